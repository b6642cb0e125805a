//! The printed numbers of the dissertation: a changed one of ours is seen.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{rounded, toolglide};
use serde_json::Value;
use std::fmt::Write;

fn rows(arguments: &[&str]) -> Vec<Value> {
    let run = toolglide(&[&["reproduce", "--json"], arguments].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    serde_json::from_str(&run.out).unwrap()
}

#[test]
fn every_printed_number_beside_ours() {
    let mut text = String::new();
    for row in rows(&[]) {
        let ours = &rounded(&row)["ours"];
        let _ = writeln!(
            text,
            "{} | {} | {} | {} | {ours} {}",
            row["name"].as_str().unwrap(),
            row["program"].as_str().unwrap_or("-"),
            row["quantity"].as_str().unwrap(),
            row["printed_as"].as_str().unwrap(),
            row["unit"].as_str().unwrap(),
        );
    }
    insta::assert_snapshot!(text);
}

#[test]
fn what_is_given_in_full_is_reproduced_within_a_percent() {
    for name in ["section-2.3.1", "fig-3.9"] {
        for row in rows(&[name]) {
            if let Some(percent) = row["difference_percent"].as_f64() {
                assert!(percent.abs() < 1.0, "{row}");
            }
        }
    }
}

#[test]
fn the_table_has_the_rows_of_the_array() {
    let all = toolglide(&["reproduce", "fig-3.9"]);
    assert_eq!(all.code, 0, "{}", all.err);
    for row in rows(&["fig-3.9"]) {
        let quantity = row["quantity"].as_str().unwrap();
        assert!(all.out.contains(quantity), "{quantity}");
        assert_eq!(row["name"], "fig-3.9");
    }
    assert!(all.out.starts_with("fig-3.9: "), "{}", all.out);
}

#[test]
fn an_unknown_name_is_refused_with_those_there_are() {
    let run = toolglide(&["reproduce", "fig-9.9"]);
    assert_eq!(run.code, 2);
    assert!(
        run.err.contains("fig-9.9") && run.err.contains("table-3.1"),
        "{}",
        run.err
    );
}

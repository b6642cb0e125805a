//! Comparing methods: what the table, the JSON and the picture hold.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, SQUARE, rounded, toolglide};
use serde_json::Value;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_small_program_by_every_method() {
    let program = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../examples/dissertation/two_corners_80um.ngc"
    );
    let run = toolglide(&["compare", program, "--max-acceleration", "3000", "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let mut all = json(&run.out);
    all["program"] = "two_corners_80um.ngc".into();
    let methods = all["methods"].as_array_mut().unwrap();
    // What is found by iteration is held against the optimum in its own tests, not digit by digit.
    methods.retain(|method| method["method"] != "optimal");
    for method in methods {
        let time = method.as_object_mut().unwrap();
        let time = time.remove("planning_us_per_block").unwrap();
        assert!(time.as_f64().unwrap() > 0.0, "measured");
    }
    insta::assert_snapshot!(serde_json::to_string_pretty(&rounded(&all)).unwrap());
}

#[test]
fn methods_are_shown_as_asked_and_measured_by_a_stop_all_the_same() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let all = json(&toolglide(&["compare", &program, "--json"]).out);
    let run = toolglide(&[
        "compare",
        &program,
        "--methods",
        "kcs-interrupted,kcs",
        "--json",
    ]);
    let some = json(&run.out);
    let names: Vec<_> = some["methods"].as_array().unwrap().iter().collect();
    assert_eq!(names.len(), 2);
    for (one, name) in names.iter().zip(["kcs-interrupted", "kcs"]) {
        assert_eq!(one["method"], name);
        let methods = all["methods"].as_array().unwrap();
        let same = methods.iter().find(|row| row["method"] == name).unwrap();
        assert_eq!(one["ratio_to_exact_stop"], same["ratio_to_exact_stop"]);
    }
    assert_eq!(all["blocks"], 8);
    let stop = all["methods"].as_array().unwrap().last().unwrap();
    assert_eq!(stop["method"], "exact-stop");
    assert_eq!(stop["ratio_to_exact_stop"], 1.0);
}

#[test]
fn a_method_plans_what_it_plans_alone() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let run = toolglide(&["compare", &program, "--json"]);
    for row in json(&run.out)["methods"].as_array().unwrap() {
        let method = row["method"].as_str().unwrap();
        let alone = toolglide(&["plan", &program, "--json", "--method", method]);
        let alone = json(&alone.out);
        for field in ["cycle_time_s", "peak_jerk", "max_deviation_mm"] {
            assert_eq!(row[field], alone[field], "{method}: {field}");
        }
    }
}

#[test]
fn the_tables_have_a_line_for_every_method_each() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let run = toolglide(&["compare", &program]);
    assert_eq!(run.code, 0, "{}", run.err);
    for method in toolglide_cli::METHODS {
        if method.must_be_named() {
            continue;
        }
        let name = format!("\n{} ", method.name);
        assert_eq!(run.out.matches(&name).count(), 4, "{name}{}", run.out);
    }
    assert!(run.out.contains("µs per block"), "{}", run.out);
    assert!(!run.out.contains("NaN"), "{}", run.out);
}

#[test]
fn a_picture_has_a_legend_of_the_methods() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let plot = folder.name("feeds.svg");
    let run = toolglide(&["compare", &program, "--plot", &plot]);
    assert_eq!(run.code, 0, "{}", run.err);
    let svg = folder.read("feeds.svg");
    for method in toolglide_cli::METHODS {
        if method.must_be_named() {
            continue;
        }
        assert!(svg.contains(&format!(">{}<", method.name)), "{svg}");
    }
    assert!(svg.contains("Feedrate along the path, mm/s"));
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "only numbers");
    let still = folder.write("still.ngc", "");
    let run = toolglide(&["compare", &still, "--plot", &folder.name("still.png")]);
    assert_eq!(run.code, 0, "{}", run.err);
}

#[test]
fn what_cannot_be_compared_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", "G1 X1 F600\nQ7\n");
    let plot = folder.name("feeds.svg");
    for more in [
        &["--plot", &plot][..],
        &["--plot", &program],
        &["--plot", "feeds.pdf"],
        &["--methods", "kcs,spline"],
        &["--methods", ""],
        &["--max-jerk", "0"],
    ] {
        let run = toolglide(&[&["compare", &program], more].concat());
        assert_eq!(run.code, 2, "{more:?}: {}", run.out);
        assert!(!run.err.is_empty() && run.out.is_empty(), "{more:?}");
    }
    assert_eq!(toolglide(&["compare", "no such file"]).code, 2);
    assert_eq!(folder.files(), ["part.ngc"]);
}

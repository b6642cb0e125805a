//! Scores against the time-optimal motion, as users and programs read them.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, toolglide};
use serde_json::Value;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

const CORNER: &str = "G64 P0.1\nG1 X10 F6000\nY10\n";

#[test]
fn every_method_stands_between_its_bound_and_nothing() {
    let folder = Folder::new();
    let program = folder.write("corner.ngc", CORNER);
    let run = toolglide(&["score", &program, "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let standing = json(&run.out);
    let number = |value: &Value| value.as_f64().unwrap();
    let optimum = number(&standing["optimum_s"]);
    let bound = number(&standing["lower_bound_s"]);
    assert!(bound <= optimum && bound > 0.999 * optimum, "{}", run.out);
    assert!((optimum - 0.2715).abs() < 1e-4, "{optimum}");
    let methods = standing["methods"].as_array().unwrap();
    let all = toolglide_cli::METHODS.iter();
    let scored = all.filter(|method| !method.must_be_named()).count();
    assert_eq!(methods.len(), scored);
    for method in methods {
        let (time, score) = (number(&method["cycle_time_s"]), number(&method["score"]));
        assert!((score - optimum / time).abs() < 1e-12, "{method}");
        assert!(score < 1.0 && score > 0.5, "{method}");
        assert!(number(&method["lower_bound_s"]) <= time, "{method}");
        assert!(number(&method["corner_penalty_ratio"]) < score, "{method}");
    }
    let losses = standing["losses"].as_array().unwrap();
    let lines: Vec<_> = losses
        .iter()
        .map(|loss| loss["line"].as_u64().unwrap())
        .collect();
    assert_eq!(lines.len(), 2, "{}", run.out);
    assert!(lines.contains(&2) && lines.contains(&3), "{lines:?}");
    let lost: f64 = losses.iter().map(|loss| number(&loss["loss_s"])).sum();
    let time = number(&methods[0]["cycle_time_s"]);
    assert!((lost - (time - optimum)).abs() < 1e-9, "{lost}");
}

#[test]
fn the_table_and_the_picture_name_the_optimum() {
    let folder = Folder::new();
    let program = folder.write("corner.ngc", CORNER);
    let plot = folder.name("score.svg");
    let run = toolglide(&[
        "score",
        &program,
        "--methods",
        "exact-stop",
        "--plot",
        &plot,
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("optimum 0.2714"), "{}", run.out);
    assert!(run.out.contains("\nexact-stop "), "{}", run.out);
    assert!(
        run.out.contains("where exact-stop loses most"),
        "{}",
        run.out
    );
    let svg = folder.read("score.svg");
    assert!(
        svg.contains("optimum 0.27") && svg.contains("exact-stop 0.3050 s"),
        "{svg}"
    );
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "only numbers");
}

#[test]
fn stops_and_dwells_cost_the_optimum_too() {
    let folder = Folder::new();
    let program = folder.write("stops.ngc", "G61\nG1 X10 F6000\nG4 P0.5\nG1 X20\n");
    let run = toolglide(&["score", &program, "--methods", "kcs,exact-stop", "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let standing = json(&run.out);
    let optimum = standing["optimum_s"].as_f64().unwrap();
    assert!(
        (optimum - 0.805).abs() < 1e-6,
        "two moves in closed form and a dwell: {optimum}"
    );
    for method in standing["methods"].as_array().unwrap() {
        assert!(method["score"].as_f64().unwrap() <= 1.0 + 1e-9, "{method}");
    }
    assert!(
        standing["losses"].as_array().unwrap().is_empty(),
        "{}",
        run.out
    );
}

#[test]
fn a_program_of_nothing_has_a_score_of_one() {
    let folder = Folder::new();
    let program = folder.write("nothing.ngc", "G21\n");
    let run = toolglide(&["score", &program, "--methods", "kcs", "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let score = &json(&run.out)["methods"][0]["score"];
    assert!((score.as_f64().unwrap() - 1.0).abs() < 1e-12, "{}", run.out);
}

#[test]
fn what_cannot_be_scored_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", "G1 X1 F600\nQ7\n");
    let plot = folder.name("score.svg");
    for more in [
        &["--plot", &plot][..],
        &["--plot", "score.pdf"],
        &["--methods", "spline"],
        &["--intervals", "3"],
        &["--intervals", "many"],
    ] {
        let run = toolglide(&[&["score", &program], more].concat());
        assert_eq!(run.code, 2, "{more:?}: {}", run.out);
        assert!(!folder.path("score.svg").exists(), "{more:?}");
    }
}

//! Judging set-points: those of every method pass, those that were spoiled do not.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, SQUARE, rows, toolglide};
use serde_json::Value;

/// A folder with a program and its planned set-points.
fn planned(more: &[&str]) -> (Folder, String, String) {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let output = folder.name("motion.csv");
    let arguments = [&["plan", &program, "-o", &output], more].concat();
    let run = toolglide(&arguments);
    assert_eq!(run.code, 0, "{}", run.err);
    (folder, program, output)
}

/// Set-points with one cell changed.
fn spoiled(csv: &str, row: usize, column: usize, change: impl Fn(f64) -> f64) -> String {
    let mut lines: Vec<String> = csv.lines().map(str::to_owned).collect();
    let mut cells: Vec<String> = lines[row].split(',').map(str::to_owned).collect();
    let value: f64 = cells[column].parse().unwrap();
    cells[column] = change(value).to_string();
    lines[row] = cells.join(",");
    lines.join("\n")
}

#[test]
fn the_set_points_of_every_method_and_period_pass() {
    for method in toolglide_cli::METHODS
        .iter()
        .filter(|method| method.keeps_limits())
    {
        for period in ["0.001", "0.0004", "0.01"] {
            let (_folder, program, output) =
                planned(&["--method", method.name, "--period", period]);
            let run = toolglide(&["verify", &program, &output]);
            assert_eq!(run.code, 0, "{} {period}: {}", method.name, run.err);
            assert!(
                run.out.contains("every limit and tolerance is kept"),
                "{}",
                run.out
            );
        }
    }
}

#[test]
fn rounded_set_points_pass_too() {
    let (folder, program, _) = planned(&[]);
    for decimals in [3, 5] {
        let mut text = String::from("t_s,x_mm,y_mm,z_mm\n");
        for row in rows(&folder.read("motion.csv")) {
            text.push_str(&format!("{}", row[0]));
            for position in &row[1..] {
                text.push_str(&format!(",{position:.decimals$}"));
            }
            text.push('\n');
        }
        let rounded = folder.write("rounded.csv", text);
        let run = toolglide(&["verify", &program, &rounded]);
        assert_eq!(run.code, 0, "{decimals} decimals: {}", run.err);
    }
}

#[test]
fn limits_tighter_than_those_planned_with_are_broken() {
    let (_folder, program, output) = planned(&[]);
    for (option, value, word) in [
        ("--max-velocity", "50", "velocity"),
        (
            "--max-acceleration",
            "1000,2500,2500",
            "axis X: acceleration",
        ),
        ("--max-jerk", "2e5,5e4,2e5", "axis Y: jerk"),
        ("--tolerance", "0.001", "from the"),
    ] {
        let run = toolglide(&["verify", &program, &output, option, value]);
        assert_eq!(run.code, 1, "{option}: {}{}", run.out, run.err);
        assert!(run.err.contains(word), "{option}: {}", run.err);
        assert!(run.out.contains("NOT ALLOWED"), "{}", run.out);
        let json = toolglide(&["verify", &program, &output, option, value, "--json"]);
        let summary: Value = serde_json::from_str(&json.out).unwrap();
        assert!(summary["violations"].as_u64().unwrap() > 0, "{summary}");
        assert_eq!(json.code, 1);
    }
}

#[test]
fn a_point_that_jumps_or_leaves_the_path_is_found() {
    let (folder, program, _) = planned(&[]);
    let csv = folder.read("motion.csv");
    let middle = csv.lines().count() / 2;
    for column in [1, 2, 3] {
        let text = spoiled(&csv, middle, column, |value| value + 0.2);
        let file = folder.write("spoiled.csv", text);
        let run = toolglide(&["verify", &program, &file]);
        assert_eq!(run.code, 1, "column {column}: {}", run.out);
        assert!(run.err.lines().count() > 1, "{}", run.err);
    }
    // Half of the motion is missing.
    let half: Vec<&str> = csv.lines().take(middle).collect();
    let file = folder.write("half.csv", half.join("\n"));
    let run = toolglide(&["verify", &program, &file]);
    assert_eq!(run.code, 1, "{}", run.out);
    // The motion starts elsewhere.
    let file = folder.write("shifted.csv", spoiled(&csv, 1, 1, |value| value + 1.0));
    let run = toolglide(&["verify", &program, &file]);
    assert_eq!(run.code, 1, "{}", run.out);
    assert!(run.err.contains("--start"), "{}", run.err);
}

#[test]
fn set_points_that_cannot_be_read_are_refused_with_their_line() {
    let (folder, program, output) = planned(&[]);
    let header = "t_s,x_mm,y_mm,z_mm\n";
    for (text, reason) in [
        (String::new(), "bad.csv:0: there is no header"),
        (header.to_owned(), "bad.csv:1: there is no row"),
        (
            "t_s,x_mm,y_mm\n0,0,0\n".to_owned(),
            "bad.csv:1: the header must name the column z_mm",
        ),
        (
            format!("{header}0,0,0,0\n0.001,NaN,0,0\n"),
            "bad.csv:3: column 2 is \"NaN\"",
        ),
        (
            format!("{header}0,0,0,0\n0.001,0,0,0\n0.001,0,0,0\n"),
            "bad.csv:4: time is 0.001 s",
        ),
        (
            format!("{header}0,0,0\n"),
            "bad.csv:2: the row has 3 columns",
        ),
        (
            "\u{0}\u{1}\u{2}\n".to_owned(),
            "bad.csv:1: the header must name",
        ),
    ] {
        let file = folder.write("bad.csv", &text);
        let run = toolglide(&["verify", &program, &file]);
        assert_eq!(run.code, 2, "{text:?}: {}", run.out);
        assert!(run.err.contains(reason), "{reason}: {}", run.err);
    }
    let missing = folder.name("missing.csv");
    assert!(
        toolglide(&["verify", &program, &missing])
            .err
            .contains("missing.csv: cannot be read")
    );
    let here = folder.here().to_str().unwrap();
    assert!(
        toolglide(&["verify", &program, here])
            .err
            .contains("it is a folder")
    );
    assert!(
        toolglide(&["verify", &program, &program])
            .err
            .contains("this is the program")
    );
    let wrong = folder.write("wrong.ngc", "G1 X10 F600\nX=3\n");
    let run = toolglide(&["verify", &wrong, &output]);
    assert_eq!(run.code, 2);
    assert!(run.err.contains("wrong.ngc:2:"), "{}", run.err);
}

#[test]
fn the_program_is_read_ahead_however_many_moves_a_row_passes() {
    let folder = Folder::new();
    let mut text = String::from("G64 P0.05\nG1 F12000\n");
    for step in 1..=12_000 {
        text.push_str(&format!("X{:.4}\n", f64::from(step) * 0.01));
    }
    let program = folder.write("part.ngc", text);
    let output = folder.name("motion.csv");
    let plan = toolglide(&[
        "plan",
        &program,
        "-o",
        &output,
        "--period",
        "0.1",
        "--method",
        "exact-stop",
    ]);
    assert_eq!(plan.code, 0, "{}", plan.err);
    let run = toolglide(&["verify", &program, &output, "--json"]);
    let summary: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(summary["violations"], 0, "{}", run.err);
}

#[test]
fn rows_too_far_apart_to_show_a_corner_are_too_coarse_to_judge() {
    let folder = Folder::new();
    let text = "G1 X10 Y5 F3000\nX0 Y9\nG2 X5 Y9 I2.5\nM2\n";
    let program = folder.write("part.ngc", text);
    let two = "t_s,x_mm,y_mm,z_mm\n0,0,0,0\n0.6827487552598196,5,9,0\n";
    let file = folder.write("two.csv", two);
    let run = toolglide(&["verify", &program, &file]);
    assert_eq!(run.code, 1, "{}", run.out);
    assert!(
        run.out
            .contains("verdict      too coarse to judge: 1 gap between rows"),
        "{}",
        run.out
    );
    assert!(
        run.err
            .contains("too coarse to judge: rows are 0.6827 s apart from 0.0000 s on"),
        "{}",
        run.err
    );
    let json = toolglide(&["verify", &program, &file, "--json"]);
    let summary: Value = serde_json::from_str(&json.out).unwrap();
    assert_eq!(summary["too_coarse"], 1, "{summary}");
    assert_eq!(summary["violations"], 0, "{summary}");
    assert_eq!(json.code, 1);
    // What every program writes a millisecond apart is fine, a tenth of it is not.
    let output = folder.name("motion.csv");
    assert_eq!(toolglide(&["plan", &program, "-o", &output]).code, 0);
    let run = toolglide(&["verify", &program, &output]);
    assert_eq!(run.code, 0, "{}", run.err);
    let rows = folder.read("motion.csv");
    let last = rows.lines().count() - 1;
    let tenth = rows.lines().enumerate();
    let tenth = tenth.filter(|(index, _)| index % 10 == 1 || *index == last);
    let tenth: Vec<&str> = tenth.map(|(_, row)| row).collect();
    let text = format!("t_s,x_mm,y_mm,z_mm\n{}\n", tenth.join("\n"));
    let file = folder.write("tenth.csv", text);
    let run = toolglide(&["verify", &program, &file]);
    assert_eq!(run.code, 1, "{}", run.out);
    assert!(run.out.contains("too coarse to judge"), "{}", run.out);
    assert!(!run.out.contains("NOT ALLOWED"), "{}", run.err);
}

#[test]
fn rows_of_tool_poses_may_be_too_coarse_to_judge_as_well() {
    let folder = Folder::new();
    let program = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/poses/star.apt");
    let rows = folder.name("rows.csv");
    let on = ["--machine", "table-ac", "--tolerance", "0.2"];
    let plan = toolglide(&[&["plan", program, "-o", &rows], &on[..]].concat());
    assert_eq!(plan.code, 0, "{}", plan.err);
    let run = toolglide(&[&["verify", program, &rows], &on[..]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let text = folder.read("rows.csv");
    let lines: Vec<&str> = text.lines().collect();
    for every in [100, lines.len()] {
        let kept = lines.iter().enumerate().skip(1);
        let kept = kept.filter(|(index, _)| index % every == 1 || *index == lines.len() - 1);
        let kept: Vec<&str> = kept.map(|(_, row)| *row).collect();
        let few = folder.write("few.csv", format!("{}\n{}\n", lines[0], kept.join("\n")));
        let run = toolglide(&[&["verify", program, &few], &on[..]].concat());
        assert_eq!(run.code, 1, "{every}: {}", run.out);
        assert!(
            run.out.contains("too coarse to judge"),
            "{every}: {}",
            run.out
        );
        assert!(!run.out.contains("NOT ALLOWED"), "{every}: {}", run.err);
    }
}

#[test]
fn set_points_of_tool_poses_are_as_near_to_the_path_as_their_plan() {
    let folder = Folder::new();
    let program = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/poses/star.apt");
    let rows = folder.name("rows.csv");
    let on = ["--machine", "table-ac", "--tolerance", "0.2", "--json"];
    let plan = toolglide(&[&["plan", program, "-o", &rows], &on[..]].concat());
    let verdict = toolglide(&[&["verify", program, &rows], &on[..]].concat());
    assert_eq!((plan.code, verdict.code), (0, 0), "{}", verdict.err);
    let [planned, judged]: [Value; 2] =
        [plan, verdict].map(|run| serde_json::from_str(&run.out).unwrap());
    for share in ["tip_deviation_share", "orientation_deviation_share"] {
        let [planned, judged] = [&planned, &judged].map(|summary| summary[share].as_f64().unwrap());
        assert!(judged <= 1.001 * planned, "{share}: {judged} of {planned}");
    }
}

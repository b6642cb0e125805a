//! Planning: what the rows, the summary and the files hold.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, SQUARE, rows, toolglide};
use serde_json::Value;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn the_rows_stand_on_the_ticks_and_end_on_the_programmed_point() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let output = folder.name("motion.csv");
    let run = toolglide(&["plan", &program, "-o", &output, "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let csv = folder.read("motion.csv");
    assert!(
        csv.starts_with("t_s,x_mm,y_mm,z_mm\n0,0,0,0\n"),
        "{}",
        &csv[..60]
    );
    assert!(csv.ends_with(",5,5,-1\n"), "the end exactly");
    let rows = rows(&csv);
    for (tick, row) in rows[..rows.len() - 1].iter().enumerate() {
        assert!(
            (row[0] - tick as f64 * 0.001).abs() < 1e-12,
            "row {tick} at {}",
            row[0]
        );
    }
    let last = &rows[rows.len() - 1];
    assert!(last[0] > rows[rows.len() - 2][0], "no instant twice");
    let summary = json(&run.out);
    assert_eq!(summary["setpoints"], rows.len());
    assert!((summary["cycle_time_s"].as_f64().unwrap() - last[0]).abs() < 1e-9);
    assert_eq!(folder.files(), ["motion.csv", "part.ngc"]);
}

#[test]
fn the_summary_is_the_same_whether_rows_are_written_or_counted() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    for period in ["0.001", "0.0007", "0.3", "10"] {
        let counted = toolglide(&["plan", &program, "--period", period, "--json"]);
        let output = folder.name("motion.csv");
        let written = toolglide(&[
            "plan", &program, "--period", period, "--json", "-o", &output,
        ]);
        let count = json(&counted.out)["setpoints"].clone();
        assert_eq!(count, json(&written.out)["setpoints"], "{period}");
        assert_eq!(count, rows(&folder.read("motion.csv")).len(), "{period}");
    }
}

#[test]
fn the_json_holds_what_others_build_on() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let run = toolglide(&["plan", &program, "--json", "--method", "exact-stop"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let summary = json(&run.out);
    for field in [
        "cycle_time_s",
        "setpoints",
        "blocks",
        "path_length_mm",
        "max_deviation_mm",
        "max_corner_error_mm",
        "planning_time_s",
        "violations",
    ] {
        assert!(summary[field].is_number(), "{field}");
    }
    for field in ["peak_velocity", "peak_acceleration", "peak_jerk"] {
        assert_eq!(summary[field].as_array().unwrap().len(), 3, "{field}");
    }
    assert_eq!(summary["method"], "exact-stop");
    assert_eq!(summary["blocks"], 8);
    let length = 50.0_f64.sqrt() + 20.0 + 20.0 + 5.0 * std::f64::consts::PI + 1001.0_f64.sqrt();
    assert!(
        (summary["path_length_mm"].as_f64().unwrap() - length).abs() < 1e-9,
        "{summary}"
    );
}

#[test]
fn standard_output_has_the_rows_to_itself() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let run = toolglide(&["plan", &program, "-o", "-"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.starts_with("t_s,x_mm,y_mm,z_mm\n"), "rows");
    assert!(run.out.ends_with(",5,5,-1\n"), "nothing after them");
    assert!(
        run.err.contains("cycle time"),
        "the summary goes where messages go"
    );
    let again = toolglide(&["plan", &program, "-o", "-"]);
    assert_eq!(run.out, again.out, "same input, same bytes");
}

#[test]
fn limits_of_the_command_line_are_kept_axis_by_axis() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let run = toolglide(&[
        "plan",
        &program,
        "--json",
        "--max-velocity",
        "50,40,30",
        "--max-acceleration",
        "900",
        "--max-jerk",
        "3e4,2e4,1e4",
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let summary = json(&run.out);
    for (field, limits) in [
        ("peak_velocity", [50.0, 40.0, 30.0]),
        ("peak_acceleration", [900.0; 3]),
        ("peak_jerk", [3e4, 2e4, 1e4]),
    ] {
        for (axis, limit) in limits.iter().enumerate() {
            let peak = summary[field][axis].as_f64().unwrap();
            assert!(
                peak <= limit * (1.0 + 1e-9),
                "{field} {axis}: {peak} of {limit}"
            );
        }
    }
}

#[test]
fn the_tolerance_of_the_command_line_overrides_the_program() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let deviation = |more: &[&str]| {
        let arguments = [&["plan", &program, "--json"], more].concat();
        json(&toolglide(&arguments).out)["max_corner_error_mm"]
            .as_f64()
            .unwrap()
    };
    let programmed = deviation(&[]);
    assert!(
        programmed > 0.005 && programmed <= 0.05 + 1e-9,
        "{programmed}"
    );
    let overridden = deviation(&["--tolerance", "0.002"]);
    assert!(overridden <= 0.002 + 1e-9, "{overridden}");
}

#[test]
fn an_empty_program_stands_still_at_the_start() {
    let folder = Folder::new();
    for text in ["", "%\n%\n", "; nothing\n\n", "G1 F600 X1 Y2 Z3\n"] {
        let program = folder.write("part.ngc", text);
        let run = toolglide(&["plan", &program, "--start", "1,2,3", "-o", "-"]);
        assert_eq!(run.code, 0, "{text:?}: {}", run.err);
        assert_eq!(run.out, "t_s,x_mm,y_mm,z_mm\n0,1,2,3\n", "{text:?}");
    }
    let program = folder.name("part.ngc");
    for picture in ["still.svg", "still.png"] {
        let plot = folder.name(picture);
        let run = toolglide(&["plan", &program, "--start", "1,2,3", "--plot", &plot]);
        assert_eq!(run.code, 0, "{}", run.err);
    }
}

#[test]
fn a_machine_of_two_axes_plans_two_axes() {
    let folder = Folder::new();
    let machine = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../examples/machines/plotter.toml"
    );
    let program = folder.write(
        "part.ngc",
        "G64 P0.1\nG1 X20 F3000\nG3 Y20 J10\nG2 X20 Y20 I5 J5 P2\n",
    );
    let run = toolglide(&["plan", &program, "--machine", machine, "-o", "-"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.out.starts_with("t_s,x_mm,y_mm\n0,0,0\n0.002,"),
        "the period of the machine"
    );
    assert!(run.out.ends_with(",20,20\n"), "the end");
    assert!(run.err.contains("plotter"), "{}", run.err);
}

#[test]
fn every_method_keeps_the_limits_of_every_example_machine() {
    let folder = Folder::new();
    let program = folder.write(
        "part.ngc",
        "G64 P0.05\nG0 X5 Y5\nG1 X25 F6000\nY25\nG3 X15 Y35 I-10\nG1 X5 Y5\n",
    );
    let mut times = Vec::new();
    for method in toolglide_cli::METHODS
        .iter()
        .filter(|method| method.keeps_limits())
    {
        for machine in ["router", "mill", "plotter"] {
            let machine = format!(
                "{}/../examples/machines/{machine}.toml",
                env!("CARGO_MANIFEST_DIR")
            );
            let run = toolglide(&[
                "plan",
                &program,
                "--machine",
                &machine,
                "--method",
                method.name,
                "--json",
            ]);
            assert_eq!(run.code, 0, "{} on {machine}: {}", method.name, run.err);
            times.push(json(&run.out)["cycle_time_s"].as_f64().unwrap());
        }
    }
    let stop = &times[times.len() - 3..];
    for (time, stop) in times.iter().zip(stop) {
        assert!(
            time <= &(stop * (1.0 + 1e-9)),
            "the first method never loses to stopping"
        );
    }
}

#[test]
fn help_and_version_are_no_mistakes() {
    for arguments in [&["--help"][..], &["--version"], &["plan", "--help"]] {
        let run = toolglide(arguments);
        assert_eq!(run.code, 0, "{arguments:?}");
        assert!(run.out.contains("toolglide"), "{}", run.out);
        assert_eq!(run.err, "");
    }
    assert!(
        toolglide(&["completions", "bash"])
            .out
            .contains("toolglide")
    );
}

#[test]
fn machines_are_listed_described_and_their_files_have_a_schema() {
    let list = toolglide(&["machines"]);
    assert!(list.out.contains("gantry "), "{}", list.out);
    let one = toolglide(&["machines", "gantry"]);
    assert!(
        one.out.contains("2500") && one.out.contains("no ends"),
        "{}",
        one.out
    );
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../examples/machines/router.toml"
    );
    let described = toolglide(&["machines", file]);
    assert!(
        described.out.contains("-50 to 1250 mm"),
        "{}",
        described.out
    );
    let table = toolglide(&["machines", "table-ac"]);
    for shown in ["-120 to 120 deg", "a_axis_z       60 ", "no ends"] {
        assert!(table.out.contains(shown), "{shown}: {}", table.out);
    }
    let schema = json(&toolglide(&["machines", "--schema"]).out);
    assert!(schema["properties"]["axis"].is_object(), "{schema}");
    let unknown = toolglide(&["machines", "lathe"]);
    assert_eq!(unknown.code, 2);
    assert!(
        unknown.err.contains("registered: ") && unknown.err.contains("gantry, "),
        "{}",
        unknown.err
    );
}

#[test]
fn a_motion_of_many_pieces_from_one_move_is_complete() {
    let folder = Folder::new();
    // One arc of thousands of chords, which all come out when the program is over.
    let program = folder.write("part.ngc", "G64 P0.0004\nG2 X0 Y0 I100 F60000\n");
    let run = toolglide(&["plan", &program, "--json", "--method", "exact-stop"]);
    let summary = json(&run.out);
    assert!(run.code <= 1, "{}", run.err);
    let length = 200.0 * std::f64::consts::PI;
    let planned = summary["path_length_mm"].as_f64().unwrap();
    assert!((planned - length).abs() < 1e-6, "{planned}");
    assert!(!run.err.contains("end"), "it comes to its end: {}", run.err);
}

#[test]
fn the_language_of_a_program_can_be_said() {
    let folder = Folder::new();
    let text = "N10 DEF REAL DEEP=4\nN20 G0 X10\nN30 G1 X=DEEP*10 F600\nN40 M30\n";
    let program = folder.write("part.txt", text);
    let run = toolglide(&["plan", &program, "--dialect", "840d"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("part.txt"), "{}", run.out);
    let run = toolglide(&["plan", &program]);
    assert_eq!(run.code, 2, "RS274/NGC has no DEF: {}", run.out);
    let program = folder.write("part.mpf", text);
    for command in ["plan", "compare"] {
        let run = toolglide(&[command, &program]);
        assert_eq!(run.code, 0, "{command} knows it by its name: {}", run.err);
    }
    let poses = folder.write(
        "poses.txt",
        "UNITS/MM\nFEDRAT/600\nGOTO/1,2,0\nGOTO/9,2,0\nFINI\n",
    );
    for more in [&[][..], &["--dialect", "cl"]] {
        let run = toolglide(&[&["plan", &poses], more].concat());
        assert_eq!(run.code, 0, "{}", run.err);
    }
}

//! Machines with axes beside X, Y and Z: what every command makes of them.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, rows, toolglide};
use serde_json::Value;

/// A tube that turns 740 degrees under a cutter.
const WRAP: &str =
    "G21 G90\nG0 A-998.2889 X0\nG1 F1200 Z-4\nG1 X18.54\nA-257.9456\nG1 X47.476\nM5\n";

/// Both ends of a wire on lines and an arc of their own.
const WIRE: &str =
    "G21 G90 F3000\nG1 X30 Y40 U30 V20\nX60 Y0 U50 V0\nG3 X80 Y20 I0 J20 U70\nG1 X0 Y0 U0 V0\nM2\n";

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_rotary_axis_is_planned_in_degrees_and_judged() {
    let folder = Folder::new();
    let program = folder.write("wrap.ngc", WRAP);
    let output = folder.name("motion.csv");
    let run = toolglide(&["plan", &program, "--machine", "gantry-a", "-o", &output]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.out.contains("1790.108 mm and degrees in 5 moves"),
        "{}",
        run.out
    );
    assert!(
        run.out.contains("\nA, deg       180.0  100.0 % "),
        "{}",
        run.out
    );
    let csv = folder.read("motion.csv");
    assert!(
        csv.starts_with("t_s,x_mm,y_mm,z_mm,a_deg\n0,0,0,0,0\n"),
        "header"
    );
    assert!(csv.ends_with(",47.476,0,-4,-257.9456\n"), "the end exactly");
    // 740 of the 740.3433 degrees of the block that turns alone, at 20 degrees a second.
    let turning = rows(&csv)
        .iter()
        .filter(|row| row[3] < -3.9 && row[4] > -998.1 && row[4] < -258.1)
        .count();
    assert!((36_950..37_100).contains(&turning), "{turning} ms");
    let run = toolglide(&["verify", &program, &output, "--machine", "gantry-a"]);
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
}

#[test]
fn every_method_plans_all_axes_together() {
    let folder = Folder::new();
    for (text, machine, axes) in [(WIRE, "hot-wire", 4), (WRAP, "gantry-abc", 6)] {
        let program = folder.write("part.ngc", text);
        let run = toolglide(&["compare", &program, "--machine", machine, "--json"]);
        assert_eq!(run.code, 0, "{}", run.err);
        let found = json(&run.out);
        let methods = found["methods"].as_array().unwrap();
        let time = |name: &str| {
            let row = methods.iter().find(|row| row["method"] == name).unwrap();
            assert_eq!(row["violations"], 0, "{name}");
            assert_eq!(row["peak_jerk"].as_array().unwrap().len(), axes, "{name}");
            row["cycle_time_s"].as_f64().unwrap()
        };
        let stop = time("exact-stop");
        for name in [
            "kcs",
            "optimal",
            "kcs-uninterrupted",
            "kcs-global",
            "bezier",
            "fir",
            "fir-p2p",
        ] {
            assert!(
                time(name) < 1.2 * stop,
                "{machine}: {name} against {stop} s"
            );
        }
        assert!(
            time("kcs") < stop && time("optimal") < stop,
            "{machine}: {stop} s"
        );
    }
}

#[test]
fn travel_start_and_limits_of_a_rotary_axis_are_degrees() {
    let folder = Folder::new();
    let program = folder.write("turn.ngc", "G0 C700\nC0\n");
    let machine = format!(
        "model = \"gantry-c\"\nname = \"turntable\"\n{}{}",
        ["X", "Y", "Z"]
            .map(|name| format!(
                "[[axis]]\nname = \"{name}\"\nvelocity = 100\nacceleration = 1000\njerk = 50000\n"
            ))
            .concat(),
        "[[axis]]\nname = \"C\"\nvelocity = 90\nacceleration = 900\njerk = 45000\ntravel = [-540, 540]\n"
    );
    let machine = folder.write("turntable.toml", machine);
    let run = toolglide(&["plan", &program, "--machine", &machine]);
    assert_eq!(run.code, 2, "{}", run.out);
    let expected = "turn.ngc:1: axis C: position 700 is outside the travel -540 to 540\n";
    assert!(run.err.ends_with(expected), "{}", run.err);
    let program = folder.write("turn.ngc", "G0 C540\n");
    let more = [
        "--start",
        "0,0,0,-540",
        "--max-velocity",
        "100,100,100,45",
        "--json",
    ];
    let run = toolglide(&[&["plan", &program, "--machine", &machine], &more[..]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let found = json(&run.out);
    // 1080 degrees at 45 degrees a second, and the ramps.
    let time = found["cycle_time_s"].as_f64().unwrap();
    assert!((24.0..24.2).contains(&time), "{time} s");
    assert_eq!(found["velocity_limit"][3], 45.0, "limit");
    assert_eq!(found["path_length_mm"], 1080.0, "path");
}

#[test]
fn axes_that_are_not_there_are_refused_by_name() {
    let folder = Folder::new();
    let program = folder.write("wire.ngc", WIRE);
    let run = toolglide(&["plan", &program, "--machine", "gantry-a"]);
    assert_eq!(run.code, 2, "{}", run.out);
    assert!(
        run.err.contains("machine \"gantry-a\" has no axis U"),
        "{}",
        run.err
    );
    let run = toolglide(&["compare", &program, "--machine", "table-ac"]);
    assert_eq!(run.code, 2, "{}", run.out);
    assert!(
        run.err.contains("axes the program moves itself"),
        "{}",
        run.err
    );
    let run = toolglide(&["machines"]);
    for name in [
        "gantry-a ",
        "gantry-abc ",
        "gantry-b ",
        "gantry-c ",
        "gantry-uvw ",
        "hot-wire ",
    ] {
        assert!(
            run.out.contains(&format!("\n{name}")),
            "{name}: {}",
            run.out
        );
    }
}

#[test]
fn score_and_spectrum_take_all_axes() {
    let folder = Folder::new();
    let program = folder.write("wire.ngc", "G1 F6000 X10 Y0 U10 V10\nX10 Y10 U0 V10\nM2\n");
    let machine = ["--machine", "hot-wire", "--methods", "kcs,exact-stop"];
    let run = toolglide(&[&["score", &program], &machine[..]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let run = toolglide(&[&["spectrum", &program, "--mode", "U,20"], &machine[..]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("kcs "), "{}", run.out);
}

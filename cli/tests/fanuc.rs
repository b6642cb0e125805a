//! Programs of FANUC and Haas: known by their signs, with the files and the reference points beside them.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, rows, toolglide};

const MACHINE: &str = r#"
    model = "gantry"
    name = "mill"
    axis = [
        { name = "X", velocity = 300.0, acceleration = 2000.0, jerk = 5e4 },
        { name = "Y", velocity = 300.0, acceleration = 2000.0, jerk = 5e4, reference = [40.0] },
        { name = "Z", velocity = 300.0, acceleration = 2000.0, jerk = 5e4, reference = [30.0, 20.0] },
    ]
"#;

#[test]
fn macros_beside_the_program_run_and_axes_go_to_their_reference_points() {
    let folder = Folder::new();
    let machine = folder.write("mill.toml", MACHINE);
    folder.write("O9010.nc", "%\nO9010 (BESIDE)\nG1 X#1 F600.\nM99\n%\n");
    let text = "%\nO1\nG21 G90 G0 X5.\nG65 P9010 A20.\nG91 G28 Z1.\nG30 Z0\nG28 Y0\nM30\n%\n";
    let program = folder.write("part.nc", text);
    let run = toolglide(&["plan", &program, "--machine", &machine, "--output", "-"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let rows = rows(&run.out);
    let highest = rows.iter().map(|row| row[3]).fold(0.0, f64::max);
    // The tool turns back within the tolerance.
    assert!((highest - 30.0).abs() < 0.02, "{highest}");
    let last = rows.last().unwrap();
    for (axis, expected) in [20.0, 40.0, 20.0].iter().enumerate() {
        assert!((last[axis + 1] - expected).abs() < 1e-6, "{last:?}");
    }
}

#[test]
fn a_dwell_is_in_ms_where_the_dialect_says_so() {
    let folder = Folder::new();
    let program = folder.write("dwell.ngc", "G21 G90\nG4 P61\nM2\n");
    let seconds = toolglide(&["check", &program]);
    assert_eq!(seconds.code, 0, "{}", seconds.err);
    assert!(
        seconds.err.contains("stands still for 61 s"),
        "{}",
        seconds.err
    );
    let dialect = toolglide(&["check", &program, "--dialect", "fanuc"]);
    assert_eq!((dialect.code, dialect.err.as_str()), (0, ""), "61 ms");
    assert!(dialect.out.contains("read as fanuc"), "{}", dialect.out);
}

#[test]
fn modes_of_haas_are_noted_and_what_is_unknown_has_its_place() {
    let folder = Folder::new();
    let text = "G21 G90\nG187 P3 E0.02\nG0 Z5.\nG154 P2\nG0 X1.\nG255\nG150 P1\nM30\n";
    let program = folder.write("haas.nc", text);
    let run = toolglide(&["check", &program]);
    assert_eq!(run.code, 2, "{}", run.err);
    assert!(run.out.contains("read as fanuc"), "{}", run.out);
    for said in [
        "G187 is noted",
        "G255 is noted",
        "G150 is not supported: pockets",
    ] {
        assert!(run.err.contains(said), "{said}: {}", run.err);
    }
    assert!(run.err.contains("haas.nc:7:1"), "{}", run.err);
}

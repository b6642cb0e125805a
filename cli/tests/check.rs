//! `toolglide check`: what a program holds, and everything that is wrong with it.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, SQUARE, toolglide};

/// A program with a mistake of every kind on a line of its own.
const WRONG: &str =
    "G21 G90\nF600\nS[1+\nG0 F#<depth>\nG2 X5 R1\nG95\no1 endif\nG43 H9\nG1 X5\nM2\n";

#[test]
fn a_program_is_described() {
    let folder = Folder::new();
    let run = toolglide(&["check", &folder.write("part.ngc", SQUARE)]);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    for line in [
        "lines        8 with 8 blocks",
        "moves        5: 3 straight, 1 arcs, 1 rapids; 1 dwells",
        "X            5.000 to 25.000 mm",
        "Y            5.000 to 35.000 mm",
        "Z            -1.000 to 0.000 mm",
        "feedrate     6000.0 to 6000.0 mm/min",
        "verdict      every line is read",
    ] {
        assert!(
            run.out.lines().any(|shown| shown == line),
            "{line}: {}",
            run.out
        );
    }
}

#[test]
fn every_error_is_shown_with_its_line_and_a_caret() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", WRONG);
    let table = folder.write("tools.tbl", "T1 P1 Z5\n");
    let run = toolglide(&["check", &program, "--tool-table", &table]);
    assert_eq!(run.code, 2, "{}", run.out);
    insta::assert_snapshot!(run.err.replace(&program, "part.ngc"));
    assert!(
        run.out.ends_with("verdict      6 lines are refused\n"),
        "{}",
        run.out
    );
}

#[test]
fn json_holds_the_same() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", WRONG);
    let run = toolglide(&["check", &program, "--json"]);
    assert_eq!((run.code, run.err.as_str()), (2, ""), "one object only");
    let survey: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(survey["errors"].as_array().unwrap().len(), 5, "errors");
    assert_eq!(survey["errors"][3]["line"], 6, "line");
    assert_eq!(survey["errors"][3]["word"], "G95", "word");
    assert_eq!(survey["warnings"][0]["line"], 8, "no tool table");
    assert_eq!(survey["moves"], 1, "moves");
}

#[test]
fn cutter_location_files_are_known_by_their_beginning() {
    let folder = Folder::new();
    let program = folder.write("part.txt", "UNITS/MM\nFEDRAT/60\nGOTO/1,2,2\nFINI\n");
    let run = toolglide(&["check", &program]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("read as cl"), "{}", run.out);
    assert!(run.out.contains("3.000 mm at feed"), "{}", run.out);
}

#[test]
fn subroutines_stand_in_files_beside_the_program() {
    let folder = Folder::new();
    folder.write(
        "pocket.ngc",
        "o<pocket> sub\nG1 X#1 F60\no<pocket> endsub\n",
    );
    let program = folder.write("part.ngc", "o<pocket> call [7]\no<nowhere> call\n");
    let run = toolglide(&["check", &program]);
    assert_eq!(run.code, 2, "{}", run.out);
    assert!(run.out.contains("7.000 mm at feed"), "{}", run.out);
    assert!(
        run.err.contains("there is no subroutine O<nowhere>"),
        "{}",
        run.err
    );
    let run = toolglide(&["check", &program, "--tool-table", &program]);
    assert!(run.code == 2 && run.err.contains("line 1:"), "{}", run.err);
}

#[test]
fn warnings_are_shown_with_their_line_too() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", "G21 F600\nM106 S255\nG1 X5\nT3 M6 G43\nM2\n");
    let run = toolglide(&["check", &program]);
    assert_eq!(run.code, 0, "{}", run.err);
    insta::assert_snapshot!(run.err.replace(&program, "part.ngc"));
}

#[test]
fn one_cause_is_shown_once() {
    let folder = Folder::new();
    let text = "G21 G90\nG1 X1\nX2\nG1 F100 Y1 ~\nX3\nX4\no1 repeat [3]\nG95\no1 endrepeat\nG96 S9\nG96\nM2\n";
    let program = folder.write("part.ngc", text);
    let run = toolglide(&["check", &program]);
    assert_eq!(run.code, 2, "{}", run.err);
    insta::assert_snapshot!(run.err.replace(&program, "part.ngc"));
    let run = toolglide(&["check", &program, "--json"]);
    let survey: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(survey["errors"].as_array().unwrap().len(), 4, "errors");
    assert_eq!(survey["consequences"], 3, "consequences");
    assert_eq!(survey["errors"][2]["times"], 3, "times");
}

#[test]
fn secondary_axes_are_counted_though_no_machine_moves_them() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", "G21 F600\nG1 X5 U2\nU4\nM2\n");
    let run = toolglide(&["check", &program]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.out.contains("beside them  secondary axes U V W"),
        "{}",
        run.out
    );
    let run = toolglide(&["plan", &program]);
    assert_eq!(run.code, 2, "{}", run.out);
    let expected = "machine \"gantry\" has no axis U";
    assert!(run.err.contains(expected), "{}", run.err);
}

#[test]
fn a_print_is_known_and_its_filament_is_told() {
    let folder = Folder::new();
    let text = "M83\nM104 S200\nM117 One (of two\nG1 X10 E0.5 F1800\nG1 E-0.25 F600\n";
    let program = folder.write("part.gcode", text);
    let run = toolglide(&["check", &program, "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let survey: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(survey["dialect"], "printer", "dialect");
    let filament = survey["filament_mm"].as_f64().unwrap();
    assert!((filament - 0.25).abs() < 1e-9, "{filament} mm");
    let run = toolglide(&["check", &program]);
    assert!(run.out.contains("filament     0.250 mm"), "{}", run.out);
}

#[test]
fn parameters_are_given_on_the_command_line() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", "F#<_hal[cut.feed]>\nG1 X#31\n");
    let run = toolglide(&["check", &program]);
    assert_eq!(run.code, 2, "{}", run.out);
    assert!(run.err.contains("--parameter"), "{}", run.err);
    let given = [
        "--parameter",
        "_hal[cut.feed]=1200",
        "--parameter",
        "31=-7.5",
    ];
    let run = toolglide(&[&["check", &program], &given[..]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("-7.500 to -7.500"), "{}", run.out);
    let run = toolglide(&["check", &program, "--parameter", "5420=1"]);
    assert_eq!(run.code, 2, "{}", run.err);
}

#[test]
fn a_language_that_is_not_read_is_named() {
    let folder = Folder::new();
    for (name, text, language) in [
        (
            "a.h",
            "0 BEGIN PGM A MM\n1 L X+0 FMAX\n2 END PGM A MM\n",
            "Heidenhain Klartext",
        ),
        ("a.stpnc", "ISO-10303-21;\nHEADER;\nENDSEC;\n", "STEP-NC"),
        (
            "a.nc",
            "G50 S2000\nT0101\nG96 S180 M3\nG0 X52 Z2\n",
            "ISO code of a lathe",
        ),
    ] {
        let program = folder.write(name, text);
        for command in ["check", "plan"] {
            let run = toolglide(&[command, &program]);
            assert_eq!(run.code, 2, "{}", run.err);
            let times = run.err.matches("which is not read").count();
            assert!(times == 1 && run.err.contains(language), "{}", run.err);
        }
    }
}

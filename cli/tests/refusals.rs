//! Wrong use and wrong input: exit code 2, one clear message, and no file left behind.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, SQUARE, toolglide};

/// Runs a plan of `program` that writes a file, and expects it to be refused for `reason`.
fn refused(folder: &Folder, program: &str, more: &[&str], reason: &str) {
    let before = folder.files();
    let output = folder.name("motion.csv");
    let mut arguments = vec!["plan", program];
    if !more.contains(&"-o") {
        arguments.extend(["-o", &output]);
    }
    arguments.extend(more);
    let run = toolglide(&arguments);
    assert_eq!(run.code, 2, "{more:?}: {}{}", run.out, run.err);
    assert!(
        run.err.contains(reason),
        "{more:?} must tell \"{reason}\": {}",
        run.err
    );
    assert_eq!(run.out, "", "{more:?}: nothing on standard output");
    assert_eq!(folder.files(), before, "{more:?}: no file is left");
}

#[test]
fn numbers_that_are_not_positive_and_finite() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    for option in [
        "--tolerance",
        "--period",
        "--max-velocity",
        "--max-acceleration",
        "--max-jerk",
    ] {
        for (value, reason) in [
            ("NaN", "NaN is not finite"),
            ("inf", "inf is not finite"),
            ("0", "0 is not positive"),
            ("-0.1", "-0.1 is not positive"),
            ("fast", "\"fast\" is not a number"),
            ("", "a number"),
        ] {
            refused(&folder, &program, &[option, value], reason);
            refused(&folder, &program, &[option, value], option);
        }
    }
    refused(
        &folder,
        &program,
        &["--period", "1e-12"],
        "at least 0.000000001 s",
    );
}

#[test]
fn lists_with_another_number_of_axes() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    for (option, value, reason) in [
        (
            "--max-jerk",
            "1e5,1e5",
            "--max-jerk: a list of 2 was given, but the machine has 3 axes",
        ),
        ("--max-velocity", "1,2,3,4", "a list of 4 was given"),
        ("--max-acceleration", "1,,3", "\"\" is not a number"),
        ("--start", "1,2", "--start: a list of 2 was given"),
        ("--start", "1", "--start: a list of 1 was given"),
        ("--start", "1,2,x", "\"x\" is not a number"),
        ("--start", "1,2,nan", "NaN is not finite"),
    ] {
        refused(&folder, &program, &[option, value], reason);
    }
}

#[test]
fn names_that_do_not_exist_are_answered_with_those_that_do() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    refused(
        &folder,
        &program,
        &["--machine", "lathe"],
        "registered: arm-6r",
    );
    refused(
        &folder,
        &program,
        &["--method", "spline"],
        "kcs-uninterrupted",
    );
    let missing = folder.name("missing.toml");
    refused(&folder, &program, &["--machine", &missing], "missing.toml");
    assert_eq!(toolglide(&["plan", &program, "--speed", "3"]).code, 2);
    assert_eq!(toolglide(&[]).code, 2);
    assert_eq!(toolglide(&["mill"]).code, 2);
}

#[test]
fn programs_that_cannot_be_read() {
    let folder = Folder::new();
    refused(
        &folder,
        &folder.name("missing.ngc"),
        &[],
        "missing.ngc: cannot be read",
    );
    refused(
        &folder,
        folder.here().to_str().unwrap(),
        &[],
        "it is a folder",
    );
    let binary = folder.write("part.ngc", [0x7f, b'E', b'L', b'F', 0, 1, 2, 0xff]);
    refused(&folder, &binary, &[], "part.ngc:1:");
}

#[test]
fn a_program_that_is_wrong_in_the_middle_leaves_no_half_of_its_motion() {
    let folder = Folder::new();
    let mut text = String::from("G21 G90 G64 P0.01\nF3000\n");
    for step in 0..3_000 {
        text.push_str(&format!("G1 X{} Y{}\n", step % 7, step % 5));
    }
    text.push_str("G1 X1 Y=3\n");
    let program = folder.write("part.ngc", text);
    refused(&folder, &program, &[], "part.ngc:3003:");
    let plot = folder.name("motion.svg");
    refused(&folder, &program, &["--plot", &plot], "part.ngc:3003:");
}

#[test]
fn files_that_cannot_be_written() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let nowhere = folder.name("no/such/folder/motion.csv");
    refused(
        &folder,
        &program,
        &["-o", &nowhere],
        "motion.csv: cannot be written",
    );
    let here = folder.here().to_str().unwrap();
    refused(&folder, &program, &["-o", here], "it is a folder");
    refused(
        &folder,
        &program,
        &["-o", &program],
        "it is the input of this run",
    );
    assert_eq!(folder.read("part.ngc"), SQUARE, "the program is untouched");
    let around = format!("{here}/./part.ngc");
    refused(
        &folder,
        &program,
        &["-o", &around],
        "it is the input of this run",
    );
    let nowhere = folder.name("no/motion.svg");
    refused(
        &folder,
        &program,
        &["--plot", &nowhere],
        "motion.svg: cannot be written",
    );
}

#[test]
fn plots_of_another_kind_or_at_the_place_of_another_file() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    for name in ["motion.pdf", "motion", "svg"] {
        refused(
            &folder,
            &program,
            &["--plot", &folder.name(name)],
            "must end in .svg or .png",
        );
    }
    let one = folder.name("one.svg");
    refused(
        &folder,
        &program,
        &["-o", &one, "--plot", &one],
        "the set-points are written there",
    );
    let picture = folder.write("part.svg", SQUARE);
    refused(
        &folder,
        &picture,
        &["--plot", &picture],
        "it is the input of this run",
    );
}

#[test]
fn rows_and_json_cannot_both_have_standard_output() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    refused(
        &folder,
        &program,
        &["-o", "-", "--json"],
        "only one of them",
    );
}

/// A machine file with one line changed.
fn machine(folder: &Folder, from: &str, to: &str) -> String {
    let text = "model = \"gantry\"\nname = \"small\"\ntolerance_mm = 0.01\nperiod_s = 0.001\n\
         [[axis]]\nname = \"X\"\nvelocity = 100\nacceleration = 1000\njerk = 5e4\ntravel = [0, 30]\n\
         [[axis]]\nname = \"Y\"\nvelocity = 100\nacceleration = 1000\njerk = 5e4\ntravel = [0, 30]\n";
    assert!(text.contains(from), "{from}");
    folder.write("small.toml", text.replacen(from, to, 1))
}

#[test]
fn machine_files_that_say_something_wrong() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", "G1 X10 F600\n");
    for (from, to, reason) in [
        (
            "velocity = 100",
            "velocity = nan",
            "axis X: velocity is NaN, but must be positive and finite",
        ),
        ("jerk = 5e4", "jerk = inf", "axis X: jerk is inf"),
        (
            "acceleration = 1000",
            "acceleration = 0",
            "axis X: acceleration is 0",
        ),
        ("velocity = 100", "velocity = -1", "axis X: velocity is -1"),
        (
            "tolerance_mm = 0.01",
            "tolerance_mm = 0.0",
            "tolerance_mm is 0",
        ),
        ("period_s = 0.001", "period_s = -1.0", "period_s is -1"),
        (
            "travel = [0, 30]",
            "travel = [30, 0]",
            "axis X: travel is [30, 0]",
        ),
        ("tolerance_mm", "tolerance", "unknown field `tolerance`"),
        ("jerk = 5e4\n", "", "missing field `jerk`"),
        ("\"gantry\"", "\"lathe\"", "registered: arm-6r"),
        ("name = \"X\"", "name = \"A\"", "the axes are A Y"),
        ("name = \"X\"", "name = \"XX\"", "small.toml"),
        ("model", "model = 3\nmodle", "small.toml"),
    ] {
        let file = machine(&folder, from, to);
        refused(&folder, &program, &["--machine", &file], reason);
        refused(&folder, &program, &["--machine", &file], "small.toml");
    }
}

#[test]
fn filters_and_modes_of_a_machine_file_are_refused_with_its_name() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    for (line, mode, reason) in [
        (
            "",
            "axis = \"X\"\nfrequency_hz = 0",
            "small.toml: mode of axis X: frequency_hz is 0",
        ),
        (
            "",
            "axis = \"Y\"\nfrequency_hz = 7\ndamping = 1.5",
            "small.toml: mode of axis Y: damping is 1.5",
        ),
        (
            "",
            "axis = \"C\"\nfrequency_hz = 7",
            "small.toml: mode: axis is C of a machine with axes XY",
        ),
        (
            "",
            "axis = \"X\"\nfrequency_hz = 1e-3",
            "small.toml: [[mode]]: ",
        ),
        (
            "fir_s = [1e9, 1]\n",
            "axis = \"X\"\nfrequency_hz = 7",
            "small.toml: fir_s: ",
        ),
    ] {
        let text = format!("[[mode]]\n{mode}\n[[axis]]\nname = \"X\"");
        let file = machine(&folder, "[[axis]]\nname = \"X\"", &text);
        let text = std::fs::read_to_string(&file).unwrap();
        let file = folder.write("small.toml", format!("{line}{text}"));
        let with = ["--machine", file.as_str(), "--method", "fir"];
        refused(&folder, &program, &with, reason);
        if reason.contains(" is ") {
            let shown = toolglide(&["machines", &file]);
            assert_eq!(shown.code, 2, "{}", shown.out);
            assert!(shown.err.contains(reason), "{}", shown.err);
        }
    }
    let file = machine(&folder, "small", "small");
    let with = ["--machine", &file, "--method", "fir", "--fir", "1e9,1"];
    refused(
        &folder,
        &program,
        &with,
        "--fir: time constant is 1000000000 s",
    );
}

#[test]
fn what_lies_outside_the_travel_is_told_with_its_line() {
    let folder = Folder::new();
    let file = machine(&folder, "small", "small");
    let with = ["--machine", file.as_str()];
    let line = folder.write("part.ngc", "G1 X10 F600\nY20\nX31\n");
    refused(
        &folder,
        &line,
        &with,
        "part.ngc:3: axis X: position 31 is outside the travel 0 to 30",
    );
    let arc = folder.write("part.ngc", "G1 X10 F600\nG3 X20 I5\nM2\n");
    refused(&folder, &arc, &with, "part.ngc:2: axis Y: position -5 ");
    let down = folder.write("part.ngc", "G1 X10 F600\nZ-1\n");
    refused(&folder, &down, &with, "part.ngc:2:");
    let start = ["--machine", file.as_str(), "--start", "-1,0"];
    refused(
        &folder,
        &line,
        &start,
        "--start: X = -1 was given, but the travel of this axis is 0 to 30",
    );
}

#[test]
fn filters_that_no_motion_can_pass() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    for (lengths, reason) in [
        ("0.05", "one filter alone, of 0.05 s"),
        (
            "1e9,1",
            "time constant is 1000000000 s, but 10 s is the longest",
        ),
        ("0.05,0.0001", "shorter than half the period"),
        (
            "1,1,1,1,1,1,1,1,1",
            "a chain has 1 to 8 filters, but 9 were given",
        ),
    ] {
        refused(
            &folder,
            &program,
            &["--method", "fir", "--fir", lengths],
            reason,
        );
    }
}

#[test]
fn tool_poses_that_point_opposite_ways_and_no_axis_between_them() {
    let folder = Folder::new();
    let poses = "FEDRAT/3000,MMPM\nGOTO/0,0,0,0.6,0,0.8\nGOTO/10,0,0,-0.6,0,-0.8\n";
    let program = folder.write("around.apt", poses);
    let on = ["--machine", "head-bc"];
    for (more, reason) in [
        (
            &[][..],
            ":3: move 1: from orientation [0.600000, 0.000000, 0.800000] to orientation",
        ),
        (&["--turn-about", "0,1"], "an axis is I,J,K"),
        (&["--turn-about", "0.6,0,0.8"], ":3: move 1: "),
        // With an axis it is the machine that cannot point below its table.
        (&["--turn-about", "0,1,0"], ":3: move 1: axis Z"),
    ] {
        refused(&folder, &program, &[&on[..], more].concat(), reason);
    }
}

#[test]
fn a_machine_or_a_tool_table_that_is_no_file_of_text_is_named_as_what_it_is() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let inside = folder.name("machines");
    std::fs::create_dir(&inside).unwrap();
    refused(&folder, &program, &["--machine", &inside], "it is a folder");
    refused(
        &folder,
        &program,
        &["--tool-table", &inside],
        "it is a folder",
    );
    if cfg!(unix) {
        for option in ["--machine", "--tool-table"] {
            let reason = "/dev/zero: cannot be read: it is no regular file";
            refused(&folder, &program, &[option, "/dev/zero"], reason);
        }
    }
    let bytes = folder.write("bytes.tbl", "\0".repeat(100_000));
    let run = toolglide(&["plan", &program, "--tool-table", &bytes]);
    assert_eq!(run.code, 2, "{}", run.out);
    assert!(
        !run.err.contains('\0') && run.err.len() < 400,
        "a word of bytes is shown as text, and not all of it: {:?}",
        run.err
    );
}

#[test]
fn programs_in_utf_16_are_named_as_such() {
    let folder = Folder::new();
    for ending in ["ngc", "mpf", "apt"] {
        let program = folder.name(&format!("part.{ending}"));
        let wide = SQUARE.encode_utf16().flat_map(u16::to_le_bytes);
        std::fs::write(
            &program,
            [0xff, 0xfe].into_iter().chain(wide).collect::<Vec<u8>>(),
        )
        .unwrap();
        let run = toolglide(&["check", &program]);
        assert_eq!(run.code, 2, "{ending}: {}", run.out);
        let told = run.err.matches("UTF-16").count();
        assert!((1..=2).contains(&told), "{ending}: {}", run.err);
        assert!(!run.err.contains("binary"), "{ending}: {}", run.err);
    }
}

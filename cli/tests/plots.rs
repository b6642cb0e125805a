//! Pictures: what is written on them, and that they stay small however long the motion is.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, SQUARE, toolglide};

#[test]
fn a_picture_names_program_method_time_and_units() {
    let folder = Folder::new();
    let program = folder.write("part <1> & two.ngc", SQUARE);
    let plot = folder.name("motion.svg");
    let run = toolglide(&["plan", &program, "--plot", &plot]);
    assert_eq!(run.code, 0, "{}", run.err);
    let svg = folder.read("motion.svg");
    for text in [
        "part &lt;1&gt; &amp; two.ngc",
        "kcs on gantry",
        "cycle time 0:00:0",
        "Path in XY, mm",
        "Sharpest corner, line 3",
        "Feedrate along the path, mm/s",
        "Velocity, mm/s",
        "Acceleration, mm/s²",
        "Jerk, m/s³",
        "time, s",
        ">limit<",
        ">X<",
        ">Z<",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "only numbers");
}

#[test]
fn a_png_has_the_size_it_should_have() {
    let folder = Folder::new();
    let program = folder.write("part.ngc", SQUARE);
    let plot = folder.name("motion.PNG");
    assert_eq!(toolglide(&["plan", &program, "--plot", &plot]).code, 0);
    let bytes = std::fs::read(plot).unwrap();
    assert!(bytes.starts_with(b"\x89PNG\r\n"), "a PNG");
    assert_eq!(
        &bytes[16..24],
        &[0, 0, 0x06, 0x40, 0, 0, 0x04, 0xb0],
        "1600 by 1200"
    );
    assert!(bytes.len() > 20_000, "something is drawn");
}

#[test]
fn odd_programs_are_drawn_without_a_mistake() {
    let folder = Folder::new();
    for text in [
        "G1 X10 F600\n",
        "G1 X10 F600\nX0\nX10\n",
        "G1 Z10 F600\nX5\n",
        "G4 P3\n",
        "G1 X90000 F90000\nX0.001\n",
        "G1 X0.00001 F600\n",
        "G61\nG1 X1 F600\nY1\nX0\n",
        "G0 X1\nY1\n",
        "G2 X0 Y0 I10 F1000\n",
    ] {
        let program = folder.write("part.ngc", text);
        let run = toolglide(&["plan", &program, "--plot", &folder.name("odd.svg")]);
        assert_eq!(run.code, 0, "{text:?}: {}", run.err);
        let svg = folder.read("odd.svg");
        assert!(
            !svg.contains("NaN") && !svg.contains("inf"),
            "{text:?}: only numbers"
        );
    }
}

#[test]
fn a_long_motion_makes_no_long_picture() {
    let folder = Folder::new();
    let mut text = String::from("G21 G64 P0.01\nG1 F3000\n");
    for step in 0..15_000 {
        let angle = f64::from(step) * 0.01;
        text.push_str(&format!(
            "X{:.4} Y{:.4}\n",
            20.0 * angle.cos(),
            20.0 * (1.7 * angle).sin()
        ));
    }
    let program = folder.write("long.ngc", text);
    let plot = folder.name("long.svg");
    let run = toolglide(&["plan", &program, "--method", "exact-stop", "--plot", &plot]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        std::fs::metadata(plot).unwrap().len() < 4_000_000,
        "bounded"
    );
}

#[test]
fn limits_told_in_words_have_the_unit_of_their_chart() {
    let folder = Folder::new();
    let program = folder.write("corner.ngc", "G64 P0.02\nG1 X50 F6000\nY50\n");
    let plot = folder.name("motion.svg");
    let filters = ["--method", "fir", "--fir", "0.05,0.03"];
    let run = toolglide(&[&["plan", &program, "--plot", &plot], &filters[..]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let svg = folder.read("motion.svg");
    assert!(
        svg.contains("Jerk, m/s³") && svg.contains("limit ±200 m/s³"),
        "{}",
        run.out
    );
}

#[test]
fn a_corner_is_drawn_as_near_as_the_verdict_says() {
    let folder = Folder::new();
    // One corner, passed at the speed at which the drawn points of the motion are farthest apart.
    let program = folder.write("corner.ngc", "G21 G90 G64 P0.03\nG1 X60 F6000\nY60\nM2\n");
    let plot = folder.name("motion.svg");
    for method in ["fir", "kcs", "optimal", "kcs-interrupted"] {
        let run = toolglide(&[
            "plan", &program, "--method", method, "--plot", &plot, "--json",
        ]);
        assert_eq!(run.code, 0, "{method}: {}", run.err);
        let summary: serde_json::Value = serde_json::from_str(&run.out).unwrap();
        let judged = 1e3 * summary["max_corner_error_mm"].as_f64().unwrap();
        let svg = folder.read("motion.svg");
        let (_, after) = svg.split_once("passed at ").unwrap();
        let (drawn, _) = after.split_once(" of 30.000 µm").unwrap();
        let drawn: f64 = drawn.parse().unwrap();
        assert!(
            (drawn - judged).abs() <= 0.000_6,
            "{method}: {drawn} drawn, {judged} judged"
        );
    }
}

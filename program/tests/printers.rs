//! Programs of printers: extrusion is no axis, and orders move nothing.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{FILE, assert_close, settings};
use std::path::Path;
use toolglide_kinematics::{Feedrate, Move, Path as Shape, Vector};
use toolglide_program::{Language, Notice, Program, Reason};

fn program(text: &str) -> Program<&[u8]> {
    Program::new(text.as_bytes(), FILE, settings()).in_language(Language::Printer)
}

fn moves(text: &str) -> Vec<Move<3>> {
    program(text)
        .collect::<Result<_, _>>()
        .unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn ends(text: &str) -> Vec<f64> {
    let mut at = Vector::zeros();
    let mut found = Vec::new();
    for step in moves(text) {
        at = step.end(at);
        found.extend(at.iter().copied());
    }
    found
}

fn rests(text: &str) -> Vec<f64> {
    moves(text)
        .iter()
        .filter_map(|step| match step.path() {
            Shape::Dwell { duration } => Some(*duration),
            _ => None,
        })
        .collect()
}

#[test]
fn orders_and_free_text_move_nothing_and_are_told_once_each() {
    let text = "M82\nG90\nG21\nM104 S200\nG29\nG92 E0\nG1 Z0.2 F1200\nM106 S127.5\nM73 P10 R5\n\
        M117 Printing (layer 2 of 9\nM204 P1000\nM205 X8\nM900 K0.05\nSET_PRESSURE_ADVANCE ADVANCE=0.05\n\
        EXCLUDE_OBJECT_START NAME=part\nM106 S0\nG10\nG11\nG1 X60 E2.4\nM107\nM84\nN9 G1 X50*12\n";
    let mut program = program(text);
    let moves: Vec<_> = program.by_ref().map(Result::unwrap).collect();
    assert_eq!(moves.len(), 3, "moves");
    let words: Vec<&str> = program
        .warnings()
        .iter()
        .map(|one| one.place().word())
        .collect();
    let expected = [
        "M104",
        "G29",
        "M106",
        "M73",
        "M117",
        "M204",
        "M205",
        "M900",
        "SET_PRESSURE_ADVANCE",
        "EXCLUDE_OBJECT_START",
        "G10",
        "G11",
        "M107",
        "M84",
    ];
    assert_eq!(words, expected, "told");
    let all = program.warnings().iter();
    let mut all = all.map(|one| matches!(one.notice(), Notice::Noted { .. }));
    assert!(all.all(|told| told), "kind");
}

#[test]
fn filament_is_counted_absolute_and_relative_and_moves_no_axis() {
    let filament = |text: &str| {
        let mut program = program(text);
        program
            .by_ref()
            .for_each(|step| assert!(step.is_ok(), "{step:?}"));
        program.filament().unwrap()
    };
    let text = "G92 E0\nG1 X10 E0.5 F1800\nX20 E1.2\nG2 X30 Y10 I10 J0 E2.0\n";
    assert_close(&[filament(text)], &[2.0], "absolute");
    let text = "M83\nG1 X10 E0.5 F1800\nG1 E-0.8 F2400\nG1 E0.8\nX20 E0.25\nM82\nG92 E5\nX30 E5.5";
    assert_close(&[filament(text)], &[1.25], "relative");
    assert_close(&[filament("G20\nG1 X1 E1 F60")], &[25.4], "inches");
    assert_close(&[filament("G91\nG1 X1 E1 F60\nX1E1")], &[2.0], "G91");
    let straight = Program::new(&b"G1 X1 F60"[..], FILE, settings());
    assert_eq!(straight.filament(), None, "other programs");
}

#[test]
fn filament_alone_takes_its_time_while_the_axes_rest() {
    let text = "M83\nG1 X10 E0.5 F1800\nG1 E-2 F2400\nG1 X20 F3000\nG1 X20 E1 F600\n";
    assert_close(&rests(text), &[0.05, 0.1], "seconds");
    let last = ends(text);
    assert_close(&last[last.len() - 3..], &[20.0, 0.0, 0.0], "end");
}

#[test]
fn dwells_are_in_milliseconds_and_waiting_is_a_rest() {
    let text = "G4 P500\nG4 S2\nM400\nM109 S200\nM0\n";
    assert_close(&rests(text), &[0.5, 2.0, 0.0, 0.0, 0.0], "seconds");
}

#[test]
fn rapids_keep_the_feedrate_once_there_is_one() {
    let speeds: Vec<f64> = moves("G0 X5\nG0 X10 F7800\nG1 X20 F600\nG0 X30\n")
        .iter()
        .map(|step| step.feedrate().speed())
        .collect();
    let rapid = Feedrate::RAPID.speed();
    assert_close(&speeds, &[rapid, 130.0, 10.0, 10.0], "speeds");
}

#[test]
fn homing_goes_to_zero_of_the_axes_that_it_names() {
    let text = "G1 X10 Y20 Z5 F600\nG92 X0\nG28 X Y\nG1 Z6\nG28\nG1 X1\n";
    let expected = [
        [10.0, 20.0, 5.0],
        [0.0, 0.0, 5.0],
        [0.0, 0.0, 6.0],
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
    ];
    assert_close(&ends(text), &expected.concat(), "ends");
}

#[test]
fn offsets_of_klipper_move_what_follows() {
    let text = "G1 X10 F600\nSET_GCODE_OFFSET Z=0.2\nG1 X20 Z1\nSET_GCODE_OFFSET Z_ADJUST=-0.05 MOVE=1\nG1 X30\n";
    let expected = [
        [10.0, 0.0, 0.0],
        [20.0, 0.0, 1.2],
        [20.0, 0.0, 1.15],
        [30.0, 0.0, 1.15],
    ];
    assert_close(&ends(text), &expected.concat(), "ends");
}

#[test]
fn orders_that_move_an_axis_or_the_part_are_refused() {
    for text in [
        "M206 X5",
        "M290 Z0.1",
        "G61",
        "FORCE_MOVE STEPPER=x DISTANCE=1",
        "SET_KINEMATIC_POSITION X=1",
        "SET_GCODE_OFFSET Q=1",
        "M98 P\"a.g\"",
    ] {
        let refused = program(text).find_map(Result::err).unwrap();
        let reason = refused.reason();
        assert!(matches!(reason, Reason::WordNotSupported { .. }), "{text}");
    }
}

#[test]
fn a_program_without_signs_of_a_printer_has_no_extruder() {
    let language = Language::of(Path::new("a.gcode"), b"G21\nG1 X10 E0.5 F600\n");
    assert_eq!(language, Language::Ngc, "language");
    let language = Language::of(Path::new("a.gcode"), b"; generated by PrusaSlicer\nG1 X1");
    assert_eq!(language, Language::Printer, "slicer");
}

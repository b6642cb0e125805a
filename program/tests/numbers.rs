//! Words that would be read as something else than they say, parameters from outside, and old feedrates.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

#[macro_use]
mod common;

use common::{FILE, lenient, settings, speeds, try_read};
use std::path::Path;
use toolglide_program::{ArithmeticError, Language, Notice, Program, Reason};

#[test]
fn exponents_are_refused_with_their_number() {
    let text = "g21g90f600\ng1x1y2\nG1X2.35e-12\nM02\n";
    refuses!(text, 3, 3, "X2.35e-12", Reason::Exponent { letter: 'X' });
    refuses!("G1 F6E2 X1", 1, 4, "F6E2", Reason::Exponent { letter: 'F' });
    refuses!("G1 X1 Y-.5e+3", 1, 7, "Y-.5e+3", Reason::Exponent { .. });
    refuses!("M67 Q1.5e-3", 1, 5, "Q1.5e-3", Reason::Exponent { .. });
    refuses!("#5 = 1e5", 1, 1, "#5 = 1e5", Reason::Exponent { .. });
    refuses!("G4 P1e3", 1, 4, "P1e3", Reason::Exponent { .. });
    for text in ["G1 X2.35e-12 F60", "G1 X1 E5 F60", "G0 X[1e3]"] {
        assert!(try_read(text, lenient()).is_err(), "lenient: {text}");
    }
    for text in ["M67E0 Q1", "M67 E0 Q1", "M67 Q1 E0"] {
        assert!(try_read(text, settings()).is_ok(), "{text}");
    }
}

#[test]
fn an_extruder_belongs_to_a_printer() {
    refuses!("G1 X1 E5 F60", 1, 7, "E5", Reason::NotSupported { .. });
    refuses!(
        "G1 X2.35 e-12 F60",
        1,
        10,
        "e-12",
        Reason::NotSupported { .. }
    );
}

#[test]
fn an_axis_that_is_not_there_may_be_said_to_be_at_zero() {
    let text = "G0 X1 Y2 A0 W0\nG92 A0\nG28 A0\nG1 X5 A0 F600\n";
    let mut program = Program::new(text.as_bytes(), FILE, settings());
    let moves: Vec<_> = program.by_ref().map(Result::unwrap).collect();
    assert_eq!(moves.len(), 2, "G28 of an absent axis moves none");
    let letters: Vec<_> = program
        .warnings()
        .iter()
        .map(|warning| match warning.notice() {
            Notice::AbsentAxis { letter } => *letter,
            other => panic!("{other}"),
        })
        .collect();
    assert_eq!(letters, ['A', 'W'], "told once each");
    refuses!("G0 X1 W0.1", 1, 7, "W0.1", Reason::NoSuchAxis { .. });
}

#[test]
fn a_feedrate_is_remembered_through_inverse_time() {
    let text = "G21 G90 F600\nG1 X10\nG93 G1 X20 F120\nG94 G1 X30\nX40\nM2\n";
    common::assert_close(&speeds(text), &[10.0, 20.0, 10.0, 10.0], "speeds");
    let mut program = Program::new(text.as_bytes(), FILE, settings());
    program
        .by_ref()
        .for_each(|step| assert!(step.is_ok(), "{step:?}"));
    let [warning] = program.warnings() else {
        panic!("{:?}", program.warnings())
    };
    let feedrate = 600.0;
    assert_eq!(warning.notice(), &Notice::OldFeedrate { feedrate }, "told");
    assert_eq!(warning.place().line(), 4, "where it is used first");
    let written = "F600 G1 X10\nG93 G1 X20 F120\nG94 G1 X30 F300\n";
    let mut program = Program::new(written.as_bytes(), FILE, settings());
    program
        .by_ref()
        .for_each(|step| assert!(step.is_ok(), "{step:?}"));
    assert!(program.warnings().is_empty(), "written anew");
}

#[test]
fn a_tolerance_of_nothing_is_an_exact_stop() {
    let text = "G64 P0\nG1 X3 F100\nG64 P0.1\nX5\n";
    let mut program = Program::new(text.as_bytes(), FILE, settings());
    let stops: Vec<bool> = program.by_ref().map(|step| step.unwrap().stops()).collect();
    assert_eq!(stops, [true, false], "stops");
    assert_eq!(program.warnings()[0].notice(), &Notice::NoTolerance, "told");
    let mut overridden = settings();
    overridden.override_tolerance = true;
    let moves = try_read(text, overridden).unwrap();
    assert!(
        !moves[0].stops(),
        "the tolerance of the command line counts"
    );
}

#[test]
fn parameters_may_be_given_from_outside() {
    let text = "F#<_hal[plasmac.cut-feed-rate]>\nG1 X#31 Y#<depth>\n";
    let program = || Program::new(text.as_bytes(), FILE, settings());
    let moves: Vec<_> = program()
        .with_parameter("#<_hal[plasmac.cut-feed-rate]>", 1200.0)
        .and_then(|program| program.with_parameter("31", 7.0))
        .and_then(|program| program.with_parameter("Depth", -2.0))
        .unwrap()
        .map(Result::unwrap)
        .collect();
    common::assert_close(&[moves[0].feedrate().speed()], &[20.0], "feedrate");
    let end = moves[0].end(toolglide_kinematics::Vector::zeros());
    common::assert_close(&[end[0], end[1]], &[7.0, -2.0], "end");
    let refused = program().find_map(Result::err).unwrap().to_string();
    assert!(refused.contains("--parameter"), "{refused}");
    for (name, value) in [("5420", 1.0), ("6000", 1.0), ("0", 1.0), ("_x", 1.0)] {
        assert!(program().with_parameter(name, value).is_err(), "{name}");
    }
    let bad = program().with_parameter("a>b", 1.0).unwrap_err();
    assert!(matches!(bad, ArithmeticError::BadName { .. }), "{bad}");
    assert!(program().with_parameter("a", f64::NAN).is_err(), "value");
}

#[test]
fn a_language_that_is_not_read_is_named_in_one_sentence() {
    let text = "0 BEGIN PGM TEST MM\n1 TOOL CALL 1 Z S3000\n2 L X+0 Y+0 R0 FMAX\n";
    let language = Language::of(Path::new("a.h"), text.as_bytes());
    let program = Program::new(text.as_bytes(), FILE, settings())
        .in_language(language)
        .past_refusals();
    let refusals: Vec<String> = program
        .filter_map(Result::err)
        .map(|error| error.to_string())
        .collect();
    let expected = "part.ngc:1:1: this is Heidenhain Klartext, which is not read";
    assert_eq!(refusals, [expected], "one sentence");
    let poses = toolglide_program::Poses::new(text.as_bytes(), FILE, settings(), language);
    assert_eq!(poses.filter_map(Result::err).count(), 1, "as poses");
}

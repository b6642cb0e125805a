//! Checks the text of refusals, and what comes after one; what is refused is in `refused_*`.

mod common;

use common::{refusal, refusal_with, settings};
use toolglide_kinematics::{ToolpathError, Vector};
use toolglide_program::{Program, Reason};

#[test]
fn a_start_that_is_no_point_is_refused_at_the_first_move() {
    let mut nowhere = settings();
    nowhere.start = Vector::<3>::new(0.0, f64::NAN, 0.0);
    let (line, _, _, reason) = refusal_with("\nG0 X1", nowhere);
    assert_eq!(
        (line, reason),
        (2, Reason::Path(ToolpathError::NotFinite)),
        "reason"
    );
}

#[test]
fn after_a_refusal_nothing_more_is_read() {
    let mut program = Program::new(&b"G0 X1\nG4 P1 G1 X2\nX3"[..], "a", settings());
    assert!(program.next().unwrap().is_ok(), "before");
    assert!(
        program.next().unwrap().is_err(),
        "no part of a refused block is a move"
    );
    assert!(
        program.next().is_none() && program.next().is_none(),
        "after"
    );
    assert_eq!(program.lines(), 2, "lines");
}

#[test]
fn messages_tell_place_quantity_value_and_bound() {
    let shown = |text: &str| {
        let (line, column, _, reason) = refusal(text);
        format!("{line}:{column}: {reason}")
    };
    assert_eq!(
        shown("\n G1 X1 F-20"),
        "2:8: feedrate is -20, but must not be negative",
        "F"
    );
    assert_eq!(shown("G4"), "1:1: G4 needs a P word", "G4");
    assert_eq!(
        shown("F9\nG2 X10 R4"),
        "2:8: arc radius is 4 mm, but half the distance from start to end is 5 mm; it may be short \
         by 0.005 mm",
        "R"
    );
    assert_eq!(
        shown("T2.5"),
        "1:1: tool number is 2.5, but must be a whole number from 0 to 999999",
        "T"
    );
}

/// Lines of refusals, and whether each may follow from one before it.
fn all_refusals(text: &str) -> Vec<(u64, bool)> {
    Program::new(text.as_bytes(), "a", settings())
        .past_refusals()
        .filter_map(Result::err)
        .map(|refused| (refused.line(), refused.is_consequence()))
        .collect()
}

#[test]
fn what_follows_from_a_refusal_is_told_apart() {
    for (text, expected) in [
        ("G1 X1\nX2\nX3\n", &[(1, false), (2, true), (3, true)][..]),
        (
            "G1 F100 X1 ~\nX2\nG1 X3\nF9 X4\n",
            &[(1, false), (2, true), (3, true)],
        ),
        (
            "F60\n#<a>=[1+\nG1 X#<a>\nX#<b>\n",
            &[(2, false), (3, true), (4, false)],
        ),
        (
            "F60 G1 X10 U1\nG2 X5 Y5 R1\nG2 X0 Y50 R1\n",
            &[(1, false), (2, true), (3, false)],
        ),
        (
            "o1 if [1+]\nG0 X1\no1 endif\no2 endif\n",
            &[(1, false), (3, true), (4, false)],
        ),
    ] {
        assert_eq!(all_refusals(text), expected, "{text:?}");
    }
}

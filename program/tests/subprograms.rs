//! Subprograms with a number, called by `M98`.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{assert_close, ends, read, refusal, try_read};
use toolglide_program::{FlowError, Reason};

/// X of each move.
fn x(text: &str) -> Vec<f64> {
    ends(text).iter().map(|end| end[0]).collect()
}

fn reason(text: &str) -> FlowError {
    match refusal(text).3 {
        Reason::Flow(reason) => reason,
        other => panic!("{text:?}: {other}"),
    }
}

#[test]
fn a_subprogram_stands_below_its_call_and_runs_as_often_as_it_is_asked() {
    let text = "%\nO1 (main)\nG0 X1\nM98 P100 L3\nM98 P100\nM98 P100 L0\nG90 X50\nM30\n\
                O100\nG91 X2\nM99\n%\n";
    assert_close(&x(text), &[1.0, 3.0, 5.0, 7.0, 9.0, 50.0], text);
    let lines: Vec<u32> = read(text).iter().map(|step| step.line()).collect();
    assert_eq!(lines, [3, 10, 10, 10, 10, 7], "lines of the file");
}

#[test]
fn parameters_are_those_of_the_caller() {
    let text = "#1=0\nM98 P100 L5\nG0 X#1\nM30\n\
                O100\n#1=[#1+1]\nM98 P200 L5\nM99\nO200\n#1=[#1+0.01]\nM99\n";
    assert_close(&x(text), &[5.25], "the example of the manual");
}

#[test]
fn a_call_comes_after_the_motion_of_its_block() {
    assert_close(
        &x("G0 X1 M98 P7\nX3\nM2\nO7\nX2\nM99\n"),
        &[1.0, 2.0, 3.0],
        "motion first",
    );
}

#[test]
fn subprograms_are_called_from_loops_and_conditions_and_hold_some() {
    let text = "#1=0\nO10 while [#1 lt 2]\n#1=[#1+1]\nM98 P5\nO10 endwhile\nG0 X9\nM2\n\
                O5\nO11 repeat [2]\nG0 X#1\nO11 endrepeat\nO12 if [#1 eq 2]\nX20\nO12 endif\nM99\n";
    assert_close(&x(text), &[1.0, 1.0, 2.0, 2.0, 20.0, 9.0], text);
}

#[test]
fn a_saved_state_comes_back_with_the_end_of_a_subprogram() {
    let text = "G90 G0 X1\nM98 P5 L2\nX3\nM2\nO5\nM73\nG91 X10\nM99\n";
    assert_close(&x(text), &[1.0, 11.0, 21.0, 3.0], "G90 again");
}

#[test]
fn subprograms_that_are_not_there_or_not_ended_are_refused() {
    let number = 5;
    let missing = FlowError::NoSubprogram { number };
    assert_eq!(reason("O5\nG0 X1\nM98 P5\nM2\n"), missing, "above its call");
    assert_eq!(
        reason("M98 P5\nM2\nO5\nG0 X1\n"),
        FlowError::NoReturn { number },
        "no M99"
    );
    assert_eq!(
        reason("M98 P5\nM2\nO5\nG0 X1\nO6\nM99\n"),
        FlowError::NoReturn { number },
        "another one begins"
    );
    assert_eq!(reason("G0 X1\nM99\n"), FlowError::EndlessProgram, "main");
    assert_eq!(
        reason("O9 sub\nM99\nO9 endsub\nO9 call\n"),
        FlowError::MixedReturn,
        "of the other kind"
    );
    let (line, column, word, reason) = refusal("G0 X1\n M98 L2\n");
    assert_eq!((line, column, word.as_str()), (2, 2, "M98"), "place");
    assert!(
        matches!(reason, Reason::WordMissing { letter: 'P', .. }),
        "P"
    );
    let (.., reason) = refusal("M98 P5 L99999999\nM2\nO5\nM99\n");
    let most = "number of repetitions is 99999999, but must be a whole number from 0 to 9999";
    assert_eq!(reason.to_string(), most, "repetitions");
    let (.., reason) = refusal("M98 P1.5\n");
    assert!(matches!(reason, Reason::NotWhole { .. }), "{reason}");
}

#[test]
fn subprograms_that_call_each_other_without_end_are_refused() {
    let text = "M98 P1\nM2\nO1\nM98 P2\nM99\nO2\nM98 P1\nM99\n";
    assert_eq!(reason(text), FlowError::TooDeep { bound: 100 }, "depth");
}

#[test]
fn behind_the_end_of_a_program_nothing_is_read() {
    let text = "M98 P5\nG0 X2\nM30\nO5\nG0 X1\nM99\n~\n";
    assert_eq!(
        try_read(text, common::settings()).unwrap().len(),
        2,
        "moves"
    );
}

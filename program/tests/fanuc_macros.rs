//! Macro B of FANUC and Haas: variables, statements, calls.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a failed unwrap is a failed test"
)]

mod common;
mod common_fanuc;

use common::assert_close;
use common_fanuc::{assert_ends, ends, moves, noted, program, refusal, refuses};
use toolglide_program::{FlowError, Reason};

/// The value of an expression, by way of a move.
fn value(before: &str, expression: &str) -> f64 {
    let text = format!("{before}\n#199={expression}\nG0 X#199 Y1.\n");
    ends(&text).last().unwrap()[0]
}

#[test]
fn loops_run_while_their_condition_holds() {
    let text = "O42\n#1=0\nWHILE [#1 LT 6] DO1\nG0 X[10.*COS[#1*60.]] Y[10.*SIN[#1*60.]]\n#1=#1+1\nEND1\nM30\n";
    let found = ends(text);
    assert_eq!(found.len(), 6, "holes");
    for (hole, end) in (0_u8..).zip(&found) {
        let angle = (f64::from(hole) * 60.0).to_radians();
        let off = (end[0] - 10.0 * angle.cos()).hypot(end[1] - 10.0 * angle.sin());
        assert!(off < 1e-9, "{end:?}");
    }
    let nested = "#1=0\nWHILE[#1LT2]DO1\n#2=0\nDO2\n#2=#2+1\nIF[#2GT2]GOTO 5\nG0X#2Y#1\nEND2\nN5#1=#1+1\nEND1\n";
    assert_ends(
        nested,
        &[
            [1.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [2.0, 1.0, 0.0],
        ],
    );
    assert_ends("WHILE [0] DO1\nG0 X1\nEND1\nG0 X2\n", &[[2.0, 0.0, 0.0]]);
}

#[test]
fn jumps_go_forwards_and_back_to_block_numbers() {
    let text = "#101=0\nN10 #101=#101+1\nG1 X[#101*5.] F500\nIF [#101 LT 4] GOTO 10\n\
                IF [#101 EQ 4] THEN #102=1\nG1 Y#102\nM30\n";
    assert_ends(
        text,
        &[
            [5.0, 0.0, 0.0],
            [10.0, 0.0, 0.0],
            [15.0, 0.0, 0.0],
            [20.0, 0.0, 0.0],
            [20.0, 1.0, 0.0],
        ],
    );
    assert_ends("#1=20\nGOTO #1\nN10 G0 X1\nN20 G0 X2\n", &[[2.0, 0.0, 0.0]]);
    assert_ends("GOTO[10*2]\nG0 X9\nN0020 G0 X2\n", &[[2.0, 0.0, 0.0]]);
    // Of two blocks with one number the next one is meant.
    assert_ends(
        "N5 G0 X1\nGOTO 7\nN7 X2\nM30\nN7 X3\n",
        &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
    );
    refuses("GOTO 99\nM30\nO2\nN99 G0 X1\n", 1, "no line N99");
}

#[test]
fn a_condition_may_be_followed_by_any_statement() {
    let text = "#1=5\nIF [#1 EQ 5] THEN G0 X1\nIF [#1 NE 5] THEN G0 X9\nIF [[#1 GT 1] AND [#1 LT 9]] THEN #2=7\nG0 X#2\n\
                IF [#1 EQ 5] M30\nG0 X8\n";
    assert_ends(text, &[[1.0, 0.0, 0.0], [7.0, 0.0, 0.0]]);
}

#[test]
fn words_of_null_are_left_out() {
    assert_ends(
        "G0 X5. Y5.\nX#1 Y1.\n#1=0\nX#1\n#1=#0\nX#1 Z2.\n",
        &[
            [5.0, 5.0, 0.0],
            [5.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, 2.0],
        ],
    );
    for (condition, holds) in [
        ("#1 EQ #0", 1.0),
        ("#1 EQ 0", 0.0),
        ("#1 NE 0", 1.0),
        ("#1 GE 0", 1.0),
        ("#1 GT 0", 0.0),
    ] {
        let found = value("", &format!("[{condition}]"));
        assert!((found - holds).abs() < 1e-12, "{condition}");
    }
    assert!(
        (value("#1=#2", "#1*5+3") - 3.0).abs() < 1e-12,
        "counts as 0"
    );
}

#[test]
fn round_in_a_word_rounds_to_the_least_increment() {
    assert_ends(
        "#1=1.23456\nG0 X[ROUND[#1]] Y#1\n#2=ROUND[#1]\nX#2\n",
        &[[1.235, 1.23456, 0.0], [1.0, 1.23456, 0.0]],
    );
    assert_ends(
        "G20\n#1=1.23456\nG0 X[ROUND[#1]]\n",
        &[[1.2346 * 25.4, 0.0, 0.0]],
    );
}

#[test]
fn macros_have_arguments_and_variables_of_their_own() {
    let text = "G0 X0 Y0\n#1=77.\n#100=3.\nG65 P9010 A10. B20. F500.\nX#1 Y#100\nM30\n\
                O9010\nG1 X#1 Y#2 F#9\n#1=5.\n#100=4.\nM99\n";
    let list = moves(text);
    assert!(
        (list[1].feedrate().speed() * 60.0 - 500.0).abs() < 1e-9,
        "F is #9"
    );
    assert_ends(text, &[[0.0; 3], [10.0, 20.0, 0.0], [77.0, 4.0, 0.0]]);
    // List II, repetitions, and a level within a level.
    let text = "G65 P9011 I1. J2. I3. L2\nM30\nO9011\nG0 X#4 Y#5 Z#7\nG65 P9012 X[#4+8.]\nM99\nO9012\nG0 X#24\n#4=0\nM99\n";
    assert_ends(
        text,
        &[
            [1.0, 2.0, 3.0],
            [9.0, 2.0, 3.0],
            [1.0, 2.0, 3.0],
            [9.0, 2.0, 3.0],
        ],
    );
}

#[test]
fn subprograms_share_the_variables_of_their_caller() {
    let text = "#1=5.\nM98 P1000 L2\nX#1\nM30\nO1000\nG0 X#1\n#1=#1+1.\nM99\n";
    assert_ends(text, &[[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [7.0, 0.0, 0.0]]);
}

#[test]
fn repetitions_may_stand_before_the_number_of_a_subprogram() {
    let text = "G0 X0\nM98 P31001\nM98 P1000 L2\nM98 P00021000\nM30\nO1000\nG91 G1 X5. F600\nG90\nM99\n\
                O1001\nG91 G1 Y2. F600\nG90\nM99\n";
    let found = ends(text);
    assert_close(found.last().unwrap(), &[20.0, 6.0, 0.0], "3 and 2 and 2");
    // A program whose number has five digits is that one.
    assert_ends(
        "M98 P12345\nM30\nO12345\nG0 X1\nM99\nO2345\nG0 X9\nM99\n",
        &[[1.0, 0.0, 0.0]],
    );
}

#[test]
fn local_subprograms_begin_at_a_block_of_their_program() {
    let text = "G0 X0\nM97 P100 L2\nX9.\nM30\nN100 G91 X1.\nN110 G90 M99\n";
    assert_ends(
        text,
        &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [9.0, 0.0, 0.0]],
    );
    refuses("M97 P100\nM30\n", 1, "no line N100");
}

#[test]
fn a_return_may_lead_to_a_block_of_the_caller() {
    let text = "M98 P1\nG0 X9.\nN50 G0 X1.\nM30\nO1\nM99 P50\n";
    assert_ends(text, &[[1.0, 0.0, 0.0]]);
    let text = "#1=0\nN10 #1=#1+1\nIF [#1 GT 2] GOTO 20\nG0 X#1\nM99 P10\nN20 M30\n";
    assert_ends(text, &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
}

#[test]
fn a_modal_macro_runs_after_each_motion_until_it_ends() {
    let text = "G0 X0 Y0\nG66 P9100 Z-2. R1.\nX10.\nY10.\nM8\nG67\nX0\nM30\n\
                O9100\nG0 Z#18\nG1 Z#26 F100\nG0 Z5.\n#33=#33+1\nM99\n";
    let found = ends(text);
    let bottoms: Vec<_> = found.iter().filter(|end| end[2] < -1.0).collect();
    assert_eq!(bottoms.len(), 2, "{found:?}");
    assert_close(found.last().unwrap(), &[0.0, 10.0, 5.0], "end");
    refuses("G66 P1\nG66 P1\nO1\nM99\n", 2, "within another");
}

#[test]
fn programs_beside_the_file_are_found() {
    assert_ends(
        "G65 P7000 A1. B2.\n#1=4.\n#2=5.\nM98 P7000\nM198 P7000\n",
        &[[1.0, 3.0, 0.0], [4.0, 6.0, 0.0], [4.0, 6.0, 0.0]],
    );
    // The one in the file is nearer.
    assert_ends("M98 P7000\nM30\nO7000\nG0 X8.\nM99\n", &[[8.0, 0.0, 0.0]]);
}

#[test]
fn variables_of_the_control_tell_what_is_known() {
    let before = "G91 G1 X3. F120.\nG90 G18 G55 G43 H0 Z1. S500\nT7 M6";
    for (variable, expected) in [
        (4001, 1.0),
        (4002, 18.0),
        (4003, 90.0),
        (4006, 21.0),
        (4008, 43.0),
        (4009, 80.0),
        (4014, 55.0),
        (4109, 120.0),
        (4119, 500.0),
        (4120, 7.0),
        (5001, 3.0),
        (5023, 1.0),
        (5043, 1.0),
        (5221, 0.0),
    ] {
        let found = value(before, &format!("#{variable}"));
        assert!((found - expected).abs() < 1e-9, "#{variable}: {found}");
    }
    assert!(
        (value("G20\nG0 X2.", "#5041*10.") / 25.4 - 20.0).abs() < 1e-9,
        "inch"
    );
    for variable in [1000, 2001, 3001, 3011, 5061, 5101, 40_000, 50] {
        refuses(&format!("#1=#{variable}"), 1, "not known before");
    }
    refuses("#5041=1", 1, "cannot be set");
    assert_eq!(
        noted("#3004=7\n#3004=0\n#1132=1\nDPRNT[X#1[53]]\n").len(),
        3,
        "noted"
    );
}

#[test]
fn variables_may_be_given_before_the_program_begins() {
    let given = program("G0 X#500 Y[#1*2.]\n")
        .with_parameter("#500", 7.0)
        .and_then(|program| program.with_parameter("1", 3.0));
    let moves: Vec<_> = given.unwrap().map(Result::unwrap).collect();
    let end = moves[0].end(toolglide_kinematics::Vector::zeros());
    assert_close(end.as_slice(), &[7.0, 6.0, 0.0], "given");
    assert!(program("").with_parameter("3000", 1.0).is_err(), "alarm");
}

#[test]
fn an_alarm_ends_the_program_with_its_text() {
    let text = "G0 X1.\nIF [#1 EQ #0] THEN #3000=21 (NO RADIUS)\nX2.\n";
    let (line, column, _, reason) = refusal(text);
    assert_eq!((line, column), (2, 20), "{reason}");
    assert_eq!(
        reason.to_string(),
        "the program raises its alarm 21: NO RADIUS"
    );
    assert_eq!(
        moves("G0 X1.\n#3006=1 (TURN THE PART)\nX2.\n").len(),
        3,
        "a rest"
    );
}

#[test]
fn loops_without_end_are_refused_at_once() {
    for text in [
        "WHILE [1 EQ 1] DO1\nEND1\n",
        "DO1\n#1=#1+1\nEND1\n",
        "N10 GOTO 10\n",
        "G0 X1\nN10 M99 P10\n",
        "N1 #1=1-#1\nGOTO 1\n",
        "M98 P1 L9999\nM30\nO1\nM98 P2 L9999\nM99\nO2\nM99\n",
        "G0 X1.\nDO1\nG0 X1.\nEND1\n",
    ] {
        let (.., reason) = refusal(text);
        let endless = matches!(
            reason,
            Reason::Flow(FlowError::NoMotion { .. } | FlowError::Endless)
        );
        assert!(endless, "{text:?}: {reason}");
    }
    refuses("O1\nM98 P1\nM99\n", 2, "deep");
    refuses("G0 X1\nM99\n", 2, "without end");
    assert!(
        program("DO1\nEND1\n").past_refusals().count() < 3,
        "check ends too"
    );
}

#[test]
fn statements_that_are_none_are_refused_at_their_place() {
    for (text, line, says) in [
        ("WHILE [#1 LT 2]\nEND1\n", 1, "DO"),
        ("WHILE #1 DO1\n", 1, "condition"),
        ("DO1\nG0 X1\n", 1, "END1 is missing"),
        ("DO1\nDO1\nEND1\nEND1\n", 1, "END1 is missing"),
        ("END1\n", 1, "does not run"),
        ("DO4\nEND4\n", 1, "number of a loop"),
        ("IF [#1 EQ 0]\n", 1, "nothing follows"),
        ("IF [1 EQ 1 GOTO 5\n", 1, "operator"),
        ("GOTO\n", 1, "whole number"),
        ("#1=\n", 1, "missing here"),
        ("#1 5\n", 1, "\"=\""),
        ("#1=1 G0 X1\n", 1, "stands alone"),
        ("#0=1\n", 1, "cannot be set"),
        ("#1=1/0\n", 1, "division"),
        ("G65 A1\n", 1, "P word"),
        ("G65 P1234\n", 1, "no macro O1234"),
        ("G65 P9810 Z-5.\n", 1, "probe"),
        ("M98 P1234\n", 1, "O1234"),
        ("M98\n", 1, "P word"),
        ("M98 P1\nM30\nO1\nG0 X1\nO2\nM99\n", 5, "without M99"),
        ("M98 P1\nM30\nO1\nG0 X1\n", 4, "without M99"),
        ("ENDIF\n", 1, "not supported"),
        ("SETUP FOR PART\n", 1, "not supported"),
    ] {
        refuses(text, line, says);
    }
}

//! Parameters, expressions, and O words.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{FILE, assert_close, assert_ends, ends, read, refusal, refusal_with, settings};
use toolglide_program::{ArithmeticError, FlowError, Program, Reason};

/// X of each move.
fn x(text: &str) -> Vec<f64> {
    ends(text).iter().map(|end| end[0]).collect()
}

fn assert_x(text: &str, expected: &[f64]) {
    assert_close(&x(text), expected, text);
}

#[test]
fn operators_bind_as_the_language_says() {
    for (expression, value) in [
        ("1+2*3", 7.0),
        ("2**3**2", 64.0),
        ("-2**2", 4.0),
        ("[1+2]*3", 9.0),
        ("-7 mod 3", 2.0),
        ("1 or 0 and 0", 0.0),
        ("1 gt 0+5", 0.0),
        ("1.00005 eq 1", 1.0),
        ("1.001 ne 1", 1.0),
        ("2 xor 0", 1.0),
        ("7-2-1", 4.0),
        ("-[2+1]", -3.0),
    ] {
        assert_x(&format!("G0 X[{expression}]"), &[value]);
    }
}

#[test]
fn functions_take_degrees_and_round_away_from_zero() {
    for (expression, value) in [
        ("sin[30]", 0.5),
        ("acos[0]", 90.0),
        ("atan[1]/[-1]", 135.0),
        ("fix[-2.5]", -3.0),
        ("fup[-2.5]", -2.0),
        ("round[-2.5]", -3.0),
        ("abs[-1]+sqrt[16]", 5.0),
        ("exp[ln[3]]", 3.0),
        ("exists[#<a>]", 0.0),
        ("exists[#1]", 1.0),
    ] {
        assert_x(&format!("G0 X[{expression}]"), &[value]);
    }
}

#[test]
fn parameters_change_once_their_line_is_read() {
    assert_x("#1=5 #2=[#1+1]\nG0 X#1 #1=9\nX#1 Y#2", &[5.0, 9.0]);
    assert_close(
        &[ends("#1=5 #2=[#1+1]\nG0 X1 Y#2")[0][1]],
        &[1.0],
        "the old value",
    );
    assert_x("#1=2 #2=7\nG0 X##1", &[7.0]);
    assert_x("#<Inner Radius>=3\nG0 X#<innerradius>", &[3.0]);
    assert_x("G20 G0 X2\nX[#5420+#<_x>+1]", &[50.8, 127.0]);
    assert_x("G[0+1] X1 F[60*10]\nG#31 X2", &[1.0, 2.0]);
}

#[test]
fn conditions_take_the_first_branch_that_holds() {
    let text = |value: u8| {
        format!(
            "#1={value}\no1 if [#1 eq 1]\nG0 X10\no1 elseif [#1 eq 2]\nG0 X20\no1 else\no2 if [#1 gt 5]\n\
             G0 X30\no2 endif\nG0 X40\no1 endif\nG0 X50"
        )
    };
    assert_x(&text(1), &[10.0, 50.0]);
    assert_x(&text(2), &[20.0, 50.0]);
    assert_x(&text(3), &[40.0, 50.0]);
    assert_x(&text(6), &[30.0, 40.0, 50.0]);
}

#[test]
fn loops_run_break_and_continue() {
    assert_x(
        "#1=0\no1 while [#1 lt 3]\n#1=[#1+1]\nG0 X#1\no1 endwhile",
        &[1.0, 2.0, 3.0],
    );
    assert_x(
        "#1=0\no1 do\n#1=[#1+1]\nG0 X#1\no1 while [#1 lt 2]\nX9",
        &[1.0, 2.0, 9.0],
    );
    assert_x(
        "G91 G0\no1 repeat [3]\nX1\no1 endrepeat\no2 repeat [0]\nX5\no2 endrepeat",
        &[1.0, 2.0, 3.0],
    );
    let text = "#1=0\no1 while [1]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\no3 if [#1 gt 3]\n\
                o1 break\no3 endif\nG0 X#1\no1 endwhile\nX8";
    assert_x(text, &[1.0, 3.0, 8.0]);
    let text = "#1=0\no1 repeat [3]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\nG0 X#1\no1 endrepeat";
    assert_x(text, &[1.0, 3.0]);
    let text = "#1=0\no1 do\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\nG0 X#1\no1 while [#1 lt 3]";
    assert_x(text, &[1.0, 3.0]);
}

#[test]
fn loops_within_loops_repeat_all_of_it() {
    let text = "G91 G0\no1 repeat [2]\no2 repeat [3]\nX1\no2 endrepeat\nX10\no1 endrepeat";
    assert_x(text, &[1.0, 2.0, 3.0, 13.0, 14.0, 15.0, 16.0, 26.0]);
}

#[test]
fn subroutines_have_arguments_locals_and_values() {
    let text = "o<step> sub\n#<a>=[#1*2]\nG0 X#<a>\no<step> return [#<a>+1]\nG0 X99\no<step> endsub\n\
                #1=7\no<step> call [4]\nG0 X#<_value>\nX#1";
    assert_x(text, &[8.0, 9.0, 7.0]);
    let text = "o1 sub\no2 if [#1 gt 0]\nG0 X#1\no1 call [#1-1]\no2 endif\no1 endsub\no1 call [3]";
    assert_x(text, &[3.0, 2.0, 1.0]);
    assert_x("o[50+50] sub\nG0 X1\no100 endsub\n#5=100\no#5 call", &[1.0]);
}

#[test]
fn moves_of_a_loop_know_their_lines() {
    let moves = read("G91 G0\no1 repeat [2]\nX1\no1 endrepeat\nX2");
    let lines: Vec<u32> = moves.iter().map(toolglide_kinematics::Move::line).collect();
    assert_eq!(lines, [3, 3, 5], "lines");
}

#[test]
fn subroutines_of_other_files_are_found_by_their_name() {
    let file = b"(pocket)\r\no<pocket> sub\r\nG0 X#1\r\nG0 X[\r\no<pocket> endsub\r\n".to_vec();
    let text = "G0 X1\n\no<pocket> call [5]\n";
    let mut program = Program::new(text.as_bytes(), FILE, settings())
        .with_subroutines(move |name| Ok((name == "pocket").then(|| file.clone())));
    let lines: Vec<u32> = program
        .by_ref()
        .take(2)
        .map(|step| step.unwrap().line())
        .collect();
    assert_eq!(lines, [1, 3], "the line of the call");
    let error = program.next().unwrap().unwrap_err();
    assert_eq!(
        (error.file(), error.line(), error.column()),
        ("pocket.ngc", 4, 6),
        "{error}"
    );
}

#[test]
fn the_state_is_saved_and_restored() {
    assert_x("G91 M70\nG90 G0 X5\nM72\nG0 X1", &[5.0, 6.0]);
    assert_x(
        "G90\no1 sub\nM73\nG91 G0 X1\no1 endsub\nG0 X5\no1 call\nX2",
        &[5.0, 6.0, 2.0],
    );
}

/// Why a program is refused that goes round and round.
fn endless(text: &str) -> FlowError {
    match refusal(text).3 {
        Reason::Flow(reason) => reason,
        other => panic!("{text:?}: {other}"),
    }
}

#[test]
fn a_loop_that_changes_nothing_is_refused_before_it_has_run_three_times() {
    for text in [
        "o1 while [1]\no1 endwhile",
        "o1 while [1]\n#1=2\no1 endwhile",
        "o1 do\no1 while [1]",
        "o1 do\nG1 F100 X10\nG0 X0\no1 while [1]",
        "o1 while [1]\no2 repeat [3]\nG91 G0 X1\no2 endrepeat\nG90 X0\no1 endwhile",
        "o9 sub\n#1=[#1+1]\nG0 X#1\no9 endsub\no1 while [1]\no9 call [4]\nX0\no1 endwhile",
        "o1 while [1]\nM98 P5\no1 endwhile\nM2\nO5\nG4 P1\nM99",
    ] {
        let mut program = Program::new(text.as_bytes(), FILE, settings());
        let last = program.by_ref().last().unwrap().unwrap_err();
        let expected = Reason::Flow(FlowError::Endless);
        assert_eq!(last.reason(), &expected, "{text:?}: {last}");
        assert!(program.blocks() < 60, "{text:?}: {}", program.blocks());
    }
}

#[test]
fn a_loop_that_comes_to_an_end_is_never_taken_for_endless() {
    // The state repeats but for one parameter, a tool length, a saved mode, or a place.
    for text in [
        "#5000=0\no1 while [#5000 lt 300]\nG0 X1\nX0\n#5000=[#5000+1]\no1 endwhile",
        "#<n>=0\no1 while [#<n> lt 300]\nG0 X1\nX0\n#<n>=[#<n>+1]\no1 endwhile",
        "o1 while [#5403 lt 3]\nG10 L1 P7 Z[#5403+0.01]\nG43 H7\no1 endwhile",
        "G91\no1 while [#5420 lt 300]\nG0 X1\no1 endwhile",
        "o9 sub\no1 if [#1 gt 0]\no9 call [#1-1]\no1 endif\no9 endsub\no9 call [90]",
        "o1 repeat [300]\nG0 X1\nX0\no1 endrepeat",
        "M98 P5 L300\nM2\nO5\nG0 X1\nX0\nM99",
    ] {
        read(text);
    }
}

#[test]
fn lines_that_are_run_again_without_a_move_are_counted() {
    let bound = settings().still_steps;
    let expected = FlowError::NoMotion { bound };
    for text in [
        "o1 while [1]\n#1=[#1+1]\no1 endwhile",
        "o1 repeat [1000000000]\n(nothing)\no1 endrepeat",
        "o1 while [1]\n#1=[#1+1]\nG1 F100 X0\nG4 P0\no1 endwhile",
        "M98 P5 L9999\nM2\nO5\nM98 P6 L9999\nM99\nO6\nM99",
    ] {
        assert_eq!(endless(text), expected, "{text:?}");
    }
    let counts = |lines: u64| format!("o1 repeat [{}]\n#1=[#1+1]\no1 endrepeat\nG0 X1", lines / 2);
    read(&counts(bound - 2));
    assert_eq!(endless(&counts(bound + 2)), expected, "a little more");
    // A move begins the count anew, and a long line counts as several.
    read(&format!(
        "o1 repeat [3]\n{}\no1 endrepeat",
        counts(bound - 20).replace("o1", "o2") + " G91"
    ));
    let long = format!("#1=[#1+1]{}", " ".repeat(6400));
    let text = format!("o1 repeat [{}]\n{long}\no1 endrepeat", bound / 100);
    assert_eq!(endless(&text), expected, "long lines");
}

#[test]
fn lines_that_are_run_again_are_counted_in_all() {
    let mut few = settings();
    few.steps = 1000;
    let text = "G91\no1 while [1]\nG0 X1\no1 endwhile";
    let (.., reason) = refusal_with(text, few);
    let expected = Reason::Flow(FlowError::TooManySteps { bound: 1000 });
    assert_eq!(reason, expected, "{text:?}");
    let (line, column, _, reason) = refusal("o1 sub\no1 call\no1 endsub\no1 call");
    assert_eq!((line, column), (2, 1), "{reason}");
    assert!(
        matches!(reason, Reason::Flow(FlowError::TooDeep { .. })),
        "{reason:?}"
    );
}

#[test]
fn wrong_o_words_are_refused_at_their_place() {
    for (text, expected) in [
        (
            "o1 jump",
            "1:4: not known after a label: write SUB, ENDSUB, CALL, RETURN, IF, ELSEIF, ELSE, ENDIF, WHILE, ENDWHILE, DO, REPEAT, ENDREPEAT, BREAK or CONTINUE",
        ),
        (
            "o if [1]",
            "1:1: O needs a number, or a name in angle brackets, after it",
        ),
        ("o1 endif", "1:1: ENDIF of O1 without its IF"),
        (
            "o1 while [1]\nG0 X1",
            "1:1: WHILE of O1 is not closed: ENDWHILE is missing",
        ),
        (
            "o1 sub\nG0 X1",
            "1:1: SUB of O1 is not closed: ENDSUB is missing",
        ),
        (
            "o1 if [0]\no2 endif",
            "1:1: IF of O1 is not closed: ENDIF is missing",
        ),
        (
            "o<no> call",
            "1:1: there is no subroutine O<no>: neither in this program nor in a file of that name",
        ),
        ("o1 if", "1:1: IF needs an expression in brackets after it"),
        ("o1 return", "1:1: RETURN of O1 without its SUB"),
        (
            "o1 repeat [2**60]\no1 endrepeat",
            "1:1: repetitions are 1152921504606847000, but may be 1000000000000000 at most",
        ),
        (
            "o1 break",
            "1:1: BREAK of O1 without its WHILE, DO or REPEAT",
        ),
        (
            "G0 X1 o1 call",
            "1:7: O words behind other words are not supported",
        ),
    ] {
        let (line, column, _, reason) = refusal(text);
        assert_eq!(format!("{line}:{column}: {reason}"), expected, "{text:?}");
    }
}

#[test]
fn wrong_expressions_are_refused_at_their_place() {
    for (text, place, expected) in [
        ("G0 X[1+", (1, 8), ArithmeticError::ValueMissing),
        ("G0 X[1 2 foo 3]", (1, 10), ArithmeticError::UnknownOperator),
        ("G0 X[1", (1, 5), ArithmeticError::NotClosed),
        ("G0 X[foo[1]]", (1, 6), ArithmeticError::UnknownFunction),
        (
            "G0 X#0",
            (1, 5),
            ArithmeticError::NoSuchParameter {
                value: 0.0,
                most: 5602,
            },
        ),
        (
            "#5420=1",
            (1, 1),
            ArithmeticError::ReadOnly { number: 5420 },
        ),
        (
            "#<_x>=1",
            (1, 1),
            ArithmeticError::Predefined { name: "_x".into() },
        ),
        ("G0 X#<a", (1, 6), ArithmeticError::BadName { most: 255 }),
        (
            "G0 X[1/0]",
            (1, 7),
            ArithmeticError::Undefined {
                function: "division by zero",
                value: 1.0,
            },
        ),
        (
            "G0 X[ln[0]]",
            (1, 6),
            ArithmeticError::Undefined {
                function: "LN",
                value: 0.0,
            },
        ),
        (
            "G0 X[exp[1000]]",
            (1, 6),
            ArithmeticError::Overflow { function: "EXP" },
        ),
        ("#1 5", (1, 1), ArithmeticError::NotAssigned),
    ] {
        let (line, column, _, reason) = refusal(text);
        assert_eq!(
            ((line, column), reason),
            (place, Reason::Arithmetic(expected)),
            "{text:?}"
        );
    }
    let deep = format!("G0 X{}1{}", "[".repeat(500), "]".repeat(500));
    let (.., reason) = refusal(&deep);
    assert!(
        matches!(reason, Reason::Arithmetic(ArithmeticError::TooDeep { .. })),
        "{reason:?}"
    );
}

#[test]
fn a_program_number_is_no_o_word() {
    assert_ends("O1234 (PART)\nG0 X1", &[[1.0, 0.0, 0.0]]);
}

#[test]
fn a_subroutine_may_stand_below_its_call() {
    let text = "G0 X1\no1 call [3]\no2 call\nX9\nM2\no1 sub\nX#1\no2 call\no1 endsub\n\
                o2 sub\nX[#1+7]\no2 endsub\n";
    assert_x(text, &[1.0, 3.0, 7.0, 7.0, 9.0]);
    assert_x("o1 call\no1 sub\nG0 X5\no1 endsub\no1 call\n", &[5.0, 5.0]);
}

#[test]
fn a_subroutine_has_one_definition() {
    let text = "o1 sub\nG0 X1\no1 endsub\n\no1 sub\nG0 X2\no1 endsub\n";
    let (line, _, word, reason) = refusal(text);
    assert_eq!((line, word.as_str()), (5, "o1 sub"), "place");
    let expected = "subroutine O1 was already defined in line 1";
    assert_eq!(reason.to_string(), expected, "message");
    let again = "o5 repeat [2]\no1 sub\nG0 X1\no1 endsub\no1 call\no5 endrepeat\n";
    assert_x(again, &[1.0, 1.0]);
}

#[test]
fn a_negative_number_of_repetitions_is_none() {
    assert_x("o1 repeat [-2]\nG0 X1\no1 endrepeat\nG0 X2", &[2.0]);
}

#[test]
fn the_number_of_a_line_is_that_of_the_line_being_read() {
    assert_x("G0 X#<_line>\n\nX#<_line>", &[1.0, 3.0]);
}

#[test]
fn refusals_within_loops_do_not_go_on_for_ever() {
    for text in [
        "o1 while [#1 lt 5]\n#1=[1+\no1 endwhile\n",
        "o1 while [#1 lt\nG0 X1\no1 endwhile\n",
        "o1 sub\n~\no1 call\no1 endsub\no1 call\n",
    ] {
        let program = Program::new(text.as_bytes(), FILE, settings()).past_refusals();
        let refused = program.filter(Result::is_err).count();
        assert!((1..=1001).contains(&refused), "{text:?}: {refused}");
    }
}

//! Checks every FANUC program, however it is written: reading ends, never panics, and tells a place.

mod common;
mod common_fanuc;

use common::{FILE, lenient, settings};
use common_fanuc::beside;
use proptest::prelude::*;
use std::path::Path;
use toolglide_kinematics::{Path as Course, Vector};
use toolglide_program::{Language, Poses, Program, Settings};

/// Moves after which a program is long enough.
const ENOUGH: usize = 5000;

/// Reads a text in every way, and checks what must hold of any outcome.
fn check(text: &str) {
    let _ = Language::of(Path::new("a.nc"), text.as_bytes());
    let bounded = |settings: Settings| Settings {
        steps: 3000,
        still_steps: 1000,
        ..settings
    };
    for (settings, past, rotary) in [
        (settings(), false, false),
        (lenient(), true, true),
        (settings(), true, false),
    ] {
        let mut program = Program::new(text.as_bytes(), FILE, bounded(settings))
            .in_language(Language::Fanuc)
            .with_subroutines(beside);
        if past {
            program = program.past_refusals();
        }
        if rotary {
            program = program.with_rotary_axes();
        }
        let mut at = Vector::<3>::zeros();
        for step in program.take(ENOUGH) {
            match step {
                Ok(step) => {
                    if let (Course::Arc(arc), false) = (step.path(), past) {
                        let room = 1e-9 * (1.0 + at.norm());
                        assert!(
                            (arc.start() - at).norm() <= room,
                            "{text:?}: an arc begins elsewhere"
                        );
                    }
                    at = step.end(at);
                    assert!(at.iter().all(|value| value.is_finite()), "{text:?}: finite");
                    assert!(step.feedrate().speed() > 0.0, "{text:?}: speed");
                }
                Err(error) => {
                    assert!(
                        error.line() >= 1 && error.column() >= 1,
                        "{text:?}: counted from 1"
                    );
                    assert!(error.length() >= 1, "{text:?}: a caret has a width");
                    assert!(!error.to_string().is_empty(), "{text:?}: message");
                }
            }
        }
    }
    let poses = Poses::new(text.as_bytes(), FILE, bounded(settings()), Language::Fanuc);
    let _ = poses.take(ENOUGH).count();
}

fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        (-40_i32..40).prop_map(|value| value.to_string()),
        (-99..99_i32).prop_map(|value| format!("{:.1}", f64::from(value) / 10.0)),
        (1_u8..12).prop_map(|value| format!("#{value}")),
        (0_u16..3).prop_map(|value| format!("[#{value}*2.-1.]")),
        Just(String::from("#0")),
        Just(String::from("[ROUND[#1]]")),
        Just(String::from("31001")),
        Just(String::from("1e3")),
        Just(String::from("99999999999999999999999")),
        Just(String::new()),
    ]
}

fn word() -> impl Strategy<Value = String> {
    let code = prop_oneof![
        "G(0|1|2|3|4|5|5\\.1|8|9|10|11|12|13|15|16|17|18|19|20|21|27|28|29|30|31|39|40|41|42|43|44|49)",
        "G(50|51|50\\.1|51\\.1|52|53|54|55|54\\.1|154|110|61|64|65|66|67|68|69|73|74|76|80|81|82|83)",
        "G(84|85|86|87|88|89|90|91|92|92\\.1|93|94|98|99|100|101|103|187|255|6\\.2|43\\.4|61\\.1)",
        "M(0|1|3|6|8|9|19|29|30|97 P1|98 P1|98 P2|98 P20001|98 P7000|99|99 P1|88)",
        "G10 L(2|20|10|12) P1",
        "G(65|66) P(1|2|7000)",
    ];
    let letter = proptest::sample::select(b"XYZIJKRFPQLHDSTABCEUOXYZ".to_vec());
    let value = (letter, number()).prop_map(|(letter, number)| {
        let letter = char::from(letter);
        format!("{letter}{number}")
    });
    let corner = prop_oneof![",R", ",C", ",A"]
        .prop_flat_map(|word| number().prop_map(move |number| format!("{word}{number}")));
    let rest = proptest::sample::select(vec![
        "(c)", ";c", "(", ")", "%", "/", "/2", "N1", "N2", ",", "[", "]", "#", "=", "é",
    ]);
    prop_oneof![6 => code, 10 => value, 1 => corner, 1 => rest.prop_map(String::from)]
}

fn statement() -> impl Strategy<Value = String> {
    let head = proptest::sample::select(vec![
        "IF [#1 EQ #0] GOTO ",
        "IF [#1 LT 3] THEN #1=#1+",
        "WHILE [#1 LT 3] DO",
        "DO",
        "END",
        "GOTO ",
        "#1=#1+",
        "#2=",
        "#[#1+1]=",
        "#500=",
        "#5221=",
        "#3006=",
        "#3000=",
        "O",
        "O",
        "M98 P",
        "N",
        "%",
        "DPRNT[",
        "IF [[#1 GT 1] AND [#2 NE 2]] ",
    ]);
    (head, number()).prop_map(|(head, number)| format!("{head}{number}"))
}

fn line() -> impl Strategy<Value = String> {
    prop_oneof![
        3 => proptest::collection::vec(word(), 0..6).prop_map(|words| words.join(" ")),
        1 => statement(),
        1 => proptest::sample::select(vec!["END1", "DO1", "O1", "O2", "M99", "N1", "N2", "%", "M30", "G80", "G40"])
            .prop_map(String::from),
    ]
}

proptest! {
    #[test]
    fn any_words_are_read_to_the_end(lines in proptest::collection::vec(line(), 0..24)) {
        check(&format!("F100\n{}\n", lines.join("\n")));
    }

    #[test]
    fn any_text_is_read_to_the_end(text in "\\PC{0,200}") {
        check(&text);
    }
}

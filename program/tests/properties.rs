//! Checks every program: reading ends, never panics, and does not depend on how it is
//! written.

mod common;

use common::{lenient, settings};
use proptest::prelude::*;
use toolglide_kinematics::{Move, Path, Tolerance, Vector};
use toolglide_program::{Program, ProgramError, Settings};

/// Moves that one line can make: a dwell, a motion and a rest.
const MOVES_PER_LINE: usize = 3;

/// Rounding of a few operations on coordinates of some hundred mm, mm.
const ROUNDING: f64 = 1e-6;

fn all(text: &[u8], settings: Settings) -> (Vec<Move<3>>, Option<ProgramError>) {
    let mut moves = Vec::new();
    for step in Program::new(text, "fuzz", settings) {
        match step {
            Ok(step) => moves.push(step),
            Err(error) => return (moves, Some(error)),
        }
    }
    (moves, None)
}

/// Reads to the end, and checks what must hold of any outcome.
fn check(text: &[u8], settings: Settings) {
    let lines = text.split(|&byte| byte == b'\n').count();
    let mut program = Program::new(text, "fuzz", settings);
    let mut refused = false;
    let mut at = settings.start;
    let mut count = 0;
    for step in program.by_ref() {
        assert!(!refused, "nothing follows a refusal");
        match step {
            Ok(step) => {
                count += 1;
                if let Path::Arc(arc) = step.path() {
                    assert_eq!(arc.start(), at, "arcs start where the path is");
                }
                at = step.end(at);
                assert!(at.iter().all(|value| value.is_finite()), "finite");
                assert!(step.feedrate().speed() > 0.0, "speed");
            }
            Err(error) => {
                refused = true;
                assert!(error.line() <= lines as u64, "line {}", error.line());
                assert!(error.line() >= 1 && error.column() >= 1, "counted from 1");
                assert!(error.length() >= 1, "a caret has a width");
                assert!(!error.to_string().is_empty(), "message");
            }
        }
    }
    assert!(
        count <= MOVES_PER_LINE * lines,
        "{count} moves of {lines} lines"
    );
    assert!(program.next().is_none(), "fused");
}

fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        (-200_i32..200).prop_map(|value| value.to_string()),
        (-200.0..200.0_f64).prop_map(|value| format!("{value:.4}")),
        Just(String::from("0")),
        Just(String::from("-.5")),
        Just(String::from("1.")),
        Just(String::from("1 0")),
        Just(String::from("99999999999999999999999")),
        Just(String::new()),
    ]
}

fn word() -> impl Strategy<Value = String> {
    let code = prop_oneof![
        "G(0|1|2|3|4|17|18|19|20|21|40|49|54|61|61\\.1|64|80|90|91|90\\.1|91\\.1|93|94|28|53)",
        "M(0|1|2|3|5|6|7|8|9|30|48|60|98|104)",
        Just(String::from("G1")),
        Just(String::from("g3")),
    ];
    let letter = proptest::sample::select(b"XYZIJKRFPQSTNABDEHLxyzij".to_vec());
    let value = (letter, number()).prop_map(|(letter, number)| {
        let letter = char::from(letter);
        format!("{letter}{number}")
    });
    let rest = proptest::sample::select(vec![
        " ", "(c)", ";c", "(", ")", "#1", "[2]", "%", "/", "\t",
    ]);
    prop_oneof![4 => code, 8 => value, 1 => rest.prop_map(String::from)]
}

fn line() -> impl Strategy<Value = String> {
    proptest::collection::vec(word(), 0..6).prop_map(|words| words.join(" "))
}

/// Points that a program with four decimals writes exactly.
fn point() -> impl Strategy<Value = [i32; 3]> {
    proptest::array::uniform3(-1_000_000..1_000_000_i32)
}

fn decimal(ten_thousandths: i32) -> String {
    format!("{:.4}", f64::from(ten_thousandths) / 1e4)
}

/// A program of straight moves, with all its numbers changed by `scale`.
fn lines_through(points: &[[i32; 3]], scale: f64) -> String {
    let mut text = String::from("G1 F100\n");
    for point in points {
        let [x, y, z] = point.map(|value| f64::from(value) / 1e4 * scale);
        text += &format!("X{x:.12} Y{y:.12} Z{z:.12}\n");
    }
    text
}

proptest! {
    #[test]
    fn any_bytes_are_read_to_the_end(text in proptest::collection::vec(any::<u8>(), 0..400)) {
        check(&text, settings());
        check(&text, lenient());
    }

    #[test]
    fn any_line_of_words_is_read_to_the_end(lines in proptest::collection::vec(line(), 0..12)) {
        let text = lines.join("\n");
        check(text.as_bytes(), settings());
        check(text.as_bytes(), lenient());
    }

    #[test]
    fn each_line_is_read_after_a_legal_beginning(line in line()) {
        let text = format!("F100 G1 X1 Y1\n{line}");
        check(text.as_bytes(), settings());
    }

    #[test]
    fn case_blanks_and_comments_change_nothing(lines in proptest::collection::vec(line(), 0..8)) {
        let text = lines.join("\n");
        let other: String = text
            .chars()
            .map(|letter| match letter {
                ' ' => String::from(" \t"),
                _ => letter.to_ascii_lowercase().to_string(),
            })
            .collect();
        let (moves, error) = all(text.as_bytes(), settings());
        let (others, other_error) = all(other.as_bytes(), settings());
        prop_assert_eq!(moves, others);
        prop_assert_eq!(error.as_ref().map(ProgramError::line), other_error.as_ref().map(ProgramError::line));
    }

    #[test]
    fn line_ends_change_nothing(lines in proptest::collection::vec(line(), 0..8)) {
        let (moves, error) = all(lines.join("\n").as_bytes(), settings());
        let (others, other_error) = all((lines.join("\r\n") + "\r\n").as_bytes(), settings());
        prop_assert_eq!(moves, others);
        prop_assert_eq!(error, other_error);
    }

    #[test]
    fn numbers_are_read_to_the_last_bit(whole in 0_u64..u64::MAX, decimals in 0_usize..25) {
        let mut text = format!("{whole:025}");
        text.insert(25 - decimals, '.');
        let expected: f64 = text.parse().unwrap();
        let (moves, _) = all(format!("G0 X-{text}").as_bytes(), settings());
        if expected <= toolglide_program::FARTHEST {
            let found = moves[0].end(Vector::zeros())[0];
            prop_assert_eq!(found.to_bits(), (-expected).to_bits());
        } else {
            prop_assert!(moves.is_empty());
        }
    }

    #[test]
    fn inches_and_millimetres_are_the_same_path(points in proptest::collection::vec(point(), 1..6)) {
        let (metric, _) = all(lines_through(&points, 25.4).as_bytes(), settings());
        let inch = format!("G20\n{}", lines_through(&points, 1.0));
        let (moves, _) = all(inch.as_bytes(), settings());
        prop_assert_eq!(metric.len(), points.len());
        for (one, other) in metric.iter().zip(&moves) {
            let apart = one.end(Vector::zeros()) - other.end(Vector::zeros());
            prop_assert!(apart.norm() < ROUNDING, "{apart:?}");
            let ratio = other.feedrate().speed() / one.feedrate().speed();
            prop_assert!((ratio - 25.4).abs() < ROUNDING, "{ratio}");
        }
    }

    #[test]
    fn absolute_and_incremental_are_the_same_path(points in proptest::collection::vec(point(), 1..6)) {
        let (absolute, _) = all(lines_through(&points, 1.0).as_bytes(), settings());
        let mut last = [0; 3];
        let steps: Vec<[i32; 3]> = points
            .iter()
            .map(|point| {
                let step = [point[0] - last[0], point[1] - last[1], point[2] - last[2]];
                last = *point;
                step
            })
            .collect();
        let text = format!("G91\n{}", lines_through(&steps, 1.0));
        let (incremental, _) = all(text.as_bytes(), settings());
        for (one, other) in absolute.iter().zip(&incremental) {
            let apart = one.end(Vector::zeros()) - other.end(Vector::zeros());
            prop_assert!(apart.norm() < ROUNDING, "{apart:?}");
        }
    }

    /// The centre is chosen first and the radius follows from it, so that nothing is shared with
    /// how a radius is read.
    #[test]
    fn a_radius_and_its_centre_are_the_same_arc(
        center in point(),
        radius in 0.5..100.0_f64,
        from in 0.0..std::f64::consts::TAU,
        sweep in 0.01..6.27_f64,
        plane in 0_usize..3,
        left in any::<bool>(),
    ) {
        // Near half a circle the radius hardly tells the centre.
        prop_assume!((sweep - std::f64::consts::PI).abs() > 0.01);
        let (code, [first, second]) = [(17, [0, 1]), (18, [2, 0]), (19, [1, 2])][plane];
        let center: Vector<3> = center.map(|value| f64::from(value) / 1e4).into();
        let at = |angle: f64| {
            let mut point = center;
            point[first] += radius * angle.cos();
            point[second] += radius * angle.sin();
            point
        };
        let (start, end) = (at(from), at(if left { from + sweep } else { from - sweep }));
        let offset = center - start;
        let word = |letters: &str, values: &Vector<3>, axis: usize| {
            format!("{}{:.12} ", &letters[axis..=axis], values[axis])
        };
        let (g, short) = (if left { 3 } else { 2 }, sweep < std::f64::consts::PI);
        let to = word("XYZ", &end, first) + &word("XYZ", &end, second);
        let by_center = format!("G{g} {to} {}{}", word("IJK", &offset, first), word("IJK", &offset, second));
        let by_radius = format!("G{g} {to} R{:.12}", if short { radius } else { -radius });
        let arc_of = |line: &str| {
            let begin = format!("F60 G{code} G0 X{:.12} Y{:.12} Z{:.12}\n", start[0], start[1], start[2]);
            let (moves, error) = all((begin + line).as_bytes(), settings());
            assert!(error.is_none(), "{error:?}");
            match moves[1].path() {
                Path::Arc(arc) => *arc,
                other => panic!("{other:?}"),
            }
        };
        let (one, other) = (arc_of(&by_center), arc_of(&by_radius));
        let signed = if left { sweep } else { -sweep };
        prop_assert!((one.sweep() - signed).abs() < ROUNDING, "{} {signed}", one.sweep());
        for share in [0.0, 0.3, 0.5, 0.9, 1.0] {
            let apart = (one.point(share) - other.point(share)).norm();
            prop_assert!(apart < ROUNDING * 10.0, "{apart} at {share}");
        }
    }

    #[test]
    fn feedrates_are_a_minute(feed in 1_i32..1_000_000, tolerance in 1_i32..10_000) {
        let text = format!("G64 P{}\nG1 X1 F{}", decimal(tolerance), decimal(feed));
        let (moves, _) = all(text.as_bytes(), settings());
        let speed = f64::from(feed) / 1e4 / 60.0;
        prop_assert!((moves[0].feedrate().speed() - speed).abs() < ROUNDING);
        let expected = Tolerance::new(f64::from(tolerance) / 1e4).unwrap();
        prop_assert_eq!(moves[0].tolerance(), expected);
    }
}

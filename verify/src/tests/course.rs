//! Set-points along a path that is hard to follow: near itself, many moves between two points, whole turns.

use super::build::{judged, limits, line, path, stop_and_go};
use crate::Violation;
use toolglide_kinematics::{Arc, Feedrate, Move, Tolerance, Toolpath, Vector};

#[test]
fn a_path_that_comes_back_near_itself_is_followed_in_order() {
    // Lines 0.05 mm apart, there and back, then across all of them: 300 moves within 15 mm.
    let mut moves = Vec::new();
    for k in 0..150_u32 {
        let y = 0.05 * f64::from(k);
        moves.push(line([if k % 2 == 0 { 5.0 } else { 0.0 }, y]));
        moves.push(line([if k % 2 == 0 { 5.0 } else { 0.0 }, y + 0.05]));
    }
    moves.push(line([2.5, 0.0]));
    let full = path(&moves);
    let report = judged(&stop_and_go(&full, &limits()), &full, 0.001);
    assert!(report.passes(), "{:?}", report.examples);
    // The same without the 40 moves in the middle is found out.
    moves.drain(100..140);
    moves.insert(100, line([0.0, 3.5]));
    let report = judged(&stop_and_go(&path(&moves), &limits()), &full, 0.001);
    assert!(
        report
            .examples
            .iter()
            .any(|v| matches!(v, Violation::CornerMissed { .. }))
            && report
                .examples
                .iter()
                .any(|v| matches!(v, Violation::Deviation { .. })),
        "{:?}",
        report.examples
    );
}

#[test]
fn many_moves_between_two_points_are_passed() {
    let chords: Vec<_> = (1..=4_000_u32)
        .map(|k| {
            let angle = f64::from(k) * 0.000_5;
            line([20.0 * angle.sin(), 20.0 * (1.0 - angle.cos())])
        })
        .collect();
    let fine = path(&chords);
    // Cut to 20 chords: 0.025 mm off the 4000, of which 50 and more lie between two points.
    let coarse: Vec<_> = (0..20).map(|k| chords[200 * k + 199]).collect();
    let plan = stop_and_go(&path(&coarse), &limits());
    let sagitta = 20.0 * (1.0 - 0.05_f64.cos());
    for (tolerance, passes) in [(1.01 * sagitta, true), (0.9 * sagitta, false)] {
        let tolerance = Tolerance::new(tolerance).unwrap();
        let mut path = Toolpath::starting_at(fine.start()).unwrap();
        for (step, mv) in fine.moves().iter().zip(0..) {
            let feedrate = Feedrate::new(100.0).unwrap();
            let end = step.end(Vector::zeros());
            path.push(
                Move::line_to(end, feedrate, tolerance)
                    .unwrap()
                    .from_line(mv),
            )
            .unwrap();
        }
        let report = judged(&plan, &path, 0.001);
        assert_eq!(report.passes(), passes, "{:?}", report.examples.first());
        assert!(
            (report.deviation.value / sagitta - 1.0).abs() < 0.01,
            "{:?}",
            report.deviation
        );
    }
}

#[test]
fn a_circle_is_followed_all_the_way() {
    let origin = Vector::<2>::zeros();
    let center = Vector::<2>::new(0.0, 5.0);
    let tolerance = Tolerance::new(0.01).unwrap();
    let circle = Arc::about(origin, origin, center, [0, 1], true, 1).unwrap();
    let slow = Feedrate::new(20.0).unwrap();
    let full = path(&[Move::arc(circle, slow, tolerance), line([10.0, 0.0])]);
    let chords = |turns: u32| {
        let mut moves: Vec<_> = (1..=turns * 120)
            .map(|k| {
                let angle = f64::from(k) * 3.0_f64.to_radians();
                line([5.0 * angle.sin(), 5.0 * (1.0 - angle.cos())])
            })
            .collect();
        moves.push(line([10.0, 0.0]));
        let feedrate = Feedrate::new(20.0).unwrap();
        let slow: Vec<_> = moves
            .iter()
            .map(|step| Move::line_to(step.end(origin), feedrate, tolerance).unwrap())
            .collect();
        stop_and_go(&path(&slow), &limits())
    };
    let report = judged(&chords(2), &full, 0.001);
    assert!(report.passes(), "{:?}", report.examples);
    let sagitta = 5.0 * (1.0 - 1.5_f64.to_radians().cos());
    assert!(
        (report.deviation.value / sagitta - 1.0).abs() < 1e-2,
        "{:?}",
        report.deviation
    );
    let report = judged(&chords(1), &full, 0.001);
    assert!(
        report
            .examples
            .iter()
            .any(|v| matches!(v, Violation::ArcCut { .. })),
        "{:?}",
        report.examples
    );
}

//! Moves must be served in order, and corners passed in order.

use super::build::{limits, line, path, stop_and_go};
use crate::{Judge, Violation, verify};
use toolglide_kinematics::{
    Arc, Feedrate, Move, MoveRange, Piece, Plan, Sample, Tolerance, Toolpath, Vector,
};

fn claiming(plan: &Plan<2>, claim: impl Fn(MoveRange) -> MoveRange) -> Plan<2> {
    let mut other = Plan::starting_at(plan.start());
    for piece in plan.pieces() {
        other.push(Piece::new(
            &piece.at(0.0),
            piece.duration(),
            piece.end(),
            claim(piece.serves()),
        ));
    }
    other
}

#[test]
fn a_skipped_move_is_named() {
    let full = path(&[
        line([10.0, 0.0]),
        line([10.0, 5.0]),
        line([10.0, 0.0]),
        line([20.0, 0.0]),
    ]);
    let short = path(&[line([10.0, 0.0]), line([20.0, 0.0])]);
    let plan = claiming(&stop_and_go(&short, &limits()), |serves| MoveRange {
        first: serves.first * 3,
        last: serves.last * 3,
    });
    let report = verify(&plan, &full, &limits());
    let skipped: Vec<_> = report
        .examples
        .iter()
        .filter_map(|violation| match violation {
            Violation::MoveSkipped { place, .. } => Some(place.mv),
            _ => None,
        })
        .collect();
    assert_eq!(skipped, [1, 2], "{:?}", report.examples);
}

#[test]
fn wide_claims_do_not_hide_a_missed_corner() {
    let full = path(&[
        line([10.0, 0.0]),
        line([10.0, 5.0]),
        line([10.0, 0.0]),
        line([20.0, 0.0]),
    ]);
    let short = path(&[line([10.0, 0.0]), line([20.0, 0.0])]);
    let plan = claiming(&stop_and_go(&short, &limits()), |_| MoveRange {
        first: 0,
        last: 3,
    });
    let report = verify(&plan, &full, &limits());
    let missed: Vec<_> = report
        .examples
        .iter()
        .filter_map(|violation| match violation {
            Violation::CornerMissed { value, place, .. } => Some((place.mv, *value)),
            _ => None,
        })
        .collect();
    assert_eq!(missed.len(), 1, "{:?}", report.examples);
    assert!(
        missed[0].0 == 1 && (missed[0].1 - 5.0).abs() < 1e-9,
        "{missed:?}"
    );
    assert_eq!(report.violations, 1, "{:?}", report.examples);
}

#[test]
fn corners_in_the_wrong_order_are_seen() {
    // There, back and there again, cut down to once there.
    let full = path(&[line([10.0, 0.0]), line([0.0, 0.0]), line([10.0, 0.0])]);
    let once = path(&[line([10.0, 0.0])]);
    let plan = claiming(&stop_and_go(&once, &limits()), |_| MoveRange {
        first: 0,
        last: 2,
    });
    let report = verify(&plan, &full, &limits());
    assert_eq!(report.violations, 1, "{:?}", report.examples);
    assert!(
        matches!(report.examples[0], Violation::CornerOrder { place, .. } if place.mv == 1),
        "{:?}",
        report.examples
    );
    assert!(
        verify(&stop_and_go(&full, &limits()), &full, &limits()).passes(),
        "all three"
    );
}

#[test]
fn a_circle_left_out_is_seen() {
    let origin = Vector::<2>::zeros();
    let center = Vector::<2>::new(0.0, 5.0);
    for turns in [0, 1, 5] {
        let circle = Arc::about(origin, origin, center, [0, 1], true, turns).unwrap();
        let step = Move::arc(circle, Feedrate::RAPID, Tolerance::new(0.01).unwrap());
        let path = path(&[step, line([10.0, 0.0])]);
        let mut plan = Plan::starting_at(origin);
        plan.push(Piece::new(
            &Sample::at_rest(origin),
            1.0,
            origin,
            MoveRange { first: 0, last: 0 },
        ));
        let straight = super::build::path(&[line([10.0, 0.0])]);
        let rest = claiming(&stop_and_go(&straight, &limits()), |_| MoveRange {
            first: 1,
            last: 1,
        });
        plan.extend(rest.pieces().iter().copied());
        let report = verify(&plan, &path, &limits());
        assert_eq!(report.violations, 1, "{:?}", report.examples);
        assert!(
            matches!(report.examples[0], Violation::ArcCut { place, .. } if place.mv == 0),
            "{:?}",
            report.examples
        );
    }
}

#[test]
fn claims_that_go_back_or_beyond_are_named() {
    let path = path(&[line([10.0, 0.0]), line([20.0, 0.0])]);
    let plan = stop_and_go(&path, &limits());
    for claim in [
        |serves: MoveRange| MoveRange {
            first: 1 - serves.first,
            last: 1 - serves.last,
        },
        |serves: MoveRange| MoveRange {
            first: serves.first,
            last: serves.last + 7,
        },
        |serves: MoveRange| MoveRange {
            first: serves.first + 1,
            last: serves.last,
        },
        |_| MoveRange {
            first: u32::MAX,
            last: 0,
        },
    ] {
        let report = verify(&claiming(&plan, claim), &path, &limits());
        assert!(
            report
                .examples
                .iter()
                .any(|violation| matches!(violation, Violation::MovesOutOfOrder { .. })),
            "{:?}",
            report.examples
        );
    }
}

#[test]
fn moves_of_no_length_may_be_left_out() {
    let full = path(&[
        line([10.0, 0.0]),
        line([10.0, 0.0]),
        Move::dwell(0.0, Tolerance::new(0.01).unwrap()).unwrap(),
        line([20.0, 0.0]),
    ]);
    let short = path(&[line([10.0, 0.0]), line([20.0, 0.0])]);
    let plan = claiming(&stop_and_go(&short, &limits()), |serves| MoveRange {
        first: serves.first * 3,
        last: serves.last * 3,
    });
    let report = verify(&plan, &full, &limits());
    assert!(report.passes(), "{:?}", report.examples);
}

#[test]
fn a_judge_forgets_what_is_behind_and_may_know_all_that_is_ahead() {
    let points: Vec<_> = (1..=2_000_u32)
        .map(|k| line([f64::from(k) * 0.5, f64::from(k % 2)]))
        .collect();
    let path: Toolpath<2> = path(&points);
    let plan = stop_and_go(&path, &limits());
    let mut judge = Judge::new(path.start(), limits());
    for step in path.moves() {
        judge.expect(step).unwrap();
    }
    for piece in plan.pieces() {
        judge.observe(piece);
    }
    assert!(judge.moves_held() <= 2, "{}", judge.moves_held());
    let ahead = judge.finish();
    assert!(ahead.passes(), "{:?}", ahead.examples);
    assert_eq!(ahead, verify(&plan, &path, &limits()), "told late");
}

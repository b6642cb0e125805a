//! One defect each: the judge names it, its value, its time and its place, and nothing else.

use super::build::{limits, line, overlapped, path, push_phases, stop_and_go};
use crate::{Place, Report, Violation, verify};
use toolglide_kinematics::{
    Arc, Feedrate, Move, MoveRange, Piece, Plan, Sample, Tolerance, Trajectory, Vector,
};

fn only<const N: usize>(report: &Report<N>) -> Violation {
    assert_eq!(report.violations, 1, "{:#?}", report.examples);
    report.examples[0]
}

fn corner_path() -> toolglide_kinematics::Toolpath<2> {
    path(&[line([10.0, 0.0]), line([10.0, 10.0])])
}

#[test]
fn a_clean_stop_and_go_breaks_nothing() {
    let path = path(&[
        line([10.0, 0.0, 3.0]),
        line([10.0, 10.0, 3.0]).with_exact_stop(),
        Move::dwell(0.25, Tolerance::new(0.01).unwrap()).unwrap(),
        line([9.999, 10.0, 3.0]),
        line([-700.0, 10.0, 30.0]),
    ]);
    let plan = stop_and_go(&path, &limits());
    let report = verify(&plan, &path, &limits());
    assert!(report.passes(), "{:#?}", report.examples);
    assert!((report.cycle_time - plan.duration()).abs() < 1e-9, "time");
    assert!((report.path_length - path.length()).abs() < 1e-9, "length");
    assert!(report.deviation.value < 1e-9, "{:?}", report.deviation);
    assert!(
        report.corner_error.value < 1e-9,
        "{:?}",
        report.corner_error
    );
    assert!(
        (report.peak_speed.value - 100.0).abs() < 1e-6,
        "feedrate is used"
    );
}

#[test]
fn a_blended_corner_is_measured() {
    let plan = overlapped([10.0, 10.0], 0.06, &limits(), 100.0);
    let mut closest = f64::INFINITY;
    let mut farthest = 0.0_f64;
    let steps = 200_000;
    for k in 0..=steps {
        let at = plan.duration() * f64::from(k) / f64::from(steps);
        let point = plan.sample(at).position;
        closest = closest.min((point - Vector::<2>::new(10.0, 0.0)).norm());
        farthest = farthest.max(point[1].abs().min((point[0] - 10.0).abs()));
    }
    let path = corner_path();
    let report = verify(&plan, &path, &limits());
    let missed = report
        .examples
        .iter()
        .find_map(|violation| match violation {
            Violation::CornerMissed {
                value,
                tolerance,
                place,
                ..
            } => Some((*value, *tolerance, *place)),
            _ => None,
        });
    let (value, tolerance, place) = missed.unwrap();
    assert!((value / closest - 1.0).abs() < 1e-6, "{value} {closest}");
    assert!((tolerance - 0.01).abs() < 1e-15, "{tolerance}");
    assert_eq!(place, Place { mv: 0, line: 10 }, "place");
    assert!(
        (report.deviation.value / farthest - 1.0).abs() < 2e-6,
        "{} {farthest}",
        report.deviation.value
    );
    let wide = Tolerance::new(closest * (1.0 + 1e-6)).unwrap();
    let feedrate = Feedrate::new(100.0).unwrap();
    let path = super::build::path(&[
        Move::line_to(Vector::<2>::new(10.0, 0.0), feedrate, wide).unwrap(),
        Move::line_to(Vector::<2>::new(10.0, 10.0), feedrate, wide).unwrap(),
    ]);
    let report = verify(&plan, &path, &limits());
    assert!(report.passes(), "{:#?}", report.examples);
    assert!(
        (report.corner_ratio.value - 1.0).abs() < 3e-6,
        "{:?}",
        report.corner_ratio
    );
}

#[test]
fn a_chord_leaves_its_arc_by_the_sagitta() {
    for (lift, angle) in [(0.0, 0.5_f64), (0.0, 3.0), (0.0, 0.01)] {
        let start = Vector::<3>::new(0.0, 0.0, 0.0);
        let center = Vector::<3>::new(-50.0, 0.0, 0.0);
        let end = center + Vector::<3>::new(50.0 * angle.cos(), 50.0 * angle.sin(), lift);
        let arc = Arc::about(start, end, center, [0, 1], true, 0).unwrap();
        let sagitta = 50.0 * (1.0 - (0.5 * angle).cos());
        let mut broken = 0;
        for tolerance in [sagitta * 1.000_01, sagitta * 0.999_99] {
            let step = Move::arc(arc, Feedrate::RAPID, Tolerance::new(tolerance).unwrap());
            let path = path(&[step]);
            let report = verify(&stop_and_go(&path, &limits()), &path, &limits());
            assert!(
                (report.deviation.value - sagitta).abs() <= 1e-9_f64.max(1e-6 * sagitta),
                "{} {sagitta}",
                report.deviation.value
            );
            broken += report.violations;
        }
        // The cruise alone holds the middle of the chord.
        assert!(broken >= 1, "{angle}");
    }
}

#[test]
fn a_cut_corner_is_measured() {
    // A straight line past the corner, rest to rest: the sharpest cut there is.
    let path = corner_path();
    let mut plan = Plan::starting_at(path.start());
    let span = Vector::<2>::new(10.0, 10.0);
    let direction = span.normalize();
    let seven = super::build::phases(span.norm(), 100.0, 2_000.0, 50_000.0);
    let seven: Vec<_> = seven.iter().map(|(t, j)| (*t, direction * *j)).collect();
    push_phases(&mut plan, &seven, span, MoveRange { first: 0, last: 1 });
    let report = verify(&plan, &path, &limits());
    assert!(
        (report.corner_error.value - 50.0_f64.sqrt()).abs() < 1e-6,
        "corner"
    );
    assert!(
        (report.deviation.value - 5.0).abs() < 1e-5,
        "{:?}",
        report.deviation
    );
    let time = 0.5 * plan.duration();
    assert!(
        (report.deviation.time - time).abs() < 1e-3,
        "{:?}",
        report.deviation
    );
    assert!(
        (report.corner_error.time - time).abs() < 1e-3,
        "{:?}",
        report.corner_error
    );
}

#[test]
fn a_missed_stop_and_a_short_dwell_are_named() {
    let tolerance = Tolerance::new(0.01).unwrap();
    let through = path(&[line([20.0, 0.0])]);
    let stopping = path(&[line([10.0, 0.0]).with_exact_stop(), line([20.0, 0.0])]);
    let mut plan = Plan::starting_at(through.start());
    for piece in stop_and_go(&through, &limits()).pieces() {
        let serves = MoveRange {
            first: u32::from(piece.start()[0] > 10.0),
            last: u32::from(piece.end()[0] > 10.0),
        };
        plan.push(Piece::new(
            &piece.at(0.0),
            piece.duration(),
            piece.end(),
            serves,
        ));
    }
    let missed = only(&verify(&plan, &stopping, &limits()));
    assert!(
        matches!(missed, Violation::StopNotMade { distance, place: Place { mv: 0, line: 10 }, .. } if distance < 1e-9),
        "{missed}"
    );
    let dwell = |time| {
        path(&[
            line([10.0, 0.0]),
            Move::dwell(time, tolerance).unwrap(),
            line([20.0, 0.0]),
        ])
    };
    let plan = stop_and_go(&dwell(0.5), &limits());
    assert!(verify(&plan, &dwell(0.5), &limits()).passes(), "dwell");
    let short = only(&verify(&plan, &dwell(0.6), &limits()));
    assert!(
        matches!(short, Violation::DwellTooShort { rested, place: Place { mv: 1, line: 11 }, .. } if (rested - 0.5).abs() < 1e-9),
        "{short}"
    );
}

#[test]
fn the_wrong_end_and_the_wrong_start_are_named() {
    let path = path(&[line([10.0, 0.0])]);
    let clean = stop_and_go(&path, &limits());
    let mut cut = Plan::starting_at(path.start());
    cut.extend(clean.pieces()[..4].iter().copied());
    let report = verify(&cut, &path, &limits());
    assert_eq!(report.violations, 2, "{:?}", report.examples);
    assert!(
        matches!(report.examples[0], Violation::EndsElsewhere { .. }),
        "{:?}",
        report.examples
    );
    assert!(
        matches!(report.examples[1], Violation::EndsMoving { axis: 0, .. }),
        "{:?}",
        report.examples
    );
    let mut late = Plan::starting_at(path.start());
    late.extend(clean.pieces()[3..].iter().copied());
    let report = verify(&late, &path, &limits());
    assert_eq!(report.violations, 2, "{:?}", report.examples);
    assert!(
        matches!(report.examples[0], Violation::StartsElsewhere { .. }),
        "{:?}",
        report.examples
    );
    assert!(
        matches!(report.examples[1], Violation::StartsMoving { axis: 0 }),
        "{:?}",
        report.examples
    );
}

#[test]
fn motion_that_is_no_number_is_named() {
    let path = path(&[line([10.0, 0.0])]);
    let mut plan = Plan::starting_at(path.start());
    let mut state = Sample::at_rest(path.start());
    state.velocity[1] = f64::NAN;
    plan.push(Piece::new(
        &state,
        1.0,
        path.end(),
        MoveRange { first: 0, last: 0 },
    ));
    state.velocity[1] = f64::INFINITY;
    plan.push(Piece::new(
        &state,
        1.0,
        path.end(),
        MoveRange { first: 0, last: 7 },
    ));
    let report = verify(&plan, &path, &limits());
    assert!(
        matches!(report.examples[0], Violation::NotFinite { .. }),
        "{:?}",
        report.examples
    );
}

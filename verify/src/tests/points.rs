//! Set-points: what is certain is judged, and a legal motion never fails.

use proptest::prelude::*;

use super::build::{judged, limits, line, overlapped, path, set_points, stop_and_go};
use crate::{SetPointJudge, VerifyError, Violation, verify, verify_set_points};
use toolglide_kinematics::{Feedrate, Limits, Move, Tolerance, Toolpath, Trajectory, Vector};

fn wide(tolerance: f64) -> Toolpath<2> {
    let feedrate = Feedrate::new(100.0).unwrap();
    let tolerance = Tolerance::new(tolerance).unwrap();
    path(
        &[[10.0, 0.0], [10.0, 10.0]]
            .map(|end| Move::line_to(Vector::from(end), feedrate, tolerance).unwrap()),
    )
}

fn busy_path() -> Toolpath<3> {
    let tolerance = Tolerance::new(0.01).unwrap();
    path(&[
        line([10.0, 0.0, 3.0]),
        line([10.0, 10.0, 3.0]).with_exact_stop(),
        Move::dwell(0.25, tolerance).unwrap(),
        Move::dwell(0.0, tolerance).unwrap(),
        Move::dwell(0.125, tolerance).unwrap(),
        line([0.0, 10.0, 3.0]),
        line([10.0, 10.0, 3.0]),
        line([9.999, 10.0, 3.0]),
        line([9.999, 10.0005, 3.0]),
        line([9.999, 10.0, 3.0]).with_exact_stop(),
        line([-70.0, 10.0, 30.0]),
        line([-70.0, 10.0, 30.0]),
        line([-70.001, 10.0, 30.0]),
        line([0.0, 10.0, 3.0]),
    ])
}

#[test]
fn set_points_of_a_clean_motion_break_nothing_at_any_period() {
    let path = busy_path();
    let short = Toolpath::clone(&path);
    let moves: Vec<_> = short
        .moves()
        .iter()
        .enumerate()
        .filter(|(index, _)| *index != 11)
        .map(|(_, step)| *step)
        .collect();
    let path_without_empty = super::build::path(&moves);
    let plan = stop_and_go(&path_without_empty, &limits());
    for period in [1e-4, 0.001, 0.002, 0.003_7, 0.01, 0.1] {
        let report = judged(&plan, &path, period);
        assert_eq!(report.violations, 0, "{period}: {:#?}", report.examples);
        assert_eq!(report.passes(), period < 0.004, "{period}: too coarse");
        assert!((report.cycle_time - plan.duration()).abs() < 1e-12, "time");
        if period < 0.002 {
            assert!(report.peak_speed.value > 99.9, "{:?}", report.peak_speed);
            assert!(
                report.peak_jerk[0].value > 49_000.0,
                "{:?}",
                report.peak_jerk
            );
        }
    }
}

#[test]
fn rounded_set_points_pass_with_their_resolution() {
    let plan = overlapped([10.0, 10.0], 0.03, &limits(), 100.0);
    let report = verify(&plan, &wide(5.0), &limits());
    assert!(report.passes(), "{:?}", report.examples);
    let tight = report.corner_error.value.max(report.deviation.value);
    for decimals in [1e-3, 1e-4, 1e-6] {
        let points = set_points(&plan, 0.001)
            .into_iter()
            .map(|(time, at)| (time, at.map(|x| (x / decimals).round() * decimals)));
        let rounded = verify_set_points(points, &wide(tight), &limits(), 0.5 * decimals).unwrap();
        assert!(rounded.passes(), "{decimals}: {:?}", rounded.examples);
    }
}

#[test]
fn a_corner_is_measured_between_points() {
    let plan = overlapped([10.0, 10.0], 0.06, &limits(), 100.0);
    let exact = verify(&plan, &wide(5.0), &limits());
    for period in [0.000_1, 0.001] {
        let report = judged(&plan, &wide(5.0), period);
        let (found, truth) = (report.corner_error.value, exact.corner_error.value);
        assert!(found <= truth && found > truth - 0.004, "{found} {truth}");
        assert!(report.passes(), "{:?}", report.examples);
        let report = judged(&plan, &wide(0.98 * truth), period);
        assert!(
            report.examples.iter().any(|violation| matches!(
                violation,
                Violation::CornerMissed { place, .. } if place.mv == 0
            )),
            "{:?}",
            report.examples
        );
        assert!(
            !report
                .examples
                .iter()
                .any(|violation| matches!(violation, Violation::MoveSkipped { .. })),
            "the motion is found again"
        );
    }
}

#[test]
fn limits_are_judged_by_mean_derivatives() {
    let path = path(&[line([10.0, 0.0])]);
    let harder = Limits::uniform(200.0, 2_100.0, 50_000.0).unwrap();
    let report = judged(&stop_and_go(&path, &harder), &path, 0.001);
    assert!(
        (report.peak_acceleration[0].value - 2_100.0).abs() < 30.0,
        "{:?}",
        report.peak_acceleration
    );
    assert!(
        !report.passes()
            && report
                .examples
                .iter()
                .all(|v| matches!(v, Violation::Acceleration { axis: 0, .. })),
        "{:?}",
        report.examples
    );
    let faster = super::build::path(&[Move::line_to(
        Vector::<2>::new(10.0, 0.0),
        Feedrate::new(103.0).unwrap(),
        Tolerance::new(0.01).unwrap(),
    )
    .unwrap()]);
    let report = judged(&stop_and_go(&faster, &limits()), &path, 0.001);
    assert!(
        !report.passes()
            && report
                .examples
                .iter()
                .all(|v| matches!(v, Violation::Feedrate { .. })),
        "{:?}",
        report.examples
    );
    assert!(
        report.feedrate_overshoot.value > 1.0,
        "{:?}",
        report.feedrate_overshoot
    );
}

#[test]
fn a_slow_move_between_rapids_keeps_its_feedrate() {
    let tolerance = Tolerance::new(0.01).unwrap();
    let to =
        |x: f64, feedrate| Move::line_to(Vector::<2>::new(x, 0.0), feedrate, tolerance).unwrap();
    let slow = Feedrate::new(50.0).unwrap();
    let made = path(&[
        to(10.0, Feedrate::RAPID),
        to(20.0, Feedrate::RAPID),
        to(0.0, Feedrate::RAPID),
    ]);
    let meant = path(&[
        to(10.0, Feedrate::RAPID),
        to(20.0, slow),
        to(0.0, Feedrate::RAPID),
    ]);
    let report = judged(&stop_and_go(&made, &limits()), &meant, 0.001);
    assert!(
        !report.passes()
            && report
                .examples
                .iter()
                .all(|v| matches!(v, Violation::Feedrate { place, .. } if place.mv == 1)),
        "{:?}",
        report.examples
    );
}

#[test]
fn stops_and_dwells_are_found_among_points() {
    let through = path(&[line([20.0, 0.0])]);
    let stopping = path(&[line([10.0, 0.0]).with_exact_stop(), line([20.0, 0.0])]);
    let report = judged(&stop_and_go(&through, &limits()), &stopping, 0.001);
    assert_eq!(report.violations, 1, "{:?}", report.examples);
    assert!(
        matches!(report.examples[0], Violation::StopNotMade { place, .. } if place.mv == 0),
        "{:?}",
        report.examples
    );
    let tolerance = Tolerance::new(0.01).unwrap();
    let dwell = |time| {
        path(&[
            line([10.0, 0.0]),
            Move::dwell(time, tolerance).unwrap(),
            line([20.0, 0.0]),
        ])
    };
    let plan = stop_and_go(&dwell(0.5), &limits());
    assert!(judged(&plan, &dwell(0.5), 0.001).passes(), "long enough");
    let report = judged(&plan, &dwell(0.51), 0.001);
    assert_eq!(report.violations, 1, "{:?}", report.examples);
    assert!(
        matches!(report.examples[0], Violation::DwellTooShort { rested, place, .. }
            if place.mv == 1 && (rested - 0.5).abs() < 0.004),
        "{:?}",
        report.examples
    );
}

#[test]
fn the_ends_must_be_at_rest() {
    let path = path(&[line([10.0, 0.0])]);
    let points = set_points(&stop_and_go(&path, &limits()), 0.001);
    let late = points.len() - 20;
    let cut = verify_set_points(points[..late].iter().copied(), &path, &limits(), 0.0).unwrap();
    assert!(
        cut.examples
            .iter()
            .any(|v| matches!(v, Violation::EndsElsewhere { .. }))
            && cut
                .examples
                .iter()
                .any(|v| matches!(v, Violation::EndsMoving { axis: 0, .. })),
        "{:?}",
        cut.examples
    );
    let leap = [
        points[0],
        (0.001, Vector::<2>::new(0.05, 0.0)),
        (0.002, Vector::<2>::new(0.1, 0.0)),
    ];
    let report = verify_set_points(leap, &path, &limits(), 0.0).unwrap();
    assert!(
        report
            .examples
            .iter()
            .any(|v| matches!(v, Violation::StartsMoving { axis: 0 })),
        "{:?}",
        report.examples
    );
}

#[test]
fn points_that_are_no_motion_are_refused() {
    let path = path(&[line([10.0, 0.0])]);
    let zero = Vector::<2>::zeros();
    let mut judge = SetPointJudge::new(path.start(), limits(), 0.0);
    judge.expect(&path.moves()[0]).unwrap();
    assert_eq!(
        judge.observe(0.0, Vector::<2>::new(1.0, 0.0)),
        Err(VerifyError::NotAtStart { distance: 1.0 }),
        "start"
    );
    assert_eq!(
        judge.observe(5.0, zero),
        Ok(()),
        "any time may be the first"
    );
    assert!(
        matches!(
            judge.observe(5.0, zero),
            Err(VerifyError::Time { index: 1, .. })
        ),
        "time"
    );
    assert_eq!(
        judge.observe(6.0, zero.map(|_| f64::NAN)),
        Err(VerifyError::NotFinite { index: 1 }),
        "position"
    );
    let mut judge = SetPointJudge::new(path.start(), limits(), -1.0);
    assert_eq!(
        judge.observe(0.0, zero),
        Err(VerifyError::Resolution { value: -1.0 }),
        "resolution"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_legal_motion_never_breaks_anything(
        ends in proptest::collection::vec([-20.0..20.0_f64, -20.0..20.0], 1..6),
        stops in 0_u32..64,
        period in 0.000_3..0.02_f64,
        jitter in 0.0..0.9_f64,
        shift in -1e5..1e5_f64,
    ) {
        let feedrate = Feedrate::new(70.0).unwrap();
        let tolerance = Tolerance::new(0.01).unwrap();
        let start = Vector::<2>::new(shift, -shift);
        let mut path = Toolpath::starting_at(start).unwrap();
        for (index, end) in ends.iter().enumerate() {
            let mut step = Move::line_to(start + Vector::from(*end), feedrate, tolerance).unwrap();
            if stops & (1 << index) != 0 {
                step = step.with_exact_stop();
            }
            path.push(step).unwrap();
        }
        let plan = stop_and_go(&path, &limits());
        let exact = verify(&plan, &path, &limits());
        prop_assert!(exact.passes(), "{:?}", exact.examples);
        let mut time = 0.0;
        let mut points = vec![(0.0, start)];
        let mut turn = 0.5_f64;
        loop {
            turn = (turn * 997.0).fract();
            time += period * (1.0 - jitter * turn);
            if time >= plan.duration() {
                break;
            }
            points.push((time, plan.sample(time).position));
        }
        points.push((plan.duration(), plan.end()));
        let report = verify_set_points(points, &path, &limits(), 0.0).unwrap();
        prop_assert_eq!(report.violations, 0, "{:?}", report.examples);
        prop_assert!(period > 0.001 || report.passes(), "{:?}", report.gaps);
        for axis in 0..2 {
            prop_assert!(report.peak_jerk[axis].value <= 50_000.0 * (1.0 + 1e-9), "jerk");
        }
    }
}

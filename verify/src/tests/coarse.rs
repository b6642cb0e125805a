//! Set-points too far apart to be judged, and those that are just near enough.

use super::build::{limits, line, path, set_points, stop_and_go};
use crate::{Report, SetPointJudge, Unseen, verify_set_points};
use toolglide_kinematics::{Feedrate, Limits, Move, Tolerance, Toolpath, Vector};

type Rows<const N: usize> = Vec<(f64, Vector<N>)>;

fn near(one: f64, other: f64) -> bool {
    (one - other).abs() <= 1e-12 * other.abs()
}

fn zigzag() -> Toolpath<2> {
    path(&[line([10.0, 5.0]), line([0.0, 9.0]), line([5.0, 9.0])])
}

fn judge<const N: usize>(rows: &Rows<N>, path: &Toolpath<N>, limits: &Limits<N>) -> Report<N> {
    verify_set_points(rows.iter().copied(), path, limits, 0.0).unwrap()
}

/// Every so many of the rows, and the last.
fn decimated(rows: &Rows<2>, every: usize) -> Rows<2> {
    let last = rows.len() - 1;
    let kept = rows.iter().enumerate();
    let kept = kept.filter(|(index, _)| index % every == 0 || *index == last);
    kept.map(|(_, row)| *row).collect()
}

#[test]
fn the_first_and_last_row_of_a_program_show_none_of_its_corners() {
    let rows = vec![(0.0, Vector::zeros()), (0.7, Vector::from([5.0, 9.0]))];
    let report = judge(&rows, &zigzag(), &limits());
    assert_eq!(report.violations, 0, "{:?}", report.examples);
    assert!(!report.passes(), "two rows pass");
    assert_eq!(report.gaps.count, 1);
    let gap = report.gaps.examples[0];
    assert!(
        matches!(gap.unseen, Unseen::Path { hidden, tolerance } if hidden > 100.0 && near(tolerance, 0.01)),
        "{gap}"
    );
    assert!(near(gap.begin, 0.0) && near(gap.duration, 0.7), "{gap}");
}

#[test]
fn rows_of_a_servo_pass_and_few_of_them_do_not() {
    let path = zigzag();
    let rows = set_points(&stop_and_go(&path, &limits()), 0.001);
    let report = judge(&rows, &path, &limits());
    assert!(report.passes(), "{:?}{:?}", report.examples, report.gaps);
    for every in [10, 100, 1000] {
        let few = decimated(&rows, every);
        let report = judge(&few, &path, &limits());
        assert_eq!(report.violations, 0, "{every}: {:?}", report.examples);
        assert!(!report.passes(), "every {every}th row");
    }
}

#[test]
fn rows_that_are_missing_are_told_with_their_time_and_move() {
    let path = zigzag();
    let mut rows = set_points(&stop_and_go(&path, &limits()), 0.001);
    let (before, after) = (rows[260], rows[281]);
    rows.drain(261..281);
    let report = judge(&rows, &path, &limits());
    assert_eq!((report.violations, report.gaps.count), (0, 1));
    let gap = report.gaps.examples[0];
    assert!(near(gap.begin, before.0), "{gap}");
    assert!((gap.duration - (after.0 - before.0)).abs() < 1e-12, "{gap}");
    assert_eq!(gap.place.line, 11, "{gap}");
}

#[test]
fn a_corner_cut_between_rows_is_not_called_kept() {
    // The motion goes straight from the start to the end of the path, past two corners.
    let short = path(&[line([5.0, 9.0])]);
    let motion = stop_and_go(&short, &limits());
    let rows = set_points(&motion, 0.001);
    assert!(judge(&rows, &zigzag(), &limits()).violations > 0, "seen");
    let ends = vec![rows[0], rows[rows.len() - 1]];
    let report = judge(&ends, &zigzag(), &limits());
    assert!(!report.passes(), "the ends alone");
}

/// Rows of an even acceleration of one axis.
fn thrust(acceleration: f64, period: f64) -> Rows<1> {
    (0..40)
        .map(|k| f64::from(k) * period)
        .map(|t| (t, Vector::from([0.5 * acceleration * t * t])))
        .collect()
}

fn straight(tolerance: f64, stop: bool) -> Toolpath<1> {
    let feedrate = Feedrate::new(1e6).unwrap();
    let tolerance = Tolerance::new(tolerance).unwrap();
    let one = Move::line_to(Vector::from([1e-3]), feedrate, tolerance).unwrap();
    let one = if stop { one.with_exact_stop() } else { one };
    path(&[
        one,
        Move::line_to(Vector::from([1e4]), feedrate, tolerance).unwrap(),
    ])
}

#[test]
fn a_path_is_shown_up_to_the_spacing_at_which_the_motion_may_leave_its_chord() {
    let limits = Limits::uniform(1e6, 2_000.0, 4_000.0).unwrap();
    let needed = (8.0 * 0.04 / 2_000.0_f64).sqrt();
    for (share, coarse) in [(0.999_99, false), (1.000_01, true)] {
        let rows = thrust(2_000.0, share * needed);
        let report = judge(&rows, &straight(0.04, false), &limits);
        let paths = report
            .gaps
            .examples
            .iter()
            .filter_map(|gap| match gap.unseen {
                Unseen::Path { hidden, .. } => Some((hidden, gap.needed)),
                _ => None,
            });
        let found: Vec<_> = paths.collect();
        assert_eq!(!found.is_empty(), coarse, "{share}: {:?}", report.gaps);
        for (hidden, told) in found {
            assert!((hidden - 0.04 * share * share).abs() < 1e-9, "{hidden}");
            assert!((told - needed).abs() < 1e-9, "{told} instead of {needed}");
        }
    }
}

#[test]
fn a_stop_is_shown_up_to_the_spacing_at_which_an_axis_may_rest_between_rows() {
    let limits = Limits::uniform(1e6, 2_000.0, 60_000.0).unwrap();
    let reach = 60_000.0 * 0.02_f64.powi(3) / 6.0;
    for (share, coarse) in [(0.999_99, true), (1.000_01, false)] {
        let tolerance = reach * share;
        let rows = vec![(0.0, Vector::zeros()), (0.02, Vector::from([1e-3]))];
        let report = judge(&rows, &straight(tolerance, true), &limits);
        let stops = report.gaps.examples.iter();
        let stops = stops.filter(|gap| matches!(gap.unseen, Unseen::Stop { .. }));
        assert_eq!(stops.count() > 0, coarse, "{share}: {:?}", report.gaps);
    }
}

#[test]
fn limits_are_shown_up_to_the_spacing_at_which_differences_can_exceed_them() {
    let wide = straight(1e3, false);
    for (jerk, velocity, most, jerk_told) in
        [(200_000.0, 1e6, 0.02, true), (1_000.0, 30.0, 0.03, false)]
    {
        let limits = Limits::uniform(velocity, 2_000.0, jerk).unwrap();
        for (share, coarse) in [(0.999_99, false), (1.000_01, true)] {
            let report = judge(&thrust(1.0, most * share), &wide, &limits);
            assert_eq!(!report.gaps.is_empty(), coarse, "{:?}", report.gaps);
            for gap in &report.gaps.examples {
                let is_jerk = gap.unseen == (Unseen::Jerk { axis: 'X' });
                let is_other = gap.unseen == (Unseen::Acceleration { axis: 'X' });
                assert!(if jerk_told { is_jerk } else { is_other }, "{gap}");
                assert!((gap.needed - most).abs() < 1e-12, "{gap}");
            }
        }
    }
}

#[test]
fn rows_of_a_servo_are_never_too_coarse_whatever_the_limits() {
    // Neither the jerk nor a tolerance of a nanometre can be seen a millisecond apart.
    let limits = Limits::uniform(1e6, 2_000.0, 1e9).unwrap();
    for (period, coarse) in [(0.001, false), (0.001_1, true)] {
        let rows = thrust(1_000.0, period);
        let report = judge(&rows, &straight(1e-6, true), &limits);
        assert_eq!(!report.gaps.is_empty(), coarse, "{:?}", report.gaps);
    }
}

#[test]
fn a_tolerance_is_the_smallest_of_all_moves_between_two_rows() {
    let feedrate = Feedrate::new(100.0).unwrap();
    let to = |x: f64, y: f64, tolerance: f64| {
        let tolerance = Tolerance::new(tolerance).unwrap();
        Move::line_to(Vector::from([x, y]), feedrate, tolerance).unwrap()
    };
    let path = path(&[
        to(10.0, 0.0, 0.5),
        to(10.001, 0.0, 0.5),
        to(10.002, 0.0, 1e-3),
        to(10.003, 0.0, 0.5),
        to(20.0, 0.0, 0.5),
    ]);
    let limits = Limits::uniform(200.0, 2_000.0, 50_000.0).unwrap();
    let rows: Rows<2> = (0..50)
        .map(|k| f64::from(k) * 0.008)
        .map(|t| (t, Vector::from([100.0 * t, 0.0])))
        .collect();
    let mut judge = SetPointJudge::new(Vector::zeros(), limits, 0.0);
    for next in path.moves() {
        judge.expect(next).unwrap();
    }
    for (time, at) in &rows[..26] {
        judge.observe(*time, *at).unwrap();
    }
    let report = judge.finish();
    assert!(
        report.gaps.examples.iter().all(|gap| matches!(
            gap.unseen,
            Unseen::Path { tolerance, .. } if near(tolerance, 1e-3)
        )) && !report.gaps.is_empty(),
        "{:?}",
        report.gaps
    );
}

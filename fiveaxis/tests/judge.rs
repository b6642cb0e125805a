//! The judge of poses finds what is wrong with a motion that was right.

mod common;

use common::{Planned, STAR, judge, legs, plan, settings, start_of, table_ac};
use toolglide_fiveaxis::PoseMethod;
use toolglide_kinematics::{Axis, AxisLimits, MachineKinematics, PoseLeg, PosePath};
use toolglide_verify::PoseReport;

const SPEED: f64 = 50.0;
const TIP: f64 = 0.1;
const ORIENTATION: f64 = 0.001;

/// A motion along the star that keeps everything, with what it was planned for.
fn right() -> (Box<dyn MachineKinematics>, Vec<Axis>, Vec<PoseLeg>, Planned) {
    let (machine, axes) = table_ac();
    let start = start_of(machine.as_ref(), &STAR[0]);
    let legs = legs(&STAR, SPEED, TIP, ORIENTATION);
    let settings = settings([0.1, 0.06], PoseMethod::DwellControlled);
    let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
    let report = judge(machine.as_ref(), &axes, &legs, &planned);
    assert!(report.passes(), "{:#?}", report.examples);
    (machine, axes, legs, planned)
}

/// Whether a violation says this.
fn tells(report: &PoseReport, words: &str) -> bool {
    report
        .examples
        .iter()
        .any(|violation| violation.to_string().contains(words))
}

#[test]
fn a_limit_just_below_the_peak_of_an_axis_is_exceeded() {
    let (machine, axes, legs, planned) = right();
    let report = judge(machine.as_ref(), &axes, &legs, &planned);
    for (index, peaks) in report.axes.iter().enumerate() {
        let below = |value: f64| 0.99 * value;
        for quantity in ["velocity", "acceleration", "jerk"] {
            let wide = |peak: f64| 10.0 * peak;
            let (mut velocity, mut acceleration, mut jerk) = (
                wide(peaks.velocity.value),
                wide(peaks.acceleration.value),
                wide(peaks.jerk.value),
            );
            match quantity {
                "velocity" => velocity = below(peaks.velocity.value),
                "acceleration" => acceleration = below(peaks.acceleration.value),
                _ => jerk = below(peaks.jerk.value),
            }
            let mut tight = axes.clone();
            tight[index].limits = AxisLimits::new(velocity, acceleration, jerk).unwrap();
            let report = judge(machine.as_ref(), &tight, &legs, &planned);
            let words = format!("axis {}: {quantity}", peaks.name);
            assert!(tells(&report, &words), "{words}: {:#?}", report.examples);
        }
    }
}

#[test]
fn tolerances_just_below_the_largest_deviations_are_exceeded() {
    let (machine, axes, _, planned) = right();
    let full = legs(&STAR, SPEED, TIP, ORIENTATION);
    let report = judge(machine.as_ref(), &axes, &full, &planned);
    let tip = report.tip_ratio.value.max(report.tip_corner_ratio.value);
    let orientation = report
        .orientation_ratio
        .value
        .max(report.orientation_corner_ratio.value);
    let tight = legs(&STAR, SPEED, 0.99 * tip * TIP, ORIENTATION);
    let report = judge(machine.as_ref(), &axes, &tight, &planned);
    assert!(!report.passes(), "a tip outside its tolerance passes");
    let tight = legs(&STAR, SPEED, TIP, 0.99 * orientation * ORIENTATION);
    let report = judge(machine.as_ref(), &axes, &tight, &planned);
    assert!(
        !report.passes(),
        "an orientation outside its tolerance passes"
    );
}

#[test]
fn a_motion_that_lacks_a_piece_or_ends_early_is_refused() {
    let (machine, axes, legs, planned) = right();
    let count = planned.pieces.len();
    for missing in [0, count / 2, count - 1] {
        let mut pieces = planned.pieces.clone();
        pieces.remove(missing);
        let broken = Planned {
            pieces,
            slowdowns: Vec::new(),
            start: planned.start,
        };
        let report = judge(machine.as_ref(), &axes, &legs, &broken);
        assert!(!report.passes(), "piece {missing} is missed by nobody");
    }
}

#[test]
fn a_motion_along_another_path_is_refused() {
    let (machine, axes, _, planned) = right();
    let mut elsewhere = STAR;
    elsewhere[4][2] += 2.0 * TIP;
    let other = legs(&elsewhere, SPEED, TIP, ORIENTATION);
    let report = judge(machine.as_ref(), &axes, &other, &planned);
    assert!(!report.passes(), "a tip beside its corner passes");
    let mut leaning = STAR;
    leaning[6][3] += 0.02;
    let length = leaning[6][3..]
        .iter()
        .map(|part| part * part)
        .sum::<f64>()
        .sqrt();
    for part in &mut leaning[6][3..] {
        *part /= length;
    }
    let other = legs(&leaning, SPEED, TIP, ORIENTATION);
    let report = judge(machine.as_ref(), &axes, &other, &planned);
    assert!(!report.passes(), "a tool that leans otherwise passes");
}

#[test]
fn a_feedrate_below_that_of_the_motion_is_exceeded() {
    let (machine, axes, _, planned) = right();
    let slower = legs(&STAR, 0.9 * SPEED, TIP, ORIENTATION);
    let report = judge(machine.as_ref(), &axes, &slower, &planned);
    assert!(!report.passes(), "a tip faster than its feedrate passes");
}

#[test]
fn a_motion_many_turns_away_is_judged_as_at_home() {
    let (machine, axes, legs, planned) = right();
    let home = judge(machine.as_ref(), &axes, &legs, &planned);
    let mut away = planned;
    away.start[4] += 20.0 * std::f64::consts::TAU;
    let away = judge(machine.as_ref(), &axes, &legs, &away);
    for (home, away) in home.axes.iter().zip(&away.axes) {
        let miss = (home.jerk.value - away.jerk.value).abs();
        assert!(
            miss < 1e-3 * home.jerk.value,
            "{}: {miss} of jerk",
            home.name
        );
    }
    assert!(away.passes(), "{:#?}", away.examples);
}

/// The star with an exact stop at its fifth pose and a dwell of a quarter of a second after its tenth,
/// planned after `change` has been made to it.
fn with_stop_and_dwell(change: impl FnOnce(&mut Vec<PoseLeg>)) -> PoseReport {
    let (machine, axes) = table_ac();
    let start = start_of(machine.as_ref(), &STAR[0]);
    let mut asked = legs(&STAR, SPEED, TIP, ORIENTATION);
    asked[4].stop = true;
    let dwell = PoseLeg {
        path: PosePath::Dwell { duration: 0.25 },
        ..asked[9].clone()
    };
    asked.insert(10, dwell);
    let mut planned_for = asked.clone();
    change(&mut planned_for);
    let settings = settings([0.1, 0.06], PoseMethod::DwellControlled);
    let planned = plan(machine.as_ref(), &axes, start, &planned_for, &settings);
    judge(machine.as_ref(), &axes, &asked, &planned)
}

#[test]
fn stops_and_dwells_must_be_made() {
    let report = with_stop_and_dwell(|_| {});
    assert!(report.passes(), "{:#?}", report.examples);
    let report = with_stop_and_dwell(|legs| legs[4].stop = false);
    assert!(tells(&report, "stop"), "no stop: {:#?}", report.examples);
    let report = with_stop_and_dwell(|legs| {
        legs[10].path = PosePath::Dwell { duration: 0.2 };
    });
    assert!(
        tells(&report, "dwell"),
        "a short dwell: {:#?}",
        report.examples
    );
}

//! No legal plan scores above 1, whichever method made it and however coarse the grid of the optimum is.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use toolglide_kinematics::{Feedrate, Limits, Move, Plan, Tolerance, Toolpath, Vector};
use toolglide_reference::{Section, Settings, hold, part, score, sections};
use toolglide_smoothing::Method;
use toolglide_verify::verify;

/// Intervals of time of an optimum: coarse, so that plans are often faster.
const INTERVALS: usize = 24;

/// Rounding of a sum of durations, relative.
const ROUNDING: f64 = 1e-12;

/// A move: where to, mm; tolerance, mm; feedrate, mm/s; whether it stops.
type Step = ([f64; 2], f64, f64, bool);

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let log = |low: f64, high: f64| (low.ln()..high.ln()).prop_map(f64::exp);
    let step = (
        prop::array::uniform2(-15.0..15.0_f64),
        log(1e-3, 0.1),
        log(5.0, 200.0),
        prop::bool::weighted(0.2),
    );
    prop::collection::vec(step, 1..6)
}

fn path(steps: &[Step]) -> Toolpath<2> {
    let mut path = Toolpath::starting_at(Vector::<2>::zeros()).unwrap();
    for (end, tolerance, feedrate, stops) in steps {
        let tolerance = Tolerance::new(*tolerance).unwrap();
        let feedrate = Feedrate::new(*feedrate).unwrap();
        let next = Move::line_to(Vector::<2>::from(*end), feedrate, tolerance).unwrap();
        path.push(if *stops { next.with_exact_stop() } else { next })
            .unwrap();
    }
    path
}

fn plans(path: &Toolpath<2>, limits: Limits<2>) -> Vec<(&'static str, Plan<2>)> {
    let smoothed = [Method::Kcs, Method::ExactStop].map(|method| {
        let settings = toolglide_smoothing::Settings::new(limits).with_method(method);
        let plan = toolglide_smoothing::plan(path, &settings).unwrap();
        (method.name(), plan)
    });
    let optimal = toolglide_optimal::plan(path, &toolglide_optimal::Settings::new(limits)).unwrap();
    smoothed.into_iter().chain([("optimal", optimal)]).collect()
}

/// Scores every plan of a path; gives the optimum of the whole path, s.
fn never_above_one(path: &Toolpath<2>, intervals: usize) -> Result<f64, TestCaseError> {
    let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
    let plans = plans(path, limits);
    let legal: Vec<bool> = plans
        .iter()
        .map(|(_, plan)| verify(plan, path, &limits).passes())
        .collect();
    prop_assert!(legal.iter().all(|legal| *legal), "{legal:?}");
    let settings = Settings::default().with_intervals(intervals);
    let mut total = 0.0;
    for section in sections(path, limits).unwrap() {
        let Section::Course(course) = section else {
            continue;
        };
        let parts: Vec<_> = plans.iter().map(|(_, plan)| part(plan, &course)).collect();
        let Ok(found) = hold(&course, &parts, &legal, &settings, &mut || {}) else {
            continue;
        };
        let optimum = &found.optimum;
        total += optimum.duration();
        prop_assert!(
            optimum.lower_bound() <= optimum.duration() * (1.0 + ROUNDING),
            "{} s, but no less than {} s",
            optimum.duration(),
            optimum.lower_bound()
        );
        for ((method, _), held) in plans.iter().zip(&found.motions) {
            let score = score(optimum.duration(), held.duration);
            prop_assert!(score <= 1.0 + ROUNDING, "{method} scores {score}");
        }
    }
    Ok(total)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_legal_plan_scores_above_one(steps in steps()) {
        never_above_one(&path(&steps), INTERVALS)?;
    }
}

#[test]
fn the_optimum_where_tolerance_and_mode_change_is_no_slower_than_exact_stops() {
    // Intervals of the whole grid last 15 ms here, and a corner is over in 18 ms.
    let slow = 1000.0 / 60.0;
    let steps = [
        ([10.0, 0.0], 0.05, slow, false),
        ([10.0, 10.0], 0.05, slow, false),
        ([20.0, 10.0], 0.001, slow, false),
        ([20.0, 20.0], 0.001, slow, false),
        ([30.0, 20.0], 0.001, slow, true),
        ([30.0, 30.0], 0.001, slow, false),
    ];
    let optimum = never_above_one(&path(&steps), 240).unwrap();
    assert!(
        optimum < 3.675,
        "exact stops take 3.7095 s, kcs 3.6747 s: {optimum}"
    );
}

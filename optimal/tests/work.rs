//! Planning costs no more than motion earns, counted in intervals times steps of the solver, and no move much more
//! than a window.

#![allow(
    clippy::unwrap_used,
    clippy::cast_precision_loss,
    reason = "a failed unwrap is a failed test; counts are small"
)]

use toolglide_kinematics::{
    Arc, Feedrate, Limits, MotionPlanner, Move, Plan, Tolerance, Toolpath, Trajectory, Vector,
};
use toolglide_optimal::{Settings, Smoothing, TimeOptimal};
use toolglide_verify::verify;

/// Work that may be spent before motion has earned it, and what a second of it earns in three axes: a quarter of it
/// is there for smoothing.
const STORE: f64 = 5e5;
const EARNED: f64 = 2.5e5;

/// Most work of a window, and what a move may have cost before it.
const WINDOW: u64 = 225_000;
const BEFORE: u64 = 80_000;

fn limits() -> Limits<3> {
    Limits::uniform(500.0, 2500.0, 2e5).unwrap()
}

/// A motion, what it cost, and what the costliest move before the end cost.
fn plan(path: &Toolpath<3>) -> (Plan<3>, u64, u64) {
    let mut planner = TimeOptimal::new(path.start(), &Settings::new(limits()));
    let mut plan = Plan::starting_at(path.start());
    let (mut before, mut costliest) = (0, 0);
    for step in path.moves() {
        planner.push(step).unwrap();
        plan.extend(std::iter::from_fn(|| planner.pull()));
        let work = planner.windows().unwrap().work;
        costliest = costliest.max(work - before);
        before = work;
    }
    planner.finish().unwrap();
    plan.extend(std::iter::from_fn(|| planner.pull()));
    (plan, planner.windows().unwrap().work, costliest)
}

/// Plans, and holds the motion to the judge, to smoothed corners, and to the budget; gives the share of the
/// budget that was spent.
fn holds(path: &Toolpath<3>) -> f64 {
    let (motion, work, costliest) = plan(path);
    let report = verify(&motion, path, &limits());
    assert!(report.passes(), "{:#?}", report.examples);
    let settings = toolglide_smoothing::Settings::new(limits());
    let smoothed = toolglide_smoothing::plan(path, &settings).unwrap();
    let (duration, smoothed) = (motion.duration(), smoothed.duration());
    let most = smoothed * (1.0 + Smoothing::DEFAULT.indifference());
    assert!(duration <= most, "{duration} s, {smoothed} s");
    let budget = STORE + EARNED * duration;
    assert!(work as f64 <= budget, "{work} for {duration} s");
    assert!(costliest <= WINDOW + BEFORE, "{costliest} for one move");
    work as f64 / budget
}

/// Half circles of a radius from side to side, within a tolerance.
fn half_circles(count: u32, radius: f64, tolerance: f64) -> Toolpath<3> {
    let mut path = Toolpath::starting_at(Vector::<3>::zeros()).unwrap();
    let mut at = Vector::<3>::zeros();
    for index in 0..count {
        let center = at + Vector::<3>::new(radius, 0.0, 0.0);
        let end = at + Vector::<3>::new(2.0 * radius, 0.0, 0.0);
        let arc = Arc::about(at, end, center, [0, 1], index % 2 == 0, 0).unwrap();
        let tolerance = Tolerance::new(tolerance).unwrap();
        path.push(Move::arc(arc, Feedrate::new(60.0).unwrap(), tolerance))
            .unwrap();
        at = end;
    }
    path
}

/// Moves of a length in all directions of space.
fn scribble(count: u32, length: f64) -> Toolpath<3> {
    let mut at = Vector::<3>::zeros();
    let mut points = vec![at];
    for k in 0..count {
        let t = f64::from(k);
        let way = Vector::<3>::new((1.7 * t).sin(), (2.9 * t).cos(), (4.3 * t).sin());
        at += way.normalize() * length;
        points.push(at);
    }
    let feedrate = Feedrate::new(100.0).unwrap();
    Toolpath::from_points(&points, feedrate, Tolerance::new(0.01).unwrap()).unwrap()
}

#[test]
fn arcs_within_a_hundredth_of_a_micrometre_cost_no_more_than_others() {
    // Some hundred thousand chords a second: all windows together would cost ten times the budget.
    let share = holds(&half_circles(6, 3.0, 1e-5));
    assert!(share > 0.2, "windows were solved: {share}");
}

#[test]
fn usual_arcs_are_planned_within_a_part_of_the_budget() {
    let share = holds(&half_circles(12, 3.0, 0.01));
    assert!(share < 0.6, "{share}");
}

#[test]
fn short_moves_in_all_directions_cost_no_more_than_they_earn() {
    holds(&scribble(300, 0.1));
}

#[test]
fn three_long_moves_are_enough_for_motion_to_begin_and_it_stays_as_near_behind() {
    let mut at = Vector::<3>::zeros();
    let mut points = vec![at];
    for index in 0..30 {
        at[index % 2] += 50.0;
        points.push(at);
    }
    let feedrate = Feedrate::new(100.0).unwrap();
    let path = Toolpath::from_points(&points, feedrate, Tolerance::new(0.01).unwrap()).unwrap();
    let mut planner = TimeOptimal::new(path.start(), &Settings::new(limits()));
    for (index, step) in (0_u32..).zip(path.moves()) {
        planner.push(step).unwrap();
        let last = std::iter::from_fn(|| planner.pull()).last();
        if index >= 2 {
            let served = last.map(|piece| piece.serves().last);
            assert!(
                served.is_some_and(|last| last + 2 >= index),
                "after move {index} motion has come to {served:?}"
            );
        }
    }
}

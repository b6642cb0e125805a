//! Turns the states that a solver found into exact pieces of motion.
//!
//! Source: a solver leaves residuals of some 1e-8. Jerks are integrated exactly, and over every few
//! intervals corrected by the least change that reaches the state wanted there; then the whole is
//! slowed until every limit is kept, which does not change where it passes. Not here: whether it
//! passes the judge.

use crate::course::Course;
use crate::motion::Motion;
use toolglide_kinematics::nalgebra::{Matrix3, Vector3};
use toolglide_kinematics::{MoveRange, Piece, Plan, Sample, Vector};

/// Intervals that are corrected together: few, so that residuals cannot add up; many, so that small
/// changes of jerk suffice.
const TOGETHER: usize = 32;

/// How often a correction is repeated: each time leaves some 1e-13 of what was there.
const REPEATS: usize = 3;

/// Share by which the motion stays below its limits, dimensionless: less than the judge forgives.
const BELOW: f64 = 1e-12;

/// The motion as pieces; `first_move` is added to the move that each piece serves.
pub(crate) fn pieces<const N: usize>(
    course: &Course<N>,
    motion: &Motion<N>,
    serves: &[usize],
) -> Plan<N> {
    let jerks = corrected(motion);
    let states = integrated(&motion.positions[0], &motion.steps, &jerks);
    let stretch = stretch(course, motion, serves, &jerks, &states);
    let mut plan = Plan::starting_at(course.start());
    let count = motion.steps.len();
    for (k, (&step, &leg)) in motion.steps.iter().zip(serves).enumerate() {
        let (position, velocity, acceleration) = states[k];
        let start = Sample {
            position: if k == 0 { course.start() } else { position },
            velocity: velocity / stretch,
            acceleration: acceleration / (stretch * stretch),
            jerk: jerks[k] / (stretch * stretch * stretch),
        };
        let end = if k + 1 == count {
            course.end()
        } else {
            states[k + 1].0
        };
        let serves = course.legs[leg].serves;
        let serves = MoveRange {
            first: serves,
            last: serves,
        };
        plan.push(Piece::new(&start, step * stretch, end, serves));
    }
    plan
}

type State<const N: usize> = (Vector<N>, Vector<N>, Vector<N>);

fn after<const N: usize>(state: &State<N>, jerk: &Vector<N>, t: f64) -> State<N> {
    let (p, v, a) = state;
    (
        p + (v + (a * 0.5 + jerk * (t / 6.0)) * t) * t,
        v + (a + jerk * (0.5 * t)) * t,
        a + jerk * t,
    )
}

fn integrated<const N: usize>(
    start: &Vector<N>,
    steps: &[f64],
    jerks: &[Vector<N>],
) -> Vec<State<N>> {
    let mut states = vec![(*start, Vector::zeros(), Vector::zeros())];
    for (&step, jerk) in steps.iter().zip(jerks) {
        let next = after(&states[states.len() - 1], jerk, step);
        states.push(next);
    }
    states
}

/// Jerks that lead exactly from state to state, over every few intervals.
fn corrected<const N: usize>(motion: &Motion<N>) -> Vec<Vector<N>> {
    let count = motion.steps.len();
    let mut jerks = motion.jerks.clone();
    let mut state = (motion.positions[0], Vector::zeros(), Vector::zeros());
    // Parts of nearly equal size.
    let parts = count.div_ceil(TOGETHER);
    for part in 0..parts {
        let range = part * count / parts..(part + 1) * count / parts;
        let end = range.end;
        let wanted = if end == count {
            (motion.positions[end], Vector::zeros(), Vector::zeros())
        } else {
            (
                motion.positions[end],
                motion.velocities[end],
                motion.accelerations[end],
            )
        };
        let steps = &motion.steps[range.clone()];
        let jerks = &mut jerks[range];
        for _ in 0..REPEATS {
            let reached = reach(&state, steps, jerks);
            correct(steps, jerks, &reached, &wanted);
        }
        state = reach(&state, steps, jerks);
    }
    jerks
}

fn reach<const N: usize>(state: &State<N>, steps: &[f64], jerks: &[Vector<N>]) -> State<N> {
    steps
        .iter()
        .zip(jerks)
        .fold(*state, |state, (&step, jerk)| after(&state, jerk, step))
}

/// Adds the least change of jerk that leads to the state wanted instead of the one reached.
fn correct<const N: usize>(
    steps: &[f64],
    jerks: &mut [Vector<N>],
    reached: &State<N>,
    wanted: &State<N>,
) {
    let total: f64 = steps.iter().sum();
    // What a unit of jerk in each interval adds to the end, with time in units of the total.
    let mut left = 1.0;
    let mut effects = Vec::with_capacity(steps.len());
    for &step in steps {
        let (before, after) = (left, left - step / total);
        let power = |n: i32| before.powi(n) - after.powi(n);
        effects.push(Vector3::new(power(1), power(2) / 2.0, power(3) / 6.0));
        left = after;
    }
    let gram: Matrix3<f64> = effects
        .iter()
        .map(|effect| effect * effect.transpose())
        .sum();
    let Some(inverse) = gram.try_inverse() else {
        return;
    };
    for axis in 0..N {
        let missing = Vector3::new(
            (wanted.2[axis] - reached.2[axis]) / total,
            (wanted.1[axis] - reached.1[axis]) / (total * total),
            (wanted.0[axis] - reached.0[axis]) / (total * total * total),
        );
        let weights = inverse * missing;
        for (jerk, effect) in jerks.iter_mut().zip(&effects) {
            jerk[axis] += effect.dot(&weights);
        }
    }
}

/// By how much all times must be multiplied so that every limit is kept.
fn stretch<const N: usize>(
    course: &Course<N>,
    motion: &Motion<N>,
    serves: &[usize],
    jerks: &[Vector<N>],
    states: &[State<N>],
) -> f64 {
    let limits = &course.limits;
    let mut stretch = 1.0_f64;
    for (k, (&step, &leg)) in motion.steps.iter().zip(serves).enumerate() {
        let (start, end) = (&states[k], &states[k + 1]);
        // Bezier points of the velocity enclose it.
        let between = start.1 + start.2 * (0.5 * step);
        for velocity in [&start.1, &between, &end.1] {
            stretch = stretch.max(velocity.norm() / course.legs[leg].feed);
            stretch = stretch.max(velocity.abs().component_div(limits.velocity()).max());
        }
        for acceleration in [&start.2, &end.2] {
            let share = acceleration.abs().component_div(limits.acceleration());
            stretch = stretch.max(share.max().sqrt());
        }
        let share = jerks[k].abs().component_div(limits.jerk());
        stretch = stretch.max(share.max().cbrt());
    }
    stretch * (1.0 + BELOW)
}

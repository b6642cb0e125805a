//! Runs a planner and a judge side by side, as a controller would.
//!
//! Not here: what the report must say.

use std::time::{Duration, Instant};
use toolglide_kinematics::{Limits, MotionPlanner, Move, Vector};
use toolglide_smoothing::{KinematicSmoothing, Settings};
use toolglide_verify::{Judge, Report};

/// What came of a stream of moves.
#[derive(Clone, Debug)]
pub struct Outcome<const N: usize> {
    /// What the judge found.
    pub report: Report<N>,
    /// How long planning took altogether.
    pub planning: Duration,
    /// How long the longest push took, with the pulls after it.
    pub longest: Duration,
    /// Most moves that the judge held at once.
    pub moves_held: u32,
}

/// Plans moves from the origin, pulling after each push, and has each piece judged at once.
///
/// # Panics
/// When the planner refuses a move.
#[must_use]
pub fn plan_and_judge<const N: usize>(
    moves: &[Move<N>],
    settings: &Settings<N>,
    limits: Limits<N>,
) -> Outcome<N> {
    let mut planner = KinematicSmoothing::new(Vector::zeros(), settings);
    let mut judge = Judge::new(Vector::zeros(), limits);
    let mut pieces = Vec::new();
    let (mut planning, mut longest, mut moves_held) = (Duration::ZERO, Duration::ZERO, 0);
    for step in moves.iter().map(Some).chain([None]) {
        let began = Instant::now();
        match step {
            Some(step) => planner.push(step).unwrap(),
            None => planner.finish().unwrap(),
        }
        while let Some(piece) = planner.pull() {
            pieces.push(piece);
        }
        let took = began.elapsed();
        planning += took;
        longest = longest.max(took);
        if let Some(step) = step {
            judge.expect(step).unwrap();
        }
        for piece in pieces.drain(..) {
            judge.observe(&piece);
        }
        moves_held = moves_held.max(judge.moves_held());
    }
    Outcome {
        report: judge.finish(),
        planning,
        longest,
        moves_held,
    }
}

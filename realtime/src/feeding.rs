//! Refuses pieces that do not follow or that break the limits of the plan, before they are executed.

use crate::settings::Settings;
use thiserror::Error;
use toolglide_kinematics::{Piece, Vector};

/// Pieces that begin this near to the end of the one before follow it, mm.
const JOINT: f64 = 1e-6;

/// Room granted to a limit of the plan, as a share: far below the reserve.
const SLACK: f64 = 1e-6;

/// Why a piece is refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FeedError {
    /// There is no room: tick, then feed it again.
    #[error("there is no room for another piece")]
    Full,
    /// After an abort nothing is taken until the operator resumes.
    #[error("the motion was aborted; resume before feeding what follows")]
    Aborted,
    /// It begins elsewhere.
    #[error("axis {axis} begins {gap} mm from where the piece before ends")]
    Gap {
        /// The axis, counted from 0.
        axis: usize,
        /// By how much, mm.
        gap: f64,
    },
    /// It jumps.
    #[error(
        "{quantity} of axis {axis} jumps by {jump} at the beginning of the piece, but may jump by {most}"
    )]
    Jump {
        /// "velocity" or "acceleration".
        quantity: &'static str,
        /// The axis, counted from 0.
        axis: usize,
        /// By how much.
        jump: f64,
        /// The most.
        most: f64,
    },
    /// It is faster than the plan may be.
    #[error("{quantity} of axis {axis} is {value}, but the plan may use {limit} of it")]
    Limit {
        /// "velocity", "acceleration" or "jerk".
        quantity: &'static str,
        /// The axis, counted from 0.
        axis: usize,
        /// The value.
        value: f64,
        /// The limit of the plan.
        limit: f64,
    },
}

/// The limits of the plan and the end of the last piece.
#[derive(Clone, Debug)]
pub(crate) struct Feeding<const N: usize> {
    velocity: [f64; N],
    acceleration: [f64; N],
    jerk: [f64; N],
    end: Vector<N>,
    last: (Vector<N>, Vector<N>),
}

impl<const N: usize> Feeding<N> {
    pub(crate) fn new(at: Vector<N>, settings: &Settings<N>) -> Self {
        let rho = settings.reserve.rho();
        Self {
            velocity: settings.fastest.into(),
            acceleration: (settings.limits.acceleration() * (rho * rho)).into(),
            jerk: (settings.limits.jerk() * (rho * rho * rho)).into(),
            end: at,
            last: (Vector::zeros(), Vector::zeros()),
        }
    }

    /// Begins anew at a point, at rest.
    pub(crate) fn begin_at(&mut self, at: Vector<N>) {
        self.end = at;
        self.last = (Vector::zeros(), Vector::zeros());
    }

    /// Checks the piece that follows.
    pub(crate) fn check(&mut self, piece: &Piece<N>) -> Result<(), FeedError> {
        let t = piece.duration();
        let (first, last) = (piece.at(0.0), piece.at(t));
        for axis in 0..N {
            let gap = (piece.start()[axis] - self.end[axis]).abs();
            if gap.is_nan() || gap > JOINT {
                return Err(FeedError::Gap { axis, gap });
            }
            let (v, a, j) = (
                self.velocity[axis],
                self.acceleration[axis],
                self.jerk[axis],
            );
            for (quantity, now, before, limit) in [
                ("velocity", first.velocity[axis], self.last.0[axis], v),
                (
                    "acceleration",
                    first.acceleration[axis],
                    self.last.1[axis],
                    a,
                ),
            ] {
                let (jump, most) = ((now - before).abs(), SLACK * limit);
                if jump.is_nan() || jump > most {
                    return Err(FeedError::Jump {
                        quantity,
                        axis,
                        jump,
                        most,
                    });
                }
            }
            // The velocity is a parabola: largest at an end or where the acceleration is 0.
            let (a0, a1, j0) = (
                first.acceleration[axis],
                last.acceleration[axis],
                first.jerk[axis],
            );
            let mut fastest = first.velocity[axis].abs().max(last.velocity[axis].abs());
            if a0 * a1 < 0.0 {
                fastest = fastest.max((first.velocity[axis] - 0.5 * a0 * a0 / j0).abs());
            }
            for (quantity, value, limit) in [
                ("velocity", fastest, v),
                ("acceleration", a0.abs().max(a1.abs()), a),
                ("jerk", j0.abs(), j),
            ] {
                if value.is_nan() || value > limit * (1.0 + SLACK) {
                    return Err(FeedError::Limit {
                        quantity,
                        axis,
                        value,
                        limit,
                    });
                }
            }
        }
        self.end = piece.end();
        self.last = (last.velocity, last.acceleration);
        Ok(())
    }
}

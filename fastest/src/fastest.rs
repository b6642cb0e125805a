//! Plans with every method that is the fastest on some paths.
//!
//! Not here: the comparison, see [`FasterOf`].

use crate::faster_of::FasterOf;
use toolglide_fir::FirInterpolation;
use toolglide_kinematics::{Limits, MotionPlanner, Move, Piece, Plan, PlanError, Toolpath, Vector};
use toolglide_smoothing::{KinematicSmoothing, Method, Settings};

/// Pieces that are held to compare kinds of corners: some 500 corners.
const HELD_OF_CORNERS: usize = 1 << 12;

/// Pieces that are held to compare corners with pulses.
const HELD: usize = 1 << 14;

/// Two kinds of planner.
type Pair<A, const N: usize> = FasterOf<A, KinematicSmoothing<N>, N>;

/// Plans kinematic corner smoothing while the path is being read, and hands out another motion where that is faster: one
/// kind of corner throughout, or feed pulses behind filters.
///
/// Between two places that all of them pass in the same state it is the fastest of them.
#[derive(Clone, Debug)]
pub struct Fastest<const N: usize> {
    planner: FasterOf<Pair<Pair<Pair<KinematicSmoothing<N>, N>, N>, N>, FirInterpolation<N>, N>,
}

impl<const N: usize> Fastest<N> {
    /// A planner whose motion begins at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, limits: Limits<N>) -> Self {
        let by =
            |method| KinematicSmoothing::new(start, &Settings::new(limits).with_method(method));
        let corners = FasterOf::new(
            start,
            by(Method::Kcs),
            by(Method::KcsInterrupted),
            &limits,
            HELD_OF_CORNERS,
        );
        let corners = FasterOf::new(
            start,
            corners,
            by(Method::KcsUninterrupted),
            &limits,
            HELD_OF_CORNERS,
        );
        let corners = FasterOf::new(
            start,
            corners,
            by(Method::KcsGlobal),
            &limits,
            HELD_OF_CORNERS,
        );
        let filtered = FirInterpolation::new(start, &toolglide_fir::Settings::new(limits));
        Self {
            planner: FasterOf::new(start, corners, filtered, &limits, HELD),
        }
    }
}

impl<const N: usize> MotionPlanner<N> for Fastest<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        self.planner.push(next)
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        self.planner.finish()
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        self.planner.pull()
    }
}

/// Plans a whole toolpath: a loop over the streaming planner.
///
/// # Errors
/// As [`MotionPlanner::push`].
pub fn plan<const N: usize>(path: &Toolpath<N>, limits: &Limits<N>) -> Result<Plan<N>, PlanError> {
    Plan::of(path, &mut Fastest::new(path.start(), *limits))
}

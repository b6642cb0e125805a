//! Selects the corner blends that a window tries at a corner.
//!
//! Source: the comparison of section 2.4, per corner. Not here: the motions, and how they share
//! short moves.

use crate::corner::interrupted::Interrupted;
use crate::corner::shape::BlendShape;
use crate::corner::stop_start::StopStart;
use crate::corner::uninterrupted::Uninterrupted;
use crate::method::{Method, Settings};
use toolglide_kinematics::{Corner, Limits, PathLimits};
use toolglide_profiles::{Blender, Boundary, SpeedRamp};

/// How the motions of one window are selected.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Selection<const N: usize> {
    kind: Kind,
    limits: Limits<N>,
    interrupted: Interrupted<N>,
    uninterrupted: Uninterrupted<N>,
    stop_start: StopStart<N>,
    unequal: [Uninterrupted<N>; UNEQUAL.len()],
}

/// Ratios of the speeds after and before a corner that are tried beside equal ones.
const UNEQUAL: [f64; 4] = [0.5, 0.75, 1.0 / 0.75, 2.0];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Interrupted,
    Uninterrupted,
    Fastest,
}

impl<const N: usize> Selection<N> {
    /// The selections whose windows a method plans with.
    pub(crate) fn of(settings: &Settings<N>) -> Vec<Self> {
        let kinds: &[Kind] = match settings.method {
            // Between its stops, an exact stop has only the chords of an arc to turn.
            Method::Kcs | Method::ExactStop => {
                &[Kind::Fastest, Kind::Interrupted, Kind::Uninterrupted]
            }
            Method::KcsInterrupted => &[Kind::Interrupted],
            Method::KcsUninterrupted | Method::KcsLocal | Method::KcsGlobal => {
                &[Kind::Uninterrupted]
            }
        };
        kinds
            .iter()
            .map(|&kind| Self {
                kind,
                limits: settings.limits,
                interrupted: Interrupted::new(settings.limits),
                uninterrupted: Uninterrupted::new(settings.limits),
                stop_start: StopStart::new(settings.limits),
                unequal: UNEQUAL.map(|ratio| Uninterrupted::unequal(settings.limits, ratio)),
            })
            .collect()
    }

    /// Whether the window starts from balanced scales: uninterrupted corners need it.
    pub(crate) fn is_balanced(&self) -> bool {
        self.kind != Kind::Interrupted
    }

    /// The uninterrupted corner as if the moves beside it were long.
    pub(crate) fn unscaled(&self, corner: &Corner<N>) -> Option<BlendShape> {
        self.uninterrupted
            .blend(corner)
            .ok()
            .map(|turn| *turn.shape())
    }

    /// The interrupted corner as if the moves beside it were long.
    pub(crate) fn interrupted(&self, corner: &Corner<N>) -> BlendShape {
        self.interrupted
            .blend(corner)
            .map_or(BlendShape::STOP, |turn| *turn.shape())
    }

    /// The motion for a corner between moves of two lengths.
    pub(crate) fn shape(&self, corner: &Corner<N>, before: f64, after: f64) -> BlendShape {
        let interrupted = || self.interrupted.blend(corner).map(|turn| *turn.shape());
        let uninterrupted = || self.uninterrupted.blend(corner).map(|turn| *turn.shape());
        let shape = match self.kind {
            Kind::Interrupted => interrupted(),
            Kind::Uninterrupted => uninterrupted().or_else(|_| interrupted()),
            Kind::Fastest => {
                let stop_start = self.stop_start.blend(corner).map(|turn| *turn.shape());
                let mut fastest = interrupted();
                // The longer move beside the corner has the higher speed.
                let unequal = self
                    .unequal
                    .iter()
                    .zip(UNEQUAL)
                    .filter(|(_, ratio)| (after > before) == (*ratio > 1.0))
                    .map(|(blender, _)| blender.blend(corner).map(|turn| *turn.shape()));
                for other in [uninterrupted(), stop_start].into_iter().chain(unequal) {
                    fastest = match (fastest, other) {
                        (Ok(one), Ok(other)) => Ok(self.faster(corner, before, after, one, other)),
                        (one, _) => one,
                    };
                }
                fastest
            }
        };
        shape.unwrap_or(BlendShape::STOP)
    }

    /// The turn that loses less time against passing the corner at the speeds that the moves reach.
    fn faster(
        &self,
        corner: &Corner<N>,
        before: f64,
        after: f64,
        one: BlendShape,
        other: BlendShape,
    ) -> BlendShape {
        let before = (self.limits.along(&corner.incoming), corner.speed_in, before);
        let after = (self.limits.along(&corner.outgoing), corner.speed_out, after);
        let loss = |shape: &BlendShape| {
            shape.duration
                + lost_beside(&shape.entry, &before.0, before.1, before.2)
                + lost_beside(&shape.exit, &after.0, after.1, after.2)
        };
        if loss(&other) < loss(&one) {
            other
        } else {
            one
        }
    }
}

/// Time from the boundary of a turn to the speed that a move reaches, less the time that the whole
/// way from the corner would take at that speed.
fn lost_beside(boundary: &Boundary, limits: &PathLimits, feedrate: f64, length: f64) -> f64 {
    let least = SpeedRamp::least_peak(boundary.speed, boundary.acceleration, limits.jerk);
    let reached = (0.25 * limits.jerk * length * length).cbrt(); // rest to rest over the move
    let peak = reached.min(feedrate).max(least);
    let rise = SpeedRamp::to_peak(
        boundary.speed,
        boundary.acceleration,
        peak,
        limits.acceleration,
        limits.jerk,
    );
    rise.duration() - (rise.distance + boundary.distance) / peak
}

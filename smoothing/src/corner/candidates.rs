//! Selects the corner blends that a window tries at a corner.
//!
//! Source: the comparison of section 2.4, per corner. Not here: the motions, and how they share
//! short moves.

use crate::corner::interrupted::Interrupted;
use crate::corner::stop_start::StopStart;
use crate::corner::uninterrupted::Uninterrupted;
use crate::method::{Method, Settings};
use std::sync::Arc;
use toolglide_kinematics::{Corner, Limits, PathLimits};
use toolglide_profiles::{BlendShape, Blender, Boundary, SpeedRamp};

/// The blenders that compete at every corner.
pub(crate) type Blenders<const N: usize> = Arc<[Arc<dyn Blender<N>>]>;

/// Ratios of the speeds after and before a corner that are tried beside equal ones.
const UNEQUAL: [f64; 4] = [0.5, 0.75, 1.0 / 0.75, 2.0];

/// How the motions of one window are selected.
#[derive(Clone, Debug)]
pub(crate) struct Selection<const N: usize> {
    kind: Kind<N>,
    limits: Limits<N>,
    interrupted: Interrupted<N>,
    uninterrupted: Uninterrupted<N>,
}

#[derive(Clone, Debug)]
enum Kind<const N: usize> {
    Interrupted,
    Uninterrupted,
    /// The fastest of these blenders.
    Fastest(Blenders<N>),
}

/// The blenders among which a method takes the fastest; none where it forces one kind.
pub(crate) fn blenders_of<const N: usize>(settings: &Settings<N>) -> Vec<Arc<dyn Blender<N>>> {
    let limits = settings.limits;
    match settings.method {
        // Between its stops, an exact stop has only the chords of an arc to turn.
        Method::Kcs | Method::ExactStop => {
            let mut blenders: Vec<Arc<dyn Blender<N>>> = vec![
                Arc::new(Interrupted::new(limits)),
                Arc::new(Uninterrupted::new(limits)),
                Arc::new(StopStart::new(limits)),
            ];
            for ratio in UNEQUAL {
                blenders.push(Arc::new(Uninterrupted::unequal(limits, ratio)));
            }
            blenders
        }
        Method::KcsInterrupted => vec![Arc::new(Interrupted::new(limits))],
        Method::KcsUninterrupted | Method::KcsLocal | Method::KcsGlobal => {
            vec![Arc::new(Uninterrupted::new(limits))]
        }
    }
}

impl<const N: usize> Selection<N> {
    /// The selections whose windows a method plans with; `blenders` take the place of its own.
    pub(crate) fn of(settings: &Settings<N>, blenders: Option<&Blenders<N>>) -> Vec<Self> {
        let forced = match settings.method {
            Method::Kcs | Method::ExactStop => &[Kind::Interrupted, Kind::Uninterrupted][..],
            _ => &[],
        };
        let first = match (blenders, settings.method) {
            (Some(blenders), _) => Kind::Fastest(Arc::clone(blenders)),
            (None, Method::KcsInterrupted) => Kind::Interrupted,
            (None, Method::Kcs | Method::ExactStop) => Kind::Fastest(blenders_of(settings).into()),
            (None, _) => Kind::Uninterrupted,
        };
        std::iter::once(first)
            .chain(forced.iter().cloned())
            .map(|kind| Self {
                kind,
                limits: settings.limits,
                interrupted: Interrupted::new(settings.limits),
                uninterrupted: Uninterrupted::new(settings.limits),
            })
            .collect()
    }

    /// Whether the window starts from balanced scales: uninterrupted corners need it.
    pub(crate) fn is_balanced(&self) -> bool {
        !matches!(self.kind, Kind::Interrupted)
    }

    /// The uninterrupted corner as if the moves beside it were long.
    pub(crate) fn unscaled(&self, corner: &Corner<N>) -> Option<BlendShape> {
        self.uninterrupted.blend(corner, 0.0, 0.0).ok()
    }

    /// The interrupted corner as if the moves beside it were long.
    pub(crate) fn interrupted(&self, corner: &Corner<N>) -> BlendShape {
        self.interrupted
            .blend(corner, 0.0, 0.0)
            .unwrap_or(BlendShape::STOP)
    }

    /// The motion for a corner between moves of two lengths: a stop where no blender has one.
    pub(crate) fn shape(&self, corner: &Corner<N>, before: f64, after: f64) -> BlendShape {
        let shape = match &self.kind {
            Kind::Interrupted => self.interrupted.blend(corner, before, after).ok(),
            Kind::Uninterrupted => self
                .uninterrupted
                .blend(corner, before, after)
                .or_else(|_| self.interrupted.blend(corner, before, after))
                .ok(),
            Kind::Fastest(blenders) => blenders
                .iter()
                .filter_map(|blender| blender.blend(corner, before, after).ok())
                .reduce(|one, other| self.faster(corner, before, after, one, other)),
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

//! Which motion a window tries at a corner.
//!
//! Source: the comparison of section 2.4, per corner. Not here: the motions, and how they share
//! short moves.

use crate::interrupted::Interrupted;
use crate::method::{Method, Settings};
use crate::stop_start::StopStart;
use crate::turn::TurnShape;
use crate::uninterrupted::Uninterrupted;
use toolglide_kinematics::{Corner, Limits, Tangential};
use toolglide_profiles::{Blender, Rise};

/// How the motions of one window are selected.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Selection<const N: usize> {
    kind: Kind,
    limits: Limits<N>,
    interrupted: Interrupted<N>,
    uninterrupted: Uninterrupted<N>,
    stop_start: StopStart<N>,
}

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
            Method::Kcs | Method::ExactStop => &[Kind::Fastest, Kind::Interrupted],
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
            })
            .collect()
    }

    /// Whether the window starts from balanced scales: uninterrupted corners need it.
    pub(crate) fn is_balanced(&self) -> bool {
        self.kind != Kind::Interrupted
    }

    /// The uninterrupted corner as if the moves beside it were long.
    pub(crate) fn unscaled(&self, corner: &Corner<N>) -> Option<TurnShape> {
        self.uninterrupted
            .blend(corner)
            .ok()
            .map(|turn| *turn.shape())
    }

    /// The motion for a corner between moves of two lengths.
    pub(crate) fn shape(&self, corner: &Corner<N>, before: f64, after: f64) -> TurnShape {
        let interrupted = || self.interrupted.blend(corner).map(|turn| *turn.shape());
        let uninterrupted = || self.uninterrupted.blend(corner).map(|turn| *turn.shape());
        let shape = match self.kind {
            Kind::Interrupted => interrupted(),
            Kind::Uninterrupted => uninterrupted().or_else(|_| interrupted()),
            Kind::Fastest => {
                let stop_start = self.stop_start.blend(corner).map(|turn| *turn.shape());
                let mut fastest = interrupted();
                for other in [uninterrupted(), stop_start] {
                    fastest = match (fastest, other) {
                        (Ok(one), Ok(other)) => Ok(self.faster(corner, before, after, one, other)),
                        (one, _) => one,
                    };
                }
                fastest
            }
        };
        shape.unwrap_or(TurnShape::STOP)
    }

    /// The turn that loses less time against passing the corner at the speeds that the moves reach.
    fn faster(
        &self,
        corner: &Corner<N>,
        before: f64,
        after: f64,
        one: TurnShape,
        other: TurnShape,
    ) -> TurnShape {
        let sides = [
            (self.limits.along(&corner.incoming), corner.speed_in, before),
            (self.limits.along(&corner.outgoing), corner.speed_out, after),
        ];
        let loss = |shape: &TurnShape| {
            sides
                .iter()
                .fold(shape.duration, |loss, (limits, feedrate, length)| {
                    loss + lost_beside(shape, limits, *feedrate, *length)
                })
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
fn lost_beside(shape: &TurnShape, limits: &Tangential, feedrate: f64, length: f64) -> f64 {
    let least = Rise::least_peak(shape.speed, shape.acceleration, limits.jerk);
    let reached = (0.25 * limits.jerk * length * length).cbrt(); // rest to rest over the move
    let peak = reached.min(feedrate).max(least);
    let rise = Rise::to_peak(
        shape.speed,
        shape.acceleration,
        peak,
        limits.acceleration,
        limits.jerk,
    );
    rise.duration() - (rise.distance + shape.reach) / peak
}

//! Plans legs from rest to rest in many ways, sharp corners included, within bounded work.
//!
//! Source: ours. Wide filters turn corners that lie close together, stiff progress leaves the jerk to the filter,
//! and pulses pause where corners are sharp: which of them is the fastest depends on the path, so each is tried
//! while there is work left. Not here: when that is worth it.

use crate::segment::Segment;
use crate::short_segments::ShortSegmentSmoother;
use crate::short_segments::feed_profile::Filter;
use toolglide_kinematics::Vector;

/// A filter that is tried: the time step of a spline of its width, as a share of the ramp, the sharpening, the
/// stiffness, and how many steps its means have.
const WAYS: [(f64, f64, f64, u8); 9] = [
    (0.4, 1.0, 1.0, 1),
    (0.6, 0.0, 4.0, 1),
    (0.6, 1.0, 10.0, 1),
    (1.0, 0.0, 1000.0, 1),
    (0.2, 0.0, 1.0, 1),
    (0.1, 0.0, 1.0, 1),
    (0.6, 0.0, 1000.0, 6),
    (1.0, 0.0, 1000.0, 8),
    (1.4, 0.0, 1000.0, 12),
];

/// Speeds that pulses are designed for, as shares of the largest on the path, and how many changes of velocity of
/// that size may meet in one mean.
const PULSES: [(f64, f64); 9] = [
    (1.0, 2.0),
    (0.5, 2.0),
    (0.25, 2.0),
    (0.7, 2.0),
    (0.35, 2.0),
    (0.12, 2.0),
    (0.06, 2.0),
    (1.0, 1.0),
    (0.35, 1.0),
];

/// Pieces that may be judged at the most.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// With filters of different widths.
    pub(crate) ways: usize,
    /// With pulses, beside what filters have left.
    pub(crate) pulses: usize,
}

impl<const N: usize> ShortSegmentSmoother<N> {
    /// Plans the legs from rest to rest in less than `most` seconds; the duration, or `None` when no way of doing that was found, and the effort that is left.
    ///
    /// `least` is a time that no motion can undercut.
    pub(crate) fn plan_whole(
        &mut self,
        legs: &[Segment<N>],
        least: f64,
        most: f64,
        effort: Effort,
    ) -> (Option<f64>, usize) {
        self.curve.set(legs);
        let ramp = self.ramp(legs);
        let top = legs.iter().fold(0.0_f64, |most, leg| {
            most.max(leg.limits.reachable_within(self.curve.length()))
        });
        let mut shortest = None;
        self.effort = effort.ways;
        for (width, sharpening, stiffness, taps) in WAYS {
            let filter = Filter {
                step: width * ramp / f64::from(taps),
                sharpening,
                stiffness,
                hasty: false,
                lags: false,
                inside: sharpening,
                taps: [usize::from(taps); 2],
            };
            let most = shortest.unwrap_or(most);
            if least < most && self.attempt(&filter, ramp, most, None) {
                shortest = Some(self.keep());
            }
        }
        self.effort += effort.pulses;
        for (share, changes) in PULSES {
            let most = shortest.unwrap_or(most);
            if least < most && self.pulse(legs, share * top, changes, most) {
                shortest = Some(self.keep());
            }
        }
        (shortest, std::mem::replace(&mut self.effort, usize::MAX))
    }

    /// Whether what was planned last comes as near to points as is said, one after the other.
    pub(crate) fn passes(&self, points: impl Iterator<Item = (Vector<N>, f64, u32)>) -> bool {
        self.best.passes(points)
    }

    /// What was planned last is the best; its duration.
    pub(super) fn keep(&mut self) -> f64 {
        std::mem::swap(&mut self.spline, &mut self.best);
        self.best.duration()
    }
}

//! Judges whether set-points are near enough to each other to show what they are judged by.
//!
//! Between two rows the motion is known as far as its limits bind it. With `a` and `j` the limits of acceleration
//! and jerk of an axis, `v` that of its velocity, and `t` the time between the rows, they show
//! - the path, where no motion within the limits leaves the chord by more than the smallest tolerance of the
//!   moves between the rows: at most `sqrt(8 tolerance / |a|)` apart always do, and farther ones where the rows
//!   around them show that the motion bends less,
//! - a stop, where no axis that rests between the rows can be farther from there than the tolerance of the move,
//! - the limit of jerk, where the third difference can exceed it while acceleration is kept: `t <= 2 a / j`,
//! - the limit of acceleration, where the second difference can exceed it while velocity is kept: `t <= 2 v / a`.
//!
//! Rows at most [`SERVO_PERIOD`] apart are what a drive is given, with nothing between them, and always fine enough.
//!
//! Source: the differences are means of the derivative over their rows, whose changes are those of the derivative
//! below (Peano). Not here: what certain violations there are.

use crate::report::Place;
use toolglide_kinematics::AxisLimits;
use toolglide_kinematics::numeric::{LIMIT_SLACK, SERVO_PERIOD, TIME_SLACK};

/// How many gaps a report quotes; all are counted.
const EXAMPLES: usize = 10;

/// What two rows cannot show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unseen {
    /// The path, its corners included: the motion may leave the chord by more than the tolerance.
    Path {
        /// How far the motion may be from the chord, mm.
        hidden: f64,
        /// The smallest tolerance of the moves between the rows, mm.
        tolerance: f64,
    },
    /// The orientation of the tool: it may turn away from the chord by more than the tolerance.
    Orientation {
        /// How far it may be from the chord, rad.
        hidden: f64,
        /// The smallest tolerance of the moves between the rows, rad.
        tolerance: f64,
    },
    /// A stop: the motion may pass without one.
    Stop {
        /// How far an axis that rests between the rows may be from both, mm.
        hidden: f64,
        /// The tolerance of the move that stops, mm.
        tolerance: f64,
    },
    /// The limit of acceleration of an axis.
    Acceleration {
        /// Letter of the axis.
        axis: char,
    },
    /// The limit of jerk of an axis.
    Jerk {
        /// Letter of the axis.
        axis: char,
    },
}

impl std::fmt::Display for Unseen {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Path { hidden, tolerance } => write!(
                f,
                "the motion may leave the path by {hidden:.4} mm of {tolerance} mm unseen"
            ),
            Self::Orientation { hidden, tolerance } => write!(
                f,
                "the tool may turn away from the path by {hidden:.6} rad of {tolerance} rad unseen"
            ),
            Self::Stop { hidden, tolerance } => write!(
                f,
                "a stop is not told from passing by within {hidden:.4} mm of {tolerance} mm"
            ),
            Self::Acceleration { axis } => {
                write!(f, "the limit of acceleration of axis {axis} is not shown")
            }
            Self::Jerk { axis } => write!(f, "the limit of jerk of axis {axis} is not shown"),
        }
    }
}

/// Two rows that are too far apart, and what they cannot show.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "too coarse to judge: rows are {duration:.4} s apart from {begin:.4} s on ({place}), where {unseen}; {needed:.4} s would show it"
)]
pub struct Gap {
    /// Time of the older row, s from the start of the motion.
    pub begin: f64,
    /// Time between the rows, s.
    pub duration: f64,
    /// A time between rows at which this is shown whatever the motion does, s.
    pub needed: f64,
    /// What is not shown.
    pub unseen: Unseen,
    /// Where.
    pub place: Place,
}

/// All pairs of rows that are too far apart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gaps {
    /// How many there are.
    pub count: u64,
    /// The first few, in order of time.
    pub examples: Vec<Gap>,
}

impl Gaps {
    /// Whether every two rows are near enough to be judged.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Takes the first finding of what two rows cannot show which asks for the rows to be nearest.
    pub(crate) fn add(
        &mut self,
        begin: f64,
        duration: f64,
        place: Place,
        unseen: impl IntoIterator<Item = (Unseen, f64)>,
    ) {
        let least = |one: &(Unseen, f64), two: &(Unseen, f64)| one.1.total_cmp(&two.1);
        let Some((unseen, needed)) = unseen.into_iter().min_by(least) else {
            return;
        };
        self.count += 1;
        if self.examples.len() < EXAMPLES {
            self.examples.push(Gap {
                begin,
                duration,
                needed: needed.max(SERVO_PERIOD),
                unseen,
                place,
            });
        }
    }
}

/// Whether rows are what a drive is given.
pub(crate) fn is_fine(duration: f64) -> bool {
    duration <= SERVO_PERIOD + TIME_SLACK
}

/// The limits of one axis that rows so far apart cannot show, and at most how far apart they show them.
pub(crate) fn unseen_limits(
    axis: char,
    limits: AxisLimits,
    duration: f64,
) -> impl Iterator<Item = (Unseen, f64)> {
    let jerk = 2.0 * limits.acceleration() / limits.jerk();
    let acceleration = 2.0 * limits.velocity() / limits.acceleration();
    [
        (Unseen::Jerk { axis }, jerk),
        (Unseen::Acceleration { axis }, acceleration),
    ]
    .into_iter()
    .filter(move |(_, needed)| duration > needed * (1.0 + LIMIT_SLACK) + TIME_SLACK)
}

/// Mean distance of the second derivative between two rows from its mean over three, in time: times the
/// limit of jerk, what the second difference of the rows may miss of how the motion bends between the last two.
///
/// The mean is weighted by a triangle over both intervals, so that at the ends of the newer one its distance is
/// `(b^2 + n^2) / (3 (b + n))` and `(b + 2 n) / 3`, and convex between. The way from the chord weighs it by Green's
/// function of the interval; for what is linear in time that is the value in the middle, and at most 1.03 times as
/// much where the largest distance is elsewhere.
pub(crate) fn bend_distance(before: f64, newest: f64) -> f64 {
    let both = before + newest;
    let first = (before * before + newest * newest) / (3.0 * both);
    let last = (before + 2.0 * newest) / 3.0;
    0.5 * 1.03 * (first + last)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Greatest integral of Green's function of the newer interval times the mean distance from a triangle.
    fn farthest(before: f64, newest: f64) -> f64 {
        const STEPS: u32 = 200;
        let triangle = |u: f64| {
            if u < 0.0 {
                1.0 + u / before
            } else {
                1.0 - u / newest
            }
        };
        let grid = |from: f64, to: f64, k: u32| {
            from + (to - from) * (f64::from(k) + 0.5) / f64::from(STEPS)
        };
        let distance = |s: f64| {
            let (mut sum, mut weight) = (0.0, 0.0);
            for (from, to) in [(-before, 0.0), (0.0, newest)] {
                for k in 0..STEPS {
                    let u = grid(from, to, k);
                    let part = triangle(u) * (to - from);
                    sum += part * (s - u).abs();
                    weight += part;
                }
            }
            sum / weight
        };
        let distances: Vec<f64> = (0..STEPS).map(|k| distance(grid(0.0, newest, k))).collect();
        let mut most = 0.0_f64;
        for at in 0..STEPS {
            let t = grid(0.0, newest, at);
            let mut sum = 0.0;
            for (k, distance) in (0..STEPS).zip(&distances) {
                let s = grid(0.0, newest, k);
                sum += t.min(s) * (newest - t.max(s)) / newest * distance;
            }
            most = most.max(sum * newest / f64::from(STEPS));
        }
        most
    }

    #[test]
    fn what_bends_between_rows_is_bounded_and_not_by_much_too_far() {
        for before in [0.05, 0.5, 0.7, 1.0, 2.0, 30.0] {
            let bound = bend_distance(before, 1.0) / 8.0;
            let most = farthest(before, 1.0);
            assert!(most <= bound, "{before}: {most} above {bound}");
            assert!(most > 0.55 * bound, "{before}: {most} far below {bound}");
        }
    }

    #[test]
    fn a_limit_is_shown_as_long_as_its_difference_can_exceed_it() {
        let limits = AxisLimits::new(500.0, 2_500.0, 200_000.0).unwrap();
        let unseen = |duration| {
            unseen_limits('X', limits, duration)
                .map(|(unseen, _)| unseen)
                .collect::<Vec<_>>()
        };
        assert_eq!(unseen(0.025), [], "as far apart as may be");
        assert_eq!(unseen(0.025_01), [Unseen::Jerk { axis: 'X' }]);
        assert_eq!(unseen(0.4).len(), 1, "acceleration is still shown");
        assert_eq!(unseen(0.400_01).len(), 2);
    }
}

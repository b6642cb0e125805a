//! Bounds the deviation of pose motion from its path over intervals of time.
//!
//! Source: geometry. A cubic curve over its chord is bounded by its values at the thirds of the
//! stretch, and the distance from a segment is convex along the chord. Not here: time, and which
//! legs count.

use toolglide_kinematics::Vector;
use toolglide_kinematics::{GreatCircle, angle_between};

/// The bound is taken for the value when it is above what is attained by this share at most.
const PRECISION: f64 = 1e-5;

/// Ratios to the tolerance below this are not told apart: a hundredth of a percent of it.
const MIN_RATIO: f64 = 1e-4;

/// How often a stretch is halved at most.
const HALVINGS: u32 = 40;

/// Distance between a point and the segment from `start` to `end`.
pub(super) fn from_segment(point: &Vector<3>, start: &Vector<3>, end: &Vector<3>) -> f64 {
    let span = end - start;
    let squared = span.norm_squared();
    let share = if squared > 0.0 {
        ((point - start).dot(&span) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point - (start + span * share)).norm()
}

/// Angle between an orientation and the arc of a turn.
pub(super) fn from_arc(orientation: &Vector<3>, turn: &GreatCircle) -> f64 {
    let (start, end, axis) = (turn.start(), turn.end(), turn.axis());
    let ends = angle_between(orientation, &start).min(angle_between(orientation, &end));
    if turn.angle() > 0.0
        && axis.cross(&start).dot(orientation) >= 0.0
        && end.cross(&axis).dot(orientation) >= 0.0
    {
        let height = axis.dot(orientation);
        let along = (orientation - axis * height).norm();
        return height.abs().atan2(along).min(ends);
    }
    ends
}

/// What is measured: distances of the tip, or angles of the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Space {
    /// Points, and segments between them.
    Straight,
    /// Unit vectors, and arcs between them.
    Sphere,
}

/// A largest share of a tolerance: what is certain not to be exceeded, and where it is attained.
#[derive(Clone, Copy, Debug)]
pub(super) struct Largest {
    pub(super) bound: f64,
    pub(super) at: f64,
    pub(super) leg: u32,
}

/// Takes a leg: its number, the distance from it, and its tolerance.
pub(super) type Visit<'a> = &'a mut dyn FnMut(u32, f64, f64);

/// A motion against time, and the shares of the tolerances of the legs that count: leg and distance
/// as a share of its tolerance.
pub(super) struct Course<'a> {
    pub(super) space: Space,
    pub(super) point: &'a mut dyn FnMut(f64) -> Vector<3>,
    /// Visits every leg that counts.
    pub(super) legs: &'a dyn Fn(&Vector<3>, Visit<'_>),
}

impl Course<'_> {
    /// The largest share of a tolerance over a stretch of time, when it is above `known`.
    pub(super) fn largest(&mut self, duration: f64, known: f64) -> Largest {
        let mut found = Largest {
            bound: 0.0,
            at: 0.0,
            leg: 0,
        };
        let ends = [(self.point)(0.0), (self.point)(duration)];
        self.search([0.0, duration], ends, known, 0, &mut found);
        found
    }

    fn search(
        &mut self,
        [begin, end]: [f64; 2],
        [first, last]: [Vector<3>; 2],
        known: f64,
        depth: u32,
        found: &mut Largest,
    ) {
        let length = end - begin;
        let thirds = [1.0, 2.0].map(|third| (self.point)(begin + length * third / 3.0));
        let mut attained = found.bound.max(known).max(MIN_RATIO);
        for (point, at) in [
            (&first, begin),
            (&thirds[0], begin + length / 3.0),
            (&thirds[1], begin + length * 2.0 / 3.0),
            (&last, end),
        ] {
            let (leg, share) = self.nearest(point);
            if share > found.bound {
                (found.bound, found.at, found.leg) = (share, at, leg);
            }
            attained = attained.max(share);
        }
        let bound = self.bound(&first, &thirds, &last);
        if bound <= attained * (1.0 + PRECISION) {
            return;
        }
        if depth >= HALVINGS {
            found.bound = found.bound.max(bound);
            return;
        }
        let middle = 0.5 * (begin + end);
        let between = (self.point)(middle);
        self.search([begin, middle], [first, between], known, depth + 1, found);
        self.search([middle, end], [between, last], known, depth + 1, found);
    }

    fn nearest(&self, point: &Vector<3>) -> (u32, f64) {
        let mut nearest = (0, f64::INFINITY);
        (self.legs)(point, &mut |leg, distance, tolerance| {
            let share = distance / tolerance;
            if share < nearest.1 {
                nearest = (leg, share);
            }
        });
        nearest
    }

    /// A bound of the share of the tolerance over the stretch, by the leg that gives the least.
    fn bound(&self, first: &Vector<3>, thirds: &[Vector<3>; 2], last: &Vector<3>) -> f64 {
        let sagitta = sagitta(first, thirds, last);
        let spread = match self.space {
            Space::Straight => 1.0,
            // A great circle between two points of one latitude bulges towards the pole.
            Space::Sphere => 1.0 / (0.5 * angle_between(first, last)).cos().max(0.1),
        };
        let mut starts = Vec::new();
        (self.legs)(first, &mut |_, distance, _| starts.push(distance));
        let mut least = f64::INFINITY;
        let mut index = 0;
        (self.legs)(last, &mut |_, distance, tolerance| {
            let start: f64 = starts.get(index).copied().unwrap_or(f64::INFINITY);
            least = least.min((distance.max(start) * spread + sagitta) / tolerance);
            index += 1;
        });
        least
    }
}

/// How far a cubic curve is from its chord at most, from its points at the thirds.
fn sagitta(first: &Vector<3>, thirds: &[Vector<3>; 2], last: &Vector<3>) -> f64 {
    let span = last - first;
    let length = span.norm();
    let lifted = [1.0 / 3.0, 2.0 / 3.0].map(|share| {
        let index = usize::from(share > 0.5);
        thirds[index] - (first + span * share)
    });
    let most = |one: &Vector<3>, two: &Vector<3>| {
        let scale = 9.0 / 8.0;
        scale * (one * 2.0 - two).norm().max((two * 2.0 - one).norm())
    };
    if length > 0.0 {
        let direction = span / length;
        let along = thirds.map(|point| (point - first).dot(&direction));
        if 0.0 <= along[0] && along[0] <= along[1] && along[1] <= length {
            let across = lifted.map(|lift| lift - direction * lift.dot(&direction));
            return most(&across[0], &across[1]);
        }
    }
    most(&lifted[0], &lifted[1])
}

/// The least distance that a motion is seen to have from a point, and when.
pub(super) fn approach(duration: f64, mut distance: impl FnMut(f64) -> f64) -> (f64, f64) {
    /// Points looked at before the search narrows.
    const POINTS: u32 = 12;
    /// Steps of the golden section: a share of 1e-6 of the bracket.
    const STEPS: u32 = 30;
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let step = duration / f64::from(POINTS);
    let mut best = (f64::INFINITY, 0.0);
    for index in 0..=POINTS {
        let time = step * f64::from(index);
        let value = distance(time);
        if value < best.0 {
            best = (value, time);
        }
    }
    let (mut low, mut high) = ((best.1 - step).max(0.0), (best.1 + step).min(duration));
    for _ in 0..STEPS {
        let (one, two) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (at_one, at_two) = (distance(one), distance(two));
        for candidate in [(at_one, one), (at_two, two)] {
            if candidate.0 < best.0 {
                best = candidate;
            }
        }
        if at_one < at_two {
            high = two;
        } else {
            low = one;
        }
    }
    best
}

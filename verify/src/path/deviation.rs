//! Finds the largest distance of a curve from a range of moves.
//!
//! Source: branch and bound over halves of the curve. Each move has a cubic nowhere below its
//! distance; the distance from the nearer of two moves is nowhere above any weighted mean of
//! theirs, so that the bound stays sharp where the nearest move changes. Not here: the cubics.

use crate::path::bernstein::Cubic;
use crate::path::route::Route;
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::{
    JUDGE_HALVINGS, JUDGE_PARTS, JUDGE_PARTS_OF_A_MOVE, JUDGE_PRECISION, LENGTH_SLACK,
};

/// A value that the motion attains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Attained {
    pub(crate) value: f64,
    /// Where on the curve, in `0..=1`.
    pub(crate) at: f64,
    /// On which move.
    pub(crate) mv: u32,
}

/// Largest distance, and largest distance as a share of what is allowed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deviation {
    /// Bounds from above; no larger than what was known where nothing larger was found.
    pub(crate) bounds: [f64; 2],
    /// The largest values met on the way.
    pub(crate) attained: [Attained; 2],
}

/// Looks for deviations of `curve` from the moves `first..=last` that are above `known` (distance
/// and share), and for any share above 1.
pub(crate) fn largest<const N: usize>(
    route: &Route<N>,
    curve: &Cubic<N>,
    first: u32,
    last: u32,
    known: [f64; 2],
) -> Deviation {
    let start = Attained {
        value: 0.0,
        at: 0.0,
        mv: first,
    };
    let mut search = Search {
        route,
        known,
        found: Deviation {
            bounds: [0.0; 2],
            attained: [start; 2],
        },
        parts: JUDGE_PARTS
            .saturating_add(JUDGE_PARTS_OF_A_MOVE.saturating_mul(last.saturating_sub(first))),
    };
    let part = Part {
        curve: *curve,
        from: 0.0,
        to: 1.0,
        first,
        last,
    };
    search.descend(&part, JUDGE_HALVINGS);
    search.found
}

struct Part<const N: usize> {
    curve: Cubic<N>,
    from: f64,
    to: f64,
    first: u32,
    last: u32,
}

/// The two moves with the lowest bounds in one measure.
#[derive(Clone, Copy, Default)]
struct Lowest {
    best: Option<([f64; 4], f64)>,
    second: Option<([f64; 4], f64)>,
}

impl Lowest {
    fn offer(&mut self, values: [f64; 4], most: f64) {
        if self.best.is_none_or(|best| most < best.1) {
            self.second = self.best;
            self.best = Some((values, most));
        } else if self.second.is_none_or(|second| most < second.1) {
            self.second = Some((values, most));
        }
    }

    fn bound(&self) -> f64 {
        match (self.best, self.second) {
            (Some(best), Some(second)) => best.1.min(mean(best.0, second.0)),
            (Some(best), None) => best.1,
            _ => f64::INFINITY,
        }
    }

    /// Where the smaller of the two is likely largest, in `0..=1`.
    fn place(&self) -> f64 {
        let Some((one, _)) = self.best else {
            return 0.5;
        };
        if let Some((other, _)) = self.second {
            let (before, after) = (one[0] - other[0], one[3] - other[3]);
            if before * after < 0.0 {
                return before / (before - after);
            }
        }
        let inside = one[1].max(one[2]);
        if one[0] >= inside && one[0] >= one[3] {
            0.0
        } else if one[3] >= inside {
            1.0
        } else {
            0.5
        }
    }
}

struct Search<'a, const N: usize> {
    route: &'a Route<N>,
    known: [f64; 2],
    found: Deviation,
    /// How many parts may still be looked at.
    parts: u32,
}

impl<const N: usize> Search<'_, N> {
    fn descend(&mut self, part: &Part<N>, halvings: u32) {
        self.parts = self.parts.saturating_sub(1);
        let lowest = self.lowest(part);
        let bounds = lowest.map(|measure| measure.bound());
        let mut place = 0.5;
        for (measure, at_place) in lowest.iter().enumerate() {
            if self.settled(bounds)[measure] {
                continue;
            }
            place = at_place.place();
            let point = part.curve.at(place);
            self.attain(part, &point, part.from + (part.to - part.from) * place);
        }
        if halvings == 0 || self.parts == 0 || self.settled(bounds) == [true; 2] {
            return self.accept(bounds);
        }
        let (first, last) = self.narrow(part, &part.curve.at(place), bounds);
        let middle = 0.5 * (part.from + part.to);
        let (left, right) = part.curve.split(0.5);
        for (curve, from, to) in [(left, part.from, middle), (right, middle, part.to)] {
            let half = Part {
                curve,
                from,
                to,
                first,
                last,
            };
            self.descend(&half, halvings - 1);
        }
    }

    /// Whether each bound says enough: nothing larger than known or attained, and legal or not.
    fn settled(&self, bounds: [f64; 2]) -> [bool; 2] {
        let [distance, share] = self.found.attained.map(|attained| attained.value);
        let room = if bounds[0] > 0.0 {
            LENGTH_SLACK * bounds[1] / bounds[0]
        } else {
            0.0
        };
        let known = if share > 1.0 { 0.0 } else { self.known[1] };
        let enough = [
            self.known[0].max(distance + (JUDGE_PRECISION * distance).max(LENGTH_SLACK)),
            known.max(share + (JUDGE_PRECISION * share).max(room)),
        ];
        [
            bounds[0] <= enough[0],
            bounds[1] <= enough[1] && (bounds[1] <= 1.0 || share > 1.0),
        ]
    }

    fn accept(&mut self, bounds: [f64; 2]) {
        for (most, bound) in self.found.bounds.iter_mut().zip(bounds) {
            *most = most.max(bound);
        }
    }

    /// The moves with the lowest bounds over a part, by distance and by share.
    fn lowest(&self, part: &Part<N>) -> [Lowest; 2] {
        let mut lowest = [Lowest::default(); 2];
        for leg in self.route.range(part.first, part.last) {
            let values = leg.majorant(&part.curve);
            let [a, b, c, d] = values;
            let most = if (a + b + c + d).is_nan() {
                f64::INFINITY
            } else {
                a.max(b).max(c).max(d)
            };
            let weight = leg.allowed.recip();
            lowest[0].offer(values, most);
            lowest[1].offer(values.map(|value| value * weight), most * weight);
        }
        lowest
    }

    /// Takes the deviation at one point into account.
    fn attain(&mut self, part: &Part<N>, point: &Vector<N>, at: f64) {
        let mut nearest = [f64::INFINITY; 2];
        let mut moves = [part.first; 2];
        for leg in self.route.range(part.first, part.last) {
            let distance = leg.distance(point);
            for (k, value) in [distance, distance / leg.allowed].into_iter().enumerate() {
                if value < nearest[k] {
                    nearest[k] = value;
                    moves[k] = leg.place.mv;
                }
            }
        }
        for k in 0..2 {
            if nearest[k].is_finite() && nearest[k] > self.found.attained[k].value {
                self.found.attained[k] = Attained {
                    value: nearest[k],
                    at,
                    mv: moves[k],
                };
            }
        }
    }

    /// Leaves out moves at both ends of the range that are nowhere nearest.
    fn narrow(&self, part: &Part<N>, point: &Vector<N>, bounds: [f64; 2]) -> (u32, u32) {
        let (mut first, mut last) = (part.first, part.last);
        if first == last {
            return (first, last);
        }
        let spread = |corner: &Vector<N>| (corner - point).norm();
        let radius = part.curve.points.iter().map(spread).fold(0.0, f64::max);
        let far = |mv: u32| {
            self.route.get(mv).is_none_or(|leg| {
                let least = leg.distance(point) - radius;
                least > bounds[0] && least > bounds[1] * leg.allowed
            })
        };
        while first < last && far(first) {
            first += 1;
        }
        while first < last && far(last) {
            last -= 1;
        }
        (first, last)
    }
}

/// Bound of the smaller of two cubics, by the mean that makes both ends equal.
fn mean(one: [f64; 4], other: [f64; 4]) -> f64 {
    let fall = one[0] - one[3];
    let rise = other[3] - other[0];
    let share = rise / (fall + rise);
    if !(share > 0.0 && share < 1.0) {
        return f64::INFINITY;
    }
    let mut most = 0.0_f64;
    for (a, b) in one.into_iter().zip(other) {
        most = most.max(share * a + (1.0 - share) * b);
    }
    most
}

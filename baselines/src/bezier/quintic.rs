//! Computes the symmetric quintic of least curvature around a corner, and points at equal distances
//! on it.
//!
//! Source: Sencer, Ishizaki and Shamoto (2015), "A curvature optimal sharp corner smoothing algorithm
//! for high-speed feed motion generation of NC systems along linear tool paths". Three control points
//! lie on each leg at equal distances from one another, so that the curvature vanishes at both ends.
//! Their distance is searched instead of fitted: the one whose largest curvature is least among the
//! curves that pass the corner at the same distance. Not here: limits, tolerance and time.

/// Equal parts into which the length of a curve is cut: an even number.
pub(super) const PARTS: usize = 32;
/// Parts of half a curve.
const HALF: usize = PARTS / 2;
/// Range of the distance between control points, as a share of that of the nearest from the corner:
/// from the sharpest turn to the flattest one it falls from 1.36 to nothing.
const RATIOS: [f64; 2] = [0.01, 2.0];
/// Steps of the search within that range, which find it to a thousandth.
const SEARCH_STEPS: usize = 16;
/// Places of half a curve at which its curvature is looked at.
const PLACES: u32 = 16;
/// Newton steps to a place of known distance: the first guess is good to some percent.
const NEWTON_STEPS: usize = 5;
/// Panels for the length of half a curve.
const PANELS: u32 = 32;
/// Gauss nodes and weights for four values over -1 to 1.
const GAUSS: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];
/// The golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Where a point lies: so far before the corner on the incoming leg, and from there so far along the
/// outgoing direction.
pub(super) type Offset = [f64; 2];

/// A quintic Bezier curve whose nearest control points lie at distance 1 from the corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quintic {
    /// Distance between control points of a leg.
    ratio: f64,
    half_sine: f64,
    half_cosine: f64,
}

impl Quintic {
    /// The curve of least curvature for a turn given by sine and cosine of its half.
    pub(super) fn optimal(half_sine: f64, half_cosine: f64) -> Self {
        let at = |ratio: f64| Self {
            ratio,
            half_sine,
            half_cosine,
        };
        let [mut low, mut high] = RATIOS;
        let inner = |low: f64, high: f64| low + GOLDEN * (high - low);
        let (mut left, mut right) = (inner(high, low), inner(low, high));
        let (mut at_left, mut at_right) = (at(left).peak(), at(right).peak());
        for _ in 0..SEARCH_STEPS {
            if at_left < at_right {
                high = right;
                (right, at_right) = (left, at_left);
                left = inner(high, low);
                at_left = at(left).peak();
            } else {
                low = left;
                (left, at_left) = (right, at_right);
                right = inner(low, high);
                at_right = at(right).peak();
            }
        }
        at(0.5 * (low + high))
    }

    /// The points that cut the curve into equal lengths, from its beginning to its middle, in units of
    /// that length.
    pub(super) fn offsets(&self) -> [Offset; HALF + 1] {
        let panel = 0.5 / f64::from(PANELS);
        let mut half = 0.0;
        for index in 0..PANELS {
            let from = f64::from(index) * panel;
            half += self.length(from, from + panel);
        }
        let step = half / HALF as f64;
        let mut offsets = [self.point(0.0, step); HALF + 1];
        let mut from = 0.0;
        for offset in &mut offsets[1..HALF] {
            let mut to = from + step / self.speed(from);
            for _ in 0..NEWTON_STEPS {
                to = to.clamp(from, 0.5);
                to += (step - self.length(from, to)) / self.speed(to);
            }
            from = to.clamp(from, 0.5);
            *offset = self.point(from, step);
        }
        offsets[HALF] = self.point(0.5, step);
        offsets
    }

    /// Largest curvature times the distance between corner and curve.
    fn peak(&self) -> f64 {
        let mut most = 0.0_f64;
        for place in 0..=PLACES {
            let share = 0.5 * f64::from(place) / f64::from(PLACES);
            let [in_first, out_first] = self.first(share);
            let (in_second, out_second) = (self.second(share), self.second(1.0 - share));
            let cross = (in_first * out_second - out_first * in_second).abs();
            most = most.max(cross / self.speed(share).powi(3));
        }
        most * 2.0 * self.half_sine * self.half_cosine * (16.0 + 7.0 * self.ratio)
    }

    fn point(&self, share: f64, unit: f64) -> Offset {
        let along = |share: f64| {
            let rest = 1.0 - share;
            let (square, ratio) = (rest * rest, self.ratio);
            square
                * rest
                * (square * (1.0 + 2.0 * ratio)
                    + 5.0 * share * rest * (1.0 + ratio)
                    + 10.0 * share * share)
        };
        [along(share) / unit, along(1.0 - share) / unit]
    }

    /// First derivatives of the two offsets.
    fn first(&self, share: f64) -> [f64; 2] {
        let along = |share: f64| {
            let rest = 1.0 - share;
            let square = rest * rest;
            5.0 * square * (self.ratio * rest * (rest + 4.0 * share) + 6.0 * share * share)
        };
        [-along(share), along(1.0 - share)]
    }

    /// Second derivative of the first offset; of the other one it is that at the rest of the share.
    fn second(&self, share: f64) -> f64 {
        let rest = 1.0 - share;
        60.0 * share * rest * ((self.ratio - 1.0) * rest + share)
    }

    /// Length of the first derivative.
    fn speed(&self, share: f64) -> f64 {
        let [incoming, outgoing] = self.first(share);
        let straight = outgoing - incoming;
        let turned = 4.0 * self.half_sine * self.half_sine * incoming * outgoing;
        (straight * straight + turned)
            .max(0.0)
            .sqrt()
            .max(f64::MIN_POSITIVE)
    }

    fn length(&self, from: f64, to: f64) -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        GAUSS
            .iter()
            .map(|[node, weight]| weight * half * self.speed(middle + half * node))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half(degrees: f64) -> (f64, f64) {
        (0.5 * degrees.to_radians()).sin_cos()
    }

    #[test]
    fn no_other_ratio_has_less_curvature_at_the_same_corner_error() {
        for degrees in [0.1, 10.0, 45.0, 90.0, 120.0, 150.0, 170.0] {
            let (half_sine, half_cosine) = half(degrees);
            let best = Quintic::optimal(half_sine, half_cosine);
            for ratio in 1..200 {
                let other = Quintic {
                    ratio: 0.01 * f64::from(ratio),
                    ..best
                };
                assert!(
                    other.peak() > best.peak() * (1.0 - 1e-3),
                    "{degrees} {other:?} {best:?}"
                );
            }
        }
    }

    #[test]
    fn the_points_lie_at_equal_distances() {
        for degrees in [1e-6, 1.0, 45.0, 90.0, 135.0, 160.0] {
            let (half_sine, half_cosine) = half(degrees);
            let curve = Quintic::optimal(half_sine, half_cosine);
            let offsets = curve.offsets();
            let turn = degrees.to_radians();
            let place = |[incoming, outgoing]: Offset| {
                [outgoing * turn.cos() - incoming, outgoing * turn.sin()]
            };
            for pair in offsets.windows(2) {
                let [from, to] = [place(pair[0]), place(pair[1])];
                let chord = (to[0] - from[0]).hypot(to[1] - from[1]);
                assert!(chord < 1.0 + 1e-6 && chord > 0.95, "{degrees} {chord}");
            }
        }
    }
}

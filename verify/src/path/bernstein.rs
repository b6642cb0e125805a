//! Bounds pieces of motion by Bézier points and polynomials by Bernstein coefficients.
//!
//! Source: the hull property and de Casteljau's halving, both standard. Not here: distances.

use crate::path::leg::is_measurable;
use toolglide_kinematics::Piece;
use toolglide_kinematics::Sample;
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::{JUDGE_HALVINGS, SPEED_PRECISION};

/// A cubic curve over `0..=1`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cubic<const N: usize> {
    pub(crate) points: [Vector<N>; 4],
}

impl<const N: usize> Cubic<N> {
    /// The curve of a piece which starts with `start` and ends where the piece says.
    pub(crate) fn of(start: &Sample<N>, piece: &Piece<N>) -> Self {
        let t = piece.duration();
        let first = start.position + start.velocity * (t / 3.0);
        let second = start.position
            + start.velocity * (t * (2.0 / 3.0))
            + start.acceleration * (t * t / 6.0);
        Self {
            points: [start.position, first, second, piece.end()],
        }
    }

    pub(crate) fn is_measurable(&self) -> bool {
        self.points.iter().all(is_measurable)
    }

    /// The same curve seen from `origin`.
    pub(crate) fn relative_to(&self, origin: &Vector<N>) -> Self {
        Self {
            points: self.points.map(|point| point - origin),
        }
    }

    pub(crate) fn at(&self, u: f64) -> Vector<N> {
        let [a, b, c, d] = &self.points;
        let w = 1.0 - u;
        a * (w * w * w) + b * (3.0 * w * w * u) + c * (3.0 * w * u * u) + d * (u * u * u)
    }

    /// Derivative by `u`.
    pub(crate) fn slope(&self, u: f64) -> Vector<N> {
        let [a, b, c, d] = &self.points;
        let w = 1.0 - u;
        (b - a) * (3.0 * w * w) + (c - b) * (6.0 * w * u) + (d - c) * (3.0 * u * u)
    }

    /// Second derivative by `u`.
    pub(crate) fn bend(&self, u: f64) -> Vector<N> {
        let [a, b, c, d] = &self.points;
        (c - b * 2.0 + a) * (6.0 * (1.0 - u)) + (d - c * 2.0 + b) * (6.0 * u)
    }

    /// The parts before and after `u`, each over `0..=1`.
    pub(crate) fn split(&self, u: f64) -> (Self, Self) {
        let [a, b, c, d] = self.points;
        let w = 1.0 - u;
        let ab = a * w + b * u;
        let bc = b * w + c * u;
        let cd = c * w + d * u;
        let abc = ab * w + bc * u;
        let bcd = bc * w + cd * u;
        let mid = abc * w + bcd * u;
        (
            Self {
                points: [a, ab, abc, mid],
            },
            Self {
                points: [mid, bcd, cd, d],
            },
        )
    }

    /// Square of the distance from the origin, of degree 6.
    pub(crate) fn squared_norm(&self) -> [f64; 7] {
        let [a, b, c, d] = &self.points;
        [
            a.norm_squared(),
            a.dot(b),
            (2.0 * a.dot(c) + 3.0 * b.norm_squared()) / 5.0,
            (a.dot(d) + 9.0 * b.dot(c)) / 10.0,
            (2.0 * b.dot(d) + 3.0 * c.norm_squared()) / 5.0,
            c.dot(d),
            d.norm_squared(),
        ]
    }
}

/// The halves of a polynomial.
pub(crate) fn halves<const K: usize>(coefficients: &[f64; K]) -> ([f64; K], [f64; K]) {
    let mut left = *coefficients;
    let mut right = *coefficients;
    for (level, first) in left.iter_mut().enumerate().skip(1) {
        for index in 0..K - level {
            right[index] = 0.5 * (right[index] + right[index + 1]);
        }
        *first = right[0];
    }
    (left, right)
}

/// Square of the speed of a piece, of degree 4.
pub(crate) fn squared_speed<const N: usize>(start: &Sample<N>, time: f64) -> [f64; 5] {
    let first = start.velocity;
    let second = first + start.acceleration * (0.5 * time);
    let third = first + (start.acceleration + start.jerk * (0.5 * time)) * time;
    [
        first.norm_squared(),
        first.dot(&second),
        (2.0 * second.norm_squared() + first.dot(&third)) / 3.0,
        second.dot(&third),
        third.norm_squared(),
    ]
}

/// Search of the largest value of a polynomial over `0..=1`.
pub(crate) struct Largest {
    /// Largest value that was reached.
    attained: f64,
    /// Where.
    pub(crate) at: f64,
    /// Bound from above, unless all values stay below what was known.
    pub(crate) bound: f64,
}

impl Largest {
    /// Looks for values above `known`; gives it back as the bound when there are none.
    pub(crate) fn above<const K: usize>(known: f64, coefficients: &[f64; K]) -> Self {
        let mut search = Self {
            attained: known,
            at: 0.0,
            bound: known,
        };
        search.descend(coefficients, 0.0, 1.0, JUDGE_HALVINGS);
        search
    }

    fn descend<const K: usize>(&mut self, values: &[f64; K], from: f64, to: f64, halvings: u32) {
        let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        for (value, at) in [(values[0], from), (values[K - 1], to)] {
            if value > self.attained {
                self.attained = value;
                self.at = at;
            }
        }
        if top <= self.attained * (1.0 + SPEED_PRECISION) || halvings == 0 {
            self.bound = self.bound.max(top);
            return;
        }
        let (left, right) = halves(values);
        let middle = 0.5 * (from + to);
        self.descend(&left, from, middle, halvings - 1);
        self.descend(&right, middle, to, halvings - 1);
    }
}

//! Finds the closest approach of a piece to a point, and when it first comes within a distance.
//!
//! Source: the squared distance is a polynomial of degree 6 in Bernstein form, whose smallest
//! coefficient bounds it from below and which is monotone when its coefficients are. Not here:
//! which points matter.

use crate::path::bernstein::{Cubic, halves};
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::{
    COORDINATE_ROUNDING, JUDGE_HALVINGS, JUDGE_PRECISION, LENGTH_SLACK,
};

/// Newton steps that sharpen a closest point: the third already squares away what is left.
const POLISHING_STEPS: u32 = 4;

/// How precisely the first place within a distance is found, as a share of the piece: it orders the
/// corners passed within one piece and nothing else.
const ENTRY_PRECISION: f64 = 1e-6;

/// The closest point found of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Near {
    /// Distance of that point: attained, so never below the true minimum.
    pub(crate) distance: f64,
    /// Where on the curve, in `0..=1`.
    pub(crate) at: f64,
}

/// The closest point of `curve` to `point`, unless it is no closer than `best`.
///
/// The search ends early once a distance of `enough` is reached.
pub(crate) fn closest<const N: usize>(
    curve: &Cubic<N>,
    point: &Vector<N>,
    best: f64,
    enough: f64,
) -> Option<Near> {
    let curve = curve.relative_to(point);
    let squares = curve.squared_norm();
    let lowest = squares.iter().copied().fold(f64::INFINITY, f64::min);
    if lowest >= best * best {
        return None;
    }
    let mut search = Search {
        curve: &curve,
        enough,
        near: Near {
            distance: best,
            at: f64::NAN,
        },
    };
    // Motion that comes to rest at the point has no simple root there; its ends are exact.
    search.try_at(0.0);
    search.try_at(1.0);
    search.descend(&squares, 0.0, 1.0, JUDGE_HALVINGS);
    (!search.near.at.is_nan()).then_some(search.near)
}

/// The first place from `from` on where `curve` is within `distance` of `point`, or at most
/// [`ENTRY_PRECISION`] before it.
pub(crate) fn enters<const N: usize>(
    curve: &Cubic<N>,
    point: &Vector<N>,
    distance: f64,
    from: f64,
) -> Option<f64> {
    let curve = curve.relative_to(point);
    let rest = if from > 0.0 {
        curve.split(from).1
    } else {
        curve
    };
    let squares = rest.squared_norm();
    let largest = squares.iter().copied().fold(0.0, f64::max);
    let entry = Entry {
        curve: &rest,
        distance,
        limit: distance * distance + COORDINATE_ROUNDING * largest,
    };
    let at = entry.first(&squares, 0.0, 1.0, JUDGE_HALVINGS)?;
    Some(from + at * (1.0 - from))
}

/// Search of the first place within a distance of the origin.
struct Entry<'a, const N: usize> {
    curve: &'a Cubic<N>,
    distance: f64,
    /// Square of the distance, with room for the rounding of squares.
    limit: f64,
}

impl<const N: usize> Entry<'_, N> {
    fn first(&self, squares: &[f64; 7], from: f64, to: f64, halvings: u32) -> Option<f64> {
        let lowest = squares.iter().copied().fold(f64::INFINITY, f64::min);
        if lowest > self.limit {
            return None;
        }
        let inside = |at: f64| self.curve.at(at).norm() <= self.distance;
        if inside(from) {
            return Some(from);
        }
        if halvings == 0 || to - from < ENTRY_PRECISION {
            let closest = newton(self.curve, 0.5 * (from + to)).clamp(from, to);
            // The early side: a corner is never found out of order by the width of a part.
            return (inside(closest) || inside(to)).then_some(from);
        }
        let middle = 0.5 * (from + to);
        let (left, right) = halves(squares);
        self.first(&left, from, middle, halvings - 1)
            .or_else(|| self.first(&right, middle, to, halvings - 1))
    }
}

/// Newton's method on the derivative of the squared distance from the origin.
fn newton<const N: usize>(curve: &Cubic<N>, guess: f64) -> f64 {
    let mut u = guess;
    for _ in 0..POLISHING_STEPS {
        let (position, slope) = (curve.at(u), curve.slope(u));
        let curvature = slope.norm_squared() + position.dot(&curve.bend(u));
        let step = position.dot(&slope) / curvature;
        if !(curvature > 0.0 && step.is_finite()) {
            break;
        }
        u = (u - step).clamp(0.0, 1.0);
    }
    u
}

struct Search<'a, const N: usize> {
    curve: &'a Cubic<N>,
    enough: f64,
    near: Near,
}

impl<const N: usize> Search<'_, N> {
    fn try_at(&mut self, at: f64) {
        let distance = match at {
            u if u <= 0.0 => self.curve.points[0].norm(),
            u if u >= 1.0 => self.curve.points[3].norm(),
            u => self.curve.at(u).norm(),
        };
        if distance < self.near.distance {
            self.near = Near { distance, at };
        }
    }

    fn polish(&mut self, guess: f64) {
        self.try_at(newton(self.curve, guess));
    }

    fn descend(&mut self, squares: &[f64; 7], from: f64, to: f64, halvings: u32) {
        let best = self.near.distance;
        if best <= self.enough {
            return;
        }
        let room = best - (JUDGE_PRECISION * best).max(LENGTH_SLACK);
        let lowest = squares.iter().copied().fold(f64::INFINITY, f64::min);
        let better = room > 0.0 && lowest < room * room;
        // Whether `enough` is reached is decided, not left to the precision of the value.
        let decides = lowest < self.enough * self.enough;
        if !better && !decides && best.is_finite() {
            return;
        }
        if squares.windows(2).all(|pair| pair[1] <= pair[0]) {
            return self.try_at(to);
        }
        if squares.windows(2).all(|pair| pair[1] >= pair[0]) {
            return self.try_at(from);
        }
        if halvings == 0 {
            return self.try_at(0.5 * (from + to));
        }
        let middle = 0.5 * (from + to);
        self.try_at(middle);
        self.polish(from + (to - from) * lowest_place(squares));
        let (left, right) = halves(squares);
        self.descend(&left, from, middle, halvings - 1);
        self.descend(&right, middle, to, halvings - 1);
    }
}

/// Where the control polygon of a polynomial is lowest, in `0..=1`.
fn lowest_place(values: &[f64; 7]) -> f64 {
    let mut place = 0.0;
    let mut lowest = values[0];
    for (value, at) in values.iter().zip([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]) {
        if *value < lowest {
            lowest = *value;
            place = at / 6.0;
        }
    }
    place
}

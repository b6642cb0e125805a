//! Flattens Bezier curves into chords, and cuts them out of splines.
//!
//! Source: de Casteljau's halving, Boehm's insertion of knots. A curve with positive weights lies within
//! its control points, so that chords near all of them are near the curve. Not here: which curves a
//! program asks for, see `splines`.

use crate::interpreter::MAX_MOVES;
use toolglide_kinematics::Vector;

/// A point times its weight, and the weight.
pub(crate) type Weighted = [f64; 4];

/// How often one curve is halved at most: beyond a million chords there is no curve left.
pub(crate) const MAX_HALVINGS: u32 = 20;

/// Appends points to which chords lead from the start of a curve, within `error` of it.
pub(crate) fn flatten(curve: &[Weighted], error: f64, halvings: u32, into: &mut Vec<[f64; 3]>) {
    let (Some(first), Some(last)) = (curve.first(), curve.last()) else {
        return;
    };
    let (start, end) = (place(first), place(last));
    let flat = curve
        .iter()
        .all(|point| off_chord(place(point), start, end) <= error);
    if flat || halvings == 0 || into.len() > MAX_MOVES as usize {
        into.push(end.into());
        return;
    }
    let (before, after) = halved(curve);
    flatten(&before, error, halvings - 1, into);
    flatten(&after, error, halvings - 1, into);
}

fn place(point: &Weighted) -> Vector<3> {
    Vector::from_fn(|axis, _| point[axis] / point[3])
}

/// Distance of a point from a chord.
fn off_chord(point: Vector<3>, start: Vector<3>, end: Vector<3>) -> f64 {
    let along = end - start;
    let from = point - start;
    let square = along.norm_squared();
    let share = if square > 0.0 {
        (from.dot(&along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (from - share * along).norm()
}

/// De Casteljau's two halves of a Bezier curve.
fn halved(curve: &[Weighted]) -> (Vec<Weighted>, Vec<Weighted>) {
    let mut row = curve.to_vec();
    let (mut before, mut after) = (Vec::new(), Vec::new());
    while let (Some(first), Some(last)) = (row.first(), row.last()) {
        before.push(*first);
        after.push(*last);
        row = row
            .windows(2)
            .map(|pair| std::array::from_fn(|axis| 0.5 * (pair[0][axis] + pair[1][axis])))
            .collect();
    }
    after.reverse();
    (before, after)
}

/// Knots of a clamped spline with equal steps between its inner ones.
pub(crate) fn even_knots(points: usize, order: usize) -> Vec<f64> {
    let mut knots = vec![0.0; order];
    let mut inner = 0.0;
    for _ in order..points {
        inner += 1.0;
        knots.push(inner);
    }
    knots.extend(std::iter::repeat_n(inner + 1.0, order));
    knots
}

/// The Bezier curves of a clamped spline, by inserting each of its inner knots until the curves part
/// there (Boehm).
pub(crate) fn beziers(points: &[Weighted], order: usize, knots: &[f64]) -> Vec<Vec<Weighted>> {
    let degree = order - 1;
    if degree == 0 || points.len() < order || knots.len() != points.len() + order {
        return Vec::new();
    }
    // Inner knots, and how often each stands there.
    let mut inner: Vec<(f64, usize)> = Vec::new();
    for &knot in &knots[order..points.len()] {
        match inner.last_mut() {
            Some((last, times)) if knot <= *last => *times += 1,
            _ => inner.push((knot, 1)),
        }
    }
    let mut points = points.to_vec();
    let mut knots = knots.to_vec();
    for &(knot, times) in &inner {
        for _ in times..degree {
            insert(&mut points, &mut knots, degree, knot);
        }
    }
    (0..=inner.len())
        .filter_map(|span| points.get(span * degree..=span * degree + degree))
        .map(<[Weighted]>::to_vec)
        .collect()
}

fn insert(points: &mut Vec<Weighted>, knots: &mut Vec<f64>, degree: usize, knot: f64) {
    let last = knots
        .iter()
        .rposition(|&other| other <= knot)
        .unwrap_or(degree);
    let mut next = Vec::with_capacity(points.len() + 1);
    for index in 0..=points.len() {
        let before = index.checked_sub(1).map(|before| points[before]);
        let share = if index + degree <= last {
            1.0
        } else if index > last {
            0.0
        } else {
            (knot - knots[index]) / (knots[index + degree] - knots[index])
        };
        let here = points.get(index).copied();
        next.push(match (before, here) {
            (Some(before), Some(here)) => {
                std::array::from_fn(|axis| share * here[axis] + (1.0 - share) * before[axis])
            }
            (Some(point), None) | (None, Some(point)) => point,
            (None, None) => [0.0, 0.0, 0.0, 1.0],
        });
    }
    *points = next;
    knots.insert(last + 1, knot);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_circle_of_three_weights_stays_on_its_circle() {
        let weight = 0.5_f64.sqrt();
        let curve = [
            [1.0, 0.0, 2.0, 1.0],
            [weight, weight, 2.0 * weight, weight],
            [0.0, 1.0, 2.0, 1.0],
        ];
        let mut chords = Vec::new();
        flatten(&curve, 1e-4, MAX_HALVINGS, &mut chords);
        assert!(chords.len() > 8, "{} chords", chords.len());
        for point in &chords {
            assert!((point[0].hypot(point[1]) - 1.0).abs() < 1e-12, "{point:?}");
            assert!((point[2] - 2.0).abs() < 1e-12, "{point:?}");
        }
    }

    #[test]
    fn a_spline_in_pieces_is_the_spline_by_its_recursion() {
        let points: Vec<Weighted> = [
            [0.0, 0.0, 0.0, 1.0],
            [1.0, 3.0, 1.0, 1.0],
            [6.0, 8.0, 2.0, 2.0],
            [5.0, -1.0, 1.0, 1.0],
            [3.5, 1.0, 0.0, 0.5],
            [8.0, 0.0, -1.0, 1.0],
        ]
        .to_vec();
        for order in 2..=5 {
            let even = even_knots(points.len(), order);
            // Uneven steps, and two inner knots that coincide where the order allows it.
            let uneven: Vec<f64> = even.iter().map(|knot| 0.3 * knot * knot + 1.0).collect();
            let mut double = uneven.clone();
            if order > 2 && order + 1 < points.len() {
                double[order + 1] = double[order];
            }
            for knots in [even, uneven, double] {
                agree(&points, order, &knots);
            }
        }
    }

    /// Asserts that the middle of each piece is where the recursion has it.
    fn agree(points: &[Weighted], order: usize, knots: &[f64]) {
        let mut distinct = knots.to_vec();
        distinct.dedup();
        let curves = beziers(points, order, knots);
        assert_eq!(curves.len(), distinct.len() - 1, "spans of {knots:?}");
        for (ends, curve) in distinct.windows(2).zip(&curves) {
            let (before, _) = halved(curve);
            let middle = before[order - 1];
            let at = 0.5 * (ends[0] + ends[1]);
            let mut expected = [0.0; 4];
            for (index, point) in points.iter().enumerate() {
                let share = basis(knots, index, order, at);
                for (sum, coordinate) in expected.iter_mut().zip(point) {
                    *sum += share * coordinate;
                }
            }
            let off = (place(&middle) - place(&expected)).norm();
            assert!(off < 1e-12, "order {order} at {at}: off by {off}");
        }
    }

    /// The recursion of Cox and de Boor.
    fn basis(knots: &[f64], index: usize, order: usize, at: f64) -> f64 {
        if order == 1 {
            return f64::from(u8::from(knots[index] <= at && at < knots[index + 1]));
        }
        let part = |from: f64, to: f64, share: f64| {
            let length = to - from;
            if length > 0.0 { share / length } else { 0.0 }
        };
        let (first, last) = (knots[index], knots[index + order - 1]);
        let (second, end) = (knots[index + 1], knots[index + order]);
        part(first, last, at - first) * basis(knots, index, order - 1, at)
            + part(second, end, end - at) * basis(knots, index + 1, order - 1, at)
    }
}

//! Bezier curves: flattened into chords, and cut out of splines.
//!
//! Source: de Casteljau's halving, Boehm's insertion of knots. A curve with positive weights lies within
//! its control points, so that chords near all of them are near the curve. Not here: which curves a
//! program asks for, see `splines`.

use crate::lower::MOST_MOVES;

/// A point times its weight, and the weight.
pub(crate) type Weighted = [f64; 3];

/// How often one curve is halved at most: beyond a million chords there is no curve left.
pub(crate) const MOST_HALVINGS: u32 = 20;

/// Appends points to which chords lead from the start of a curve, within `error` of it.
pub(crate) fn flatten(curve: &[Weighted], error: f64, halvings: u32, into: &mut Vec<[f64; 2]>) {
    let place = |point: &Weighted| [point[0] / point[2], point[1] / point[2]];
    let (Some(first), Some(last)) = (curve.first(), curve.last()) else {
        return;
    };
    let (start, end) = (place(first), place(last));
    let flat = curve
        .iter()
        .all(|point| off_chord(place(point), start, end) <= error);
    if flat || halvings == 0 || into.len() > MOST_MOVES as usize {
        into.push(end);
        return;
    }
    let (before, after) = halved(curve);
    flatten(&before, error, halvings - 1, into);
    flatten(&after, error, halvings - 1, into);
}

/// Distance of a point from a chord.
fn off_chord(point: [f64; 2], start: [f64; 2], end: [f64; 2]) -> f64 {
    let along = [end[0] - start[0], end[1] - start[1]];
    let from = [point[0] - start[0], point[1] - start[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let share = if square > 0.0 {
        ((from[0] * along[0] + from[1] * along[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (from[0] - share * along[0]).hypot(from[1] - share * along[1])
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

/// The Bezier curves of a clamped spline with equal steps between its inner knots, by inserting each
/// inner knot until the curves part there (Boehm).
pub(crate) fn beziers(points: &[Weighted], order: usize) -> Vec<Vec<Weighted>> {
    let spans = points.len() + 1 - order;
    let mut knots: Vec<f64> = Vec::new();
    knots.extend(std::iter::repeat_n(0.0, order));
    let mut inner = 0.0;
    for _ in 1..spans {
        inner += 1.0;
        knots.push(inner);
    }
    knots.extend(std::iter::repeat_n(inner + 1.0, order));
    let mut points = points.to_vec();
    let degree = order - 1;
    let mut knot = 0.0;
    for _ in 1..spans {
        knot += 1.0;
        for _ in 1..degree {
            insert(&mut points, &mut knots, degree, knot);
        }
    }
    if degree == 0 {
        return Vec::new();
    }
    (0..spans)
        .map(|span| points[span * degree..=span * degree + degree].to_vec())
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
            (None, None) => [0.0, 0.0, 1.0],
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
        let curve = [[1.0, 0.0, 1.0], [weight, weight, weight], [0.0, 1.0, 1.0]];
        let mut chords = Vec::new();
        flatten(&curve, 1e-4, MOST_HALVINGS, &mut chords);
        assert!(chords.len() > 8, "{} chords", chords.len());
        for point in &chords {
            assert!((point[0].hypot(point[1]) - 1.0).abs() < 1e-12, "{point:?}");
        }
    }

    #[test]
    fn a_spline_in_pieces_is_the_spline_by_its_recursion() {
        let points: Vec<Weighted> = [
            [0.0, 0.0, 1.0],
            [1.0, 3.0, 1.0],
            [3.0, 4.0, 1.0],
            [5.0, -1.0, 1.0],
            [7.0, 2.0, 1.0],
            [8.0, 0.0, 1.0],
        ]
        .to_vec();
        for order in 2..=5 {
            let curves = beziers(&points, order);
            let spans = points.len() + 1 - order;
            assert_eq!(curves.len(), spans, "spans of order {order}");
            let clamp = |index: usize| index.saturating_sub(order - 1).min(spans);
            let knots: Vec<f64> = (0..points.len() + order)
                .map(|index| f64::from(u32::try_from(clamp(index)).unwrap()))
                .collect();
            for (span, curve) in curves.iter().enumerate() {
                let (before, _) = halved(curve);
                let middle = before[order - 1];
                let at = f64::from(u32::try_from(span).unwrap()) + 0.5;
                let mut expected = [0.0; 2];
                for (index, point) in points.iter().enumerate() {
                    let share = basis(&knots, index, order, at);
                    expected[0] += share * point[0];
                    expected[1] += share * point[1];
                }
                let off = (middle[0] - expected[0]).hypot(middle[1] - expected[1]);
                assert!(off < 1e-12, "order {order}, span {span}: off by {off}");
            }
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

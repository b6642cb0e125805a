//! Draws the sharpest corner from near: programmed path, motion, tolerance.

use super::canvas::{Anchor, Canvas, Outline, through};
use super::chart::{Chart, NORMAL};
use super::color;
use super::corner::SharpCorner;
use toolglide_kinematics::{Piece, Vector};

/// How far around the corner is shown, tolerances.
pub(crate) const WINDOW: f64 = 4.5;

/// How far the middle lies inside the corner, tolerances.
pub(crate) const INSIDE: f64 = 1.6;

/// Points that are drawn of a piece of motion.
const POINTS: u32 = 48;

/// Steps of golden section: a step of the points that are drawn, divided by ten million.
const NARROWING_STEPS: u32 = 34;

/// Share of an interval that a golden-section step keeps.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Tolerances below this are shown in µm, mm.
const MICROMETRES: f64 = 0.25;

/// Where points near a corner stand on the drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View<const N: usize> {
    chart: Chart,
    point: Vector<N>,
    plane: [usize; 2],
    scale: f64,
}

impl<const N: usize> View<N> {
    fn at(&self, point: Vector<N>) -> (f64, f64) {
        let offset = (point - self.point) * self.scale;
        self.chart.at(offset[self.plane[0]], offset[self.plane[1]])
    }

    /// Draws the motion near a corner.
    pub(crate) fn draw_motion(&self, corner: &SharpCorner<N>, color: &str, canvas: &mut Canvas) {
        let chart = &self.chart;
        canvas.clip(chart.x, chart.y, chart.width, chart.height);
        draw_curve_near(
            canvas,
            color,
            &through(motion(corner).map(|point| self.at(point))),
        );
        canvas.unclip();
    }
}

/// Draws the corner into a part of the drawing; without one it says so. What it gives places other
/// motions on the same drawing.
pub(crate) fn draw<const N: usize>(
    corner: Option<&SharpCorner<N>>,
    letters: &[char],
    canvas: &mut Canvas,
    [x, y, width, height]: [f64; 4],
    colors: &str,
) -> Option<View<N>> {
    let mut chart = Chart {
        x,
        y,
        width,
        height,
        across: (-1.0, 1.0),
        upward: (-1.0, 1.0),
    };
    let Some(corner) = corner else {
        chart.draw_frame(canvas, "Sharpest corner");
        let at = (x + 0.5 * width, y + 0.5 * height);
        canvas.text(
            at,
            Anchor::Middle,
            NORMAL,
            "fill=\"#4a525b\"",
            "the path has no corner",
        );
        return None;
    };
    let tolerance = corner.tolerance.length();
    let (scale, unit) = if tolerance < MICROMETRES {
        (1e3, "µm")
    } else {
        (1.0, "mm")
    };
    let plane = plane(corner);
    let inward = corner.outgoing - corner.incoming;
    let middle = inward / inward.norm() * (INSIDE * tolerance * scale);
    let half = WINDOW * tolerance * scale;
    chart.across = (middle[plane[0]] - half, middle[plane[0]] + half);
    chart.upward = (middle[plane[1]] - half, middle[plane[1]] + half);
    let chart = chart.with_equal_scales();
    chart.draw_grid(canvas, 1.0, true);
    canvas.clip(x, y, width, height);
    let view = View {
        chart,
        point: corner.point,
        plane,
        scale,
    };
    let on_chart = |point: Vector<N>| view.at(point);
    draw_bounds(
        canvas,
        &chart,
        on_chart(corner.point),
        tolerance * scale,
        &through(corner.path.iter().map(|&point| on_chart(point))),
    );
    canvas.unclip();
    view.draw_motion(corner, color::MOTION, canvas);
    canvas.clip(x, y, width, height);
    let nearest = nearest(corner);
    draw_nearest(canvas, on_chart(corner.point), nearest.map(on_chart));
    canvas.unclip();
    let place = if corner.line > 0 {
        format!(", line {}", corner.line)
    } else {
        String::new()
    };
    chart.draw_frame(canvas, &format!("Sharpest corner{place}, {unit}"));
    let passed = nearest.map_or(0.0, |nearest| (nearest - corner.point).norm());
    let remark = format!(
        "turn {:.1}°, passed at {:.3} of {:.3} {unit}",
        corner.turn.to_degrees(),
        passed * scale,
        tolerance * scale
    );
    chart.draw_remark(canvas, &remark);
    let letter = |axis: usize| letters.get(axis).copied().unwrap_or('?');
    let name = format!(
        "{} across, {} up, from the corner; grey: programmed, {colors}, red: tolerance",
        letter(plane[0]),
        letter(plane[1])
    );
    chart.draw_name_across(canvas, &name);
    Some(view)
}

/// Draws the tolerance around a corner, and the path through it.
pub(crate) fn draw_bounds(
    canvas: &mut Canvas,
    chart: &Chart,
    corner: (f64, f64),
    tolerance: f64,
    path: &Outline,
) {
    let ring = format!(
        "fill=\"{0}\" fill-opacity=\"0.06\" stroke=\"{0}\" stroke-width=\"1.4\" \
         stroke-dasharray=\"7 5\"",
        color::BOUND
    );
    canvas.circle(corner, chart.pixels(tolerance), &ring);
    let style = format!(
        "fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" stroke-linejoin=\"miter\"",
        color::PROGRAMMED
    );
    canvas.path(path, &style);
}

/// Draws the motion near a corner.
pub(crate) fn draw_curve_near(canvas: &mut Canvas, color: &str, motion: &Outline) {
    let style =
        format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"2.6\" stroke-linejoin=\"round\"");
    canvas.path(motion, &style);
}

/// Marks a corner and the point of the motion that is nearest.
pub(crate) fn draw_nearest(canvas: &mut Canvas, corner: (f64, f64), nearest: Option<(f64, f64)>) {
    if let Some(nearest) = nearest {
        let style = format!("stroke=\"{}\" stroke-width=\"1.2\"", color::MOTION);
        canvas.line(corner, nearest, &style);
        let dot = format!("fill=\"{}\"", color::MOTION);
        canvas.circle(nearest, 3.4, &dot);
    }
    let dot = format!("fill=\"{}\"", color::PROGRAMMED);
    canvas.circle(corner, 3.0, &dot);
}

/// Points of the motion, close enough to look like a curve where the window is.
fn motion<const N: usize>(corner: &SharpCorner<N>) -> impl Iterator<Item = Vector<N>> + '_ {
    corner.pieces.iter().flat_map(move |piece| {
        let points = points_of(corner, piece);
        (0..=points).map(move |step| {
            let share = f64::from(step) / f64::from(points);
            piece.position_at(piece.duration() * share)
        })
    })
}

/// How many points of a piece are drawn: one, its end, where it is far from the corner.
fn points_of<const N: usize>(corner: &SharpCorner<N>, piece: &Piece<N>) -> u32 {
    let near = 4.0 * WINDOW * corner.tolerance.length();
    let length = (piece.end() - piece.start()).norm();
    if (piece.start() - corner.point).norm() < near + length {
        POINTS
    } else {
        1
    }
}

/// The point of the motion nearest to the corner, as the judge finds it: between the points that are drawn.
///
/// The motion may come by again later; what counts is how it turns here.
fn nearest<const N: usize>(corner: &SharpCorner<N>) -> Option<Vector<N>> {
    let turning = corner
        .pieces
        .iter()
        .filter(|piece| corner.is_served_by(piece));
    let points = turning.map(|piece| {
        let at = |share: f64| piece.position_at(piece.duration() * share);
        let distance = |share: f64| (at(share) - corner.point).norm();
        at(nearest_share(points_of(corner, piece), distance))
    });
    points.min_by(|one, two| {
        let distance = |point: &Vector<N>| (point - corner.point).norm();
        distance(one).total_cmp(&distance(two))
    })
}

/// Where in `0..=1` a distance is smallest: about the smallest of so many equal steps, narrowed down
/// between its neighbours by golden section to the digits of a picture.
pub(crate) fn nearest_share(points: u32, distance: impl Fn(f64) -> f64) -> f64 {
    let share = |step: u32| f64::from(step) / f64::from(points);
    let mut best = (0, f64::INFINITY);
    for step in 0..=points {
        let here = distance(share(step));
        if here < best.1 {
            best = (step, here);
        }
    }
    let mut low = share(best.0.saturating_sub(1));
    let mut high = share((best.0 + 1).min(points));
    for _ in 0..NARROWING_STEPS {
        let inside = (high - low) * GOLDEN;
        if distance(high - inside) < distance(low + inside) {
            high = low + inside;
        } else {
            low = high - inside;
        }
    }
    let narrowed = 0.5 * (low + high);
    if distance(narrowed) < best.1 {
        narrowed
    } else {
        share(best.0)
    }
}

/// The two axes between which the corner turns most.
fn plane<const N: usize>(corner: &SharpCorner<N>) -> [usize; 2] {
    let (one, two) = (corner.incoming, corner.outgoing);
    let mut most = [0, 1];
    let area = |[a, b]: [usize; 2]| (one[a] * two[b] - one[b] * two[a]).abs();
    for pair in [[0, 2], [1, 2]] {
        if pair[1] < N && area(pair) > area(most) * 1.01 {
            most = pair;
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_nearest_is_found_between_the_points_that_are_drawn() {
        for place in [0.0, 0.013, 0.5, 0.617, 1.0] {
            let distance = |share: f64| ((share - place) * 3.0).hypot(0.03);
            let found = nearest_share(48, distance);
            assert!((distance(found) - 0.03).abs() < 1e-12, "{place}: {found}");
        }
    }
}

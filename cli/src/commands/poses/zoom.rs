//! Draws the sharpest corner of tool tip or tool orientation from near.

use crate::commands::poses::corner::{Part, PoseCorner, PoseCornerFinder};
use crate::plot::canvas::{Anchor, Canvas, Outline, through};
use crate::plot::chart::{Chart, NORMAL};
use crate::plot::color;
use crate::plot::zoom::{
    INSIDE, WINDOW, draw_bounds, draw_curve_near, draw_nearest, nearest_share,
};
use toolglide_kinematics::Vector;

/// Points that are drawn of a piece of motion.
const POINTS: u32 = 24;

/// Draws what a finder found into a part of the sheet; without a corner it says so.
pub(super) fn draw(
    finder: &PoseCornerFinder,
    canvas: &mut Canvas,
    [x, y, width, height]: [f64; 4],
) {
    let chart = Chart {
        x,
        y,
        width,
        height,
        across: (-1.0, 1.0),
        upward: (-1.0, 1.0),
    };
    let (name, scale, unit) = match finder.part {
        Part::Tip => ("Tool tip", 1e3, "µm"),
        Part::Orientation => ("Orientation", 1e3, "mrad"),
    };
    let Some(corner) = finder.best() else {
        chart.draw_frame(canvas, &format!("{name} at its sharpest corner"));
        let at = (x + 0.5 * width, y + 0.5 * height);
        let none = "there is none without a stop";
        canvas.text(at, Anchor::Middle, NORMAL, "fill=\"#4a525b\"", none);
        return;
    };
    let plane = Plane::of(corner, scale);
    let window = WINDOW * corner.tolerance * scale;
    let middle = plane.inside * (INSIDE * corner.tolerance * scale);
    let chart = Chart {
        across: (middle.x - window, middle.x + window),
        upward: (middle.y - window, middle.y + window),
        ..chart
    }
    .with_equal_scales();
    chart.draw_grid(canvas, 1.0, true);
    canvas.clip(x, y, width, height);
    let center = chart.at(0.0, 0.0);
    // Longer than the diagonal of the drawing.
    let far = 8.0 * window;
    let ways = [
        -plane.flat(corner.incoming) * far,
        Vector::<2>::zeros(),
        plane.flat(corner.outgoing) * far,
    ];
    let mut path = Outline::default();
    path.stretch(ways.iter().map(|way| chart.at(way.x, way.y)));
    draw_bounds(canvas, &chart, center, corner.tolerance * scale, &path);
    let offsets: Vec<Vector<3>> = motion(finder.part, corner).collect();
    let place = |offset: &Vector<3>| {
        let flat = plane.flat(*offset) * scale;
        chart.at(flat.x, flat.y)
    };
    draw_curve_near(canvas, color::MOTION, &through(offsets.iter().map(place)));
    let nearest = nearest(finder.part, corner);
    draw_nearest(canvas, center, nearest.as_ref().map(place));
    canvas.unclip();
    let line = if corner.line > 0 {
        format!(" at line {}", corner.line)
    } else {
        " at its sharpest corner".to_owned()
    };
    chart.draw_frame(canvas, &format!("{name}{line}, {unit}"));
    let passed = nearest.map_or(0.0, |nearest| nearest.norm()) * scale;
    chart.draw_name_across(
        canvas,
        &format!(
            "passed at {} of {} {unit}; red: tolerance",
            figures(passed),
            figures(corner.tolerance * scale)
        ),
    );
}

/// A length with as many decimals as it needs to be told from its bound.
fn figures(value: f64) -> String {
    let decimals = if value < 10.0 { 4 } else { 2 };
    format!("{value:.decimals$}")
}

/// The plane in which a path turns.
struct Plane {
    across: Vector<3>,
    upward: Vector<3>,
    /// Unit direction from the corner to the inner side.
    inside: Vector<2>,
}

impl Plane {
    /// Incoming to the right, the turn upward.
    fn of(corner: &PoseCorner, scale: f64) -> Self {
        let across = corner.incoming;
        let turned = corner.outgoing - across * across.dot(&corner.outgoing);
        let upward = turned.try_normalize(0.0).unwrap_or_else(Vector::zeros);
        let mut plane = Self {
            across,
            upward,
            inside: Vector::zeros(),
        };
        let inward = plane.flat(corner.outgoing - corner.incoming) * scale;
        plane.inside = inward.try_normalize(0.0).unwrap_or_else(Vector::zeros);
        plane
    }

    fn flat(&self, offset: Vector<3>) -> Vector<2> {
        Vector::from([offset.dot(&self.across), offset.dot(&self.upward)])
    }
}

/// Where the motion stands from the corner when it is nearest, between the points that are drawn.
fn nearest(part: Part, corner: &PoseCorner) -> Option<Vector<3>> {
    let points = corner.pieces.iter().map(|piece| {
        let at = |share: f64| part.of(&piece.at(piece.duration * share)) - corner.point;
        at(nearest_share(POINTS, |share| at(share).norm()))
    });
    points.min_by(|one, two| one.norm().total_cmp(&two.norm()))
}

/// Where the motion stands from the corner, close enough to look like a curve.
fn motion(part: Part, corner: &PoseCorner) -> impl Iterator<Item = Vector<3>> + '_ {
    corner.pieces.iter().flat_map(move |piece| {
        (0..=POINTS).map(move |step| {
            let pose = piece.at(piece.duration * f64::from(step) / f64::from(POINTS));
            part.of(&pose) - corner.point
        })
    })
}

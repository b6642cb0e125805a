//! Draws the path of the motion, coloured by speed.

use super::canvas::{Anchor, Canvas, Outline};
use super::chart::{Chart, SMALL};
use super::{Plot, RAPID, color};
use toolglide_kinematics::Vector;

/// Room around the path, as a share of its extent.
const MARGIN: f64 = 0.05;

/// An extent below this share of the largest is flat.
const FLAT: f64 = 1e-3;

/// Extent that is shown around a path of no extent, mm.
const MIN_EXTENT: f64 = 1.0;

/// Widths of the line of a path, pixels.
const THICKEST: f64 = 1.7;
/// As above.
const FINEST: f64 = 0.45;

/// A path of this many pixels still has the thickest line.
const LIGHT: f64 = 8000.0;

/// Width of the scale of colours, pixels.
const SCALE_WIDTH: f64 = 128.0;

/// Draws the path into a part of the drawing.
pub(crate) fn draw<const N: usize>(
    plot: &Plot<N>,
    canvas: &mut Canvas,
    x: f64,
    y: f64,
    width: f64,
    height: f64,
) {
    let (low, high) = plot.programmed.extent();
    let (motion_low, motion_high) = plot.motion.extent();
    let (low, high) = (low.inf(&motion_low), high.sup(&motion_high));
    let [across, upward] = projection(&(high - low));
    let room = (MARGIN * (high - low).norm()).max(0.5 * MIN_EXTENT * MARGIN);
    let range = |axis: usize| (low[axis] - room, high[axis] + room);
    let chart = Chart {
        x,
        y,
        width,
        height,
        across: range(across),
        upward: range(upward),
    }
    .with_equal_scales();
    chart.draw_grid(canvas, 1.0, true);
    canvas.clip(x, y, width, height);
    let fastest = plot.cutting_speed;
    let (rapids, cuts) = outlines(plot, &chart, [across, upward], fastest);
    let style = "fill=\"none\" stroke=\"#9aa3ad\" stroke-width=\"1\" stroke-dasharray=\"5 4\"";
    canvas.path(&rapids, style);
    let stroke = stroke(plot.programmed.length() * chart.pixels(1.0));
    for (shade, outline) in cuts.iter().enumerate() {
        let style = format!(
            "fill=\"none\" stroke=\"{}\" stroke-width=\"{stroke:.2}\" stroke-linecap=\"round\" \
             stroke-linejoin=\"round\"",
            color::shade(shade)
        );
        canvas.path(outline, &style);
    }
    if let Some((start, _)) = plot.programmed.points().next() {
        let style = "fill=\"#ffffff\" stroke=\"#20262d\" stroke-width=\"1.8\"";
        canvas.circle(chart.at(start[across], start[upward]), 4.5, style);
    }
    canvas.unclip();
    let letter = |axis: usize| plot.letters.get(axis).copied().unwrap_or('?');
    chart.draw_frame(
        canvas,
        &format!("Path in {}{}, mm", letter(across), letter(upward)),
    );
    let mut name = format!(
        "{} across, {} up; ring: start",
        letter(across),
        letter(upward)
    );
    if plot.motion.points().any(|point| point.1.is_infinite()) {
        name.push_str("; grey: rapids");
    }
    chart.draw_name_across(canvas, &name);
    draw_scale(canvas, &chart, fastest);
}

/// Width of the line of a path that goes over many pixels: the longer, the finer, so that lines
/// side by side stay lines.
fn stroke(pixels: f64) -> f64 {
    let share = (LIGHT / pixels.max(LIGHT)).sqrt();
    (THICKEST * share).max(FINEST)
}

/// The two axes to look at: X and Y unless the path is flat there.
fn projection<const N: usize>(extent: &Vector<N>) -> [usize; 2] {
    let most = extent.max();
    if N < 3 || extent[1].min(extent[0]) > FLAT * most {
        return [0, 1];
    }
    let least = (0..N)
        .rev()
        .min_by(|&one, &two| extent[one].total_cmp(&extent[two]))
        .unwrap_or(2);
    match least {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

/// The outline of the rapids, and one for each shade of speed.
fn outlines<const N: usize>(
    plot: &Plot<N>,
    chart: &Chart,
    [across, upward]: [usize; 2],
    fastest: f64,
) -> (Outline, Vec<Outline>) {
    let mut rapids = Outline::default();
    let mut cuts = vec![Outline::default(); color::SHADES];
    let mut last: Option<(Vector<N>, f64)> = None;
    let mut open = None;
    for (point, speed) in plot.motion.points() {
        if let Some((from, former)) = last {
            let shade = (speed < RAPID).then(|| {
                let former = if former < RAPID { former } else { speed };
                color::nearest(0.5 * (speed + former), fastest)
            });
            let outline = match shade {
                Some(shade) => &mut cuts[shade],
                None => &mut rapids,
            };
            if open != Some(shade) {
                outline.move_to(chart.at(from[across], from[upward]));
                open = Some(shade);
            }
            outline.line_to(chart.at(point[across], point[upward]));
        }
        last = Some((point, speed));
    }
    (rapids, cuts)
}

#[allow(clippy::cast_precision_loss, reason = "a handful of shades")]
fn draw_scale(canvas: &mut Canvas, chart: &Chart, fastest: f64) {
    let y = chart.y - 18.0;
    if fastest <= 0.0 {
        return;
    }
    let text = format!("{fastest:.1} mm/s");
    let right = chart.x + chart.width;
    canvas.text(
        (right, y + 10.0),
        Anchor::End,
        SMALL,
        "fill=\"#4a525b\"",
        &text,
    );
    let left = right - 82.0 - SCALE_WIDTH;
    let step = SCALE_WIDTH / color::SHADES as f64;
    for shade in 0..color::SHADES {
        let style = format!("fill=\"{}\"", color::shade(shade));
        canvas.rectangle(left + step * shade as f64, y + 1.0, step + 0.3, 8.0, &style);
    }
    canvas.text(
        (left - 8.0, y + 10.0),
        Anchor::End,
        SMALL,
        "fill=\"#4a525b\"",
        "speed 0",
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_that_is_flat_in_the_plane_is_seen_from_the_side() {
        assert_eq!(projection(&Vector::<3>::new(100.0, 50.0, 80.0)), [0, 1]);
        assert_eq!(projection(&Vector::<3>::new(100.0, 0.0, 20.0)), [0, 2]);
        assert_eq!(projection(&Vector::<3>::new(0.0, 30.0, 20.0)), [1, 2]);
        assert_eq!(projection(&Vector::<3>::new(0.0, 0.0, 20.0)), [0, 2]);
        assert_eq!(projection(&Vector::<3>::new(10.0, 0.0, 0.0)), [0, 1]);
        assert_eq!(projection(&Vector::<2>::new(10.0, 0.0)), [0, 1]);
    }
}

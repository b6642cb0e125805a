//! Draws one curve over time: a line, or an area where it swings faster than the chart can show.
//!
//! Not here: the frame around it.

use super::canvas::{Canvas, Outline};
use super::chart::Chart;
use super::envelope::Envelope;

/// A curve within this many pixels of height is a line however it swings.
const AREA: f64 = 6.0;

/// A curve that goes this many times its height to and fro nearby is drawn as an area.
const SWINGS: f64 = 3.0;

/// Stretches on either side that count as nearby: about ten pixels in all.
const NEAR: usize = 10;

/// Stretches on either side that the edge of an area takes in.
const SMOOTH: usize = 2;

/// What the eye does not see, pixels.
const SUBPIXEL: f64 = 0.05;

/// A curve: a line where it is one, an area where it swings faster than the chart can show.
pub(crate) fn draw_curve(
    canvas: &mut Canvas,
    chart: &Chart,
    curves: &Envelope,
    curve: usize,
    scale: f64,
    color: &str,
) {
    let half = 0.5 * curves.width();
    let bars: Vec<Bar> = curves
        .curve(curve)
        .map(|(stretch, low, high)| {
            let middle = curves.begin(stretch) + half;
            let (x, top) = chart.at(middle, high * scale);
            let (_, bottom) = chart.at(middle, low * scale);
            Bar { x, top, bottom }
        })
        .collect();
    let dense = dense(&bars);
    let mut area = Outline::default();
    let mut edge = Outline::default();
    let mut line = Outline::default();
    let mut begin = 0;
    for run in dense.chunk_by(|one, two| one == two) {
        let range = begin..begin + run.len();
        begin += run.len();
        let bars: Vec<Bar> = if run[0] {
            range
                .map(|at| Bar {
                    x: bars[at].x,
                    ..hull(near(&bars, at, SMOOTH))
                })
                .collect()
        } else {
            bars[range].to_vec()
        };
        if run[0] {
            let there = bars.iter().map(|bar| (bar.x, bar.top));
            let back = bars.iter().rev().map(|bar| (bar.x, bar.bottom));
            area.stretch(there.clone().chain(back));
            area.close();
            edge.stretch(there);
            edge.stretch(bars.iter().map(|bar| (bar.x, bar.bottom)));
            // The line goes on behind the area where it left.
            if let Some(last) = bars.last() {
                line.move_to((last.x, 0.5 * (last.top + last.bottom)));
            }
        } else {
            add_line(&mut line, &bars);
        }
    }
    canvas.path(&area, &format!("fill=\"{color}\" fill-opacity=\"0.3\""));
    let style = format!("fill=\"none\" stroke=\"{color}\" stroke-linejoin=\"round\"");
    canvas.path(
        &edge,
        &format!("{style} stroke-width=\"0.7\" stroke-opacity=\"0.75\""),
    );
    canvas.path(&line, &format!("{style} stroke-width=\"1.4\""));
}

/// Least and greatest value of a curve in a stretch, in pixels.
#[derive(Clone, Copy, Debug)]
struct Bar {
    x: f64,
    top: f64,
    bottom: f64,
}

/// Where the curve swings to and fro within a few pixels, so that a line would be a smear.
fn dense(bars: &[Bar]) -> Vec<bool> {
    let swings = |near: &[Bar]| {
        let way: f64 = near.iter().map(|bar| bar.bottom - bar.top).sum();
        let around = hull(near);
        let span = around.bottom - around.top;
        span > AREA && way > SWINGS * span
    };
    let mut dense: Vec<bool> = (0..bars.len())
        .map(|at| swings(near(bars, at, NEAR)))
        .collect();
    let mut begin = 0;
    let runs: Vec<(bool, usize)> = dense
        .chunk_by(|one, two| one == two)
        .map(|run| (run[0], run.len()))
        .collect();
    // A glimpse of a line within an area is no line.
    for (index, (is_dense, length)) in runs.iter().enumerate() {
        if !is_dense && *length < NEAR && index > 0 && index + 1 < runs.len() {
            dense[begin..begin + length].fill(true);
        }
        begin += length;
    }
    dense
}

/// Up to `count` bars on either side of one.
fn near(bars: &[Bar], at: usize, count: usize) -> &[Bar] {
    &bars[at.saturating_sub(count)..(at + count + 1).min(bars.len())]
}

/// The bar around bars, at the middle of them.
fn hull(bars: &[Bar]) -> Bar {
    let nothing = Bar {
        x: bars.get(bars.len() / 2).map_or(0.0, |bar| bar.x),
        top: f64::INFINITY,
        bottom: f64::NEG_INFINITY,
    };
    bars.iter().fold(nothing, |around, bar| Bar {
        top: around.top.min(bar.top),
        bottom: around.bottom.max(bar.bottom),
        ..around
    })
}

fn add_line(line: &mut Outline, bars: &[Bar]) {
    for (index, bar) in bars.iter().enumerate() {
        let level = |other: Option<&Bar>| {
            other.is_some_and(|other| {
                (other.top - bar.bottom).abs() < SUBPIXEL
                    && (other.bottom - bar.top).abs() < SUBPIXEL
            })
        };
        // The inner points of a level stretch add nothing.
        if index > 0 && level(bars.get(index - 1)) && level(bars.get(index + 1)) {
            continue;
        }
        let next = bars.get(index + 1);
        let rising = next.is_none_or(|next| next.top + next.bottom <= bar.top + bar.bottom);
        let (one, two) = if rising {
            (bar.bottom, bar.top)
        } else {
            (bar.top, bar.bottom)
        };
        line.line_to((bar.x, one));
        if bar.bottom - bar.top > SUBPIXEL {
            line.line_to((bar.x, two));
        }
    }
}

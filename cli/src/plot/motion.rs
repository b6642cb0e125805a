//! Draws feedrate, velocity, acceleration and jerk over time, with their limits.

use super::canvas::{Canvas, Outline};
use super::chart::{Chart, time_unit};
use super::curve::draw_curve;
use super::{Plot, color, feed_curve, speed_curve};

/// A limit farther away than this many times the peak is told instead of drawn.
const FAR_LIMIT: f64 = 3.0;

/// Rapids faster than this many times the fastest cut are told instead of drawn.
pub(super) const FAR_RAPID: f64 = 2.0;

/// Programmed feedrates faster than this many times the fastest cut are told instead of drawn.
const FAR_FEED: f64 = 5.0;

/// Numbers from here on are shown in thousands: mm/s³ become m/s³.
const THOUSANDS: f64 = 20_000.0;

/// What goes back less than this share of what goes forward gets no more room than that.
const BACKWARD: f64 = 0.08;

/// Room above the highest curve, as a share.
pub(super) const HEADROOM: f64 = 1.12;

/// One chart of the axes.
struct Panel<'a> {
    title: &'a str,
    unit: &'a str,
    unit_of_thousands: &'a str,
    first_curve: usize,
    limits: &'a [f64],
}

/// Draws the four charts, from the top down, in a column.
pub(crate) fn draw<const N: usize>(
    plot: &Plot<N>,
    canvas: &mut Canvas,
    x: f64,
    width: f64,
    tops: [f64; 4],
    height: f64,
) {
    let time = if plot.time > 0.0 { plot.time } else { 1.0 };
    let chart = |top: f64, upward: (f64, f64)| Chart {
        x,
        y: top,
        width,
        height,
        across: (0.0, time),
        upward,
    };
    feedrate(plot, canvas, |upward| chart(tops[0], upward));
    let panels = [
        Panel {
            title: "Velocity",
            unit: "mm/s",
            unit_of_thousands: "m/s",
            first_curve: 0,
            limits: plot.limits.velocity().as_slice(),
        },
        Panel {
            title: "Acceleration",
            unit: "mm/s²",
            unit_of_thousands: "m/s²",
            first_curve: N,
            limits: plot.limits.acceleration().as_slice(),
        },
        Panel {
            title: "Jerk",
            unit: "mm/s³",
            unit_of_thousands: "m/s³",
            first_curve: 2 * N,
            limits: plot.limits.jerk().as_slice(),
        },
    ];
    for (panel, top) in panels.iter().zip(&tops[1..]) {
        let lowest = panel.first_curve == 2 * N;
        axes(plot, canvas, panel, |upward| chart(*top, upward), lowest);
    }
}

fn feedrate<const N: usize>(
    plot: &Plot<N>,
    canvas: &mut Canvas,
    chart: impl Fn((f64, f64)) -> Chart,
) {
    let fastest = plot.curves.peak(speed_curve(N));
    let programmed_at_most = plot.curves.peak(feed_curve(N));
    let never_reached =
        plot.cutting_speed > 0.0 && programmed_at_most > FAR_FEED * plot.cutting_speed;
    let cutting = if never_reached {
        plot.cutting_speed
    } else {
        plot.cutting_speed.max(programmed_at_most)
    };
    let too_fast = cutting > 0.0 && fastest > FAR_RAPID * cutting;
    let most = if too_fast {
        cutting
    } else {
        fastest.max(cutting)
    };
    let chart = chart((0.0, if most > 0.0 { HEADROOM * most } else { 1.0 }));
    chart.draw_grid(canvas, time_unit(plot.time).0, false);
    canvas.clip(chart.x, chart.y, chart.width, chart.height);
    draw_curve(
        canvas,
        &chart,
        &plot.curves,
        speed_curve(N),
        1.0,
        color::MOTION,
    );
    programmed(plot, canvas, &chart);
    canvas.unclip();
    chart.draw_frame(canvas, "Feedrate along the path, mm/s");
    let mut entries = vec![("planned", color::MOTION, false)];
    let beyond = format!("programmed up to {programmed_at_most:.0}");
    if never_reached {
        entries.push((&beyond, "", false));
    } else if cutting > 0.0 {
        entries.push(("programmed", color::PROGRAMMED, true));
    }
    let told = format!("rapids up to {fastest:.0}");
    if too_fast {
        entries.push((&told, "", false));
    }
    chart.draw_legend(canvas, &entries);
}

/// The programmed feedrate as a dashed step line; rapids have none.
fn programmed<const N: usize>(plot: &Plot<N>, canvas: &mut Canvas, chart: &Chart) {
    let mut outline = Outline::default();
    let mut last: Option<(usize, f64)> = None;
    for (stretch, _, feed) in plot.curves.curve(feed_curve(N)) {
        let begin = plot.curves.begin(stretch);
        match last {
            Some((before, former)) if before + 1 == stretch => {
                if (former - feed).abs() > 0.0 {
                    outline.line_to(chart.at(begin, former));
                    outline.line_to(chart.at(begin, feed));
                }
            }
            Some((before, former)) => {
                outline.line_to(chart.at(plot.curves.begin(before + 1), former));
                outline.move_to(chart.at(begin, feed));
            }
            None => outline.move_to(chart.at(begin, feed)),
        }
        last = Some((stretch, feed));
    }
    if let Some((stretch, feed)) = last {
        outline.line_to(chart.at(plot.curves.begin(stretch + 1).min(plot.time), feed));
    }
    let style = format!(
        "fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" stroke-dasharray=\"7 5\"",
        color::PROGRAMMED
    );
    canvas.path(&outline, &style);
}

fn axes<const N: usize>(
    plot: &Plot<N>,
    canvas: &mut Canvas,
    panel: &Panel<'_>,
    chart: impl Fn((f64, f64)) -> Chart,
    lowest: bool,
) {
    let peak = (0..N)
        .map(|axis| plot.curves.peak(panel.first_curve + axis))
        .fold(0.0, f64::max);
    let drawn: Vec<bool> = panel
        .limits
        .iter()
        .map(|&limit| peak <= 0.0 || limit <= FAR_LIMIT * peak)
        .collect();
    let most = panel
        .limits
        .iter()
        .zip(&drawn)
        .filter(|(_, drawn)| **drawn)
        .fold(peak, |most, (&limit, _)| most.max(limit));
    let scale = if most >= THOUSANDS { 1e-3 } else { 1.0 };
    let unit = if most >= THOUSANDS {
        panel.unit_of_thousands
    } else {
        panel.unit
    };
    let bound = HEADROOM * most * scale;
    // What only goes forward needs no room for going back.
    let lowest_value = (0..N)
        .map(|axis| plot.curves.least(panel.first_curve + axis))
        .fold(0.0, f64::min);
    let forward = !drawn.contains(&true) && lowest_value > -BACKWARD * most;
    let chart = chart((if forward { -BACKWARD * bound } else { -bound }, bound));
    chart.draw_grid(canvas, time_unit(plot.time).0, lowest);
    canvas.clip(chart.x, chart.y, chart.width, chart.height);
    for axis in (0..N).rev().filter(|&axis| plot.moves(axis)) {
        let color = color::of_axis(axis);
        draw_curve(
            canvas,
            &chart,
            &plot.curves,
            panel.first_curve + axis,
            scale,
            color,
        );
    }
    let alike = draw_limits(panel, &drawn, scale, &chart, canvas);
    canvas.unclip();
    chart.draw_frame(canvas, &format!("{}, {unit}", panel.title));
    if lowest {
        chart.draw_name_across(canvas, &format!("time, {}", time_unit(plot.time).1));
    }
    let names: Vec<String> = plot.letters.iter().map(char::to_string).collect();
    let told = told_limits(panel, &names, &drawn, alike, (scale, unit));
    let mut entries: Vec<(&str, &str, bool)> = names
        .iter()
        .zip(color::AXES)
        .enumerate()
        .filter(|&(axis, _)| plot.moves(axis))
        .map(|(_, (name, color))| (name.as_str(), color, false))
        .collect();
    if drawn.contains(&true) {
        let color = if alike {
            color::BOUND
        } else {
            color::PROGRAMMED
        };
        entries.push(("limit", color, true));
    }
    if !told.is_empty() {
        entries.push((&told, "", false));
    }
    chart.draw_legend(canvas, &entries);
}

/// The limits that are near enough, as dashed lines; one for all axes where they are alike, which it gives.
fn draw_limits(
    panel: &Panel<'_>,
    drawn: &[bool],
    scale: f64,
    chart: &Chart,
    canvas: &mut Canvas,
) -> bool {
    let alike = panel
        .limits
        .windows(2)
        .all(|pair| pair[0].to_bits() == pair[1].to_bits());
    let bounds = panel.limits.iter().zip(drawn).enumerate();
    for (axis, (&limit, _)) in bounds.filter(|(_, (_, drawn))| **drawn) {
        let color = if alike {
            color::BOUND
        } else {
            color::of_axis(axis)
        };
        let style = format!("stroke=\"{color}\" stroke-width=\"1.3\" stroke-dasharray=\"8 5\"");
        for limit in [limit * scale, -limit * scale] {
            let (_, y) = chart.at(0.0, limit);
            canvas.line((chart.x, y), (chart.x + chart.width, y), &style);
        }
        if alike {
            break;
        }
    }
    alike
}

/// Limits that are too far away to be drawn, in words, in the unit of the chart.
fn told_limits(
    panel: &Panel<'_>,
    names: &[String],
    drawn: &[bool],
    alike: bool,
    (scale, unit): (f64, &str),
) -> String {
    let shown = |limit: f64| crate::output::summary::shortest(limit * scale);
    if alike {
        return match (drawn.first(), panel.limits.first()) {
            (Some(false), Some(limit)) => format!("limit ±{} {unit}", shown(*limit)),
            _ => String::new(),
        };
    }
    let told: Vec<String> = names
        .iter()
        .zip(drawn)
        .zip(panel.limits)
        .filter(|((_, drawn), _)| !**drawn)
        .map(|((name, _), limit)| format!("{name} ±{}", shown(*limit)))
        .collect();
    if told.is_empty() {
        String::new()
    } else {
        format!("limits {} {unit}", told.join(", "))
    }
}

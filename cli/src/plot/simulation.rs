//! Draws simulated motions: the deviation of the tool magnified, errors and forces over time, the trade-off among motions.
//!
//! Everything is gathered in fixed memory. Where a program has one full circle the deviation is the picture of a ballbar
//! (ISO 230-4). Not here: the simulation.

use super::canvas::{Anchor, Canvas, through};
use super::chart::{Chart, SMALL, time_unit};
use super::curve::draw_curve;
use super::envelope::Envelope;
use super::motion::HEADROOM;
use super::{Caption, color};
use toolglide_kinematics::Vector;
use toolglide_simulation::{Instant, ResponsePoint};

/// Size of the sheet, pixels.
const WIDTH: f64 = 1600.0;
/// As above.
const HEIGHT: f64 = 1200.0;

/// Points of a path that are kept.
const POINTS: usize = 4096;

/// Reversals that are marked.
const REVERSALS: usize = 400;

/// The largest error is drawn as this share of the picture.
const LARGEST_SHARE: f64 = 1.0 / 15.0;

/// Curves of the envelope before those of the axes.
const SERVO: usize = 0;
/// As above.
const PART: usize = 1;
/// As above.
const TOLERANCE: usize = 2;
/// As above.
const FORCES: usize = 3;

/// A point of the path, the offset of the tool, and their size.
#[derive(Clone, Copy, Debug)]
struct Deviation {
    planned: Vector<2>,
    offset: Vector<2>,
    size: f64,
}

/// What is kept of one motion.
#[derive(Clone, Debug)]
pub(crate) struct SimulationTrace {
    axes: usize,
    curves: Envelope,
    points: Vec<Deviation>,
    /// Instants that stand for one point.
    stride: u64,
    seen: u64,
    worst: Option<Deviation>,
    largest: Option<(Deviation, u32, Option<char>)>,
    reversals: Vec<(f64, char)>,
    reversing: Option<char>,
    time: f64,
}

impl SimulationTrace {
    /// Nothing of a motion of so many axes.
    pub(crate) fn new(axes: usize) -> Self {
        Self {
            axes,
            curves: Envelope::new(FORCES + axes),
            points: Vec::with_capacity(POINTS),
            stride: 1,
            seen: 0,
            worst: None,
            largest: None,
            reversals: Vec::new(),
            reversing: None,
            time: 0.0,
        }
    }

    /// Takes an instant.
    pub(crate) fn take<const N: usize>(&mut self, instant: &Instant<N>) {
        let (before, now) = (self.time, instant.time);
        self.time = now;
        for stretch in self.curves.stretches(before, now) {
            self.curves.add(stretch, SERVO, 1e3 * instant.servo.norm());
            self.curves.add(stretch, PART, 1e3 * instant.part.abs());
            if instant.tolerance > 0.0 {
                self.curves.add(stretch, TOLERANCE, 1e3 * instant.tolerance);
            }
            for axis in 0..N {
                self.curves.add(stretch, FORCES + axis, instant.force[axis]);
            }
        }
        if !instant.moving {
            return;
        }
        if instant.reversing != self.reversing {
            self.reversing = instant.reversing;
            if let Some(axis) = instant.reversing
                && self.reversals.len() < REVERSALS
            {
                self.reversals.push((now, axis));
            }
        }
        let plane = |vector: &Vector<N>| {
            Vector::<2>::new(
                vector.iter().next().copied().unwrap_or(0.0),
                vector.iter().nth(1).copied().unwrap_or(0.0),
            )
        };
        let deviation = Deviation {
            planned: plane(&instant.planned),
            offset: plane(&instant.servo),
            size: instant.servo.norm(),
        };
        if self
            .largest
            .is_none_or(|(largest, ..)| deviation.size > largest.size)
        {
            self.largest = Some((deviation, instant.line, instant.reversing));
        }
        if self.worst.is_none_or(|worst| deviation.size > worst.size) {
            self.worst = Some(deviation);
        }
        self.seen += 1;
        if self.seen.is_multiple_of(self.stride) {
            self.points.extend(self.worst.take());
            if self.points.len() >= POINTS {
                // Of two neighbours the larger error stays.
                self.points = self
                    .points
                    .chunks(2)
                    .filter_map(|pair| {
                        pair.iter()
                            .copied()
                            .max_by(|one, other| one.size.total_cmp(&other.size))
                    })
                    .collect();
                self.stride *= 2;
            }
        }
    }
}

/// One motion in the picture.
#[derive(Clone, Debug)]
struct Shown {
    label: String,
    cycle_time: f64,
    /// Largest part error, mm.
    part: f64,
    trace: SimulationTrace,
}

/// Gathers the motions of a run.
#[derive(Clone, Debug)]
pub(crate) struct SimulationPlot {
    letters: Vec<char>,
    motions: Vec<Shown>,
}

impl SimulationPlot {
    /// No motion yet, of axes with these letters.
    pub(crate) fn new(letters: Vec<char>) -> Self {
        Self {
            letters,
            motions: Vec::new(),
        }
    }

    /// Adds a motion.
    pub(crate) fn add(&mut self, label: &str, cycle_time: f64, part: f64, trace: SimulationTrace) {
        self.motions.push(Shown {
            label: label.to_owned(),
            cycle_time,
            part,
            trace,
        });
    }

    /// The picture as SVG.
    pub(crate) fn draw(&self, caption: &Caption) -> String {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        caption.draw(&mut canvas);
        match &self.motions[..] {
            [] => {}
            [one] => {
                draw_deviation(&mut canvas, &one.trace, [64.0, 128.0, 660.0, 1000.0]);
                self.draw_errors(&mut canvas, &one.trace);
            }
            several => draw_several(&mut canvas, several),
        }
        canvas.finish()
    }

    fn draw_errors(&self, canvas: &mut Canvas, trace: &SimulationTrace) {
        let curves = &trace.curves;
        let duration = trace.time.max(1e-9);
        let (unit, unit_name) = time_unit(duration);
        let chart = |y: f64, low: f64, high: f64| Chart {
            x: 812.0,
            y,
            width: 752.0,
            height: 270.0,
            across: (0.0, duration),
            upward: (low, if high > low { high } else { low + 1.0 }),
        };
        let servo = chart(128.0, 0.0, HEADROOM * curves.peak(SERVO));
        servo.draw_grid(canvas, unit, false);
        for &(time, axis) in &trace.reversals {
            let place = self.letters.iter().position(|letter| *letter == axis);
            let stroke = color::of_axis(place.unwrap_or(0));
            let style = format!("stroke=\"{stroke}\" stroke-width=\"1\"");
            let top = servo.at(time, servo.upward.1);
            canvas.line(top, (top.0, top.1 + 9.0), &style);
        }
        draw_curve(canvas, &servo, curves, SERVO, 1.0, color::MOTION);
        servo.draw_frame(canvas, "Servo error, µm: distance from the planned motion");
        servo.draw_remark(canvas, "ticks: an axis has reversed");
        let tolerance = curves.peak(TOLERANCE);
        let part_peak = curves.peak(PART);
        let most = if tolerance < 4.0 * part_peak {
            part_peak.max(tolerance)
        } else {
            part_peak
        };
        let part = chart(482.0, 0.0, HEADROOM * most);
        part.draw_grid(canvas, unit, false);
        canvas.clip(part.x, part.y, part.width, part.height);
        draw_curve(canvas, &part, curves, TOLERANCE, 1.0, color::BOUND);
        draw_curve(canvas, &part, curves, PART, 1.0, color::MOTION);
        canvas.unclip();
        part.draw_frame(canvas, "Part error, µm: distance from the programmed path");
        part.draw_legend(canvas, &[("tolerance of the move", color::BOUND, false)]);
        let peak = (0..trace.axes)
            .map(|axis| curves.peak(FORCES + axis))
            .fold(0.0, f64::max);
        let force = chart(836.0, -HEADROOM * peak, HEADROOM * peak);
        force.draw_grid(canvas, unit, true);
        canvas.clip(force.x, force.y, force.width, force.height);
        for axis in 0..trace.axes {
            let stroke = color::of_axis(axis);
            draw_curve(canvas, &force, curves, FORCES + axis, 1.0, stroke);
        }
        canvas.unclip();
        force.draw_frame(canvas, "Specific force, mm/s²");
        force.draw_name_across(canvas, &format!("time, {unit_name}"));
        let names: Vec<String> = self.letters.iter().map(char::to_string).collect();
        let entries: Vec<_> = names
            .iter()
            .enumerate()
            .map(|(axis, name)| (name.as_str(), color::of_axis(axis), false))
            .collect();
        force.draw_legend(canvas, &entries);
    }
}

/// A round number at most as large: 1, 2 or 5 times a power of ten.
fn rounded(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.log10().floor());
    [5.0, 2.0, 1.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|&step| step <= value * (1.0 + 1e-9))
        .unwrap_or(power)
}

/// The path in grey, and the tool with its offset magnified.
fn draw_deviation(canvas: &mut Canvas, trace: &SimulationTrace, area: [f64; 4]) {
    let [x, y, width, height] = area;
    let extent = |axis: usize| {
        trace
            .points
            .iter()
            .map(|point| point.planned[axis])
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
    };
    let Some((largest, line, reversing)) = trace.largest else {
        return;
    };
    let (across, upward) = (extent(0), extent(1));
    let size = (across.1 - across.0).max(upward.1 - upward.0).max(1e-6);
    let magnification = if largest.size > 0.0 {
        rounded(LARGEST_SHARE * size / largest.size)
    } else {
        1.0
    };
    let margin = 0.1 * size;
    let chart = Chart {
        x,
        y,
        width,
        height,
        across: (across.0 - margin, across.1 + margin),
        upward: (upward.0 - margin, upward.1 + margin),
    }
    .with_equal_scales();
    chart.draw_grid(canvas, 1.0, true);
    canvas.clip(x, y, width, height);
    let path = trace
        .points
        .iter()
        .map(|point| chart.at(point.planned[0], point.planned[1]));
    canvas.path(
        &through(path),
        "fill=\"none\" stroke=\"#9aa3ad\" stroke-width=\"1.5\"",
    );
    let moved = |point: &Deviation| {
        let at = point.planned + point.offset * magnification;
        chart.at(at[0], at[1])
    };
    canvas.path(
        &through(trace.points.iter().map(moved)),
        "fill=\"none\" stroke=\"#c1121f\" stroke-width=\"1.5\"",
    );
    let ring = moved(&largest);
    canvas.circle(
        ring,
        9.0,
        "fill=\"none\" stroke=\"#20262d\" stroke-width=\"2\"",
    );
    let axis = reversing.map_or_else(String::new, |axis| format!(", {axis} has reversed"));
    let label = format!("{:.1} µm, line {line}{axis}", 1e3 * largest.size);
    let anchor = if ring.0 > x + 0.6 * width {
        Anchor::End
    } else {
        Anchor::Start
    };
    let side = if anchor == Anchor::End { -14.0 } else { 14.0 };
    canvas.text(
        (ring.0 + side, ring.1 + 5.0),
        anchor,
        SMALL,
        "fill=\"#20262d\"",
        &label,
    );
    // A bar that is a round length of error.
    let bar = rounded(0.12 * size / magnification);
    let pixels = chart.pixels(bar * magnification);
    let (left, base) = (x + 20.0, y + height - 24.0);
    let style = "stroke=\"#20262d\" stroke-width=\"3\"";
    canvas.line((left, base), (left + pixels, base), style);
    canvas.text(
        (left + pixels + 10.0, base + 5.0),
        Anchor::Start,
        SMALL,
        "fill=\"#20262d\"",
        &format!("{} µm of error", round_text(1e3 * bar)),
    );
    canvas.unclip();
    chart.draw_frame(canvas, "Path, mm, and the tool beside it");
    chart.draw_remark(
        canvas,
        &format!(
            "red: servo error {} times as large",
            round_text(magnification)
        ),
    );
}

/// A number of few digits.
fn round_text(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{rounded}")
}

/// Errors of several motions over time, and cycle time against part error.
fn draw_several(canvas: &mut Canvas, motions: &[Shown]) {
    let duration = motions
        .iter()
        .map(|motion| motion.trace.time)
        .fold(1e-9, f64::max);
    let (unit, unit_name) = time_unit(duration);
    let names: Vec<&str> = motions.iter().map(|motion| motion.label.as_str()).collect();
    for (curve, y, title) in [
        (
            SERVO,
            128.0,
            "Servo error, µm: distance from the planned motion",
        ),
        (
            PART,
            470.0,
            "Part error, µm: distance from the programmed path",
        ),
    ] {
        let most = motions
            .iter()
            .map(|motion| motion.trace.curves.peak(curve))
            .fold(0.0, f64::max);
        let chart = Chart {
            x: 64.0,
            y,
            width: 1500.0,
            height: 270.0,
            across: (0.0, duration),
            upward: (0.0, if most > 0.0 { HEADROOM * most } else { 1.0 }),
        };
        chart.draw_grid(canvas, unit, curve == PART);
        canvas.clip(chart.x, chart.y, chart.width, chart.height);
        for (index, motion) in motions.iter().enumerate().rev() {
            let stroke = color::of_method(index);
            draw_curve(canvas, &chart, &motion.trace.curves, curve, 1.0, stroke);
        }
        canvas.unclip();
        chart.draw_frame(canvas, title);
        if curve == PART {
            chart.draw_name_across(canvas, &format!("time, {unit_name}"));
        }
    }
    let most = |value: &dyn Fn(&Shown) -> f64| motions.iter().map(value).fold(0.0, f64::max);
    let slowest = most(&|motion| motion.cycle_time);
    let fastest = motions
        .iter()
        .map(|motion| motion.cycle_time)
        .fold(f64::INFINITY, f64::min);
    let spread = (slowest - fastest).max(0.02 * slowest).max(1e-6);
    let worst = most(&|motion| 1e3 * motion.part);
    let chart = Chart {
        x: 64.0,
        y: 830.0,
        width: 760.0,
        height: 310.0,
        across: (fastest - 0.1 * spread, slowest + 0.1 * spread),
        upward: (0.0, if worst > 0.0 { 1.15 * worst } else { 1.0 }),
    };
    chart.draw_grid(canvas, 1.0, true);
    let best = |motion: &Shown| {
        !motions.iter().any(|other| {
            other.cycle_time <= motion.cycle_time
                && other.part <= motion.part
                && (other.cycle_time < motion.cycle_time || other.part < motion.part)
        })
    };
    let mut front: Vec<&Shown> = motions.iter().filter(|motion| best(motion)).collect();
    front.sort_by(|one, other| one.cycle_time.total_cmp(&other.cycle_time));
    let points = front
        .iter()
        .map(|motion| chart.at(motion.cycle_time, 1e3 * motion.part));
    canvas.path(
        &through(points),
        "fill=\"none\" stroke=\"#9aa3ad\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\"",
    );
    for (index, motion) in motions.iter().enumerate() {
        let at = chart.at(motion.cycle_time, 1e3 * motion.part);
        let fill = format!("fill=\"{}\"", color::of_method(index));
        canvas.circle(at, 6.0, &fill);
    }
    chart.draw_frame(canvas, "Largest part error, µm, against cycle time");
    chart.draw_name_across(canvas, "cycle time, s; dashed: no motion is better in both");
    for (index, name) in names.iter().enumerate() {
        #[allow(clippy::cast_precision_loss, reason = "there are a few motions")]
        let y = 850.0 + 24.0 * index as f64;
        let style = format!("stroke=\"{}\" stroke-width=\"3\"", color::of_method(index));
        canvas.line((880.0, y - 4.0), (910.0, y - 4.0), &style);
        canvas.text((920.0, y), Anchor::Start, SMALL, "fill=\"#20262d\"", name);
    }
}

/// The response of one drive.
#[derive(Clone, Debug)]
pub(crate) struct ResponseCurve {
    /// Letter of the axis.
    pub(crate) axis: char,
    /// Frequency at which it falls to -3 dB, Hz.
    pub(crate) bandwidth: f64,
    /// Frequencies of its modes, Hz.
    pub(crate) modes: Vec<f64>,
    /// The response, by increasing frequency.
    pub(crate) points: Vec<ResponsePoint>,
}

/// Draws the responses of drives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Responses;

impl Responses {
    /// The picture of all axes as SVG.
    pub(crate) fn draw(axes: &[ResponseCurve], caption: &Caption) -> String {
        #[allow(clippy::cast_precision_loss, reason = "there are a few axes")]
        let count = axes.len() as f64;
        let mut canvas = Canvas::new(1200.0, 140.0 + 400.0 * count);
        caption.draw(&mut canvas);
        let mut top = 128.0;
        for axis in axes {
            axis.draw(&mut canvas, top);
            top += 400.0;
        }
        canvas.finish()
    }
}

impl ResponseCurve {
    fn draw(&self, canvas: &mut Canvas, top: f64) {
        let last = self.points.last().map_or(1.0, |point| point.frequency);
        let most = self
            .points
            .iter()
            .map(|point| point.fed.max(point.tool).min(5.0))
            .fold(1.0, f64::max);
        let chart = Chart {
            x: 72.0,
            y: top,
            width: 1092.0,
            height: 300.0,
            across: (0.0, last),
            upward: (0.0, HEADROOM * most),
        };
        chart.draw_grid(canvas, 1.0, true);
        canvas.clip(chart.x, chart.y, chart.width, chart.height);
        let dashed = "stroke=\"#9aa3ad\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\"";
        for &mode in &self.modes {
            let (low, high) = (chart.at(mode, 0.0), chart.at(mode, chart.upward.1));
            canvas.line(low, high, dashed);
        }
        let root = std::f64::consts::FRAC_1_SQRT_2;
        canvas.line(chart.at(0.0, root), chart.at(last, root), dashed);
        let mark = chart.at(self.bandwidth, root);
        canvas.circle(mark, 5.0, "fill=\"#c1121f\"");
        type Value = fn(&ResponsePoint) -> f64;
        let curves: [(Value, &str); 3] = [
            (|point| point.tool, color::AXES[2]),
            (|point| point.fed, color::AXES[1]),
            (|point| point.plain, color::AXES[0]),
        ];
        for (value, stroke) in curves {
            let points = self
                .points
                .iter()
                .map(|point| chart.at(point.frequency, value(point)));
            let style = format!("fill=\"none\" stroke=\"{stroke}\" stroke-width=\"2\"");
            canvas.path(&through(points), &style);
        }
        canvas.unclip();
        let softest = self
            .points
            .iter()
            .map(|point| point.compliance)
            .fold(0.0, f64::max);
        let title = format!(
            "{}: magnitude; -3 dB at {:.1} Hz; compliance at most {:.3} µm for 1000 mm/s²",
            self.axis,
            self.bandwidth,
            1e6 * softest
        );
        chart.draw_frame(canvas, &title);
        chart.draw_name_across(canvas, "frequency, Hz; dashed: modes and -3 dB");
        chart.draw_legend(
            canvas,
            &[
                ("without feedforward", color::AXES[0], false),
                ("with it", color::AXES[1], false),
                ("tool", color::AXES[2], false),
            ],
        );
    }
}

//! Draws executed motion over time: feedrate commanded and executed, rate, acceleration and jerk with their limits.

use super::canvas::{Anchor, Canvas};
use super::chart::{Chart, SMALL, time_unit};
use super::curve::draw_curve;
use super::envelope::Envelope;
use super::motion::HEADROOM;
use super::{Caption, color};
use toolglide_kinematics::Limits;
use toolglide_realtime::Tick;

/// Size of the sheet, pixels.
const SIZE: (f64, f64) = (1600.0, 1200.0);

/// Upper edges of the charts, pixels.
const TOPS: [f64; 4] = [140.0, 404.0, 668.0, 932.0];

/// Height of a chart.
const HEIGHT: f64 = 204.0;

/// Marks at most; more would hide the curves.
const MAX_MARKS: usize = 200;

/// Marks with their names at most.
const MAX_NAMES: usize = 24;

/// Gathers what the picture shows, in fixed memory.
#[derive(Clone, Debug)]
pub(crate) struct ExecutedPlot<const N: usize> {
    limits: Limits<N>,
    letters: Vec<char>,
    curves: Envelope,
    time: f64,
    marks: Vec<(f64, String)>,
}

/// Order of the curves: acceleration and jerk of each axis, then these.
const fn executed_curve(axes: usize) -> usize {
    2 * axes
}

const fn commanded_curve(axes: usize) -> usize {
    2 * axes + 1
}

const fn rate_curve(axes: usize) -> usize {
    2 * axes + 2
}

impl<const N: usize> ExecutedPlot<N> {
    /// Nothing yet.
    pub(crate) fn new(limits: Limits<N>, letters: Vec<char>) -> Self {
        Self {
            limits,
            letters,
            curves: Envelope::new(2 * N + 3),
            time: 0.0,
            marks: Vec::new(),
        }
    }

    /// Marks a command.
    pub(crate) fn mark(&mut self, time: f64, name: &str) {
        if self.marks.len() < MAX_MARKS {
            self.marks.push((time, name.to_owned()));
        }
    }

    /// Takes one tick, with the feedrate that is commanded; `None` for rapids.
    pub(crate) fn observe(
        &mut self,
        time: f64,
        period: f64,
        tick: &Tick<N>,
        commanded: Option<f64>,
    ) {
        self.time = time + period;
        for stretch in self.curves.stretches(time, self.time) {
            for axis in 0..N {
                self.curves
                    .add(stretch, axis, tick.sample.acceleration[axis]);
                self.curves.add(stretch, N + axis, tick.sample.jerk[axis]);
            }
            let speed = tick.sample.velocity.norm();
            self.curves.add(stretch, executed_curve(N), speed);
            if let Some(commanded) = commanded {
                self.curves.add(stretch, commanded_curve(N), commanded);
            }
            self.curves.add(stretch, rate_curve(N), tick.rate);
        }
    }

    /// The picture as SVG.
    pub(crate) fn draw(&self, caption: &Caption) -> String {
        let mut canvas = Canvas::new(SIZE.0, SIZE.1);
        caption.draw(&mut canvas);
        let (executed, commanded) = (executed_curve(N), commanded_curve(N));
        let fastest = self.curves.peak(executed).max(self.curves.peak(commanded));
        let chart = self.chart(
            0,
            (
                0.0,
                if fastest > 0.0 {
                    HEADROOM * fastest
                } else {
                    1.0
                },
            ),
        );
        chart.draw_grid(&mut canvas, time_unit(self.time).0, false);
        self.curve(&mut canvas, &chart, commanded, 1.0, color::PROGRAMMED);
        self.curve(&mut canvas, &chart, executed, 1.0, color::MOTION);
        self.draw_marks(&mut canvas, &chart, true);
        chart.draw_frame(&mut canvas, "Feedrate along the path, mm/s");
        chart.draw_legend(
            &mut canvas,
            &[
                ("executed", color::MOTION, false),
                ("commanded", color::PROGRAMMED, false),
            ],
        );
        let least = self.curves.least(rate_curve(N)).min(0.0);
        let chart = self.chart(1, (1.12 * least, 1.12));
        chart.draw_grid(&mut canvas, time_unit(self.time).0, false);
        self.curve(&mut canvas, &chart, rate_curve(N), 1.0, color::MOTION);
        self.draw_marks(&mut canvas, &chart, false);
        chart.draw_frame(&mut canvas, "Rate of planned time");
        let limits = [self.limits.acceleration(), self.limits.jerk()];
        for (index, (name, limits)) in ["Acceleration, m/s²", "Jerk, m/s³"]
            .iter()
            .zip(limits)
            .enumerate()
        {
            let most = 1e-3 * limits.amax();
            let chart = self.chart(2 + index, (-HEADROOM * most, HEADROOM * most));
            chart.draw_grid(&mut canvas, time_unit(self.time).0, index == 1);
            for axis in (0..N).rev() {
                self.curve(
                    &mut canvas,
                    &chart,
                    index * N + axis,
                    1e-3,
                    color::of_axis(axis),
                );
            }
            for &limit in limits {
                for bound in [1e-3 * limit, -1e-3 * limit] {
                    let (_, y) = chart.at(0.0, bound);
                    let style = format!(
                        "stroke=\"{}\" stroke-width=\"1.3\" stroke-dasharray=\"8 5\"",
                        color::BOUND
                    );
                    canvas.line((chart.x, y), (chart.x + chart.width, y), &style);
                }
            }
            self.draw_marks(&mut canvas, &chart, false);
            chart.draw_frame(&mut canvas, name);
            let names: Vec<String> = self.letters.iter().map(char::to_string).collect();
            let mut entries: Vec<_> = names
                .iter()
                .enumerate()
                .map(|(axis, name)| (name.as_str(), color::of_axis(axis), false))
                .collect();
            entries.push(("limit", color::BOUND, true));
            chart.draw_legend(&mut canvas, &entries);
            if index == 1 {
                chart.draw_name_across(&mut canvas, &format!("time, {}", time_unit(self.time).1));
            }
        }
        canvas.finish()
    }

    fn chart(&self, row: usize, upward: (f64, f64)) -> Chart {
        Chart {
            x: 96.0,
            y: TOPS[row],
            width: SIZE.0 - 160.0,
            height: HEIGHT,
            across: (0.0, if self.time > 0.0 { self.time } else { 1.0 }),
            upward,
        }
    }

    fn curve(&self, canvas: &mut Canvas, chart: &Chart, curve: usize, scale: f64, color: &str) {
        canvas.clip(chart.x, chart.y, chart.width, chart.height);
        draw_curve(canvas, chart, &self.curves, curve, scale, color);
        canvas.unclip();
    }

    /// The commands as thin lines, named at the top.
    fn draw_marks(&self, canvas: &mut Canvas, chart: &Chart, named: bool) {
        for (index, (time, name)) in self.marks.iter().enumerate() {
            let (x, _) = chart.at(*time, 0.0);
            let style = "stroke=\"#20262d\" stroke-width=\"0.8\" stroke-dasharray=\"2 3\"";
            canvas.line((x, chart.y), (x, chart.y + chart.height), style);
            if named && index < MAX_NAMES {
                #[allow(clippy::cast_precision_loss, reason = "three rows of names")]
                let y = chart.y + 15.0 + 15.0 * (index % 3) as f64;
                canvas.text((x + 4.0, y), Anchor::Start, SMALL, "fill=\"#20262d\"", name);
            }
        }
    }
}

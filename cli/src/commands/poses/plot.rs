//! Draws pose motion: path of the tool tip, orientation on the sphere, sharpest corner, use of axis
//! limits.
//!
//! Gathered in fixed memory while the motion streams past. Derivatives are differences of set-points,
//! good enough to look at; the judge is exact. Not here: planning.

use crate::commands::poses::corner::{Part, PoseCornerFinder};
use crate::commands::poses::zoom;
use crate::plot::Caption;
use crate::plot::canvas::{Anchor, Canvas, Outline, through};
use crate::plot::chart::{Chart, NORMAL, SMALL, time_unit};
use crate::plot::color;
use crate::plot::curve::draw_curve;
use crate::plot::envelope::Envelope;
use toolglide_fiveaxis::PoseTick;
use toolglide_kinematics::{
    Axis, MachineKinematics, PoseLeg, PosePath, PosePiece, SamplePeriod, Vector,
};

/// Size of the sheet, pixels.
const WIDTH: f64 = 1600.0;
/// As above.
const HEIGHT: f64 = 1200.0;

/// Upper edges of the charts over time, pixels.
const TOPS: [f64; 4] = [128.0, 396.0, 664.0, 932.0];

/// Most poses that are kept for the paths; then every second one goes.
const MAX_POSES: usize = 1 << 12;

/// Points of an arc on the sphere.
const ARC_POINTS: u32 = 16;

/// Most arcs that are kept.
const MAX_LEGS: usize = 1 << 14;

/// Gathers what the picture shows.
pub(crate) struct PosePlot<'m> {
    machine: &'m dyn MachineKinematics,
    axes: Vec<Axis>,
    period: f64,
    curves: Envelope,
    /// Positions, velocities and accelerations of the last set-point.
    last: Option<(PoseTick, Vec<[f64; 2]>)>,
    ticks: u64,
    motion: Vec<(Vector<3>, Vector<3>)>,
    stride: u64,
    legs: Vec<PoseLeg>,
    /// Orientations of the tool along each leg.
    swings: Vec<Vec<Vector<3>>>,
    corners: [PoseCornerFinder; 2],
    time: f64,
}

impl<'m> PosePlot<'m> {
    pub(crate) fn new(
        machine: &'m dyn MachineKinematics,
        axes: &[Axis],
        period: SamplePeriod,
    ) -> Self {
        Self {
            machine,
            period: period.seconds(),
            curves: Envelope::new(3 * axes.len() + 1),
            last: None,
            ticks: 0,
            motion: Vec::new(),
            stride: 1,
            legs: Vec::new(),
            swings: Vec::new(),
            corners: [Part::Tip, Part::Orientation].map(PoseCornerFinder::new),
            time: 0.0,
            axes: axes.to_vec(),
        }
    }

    /// Takes the next leg of the path.
    pub(crate) fn expect(&mut self, leg: &PoseLeg) {
        for corner in &mut self.corners {
            corner.expect(leg);
        }
        if leg.tip().is_some() && self.legs.len() < MAX_LEGS {
            self.swings.push(self.swing(leg));
            self.legs.push(leg.clone());
        }
    }

    /// Orientations of the tool along a leg.
    fn swing(&self, leg: &PoseLeg) -> Vec<Vector<3>> {
        let shares = (0..=ARC_POINTS).map(|step| f64::from(step) / f64::from(ARC_POINTS));
        match &leg.path {
            PosePath::Tool { turn, .. } => shares.map(|share| turn.at(share)).collect(),
            PosePath::Rotary { axes, .. } => shares
                .filter_map(|share| {
                    let mut at = axes[0];
                    for (at, end) in at.iter_mut().zip(axes[1].iter()) {
                        *at += (end - *at) * share;
                    }
                    self.machine
                        .forward(&at)
                        .ok()
                        .map(|pose| pose.orientation())
                })
                .collect(),
            _ => Vec::new(),
        }
    }

    /// Takes the next piece of the motion.
    pub(crate) fn observe(&mut self, piece: &PosePiece) {
        for corner in &mut self.corners {
            corner.observe(piece);
        }
    }

    /// Takes the next set-point.
    pub(crate) fn tick(&mut self, tick: &PoseTick) {
        if self.ticks.is_multiple_of(self.stride) {
            self.motion.push((tick.pose.tip(), tick.pose.orientation()));
            if self.motion.len() > MAX_POSES {
                let mut index = 0;
                self.motion.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.stride *= 2;
            }
        }
        self.ticks += 1;
        let count = self.axes.len();
        let mut rates = vec![[0.0; 2]; count];
        if let Some((before, known)) = &self.last {
            let step = tick.time - before.time;
            // The last row may come a moment after the one before it.
            if step > 0.5 * self.period {
                self.time = tick.time;
                let speed = (tick.pose.tip() - before.pose.tip()).norm() / step;
                for stretch in self.curves.stretches(before.time, tick.time) {
                    self.curves.add(stretch, 3 * count, speed);
                    for (index, axis) in self.axes.iter().enumerate() {
                        let velocity = (tick.axes[index] - before.axes[index]) / step;
                        let acceleration = (velocity - known[index][0]) / step;
                        let jerk = (acceleration - known[index][1]) / step;
                        rates[index] = [velocity, acceleration];
                        let limits = &axis.limits;
                        for (order, share) in [
                            velocity / limits.velocity(),
                            acceleration / limits.acceleration(),
                            jerk / limits.jerk(),
                        ]
                        .into_iter()
                        .enumerate()
                        {
                            self.curves
                                .add(stretch, order * count + index, 100.0 * share);
                        }
                    }
                }
            }
        }
        self.last = Some((*tick, rates));
    }

    /// The picture as SVG.
    pub(crate) fn draw(&self, caption: &Caption) -> String {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        caption.draw(&mut canvas);
        self.draw_tip(&mut canvas);
        self.draw_sphere(&mut canvas);
        for (corner, left) in self.corners.iter().zip([64.0, 424.0]) {
            zoom::draw(corner, &mut canvas, [left, 876.0, 300.0, 268.0]);
        }
        let time = if self.time > 0.0 { self.time } else { 1.0 };
        let count = self.axes.len();
        let (unit, name) = time_unit(time);
        for (place, (title, top)) in [
            "Speed of the tool tip, mm/s",
            "Velocity of the axes, % of the limit",
            "Acceleration of the axes, % of the limit",
            "Jerk of the axes, % of the limit",
        ]
        .into_iter()
        .zip(TOPS)
        .enumerate()
        {
            let upward = if place == 0 {
                (0.0, 1.12 * self.curves.peak(3 * count).max(1.0))
            } else {
                (-112.0, 112.0)
            };
            let chart = Chart {
                x: 812.0,
                y: top,
                width: 752.0,
                height: 212.0,
                across: (0.0, time),
                upward,
            };
            chart.draw_grid(&mut canvas, unit, place == 3);
            canvas.clip(chart.x, chart.y, chart.width, chart.height);
            if place == 0 {
                draw_curve(
                    &mut canvas,
                    &chart,
                    &self.curves,
                    3 * count,
                    1.0,
                    color::MOTION,
                );
            } else {
                let dashed = format!(
                    "stroke=\"{}\" stroke-width=\"1.4\" stroke-dasharray=\"6 4\"",
                    color::BOUND
                );
                for bound in [-100.0, 100.0] {
                    let (from, to) = (chart.at(0.0, bound), chart.at(time, bound));
                    canvas.line(from, to, &dashed);
                }
                for axis in 0..count {
                    let curve = (place - 1) * count + axis;
                    let hue = color::of_method(axis + 1);
                    draw_curve(&mut canvas, &chart, &self.curves, curve, 1.0, hue);
                }
            }
            canvas.unclip();
            chart.draw_frame(&mut canvas, title);
            if place == 1 {
                let names: Vec<String> =
                    self.axes.iter().map(|axis| axis.name.to_string()).collect();
                let legend: Vec<_> = names
                    .iter()
                    .enumerate()
                    .map(|(axis, name)| (name.as_str(), color::of_method(axis + 1), false))
                    .collect();
                chart.draw_legend(&mut canvas, &legend);
            }
            if place == 3 {
                chart.draw_name_across(&mut canvas, &format!("time, {name}"));
            }
        }
        canvas.finish()
    }

    /// The path of the tool tip, seen from above and in front.
    fn draw_tip(&self, canvas: &mut Canvas) {
        let flat = |point: &Vector<3>| {
            let (cosine, sine) = (0.75_f64.sqrt(), 0.5);
            (
                (point.x - point.y) * cosine,
                point.z + (point.x + point.y) * sine,
            )
        };
        let programmed: Vec<_> = self.legs.iter().filter_map(PoseLeg::tip).collect();
        let mut across = (f64::INFINITY, f64::NEG_INFINITY);
        let mut upward = across;
        let points = self
            .motion
            .iter()
            .map(|(tip, _)| tip)
            .chain(programmed.iter().flatten());
        for (x, y) in points.map(flat) {
            across = (across.0.min(x), across.1.max(x));
            upward = (upward.0.min(y), upward.1.max(y));
        }
        let padded = |(low, high): (f64, f64)| {
            let room = (0.06 * (high - low)).max(0.5);
            if low <= high {
                (low - room, high + room)
            } else {
                (-1.0, 1.0)
            }
        };
        let chart = Chart {
            x: 64.0,
            y: 128.0,
            width: 660.0,
            height: 336.0,
            across: padded(across),
            upward: padded(upward),
        }
        .with_equal_scales();
        let place = |point: &Vector<3>| {
            let (x, y) = flat(point);
            chart.at(x, y)
        };
        let mut outline = Outline::default();
        for tip in &programmed {
            outline.stretch(tip.iter().map(place));
        }
        let grey = color::PROGRAMMED;
        canvas.path(
            &outline,
            &format!("fill=\"none\" stroke=\"{grey}\" stroke-width=\"1\""),
        );
        let motion = through(self.motion.iter().map(|(tip, _)| place(tip)));
        canvas.path(
            &motion,
            &format!(
                "fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"",
                color::MOTION
            ),
        );
        // The tool at the programmed poses.
        if self.legs.len() <= 200 {
            let length =
                0.05 * ((chart.across.1 - chart.across.0).min(chart.upward.1 - chart.upward.0));
            let style = format!("stroke=\"{}\" stroke-width=\"1.6\"", color::AXES[0]);
            for (leg, swing) in self.legs.iter().zip(&self.swings) {
                if let (Some(tip), Some(tool)) = (leg.tip(), swing.last()) {
                    canvas.line(place(&tip[1]), place(&(tip[1] + tool * length)), &style);
                }
            }
        }
        chart.draw_frame(canvas, "Path of the tool tip, with the tool at the poses");
        let span = chart.across.1 - chart.across.0;
        chart.draw_remark(canvas, &format!("{span:.1} mm across"));
    }

    /// The orientation on the unit sphere, seen along the tool axis of an upright tool.
    fn draw_sphere(&self, canvas: &mut Canvas) {
        let chart = Chart {
            x: 64.0,
            y: 508.0,
            width: 660.0,
            height: 316.0,
            across: (-1.05, 1.05),
            upward: (-1.05, 1.05),
        };
        // Zoomed to what the tool does, but always round the pole.
        let reach = self
            .motion
            .iter()
            .map(|(_, tool)| tool.x.abs().max(tool.y.abs()))
            .fold(0.05, f64::max)
            * 1.15;
        let reach = reach.min(1.05);
        let chart = Chart {
            across: (-reach, reach),
            upward: (-reach, reach),
            ..chart
        }
        .with_equal_scales();
        canvas.clip(chart.x, chart.y, chart.width, chart.height);
        let center = chart.at(0.0, 0.0);
        let faint = "fill=\"none\" stroke=\"#e4e7eb\" stroke-width=\"1\"";
        for tilt in [15.0_f64, 30.0, 45.0, 60.0, 75.0, 90.0] {
            let radius = chart.pixels(tilt.to_radians().sin());
            canvas.circle(center, radius, faint);
            let at = (center.0 + 4.0, center.1 - radius - 3.0);
            canvas.text(
                at,
                Anchor::Start,
                SMALL,
                "fill=\"#9aa3ad\"",
                &format!("{tilt:.0}°"),
            );
        }
        let mut arcs = Outline::default();
        for swing in &self.swings {
            arcs.stretch(swing.iter().map(|at| chart.at(at.x, at.y)));
        }
        let grey = color::PROGRAMMED;
        canvas.path(
            &arcs,
            &format!("fill=\"none\" stroke=\"{grey}\" stroke-width=\"1\""),
        );
        let motion = through(self.motion.iter().map(|(_, tool)| chart.at(tool.x, tool.y)));
        canvas.path(
            &motion,
            &format!(
                "fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"",
                color::MOTION
            ),
        );
        canvas.unclip();
        chart.draw_frame(canvas, "Tool orientation on the unit sphere, from above");
        let at = (chart.x + chart.width, chart.y - 8.0);
        canvas.text(
            at,
            Anchor::End,
            NORMAL - 2.0,
            "fill=\"#4a525b\"",
            "grey: programmed, violet: motion",
        );
    }
}

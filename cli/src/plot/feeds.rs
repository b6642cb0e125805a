//! Draws the feedrates of several methods over one another, gathered in fixed memory.
//!
//! Not here: what the methods did otherwise.

use super::canvas::{Anchor, Canvas};
use super::chart::{Chart, NORMAL, SMALL, time_unit};
use super::curve::draw_curve;
use super::envelope::Envelope;
use super::motion::{FAR_RAPID, HEADROOM};
use super::{Caption, color};
use toolglide_kinematics::{Move, Piece};

/// Width of the sheet, pixels.
const WIDTH: f64 = 1600.0;

/// Left edge of the charts, pixels.
const LEFT: f64 = 64.0;

/// Upper edge and height of the chart of all motions, pixels.
const ALL_TOP: f64 = 128.0;
/// As above.
const ALL_HEIGHT: f64 = 360.0;

/// Height of the chart of one motion, the gap above it, and what is left below the last, pixels.
const EACH_HEIGHT: f64 = 86.0;
/// As above.
const GAP: f64 = 34.0;
/// As above.
const BELOW: f64 = 56.0;

/// Where the legend begins, and the distance between two entries, pixels.
const LEGEND: f64 = 1300.0;
/// As above.
const ENTRY: f64 = 46.0;

/// Gathers the speeds of several motions.
#[derive(Clone, Debug)]
pub(crate) struct Feeds {
    names: Vec<String>,
    curves: Envelope,
    times: Vec<f64>,
    /// Largest feedrate of the program, rapids left out.
    programmed: f64,
}

impl Feeds {
    /// Begins with all motions at rest.
    pub(crate) fn new(names: Vec<String>) -> Self {
        Self {
            curves: Envelope::new(names.len()),
            times: vec![0.0; names.len()],
            names,
            programmed: 0.0,
        }
    }

    /// Takes the next move of the path.
    pub(crate) fn expect<const N: usize>(&mut self, next: &Move<N>) {
        let feedrate = next.feedrate().speed();
        if feedrate.is_finite() {
            self.programmed = self.programmed.max(feedrate);
        }
    }

    /// Takes the next piece of one of the motions.
    pub(crate) fn observe<const N: usize>(&mut self, motion: usize, piece: &Piece<N>) {
        let Some(time) = self.times.get_mut(motion) else {
            return;
        };
        let start = *time;
        *time += piece.duration();
        let mut before = piece.at(0.0).velocity.norm();
        for stretch in self.curves.stretches(start, *time) {
            let until = self.curves.begin(stretch) + self.curves.width() - start;
            let after = piece.at(until.min(piece.duration())).velocity.norm();
            self.curves.add(stretch, motion, before);
            self.curves.add(stretch, motion, after);
            before = after;
        }
    }

    /// The picture as SVG: all motions in one chart, and below it each in its own.
    pub(crate) fn draw(&self, caption: &Caption) -> String {
        let count = self.names.len();
        let mut bottom = ALL_TOP + ALL_HEIGHT;
        let tops: Vec<f64> = self
            .names
            .iter()
            .map(|_| {
                let top = bottom + GAP;
                bottom = top + EACH_HEIGHT;
                top
            })
            .collect();
        let mut canvas = Canvas::new(WIDTH, bottom + BELOW);
        caption.draw(&mut canvas);
        let (duration, fastest, most) = self.extent();
        let too_fast = most < fastest;
        let (unit, unit_name) = time_unit(duration);
        let or_one = |value: f64| if value > 0.0 { value } else { 1.0 };
        let chart = |y, height| Chart {
            x: LEFT,
            y,
            width: LEGEND - LEFT - 40.0,
            height,
            across: (0.0, or_one(duration)),
            upward: (0.0, or_one(HEADROOM * most)),
        };
        let all = chart(ALL_TOP, ALL_HEIGHT);
        all.draw_grid(&mut canvas, unit, false);
        // The first method lies on top.
        let order: Vec<usize> = (0..count).rev().collect();
        self.draw_motions(&mut canvas, &all, &order);
        all.draw_frame(&mut canvas, "Feedrate along the path, mm/s");
        if too_fast {
            all.draw_remark(&mut canvas, &format!("rapids up to {fastest:.0} mm/s"));
        }
        self.draw_legend(&mut canvas, ALL_TOP + 12.0);
        let mut lowest = all;
        for (motion, (&top, name)) in tops.iter().zip(&self.names).enumerate() {
            lowest = chart(top, EACH_HEIGHT);
            lowest.draw_grid(&mut canvas, unit, motion + 1 == count);
            self.draw_motions(&mut canvas, &lowest, &[motion]);
            lowest.draw_frame(&mut canvas, name);
        }
        lowest.draw_name_across(&mut canvas, &format!("time, {unit_name}"));
        canvas.finish()
    }

    /// The longest duration, the largest speed, and the largest that is worth its room.
    fn extent(&self) -> (f64, f64, f64) {
        let duration = self.times.iter().copied().fold(0.0, f64::max);
        let fastest = (0..self.names.len())
            .map(|motion| self.curves.peak(motion))
            .fold(0.0, f64::max);
        let too_fast = self.programmed > 0.0 && fastest > FAR_RAPID * self.programmed;
        (
            duration,
            fastest,
            if too_fast { self.programmed } else { fastest },
        )
    }

    /// All motions in one chart, in a part of another drawing, with what each is called and takes.
    pub(super) fn draw_all(&self, canvas: &mut Canvas, x: f64, y: f64, width: f64, height: f64) {
        let (duration, _, most) = self.extent();
        let or_one = |value: f64| if value > 0.0 { value } else { 1.0 };
        let chart = Chart {
            x,
            y,
            width,
            height,
            across: (0.0, or_one(duration)),
            upward: (0.0, or_one(HEADROOM * most)),
        };
        let (unit, unit_name) = time_unit(duration);
        chart.draw_grid(canvas, unit, true);
        let order: Vec<usize> = (0..self.names.len()).rev().collect();
        self.draw_motions(canvas, &chart, &order);
        chart.draw_frame(canvas, "Feedrate along the path, mm/s");
        chart.draw_name_across(canvas, &format!("time, {unit_name}"));
        let told: Vec<String> = self
            .names
            .iter()
            .zip(&self.times)
            .map(|(name, time)| format!("{name} {time:.4} s"))
            .collect();
        let entries: Vec<_> = told
            .iter()
            .enumerate()
            .map(|(motion, name)| (name.as_str(), color::of_method(motion), false))
            .collect();
        chart.draw_legend(canvas, &entries);
    }

    fn draw_motions(&self, canvas: &mut Canvas, chart: &Chart, motions: &[usize]) {
        canvas.clip(chart.x, chart.y, chart.width, chart.height);
        for &motion in motions {
            let color = color::of_method(motion);
            draw_curve(canvas, chart, &self.curves, motion, 1.0, color);
        }
        canvas.unclip();
    }

    fn draw_legend(&self, canvas: &mut Canvas, top: f64) {
        let mut y = top;
        for (motion, (name, time)) in self.names.iter().zip(&self.times).enumerate() {
            let style = format!("stroke=\"{}\" stroke-width=\"3\"", color::of_method(motion));
            canvas.line((LEGEND, y - 5.0), (LEGEND + 28.0, y - 5.0), &style);
            let at = (LEGEND + 38.0, y);
            canvas.text(at, Anchor::Start, NORMAL, "fill=\"#20262d\"", name);
            let at = (LEGEND + 38.0, y + 18.0);
            let told = format!("cycle time {time:.3} s");
            canvas.text(at, Anchor::Start, SMALL, "fill=\"#4a525b\"", &told);
            y += ENTRY;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{MoveRange, Sample, Vector};

    #[test]
    fn motions_of_different_lengths_share_one_scale_of_time() {
        let mut feeds = Feeds::new(vec!["one".to_owned(), "two".to_owned()]);
        let serves = MoveRange { first: 0, last: 0 };
        for (motion, duration) in [(0, 1.0), (1, 3.0), (0, 1.0)] {
            let start = Sample {
                position: Vector::<2>::zeros(),
                velocity: Vector::<2>::x() * 5.0,
                acceleration: Vector::zeros(),
                jerk: Vector::zeros(),
            };
            let end = start.velocity * duration;
            feeds.observe(motion, &Piece::new(&start, duration, end, serves));
        }
        assert_eq!(feeds.times, [2.0, 3.0]);
        let caption = Caption {
            title: "t".to_owned(),
            subtitle: "s".to_owned(),
        };
        let svg = feeds.draw(&caption);
        assert!(svg.contains("cycle time 2.000 s"), "one");
        assert!(svg.contains("cycle time 3.000 s"), "two");
        let empty = Feeds::new(Vec::new()).draw(&caption);
        assert!(!empty.contains("NaN"), "nothing at all is drawn soundly");
    }
}

//! Draws the spectra of several motions over one another, one chart per axis.
//!
//! Not here: how they are computed.

use super::canvas::{Canvas, through};
use super::chart::Chart;
use super::motion::HEADROOM;
use super::{Caption, color};

/// Width of the sheet, pixels.
const WIDTH: f64 = 1200.0;

/// Left edge of the charts, and what is left at the right, pixels.
const LEFT: f64 = 72.0;
/// As above.
const RIGHT: f64 = 36.0;

/// Upper edge of the first chart, height of each, and the gap below it, pixels.
const TOP: f64 = 128.0;
/// As above.
const HEIGHT: f64 = 300.0;
/// As above.
const GAP: f64 = 84.0;

/// The spectrum of one axis in one motion.
#[derive(Clone, Debug)]
pub(crate) struct Spectrum {
    /// Magnitudes, one for each frequency.
    pub(crate) magnitudes: Vec<f64>,
}

/// What is drawn of one axis.
#[derive(Clone, Debug)]
pub(crate) struct Spectra {
    /// Letter of the axis.
    pub(crate) axis: char,
    /// Frequencies of its modes, Hz.
    pub(crate) modes: Vec<f64>,
    /// One for each motion.
    pub(crate) of: Vec<Spectrum>,
}

impl Spectra {
    /// The picture of all axes as SVG.
    pub(crate) fn draw(
        axes: &[Self],
        frequencies: &[f64],
        names: &[String],
        caption: &Caption,
    ) -> String {
        #[allow(clippy::cast_precision_loss, reason = "there are a few axes")]
        let count = axes.len() as f64;
        let mut canvas = Canvas::new(WIDTH, TOP + count * (HEIGHT + GAP));
        caption.draw(&mut canvas);
        let mut top = TOP;
        for axis in axes {
            axis.draw_chart(&mut canvas, top, frequencies, names);
            top += HEIGHT + GAP;
        }
        canvas.finish()
    }

    fn draw_chart(&self, canvas: &mut Canvas, top: f64, frequencies: &[f64], names: &[String]) {
        let all = || self.of.iter().flat_map(|motion| &motion.magnitudes);
        let most = all().copied().fold(0.0, f64::max);
        let first = frequencies.first().copied().unwrap_or(0.0);
        let last = frequencies.last().copied().unwrap_or(1.0);
        let chart = Chart {
            x: LEFT,
            y: top,
            width: WIDTH - LEFT - RIGHT,
            height: HEIGHT,
            across: (first, last),
            upward: (0.0, if most > 0.0 { HEADROOM * most } else { 1.0 }),
        };
        chart.draw_grid(canvas, 1.0, true);
        canvas.clip(chart.x, chart.y, chart.width, chart.height);
        for &mode in &self.modes {
            let style = "stroke=\"#9aa3ad\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\"";
            let (low, high) = (chart.at(mode, 0.0), chart.at(mode, chart.upward.1));
            canvas.line(low, high, style);
        }
        // The first method lies on top.
        for (motion, spectrum) in self.of.iter().enumerate().rev() {
            let points = frequencies
                .iter()
                .zip(&spectrum.magnitudes)
                .map(|(&frequency, &magnitude)| chart.at(frequency, magnitude));
            let style = format!(
                "fill=\"none\" stroke=\"{}\" stroke-width=\"2\"",
                color::of_method(motion)
            );
            canvas.path(&through(points), &style);
        }
        canvas.unclip();
        let title = format!("Spectrum of the acceleration of {}, mm/s", self.axis);
        chart.draw_frame(canvas, &title);
        chart.draw_name_across(canvas, "frequency, Hz; dashed: modes");
        let entries: Vec<_> = names
            .iter()
            .enumerate()
            .map(|(motion, name)| (name.as_str(), color::of_method(motion), false))
            .collect();
        chart.draw_legend(canvas, &entries);
    }
}

//! Places the charts on the sheet, and the text above them.

use super::canvas::{Anchor, Canvas};
use super::{Plot, motion, path, zoom};

/// Size of the sheet, pixels.
const WIDTH: f64 = 1600.0;
/// As above.
const HEIGHT: f64 = 1200.0;

/// Upper edges of the charts over time, pixels.
const TOPS: [f64; 4] = [128.0, 396.0, 664.0, 932.0];

/// What is written above the charts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Caption {
    /// The program.
    pub(crate) title: String,
    /// Method, cycle time, and what else fits a line.
    pub(crate) subtitle: String,
}

impl Caption {
    /// Writes it.
    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        let title = "fill=\"#20262d\" font-weight=\"bold\"";
        canvas.text((64.0, 48.0), Anchor::Start, 26.0, title, &self.title);
        let subtitle = "fill=\"#4a525b\"";
        canvas.text((64.0, 77.0), Anchor::Start, 16.0, subtitle, &self.subtitle);
    }
}

impl<const N: usize> Plot<N> {
    /// The picture as SVG.
    pub(crate) fn draw(self, caption: &Caption) -> String {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        caption.draw(&mut canvas);
        path::draw(&self, &mut canvas, 64.0, 128.0, 660.0, 520.0);
        motion::draw(&self, &mut canvas, 812.0, 752.0, TOPS, 212.0);
        let corner = self.corner.finish();
        zoom::draw(
            corner.as_ref(),
            &self.letters,
            &mut canvas,
            [64.0, 732.0, 660.0, 412.0],
            "violet: motion",
        );
        canvas.finish()
    }
}

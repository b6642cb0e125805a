//! Draws the optimum and a planned motion: the sharpest corner, and their feedrates over one
//! another.
//!
//! Not here: finding either.

use super::canvas::Canvas;
use super::corner::CornerFinder;
use super::feeds::Feeds;
use super::{Caption, color, zoom};
use toolglide_kinematics::{Move, Piece, Vector};

/// Size of the sheet, pixels.
const WIDTH: f64 = 1600.0;
/// As above.
const HEIGHT: f64 = 780.0;

/// Upper edge and height of the charts, pixels.
const TOP: f64 = 128.0;
/// As above.
const TALL: f64 = 580.0;

/// Gathers two motions along one path, the optimum first.
#[derive(Clone, Debug)]
pub(crate) struct Contrast<const N: usize> {
    letters: Vec<char>,
    feeds: Feeds,
    corners: [CornerFinder<N>; 2],
}

impl<const N: usize> Contrast<N> {
    /// Both at rest at `start`.
    pub(crate) fn new(start: Vector<N>, names: [String; 2], letters: Vec<char>) -> Self {
        Self {
            letters,
            feeds: Feeds::new(names.to_vec()),
            corners: std::array::from_fn(|_| CornerFinder::starting_at(start)),
        }
    }

    /// Takes the next move of the path.
    pub(crate) fn expect(&mut self, next: &Move<N>) {
        self.feeds.expect(next);
        for corner in &mut self.corners {
            corner.expect(next);
        }
    }

    /// Takes the next piece of one of the motions.
    pub(crate) fn observe(&mut self, motion: usize, piece: &Piece<N>) {
        self.feeds.observe(motion, piece);
        if let Some(corner) = self.corners.get_mut(motion) {
            corner.observe(piece);
        }
    }

    /// How sharp the sharpest corner is.
    pub(crate) fn sharpness(&self) -> f64 {
        self.corners[0].sharpness()
    }

    /// The picture as SVG.
    pub(crate) fn draw(self, caption: &Caption) -> String {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        caption.draw(&mut canvas);
        let [optimum, planned] = self.corners.map(CornerFinder::finish);
        let letters = &self.letters;
        let colors = "violet: optimum, blue: planned";
        let view = zoom::draw(
            optimum.as_ref(),
            letters,
            &mut canvas,
            [64.0, TOP, 640.0, TALL],
            colors,
        );
        if let (Some(view), Some(planned)) = (view, &planned) {
            view.draw_motion(planned, color::of_method(1), &mut canvas);
        }
        self.feeds.draw_all(&mut canvas, 790.0, TOP, 770.0, TALL);
        canvas.finish()
    }
}

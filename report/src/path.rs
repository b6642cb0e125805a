//! Gathers the programmed path: line, feedrate and tolerance of every move, and points to draw it by.
//!
//! Not here: the motion.

use crate::columns::Packer;
use std::io;
use toolglide_kinematics::{Arc, Move, Path, Vector};

/// Share of the tolerance by which the drawn chords of an arc may leave it.
const CHORD_SHARE: f64 = 0.02;

/// Fewest and most chords of a drawn arc.
const CHORDS: std::ops::RangeInclusive<f64> = 8.0..=1024.0;

/// Points that are kept of the path; of longer ones every other is dropped, as often as it takes.
const MAX_POINTS: usize = 1 << 20;

/// What is known of a move.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MoveInfo {
    pub(crate) line: u32,
    /// Feedrate, mm/s; infinite for a rapid.
    pub(crate) feedrate: f64,
    pub(crate) tolerance: f64,
}

/// Gathers the moves of a program.
///
/// # Examples
/// ```
/// use toolglide_report::PathRecorder;
/// use toolglide_kinematics::{Feedrate, Move, Tolerance, Vector};
/// let mut path = PathRecorder::starting_at(Vector::<2>::zeros());
/// path.expect(&Move::line_to(
///     Vector::<2>::new(10.0, 0.0), Feedrate::new(100.0)?, Tolerance::new(0.01)?)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PathRecorder<const N: usize> {
    at: Vector<N>,
    moves: Vec<MoveInfo>,
    points: Vec<Vector<N>>,
    /// One point in so many is kept.
    stride: usize,
    passed: usize,
}

impl<const N: usize> PathRecorder<N> {
    /// A path that starts at a point, mm or rad by axis.
    #[must_use]
    pub fn starting_at(start: Vector<N>) -> Self {
        Self {
            at: start,
            moves: Vec::new(),
            points: vec![start],
            stride: 1,
            passed: 0,
        }
    }

    /// Takes the next move of the path.
    pub fn expect(&mut self, next: &Move<N>) {
        match next.path() {
            Path::Arc(arc) => {
                for share in shares(arc, next.tolerance().length()) {
                    self.point(arc.point(share));
                }
            }
            Path::Line { .. } | Path::Dwell { .. } => self.point(next.end(self.at)),
        }
        self.at = next.end(self.at);
        self.moves.push(MoveInfo {
            line: next.line(),
            feedrate: next.feedrate().speed(),
            tolerance: next.tolerance().length(),
        });
    }

    /// What is known of a move, counted from 0.
    pub(crate) fn info(&self, index: u32) -> Option<&MoveInfo> {
        self.moves.get(index as usize)
    }

    fn point(&mut self, point: Vector<N>) {
        self.passed += 1;
        if !self.passed.is_multiple_of(self.stride) {
            return;
        }
        self.points.push(point);
        if self.points.len() >= MAX_POINTS {
            let mut index = 0;
            self.points.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.stride *= 2;
        }
    }

    /// Packs moves and points.
    pub(crate) fn pack(&self, packer: &mut Packer) -> io::Result<()> {
        let moves = || self.moves.iter();
        packer.counts("line", moves().map(|one| one.line))?;
        packer.f32("feedrate", 23, moves().map(|one| shown(one.feedrate)))?;
        packer.f32("tolerance", 23, moves().map(|one| one.tolerance))?;
        for axis in 0..N {
            let coordinates = self.points.iter().map(|point| point[axis]);
            packer.steps(&format!("path{axis}"), crate::motion::STEP, coordinates)?;
        }
        Ok(())
    }
}

/// A feedrate as the page has it: 0 for a rapid, which has none.
fn shown(feedrate: f64) -> f64 {
    if feedrate.is_finite() { feedrate } else { 0.0 }
}

/// Shares of an arc after its start at which it is drawn.
fn shares<const N: usize>(arc: &Arc<N>, tolerance: f64) -> impl Iterator<Item = f64> + use<N> {
    let (one, two) = arc.radii();
    let radius = one.max(two).max(f64::MIN_POSITIVE);
    let sagitta = (CHORD_SHARE * tolerance).min(radius);
    let chords = arc.sweep().abs() / (8.0 * sagitta / radius).sqrt();
    let count = chords.ceil().clamp(*CHORDS.start(), *CHORDS.end());
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the count is between 8 and 1024"
    )]
    let whole = count as u32;
    (1..=whole).map(move |step| f64::from(step) / count)
}

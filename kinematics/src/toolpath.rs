//! The path as it was programmed: lines, arcs and dwells, in order.
//!
//! Source: chapter 3 plans over lines, chapter 4 over lines and arcs. Not here: time.

use crate::arc::Arc;
use crate::error::ToolpathError;
use crate::tolerance::{Feedrate, Tolerance};
use crate::vector::{Vector, is_finite};

/// Where a move leads.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Path<const N: usize> {
    /// A straight line from wherever the last move ended.
    Line {
        /// Where it ends.
        end: Vector<N>,
    },
    /// A circular move; it starts where the last move ended.
    Arc(Arc<N>),
    /// Standing still for a time, s.
    Dwell {
        /// How long, s.
        duration: f64,
    },
}

/// One move of a toolpath.
///
/// The tolerance of a corner between two moves is the smaller of theirs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move<const N: usize> {
    path: Path<N>,
    feedrate: Feedrate,
    tolerance: Tolerance,
    stop: bool,
    line: u32,
}

impl<const N: usize> Move<N> {
    /// A straight move to `end`.
    ///
    /// # Errors
    /// [`ToolpathError::NotFinite`] for coordinates that are not finite.
    pub fn line_to(
        end: Vector<N>,
        feedrate: Feedrate,
        tolerance: Tolerance,
    ) -> Result<Self, ToolpathError> {
        if !is_finite(&end) {
            return Err(ToolpathError::NotFinite);
        }
        Ok(Self {
            path: Path::Line { end },
            feedrate,
            tolerance,
            stop: false,
            line: 0,
        })
    }

    /// A circular move. Motion stays within `tolerance` of the true arc.
    #[must_use]
    pub fn arc(arc: Arc<N>, feedrate: Feedrate, tolerance: Tolerance) -> Self {
        Self {
            path: Path::Arc(arc),
            feedrate,
            tolerance,
            stop: false,
            line: 0,
        }
    }

    /// A pause at the current point, s; the motion stops for it exactly there.
    ///
    /// # Errors
    /// [`ToolpathError::NotPositive`] for a negative or infinite time; zero is legal.
    pub fn dwell(duration: f64, tolerance: Tolerance) -> Result<Self, ToolpathError> {
        if !(duration >= 0.0 && duration.is_finite()) {
            return Err(ToolpathError::NotPositive {
                quantity: "dwell",
                value: duration,
            });
        }
        Ok(Self {
            path: Path::Dwell { duration },
            feedrate: Feedrate::RAPID,
            tolerance,
            stop: true,
            line: 0,
        })
    }

    /// The same move, coming to rest exactly at its end.
    #[must_use]
    pub fn with_exact_stop(mut self) -> Self {
        self.stop = true;
        self
    }

    /// The same move, coming from a line of a program (counted from 1; 0 means none).
    #[must_use]
    pub fn from_line(mut self, line: u32) -> Self {
        self.line = line;
        self
    }

    /// Where the move leads.
    #[must_use]
    pub fn path(&self) -> &Path<N> {
        &self.path
    }

    /// Largest speed along the move.
    #[must_use]
    pub fn feedrate(&self) -> Feedrate {
        self.feedrate
    }

    /// How far the motion may leave the move.
    #[must_use]
    pub fn tolerance(&self) -> Tolerance {
        self.tolerance
    }

    /// Whether the motion must come to rest exactly at the end of this move.
    #[must_use]
    pub fn stops(&self) -> bool {
        self.stop
    }

    /// Line of the program, counted from 1; 0 when the move comes from none.
    #[must_use]
    pub fn line(&self) -> u32 {
        self.line
    }

    /// Where the move ends, when it started at `start`.
    #[must_use]
    pub fn end(&self, start: Vector<N>) -> Vector<N> {
        match &self.path {
            Path::Line { end } => *end,
            Path::Arc(arc) => arc.end(),
            Path::Dwell { .. } => start,
        }
    }

    /// Length of the move, when it started at `start`.
    #[must_use]
    pub fn length(&self, start: Vector<N>) -> f64 {
        match &self.path {
            Path::Line { end } => (end - start).norm(),
            Path::Arc(arc) => arc.length(),
            Path::Dwell { .. } => 0.0,
        }
    }
}

/// A start and the moves from there, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Toolpath<const N: usize> {
    start: Vector<N>,
    moves: Vec<Move<N>>,
}

impl<const N: usize> Toolpath<N> {
    /// A toolpath of no moves.
    ///
    /// # Errors
    /// [`ToolpathError::NotFinite`] for coordinates that are not finite.
    pub fn starting_at(start: Vector<N>) -> Result<Self, ToolpathError> {
        if is_finite(&start) {
            Ok(Self {
                start,
                moves: Vec::new(),
            })
        } else {
            Err(ToolpathError::NotFinite)
        }
    }

    /// Straight moves through points, the first of which is the start.
    ///
    /// # Errors
    /// [`ToolpathError::Empty`] without a point, [`ToolpathError::NotFinite`] as above.
    pub fn from_points(
        points: &[Vector<N>],
        feedrate: Feedrate,
        tolerance: Tolerance,
    ) -> Result<Self, ToolpathError> {
        let (first, rest) = points.split_first().ok_or(ToolpathError::Empty)?;
        let mut path = Self::starting_at(*first)?;
        for point in rest {
            path.push(Move::line_to(*point, feedrate, tolerance)?)?;
        }
        Ok(path)
    }

    /// Appends a move.
    ///
    /// # Errors
    /// [`ToolpathError::Gap`] when an arc does not start where the last move ended.
    pub fn push(&mut self, next: Move<N>) -> Result<(), ToolpathError> {
        check_contact(&next, self.end())?;
        self.moves.push(next);
        Ok(())
    }

    /// Where the path begins.
    #[must_use]
    pub fn start(&self) -> Vector<N> {
        self.start
    }

    /// Where the path ends.
    #[must_use]
    pub fn end(&self) -> Vector<N> {
        self.moves
            .iter()
            .rev()
            .find_map(|last| match last.path() {
                Path::Line { end } => Some(*end),
                Path::Arc(arc) => Some(arc.end()),
                Path::Dwell { .. } => None,
            })
            .unwrap_or(self.start)
    }

    /// The moves, in order.
    #[must_use]
    pub fn moves(&self) -> &[Move<N>] {
        &self.moves
    }

    /// Length of all moves.
    #[must_use]
    pub fn length(&self) -> f64 {
        let mut at = self.start;
        let mut length = 0.0;
        for step in &self.moves {
            length += step.length(at);
            at = step.end(at);
        }
        length
    }
}

/// Checks that `next` can follow when the path has come to `at`.
///
/// # Errors
/// [`ToolpathError::Gap`] when it is an arc that starts elsewhere.
pub fn check_contact<const N: usize>(next: &Move<N>, at: Vector<N>) -> Result<(), ToolpathError> {
    if let Path::Arc(arc) = next.path() {
        let gap = (arc.start() - at).norm();
        if gap > crate::numeric::LENGTH_SLACK {
            return Err(ToolpathError::Gap { gap });
        }
    }
    Ok(())
}

//! Represents the programmed path: lines, arcs and dwells, in order.
//!
//! Source: chapter 3 plans over lines, chapter 4 over lines and arcs. Not here: time.

use crate::arc::Arc;
use crate::error::ToolpathError;
#[cfg(not(feature = "std"))]
use crate::no_std::*;
use crate::numeric::{LENGTH_SLACK, LONGEST_DURATION, MIN_SHARE_OF_RADIUS};
use crate::tolerance::{Feedrate, Tolerance};
use crate::vector::{Vector, check};

/// Where a move leads.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// [`ToolpathError::NotFinite`] for coordinates that are not finite, [`ToolpathError::TooFar`] for those beyond
    /// [`LARGEST_COORDINATE`](crate::numeric::LARGEST_COORDINATE).
    pub fn line_to(
        end: Vector<N>,
        feedrate: Feedrate,
        tolerance: Tolerance,
    ) -> Result<Self, ToolpathError> {
        check(&end)?;
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
    /// [`ToolpathError::TooLarge`] for one beyond [`LONGEST_DURATION`].
    pub fn dwell(duration: f64, tolerance: Tolerance) -> Result<Self, ToolpathError> {
        if !(duration >= 0.0 && duration.is_finite()) {
            return Err(ToolpathError::NotPositive {
                quantity: "dwell",
                value: duration,
            });
        }
        if duration > LONGEST_DURATION {
            return Err(ToolpathError::TooLarge {
                quantity: "dwell",
                value: duration,
                bound: LONGEST_DURATION,
            });
        }
        // Minus zero is zero.
        let duration = duration.abs();
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

    /// The same move at another largest speed.
    #[must_use]
    pub fn at_feedrate(mut self, feedrate: Feedrate) -> Self {
        self.feedrate = feedrate;
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
    /// [`ToolpathError::NotFinite`] for coordinates that are not finite, [`ToolpathError::TooFar`] for those beyond
    /// [`LARGEST_COORDINATE`](crate::numeric::LARGEST_COORDINATE).
    pub fn starting_at(start: Vector<N>) -> Result<Self, ToolpathError> {
        check(&start)?;
        Ok(Self {
            start,
            moves: Vec::new(),
        })
    }

    /// Straight moves through points, the first of which is the start.
    ///
    /// # Errors
    /// [`ToolpathError::Empty`] without a point, others as above.
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
    /// As [`check_contact`].
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
/// [`ToolpathError::Gap`] when it is an arc that starts elsewhere, [`ToolpathError::TooFine`] when its tolerance is
/// below [`MIN_SHARE_OF_RADIUS`].
pub fn check_contact<const N: usize>(next: &Move<N>, at: Vector<N>) -> Result<(), ToolpathError> {
    if let Path::Arc(arc) = next.path() {
        let gap = (arc.start() - at).norm();
        if gap > LENGTH_SLACK {
            return Err(ToolpathError::Gap { gap });
        }
        let (start_radius, end_radius) = arc.radii();
        let radius = start_radius.max(end_radius);
        let (tolerance, least) = (next.tolerance.length(), MIN_SHARE_OF_RADIUS * radius);
        if tolerance < least {
            return Err(ToolpathError::TooFine {
                tolerance,
                least,
                radius,
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::LARGEST_COORDINATE;

    fn tolerance(length: f64) -> Tolerance {
        Tolerance::new(length).unwrap()
    }

    #[test]
    fn points_that_planners_cannot_carry_are_refused_with_the_bound() {
        let to = |x: f64| Move::line_to(Vector::<2>::new(x, 0.0), Feedrate::RAPID, tolerance(0.1));
        assert!(to(-LARGEST_COORDINATE).is_ok(), "the farthest");
        for value in [1.000_1e7, -1e150, 1e300] {
            assert_eq!(to(value), Err(ToolpathError::TooFar { value }));
            let start = Vector::<2>::new(0.0, value);
            assert_eq!(
                Toolpath::starting_at(start),
                Err(ToolpathError::TooFar { value })
            );
            let center = Vector::<2>::new(value, 0.0);
            let arc = Arc::about(Vector::zeros(), Vector::zeros(), center, [0, 1], true, 0);
            assert_eq!(arc, Err(ToolpathError::TooFar { value }));
        }
        assert_eq!(to(f64::NAN), Err(ToolpathError::NotFinite));
        let message = ToolpathError::TooFar { value: 1e150 }.to_string();
        assert_eq!(
            message,
            "a coordinate is 1e150 mm, but may be at most 1e7 mm"
        );
        assert!(Move::<2>::dwell(1e9, tolerance(0.1)).is_ok(), "the longest");
        let none = Move::<2>::dwell(-0.0, tolerance(0.1)).unwrap();
        let sign = matches!(none.path(), Path::Dwell { duration } if duration.is_sign_positive());
        assert!(sign, "minus zero is zero: {none:?}");
        assert!(
            matches!(
                Move::<2>::dwell(1.1e9, tolerance(0.1)),
                Err(ToolpathError::TooLarge { bound: 1e9, .. })
            ),
            "too long"
        );
    }

    #[test]
    fn an_arc_is_refused_whose_tolerance_is_nothing_beside_its_radius() {
        let radius = 500.0;
        let start = Vector::<2>::new(radius, 0.0);
        let arc = Arc::about(start, start, Vector::zeros(), [0, 1], true, 0).unwrap();
        let path = Toolpath::starting_at(start).unwrap();
        for (length, fine) in [(5.001e-8, true), (4.999e-8, false)] {
            let step = Move::arc(arc, Feedrate::RAPID, tolerance(length));
            let pushed = path.clone().push(step);
            assert_eq!(pushed.is_ok(), fine, "{length}: {pushed:?}");
            assert!(
                fine || matches!(pushed, Err(ToolpathError::TooFine { least, .. }) if (least - 5e-8).abs() < 1e-20),
                "{pushed:?}"
            );
        }
    }
}

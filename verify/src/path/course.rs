//! Measures the distance of points from a path of lines and arcs whose moves are known one after the other.
//!
//! Source: geometry; a leg is left out only where the length of path up to it proves that it cannot be nearer. Not here: which
//! moves count, and motion.

use std::collections::VecDeque;

use crate::path::route::Route;
use crate::report::Place;
use toolglide_kinematics::{Move, ToolpathError, Vector};

/// The moves of a path that are still needed, as true lines and arcs.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Feedrate, Move, Tolerance, Vector};
/// use toolglide_verify::Course;
/// let mut course = Course::new(Vector::<2>::zeros());
/// let end = Vector::<2>::new(10.0, 0.0);
/// course.expect(&Move::line_to(end, Feedrate::RAPID, Tolerance::new(0.1)?)?)?;
/// let foot = course.nearest(&Vector::<2>::new(4.0, 0.5), 0, 0, 0).ok_or("no move")?;
/// assert!((foot.distance - 0.5).abs() < 1e-15 && (foot.point.x - 4.0).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Course<const N: usize> {
    route: Route<N>,
    /// Length of the path at the end of each move that is still known.
    ends: VecDeque<f64>,
}

/// The point of a path that is nearest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CourseFoot<const N: usize> {
    /// Move and program line.
    pub place: Place,
    /// Distance, mm.
    pub distance: f64,
    /// The nearest point.
    pub point: Vector<N>,
    /// Direction of travel there, of unit length; zero on a move of no length.
    pub direction: Vector<N>,
    /// Tolerance of the move, mm.
    pub tolerance: f64,
}

impl<const N: usize> Course<N> {
    /// A path of no moves from `start`.
    #[must_use]
    pub fn new(start: Vector<N>) -> Self {
        Self {
            route: Route::new(start),
            ends: VecDeque::new(),
        }
    }

    /// Takes the next move.
    ///
    /// # Errors
    /// [`ToolpathError`] when it does not connect; the path stays as it was.
    pub fn expect(&mut self, next: &Move<N>) -> Result<(), ToolpathError> {
        self.route.expect(next)?;
        self.ends.push_back(self.route.length);
        Ok(())
    }

    /// Number of the first move that is still known, counted from 0.
    #[must_use]
    pub fn base(&self) -> u32 {
        self.route.base()
    }

    /// How many moves the path has so far, the forgotten ones included.
    #[must_use]
    pub fn moves(&self) -> u32 {
        self.route.len()
    }

    /// Forgets all moves before one.
    pub fn forget_before(&mut self, mv: u32) {
        while self.route.base() < mv && self.route.forget_first().is_some() {
            self.ends.pop_front();
        }
    }

    /// Distance of a point from a move that is known, mm.
    #[must_use]
    pub fn distance(&self, mv: u32, point: &Vector<N>) -> Option<f64> {
        self.route.get(mv).map(|leg| leg.distance(point))
    }

    /// Tolerance of a move that is known, mm.
    #[must_use]
    pub fn tolerance(&self, mv: u32) -> Option<f64> {
        self.route.get(mv).map(|leg| leg.tolerance)
    }

    /// Length of a move that is known, mm.
    #[must_use]
    pub fn length(&self, mv: u32) -> Option<f64> {
        self.route.get(mv).map(|leg| leg.length)
    }

    /// The point of moves `first..=last` that is nearest to `point`; `None` where none of them is known.
    ///
    /// `guess` is a move that is probably near: it makes the search short and does not change what it finds.
    #[must_use]
    pub fn nearest(
        &self,
        point: &Vector<N>,
        first: u32,
        last: u32,
        guess: u32,
    ) -> Option<CourseFoot<N>> {
        let first = first.max(self.route.base());
        let last = last.min(self.route.len().checked_sub(1)?);
        if first > last {
            return None;
        }
        let mut best = guess.clamp(first, last);
        let mut least = self.distance(best, point)?;
        let mut at = first;
        while at <= last {
            let distance = self.distance(at, point)?;
            if distance < least {
                (best, least) = (at, distance);
            }
            // No point nearer than the best comes before the path has gone the difference.
            let reach = self.end_of(at) + (distance - least);
            at += 1;
            while at < last && self.end_of(at) <= reach {
                at += 1;
            }
        }
        let leg = self.route.get(best)?;
        let (foot, direction) = leg.foot(point);
        Some(CourseFoot {
            place: leg.place,
            distance: least,
            point: foot,
            direction,
            tolerance: leg.tolerance,
        })
    }

    fn end_of(&self, mv: u32) -> f64 {
        let index = usize::try_from(mv.saturating_sub(self.route.base())).unwrap_or(usize::MAX);
        self.ends.get(index).copied().unwrap_or(f64::INFINITY)
    }
}

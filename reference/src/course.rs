//! Describes straight segments between two rests, and the constraints of a motion along them.
//!
//! Source: section 3.2 for the corner, whose error is the distance to it. A course is pure geometry:
//! what of a [`Toolpath`](toolglide_kinematics::Toolpath) lies between two stops. Not here: how arcs
//! become legs, see [`sections`](crate::sections()); time.

use crate::error::ReferenceError;
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::vector::length_and_direction;
use toolglide_kinematics::{Feedrate, Limits, Tolerance, Vector};

/// Which motions are compared with each other: what a score means.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Class {
    /// Every point lies within the tolerance of its leg, and the motion passes within the tolerance of
    /// every corner: the tolerance of the whole project.
    #[default]
    TwoSided,
    /// Every point lies within the tolerance of its leg, and no more. Around a sharp corner this
    /// allows a larger corner error, so it flatters the optimum.
    OneSided,
    /// Two-sided, and never on the outer side of a line next to a corner.
    NeverOutside,
    /// Two-sided within `reach` of a corner, mm along the lines, and exactly on the lines elsewhere.
    OnTheLines {
        /// How far from the corner the motion may leave the lines, mm.
        reach: f64,
    },
}

/// How a motion follows a leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hold {
    /// Within its tolerance.
    Tube,
    /// Exactly.
    Line,
    /// It does not matter.
    Free,
}

/// What holds where two legs meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Join {
    /// The motion passes within a radius of the point, mm.
    Within(f64),
    /// The motion passes through the point.
    Through,
    /// The motion changes legs anywhere.
    Anywhere,
}

/// A straight leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment<const N: usize> {
    pub(crate) start: Vector<N>,
    pub(crate) end: Vector<N>,
    /// Unit direction; zero where the leg has no length.
    pub(crate) direction: Vector<N>,
    pub(crate) length: f64,
    /// Largest speed, mm/s; infinite for a rapid.
    pub(crate) feed: f64,
    /// What keeps the tolerance for certain, mm.
    pub(crate) inner: f64,
    /// What everything that keeps the tolerance keeps, mm; more than `inner` where chords stand for
    /// an arc.
    pub(crate) outer: f64,
    pub(crate) hold: Hold,
    /// The move it belongs to, counted from 0.
    pub(crate) serves: u32,
    /// Line of the program, 0 for none.
    pub(crate) line: u32,
}

impl<const N: usize> Segment<N> {
    /// A leg along a move; `None` where the ends coincide.
    pub(crate) fn between(
        start: Vector<N>,
        end: Vector<N>,
        feed: Feedrate,
        tolerance: Tolerance,
        spent: f64,
    ) -> Option<Self> {
        let (length, direction) = length_and_direction(&start, &end)?;
        Some(Self {
            start,
            end,
            direction,
            length,
            feed: feed.speed(),
            inner: tolerance.length() - spent,
            outer: tolerance.length() + spent,
            hold: Hold::Tube,
            serves: 0,
            line: 0,
        })
    }

    /// How far a point is from the leg, mm.
    pub(crate) fn distance(&self, point: &Vector<N>) -> f64 {
        let from = point - self.start;
        let along = from.dot(&self.direction).clamp(0.0, self.length);
        (from - self.direction * along).norm()
    }
}

/// Straight legs from rest to rest, with the limits of the axes.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Feedrate, Limits, Tolerance, Vector};
/// use toolglide_reference::{Course, Settings, optimum};
/// let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
/// let limits = Limits::uniform(500.0, 2500.0, 2e5)?;
/// let course = Course::through(&corner, limits, Feedrate::new(100.0)?, Tolerance::new(0.01)?)?;
/// let best = optimum(&course, &[course.stopping_times()], &Settings::default())?;
/// assert!(best.lower_bound() < 0.28712 && 0.28710 < best.duration());
/// assert!(best.duration() - best.lower_bound() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Course<const N: usize> {
    pub(crate) limits: Limits<N>,
    pub(crate) legs: Vec<Segment<N>>,
    /// One less than the legs.
    pub(crate) joins: Vec<Join>,
    /// Whether the motion must stay on the inner side at corners.
    pub(crate) inside: bool,
}

impl<const N: usize> Course<N> {
    /// Legs through points, all with the same feedrate and tolerance; points that coincide count
    /// once.
    ///
    /// # Errors
    /// [`ReferenceError::Empty`] when no two points differ.
    pub fn through(
        points: &[Vector<N>],
        limits: Limits<N>,
        feedrate: Feedrate,
        tolerance: Tolerance,
    ) -> Result<Self, ReferenceError> {
        let mut legs: Vec<Segment<N>> = Vec::new();
        for pair in points.windows(2) {
            let start = legs.last().map_or(pair[0], |leg| leg.end);
            if let Some(mut leg) = Segment::between(start, pair[1], feedrate, tolerance, 0.0) {
                leg.serves = u32::try_from(legs.len()).unwrap_or(u32::MAX);
                legs.push(leg);
            }
        }
        let joins = vec![Join::Within(tolerance.length()); legs.len().saturating_sub(1)];
        Self::new(limits, legs, joins)
    }

    pub(crate) fn new(
        limits: Limits<N>,
        legs: Vec<Segment<N>>,
        joins: Vec<Join>,
    ) -> Result<Self, ReferenceError> {
        if legs.is_empty() {
            return Err(ReferenceError::Empty {
                shortest: SHORTEST_LENGTH,
            });
        }
        Ok(Self {
            limits,
            legs,
            joins,
            inside: false,
        })
    }

    /// The same legs for another class of motions.
    ///
    /// # Errors
    /// [`ReferenceError::Zones`] when two zones of [`Class::OnTheLines`] overlap,
    /// [`ReferenceError::NotPositive`] for their reach.
    pub fn of_class(&self, class: Class) -> Result<Self, ReferenceError> {
        let mut course = self.clone();
        match class {
            Class::TwoSided => {}
            Class::OneSided => course.joins.fill(Join::Anywhere),
            Class::NeverOutside => course.inside = true,
            Class::OnTheLines { reach } => return course.with_zones(reach),
        }
        Ok(course)
    }

    fn with_zones(&self, reach: f64) -> Result<Self, ReferenceError> {
        if !(reach > 0.0 && reach.is_finite()) {
            return Err(ReferenceError::NotPositive {
                leg: 0,
                quantity: "reach",
                value: reach,
            });
        }
        let (mut legs, mut joins) = (Vec::new(), Vec::new());
        let last = self.legs.len() - 1;
        for (index, leg) in self.legs.iter().enumerate() {
            let before = if index > 0 { reach } else { 0.0 };
            let after = if index < last { reach } else { 0.0 };
            if before + after >= leg.length {
                return Err(ReferenceError::Zones {
                    leg: index,
                    length: leg.length,
                    needed: before + after,
                });
            }
            let mut part = |from: f64, to: f64, hold| {
                if to > from {
                    legs.push(Segment {
                        start: leg.start + leg.direction * from,
                        end: leg.start + leg.direction * to,
                        length: to - from,
                        hold,
                        ..*leg
                    });
                }
            };
            part(0.0, before, Hold::Tube);
            part(before, leg.length - after, Hold::Line);
            part(leg.length - after, leg.length, Hold::Tube);
            if before > 0.0 {
                joins.push(Join::Through);
            }
            if after > 0.0 {
                joins.push(Join::Through);
                joins.push(self.joins[index]);
            }
        }
        Self::new(self.limits, legs, joins)
    }

    /// The first and the second half of two legs or more, with a rest between.
    pub(crate) fn halves(&self) -> (Self, Self) {
        let middle = self.legs.len() / 2;
        let part = |legs: &[Segment<N>], joins: &[Join]| Self {
            legs: legs.to_vec(),
            joins: joins.to_vec(),
            ..*self
        };
        (
            part(&self.legs[..middle], &self.joins[..middle - 1]),
            part(&self.legs[middle..], &self.joins[middle..]),
        )
    }

    /// How many legs there are.
    #[must_use]
    pub fn legs(&self) -> usize {
        self.legs.len()
    }

    /// Length of all legs, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.legs.iter().map(|leg| leg.length).sum()
    }

    /// Line of the program that a leg comes from, counted from 1; 0 for none.
    #[must_use]
    pub fn line(&self, leg: usize) -> u32 {
        self.legs.get(leg).map_or(0, |leg| leg.line)
    }

    /// The move that a leg belongs to, counted from 0.
    #[must_use]
    pub fn move_of(&self, leg: usize) -> u32 {
        self.legs.get(leg).map_or(0, |leg| leg.serves)
    }

    /// Where the course begins.
    #[must_use]
    pub fn start(&self) -> Vector<N> {
        self.legs[0].start
    }

    /// Where the course ends.
    #[must_use]
    pub fn end(&self) -> Vector<N> {
        self.legs[self.legs.len() - 1].end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner() -> Course<2> {
        let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 0.0], [10.0, 5.0]].map(Vector::<2>::from);
        let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
        let (feedrate, tolerance) = (Feedrate::RAPID, Tolerance::new(0.01).unwrap());
        Course::through(&points, limits, feedrate, tolerance).unwrap()
    }

    #[test]
    fn points_that_coincide_count_once() {
        let course = corner();
        assert_eq!(course.legs(), 2);
        assert!((course.length() - 15.0).abs() < 1e-12, "{course:?}");
        let same = [Vector::<2>::zeros(); 3];
        assert!(
            Course::through(
                &same,
                course.limits,
                Feedrate::RAPID,
                Tolerance::new(1.0).unwrap()
            )
            .is_err(),
            "no length"
        );
    }

    #[test]
    fn zones_split_each_leg_where_they_begin() {
        let zoned = corner().of_class(Class::OnTheLines { reach: 1.0 }).unwrap();
        let holds: Vec<_> = zoned.legs.iter().map(|leg| leg.hold).collect();
        assert_eq!(holds, [Hold::Line, Hold::Tube, Hold::Tube, Hold::Line]);
        assert_eq!(
            zoned.joins,
            [Join::Through, Join::Within(0.01), Join::Through]
        );
        assert!((zoned.length() - 15.0).abs() < 1e-12, "{zoned:?}");
        for reach in [6.0, 0.0, f64::NAN] {
            assert!(
                corner().of_class(Class::OnTheLines { reach }).is_err(),
                "{reach}"
            );
        }
    }

    #[test]
    fn distance_is_measured_to_the_leg_and_not_to_its_line() {
        let course = corner();
        let beyond = Vector::<2>::new(13.0, -4.0);
        assert!(
            (course.legs[0].distance(&beyond) - 5.0).abs() < 1e-12,
            "beyond"
        );
    }
}

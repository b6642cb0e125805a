//! Cuts moves into courses between two stops of a program.
//!
//! Source: the motion is at rest at exact stops, dwells, and both ends, so the parts between are
//! independent. Arcs become chords; the tolerance of a chord is what its arc leaves for certain, or
//! can have left at most. Not here: motion.

use crate::course::{Course, Join, Segment};
use toolglide_kinematics::{
    Arc, Limits, Move, Path, PlanError, Tolerance, Toolpath, Vector, check_contact,
};

/// Share of the tolerance by which a chord may leave its arc.
const CHORD_SHARE: f64 = 0.1;

/// What happens between two stops.
#[derive(Clone, Debug, PartialEq)]
pub enum Section<const N: usize> {
    /// Moving.
    Course(Course<N>),
    /// Standing still.
    Rest {
        /// How long, s.
        duration: f64,
        /// Where.
        place: Vector<N>,
        /// The move that asks for it, counted from 0.
        serves: u32,
    },
}

/// Collects moves into sections while a program is read.
#[derive(Clone, Debug)]
pub struct Sections<const N: usize> {
    limits: Limits<N>,
    position: Vector<N>,
    tolerance: Option<Tolerance>,
    legs: Vec<Segment<N>>,
    joins: Vec<Join>,
    index: u32,
}

impl<const N: usize> Sections<N> {
    /// No moves yet, at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, limits: Limits<N>) -> Self {
        Self {
            limits,
            position: start,
            tolerance: None,
            legs: Vec::new(),
            joins: Vec::new(),
            index: 0,
        }
    }

    /// Takes the next move and gives what it completes: at most a course and a rest.
    ///
    /// # Errors
    /// [`PlanError::Path`] for an arc that starts elsewhere, [`PlanError::TooMany`] after four thousand
    /// million moves.
    pub fn push(&mut self, next: &Move<N>) -> Result<[Option<Section<N>>; 2], PlanError> {
        let index = self.index;
        check_contact(next, self.position).map_err(|reason| PlanError::Path { index, reason })?;
        self.index = index.checked_add(1).ok_or(PlanError::TooMany { index })?;
        let mut rest = None;
        match next.path() {
            Path::Line { end } => self.leg(next, index, *end, 0.0, false),
            Path::Arc(arc) => self.arc(next, index, arc),
            Path::Dwell { duration } => {
                rest = Some(Section::Rest {
                    duration: *duration,
                    place: self.position,
                    serves: index,
                });
            }
        }
        let course = if next.stops() { self.cut() } else { None };
        Ok([course, rest])
    }

    /// Ends the section here, as a stop does; `None` when it has no leg.
    pub fn cut(&mut self) -> Option<Section<N>> {
        let joins = std::mem::take(&mut self.joins);
        self.tolerance = None;
        Course::new(self.limits, std::mem::take(&mut self.legs), joins)
            .ok()
            .map(Section::Course)
    }

    /// How many legs the section has so far.
    #[must_use]
    pub fn legs(&self) -> usize {
        self.legs.len()
    }

    /// Cuts the section at the sharpest corner of its second half, keeping what follows; ends it
    /// where there is none.
    pub(crate) fn cut_at_sharpest(&mut self) -> Option<Section<N>> {
        let middle = self.legs.len() / 2;
        let turn = |join: usize| {
            self.legs[join]
                .direction
                .dot(&self.legs[join + 1].direction)
        };
        let sharpest =
            (middle..self.joins.len()).min_by(|&one, &other| turn(one).total_cmp(&turn(other)));
        let Some(join) = sharpest else {
            return self.cut();
        };
        let legs = self.legs.split_off(join + 1);
        let joins = self.joins.split_off(join + 1);
        self.joins.pop();
        let tolerance = self.tolerance;
        let section = self.cut();
        (self.legs, self.joins, self.tolerance) = (legs, joins, tolerance);
        section
    }

    fn leg(&mut self, next: &Move<N>, index: u32, end: Vector<N>, spent: f64, smooth: bool) {
        let tolerance = next.tolerance();
        let leg = Segment::between(self.position, end, next.feedrate(), tolerance, spent);
        // A move without length moves nothing; what follows starts where the last leg ended.
        let Some(mut leg) = leg else {
            return;
        };
        leg.serves = index;
        leg.line = next.line();
        if let Some(last) = self.tolerance {
            self.joins.push(if smooth {
                Join::Anywhere
            } else {
                Join::Within(tolerance.min(last).length())
            });
        }
        self.tolerance = Some(tolerance);
        self.legs.push(leg);
        self.position = end;
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of chords is positive, and the limits of memory come first"
    )]
    fn arc(&mut self, next: &Move<N>, index: u32, arc: &Arc<N>) {
        let (first, last) = arc.radii();
        // The second derivative of the arc in its angle bounds how far a chord can leave it.
        let sweep = arc.sweep().abs();
        let bend = first.max(last) + 2.0 * (last - first).abs() / sweep.max(f64::MIN_POSITIVE);
        let allowed = CHORD_SHARE * next.tolerance().length();
        let count = (sweep / (8.0 * allowed / bend).sqrt()).ceil().max(1.0);
        let spent = bend * (sweep / count) * (sweep / count) / 8.0;
        for chord in 1..=count as u64 {
            #[allow(clippy::cast_precision_loss, reason = "a count far below 2^53")]
            let end = arc.point(chord as f64 / count);
            self.leg(next, index, end, spent, chord > 1);
        }
    }
}

/// The sections of a whole toolpath, in order.
///
/// # Errors
/// As [`Sections::push`].
pub fn sections<const N: usize>(
    path: &Toolpath<N>,
    limits: Limits<N>,
) -> Result<Vec<Section<N>>, PlanError> {
    let mut sections = Sections::new(path.start(), limits);
    let mut found = Vec::new();
    for next in path.moves() {
        found.extend(sections.push(next)?.into_iter().flatten());
    }
    found.extend(sections.cut());
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::Feedrate;

    fn line(x: f64, y: f64) -> Move<2> {
        let end = Vector::<2>::new(x, y);
        Move::line_to(end, Feedrate::RAPID, Tolerance::new(0.1).unwrap()).unwrap()
    }

    fn lengths(sections: &[Section<2>]) -> Vec<f64> {
        sections
            .iter()
            .map(|section| match section {
                Section::Course(course) => course.length(),
                Section::Rest { duration, .. } => -duration,
            })
            .collect()
    }

    #[test]
    fn stops_and_dwells_cut_the_path() {
        let limits = Limits::uniform(1.0, 1.0, 1.0).unwrap();
        let mut path = Toolpath::starting_at(Vector::<2>::zeros()).unwrap();
        for next in [
            line(1.0, 0.0),
            line(1.0, 0.0),
            line(1.0, 2.0).with_exact_stop(),
            Move::dwell(0.5, Tolerance::new(0.1).unwrap()).unwrap(),
            line(4.0, 2.0),
        ] {
            path.push(next).unwrap();
        }
        let found = sections(&path, limits).unwrap();
        assert_eq!(lengths(&found), [3.0, -0.5, 3.0]);
        let Section::Course(first) = &found[0] else {
            panic!("the first moves: {found:?}");
        };
        assert_eq!((first.legs(), first.move_of(1)), (2, 2));
    }

    #[test]
    fn chords_stay_as_near_to_their_arc_as_they_say() {
        let limits = Limits::uniform(1.0, 1.0, 1.0).unwrap();
        let (start, end) = (Vector::<2>::new(5.0, 0.0), Vector::<2>::new(-5.0, 0.0));
        let arc = Arc::about(start, end, Vector::zeros(), [0, 1], true, 0).unwrap();
        let mut path = Toolpath::starting_at(start).unwrap();
        let tolerance = Tolerance::new(0.01).unwrap();
        path.push(Move::arc(arc, Feedrate::RAPID, tolerance))
            .unwrap();
        path.push(line(-5.0, -3.0)).unwrap();
        let found = sections(&path, limits).unwrap();
        let Section::Course(course) = &found[0] else {
            panic!("no stop: {found:?}");
        };
        assert_eq!(*course.joins.last().unwrap(), Join::Within(0.01));
        for leg in &course.legs[..course.legs() - 1] {
            let sagitta = 5.0 - ((leg.start + leg.end) * 0.5).norm();
            assert!(
                sagitta <= 0.01 - leg.inner,
                "{sagitta} > {}",
                0.01 - leg.inner
            );
            assert!((leg.inner + leg.outer - 0.02).abs() < 1e-12, "{leg:?}");
            assert!(leg.inner >= 0.009 - 1e-12, "{leg:?}");
        }
    }

    #[test]
    fn a_long_section_is_cut_at_its_sharpest_corner() {
        let limits = Limits::uniform(1.0, 1.0, 1.0).unwrap();
        let mut sections = Sections::new(Vector::<2>::zeros(), limits);
        for (x, y) in [
            (1.0, 0.0),
            (1.0, 1.0),
            (2.0, 1.0),
            (2.0, 1.5),
            (1.0, 1.6),
            (0.0, 1.6),
        ] {
            sections.push(&line(x, y)).unwrap();
        }
        let Some(Section::Course(course)) = sections.cut_at_sharpest() else {
            panic!("there are legs");
        };
        assert_eq!((course.legs(), course.joins.len()), (4, 3));
        assert_eq!((sections.legs(), sections.joins.len()), (2, 1));
    }
}

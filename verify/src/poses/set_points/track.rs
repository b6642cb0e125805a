//! Assigns each row to the part of the path that leaves the fewest violations.
//!
//! Source: dynamic programming over the parts. The motion goes along the path and never back; from one row to the
//! next it may stay on a part, or pass its end, or several. What a row is away from the part that it is on, and
//! a motion from the ends that it passes, counts as far as it is above the tolerance. Of all ways to go along, the
//! one with the least sum is what happened: where it is 0 for some way, nothing is wrong for certain. Not here:
//! distances, see `parts`.

use crate::poses::FOUND_SLACK;
use crate::poses::set_points::parts::{Part, Row};
use crate::report::{Peak, Place};
use std::sync::Arc;

/// Sums of what is above the tolerances, in tolerances, that differ by more than this are not followed both: a
/// motion that leaves its path so far, and for so long, is wrong for certain.
const KEPT: f64 = 16.0;

/// Most parts on which a row may be at once.
const MOST: usize = 256;

/// Parts before and behind those on which a row may be that can be nearer to it.
const BESIDE: usize = 3;

/// Violations of one kind that are kept with their places; others are counted.
const TOLD: u64 = 10;

/// Something that is outside its tolerance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outside {
    /// Number of the part.
    pub(super) part: usize,
    /// Whether its end was passed too far away, instead of a row being too far from it.
    pub(super) at_end: bool,
    /// How far away, mm or rad.
    pub(super) value: f64,
    pub(super) time: f64,
}

/// What was outside so far, the last first.
#[derive(Debug)]
struct Told {
    last: Outside,
    before: Option<Arc<Told>>,
}

/// One way along the path so far, by the part that it has come to.
#[derive(Clone, Debug, Default)]
struct Course {
    part: usize,
    /// Sum of what is above the tolerances, in tolerances.
    excess: f64,
    /// How many rows, and how many ends, are outside.
    counts: [u64; 2],
    told: Option<Arc<Told>>,
}

impl Course {
    fn take(&mut self, share: f64, outside: Outside) {
        if share <= 1.0 + FOUND_SLACK {
            return;
        }
        self.excess += share - 1.0;
        let count = &mut self.counts[usize::from(outside.at_end)];
        *count += 1;
        if *count <= TOLD {
            self.told = Some(Arc::new(Told {
                last: outside,
                before: self.told.take(),
            }));
        }
    }

    /// The same behind the end of its part.
    fn beyond(mut self, part: &Part, row: &Row) -> Self {
        let value = part.passed(row);
        let outside = Outside {
            part: self.part,
            at_end: true,
            value,
            time: row.time,
        };
        self.take(value / part.at_end, outside);
        self.part += 1;
        self
    }

    /// The same with a row on its part.
    fn with(mut self, part: &Part, row: &Row) -> Self {
        let value = part.away(row);
        let outside = Outside {
            part: self.part,
            at_end: false,
            value,
            time: row.time,
        };
        self.take(value / part.tolerance, outside);
        self
    }
}

/// Follows rows along the path.
#[derive(Debug, Default)]
pub(super) struct Track {
    pub(super) parts: Vec<Part>,
    courses: Vec<Course>,
    next: Vec<Course>,
    /// How near the end of each part was passed, and when.
    ends: Vec<(f64, f64)>,
    /// Largest distance of a row from the nearest part, and as a share of the tolerance there.
    pub(super) away: Peak,
    pub(super) share: Peak,
    last: Option<Row>,
}

/// What was found along the whole path.
pub(super) struct Found {
    /// What is outside, in the order of time.
    pub(super) outside: Vec<Outside>,
    /// How many more rows or ends are.
    pub(super) more: u64,
    /// How far from an end the motion passed at most, by its share of the tolerance, and that share.
    pub(super) corner: Peak,
    pub(super) corner_share: Peak,
}

impl Track {
    /// Where the path has come to.
    pub(super) fn place(&self) -> Option<Place> {
        let least = |one: &&Course, two: &&Course| one.excess.total_cmp(&two.excess);
        let part = self.courses.iter().min_by(least)?.part;
        Some(self.parts.get(part)?.place)
    }

    /// First and last part on which the newest row may be.
    pub(super) fn span(&self) -> Option<(usize, usize)> {
        Some((self.courses.first()?.part, self.courses.last()?.part))
    }

    /// The smallest tolerance of the parts from the first on which a row may have been to the last on which
    /// the newest may be; infinite where there are only moves of axes, whose limits are all there is to show.
    pub(super) fn finest(&self, before: Option<(usize, usize)>) -> f64 {
        let (first, last) = self.span().unwrap_or_default();
        let first = before.map_or(first, |(first, _)| first);
        let parts = self.parts.get(first..=last).unwrap_or_default().iter();
        let of_tool = parts.filter(|part| !part.is_of_axes());
        of_tool
            .map(|part| part.at_end)
            .fold(f64::INFINITY, f64::min)
    }

    /// Takes the next row.
    pub(super) fn advance(&mut self, row: &Row) {
        if self.parts.is_empty() {
            return;
        }
        if self.last.is_none() {
            self.courses.push(Course::default());
            self.ends = vec![(f64::INFINITY, 0.0); self.parts.len()];
        }
        self.last = Some(*row);
        let mut carried: Option<Course> = None;
        let mut least = f64::INFINITY;
        let mut likely = 0;
        let mut courses = std::mem::take(&mut self.courses).into_iter().peekable();
        let mut index = courses.peek().map_or(0, |course| course.part);
        while let Some(part) = self.parts.get(index) {
            let stayed = courses.next_if(|course| course.part == index);
            let Some(course) = least_of(carried.take(), stayed) else {
                break;
            };
            let here = course.clone().with(part, row);
            least = least.min(here.excess);
            likely += usize::from(here.excess <= least);
            self.next.push(here);
            let beyond = course.beyond(part, row);
            let far = beyond.excess > least + KEPT || likely >= MOST;
            if courses.peek().is_none() && far {
                break;
            }
            carried = Some(beyond);
            index += 1;
        }
        self.next.retain(|course| course.excess <= least + KEPT);
        self.courses = std::mem::take(&mut self.next);
        self.look(row, least);
    }

    /// Notes how near the parts are on which a row may be, and their ends.
    fn look(&mut self, row: &Row, least: f64) {
        let likely = |course: &&Course| course.excess <= least;
        let (Some(first), Some(last)) = (
            self.courses.iter().find(likely),
            self.courses.iter().rfind(likely),
        ) else {
            return;
        };
        let begin = first.part.saturating_sub(BESIDE);
        let end = (last.part + BESIDE + 1).min(self.parts.len());
        let mut nearest: Option<(f64, f64, &Part)> = None;
        for (part, passed) in self.parts[begin..end]
            .iter()
            .zip(&mut self.ends[begin..end])
        {
            let away = part.away(row);
            let share = away / part.tolerance;
            if nearest.is_none_or(|(least, ..)| share < least) {
                nearest = Some((share, away, part));
            }
            let at_end = part.passed(row);
            if at_end < passed.0 {
                *passed = (at_end, row.time);
            }
        }
        // Axes that go straight are compared with no tolerance.
        if let Some((share, away, part)) = nearest
            && !part.is_of_axes()
        {
            let place = part.place;
            self.raise(share, away, row.time, place);
        }
    }

    fn raise(&mut self, share: f64, value: f64, time: f64, place: Place) {
        if share > self.share.value {
            self.share.raise(share, time, place);
            self.away = Peak { value, time, place };
        }
    }

    /// What was found, once all rows were seen: what is left of the path is passed at the last of them.
    pub(super) fn finish(&mut self) -> Found {
        let mut found = Found {
            outside: Vec::new(),
            more: 0,
            corner: Peak::default(),
            corner_share: Peak::default(),
        };
        let Some(row) = self.last else {
            return found;
        };
        let mut carried: Option<Course> = None;
        let mut courses = std::mem::take(&mut self.courses).into_iter().peekable();
        let mut index = courses.peek().map_or(0, |course| course.part);
        while let Some(part) = self.parts.get(index) {
            let stayed = courses.next_if(|course| course.part == index);
            let Some(course) = least_of(carried.take(), stayed) else {
                break;
            };
            if self.ends[index].0.is_infinite() {
                self.ends[index] = (part.passed(&row), row.time);
            }
            carried = Some(course.beyond(part, &row));
            index += 1;
        }
        let course = carried.unwrap_or_default();
        let mut told = course.told.as_ref();
        while let Some(one) = told {
            found.outside.push(one.last);
            told = one.before.as_ref();
        }
        found.outside.reverse();
        let kept = u64::try_from(found.outside.len()).unwrap_or(u64::MAX);
        found.more = course.counts.iter().sum::<u64>().saturating_sub(kept);
        for outside in &found.outside {
            let (value, time) = (outside.value, outside.time);
            if outside.at_end {
                let end = &mut self.ends[outside.part];
                if value > end.0 {
                    *end = (value, time);
                }
            } else {
                let part = &self.parts[outside.part];
                if !part.is_of_axes() {
                    let (share, place) = (value / part.tolerance, part.place);
                    self.raise(share, value, time, place);
                }
            }
        }
        for (part, &(value, time)) in self.parts.iter().zip(&self.ends) {
            let share = value / part.at_end;
            if share.is_finite() && share > found.corner_share.value {
                let place = part.place;
                found.corner_share.raise(share, time, place);
                found.corner = Peak { value, time, place };
            }
        }
        found
    }
}

/// The way along with less outside: of two that are as good, the one that has gone farther.
fn least_of(carried: Option<Course>, stayed: Option<Course>) -> Option<Course> {
    match (carried, stayed) {
        (Some(carried), Some(stayed)) if carried.excess < stayed.excess => Some(carried),
        (carried, stayed) => stayed.or(carried),
    }
}

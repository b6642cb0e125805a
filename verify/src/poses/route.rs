//! Keeps the legs that the pose judge still needs, and the motion at their ends.
//!
//! Source: legs are forgotten once the motion has gone past them. Not here: judging.

use crate::report::Place;
use std::collections::VecDeque;
use toolglide_kinematics::PoseFeed;
use toolglide_kinematics::{PoseLeg, PosePath};

/// The end of a leg, and how near the motion came to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waypoint {
    pub(super) place: Place,
    /// Tolerances of the corner: the smaller of both legs; none where there is no corner.
    pub(super) tolerances: Option<(f64, f64)>,
    /// Closest approach of the tip, and when.
    pub(super) tip: (f64, f64),
    /// Closest approach of the orientation, and when.
    pub(super) orientation: (f64, f64),
    pub(super) stopped: bool,
    pub(super) rested: f64,
}

/// A window of legs, counted from the start of the path.
#[derive(Debug, Default)]
pub(super) struct Route {
    legs: VecDeque<(PoseLeg, Waypoint)>,
    base: u32,
    finished: bool,
    last: Place,
}

impl Route {
    pub(super) fn expect(&mut self, leg: PoseLeg) {
        let place = Place {
            mv: self.len(),
            line: leg.line,
        };
        let tolerances = (
            leg.tip_tolerance.length(),
            leg.orientation_tolerance.angle(),
        );
        let is_tool = leg.tip().is_some();
        if is_tool
            && let Some((_, before)) = self.legs.back_mut()
            && let Some(smaller) = &mut before.tolerances
        {
            smaller.0 = smaller.0.min(tolerances.0);
            smaller.1 = smaller.1.min(tolerances.1);
        }
        self.legs.push_back((
            leg,
            Waypoint {
                place,
                tolerances: is_tool.then_some(tolerances),
                tip: (f64::INFINITY, 0.0),
                orientation: (f64::INFINITY, 0.0),
                stopped: false,
                rested: 0.0,
            },
        ));
    }

    /// How many legs the path has so far, the forgotten ones included.
    pub(super) fn len(&self) -> u32 {
        let kept = u32::try_from(self.legs.len()).unwrap_or(u32::MAX);
        self.base.saturating_add(kept)
    }

    fn index(&self, number: u32) -> usize {
        usize::try_from(number.saturating_sub(self.base)).unwrap_or(usize::MAX)
    }

    pub(super) fn get(&self, number: u32) -> Option<&PoseLeg> {
        self.legs.get(self.index(number)).map(|(leg, _)| leg)
    }

    pub(super) fn place(&self, number: u32) -> Place {
        self.legs
            .get(self.index(number))
            .map_or(self.last, |(_, end)| end.place)
    }

    /// Visits the legs of a range, ends included, with their numbers.
    pub(super) fn each(&self, first: u32, last: u32, mut visit: impl FnMut(u32, &PoseLeg)) {
        for number in first.max(self.base)..=last {
            if let Some(leg) = self.get(number) {
                visit(number, leg);
            }
        }
    }

    /// Visits the ends of the legs of a range.
    pub(super) fn each_end(
        &mut self,
        first: u32,
        last: u32,
        mut visit: impl FnMut(&PoseLeg, &mut Waypoint),
    ) {
        for number in first.max(self.base)..=last {
            let index = self.index(number);
            if let Some((leg, end)) = self.legs.get_mut(index) {
                visit(leg, end);
            }
        }
    }

    /// Forgets the first leg when it is before `until`.
    pub(super) fn close(&mut self, until: u32) -> Option<(PoseLeg, Waypoint)> {
        if self.base >= until {
            return None;
        }
        let (leg, end) = self.legs.pop_front()?;
        self.base = self.base.saturating_add(1);
        self.finished = end.stopped;
        self.last = end.place;
        Some((leg, end))
    }

    /// The last leg, unless the motion came to rest at its end.
    pub(super) fn last_unfinished(&self) -> Option<Place> {
        (self.base > 0 && !self.finished).then_some(self.last)
    }
}

/// Largest speed of the tool tip on a leg, mm/s; infinite for a rapid and zero for a dwell.
pub(super) fn feedrate(leg: &PoseLeg) -> f64 {
    match (&leg.path, leg.feed) {
        (PosePath::Dwell { .. }, _) => 0.0,
        (_, PoseFeed::Rapid) => f64::INFINITY,
        (_, PoseFeed::Speed(feedrate)) => feedrate.speed(),
        (_, PoseFeed::Duration(duration)) => leg.length() / duration,
    }
}

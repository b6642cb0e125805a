//! Chooses the fastest way through a stretch.
//!
//! Source: ours. From rest to rest there are corners, superposed corners, and, where there are arcs, each
//! move by itself, which is what full stops would be; one of these is the measure of going on without a
//! rest. Not here: the plans.

use super::travel::Entry;
use super::{Stretches, is_tiny};
use crate::lookahead::corners::Corners;
use crate::segment::Segment;
use crate::segment_merger::vertex_of;

/// Fewest legs of a stretch worth trying with superposed corners.
pub(super) const MIN_LEGS: usize = 4;

/// A plan this near to the least conceivable time is not improved.
const GOOD_ENOUGH: f64 = 1.02;

/// How much faster than the plan by corners a stretch at the feedrate would have to be.
const WORTH_TRYING: f64 = 0.996;

/// How much longer than its way at the feedrate, with a start and a stop, a stretch with arcs takes that need not be
/// planned in other ways.
const NEAR: f64 = 1.004;
const NEAR_STOPS: f64 = 0.25;

/// The same for one that is not planned with shorter time steps.
const ENOUGH: f64 = 1.001;
const ENOUGH_STOPS: f64 = 0.08;

/// How much longer than its way at the feedrate a stretch of tiny arcs takes at the most that is planned in one way only.
const HOPELESS: f64 = 6.0;

/// How much longer smooth motion along arcs may take than corners at their chords.
const SMOOTH: f64 = 1.002;

/// Most chords of arcs at which corners are tried though there is a smooth way.
const FEW_CHORDS: usize = 128;

/// Share of the time that a start and a stop take along the path that they take in any direction.
const ANY_DIRECTION: f64 = 0.55;

/// The moves of some legs.
fn moves_of<const N: usize>(legs: &[Segment<N>]) -> impl Iterator<Item = &[Segment<N>]> {
    legs.chunk_by(|leg, next| !leg.ends_before(next))
}

/// Least time of these legs with a rest at the end of each move.
fn least_apart<const N: usize>(legs: &[Segment<N>]) -> f64 {
    moves_of(legs).map(least_alone).sum()
}

/// No way from rest to rest takes less along these legs within their tolerance: inside of all turns the way is
/// shorter by the tolerance for each radian, and speed is gained at the most as if all axes helped.
pub(super) fn least_alone<const N: usize>(legs: &[Segment<N>]) -> f64 {
    let ideal = Ideal::of(legs);
    let length: f64 = legs.iter().map(|leg| leg.length).sum();
    let corners = legs.windows(2).map(|pair| {
        let turn = (pair[1].entry() - pair[0].exit()).norm();
        1.6 * turn * pair[0].tolerance.length()
    });
    let bends = legs.iter().filter_map(|leg| {
        let angle = leg.bend?.angle();
        Some(angle * leg.tolerance.length())
    });
    let saved = corners.chain(bends).sum::<f64>();
    ideal.at_feedrate * (1.0 - saved / length).max(0.0) + ANY_DIRECTION * ideal.stop
}

/// Whether any of some legs belongs to an arc.
pub(super) fn has_arc<const N: usize>(legs: &[Segment<N>]) -> bool {
    legs.iter().any(|leg| leg.bend.is_some())
}

/// How a stretch is travelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Choice {
    /// Corner by corner, without a rest before it.
    Corners(Material),
    /// Corner by corner, after a rest.
    Afresh,
    /// With superposed corners, after a rest or entered at speed.
    Superposed(Option<Entry>),
    /// Each move by itself, from rest to rest.
    Apart,
}

/// What corners are made of. Merging takes the path as it comes, and which of both merges better is chance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Material {
    /// The vertices as programmed, and chords of arcs.
    Vertices,
    /// The legs of the stretch, which have been cleaned.
    Legs,
}

/// What a stretch would take without corners.
pub(super) struct Ideal {
    /// The whole way at the feedrate.
    pub(super) at_feedrate: f64,
    /// Starting at one end and stopping at the other.
    pub(super) stop: f64,
}

impl Ideal {
    pub(super) fn of<const N: usize>(legs: &[Segment<N>]) -> Self {
        let at_feedrate = legs
            .iter()
            .map(|leg| leg.length / leg.limits.velocity)
            .sum();
        let length: f64 = legs.iter().map(|leg| leg.length).sum();
        let ends = [legs.first(), legs.last()];
        // Half of a start or a stop is lost against passing at speed.
        let stop = ends
            .iter()
            .flatten()
            .map(|leg| {
                0.5 * leg
                    .limits
                    .time_to_change(leg.limits.reachable_within(length))
            })
            .sum();
        Self { at_feedrate, stop }
    }

    /// Whether a plan from rest to rest is hardly longer.
    fn is_near(&self, duration: f64) -> bool {
        duration <= NEAR * (self.at_feedrate + self.stop) + NEAR_STOPS * self.stop
    }
}

impl<const N: usize> Stretches<N> {
    /// How a stretch is travelled fastest. With superposed corners it is planned when that is chosen.
    pub(super) fn decide(&mut self, legs: &[Segment<N>]) -> Choice {
        let arcs = has_arc(legs);
        if self.forced && !arcs {
            return Choice::Corners(Material::Vertices);
        }
        // Where corners merge only lines, stopping at each is among their ways.
        let certain = !self.watched && !arcs;
        if certain && legs.len() < MIN_LEGS {
            return Choice::Corners(Material::Vertices);
        }
        let (choice, least) = self.choose(legs);
        if !self.corners.has_begun() {
            return choice;
        }
        let certain = certain && matches!(choice, Choice::Corners(_));
        if certain && self.is_clean(legs) {
            return Choice::Corners(Material::Vertices);
        }
        if certain {
            return Choice::Corners(self.going_on(legs).1);
        }
        let entering = match choice {
            Choice::Superposed(_) => self.plan_entering(legs),
            _ => None,
        };
        let entering = match entering {
            Some((_, duration)) if self.is_slower_than_resting(legs, duration) => {
                return Choice::Afresh;
            }
            entering => entering,
        };
        let (choice, apart) = match (entering, choice) {
            (Some((entry, duration)), _) => (Choice::Superposed(Some(entry)), duration),
            _ if self.corners.is_cruising() => (Choice::Afresh, self.resting_behind(legs)),
            (None, Choice::Corners(_)) => (Choice::Afresh, self.resting() + least),
            (None, choice) => (choice, self.resting() + least),
        };
        let slack = if arcs && matches!(choice, Choice::Superposed(_)) {
            let ideal = Ideal::of(legs);
            let near = entering.is_some() && ideal.is_near(least);
            if near || self.vertices.chords(legs) > FEW_CHORDS {
                return choice;
            }
            (SMOOTH - 1.0) * least
        } else {
            0.0
        };
        let (going_on, material) = self.going_on(legs);
        if going_on <= apart - slack {
            Choice::Corners(material)
        } else {
            choice
        }
    }

    /// Time to rest before a stretch.
    fn resting(&mut self) -> f64 {
        self.trial.follow(&self.corners);
        self.trial.time_to_rest([])
    }

    /// The same to rest behind its first leg, in the middle of which the motion cruises, and then through the others.
    fn resting_behind(&mut self, legs: &[Segment<N>]) -> f64 {
        let (lead, others) = legs.split_at(1.min(legs.len()));
        self.trial.follow(&self.corners);
        let resting = self.trial.time_to_rest(self.vertices.of(lead));
        resting + self.choose(others).1
    }

    /// Whether a stretch with arcs that is entered at speed, where the motion cruises already, takes longer than a rest
    /// behind its first leg. What has been planned for it is planned again where that had to be tried.
    fn is_slower_than_resting(&mut self, legs: &[Segment<N>], duration: f64) -> bool {
        if !(self.corners.is_cruising() && has_arc(legs)) {
            return false;
        }
        let (lead, others) = legs.split_at(1.min(legs.len()));
        self.trial.follow(&self.corners);
        let resting = self.trial.time_to_rest(self.vertices.of(lead));
        if duration <= resting + least_apart(others) {
            return false;
        }
        if resting + self.choose(others).1 < duration {
            return true;
        }
        self.choose(legs);
        self.plan_entering(legs).is_none()
    }

    /// How a stretch is travelled fastest from rest to rest, and its duration. With superposed corners it
    /// is planned when that is chosen.
    pub(super) fn choose(&mut self, legs: &[Segment<N>]) -> (Choice, f64) {
        if has_arc(legs) {
            return self.choose_round(legs);
        }
        let (by_corners, material) = self.by_corners(legs);
        match self.superpose(legs, by_corners) {
            Some(duration) => (Choice::Superposed(None), duration),
            None => (Choice::Corners(material), by_corners),
        }
    }

    /// The same for a stretch with arcs: smoothly, unless another way is clearly faster.
    fn choose_round(&mut self, legs: &[Segment<N>]) -> (Choice, f64) {
        let ideal = Ideal::of(legs);
        let conceivable = ideal.at_feedrate + ideal.stop;
        let enough = ENOUGH * conceivable + ENOUGH_STOPS * ideal.stop;
        let apart = if moves_of(legs).nth(1).is_some() {
            least_apart(legs)
        } else {
            f64::INFINITY
        };
        let smooth = self.plan_smoothly(legs, enough);
        let settled = smooth.is_some_and(|duration| {
            legs.iter().all(is_tiny)
                || ideal.is_near(duration)
                || self.vertices.chords(legs) > FEW_CHORDS
        });
        let by_corners = if settled {
            f64::INFINITY
        } else {
            self.by_corners(legs).0
        };
        let smooth = smooth.filter(|duration| *duration <= SMOOTH * by_corners);
        let least = smooth.unwrap_or(by_corners);
        if apart < least {
            let apart = self.apart(legs, least);
            if apart < least {
                return (Choice::Apart, apart);
            }
            // The plans of the moves have taken the place of this one.
            if smooth.is_some() {
                self.plan_smoothly(legs, enough);
            }
        }
        match smooth {
            Some(duration) => (Choice::Superposed(None), duration),
            None => (Choice::Corners(Material::Vertices), by_corners),
        }
    }

    /// Plans a stretch with arcs superposed from rest to rest; its duration.
    fn plan_smoothly(&mut self, legs: &[Segment<N>], enough: f64) -> Option<f64> {
        if legs.iter().all(is_tiny) {
            self.superposer.plan_tiny(legs, HOPELESS * enough)
        } else {
            self.superposer.plan_round(legs, enough)
        }
    }

    /// Time that the moves of some legs take, each from rest to rest, as far as that is less than `most`.
    ///
    /// Stops are among the choices at every corner, but not inside an arc.
    fn apart(&mut self, legs: &[Segment<N>], most: f64) -> f64 {
        let mut apart = 0.0;
        for group in moves_of(legs) {
            apart += self.choose(group).1;
            if apart >= most {
                break;
            }
        }
        apart
    }

    /// Plans a stretch with superposed corners; its duration, when that is worth while and less than
    /// `most`.
    fn superpose(&mut self, legs: &[Segment<N>], most: f64) -> Option<f64> {
        if legs.len() < MIN_LEGS {
            return None;
        }
        let ideal = Ideal::of(legs);
        if ideal.at_feedrate + ideal.stop > WORTH_TRYING * most {
            return None;
        }
        self.superposer
            .plan(legs, GOOD_ENOUGH * ideal.at_feedrate, most)
    }

    /// Duration of a stretch planned corner by corner from rest to rest, and of what.
    pub(super) fn by_corners(&mut self, legs: &[Segment<N>]) -> (f64, Material) {
        let start = legs.first().map_or(self.end, |first| first.start);
        self.quicker(legs, |trial, _| trial.restart(start))
    }

    /// The same after the corners under way, from when they began.
    fn going_on(&mut self, legs: &[Segment<N>]) -> (f64, Material) {
        self.quicker(legs, Corners::follow)
    }

    fn quicker(
        &mut self,
        legs: &[Segment<N>],
        prepare: impl Fn(&mut Corners<N>, &Corners<N>),
    ) -> (f64, Material) {
        let clean = has_arc(legs) || self.is_clean(legs);
        let Self {
            trial,
            corners,
            vertices,
            ..
        } = self;
        prepare(trial, corners);
        let of_vertices = trial.time_to_rest(vertices.of(legs));
        if !clean {
            prepare(trial, corners);
            let of_legs = trial.time_to_rest(legs.iter().map(vertex_of));
            if of_legs < of_vertices {
                return (of_legs, Material::Legs);
            }
        }
        (of_vertices, Material::Vertices)
    }

    /// Whether the legs are the vertices.
    fn is_clean(&self, legs: &[Segment<N>]) -> bool {
        self.vertices.count(legs) == legs.len()
    }

    /// Plans the corners of a stretch after those under way.
    pub(super) fn turn(&mut self, legs: &[Segment<N>], material: Material) {
        let Self {
            corners, vertices, ..
        } = self;
        match material {
            Material::Vertices => vertices.of(legs).for_each(|vertex| corners.push(vertex)),
            Material::Legs => legs.iter().for_each(|leg| corners.push(vertex_of(leg))),
        }
    }
}

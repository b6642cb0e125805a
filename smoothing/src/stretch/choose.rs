//! Chooses the fastest way through a stretch.
//!
//! Source: ours. From rest to rest there are corners, superposed corners, and, where there are arcs, each
//! move by itself, which is what full stops would be; one of these is the measure of going on without a
//! rest. Not here: the plans.

use super::Stretches;
use super::travel::Entry;
use crate::lookahead::corners::Corners;
use crate::segment::Segment;
use crate::segment_merger::vertex_of;

/// Fewest legs of a stretch worth trying with superposed corners.
pub(super) const MIN_LEGS: usize = 4;

/// How much faster than the plan by corners a stretch at the feedrate would have to be.
const WORTH_TRYING: f64 = 0.996;

/// How much longer than its way at the feedrate, with a start and a stop, a stretch with arcs takes that need not be
/// planned in other ways.
const NEAR: f64 = 1.001;

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
fn least_alone<const N: usize>(legs: &[Segment<N>]) -> f64 {
    let ideal = Ideal::of(legs);
    let length: f64 = legs.iter().map(|leg| leg.length).sum();
    let saved: f64 = legs
        .windows(2)
        .map(|pair| {
            let turn = (pair[1].direction - pair[0].direction).norm();
            1.6 * turn * pair[0].tolerance.length()
        })
        .sum();
    ideal.at_feedrate * (1.0 - saved / length).max(0.0) + ANY_DIRECTION * ideal.stop
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
    /// The vertices as programmed, with few chords of arcs.
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
}

impl<const N: usize> Stretches<N> {
    /// How a stretch is travelled fastest. With superposed corners it is planned when that is chosen.
    pub(super) fn decide(&mut self, legs: &[Segment<N>]) -> Choice {
        // Where corners merge only lines, stopping at each is among their ways.
        let certain = !self.watched && !self.has_arc(legs);
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
        let (going_on, material) = self.going_on(legs);
        if certain {
            return Choice::Corners(material);
        }
        let entering = match choice {
            Choice::Superposed(_) => self.plan_entering(legs),
            _ => None,
        };
        let (choice, apart) = match (entering, choice) {
            (Some((entry, duration)), _) => (Choice::Superposed(Some(entry)), duration),
            _ if self.corners.is_cruising() => (Choice::Afresh, self.resting_behind(legs)),
            (None, Choice::Corners(_)) => (Choice::Afresh, self.resting() + least),
            (None, choice) => (choice, self.resting() + least),
        };
        if going_on <= apart {
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

    /// How a stretch is travelled fastest from rest to rest, and its duration. With superposed corners it
    /// is planned when that is chosen.
    pub(super) fn choose(&mut self, legs: &[Segment<N>]) -> (Choice, f64) {
        if self.has_arc(legs) {
            let ideal = Ideal::of(legs);
            let most = (NEAR * (ideal.at_feedrate + ideal.stop)).min(least_apart(legs));
            if legs.len() >= MIN_LEGS
                && let Some(duration) = self.superposer.plan(legs, ideal.at_feedrate, most)
            {
                return (Choice::Superposed(None), duration);
            }
        }
        let (mut choice, mut least) = self.without_superposing(legs);
        if let Some(duration) = self.superpose(legs, least) {
            (choice, least) = (Choice::Superposed(None), duration);
        }
        (choice, least)
    }

    /// The same without superposed corners for the whole of it.
    pub(super) fn without_superposing(&mut self, legs: &[Segment<N>]) -> (Choice, f64) {
        let (by_corners, material) = self.by_corners(legs);
        // Stops are among the choices at every corner, but not inside an arc, which begins and ends
        // afresh where the motion stops beside it.
        let several = legs.windows(2).any(|pair| pair[0].ends_before(&pair[1]));
        if several && self.has_arc(legs) && least_apart(legs) < by_corners {
            let mut apart = 0.0;
            for group in moves_of(legs) {
                apart += self.alone(group);
                if apart >= by_corners {
                    break;
                }
            }
            if apart < by_corners {
                return (Choice::Apart, apart);
            }
        }
        (Choice::Corners(material), by_corners)
    }

    /// Duration of a move, or of lines that are merged into one leg, from rest to rest.
    fn alone(&mut self, legs: &[Segment<N>]) -> f64 {
        let (by_corners, _) = self.by_corners(legs);
        self.superpose(legs, by_corners).unwrap_or(by_corners)
    }

    /// Whether any of the legs belongs to an arc.
    pub(super) fn has_arc(&self, legs: &[Segment<N>]) -> bool {
        self.vertices.of(legs).any(|vertex| vertex.bulge > 0.0)
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
        self.superposer.plan(legs, ideal.at_feedrate, most)
    }

    /// Duration of a stretch planned corner by corner from rest to rest, and of what.
    fn by_corners(&mut self, legs: &[Segment<N>]) -> (f64, Material) {
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
        let clean = self.is_clean(legs);
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
        self.vertices.of(legs).len() == legs.len()
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

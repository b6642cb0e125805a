//! Merges short moves into longer straight segments inside the tolerance, as they stream in.
//!
//! Source: ours; section 3.3 of the dissertation takes short moves as they come. A straight line may
//! replace a run of moves when every corner it leaves out lies within a share of the tolerance of it;
//! by continuity the whole run then lies near the line and the line near the run. What a merged move
//! uses of the tolerance is measured, and the corners at its ends get the rest.
//!
//! From rest to rest a leg takes no longer than the moves that it serves, stopping at each. A move needs
//! `1/V + V/A + A/J` for some `V` and `A` at most what each axis, and the feedrate, leave of it; written
//! with the reciprocals of what they leave that is `v + a/v + j/a`, its three terms are no larger for two
//! moves together than for both added, and the reciprocals are norms of the move, so they are no
//! larger for the straight line than for both moves added. Not here: motion.

use crate::bend::Bend;
use crate::segment::Segment;
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{Limits, MoveRange, Pause, Tolerance, Vector};

/// Share of the tolerance within which merged moves count as straight: rounding of their ends.
pub(crate) const STRAIGHT_SHARE: f64 = 1e-6;

/// Share of the tolerance that merging and chords may use. On a curve of radius `R`, chords of length
/// `c` lie `c^2 / 8R` off and corners that fill the chords cut `c^2 / 12R`: three parts to two.
pub const MERGE_SHARE: f64 = 0.6;

/// Share of the tolerance that merging may use where moves are to be taken as they come: enough to
/// drop moves that are nothing but rounding.
pub const ROUNDING_SHARE: f64 = 0.001;

/// Length of moves that may be slowed to the feedrate of the moves that they are merged with, as a
/// share of the tolerance: less than a micrometre where parts are machined.
const NEGLIGIBLE: f64 = 0.01;

/// Length of a leg to which no moves straight on are added, as a multiple of what it would be at its velocity while that is
/// reached: twice what a stop and a start take.
const LONG: f64 = 4.0;

/// Share by which the feedrates of moves that are merged may differ, as inverse time and rounding make them: the
/// lowest counts for all.
const ALIKE: f64 = 1e-3;

/// Most moves merged into one: bounds memory and the work a move. Where it cuts a straight line, there
/// is a corner more than the tolerance asks for.
pub(crate) const MAX_MERGED: usize = 1024;

/// The end of a straight stretch of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex<const N: usize> {
    /// Where it is.
    pub point: Vector<N>,
    /// How far the programmed path may lie from the straight stretch that ends here.
    pub bulge: f64,
    /// The arc whose chord ends here, where the motion is to follow it.
    pub bend: Option<Bend<N>>,
    /// Feedrate of the stretch, mm/s.
    pub feedrate: f64,
    /// Tolerance of the stretch.
    pub tolerance: Tolerance,
    /// The moves that the stretch serves.
    pub serves: MoveRange,
    /// Number of the next one among the vertices that corners are made of, see [`Segment::vertices`].
    pub next: u64,
}

/// The vertex at the end of a leg, which stands for all that the leg serves.
pub(crate) fn vertex_of<const N: usize>(leg: &Segment<N>) -> Vertex<N> {
    Vertex {
        point: leg.end,
        bulge: leg.deviation,
        bend: leg.bend,
        feedrate: leg.feedrate,
        tolerance: leg.tolerance,
        serves: leg.serves,
        next: leg.vertices[1],
    }
}

/// Merges vertices into legs.
#[derive(Clone, Debug)]
pub struct SegmentMerger<const N: usize> {
    limits: Limits<N>,
    share: f64,
    anchor: Vector<N>,
    run: Vec<Vertex<N>>,
    /// What bounds the run as a whole; `None` when it is empty.
    bounds: Option<Bounds>,
    /// Largest distance of the run from its line.
    deviation: f64,
    /// Time that its moves take from rest to rest; 0 while that has not been asked for.
    apart: f64,
    carried: Option<Carried<N>>,
    /// Number of the first vertex that no leg has served.
    first: u64,
}

/// What the vertices of a run have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds {
    slowest: f64,
    fastest: f64,
    tolerance: Tolerance,
    bulge: f64,
}

impl Bounds {
    fn of<const N: usize>(vertex: &Vertex<N>) -> Self {
        Self {
            slowest: vertex.feedrate,
            fastest: vertex.feedrate,
            tolerance: vertex.tolerance,
            bulge: vertex.bulge,
        }
    }

    fn with<const N: usize>(self, vertex: &Vertex<N>) -> Self {
        Self {
            slowest: self.slowest.min(vertex.feedrate),
            fastest: self.fastest.max(vertex.feedrate),
            tolerance: self.tolerance.min(vertex.tolerance),
            bulge: self.bulge.max(vertex.bulge),
        }
    }
}

/// Moves that led nowhere and wait for a leg to serve them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Carried<const N: usize> {
    serves: MoveRange,
    /// How far they strayed.
    deviation: f64,
    /// How far the motion may be from them.
    tolerance: Tolerance,
    /// Where they ended: the anchor, but for rounding.
    end: Vector<N>,
    /// Number of the next vertex.
    next: u64,
}

impl<const N: usize> SegmentMerger<N> {
    /// A merger that may use a share of the tolerance.
    #[must_use]
    pub fn new(start: Vector<N>, limits: Limits<N>, share: f64) -> Self {
        Self {
            limits,
            share,
            anchor: start,
            run: Vec::with_capacity(MAX_MERGED + 1),
            bounds: None,
            deviation: 0.0,
            apart: 0.0,
            carried: None,
            first: 0,
        }
    }

    /// Becomes a copy of another.
    pub(crate) fn follow(&mut self, other: &Self) {
        self.limits = other.limits;
        self.share = other.share;
        self.anchor = other.anchor;
        self.run.clone_from(&other.run);
        self.bounds = other.bounds;
        self.deviation = other.deviation;
        self.apart = other.apart;
        self.carried = other.carried;
        self.first = other.first;
    }

    /// Begins again at rest at `start`.
    pub(crate) fn restart(&mut self, start: Vector<N>) {
        self.anchor = start;
        self.run.clear();
        self.bounds = None;
        self.deviation = 0.0;
        self.apart = 0.0;
        self.carried = None;
    }

    /// Takes the next vertex; gives the leg that it completes.
    pub fn push(&mut self, vertex: Vertex<N>) -> Option<Segment<N>> {
        if self.run.is_empty() && (vertex.point - self.anchor).norm() <= SHORTEST_LENGTH {
            self.carry(&vertex, vertex.serves, vertex.bulge);
            return None;
        }
        let mut leg = None;
        match self.deviation_with(&vertex) {
            Some(deviation) => self.deviation = deviation,
            None => {
                leg = self.flush();
                if (vertex.point - self.anchor).norm() <= SHORTEST_LENGTH {
                    self.carry(&vertex, vertex.serves, vertex.bulge);
                    return leg;
                }
                self.deviation = vertex.bulge;
            }
        }
        self.bounds = Some(match self.bounds {
            Some(bounds) => bounds.with(&vertex),
            None => Bounds::of(&vertex),
        });
        if self.apart > 0.0
            && let Some(before) = self.run.last()
        {
            self.apart += self.time_between(&before.point, &vertex.point, vertex.feedrate);
        }
        self.run.push(vertex);
        leg
    }

    /// Completes the leg under way, if there is one.
    pub fn flush(&mut self) -> Option<Segment<N>> {
        let (first, last) = (*self.run.first()?, *self.run.last()?);
        let bounds = self.bounds?;
        let span = last.point - self.anchor;
        let length = span.norm();
        let mut serves = MoveRange {
            first: first.serves.first,
            last: last.serves.last,
        };
        let mut deviation = self.deviation;
        let (feedrate, mut tolerance) = (bounds.slowest, bounds.tolerance);
        if let Some(carried) = self.carried.take() {
            serves.first = carried.serves.first;
            deviation = deviation.max(carried.deviation);
            tolerance = tolerance.min(carried.tolerance);
        }
        let single = self.run.len() == 1;
        self.run.clear();
        self.bounds = None;
        self.deviation = 0.0;
        self.apart = 0.0;
        if length <= SHORTEST_LENGTH {
            self.carry(&Vertex { tolerance, ..last }, serves, deviation);
            return None;
        }
        let direction = span / length;
        // A part of an arc is never merged.
        let bend = first.bend.filter(|_| single);
        let length = bend.map_or(length, |bend| bend.length());
        let mut limits = self.limits.along(&direction);
        limits.velocity = limits.velocity.min(feedrate);
        let leg = Segment {
            start: self.anchor,
            end: last.point,
            direction,
            length,
            bend,
            limits,
            feedrate,
            tolerance,
            deviation,
            serves,
            vertices: [self.first, last.next],
            stop: false,
            cruises: false,
            dwell: None,
        };
        self.anchor = last.point;
        self.first = last.next;
        Some(leg)
    }

    /// Moves that led nowhere and that no leg has served.
    pub fn take_carried(&mut self) -> Option<Pause<N>> {
        let carried = self.carried.take()?;
        self.first = carried.next;
        Some(Pause {
            duration: 0.0,
            serves: carried.serves,
            end: carried.end,
        })
    }

    /// Whether moves that led nowhere wait for a leg and would narrow one of this tolerance.
    pub(crate) fn narrows(&self, tolerance: Tolerance) -> bool {
        self.carried.is_some_and(|carried| {
            carried.deviation > 0.0 || carried.tolerance.length() < tolerance.length()
        })
    }

    /// Whether there are vertices that no leg has served.
    pub(crate) fn has_begun(&self) -> bool {
        !self.run.is_empty() || self.carried.is_some()
    }

    /// Number of the first vertex that no leg has served.
    pub(crate) fn first(&self) -> u64 {
        self.first
    }

    /// Where the last leg ended.
    #[must_use]
    pub fn anchor(&self) -> Vector<N> {
        self.anchor
    }

    /// Keeps moves that end at `last`, where they began.
    fn carry(&mut self, last: &Vertex<N>, serves: MoveRange, deviation: f64) {
        let mut carried = Carried {
            serves,
            deviation,
            tolerance: last.tolerance,
            end: last.point,
            next: last.next,
        };
        if let Some(before) = self.carried {
            carried.serves.first = before.serves.first;
            carried.deviation = deviation.max(before.deviation);
            carried.tolerance = carried.tolerance.min(before.tolerance);
        }
        self.carried = Some(carried);
    }

    /// Whether moves would lose time if `vertex` were merged, because another of the run has a lower
    /// feedrate: all but those so short that they would not get up to it between two stops. `bounds` are
    /// those of the run and the vertex.
    fn hurries(&mut self, vertex: &Vertex<N>, before: &Vertex<N>, bounds: &Bounds) -> bool {
        let feedrate = bounds.slowest;
        if feedrate >= bounds.fastest {
            return false;
        }
        if feedrate >= (1.0 - ALIKE) * bounds.fastest && self.saves(vertex, before, feedrate) {
            return false;
        }
        let mut hurried = 0.0;
        let mut add = |member: &Vertex<N>, from: &Vector<N>| {
            let span = member.point - from;
            let length = span.norm();
            if member.feedrate <= feedrate || length <= 0.0 {
                return true;
            }
            hurried += length;
            let reached = self.limits.along(&(span / length)).reachable_within(length);
            hurried <= NEGLIGIBLE * bounds.tolerance.length() && reached <= feedrate
        };
        let mut from = self.anchor;
        for member in &self.run {
            if !add(member, &from) {
                return true;
            }
            from = member.point;
        }
        !add(vertex, &before.point)
    }

    /// Whether a straight run up to its last vertex is so long that nothing is gained by more: the plan can be divided
    /// on it.
    fn is_long(&self, last: &Vertex<N>, feedrate: f64) -> bool {
        let span = last.point - self.anchor;
        let length = span.norm();
        if length <= 0.0 {
            return false;
        }
        let limits = self.limits.along(&(span / length));
        let speed = feedrate.min(limits.velocity);
        length > LONG * speed * limits.time_to_change(speed)
    }

    /// Whether the run with a vertex takes no longer at a feedrate, as one, than all its moves at their own, from
    /// rest to rest.
    fn saves(&mut self, vertex: &Vertex<N>, before: &Vertex<N>, feedrate: f64) -> bool {
        if self.apart <= 0.0 {
            let mut from = self.anchor;
            for index in 0..self.run.len() {
                let member = self.run[index];
                self.apart += self.time_between(&from, &member.point, member.feedrate);
                from = member.point;
            }
        }
        let own = self.time_between(&before.point, &vertex.point, vertex.feedrate);
        self.time_between(&self.anchor, &vertex.point, feedrate) <= self.apart + own
    }

    /// Time from rest to rest between two points.
    fn time_between(&self, from: &Vector<N>, to: &Vector<N>, feedrate: f64) -> f64 {
        let span = to - from;
        let length = span.norm();
        if length <= 0.0 {
            return 0.0;
        }
        let limits = self.limits.along(&(span / length));
        let ramp = limits.acceleration / limits.jerk;
        let knee = limits.acceleration * ramp;
        let mut speed = (0.25 * limits.jerk * length * length).cbrt();
        if speed > knee {
            let square = ramp * ramp + 4.0 * length / limits.acceleration;
            speed = 0.5 * limits.acceleration * (square.sqrt() - ramp);
        }
        let speed = speed.min(limits.velocity).min(feedrate);
        length / speed + limits.time_to_change(speed)
    }

    /// Largest distance of the run from a line to `vertex`, or `None` when it cannot be merged.
    fn deviation_with(&mut self, vertex: &Vertex<N>) -> Option<f64> {
        let (Some(&before), Some(bounds)) = (self.run.last(), self.bounds) else {
            return Some(vertex.bulge);
        };
        if self.run.len() >= MAX_MERGED || before.bend.is_some() || vertex.bend.is_some() {
            return None;
        }
        let run = (before, bounds.slowest);
        let bounds = bounds.with(vertex);
        if self.hurries(vertex, &before, &bounds) {
            return None;
        }
        let budget = (self.share * bounds.tolerance.length() - bounds.bulge).max(0.0);
        let span = vertex.point - self.anchor;
        let square = span.norm_squared();
        let mut furthest = 0.0_f64;
        for member in &self.run {
            let offset = member.point - self.anchor;
            let share = if square > 0.0 {
                (offset.dot(&span) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            furthest = furthest.max((offset - span * share).norm_squared());
            if furthest > budget * budget {
                return None;
            }
        }
        let deviation = furthest.sqrt() + bounds.bulge;
        let straight = deviation <= STRAIGHT_SHARE * budget;
        (!(straight && self.is_long(&run.0, run.1))).then_some(deviation)
    }
}

//! How fast a stretch may be travelled, and the jerk-limited progress along it.
//!
//! Source: ours. At constant speed the filtered motion through a place of the curve has the second
//! and third differences of the points around it for acceleration and jerk, so the speed that a place
//! allows is found by trying; the rest of the limits is left to changes of speed, which the look-ahead
//! window plans as if the stretch were straight. What comes out is a proposal, judged elsewhere.

use super::curve::Curve;
use super::spline::Excess;
use crate::turn::TurnShape;
use crate::window::{Link, Window};
use toolglide_kinematics::numeric::LIMIT_SLACK;
use toolglide_kinematics::{Limits, Tangential, Vector, largest_multiple};
use toolglide_profiles::{Connection, Feed, Profile, State};

/// Share of the acceleration that curvature may use.
const CURVATURE_ACCELERATION: f64 = 0.85;
/// Share of the jerk that changes of curvature may use.
const CURVATURE_JERK: f64 = 0.7;
/// Share of the tolerance that curvature may use.
const CURVATURE_TOLERANCE: f64 = 0.8;
/// Ratio of the speeds that are tried at a place.
const LADDER: f64 = 0.95;
/// Lowest speed tried, as a share of the feedrate.
const LOWEST: f64 = 0.01;
/// How much faster than a place allows the progress may be before it is held back there.
const EXCESS: f64 = 1.01;
/// Places whose speeds lie within this ratio are held as one.
const ALIKE: f64 = 0.9;
/// Places whose speeds lie within this ratio are travelled at the slowest of them.
const SAME: f64 = 0.99;
/// Rounds of holding the progress back.
const ROUNDS: usize = 6;
/// Share of the limits that changes of speed may use at the least.
const LEAST_REST: f64 = 0.35;
/// What a place is slowed by in one round beyond what its excess asks for.
const SLOWER: f64 = 0.995;
/// The most that a place is slowed by in one round.
const SLOWEST: f64 = 0.85;
/// Most instants at which one stretch is looked at.
const MOST_TICKS: f64 = 20_000.0;
/// Most places on one stretch.
pub(super) const MOST_PLACES: usize = 16_384;

/// How densely and how sharply a stretch is filtered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Filter {
    /// Time between two knots.
    pub(super) step: f64,
    /// Share of the second difference by which control points are moved outward, times six.
    pub(super) sharpening: f64,
}

/// A part of the stretch with the speed and the changes of speed that it allows.
#[derive(Clone, Copy, Debug)]
struct Place {
    end: f64,
    limits: Tangential,
    feedrate: f64,
    /// What its speed must be slowed by next, and its changes of speed.
    slower: f64,
    softer: f64,
}

/// Speeds along a stretch.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    /// Share of the feedrate that is used, and what it must be lowered by next.
    share: f64,
    lower: f64,
    places: Vec<Place>,
    /// Places at whose beginning the progress is held, without acceleration.
    holds: Vec<usize>,
    runs: Vec<(usize, usize)>,
    window: Window,
    links: Vec<Link>,
    turns: Vec<TurnShape>,
}

impl Pace {
    pub(super) fn new() -> Self {
        Self {
            share: 1.0,
            lower: 1.0,
            places: Vec::with_capacity(MOST_PLACES + 1),
            holds: Vec::with_capacity(MOST_PLACES + 1),
            runs: Vec::with_capacity(MOST_PLACES + 1),
            window: Window::new(MOST_PLACES, false),
            links: Vec::with_capacity(MOST_PLACES + 1),
            turns: Vec::with_capacity(MOST_PLACES + 1),
        }
    }

    /// Finds what each place of the curve allows at a share of the feedrate; `false` when there are too
    /// many.
    pub(super) fn survey<const N: usize>(
        &mut self,
        curve: &Curve<N>,
        limits: &Limits<N>,
        filter: &Filter,
        share: f64,
    ) -> bool {
        self.places.clear();
        self.holds.clear();
        self.share = share;
        self.lower = 1.0;
        let mut trial = Trial {
            curve,
            limits,
            filter,
            near: 0,
        };
        let mut last_speed = f64::INFINITY;
        for (index, leg) in curve.legs().iter().enumerate() {
            let feedrate = leg.limits.velocity * self.share;
            let spacing = 0.5 * feedrate * filter.step;
            let begin = curve.mark(index);
            let pieces = (leg.length / spacing).ceil().max(1.0);
            let width = leg.length / pieces;
            let mut piece = 0.0;
            while piece < pieces {
                // The middle of a long leg is far from any curvature.
                let straight = piece > 6.5 && pieces - piece > 8.5;
                let end = if straight {
                    let skipped = pieces - 8.0;
                    let end = begin + skipped * width;
                    piece = skipped;
                    end
                } else {
                    piece += 1.0;
                    begin + piece * width
                };
                let limits = if straight {
                    last_speed = feedrate;
                    Tangential {
                        velocity: feedrate,
                        ..leg.limits
                    }
                } else {
                    let start = self.places.last().map_or(0.0, |place: &Place| place.end);
                    trial.near = index;
                    let limits = trial.limits_at(0.5 * (start + end), feedrate, last_speed);
                    last_speed = limits.velocity;
                    limits
                };
                if self.places.len() >= MOST_PLACES {
                    return false;
                }
                self.places.push(Place {
                    end,
                    limits,
                    feedrate: leg.limits.velocity,
                    slower: 1.0,
                    softer: 1.0,
                });
            }
        }
        true
    }

    /// Notes that the places around a distance must be slowed.
    pub(super) fn slow(&mut self, from: f64, to: f64, excess: &Excess) {
        let more = |factor: f64| (factor * SLOWER).max(SLOWEST);
        let (slower, softer) = match *excess {
            Excess::Feedrate(factor) => {
                self.lower = self.lower.min(factor);
                return;
            }
            Excess::Changes(factor) => (1.0, more(factor)),
            Excess::Curvature(factor) => (more(factor), more(factor)),
        };
        let first = self.places.partition_point(|place| place.end < from);
        let mut start = if first > 0 {
            self.places[first - 1].end
        } else {
            0.0
        };
        for place in &mut self.places[first..] {
            if start > to {
                break;
            }
            start = place.end;
            place.slower = place.slower.min(slower);
            place.softer = place.softer.min(softer);
        }
    }

    /// Slows the places that were noted, each by the most that was asked of it.
    pub(super) fn settle(&mut self) {
        self.share *= std::mem::replace(&mut self.lower, 1.0) - 4.0 * LIMIT_SLACK;
        for place in &mut self.places {
            place.limits.velocity *= std::mem::replace(&mut place.slower, 1.0);
            place.limits.velocity = place.limits.velocity.min(self.share * place.feedrate);
            let factor = std::mem::replace(&mut place.softer, 1.0);
            place.limits.acceleration *= factor * factor;
            place.limits.jerk *= factor * factor * factor;
        }
    }

    /// Plans the progress from rest to rest; its duration, or `None` when there is none.
    pub(super) fn arrange(&mut self, step: f64) -> Option<f64> {
        for _ in 0..ROUNDS {
            self.link();
            if !self.hold_back(step) {
                break;
            }
        }
        let mut duration = 0.0;
        let mut from = 0.0;
        for (index, link) in self.links.iter().enumerate() {
            let to = self.turns.get(index).map_or(0.0, |turn| turn.exit.speed);
            duration += Self::feed(link, from, to)?.duration();
            from = to;
        }
        Some(duration)
    }

    fn feed(link: &Link, from: f64, to: f64) -> Option<Feed> {
        let connection = Connection {
            from: [from, 0.0],
            to: [to, 0.0],
            limits: link.limits,
        };
        Feed::over(link.length, &connection).ok()
    }

    /// Gives distance, speed and link at each multiple of `step`.
    pub(super) fn walk(&self, step: f64, mut take: impl FnMut(f64, f64, usize) -> bool) -> bool {
        let (mut begin, mut time, mut tick, mut from) = (0.0, 0.0, 0.0, 0.0);
        for (index, link) in self.links.iter().enumerate() {
            let to = self.turns.get(index).map_or(0.0, |turn| turn.exit.speed);
            let Some(feed) = Self::feed(link, from, to) else {
                return false;
            };
            let mut state = State::moving(from, 0.0);
            for phase in feed.phases() {
                state.jerk = phase.jerk;
                let end = time + phase.duration;
                while tick * step < end {
                    if tick > MOST_TICKS {
                        return false;
                    }
                    let now = state.after(tick * step - time);
                    if !take(begin + now.position, now.velocity, index) {
                        return false;
                    }
                    tick += 1.0;
                }
                state = state.after(phase.duration);
                time = end;
            }
            begin += link.length;
            from = to;
        }
        true
    }

    /// Finds runs of places that the progress passes too fast, and holds it where the slowest places
    /// of each begin and end; `false` when there is none.
    fn hold_back(&mut self, step: f64) -> bool {
        let mut runs = std::mem::take(&mut self.runs);
        runs.clear();
        let mut place = 0;
        let mut run: Option<(usize, usize)> = None;
        let mut current = 0;
        self.walk(step, |distance, speed, link| {
            while place + 1 < self.places.len() && self.places[place].end < distance {
                place += 1;
            }
            let exceeds = speed > EXCESS * self.places[place].limits.velocity;
            if !exceeds || link != current {
                runs.extend(run.take());
                current = link;
            }
            if exceeds {
                run = Some((run.map_or(place, |(first, _)| first), place));
            }
            true
        });
        runs.extend(run);
        let before = self.holds.len();
        for &(first, last) in &runs {
            let speed = |place: usize| self.places[place].limits.velocity;
            let slowest = (first..=last).map(speed).fold(f64::INFINITY, f64::min);
            let alike = |place: &usize| speed(*place) * ALIKE <= slowest;
            let begin = (first..=last).find(alike).unwrap_or(first);
            let end = (first..=last).rev().find(alike).unwrap_or(last) + 1;
            for hold in [begin, end] {
                if hold > 0 && hold < self.places.len() {
                    self.holds.push(hold);
                }
            }
        }
        self.runs = runs;
        self.holds.sort_unstable();
        self.holds.dedup();
        self.holds.len() > before
    }

    /// Plans the speeds at which the progress is held.
    fn link(&mut self) {
        self.links.clear();
        self.turns.clear();
        self.window.restart();
        let mut first = 0;
        let mut start = 0.0;
        let ends = self.holds.iter().copied().chain([self.places.len()]);
        for end in ends {
            let group = &self.places[first..end];
            let (Some(one), Some(last)) = (group.first(), group.last()) else {
                continue;
            };
            let mut limits = one.limits;
            let mut slowest = limits.velocity;
            for place in group {
                limits.velocity = limits.velocity.max(place.limits.velocity);
                slowest = slowest.min(place.limits.velocity);
                limits.acceleration = limits.acceleration.min(place.limits.acceleration);
                limits.jerk = limits.jerk.min(place.limits.jerk);
            }
            if slowest >= SAME * limits.velocity {
                limits.velocity = slowest;
            }
            let link = Link {
                length: last.end - start,
                limits,
            };
            if first == 0 {
                self.window.begin(link);
            } else {
                let speed = self.places[first]
                    .limits
                    .velocity
                    .min(self.places[first - 1].limits.velocity);
                self.window.push(TurnShape::through(speed), link);
            }
            self.links.push(link);
            start = last.end;
            first = end;
        }
        self.window.finish();
        while let Some(turn) = self.window.pull() {
            self.turns.push(turn);
        }
    }
}

/// Tries speeds at places of a curve.
struct Trial<'a, const N: usize> {
    curve: &'a Curve<N>,
    limits: &'a Limits<N>,
    filter: &'a Filter,
    near: usize,
}

impl<const N: usize> Trial<'_, N> {
    /// The largest speed of the ladder that the place allows, and what it leaves to changes of speed.
    fn limits_at(&self, distance: f64, feedrate: f64, guess: f64) -> Tangential {
        let try_at = |speed: f64| {
            let [second, third] = self.differences(distance, speed);
            self.fits(distance, &second, &third)
                .then(|| self.rest(distance, speed, &second, &third))
        };
        let mut speed = guess.min(feedrate);
        if let Some(mut found) = try_at(speed) {
            while speed < feedrate {
                let faster = (speed / LADDER).min(feedrate);
                let Some(better) = try_at(faster) else {
                    return try_at(0.5 * (speed + faster)).unwrap_or(found);
                };
                found = better;
                speed = faster;
            }
            return found;
        }
        loop {
            speed *= LADDER;
            if let Some(found) = try_at(speed) {
                return try_at(0.5 * speed * (1.0 + 1.0 / LADDER)).unwrap_or(found);
            }
            if speed < LOWEST * feedrate {
                let [second, third] = self.differences(distance, speed);
                return self.rest(distance, speed, &second, &third);
            }
        }
    }

    /// Second and third difference of the control points around a distance.
    fn differences(&self, distance: f64, speed: f64) -> [Vector<N>; 2] {
        let reach = speed * self.filter.step;
        let at = |share: f64| {
            let distance = distance + share * reach;
            self.curve
                .point(distance, self.curve.leg_at(distance, self.near))
        };
        let second = at(1.0) - at(0.0) * 2.0 + at(-1.0);
        let third = at(1.5) - at(0.5) * 3.0 + at(-0.5) * 3.0 - at(-1.5);
        let amplified = self.filter.sharpening;
        [
            second * (1.0 + amplified / 3.0),
            third * (1.0 + 0.5 * amplified),
        ]
    }

    fn fits(&self, distance: f64, second: &Vector<N>, third: &Vector<N>) -> bool {
        let step = self.filter.step;
        let leg = &self.curve.legs()[self.curve.leg_at(distance, self.near)];
        let off = second.norm() * (1.0 - self.filter.sharpening).max(0.25) / 6.0;
        largest_multiple(second, self.limits.acceleration()) * CURVATURE_ACCELERATION * step * step
            >= 1.0
            && largest_multiple(third, self.limits.jerk()) * CURVATURE_JERK * step.powi(3) >= 1.0
            && off <= CURVATURE_TOLERANCE * leg.room().length()
    }

    /// What curvature leaves of the limits along the path.
    fn rest(&self, distance: f64, speed: f64, second: &Vector<N>, third: &Vector<N>) -> Tangential {
        let step = self.filter.step;
        let leg = &self.curve.legs()[self.curve.leg_at(distance, self.near)];
        let mut rest = Tangential {
            velocity: speed,
            ..leg.limits
        };
        let used = |difference: f64, bound: f64| (bound - difference.abs()).max(LEAST_REST * bound);
        for axis in 0..N {
            let share = leg.direction[axis].abs();
            if share > 0.0 {
                let acceleration = used(
                    second[axis] / (step * step),
                    self.limits.acceleration()[axis],
                );
                let jerk = used(third[axis] / step.powi(3), self.limits.jerk()[axis]);
                rest.acceleration = rest.acceleration.min(acceleration / share);
                rest.jerk = rest.jerk.min(jerk / share);
            }
        }
        rest
    }
}

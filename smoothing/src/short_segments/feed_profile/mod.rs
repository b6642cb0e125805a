//! Plans the jerk-limited feed profile along a section under its velocity limit curve.
//!
//! Source: ours. Places allow speeds, and leave some of the limits to changes of speed, which the
//! look-ahead window plans as if the stretch were straight; where the progress would still be too
//! fast, it is held at constant speed. What comes out is a proposal, judged elsewhere. Not here: what a
//! place allows.

mod progress;

use crate::lookahead::window::{Link, Window};
use crate::short_segments::curve::Curve;
use crate::short_segments::spline::Excess;
use crate::short_segments::velocity_limit::survey;
use toolglide_kinematics::numeric::LIMIT_SLACK;
use toolglide_kinematics::{Limits, PathLimits};
use toolglide_profiles::{BlendShape, Profile};

/// How much faster than a place allows the progress may be before it is held back there.
const EXCESS: f64 = 1.01;
/// Places whose speeds lie within this ratio are held as one.
const ALIKE: f64 = 0.9;
/// Places whose speeds lie within this ratio are travelled at the slowest of them.
const SAME: f64 = 0.99;
/// Places, half a time step each, over which the progress may go down to a slightly lower feedrate.
const BRAKING: usize = 4;
/// Rounds of holding the progress back.
const ROUNDS: usize = 6;
/// What a place is slowed by in one round beyond what its excess asks for.
const SLOWER: f64 = 0.995;
/// The most that a place is slowed by in one round.
const SLOWEST: f64 = 0.85;
/// What the power grows by from round to round with which places are slowed in haste.
const HASTE: f64 = 0.4;
/// Most places on one stretch.
pub(super) const MAX_PLACES: usize = 16_384;

/// How densely and how sharply a stretch is filtered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Filter {
    /// Time between two knots.
    pub(super) step: f64,
    /// Share of the second difference by which control points are moved outward, times six.
    pub(super) sharpening: f64,
    /// How much more jerk the progress may have than the legs: what the spline makes of it has less.
    pub(super) stiffness: f64,
    /// The same inside an arc, where nothing bends abruptly.
    pub(super) inside: f64,
    /// Whether the motion lags behind the progress where that gains speed, so that no speed overshoots.
    pub(super) lags: bool,
    /// Whether places are slowed by more from round to round.
    pub(super) hasty: bool,
    /// Lengths, in steps, of the two means that are taken of the control points.
    pub(super) taps: [usize; 2],
}

impl Filter {
    /// Of the control points themselves, made of a progress that keeps the limits of the legs.
    pub(super) fn sharp(step: f64, sharpening: f64) -> Self {
        Self {
            step,
            sharpening,
            stiffness: 1.0,
            lags: false,
            hasty: false,
            inside: sharpening,
            taps: [1, 1],
        }
    }

    /// Whether means are taken.
    pub(super) fn averages(&self) -> bool {
        self.taps != [1, 1]
    }

    /// Time of the longer mean.
    #[allow(clippy::cast_precision_loss, reason = "counts are small")]
    pub(super) fn long(&self) -> f64 {
        self.step * self.taps[0] as f64
    }

    /// Steps in both means, but for the one at which a command begins to count.
    pub(super) fn settling(&self) -> usize {
        self.taps[0] + self.taps[1] - 2
    }

    /// The time step of a spline of the same width.
    #[allow(clippy::cast_precision_loss, reason = "counts are small")]
    pub(super) fn reach(&self) -> f64 {
        self.step * self.taps[0].max(self.taps[1]) as f64
    }
}

/// A part of the stretch with the speed and the changes of speed that it allows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    end: f64,
    limits: PathLimits,
    feedrate: f64,
    /// What its speed must be slowed by next, and its changes of speed.
    slower: f64,
    softer: f64,
}

impl Place {
    pub(super) fn new(end: f64, limits: PathLimits, feedrate: f64) -> Self {
        Self {
            end,
            limits,
            feedrate,
            slower: 1.0,
            softer: 1.0,
        }
    }
}

/// A place on a stretch at which the progress neither gains nor loses speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SwitchState {
    /// Time since the beginning of the progress.
    pub(super) time: f64,
    pub(super) distance: f64,
    pub(super) speed: f64,
}

impl SwitchState {
    /// At rest at the beginning.
    pub(super) const AT_REST: Self = Self {
        time: 0.0,
        distance: 0.0,
        speed: 0.0,
    };
}

/// Speeds along a stretch.
#[derive(Clone, Debug)]
pub(super) struct FeedProfile {
    /// Where the progress begins.
    start: SwitchState,
    /// Share of the feedrate that is used, and what it must be lowered by next.
    share: f64,
    lower: f64,
    /// Power of what places must be slowed by, and how it grows from round to round.
    haste: f64,
    growth: f64,
    places: Vec<Place>,
    /// Places at whose beginning the progress is held, without acceleration.
    holds: Vec<usize>,
    runs: Vec<(usize, usize)>,
    window: Window,
    links: Vec<Link>,
    turns: Vec<BlendShape>,
}

impl FeedProfile {
    pub(super) fn new() -> Self {
        Self {
            start: SwitchState::AT_REST,
            share: 1.0,
            lower: 1.0,
            haste: 1.0,
            growth: 0.0,
            places: Vec::with_capacity(MAX_PLACES + 1),
            holds: Vec::with_capacity(MAX_PLACES + 1),
            runs: Vec::with_capacity(MAX_PLACES + 1),
            window: Window::new(MAX_PLACES, false),
            links: Vec::with_capacity(MAX_PLACES + 1),
            turns: Vec::with_capacity(MAX_PLACES + 1),
        }
    }

    /// Finds what each place of the curve from a start on allows at a share of the feedrate; `false`
    /// when there are too many places or none.
    pub(super) fn survey<const N: usize>(
        &mut self,
        curve: &Curve<N>,
        limits: &Limits<N>,
        filter: &Filter,
        start: &SwitchState,
        share: f64,
    ) -> bool {
        self.places.clear();
        self.holds.clear();
        self.start = *start;
        self.share = share;
        self.lower = 1.0;
        self.haste = 1.0;
        self.growth = if filter.hasty { HASTE } else { 0.0 };
        survey(
            curve,
            limits,
            filter,
            self.start.distance,
            share,
            |mut place| {
                place.limits.jerk *= filter.stiffness;
                let fits = self.places.len() < MAX_PLACES;
                if fits {
                    self.places.push(place);
                }
                fits
            },
        ) && !self.places.is_empty()
    }

    /// Notes that the places around a distance must be slowed.
    pub(super) fn slow(&mut self, from: f64, to: f64, excess: &Excess) {
        let more = |factor: f64| (factor.powf(self.haste) * SLOWER).max(SLOWEST);
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
        if self.lower < 1.0 && self.start.speed > 0.0 && self.places.len() > BRAKING {
            // What has been settled is too fast to be kept up.
            self.holds.push(BRAKING);
            self.holds.sort_unstable();
            self.holds.dedup();
        }
        self.haste += self.growth;
        self.share *= std::mem::replace(&mut self.lower, 1.0) - 4.0 * LIMIT_SLACK;
        for place in &mut self.places {
            place.limits.velocity *= std::mem::replace(&mut place.slower, 1.0);
            place.limits.velocity = place.limits.velocity.min(self.share * place.feedrate);
            let factor = std::mem::replace(&mut place.softer, 1.0);
            place.limits.acceleration *= factor * factor;
            place.limits.jerk *= factor * factor * factor;
        }
    }

    /// Plans the progress from its start to rest; its duration, or `None` when there is none.
    pub(super) fn arrange(&mut self, step: f64) -> Option<f64> {
        for _ in 0..ROUNDS {
            self.link();
            if !self.hold_back(step) {
                break;
            }
        }
        let mut duration = 0.0;
        let mut from = self.start.speed;
        for (index, link) in self.links.iter().enumerate() {
            let to = self.turns.get(index).map_or(0.0, |turn| turn.exit.speed);
            duration += Self::feed(link, from, to)?.duration();
            from = to;
        }
        Some(duration)
    }

    /// Finds runs of places that the progress passes too fast, and holds it where the slowest places
    /// of each begin and end; `false` when there is none.
    fn hold_back(&mut self, step: f64) -> bool {
        let mut runs = std::mem::take(&mut self.runs);
        runs.clear();
        let mut place = 0;
        let mut run: Option<(usize, usize)> = None;
        let mut current = 0;
        self.walk(0.0, step, |distance, speed, link| {
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

    /// Plans the speeds at which the progress is held. What was settled may be faster than the first holds
    /// are found to allow; those to which it cannot brake are passed without holding.
    fn link(&mut self) {
        for passed in 0..=self.holds.len() {
            self.link_after(passed);
            let to = self.turns.first().map_or(0.0, |turn| turn.exit.speed);
            let sets_out = |link| Self::feed(link, self.start.speed, to).is_some();
            if self.links.first().is_none_or(sets_out) {
                break;
            }
        }
    }

    /// The same for the holds after some.
    fn link_after(&mut self, passed: usize) {
        self.links.clear();
        self.turns.clear();
        if self.start.speed > 0.0 {
            self.window
                .restart_after(BlendShape::through(self.start.speed));
        } else {
            self.window.restart();
        }
        let mut first = 0;
        let mut start = self.start.distance;
        let holds = self.holds[passed..].iter().copied();
        let ends = holds.chain([self.places.len()]);
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
            if first == 0 {
                // What has been settled cannot be slowed any more.
                limits.velocity = limits.velocity.max(self.start.speed);
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
                self.window.push(BlendShape::through(speed), link);
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

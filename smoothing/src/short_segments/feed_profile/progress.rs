//! Evaluates the progress along a section against time, by S-curves of up to seven phases.
//!
//! Source: section 3.3.1 for the feed. Not here: where it is held, and at which speed.

use crate::lookahead::window::Link;
use crate::short_segments::feed_profile::{FeedProfile, SwitchState};
use toolglide_profiles::{Profile, SCurve, SCurveBoundary, State};

/// Share of the speed that a place allows from which the progress passes it at full speed.
const FULL: f64 = 0.97;
/// Most instants at which one stretch is looked at.
const MAX_TICKS: f64 = 20_000.0;

impl FeedProfile {
    /// The last place at which the progress neither gains nor loses speed and goes as fast as the place
    /// allows; the fastest where there is none.
    pub(in crate::short_segments) fn handover(&self) -> Option<SwitchState> {
        let mut best: Option<SwitchState> = None;
        let mut full = false;
        let mut begin = SwitchState {
            time: 0.0,
            ..self.start
        };
        let mut place = 0;
        for (index, link) in self.links.iter().enumerate() {
            let to = self.turns.get(index).map_or(0.0, |turn| turn.exit.speed);
            let feed = Self::feed(link, begin.speed, to)?;
            let cruised = &feed.starts()[4];
            let ends = [
                SwitchState {
                    time: begin.time
                        + feed.phases()[..4]
                            .iter()
                            .map(|phase| phase.duration)
                            .sum::<f64>(),
                    distance: begin.distance + cruised.position,
                    speed: cruised.velocity,
                },
                SwitchState {
                    time: begin.time + feed.duration(),
                    distance: begin.distance + link.length,
                    speed: to,
                },
            ];
            for end in ends {
                while place + 1 < self.places.len() && self.places[place].end < end.distance {
                    place += 1;
                }
                let is_full = end.speed >= FULL * self.places[place].limits.velocity;
                let better = best.is_none_or(|best| end.speed > best.speed);
                if end.speed > 0.0 && (is_full || (!full && better)) {
                    best = Some(end);
                    full |= is_full;
                }
            }
            begin = ends[1];
        }
        best
    }

    pub(super) fn feed(link: &Link, from: f64, to: f64) -> Option<SCurve> {
        let connection = SCurveBoundary {
            from: [from, 0.0],
            to: [to, 0.0],
            limits: link.limits,
        };
        SCurve::over(link.length, &connection).ok()
    }

    /// Gives distance, speed and link at each multiple of `step` after a first instant; `false` when
    /// `take` has had enough.
    pub(in crate::short_segments) fn walk(
        &self,
        first: f64,
        step: f64,
        mut take: impl FnMut(f64, f64, usize) -> bool,
    ) -> bool {
        let SwitchState {
            distance: mut begin,
            speed: mut from,
            ..
        } = self.start;
        let (mut time, mut tick) = (0.0, 0.0);
        for (index, link) in self.links.iter().enumerate() {
            let to = self.turns.get(index).map_or(0.0, |turn| turn.exit.speed);
            let Some(feed) = Self::feed(link, from, to) else {
                return false;
            };
            let mut state = State::moving(from, 0.0);
            for phase in feed.phases() {
                state.jerk = phase.jerk;
                let end = time + phase.duration;
                while first + tick * step < end {
                    if tick > MAX_TICKS {
                        return false;
                    }
                    let now = state.after(first + tick * step - time);
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
}

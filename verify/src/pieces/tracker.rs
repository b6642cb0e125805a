//! Locates a motion along the path when it names no moves.
//!
//! The motion is on one of a window of moves: the newest is the one whose end it has not passed
//! yet, the oldest is the first that it has not left behind. Ends are passed in order, as soon as
//! the motion may be within their tolerance, and those of exact stops once it may rest there. So a
//! path that comes back near itself is no trap: what is near but not in turn is not looked at.
//!
//! Source: the meaning of [`toolglide_kinematics::Tolerance`]. Not here: limits of the axes.

use crate::path::chord::Chord;
use crate::path::leg::Leg;
use crate::path::route::Route;
use crate::pieces::move_progress::close_leg;
use crate::report::Report;
use crate::set_points::spacing::is_fine;
use crate::violation::Violation;
use toolglide_kinematics::numeric::LOOK_AHEAD_MOVES;

/// A window of more moves than this is not searched for the nearest once one is near enough.
const WIDE_WINDOW: u32 = 8;

/// The window of moves that a motion may be on.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tracker {
    /// The newest move that the motion may be on.
    high: u32,
    /// The move that the motion was last found nearest to.
    pub(crate) near: u32,
    /// First move whose feedrate may still apply.
    feed_low: u32,
    /// Largest feedrate of moves left behind that may still apply.
    feed_behind: f64,
    /// Whether the motion is between moves, so that the feedrate of the next may apply already.
    off_path: bool,
    /// How far the motion has come since it was last within tolerance of its window.
    lost_length: f64,
    /// Smallest tolerance of the moves along the last chord, and of those that stop there.
    pub(crate) finest: Finest,
}

/// Smallest tolerances along a chord, mm; infinite where there is none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finest {
    pub(crate) path: f64,
    pub(crate) stop: f64,
}

impl Default for Finest {
    fn default() -> Self {
        Self {
            path: f64::INFINITY,
            stop: f64::INFINITY,
        }
    }
}

/// How far a point is from the window, least over its moves.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    distance: f64,
    share: f64,
    mv: u32,
}

impl Tracker {
    /// The newest move that the motion may be on.
    pub(crate) fn reached(&self) -> u32 {
        self.high
    }

    /// Follows the motion along one chord.
    pub(crate) fn follow<const N: usize>(
        &mut self,
        route: &mut Route<N>,
        report: &mut Report<N>,
        chord: &Chord<N>,
    ) {
        let before = self.high;
        self.pass(route, chord);
        if !is_fine(chord.duration) {
            self.finest = self.finest(route, before);
        }
        self.note_corners(route, report, chord);
        let Some(mut nearest) = self.nearest(route, report, chord) else {
            return;
        };
        if nearest.share > 1.0 {
            nearest = self.recover(route, chord, nearest);
        } else {
            self.lost_length = 0.0;
        }
        self.near = nearest.mv;
        let time = chord.begin + chord.duration;
        if let Some(leg) = route.get(nearest.mv) {
            report.deviation.raise(nearest.distance, time, leg.place);
            report.deviation_ratio.raise(nearest.share, time, leg.place);
            self.off_path = nearest.distance > leg.slack;
            if nearest.share > 1.0 {
                report.add(Violation::Deviation {
                    value: nearest.distance,
                    tolerance: leg.tolerance,
                    time,
                    place: leg.place,
                });
            }
        }
        self.leave(route, report, chord, nearest.share);
    }

    /// Smallest tolerances of the moves of the window, whose newest was `before` at the last set-point.
    fn finest<const N: usize>(&self, route: &Route<N>, before: u32) -> Finest {
        let mut finest = Finest::default();
        for leg in route.range(route.base(), self.high) {
            finest.path = finest.path.min(leg.corner_tolerance);
            if leg.stops && leg.place.mv >= before {
                finest.stop = finest.stop.min(leg.tolerance);
            }
        }
        finest
    }

    /// Largest feedrate that may have applied since the point before; call before [`Self::settle`].
    pub(crate) fn feedrate<const N: usize>(&self, route: &Route<N>) -> f64 {
        let last = if self.off_path {
            self.high.saturating_add(1)
        } else {
            self.high
        };
        let feedrates = route.range(self.feed_low, last).map(|leg| leg.feedrate);
        feedrates.fold(self.feed_behind, f64::max)
    }

    /// Drops the feedrates of moves that the motion has left for good.
    pub(crate) fn settle<const N: usize>(&mut self, route: &Route<N>, chord: &Chord<N>) {
        if self.off_path {
            return;
        }
        self.feed_behind = 0.0;
        while self.feed_low < self.high
            && route
                .get(self.feed_low)
                .is_none_or(|leg| chord.leaves(&leg.end, leg.corner_allowed))
        {
            self.feed_low += 1;
        }
    }

    /// Forgets all moves at the end of the motion; those never reached were left out.
    pub(crate) fn finish<const N: usize>(
        &mut self,
        route: &mut Route<N>,
        report: &mut Report<N>,
        time: f64,
    ) {
        while route.base() < route.len() {
            let mv = route.base();
            if mv > self.high
                && let Some(leg) = route.get(mv)
                && !leg.is_empty()
            {
                let place = leg.place;
                report.add(Violation::MoveSkipped { time, place });
            }
            close_leg(route, report, time);
        }
    }

    /// Passes ends of moves, and points inside arcs, in their order.
    fn pass<const N: usize>(&mut self, route: &mut Route<N>, chord: &Chord<N>) {
        let mut from = 0.0;
        let mut spare = chord.duration;
        loop {
            let is_last = self.high.saturating_add(1) >= route.len();
            let Some(leg) = route.get_mut(self.high) else {
                return;
            };
            leg.pass_if_small(leg.allowed + chord.slack);
            if leg.waypoints_passed < leg.waypoints() {
                let (point, _) = leg.waypoint(leg.waypoints_passed);
                let Some(at) = chord.enters(&point, leg.allowed, from) else {
                    return;
                };
                from = at;
                leg.waypoints_passed += 1;
                continue;
            }
            if leg.stops {
                if !leg.rests(chord, &mut spare) || !leg.has_dwelt() || is_last {
                    return;
                }
            } else {
                let at = chord.enters(&leg.end, leg.corner_allowed, from);
                let Some(at) = at.filter(|_| !is_last) else {
                    return;
                };
                from = at;
            }
            self.high += 1;
        }
    }

    /// Takes note how close the motion comes to corners, as far as it can change the report.
    fn note_corners<const N: usize>(
        &self,
        route: &mut Route<N>,
        report: &Report<N>,
        chord: &Chord<N>,
    ) {
        let (error, ratio) = (report.corner_error.value, report.corner_ratio.value);
        for mv in route.base()..=self.high.saturating_add(1) {
            let Some(leg) = route.get_mut(mv) else { return };
            if leg.approach > error.min(ratio * leg.corner_allowed) {
                let (distance, time) = chord.distance(&leg.end);
                leg.comes_near(distance, time);
            }
        }
    }

    /// Distance of the newest point from the window; any that changes nothing is good enough.
    fn nearest<const N: usize>(
        &self,
        route: &Route<N>,
        report: &Report<N>,
        chord: &Chord<N>,
    ) -> Option<Nearest> {
        let near = self.near.clamp(route.base(), self.high);
        let (known, known_share) = (
            report.deviation.value,
            report.deviation_ratio.value.min(1.0),
        );
        let is_wide = self.high - route.base() > WIDE_WINDOW;
        let mut best: Option<Nearest> = None;
        let behind = near.checked_sub(1).filter(|last| *last >= route.base());
        let behind = behind.map(|last| route.range(route.base(), last));
        for leg in route
            .range(near, self.high)
            .chain(behind.into_iter().flatten())
        {
            let one = nearness(leg, chord);
            let so_far = best.unwrap_or(one);
            let best = best.insert(Nearest {
                distance: so_far.distance.min(one.distance),
                share: so_far.share.min(one.share),
                mv: if one.share < so_far.share {
                    one.mv
                } else {
                    so_far.mv
                },
            });
            let enough = best.distance <= known && best.share <= known_share;
            if best.distance <= leg.slack || (is_wide && enough) {
                break;
            }
        }
        best
    }

    /// Looks ahead for a motion that has left its window: where it is nearer to a later move, it is
    /// there now, and what lies between was missed.
    ///
    /// The next move may be anywhere, later ones no farther along the path than the motion may have
    /// come since it was last in the window.
    fn recover<const N: usize>(
        &mut self,
        route: &mut Route<N>,
        chord: &Chord<N>,
        lost: Nearest,
    ) -> Nearest {
        self.lost_length += chord.length();
        let reach = 2.0 * (self.lost_length + lost.distance);
        let mut ahead = route
            .get(self.high)
            .map_or(0.0, |leg| (chord.to - leg.end).norm());
        let next = self.high.saturating_add(1);
        let last = self.high.saturating_add(LOOK_AHEAD_MOVES);
        let mut found = lost;
        for leg in route.range(next, last) {
            if ahead > reach && leg.place.mv > next {
                break;
            }
            let one = nearness(leg, chord);
            if one.share < found.share {
                found = one;
            }
            ahead += leg.length;
        }
        for mv in self.high..found.mv {
            if let Some(leg) = route.get_mut(mv) {
                let (distance, time) = chord.distance(&leg.end);
                leg.comes_near(distance, time);
            }
        }
        self.high = self.high.max(found.mv);
        found
    }

    /// Forgets moves at the old end of the window that the motion has left behind.
    fn leave<const N: usize>(
        &mut self,
        route: &mut Route<N>,
        report: &mut Report<N>,
        chord: &Chord<N>,
        share: f64,
    ) {
        while route.base() < self.high
            && let Some(leg) = route.get(route.base())
        {
            let there = nearness(leg, chord).share;
            if there <= 1.0 || there <= share {
                break;
            }
            if self.feed_low <= route.base() {
                self.feed_behind = self.feed_behind.max(leg.feedrate);
                self.feed_low = route.base() + 1;
            }
            close_leg(route, report, chord.begin);
        }
    }
}

/// Distance of the newest point from one move, as far as it is certain.
fn nearness<const N: usize>(leg: &Leg<N>, chord: &Chord<N>) -> Nearest {
    let distance = (leg.distance(&chord.to) - chord.rounding).max(0.0);
    Nearest {
        distance,
        share: distance / leg.allowed,
        mv: leg.place.mv,
    }
}

impl<const N: usize> Leg<N> {
    /// Takes note of a rest at the end of this move; a dwell uses up some of the `spare` time.
    fn rests(&mut self, chord: &Chord<N>, spare: &mut f64) -> bool {
        if !chord.may_rest_at(self) {
            self.resting = 0.0;
            return false;
        }
        self.stopped = true;
        let (distance, time) = chord.distance(&self.end);
        self.comes_near(distance, time);
        if let Some(duration) = self.dwell {
            let given = spare.min((duration - self.resting).max(0.0));
            self.resting += given;
            self.rested = self.rested.max(self.resting);
            *spare -= given;
        }
        true
    }
}

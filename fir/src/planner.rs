//! Moves in, motion out: pulses, their times, and the pieces behind the filters.
//!
//! Source: sections 4.2 and 4.3. Not here: any formula; see the chain, the look-ahead and the sweep.

use crate::chords::{Chords, bulge_of};
use crate::circle::angular_velocity;
use crate::cubic::CubicChain;
use crate::lookahead::LookAhead;
use crate::merge::{Leg, MERGE_SHARE, Merger, Vertex};
use crate::pulse::Pulse;
use crate::settings::{Method, Settings, largest_change, time_constants};
use crate::sweep::{Command, Sweep};
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{
    Arc, Limits, MotionPlanner, Move, Path, Piece, Plan, PlanError, Serves, Toolpath, Vector,
    check_contact, largest_multiple,
};

/// Room for commands that wait to become motion.
const COMMANDS: usize = 1024;

/// Share of the tolerance that is planned with; the rest is for rounding.
const LINE_SHARE: f64 = 0.9999;

/// The same for arcs, whose chords leave a ripple behind the filters.
const ARC_SHARE: f64 = 0.996;

/// By how much the bound may exceed the tolerance in the middle of an arc, where it is larger than the
/// distance itself; what is beyond the tolerance is what [`ARC_SHARE`] leaves.
const STEADY_EXCESS: f64 = 1.0015;

/// Feedrates within this factor share their time constants.
const SAME_CLASS: f64 = 2.0;

/// Plans filtered pulses while the path is being read.
///
/// # Examples
/// ```
/// use toolglide_fir::{Settings, plan};
/// use toolglide_kinematics::{Feedrate, Limits, Tolerance, Toolpath, Trajectory, Vector};
/// let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
/// let path = Toolpath::from_points(&corner, Feedrate::new(100.0)?, Tolerance::new(0.1)?)?;
/// let motion = plan(&path, &Settings::new(Limits::uniform(500.0, 2500.0, 2e5)?))?;
/// assert_eq!(motion.end(), path.end());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FirInterpolation<const N: usize> {
    limits: Limits<N>,
    method: Method,
    /// Whether the time constants follow the feedrate.
    chosen: bool,
    /// Feedrate that the time constants were chosen for.
    class: f64,
    chain: CubicChain,
    change: Vector<N>,
    /// Where the programmed path has come to.
    position: Vector<N>,
    merger: Merger<N>,
    index: u32,
    finished: bool,
    arc: Option<ArcUnderWay<N>>,
    look: LookAhead<N>,
    sweep: Sweep<N>,
}

#[derive(Clone, Copy, Debug)]
struct ArcUnderWay<const N: usize> {
    chords: Chords<N>,
    limit: f64,
    tolerance: f64,
    steady: f64,
    serves: Serves,
    stops: bool,
}

impl<const N: usize> FirInterpolation<N> {
    /// A planner whose motion begins at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, settings: &Settings<N>) -> Self {
        let chosen = settings.chain.is_none();
        let fastest = settings.limits.velocity().max();
        let chain = settings.chain.clone().unwrap_or_else(|| {
            let (long, short) = time_constants(&settings.limits, fastest);
            CubicChain::of_two(long, short)
        });
        let change = largest_change(&settings.limits, &chain);
        Self {
            limits: settings.limits,
            method: settings.method,
            chosen,
            class: fastest,
            change,
            position: start,
            merger: Merger::new(start),
            index: 0,
            finished: false,
            arc: None,
            look: LookAhead::new(chain.clone(), change),
            sweep: Sweep::new(start, chain.clone(), COMMANDS),
            chain,
        }
    }

    /// Other time constants where the feedrate asks for them.
    fn choose(&mut self, feed: f64) {
        if !self.chosen {
            return;
        }
        let feed = feed.min(self.limits.velocity().norm());
        let fits = feed <= self.class * (1.0 + f64::EPSILON) && feed * SAME_CLASS > self.class;
        if fits {
            return;
        }
        self.come_to_rest();
        self.class = feed;
        let (long, short) = time_constants(&self.limits, feed);
        self.chain = CubicChain::of_two(long, short);
        self.change = largest_change(&self.limits, &self.chain);
        self.look.set_chain(self.chain.clone(), self.change);
        self.sweep.push(Command::Filters { long, short });
    }

    /// Largest feedrate along a direction.
    fn limit_along(&self, direction: &Vector<N>, feedrate: f64) -> f64 {
        largest_multiple(direction, &self.change.inf(self.limits.velocity())).min(feedrate)
    }

    fn rest(&mut self) {
        self.flush();
        self.come_to_rest();
        if let Some(serves) = self.merger.take_carried() {
            self.sweep.push(Command::Pause {
                duration: 0.0,
                serves,
            });
        }
    }

    /// What has become pulses comes to rest.
    fn come_to_rest(&mut self) {
        let sweep = &mut self.sweep;
        self.look.rest(&mut |command| sweep.push(command));
    }

    /// The leg under way becomes a pulse.
    fn flush(&mut self) {
        let from = self.merger.anchor();
        if let Some(leg) = self.merger.flush() {
            self.leg(from, &leg);
        }
    }

    fn add(&mut self, pulse: Pulse<N>) {
        let sweep = &mut self.sweep;
        self.look.push(pulse, &mut |command| sweep.push(command));
    }

    fn leg(&mut self, from: Vector<N>, leg: &Leg<N>) {
        self.choose(leg.feedrate);
        let tolerance = LINE_SHARE * leg.room;
        let mut pulse = Pulse::between((from, leg.end), leg.feedrate, tolerance, leg.serves);
        pulse.limit = self.limit_along(&pulse.direction, leg.feedrate);
        pulse.feed = pulse.limit;
        self.add(pulse);
    }

    /// The end of a straight stretch that strays from the path by `bulge`.
    fn vertex(&mut self, point: Vector<N>, bulge: f64, step: &Move<N>, serves: Serves) {
        let from = self.merger.anchor();
        let leg = self.merger.push(Vertex {
            point,
            bulge,
            feedrate: step.feedrate().speed().min(self.limits.velocity().norm()),
            tolerance: step.tolerance().length(),
            serves,
        });
        if let Some(leg) = leg {
            self.leg(from, &leg);
        }
    }

    fn begin_arc(&mut self, arc: &Arc<N>, step: &Move<N>, serves: Serves) {
        self.flush();
        let feedrate = step.feedrate().speed();
        self.choose(feedrate);
        let tolerance = ARC_SHARE * step.tolerance().length();
        let chords = Chords::new(*arc, tolerance);
        let mut limit = self.arc_limit(arc, feedrate, tolerance);
        let mut from = self.merger.anchor();
        for vertex in chords.vertices() {
            let span = vertex - from;
            let length = span.norm();
            if length > SHORTEST_LENGTH {
                limit = limit.min(self.limit_along(&(span / length), feedrate));
            }
            from = vertex;
        }
        let steady = self
            .steady_bound(&chords, limit)
            .min(STEADY_EXCESS * tolerance);
        self.arc = Some(ArcUnderWay {
            chords,
            limit,
            tolerance,
            steady,
            serves,
            stops: step.stops(),
        });
    }

    /// The feedrate that the tolerance of an arc and its centripetal acceleration leave.
    fn arc_limit(&self, arc: &Arc<N>, feedrate: f64, tolerance: f64) -> f64 {
        let (start_radius, end_radius) = arc.radii();
        let radius = start_radius.max(end_radius);
        // Of the way, the part that turns.
        let turning = radius * arc.sweep().abs() / arc.length();
        let chain = &self.chain;
        let slow = (2.0 * tolerance / (radius * chain.variance())).sqrt();
        let mut angular = slow * STEADY_EXCESS.sqrt();
        if tolerance < radius {
            let notch = std::f64::consts::TAU / chain.long();
            let share = tolerance / radius;
            angular = angular.min(angular_velocity(|w| chain.gain(w), share, slow, notch));
        }
        // The change of velocity within the longest time constant is at most what an axis may have.
        let (radial, lateral) = arc.frame();
        for axis in 0..N {
            let share = radial[axis].hypot(lateral[axis]);
            if share > 0.0 {
                let acceleration = self.change[axis] / chain.long();
                angular = angular.min((acceleration / (radius * share)).sqrt());
            }
        }
        feedrate.min(angular * radius / turning)
    }

    /// What the bound comes to in the middle of an arc.
    fn steady_bound(&self, chords: &Chords<N>, feed: f64) -> f64 {
        let chain = &self.chain;
        let half = 0.5 * chain.total();
        let turn = 2.0 * (0.5 * chords.angle()).sin();
        let step = chords.longest() / feed;
        let mut sum = 0.5 * chain.position(half);
        let mut distance = step;
        while distance < half {
            sum += chain.position(half - distance);
            distance += step;
        }
        2.0 * turn * feed * sum
    }

    /// Takes the next chord of the arc under way; `false` when there is none.
    fn advance_arc(&mut self) -> bool {
        let Some(under_way) = &mut self.arc else {
            return false;
        };
        match under_way.chords.next() {
            Some((vertex, more)) => {
                let bulge = if more {
                    under_way.chords.outward()
                } else {
                    0.0
                };
                let ArcUnderWay {
                    limit,
                    tolerance,
                    steady,
                    serves,
                    ..
                } = *under_way;
                let from = self.merger.anchor();
                if (vertex - from).norm() <= SHORTEST_LENGTH {
                    self.merger.carry(serves, 0.0, tolerance);
                    return true;
                }
                let serves = self.merger.serve(serves);
                self.merger.go_to(vertex);
                let mut pulse = Pulse::between((from, vertex), limit, tolerance, serves);
                pulse.smooth = more;
                pulse.steady = steady;
                pulse.bulge = bulge;
                self.add(pulse);
            }
            None => {
                let stops = under_way.stops;
                self.arc = None;
                if stops || self.method == Method::PointToPoint || self.finished {
                    self.rest();
                }
            }
        }
        true
    }
}

impl<const N: usize> MotionPlanner<N> for FirInterpolation<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let index = self.index;
        if self.finished {
            return Err(PlanError::Finished { index });
        }
        check_contact(next, self.position).map_err(|reason| PlanError::Path { index, reason })?;
        self.index = index.checked_add(1).ok_or(PlanError::TooMany { index })?;
        while self.advance_arc() {}
        self.position = next.end(self.position);
        let serves = Serves {
            first: index,
            last: index,
        };
        match next.path() {
            Path::Line { end } => {
                self.vertex(*end, 0.0, next, serves);
                if next.stops() || self.method == Method::PointToPoint {
                    self.rest();
                }
            }
            Path::Arc(arc) => {
                let bulge = bulge_of(arc);
                if bulge <= MERGE_SHARE * next.tolerance().length() {
                    self.vertex(arc.end(), bulge, next, serves);
                    if next.stops() || self.method == Method::PointToPoint {
                        self.rest();
                    }
                } else {
                    self.begin_arc(arc, next, serves);
                }
            }
            Path::Dwell { duration } => {
                self.rest();
                self.sweep.push(Command::Pause {
                    duration: *duration,
                    serves,
                });
            }
            _ => {}
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        if !self.finished {
            self.finished = true;
            if self.arc.is_none() {
                self.rest();
            }
        }
        Ok(())
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            if let Some(piece) = self.sweep.pull() {
                return Some(piece);
            }
            if !self.advance_arc() {
                return None;
            }
        }
    }
}

/// Plans a whole toolpath: a loop over the streaming planner.
///
/// # Errors
/// As [`MotionPlanner::push`].
pub fn plan<const N: usize>(
    path: &Toolpath<N>,
    settings: &Settings<N>,
) -> Result<Plan<N>, PlanError> {
    let mut planner = FirInterpolation::new(path.start(), settings);
    let mut plan = Plan::starting_at(path.start());
    for step in path.moves() {
        planner.push(step)?;
        while let Some(piece) = planner.pull() {
            plan.push(piece);
        }
    }
    planner.finish()?;
    while let Some(piece) = planner.pull() {
        plan.push(piece);
    }
    Ok(plan)
}

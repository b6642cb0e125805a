//! Runs the stages of FIR interpolation, from moves to pieces behind the filters.
//!
//! Source: sections 4.2 and 4.3. Not here: any formula; see the chain, the look-ahead and the sweep.

use crate::chords::{Chords, bulge_of};
use crate::lookahead::LookAhead;
use crate::lookahead::arc_feed::ArcFeed;
use crate::lookahead::command::Command;
use crate::pulse::Pulse;
use crate::segment_merger::{MERGE_SHARE, Segment, SegmentMerger, Vertex};
use crate::settings::{Method, Settings};
use crate::sweep::Sweep;
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{
    Arc, Limits, MotionPlanner, Move, MoveRange, Path, PathCursor, Piece, Plan, PlanError,
    Toolpath, Vector, largest_multiple,
};

/// Room for commands that wait to become motion.
const COMMANDS: usize = 4096;

/// Share of the tolerance that is planned with; the rest is for rounding.
const LINE_SHARE: f64 = 0.9999;

/// The same for arcs, whose chords leave a ripple behind the filters.
const ARC_SHARE: f64 = 0.99;

/// Programmed feedrates that differ by more than this factor do not share their time constants.
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
    /// Whether the time constants are chosen.
    chosen: bool,
    /// Programmed feedrate since the motion was last at rest for other time constants.
    class: f64,
    intake: PathCursor<N>,
    merger: SegmentMerger<N>,
    arc: Option<ArcUnderWay<N>>,
    look: LookAhead<N>,
    sweep: Sweep<N>,
}

#[derive(Clone, Copy, Debug)]
struct ArcUnderWay<const N: usize> {
    chords: Chords<N>,
    /// By which the look-ahead knows it.
    number: u32,
    programmed: f64,
    feedrate: f64,
    tolerance: f64,
    serves: MoveRange,
    stops: bool,
}

impl<const N: usize> FirInterpolation<N> {
    /// A planner whose motion begins at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, settings: &Settings<N>) -> Self {
        let look = LookAhead::new(settings.limits, settings.chain.clone());
        Self {
            limits: settings.limits,
            method: settings.method,
            chosen: settings.chain.is_none(),
            class: settings.limits.velocity().max(),
            intake: PathCursor::new(start),
            merger: SegmentMerger::new(start),
            arc: None,
            sweep: Sweep::new(start, look.chain().clone(), COMMANDS),
            look,
        }
    }

    /// Comes to rest for other time constants where the feedrate asks for them.
    fn choose(&mut self, feed: f64) {
        let feed = feed.min(self.limits.velocity().norm());
        if self.chosen && !(feed <= self.class * SAME_CLASS && self.class <= feed * SAME_CLASS) {
            self.come_to_rest();
            self.class = feed;
        }
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

    fn leg(&mut self, from: Vector<N>, leg: &Segment<N>) {
        self.choose(leg.feedrate);
        let tolerance = LINE_SHARE * leg.room;
        let mut pulse = Pulse::between((from, leg.end), leg.feedrate, tolerance, leg.serves);
        let most = largest_multiple(&pulse.direction, self.limits.velocity());
        pulse.feedrate = pulse.feedrate.min(most);
        self.add(pulse);
    }

    /// The end of a straight stretch that strays from the path by `bulge`.
    fn vertex(&mut self, point: Vector<N>, bulge: f64, step: &Move<N>, serves: MoveRange) {
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

    fn begin_arc(&mut self, arc: &Arc<N>, step: &Move<N>, serves: MoveRange) {
        self.flush();
        let programmed = step.feedrate().speed();
        let mut feedrate = programmed;
        self.choose(feedrate);
        let tolerance = ARC_SHARE * step.tolerance().length();
        let chords = Chords::new(*arc, tolerance);
        let bend = ArcFeed::new(arc, &chords, tolerance);
        if feedrate > self.limits.velocity().min() {
            feedrate = feedrate.min(chords.largest_feed(self.limits.velocity()));
        }
        self.arc = Some(ArcUnderWay {
            chords,
            number: self.look.begin_arc(bend, chords.shape(), feedrate),
            programmed,
            feedrate,
            tolerance,
            serves,
            stops: step.stops(),
        });
    }

    /// Takes the next chord of the arc under way; `false` when there is none.
    fn advance_arc(&mut self) -> bool {
        let Some(under_way) = &mut self.arc else {
            return false;
        };
        match under_way.chords.next() {
            Some((vertex, more)) => {
                let ArcUnderWay {
                    number,
                    programmed,
                    feedrate,
                    tolerance,
                    serves,
                    ..
                } = *under_way;
                let from = self.merger.anchor();
                if (vertex - from).norm() <= SHORTEST_LENGTH {
                    self.merger.carry(serves, 0.0, tolerance);
                    return true;
                }
                let (serves, room) = self.merger.serve(serves);
                let tolerance = tolerance.min(ARC_SHARE * room);
                self.merger.go_to(vertex);
                let mut pulse = Pulse::between((from, vertex), feedrate, tolerance, serves);
                pulse.programmed = programmed;
                pulse.smooth = more;
                pulse.arc = Some(number);
                self.add(pulse);
            }
            None => {
                let stops = under_way.stops;
                self.arc = None;
                if stops || self.method == Method::PointToPoint || self.intake.is_closed() {
                    self.rest();
                }
            }
        }
        true
    }
}

impl<const N: usize> MotionPlanner<N> for FirInterpolation<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let index = self.intake.take(next)?;
        while self.advance_arc() {}
        let serves = MoveRange::one(index);
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
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        if self.intake.close() && self.arc.is_none() {
            self.rest();
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
    Plan::of(path, &mut FirInterpolation::new(path.start(), settings))
}

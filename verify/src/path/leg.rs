//! Describes a move of the path to the judge: geometry, bounds, and the motion seen there.
//!
//! Source: the meaning of [`toolglide_kinematics::Tolerance`]. Not here: motion.

use crate::path::bernstein::Cubic;
use crate::path::helix::Helix;
use crate::report::Place;
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::{
    COORDINATE_ROUNDING, LARGEST_MAGNITUDE, LENGTH_SLACK, LIMIT_SLACK, SHORTEST_LENGTH, TIME_SLACK,
};
use toolglide_kinematics::{Move, Path};

/// The points of a move.
#[derive(Clone, Debug)]
enum Shape<const N: usize> {
    Line {
        span: Vector<N>,
        /// One over the squared length; zero for a line that is a point.
        share: f64,
    },
    Arc(Box<Helix<N>>),
}

/// One move, with its bounds and the record of the motion along it.
#[derive(Clone, Debug)]
pub(crate) struct Leg<const N: usize> {
    shape: Shape<N>,
    pub(crate) start: Vector<N>,
    pub(crate) end: Vector<N>,
    pub(crate) length: f64,
    pub(crate) tolerance: f64,
    /// The tolerance with room for rounding.
    pub(crate) allowed: f64,
    /// Tolerance of the corner at the end: the smaller of this move's and the next.
    pub(crate) corner_tolerance: f64,
    pub(crate) corner_allowed: f64,
    /// Room for rounding of a length here.
    pub(crate) slack: f64,
    /// Largest speed; zero where the move is a dwell and bounds none.
    pub(crate) feedrate: f64,
    pub(crate) place: Place,
    pub(crate) stops: bool,
    /// How long to rest, for a dwell.
    pub(crate) dwell: Option<f64>,
    /// Closest approach so far to the corner at the end, when, and how long the motion rested.
    pub(crate) approach: f64,
    pub(crate) approach_time: f64,
    pub(crate) stopped: bool,
    pub(crate) rested: f64,
    /// The rest going on now.
    pub(crate) resting: f64,
    /// How many points inside an arc were passed, and the time of the last.
    pub(crate) waypoints_passed: u64,
}

impl<const N: usize> Leg<N> {
    pub(crate) fn new(next: &Move<N>, start: Vector<N>, mv: u32) -> Self {
        let end = next.end(start);
        let mut reach = start.amax().max(end.amax());
        let (shape, dwell) = match next.path() {
            Path::Arc(arc) => {
                let (start_radius, end_radius) = arc.radii();
                reach = reach.max(arc.center().amax() + start_radius.max(end_radius));
                (Shape::Arc(Box::new(Helix::new(arc))), None)
            }
            Path::Line { .. } => (line(start, end), None),
            Path::Dwell { duration } => (line(start, end), Some(*duration)),
        };
        let slack = length_slack(reach);
        let tolerance = next.tolerance().length();
        let allowed = tolerance * (1.0 + LIMIT_SLACK) + slack;
        Self {
            shape,
            start,
            end,
            length: next.length(start),
            tolerance,
            allowed,
            corner_tolerance: tolerance,
            corner_allowed: allowed,
            slack,
            feedrate: if dwell.is_some() {
                0.0
            } else {
                next.feedrate().speed()
            },
            place: Place {
                mv,
                line: next.line(),
            },
            stops: next.stops(),
            dwell,
            approach: f64::INFINITY,
            approach_time: 0.0,
            stopped: false,
            rested: 0.0,
            resting: 0.0,
            waypoints_passed: 0,
        }
    }

    /// Says which move follows, whose tolerance the corner between them must respect too.
    pub(crate) fn meets(&mut self, next: &Self) {
        self.corner_tolerance = self.tolerance.min(next.tolerance);
        self.corner_allowed = self.allowed.min(next.allowed);
    }

    /// Whether there is nothing to do on this move, so that a motion may leave it out.
    pub(crate) fn is_empty(&self) -> bool {
        self.length <= SHORTEST_LENGTH && !self.dwell.is_some_and(|time| time > TIME_SLACK)
    }

    /// Direction of a straight move; `None` on arcs and where there is no length.
    pub(crate) fn direction(&self) -> Option<Vector<N>> {
        match &self.shape {
            Shape::Line { span, share } if *share > 0.0 => Some(span * share.sqrt()),
            _ => None,
        }
    }

    /// Distance of a point from the move.
    pub(crate) fn distance(&self, point: &Vector<N>) -> f64 {
        match &self.shape {
            Shape::Line { span, share } => {
                let offset = point - self.start;
                let along = (offset.dot(span) * share).clamp(0.0, 1.0);
                if along >= 1.0 {
                    (point - self.end).norm()
                } else {
                    (offset - span * along).norm()
                }
            }
            Shape::Arc(helix) => helix.nearest(point).1,
        }
    }

    /// The point of the move nearest to another, and the direction of travel there; zero on a move of no length.
    pub(crate) fn foot(&self, point: &Vector<N>) -> (Vector<N>, Vector<N>) {
        match &self.shape {
            Shape::Line { span, share } => {
                let along = ((point - self.start).dot(span) * share).clamp(0.0, 1.0);
                (
                    self.start + span * along,
                    span.try_normalize(0.0).unwrap_or_else(Vector::zeros),
                )
            }
            Shape::Arc(helix) => {
                let (share, _) = helix.nearest(point);
                (helix.point(share), helix.arc.tangent(share))
            }
        }
    }

    /// Bernstein coefficients of a cubic that is nowhere below the distance of the curve.
    ///
    /// The distance from a line is convex, so that its values at the control points do.
    pub(crate) fn majorant(&self, curve: &Cubic<N>) -> [f64; 4] {
        match &self.shape {
            Shape::Line { .. } => [
                self.distance(&curve.points[0]),
                self.distance(&curve.points[1]),
                self.distance(&curve.points[2]),
                self.distance(&curve.points[3]),
            ],
            Shape::Arc(helix) => helix.majorant(curve),
        }
    }

    /// How many points inside the move the motion must pass in turn: those which cut an arc in
    /// parts of less than half a turn, so that no turn can be left out.
    pub(crate) fn waypoints(&self) -> u64 {
        match &self.shape {
            Shape::Line { .. } => 0,
            // From its centre all of it is within tolerance: there is no turn to leave out.
            Shape::Arc(helix) if helix.radius() <= self.allowed => 0,
            Shape::Arc(helix) => helix.waypoints(),
        }
    }

    /// Passes all waypoints of an arc that may lie within `room` of its centre as a whole.
    pub(crate) fn pass_if_small(&mut self, room: f64) {
        if let Shape::Arc(helix) = &self.shape
            && helix.radius() <= room
        {
            self.waypoints_passed = helix.waypoints();
        }
    }

    /// The waypoint of a number, counted from 0, and its share of the turn.
    #[allow(
        clippy::cast_precision_loss,
        reason = "an arc of 2^32 turns has fewer than 2^53 waypoints"
    )]
    pub(crate) fn waypoint(&self, index: u64) -> (Vector<N>, f64) {
        match &self.shape {
            Shape::Line { .. } => (self.end, 1.0),
            Shape::Arc(helix) => {
                let share = (index + 1) as f64 / (helix.waypoints() + 1) as f64;
                (helix.point(share), share)
            }
        }
    }

    /// Takes note that the motion is at a distance from the corner at the end.
    pub(crate) fn comes_near(&mut self, distance: f64, time: f64) {
        if distance < self.approach {
            self.approach = distance;
            self.approach_time = time;
        }
    }

    /// Whether a dwell has lasted.
    pub(crate) fn has_dwelt(&self) -> bool {
        self.dwell
            .is_none_or(|duration| self.rested >= duration * (1.0 - LIMIT_SLACK) - TIME_SLACK)
    }
}

/// Whether every coordinate is a number to reckon with.
pub(crate) fn is_measurable<const N: usize>(vector: &Vector<N>) -> bool {
    vector
        .iter()
        .all(|coordinate| coordinate.abs() <= LARGEST_MAGNITUDE)
}

/// Room for the rounding of a length among coordinates of this size.
pub(crate) fn length_slack(coordinate: f64) -> f64 {
    LENGTH_SLACK + COORDINATE_ROUNDING * coordinate
}

fn line<const N: usize>(start: Vector<N>, end: Vector<N>) -> Shape<N> {
    let span = end - start;
    let square = span.norm_squared();
    Shape::Line {
        span,
        share: if square > 0.0 { square.recip() } else { 0.0 },
    }
}

//! Rounds the duration of motion between rests to whole set-points, with every displacement kept.
//!
//! Source: section 2.3.2 rounds durations so that the number of samples is an integer. Time is stretched evenly from one rest
//! to the next, by less than a period, so that no limit is exceeded and nothing jumps. Not here: planning.

use std::collections::VecDeque;
use toolglide_kinematics::{
    MotionPlanner, Move, MoveRange, Piece, PlanError, Sample, SamplePeriod, WindowTally,
};

/// Pieces that may wait for a rest; a longer section ends with a rest that fills its last period instead.
const MAX_PIECES: usize = 8192;

/// Velocity, mm/s, and acceleration, mm/s², below which an axis rests.
const REST_VELOCITY: f64 = 1e-7;
/// As above.
const REST_ACCELERATION: f64 = 1e-4;

/// A duration is whole within this share of a period.
const WHOLE: f64 = 1e-6;

/// By how much a rest is behind its set-point, of a period: less than rows tell apart.
const TRIFLE: f64 = 1e-7;

/// A planner whose motion rests on whole set-points alone.
pub(crate) struct RoundToPeriod<const N: usize> {
    planner: Box<dyn MotionPlanner<N>>,
    period: f64,
    /// Pieces since the last rest.
    section: Vec<Piece<N>>,
    /// How long everything that was handed out lasts, s.
    clock: f64,
    /// Whether a part of the section could not wait for its rest.
    early: bool,
    ready: VecDeque<Piece<N>>,
    finished: bool,
}

impl<const N: usize> RoundToPeriod<N> {
    /// The motion of a planner, for set-points of a period.
    pub(crate) fn new(planner: Box<dyn MotionPlanner<N>>, period: SamplePeriod) -> Self {
        Self {
            planner,
            period: period.seconds(),
            section: Vec::new(),
            clock: 0.0,
            early: false,
            ready: VecDeque::new(),
            finished: false,
        }
    }

    /// Ends the section under way at a rest.
    fn round(&mut self) {
        let duration: f64 = self.section.iter().map(Piece::duration).sum();
        let periods = ((self.clock + duration) / self.period - WHOLE).ceil();
        // A trifle beyond the set-point, so that it belongs to the motion.
        let whole = periods * self.period + TRIFLE * self.period - self.clock;
        if self.early {
            // What has been handed out cannot be stretched any more: a rest fills the last period.
            let last = self.section.last().copied();
            self.ready.extend(self.section.drain(..));
            if let Some(last) = last.filter(|_| whole > duration) {
                let rest = Sample::at_rest(last.end());
                let serves = MoveRange::one(last.serves().last);
                let fill = Piece::new(&rest, whole - duration, last.end(), serves);
                self.ready.push_back(fill);
            }
        } else if duration > 0.0 {
            let stretch = (whole / duration).max(1.0);
            for piece in self.section.drain(..) {
                self.ready.push_back(stretched(&piece, stretch));
            }
        } else {
            self.ready.extend(self.section.drain(..));
        }
        self.clock += whole.max(duration);
        self.early = false;
    }

    fn take(&mut self, piece: Piece<N>) {
        let end = piece.at(piece.duration());
        self.section.push(piece);
        let rests =
            end.velocity.amax() < REST_VELOCITY && end.acceleration.amax() < REST_ACCELERATION;
        if rests {
            self.round();
        } else if self.section.len() >= MAX_PIECES {
            let early = self.section.drain(..MAX_PIECES / 2);
            self.early = true;
            for piece in early {
                self.clock += piece.duration();
                self.ready.push_back(piece);
            }
        }
    }
}

/// A piece in slower time.
fn stretched<const N: usize>(piece: &Piece<N>, by: f64) -> Piece<N> {
    let start = piece.at(0.0);
    let slower = Sample {
        position: start.position,
        velocity: start.velocity / by,
        acceleration: start.acceleration / (by * by),
        jerk: start.jerk / (by * by * by),
    };
    Piece::new(&slower, piece.duration() * by, piece.end(), piece.serves())
}

impl<const N: usize> MotionPlanner<N> for RoundToPeriod<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        self.planner.push(next)
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        self.finished = true;
        self.planner.finish()
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            if let Some(piece) = self.ready.pop_front() {
                return Some(piece);
            }
            match self.planner.pull() {
                Some(piece) => self.take(piece),
                None if self.finished && !self.section.is_empty() => self.round(),
                None => return None,
            }
        }
    }

    fn windows(&self) -> Option<WindowTally> {
        self.planner.windows()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{Feedrate, Limits, Tolerance, Vector};
    use toolglide_smoothing::{KinematicSmoothing, Settings};

    #[test]
    fn a_motion_ends_on_a_set_point_and_keeps_its_ends_and_limits() {
        let limits = Limits::<2>::uniform(500.0, 2500.0, 2e5).unwrap();
        let planner = KinematicSmoothing::new(Vector::zeros(), &Settings::new(limits));
        let period = SamplePeriod::new(1e-3).unwrap();
        let mut rounded = RoundToPeriod::new(Box::new(planner), period);
        let points = [[10.0, 0.0], [10.0, 10.0], [3.0, 7.0]].map(Vector::<2>::from);
        for (index, point) in points.iter().enumerate() {
            let next = Move::line_to(
                *point,
                Feedrate::new(100.0).unwrap(),
                Tolerance::new(0.01).unwrap(),
            );
            let next = next.unwrap();
            let next = if index == 1 {
                next.with_exact_stop()
            } else {
                next
            };
            rounded.push(&next).unwrap();
        }
        rounded.finish().unwrap();
        let (mut time, mut at, mut velocity) = (0.0, Vector::<2>::zeros(), Vector::zeros());
        let mut rests = 0;
        while let Some(piece) = rounded.pull() {
            let (start, end) = (piece.at(0.0), piece.at(piece.duration()));
            assert!((start.position - at).norm() < 1e-9, "no jump at {time}");
            assert!(
                (start.velocity - velocity).norm() < 1e-6,
                "no step at {time}"
            );
            assert!(end.acceleration.amax() <= 2500.0 + 1e-6, "{end:?}");
            (at, velocity) = (piece.end(), end.velocity);
            time += piece.duration();
            if velocity.norm() < 1e-6 {
                rests += 1;
                let off = time / 1e-3 - (time / 1e-3).round();
                assert!(off.abs() < 1e-6, "a rest at {time}");
            }
        }
        assert_eq!(rests, 2, "the stop and the end");
        assert_eq!(at, points[2]);
    }
}

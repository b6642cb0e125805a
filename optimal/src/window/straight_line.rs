//! Plans motion along a straight line in closed form, the fallback that always exists.
//!
//! Source: the seven phases of section 3.3.1. Where no window can be solved, the next straight line is
//! travelled to a stop; and the middle of a long move is travelled in this way. Not here: when that is.

use crate::path::spans::{Cruise, Span};
use crate::window::shaped_line::Shaper;
use toolglide_kinematics::{MoveRange, PathLimits, Piece, Sample, Vector};
use toolglide_profiles::{SCurve, SCurveBoundary};

/// Spans from the beginning that lie on one line.
pub(crate) fn on_one_line<'a, const N: usize>(spans: impl Iterator<Item = &'a Span<N>>) -> usize {
    let mut count = 0;
    for span in spans {
        count += 1;
        if !span.goes_on {
            break;
        }
    }
    count
}

/// Duration of a span from rest to rest, s.
pub(crate) fn stop_to_stop<const N: usize>(span: &Span<N>) -> f64 {
    connection(&span.limits, [0.0, 0.0])
        .duration_over(span.length)
        .unwrap_or(f64::INFINITY)
}

fn connection(limits: &PathLimits, [from, to]: [f64; 2]) -> SCurveBoundary {
    SCurveBoundary {
        from: [from, 0.0],
        to: [to, 0.0],
        limits: *limits,
    }
}

/// A straight line that is travelled in closed form.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line<const N: usize> {
    pub(crate) start: Vector<N>,
    pub(crate) end: Vector<N>,
    pub(crate) direction: Vector<N>,
    pub(crate) limits: PathLimits,
    pub(crate) serves: MoveRange,
}

impl<const N: usize> Line<N> {
    /// The line of spans that lie on one.
    pub(crate) fn of(first: &Span<N>, last: &Span<N>) -> Self {
        Self {
            start: first.start,
            end: last.end,
            direction: first.direction,
            limits: first.limits,
            serves: first.serves,
        }
    }

    /// The middle of a long move within limits.
    pub(crate) fn middle(cruise: &Cruise<N>, limits: PathLimits) -> Self {
        Self {
            start: cruise.start,
            end: cruise.end,
            direction: cruise.direction,
            limits,
            serves: cruise.serves,
        }
    }

    /// Pieces of the shaped motion from its start to its end with these speeds there (mm/s), without acceleration;
    /// whether it is long enough.
    pub(crate) fn travel_shaped(
        &self,
        [from, to]: [f64; 2],
        shaper: &mut Shaper,
        mut take: impl FnMut(Piece<N>),
    ) -> bool {
        // The mean of the same motion begun later lags behind it.
        let (longest, mean) = shaper.delays();
        let length = (self.end - self.start).norm();
        let shaped = length - from * mean - to * (longest - mean);
        let Some(feed) = (shaped > 0.0)
            .then(|| SCurve::over(shaped, &connection(&self.limits, [from, to])).ok())
            .flatten()
        else {
            return false;
        };
        let (mut position, mut velocity, mut acceleration) = (0.0_f64, from, 0.0_f64);
        let mut pieces = shaper.shape(&feed).peekable();
        while let Some((duration, jerk)) = pieces.next() {
            let start = Sample {
                position: self.start + self.direction * position,
                velocity: self.direction * velocity,
                acceleration: self.direction * acceleration,
                jerk: self.direction * jerk,
            };
            let h = duration;
            position += (velocity + (acceleration + jerk * (h / 3.0)) * (0.5 * h)) * h;
            velocity += (acceleration + jerk * (0.5 * h)) * h;
            acceleration += jerk * h;
            let end = if pieces.peek().is_none() {
                self.end
            } else {
                self.start + self.direction * position
            };
            take(Piece::new(&start, duration, end, self.serves));
        }
        true
    }

    /// Pieces from its start to its end with these speeds there (mm/s), without acceleration; whether
    /// it is long enough.
    pub(crate) fn travel(&self, speeds: [f64; 2], mut take: impl FnMut(Piece<N>)) -> bool {
        let length = (self.end - self.start).norm();
        let Ok(feed) = SCurve::over(length, &connection(&self.limits, speeds)) else {
            return false;
        };
        let at = |position: f64| -> Vector<N> {
            if position > 0.0 {
                self.start + self.direction * position
            } else {
                self.start
            }
        };
        let Some(final_phase) = feed.phases().iter().rposition(|phase| phase.duration > 0.0) else {
            return false;
        };
        for (index, (phase, state)) in feed.phases().iter().zip(feed.starts()).enumerate() {
            if phase.duration <= 0.0 {
                continue;
            }
            let start = Sample {
                position: at(state.position),
                velocity: self.direction * state.velocity,
                acceleration: self.direction * state.acceleration,
                jerk: self.direction * phase.jerk,
            };
            let end = if index == final_phase {
                self.end
            } else {
                at(state.after(phase.duration).position)
            };
            take(Piece::new(&start, phase.duration, end, self.serves));
        }
        true
    }
}

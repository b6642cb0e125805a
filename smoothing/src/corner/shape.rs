//! Describes a corner blend in numbers: scaled by the window, unrolled into pieces by the planner.
//!
//! Source: sections 2.3 and 3.2, in the vector form where a corner is a mixture of the incoming and
//! the outgoing direction. Not here: how large it may be, see the blenders.

use crate::corner::stop_start::Start;
use toolglide_kinematics::{Corner, MoveRange, Piece, Sample, Vector};
use toolglide_profiles::{Boundary, CornerMotion};

/// How the velocity turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Form {
    /// No turn of its own: straight through the corner, or at rest in it.
    #[default]
    Through,
    /// From the incoming to the outgoing direction along an S-curve, which raises the acceleration
    /// for `ramp`, holds it, and lowers it for `ramp` again.
    Interrupted {
        /// Duration of each of the two ramps.
        ramp: f64,
    },
    /// Constant jerk over the whole corner.
    Uninterrupted,
    /// A stop along the incoming and a start along the outgoing move, overlapped; each holds its
    /// acceleration but for a `ramp` at rest.
    StopStart {
        /// Duration of the ramp of either.
        ramp: f64,
    },
}

/// A corner motion without its geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlendShape {
    /// Where and how it leaves the incoming move.
    pub entry: Boundary,
    /// Where and how it joins the outgoing move.
    pub exit: Boundary,
    /// How long the corner takes.
    pub duration: f64,
    /// How the velocity turns.
    pub form: Form,
}

impl BlendShape {
    /// A full stop at the corner itself.
    pub const STOP: Self = Self::through(0.0);

    /// Straight on at a speed, without a turn of its own.
    #[must_use]
    pub const fn through(speed: f64) -> Self {
        let boundary = Boundary {
            distance: 0.0,
            speed,
            acceleration: 0.0,
        };
        Self::symmetric(boundary, 0.0, Form::Through)
    }

    /// A turn that leaves one move as it joins the other.
    #[must_use]
    pub const fn symmetric(boundary: Boundary, duration: f64, form: Form) -> Self {
        Self {
            entry: boundary,
            exit: boundary,
            duration,
            form,
        }
    }

    /// The same turn with all times multiplied by `scale` (0 to 1) at the same jerk.
    ///
    /// Accelerations shrink with the scale, speeds with its square, lengths and the corner error with
    /// its cube, so that a smaller turn keeps every limit that the full one keeps.
    #[must_use]
    #[inline]
    pub fn scaled(&self, scale: f64) -> Self {
        Self {
            entry: scaled(&self.entry, scale),
            exit: scaled(&self.exit, scale),
            duration: self.duration * scale,
            form: match self.form {
                Form::Interrupted { ramp } => Form::Interrupted { ramp: ramp * scale },
                Form::StopStart { ramp } => Form::StopStart { ramp: ramp * scale },
                form => form,
            },
        }
    }

    /// Whether the motion rests at the corner.
    #[must_use]
    pub fn is_stop(&self) -> bool {
        self.entry.speed <= 0.0
    }

    /// Whether the jerk is constant over the whole corner.
    #[must_use]
    pub fn is_uninterrupted(&self) -> bool {
        self.form == Form::Uninterrupted
    }
}

#[inline]
fn scaled(boundary: &Boundary, scale: f64) -> Boundary {
    let square = scale * scale;
    Boundary {
        distance: boundary.distance * square * scale,
        speed: boundary.speed * square,
        acceleration: boundary.acceleration * scale,
    }
}

/// A corner motion with its geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CornerBlend<const N: usize> {
    shape: BlendShape,
    corner: Corner<N>,
}

impl<const N: usize> CornerBlend<N> {
    pub(crate) fn new(shape: BlendShape, corner: Corner<N>) -> Self {
        Self { shape, corner }
    }

    /// The motion without its geometry.
    #[must_use]
    pub fn shape(&self) -> &BlendShape {
        &self.shape
    }

    /// The corner that it turns.
    #[must_use]
    pub fn corner(&self) -> &Corner<N> {
        &self.corner
    }

    /// Unrolls a part of the motion, phase by phase; nothing for a full stop.
    pub fn pieces(&self, part: Part, serves: MoveRange, mut take: impl FnMut(Piece<N>)) {
        let BlendShape {
            entry,
            exit,
            duration,
            form,
        } = self.shape;
        let Boundary {
            speed,
            acceleration,
            ..
        } = entry;
        if duration <= 0.0 {
            return;
        }
        let Corner {
            point,
            incoming,
            outgoing,
            ..
        } = self.corner;
        let turned = outgoing - incoming;
        let none = Vector::zeros();
        // Up to three phases of constant jerk, the same forwards and backwards.
        let phases = match form {
            Form::Through => return,
            Form::Uninterrupted => {
                // Summed before it is multiplied: near a reversal the directions all but cancel.
                let ratio = exit.acceleration / acceleration;
                let half = (incoming + outgoing * ratio) * (acceleration / duration);
                [(0.5 * duration, half), (0.0, none), (0.5 * duration, half)]
            }
            Form::Interrupted { ramp } => {
                let hold = (duration - 2.0 * ramp).max(0.0);
                let jerk = turned * (speed / ((ramp + hold) * ramp));
                [(ramp, jerk), (hold, none), (ramp, -jerk)]
            }
            Form::StopStart { ramp } => {
                let (start, stop) = (
                    outgoing * (acceleration / ramp),
                    incoming * (acceleration / ramp),
                );
                if duration >= 2.0 * ramp {
                    [(ramp, start), (duration - 2.0 * ramp, none), (ramp, stop)]
                } else {
                    let alone = duration - ramp;
                    [(alone, start), (ramp - alone, start + stop), (alone, stop)]
                }
            }
        };
        let mut state = Sample {
            position: point - incoming * entry.distance,
            velocity: incoming * speed,
            acceleration: incoming * -acceleration,
            jerk: none,
        };
        let end = point + outgoing * exit.distance;
        let whole = part == Part::Whole;
        if whole && form == Form::Uninterrupted {
            state.jerk = phases[0].1;
            take(Piece::new(&state, duration, end, serves));
            return;
        }
        let middle = 0.5 * duration;
        let mut time = 0.0;
        for (index, (length, jerk)) in phases.into_iter().enumerate() {
            state.jerk = jerk;
            let phase_end = if index == 2 { duration } else { time + length };
            let (from, to) = match part {
                Part::Whole => (time, phase_end),
                Part::FirstHalf => (time, phase_end.min(middle)),
                Part::SecondHalf => (time.max(middle), phase_end),
            };
            if to > from {
                let start = after(&state, from - time);
                let next = after(&state, to - time);
                let piece_end = if to >= duration { end } else { next.position };
                take(Piece::new(&start, to - from, piece_end, serves));
            }
            state = after(&state, length);
            time = phase_end;
        }
    }
}

/// Which part of a corner motion is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// All of it.
    Whole,
    /// From its beginning to its middle.
    FirstHalf,
    /// From its middle to its end.
    SecondHalf,
}

fn after<const N: usize>(state: &Sample<N>, time: f64) -> Sample<N> {
    Sample {
        position: state.position
            + (state.velocity + (state.acceleration * 0.5 + state.jerk * (time / 6.0)) * time)
                * time,
        velocity: state.velocity + (state.acceleration + state.jerk * (0.5 * time)) * time,
        acceleration: state.acceleration + state.jerk * time,
        jerk: state.jerk,
    }
}

impl<const N: usize> CornerMotion for CornerBlend<N> {
    fn duration(&self) -> f64 {
        self.shape.duration
    }

    fn entry(&self) -> Boundary {
        self.shape.entry
    }

    fn exit(&self) -> Boundary {
        self.shape.exit
    }

    fn corner_error(&self) -> f64 {
        let BlendShape {
            entry,
            exit,
            duration,
            form,
        } = self.shape;
        let Boundary {
            speed,
            acceleration,
            ..
        } = entry;
        let half_sine = self.corner.half_turn_sine();
        match form {
            Form::Through => 0.0,
            Form::Uninterrupted => {
                let roots = entry.distance.cbrt() + exit.distance.cbrt();
                2.0 * half_sine * entry.distance * exit.distance / roots.powi(3)
            }
            Form::Interrupted { ramp } => {
                // Half-way the S-curve has covered this much less than the straight line would have.
                let hold = (duration - 2.0 * ramp).max(0.0);
                let held = speed / (ramp + hold);
                2.0 * half_sine * (speed * speed / (8.0 * held) + held * ramp * ramp / 24.0)
            }
            Form::StopStart { ramp } => {
                let start = Start {
                    jerk: acceleration / ramp,
                    acceleration,
                };
                2.0 * half_sine * start.distance_at(0.5 * duration)
            }
        }
    }
}

//! Defines the questions that every profile answers.
//!
//! Source: section 2.2. Not here: any law.

/// Position, velocity, acceleration and jerk of one coordinate at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Position.
    pub position: f64,
    /// Velocity.
    pub velocity: f64,
    /// Acceleration.
    pub acceleration: f64,
    /// Jerk; at a knot, that of the phase that follows.
    pub jerk: f64,
}

impl State {
    /// A state of a given velocity and acceleration at the origin.
    #[must_use]
    pub fn moving(velocity: f64, acceleration: f64) -> Self {
        Self {
            velocity,
            acceleration,
            ..Self::default()
        }
    }

    /// The state after `time` of this jerk.
    #[must_use]
    pub fn after(&self, time: f64) -> Self {
        let Self {
            position,
            velocity,
            acceleration,
            jerk,
        } = *self;
        Self {
            position: position
                + time * (velocity + time * (0.5 * acceleration + time * jerk / 6.0)),
            velocity: velocity + time * (acceleration + 0.5 * time * jerk),
            acceleration: acceleration + time * jerk,
            jerk,
        }
    }
}

/// A law of motion of one coordinate over `0.0..=duration`.
pub trait Profile {
    /// How long it lasts.
    fn duration(&self) -> f64;
    /// State at `time`; a time outside the motion gives the nearer end.
    fn at(&self, time: f64) -> State;
    /// Increasing times, ends included, between which the motion is one polynomial.
    fn knots(&self) -> &[f64];
    /// State at the beginning.
    fn start(&self) -> State {
        self.at(0.0)
    }
    /// State at the end.
    fn end(&self) -> State {
        self.at(self.duration())
    }
}

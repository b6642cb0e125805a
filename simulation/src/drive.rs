//! Runs one feed drive: measures, controls and moves by one servo period at a time.
//!
//! Source: the P-PI cascade with feedforward of sections 2.3.2 and 3.5, the plant under held inputs, and friction by backward
//! Euler in velocity. A tick allocates nothing. Not here: several axes, see [`Simulator`](crate::Simulator).

use crate::friction::Slip;
use crate::model::DriveModel;
use crate::plant::MAX_STATES;
use crate::settings::MAX_DELAY;

/// Adding and taking away this rounds a double below 2^51 to the nearest whole number: 1.5 times 2^52.
const ROUNDING: f64 = 6_755_399_441_055_744.0;

/// One axis that runs.
#[derive(Clone, Debug)]
pub struct Drive {
    model: DriveModel,
    state: [f64; MAX_STATES],
    slip: Slip,
    seen: f64,
    velocity: f64,
    integral: f64,
    /// Commands that wait for the dead time, the newest first.
    waiting: [f64; MAX_DELAY + 2],
    set_points: [f64; 2],
    /// Where the table is behind the play.
    table: f64,
    command: f64,
    friction: f64,
    saturated: bool,
}

impl Drive {
    /// A drive at rest at a position.
    #[must_use]
    pub fn new(model: &DriveModel, position: f64) -> Self {
        let mut state = [0.0; MAX_STATES];
        state[0] = position;
        Self {
            slip: Slip::new(&model.settings.friction),
            model: model.clone(),
            state,
            seen: position,
            velocity: 0.0,
            integral: 0.0,
            waiting: [0.0; MAX_DELAY + 2],
            set_points: [position; 2],
            table: position,
            command: 0.0,
            friction: 0.0,
            saturated: false,
        }
    }

    /// Position of the motor, mm or rad.
    #[must_use]
    pub fn position(&self) -> f64 {
        self.state[0]
    }

    /// Velocity of the motor, mm/s or rad/s.
    #[must_use]
    pub fn velocity(&self) -> f64 {
        self.state[1]
    }

    /// Position of the table behind the play of the drive, mm or rad.
    #[must_use]
    pub fn table(&self) -> f64 {
        self.table
    }

    /// Displacement and velocity of a mode relative to the drive.
    #[must_use]
    pub fn mode(&self, index: usize) -> [f64; 2] {
        let at = 3 + 2 * index;
        match (self.state.get(at), self.state.get(at + 1)) {
            (Some(&displacement), Some(&velocity)) => [displacement, velocity],
            _ => [0.0; 2],
        }
    }

    /// Specific force that was last commanded, mm/s² or rad/s².
    #[must_use]
    pub fn command(&self) -> f64 {
        self.command
    }

    /// Specific friction force of the last step, mm/s² or rad/s².
    #[must_use]
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// Whether the last command was at its limit.
    #[must_use]
    pub fn is_saturated(&self) -> bool {
        self.saturated
    }

    /// The drive that runs.
    #[must_use]
    pub fn model(&self) -> &DriveModel {
        &self.model
    }

    /// Measures, controls and moves by one servo period towards a set-point, mm or rad.
    #[inline]
    pub fn tick(&mut self, set_point: f64) {
        let command = self.control(set_point);
        let delay = self.model.sampled.delay;
        self.waiting.copy_within(0..=delay, 1);
        self.waiting[0] = command;
        self.command = command;
        self.advance(self.waiting[delay], self.waiting[delay + 1]);
    }

    /// The command of this period.
    #[inline]
    fn control(&mut self, set_point: f64) -> f64 {
        let settings = &self.model.settings;
        let gains = &self.model.gains;
        let period = settings.servo_period;
        let mut seen = 0.0;
        for (weight, state) in self.model.measured[..self.model.states]
            .iter()
            .zip(&self.state)
        {
            seen += weight * state;
        }
        if settings.encoder_step > 0.0 {
            let counts = seen / settings.encoder_step;
            seen = ((counts + ROUNDING) - ROUNDING) * settings.encoder_step;
        }
        let raw = (seen - self.seen) / period;
        self.seen = seen;
        self.velocity += self.model.sampled.smoothing * (raw - self.velocity);
        let rate = (set_point - self.set_points[0]) / period;
        let change = ((set_point - self.set_points[0]) - (self.set_points[0] - self.set_points[1]))
            / (period * period);
        self.set_points = [set_point, self.set_points[0]];
        let forward = settings.feedforward.applied();
        let error = gains.position * (set_point - seen) + forward.velocity * rate - self.velocity;
        let mut wanted = gains.velocity * error + self.integral + forward.acceleration * change;
        if forward.friction {
            wanted +=
                settings.friction.coulomb * (rate / forward.friction_velocity).clamp(-1.0, 1.0);
        }
        let command = wanted.clamp(-settings.force_limit, settings.force_limit);
        let over = wanted - command;
        // The integral stops while the force is at its limit and the error asks for more.
        if over * error <= 0.0 {
            self.integral += gains.integral * error * period;
        }
        self.saturated = over.abs() > 0.0;
        command
    }

    /// Moves by one servo period under the command of this period and of the one before.
    #[inline]
    pub(crate) fn advance(&mut self, new: f64, old: f64) {
        let n = self.model.states;
        let count = self.model.substeps.len();
        #[allow(clippy::cast_precision_loss, reason = "at most ten substeps")]
        let length = self.model.settings.servo_period / count as f64;
        for step in &self.model.substeps {
            let mut next = [0.0; MAX_STATES];
            for (i, next) in next[..n].iter_mut().enumerate() {
                let mut sum = step.new[i] * new + step.old[i] * old;
                for (weight, state) in step.a[i][..n].iter().zip(&self.state) {
                    sum += weight * state;
                }
                *next = sum;
            }
            let gain = -step.friction[1];
            self.friction = self.slip.step(next[1], gain, self.state[1], length);
            for (next, effect) in next[..n].iter_mut().zip(&step.friction) {
                *next += effect * self.friction;
            }
            self.state = next;
        }
        let half = 0.5 * self.model.settings.backlash;
        self.table = if half > 0.0 {
            self.table.clamp(self.state[0] - half, self.state[0] + half)
        } else {
            self.state[0]
        };
    }

    /// States of the loop: plant, measured position and velocity, commands that wait, and the integral where there is one.
    pub(crate) fn loop_states(&self) -> usize {
        let integral = usize::from(self.model.gains.integral > 0.0);
        self.model.states + 3 + self.model.sampled.delay + integral
    }

    pub(crate) fn set_loop_state(&mut self, index: usize, value: f64) {
        let n = self.model.states;
        match index {
            i if i < n => self.state[i] = value,
            i if i == n => self.seen = value,
            i if i == n + 1 => self.velocity = value,
            i if i <= n + 2 + self.model.sampled.delay => self.waiting[i - n - 2] = value,
            _ => self.integral = value,
        }
    }

    pub(crate) fn loop_state(&self) -> Vec<f64> {
        let mut all = self.state[..self.model.states].to_vec();
        all.extend([self.seen, self.velocity]);
        all.extend_from_slice(&self.waiting[..=self.model.sampled.delay]);
        if self.model.gains.integral > 0.0 {
            all.push(self.integral);
        }
        all
    }
}

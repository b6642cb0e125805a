//! Describes a drive as machine files do: control loop, feedforward, force, friction, encoder and modes.
//!
//! Not here: what follows from it, see [`DriveModel`](crate::DriveModel).

use crate::error::DriveError;
use crate::friction::Friction;
use crate::gains::GainSettings;
use crate::plant::{FlexibleMode, Plant, not_negative};

/// Longest dead time, servo periods.
pub(crate) const MAX_DELAY: usize = 20;

/// Coarsest encoder, mm or rad.
const COARSEST_ENCODER: f64 = 1.0;

/// Feedforward of the cascade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feedforward {
    /// Share of the velocity of the set-points.
    pub velocity: f64,
    /// Share of their acceleration, given as force.
    pub acceleration: f64,
    /// Whether Coulomb friction is given as force in the direction of motion.
    pub friction: bool,
    /// Velocity at which that force is reached, mm/s or rad/s.
    pub friction_velocity: f64,
    /// Whether set-points pass through a zero-phase-error tracking filter (Tomizuka 1987) instead of the velocity and
    /// acceleration feedforward.
    pub zero_phase: bool,
}

impl Feedforward {
    /// Velocity feedforward alone.
    pub const VELOCITY: Self = Self {
        velocity: 1.0,
        acceleration: 0.0,
        friction: false,
        friction_velocity: 1.0,
        zero_phase: false,
    };

    /// No feedforward.
    pub const NONE: Self = Self {
        velocity: 0.0,
        ..Self::VELOCITY
    };

    /// What the cascade applies itself: neither velocity nor acceleration behind a zero-phase filter.
    #[inline]
    pub(crate) fn applied(&self) -> Self {
        let share = if self.zero_phase { 0.0 } else { 1.0 };
        Self {
            velocity: share * self.velocity,
            acceleration: share * self.acceleration,
            ..*self
        }
    }
}

/// One drive. Lengths are in mm or rad, forces are specific: mm/s² or rad/s², force per mass.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveSettings {
    /// Period of position and velocity control, s.
    pub servo_period: f64,
    /// Gains of the cascade, or what they follow from.
    pub gains: GainSettings,
    /// Feedforward.
    pub feedforward: Feedforward,
    /// Bandwidth of the current loop, Hz.
    pub current_loop: f64,
    /// Time between measurement and force, s.
    pub dead_time: f64,
    /// Corner frequency of the low-pass filter of the measured velocity, Hz; `None` for none.
    pub velocity_filter: Option<f64>,
    /// Step of the encoder, mm or rad; 0 for none.
    pub encoder_step: f64,
    /// Largest specific force; infinite for none.
    pub force_limit: f64,
    /// Friction with a limit.
    pub friction: Friction,
    /// Viscous friction, 1/s.
    pub viscous: f64,
    /// Play between motor and table, mm or rad.
    pub backlash: f64,
    /// Whether the encoder is on the motor instead of the table.
    pub measures_motor: bool,
    /// Flexible modes that the axis excites.
    pub modes: Vec<FlexibleMode>,
}

impl DriveSettings {
    /// The textbook drive at a bandwidth, Hz: rolling guides, a linear motor, a servo period of 0.1 ms.
    #[must_use]
    pub fn textbook(bandwidth: f64) -> Self {
        Self {
            servo_period: 1e-4,
            gains: GainSettings::Bandwidth {
                frequency: bandwidth,
                velocity_ratio: 1.5,
                velocity_damping: 1.0,
            },
            feedforward: Feedforward::VELOCITY,
            current_loop: 500.0,
            dead_time: 1e-4,
            velocity_filter: Some(400.0),
            encoder_step: 1e-4,
            force_limit: f64::INFINITY,
            friction: Friction {
                coulomb: 400.0,
                static_force: 520.0,
                stribeck: 5.0,
                presliding: 0.02,
            },
            viscous: 0.5,
            backlash: 0.0,
            measures_motor: false,
            modes: Vec::new(),
        }
    }

    /// The textbook drive of a rotary axis at a bandwidth, Hz.
    #[must_use]
    pub fn textbook_rotary(bandwidth: f64) -> Self {
        Self {
            encoder_step: 5e-6,
            friction: Friction {
                coulomb: 5.0,
                static_force: 6.5,
                stribeck: 0.05,
                presliding: 2e-4,
            },
            feedforward: Feedforward {
                friction_velocity: 1.0_f64.to_radians(),
                ..Feedforward::VELOCITY
            },
            ..Self::textbook(bandwidth)
        }
    }

    /// The drive that was fitted to tables 2.1, 3.1 and 3.2 of the dissertation, at a bandwidth, Hz, with an encoder step,
    /// mm.
    #[must_use]
    pub fn reference(bandwidth: f64, encoder_step: f64) -> Self {
        Self {
            gains: GainSettings::Bandwidth {
                frequency: bandwidth,
                velocity_ratio: 1.6,
                velocity_damping: 0.8,
            },
            encoder_step,
            friction: Friction {
                coulomb: 600.0,
                static_force: 900.0,
                stribeck: 0.6,
                presliding: 0.018,
            },
            viscous: 2.0,
            ..Self::textbook(bandwidth)
        }
    }

    /// The same drive without friction.
    #[must_use]
    pub fn without_friction(mut self) -> Self {
        self.friction = Friction::NONE;
        self
    }

    /// The same drive without flexible modes.
    #[must_use]
    pub fn rigid(mut self) -> Self {
        self.modes.clear();
        self
    }

    /// The linear part.
    pub(crate) fn plant(&self) -> Plant {
        Plant {
            viscous: self.viscous,
            current_loop: self.current_loop,
            modes: self.modes.clone(),
        }
    }

    /// Checks every field by itself and against the others.
    ///
    /// # Errors
    /// [`DriveError`] names the first field that is refused, with its value and its bound.
    pub fn check(&self) -> Result<(), DriveError> {
        let period = self.servo_period;
        if !(1e-6..=0.1).contains(&period) {
            return Err(DriveError::new(
                "servo_period_s",
                period,
                "from 0.000001 to 0.1",
            ));
        }
        not_negative("dead_time_s", self.dead_time)?;
        #[allow(clippy::cast_precision_loss, reason = "twenty")]
        let longest = MAX_DELAY as f64 * period;
        if self.dead_time > longest * (1.0 + 1e-9) {
            return Err(DriveError::new(
                "dead_time_s",
                self.dead_time,
                format!("at most {MAX_DELAY} servo periods, {longest}"),
            ));
        }
        if let Some(filter) = self.velocity_filter
            && !(filter > 0.0 && filter.is_finite())
        {
            return Err(DriveError::new(
                "velocity_filter_hz",
                filter,
                "positive and finite",
            ));
        }
        not_negative("encoder", self.encoder_step)?;
        if self.encoder_step > COARSEST_ENCODER {
            return Err(DriveError::new(
                "encoder",
                self.encoder_step,
                "at most 1 mm or 1 rad",
            ));
        }
        self.friction.check()?;
        if self.force_limit.is_nan() || self.force_limit <= 0.0 {
            return Err(DriveError::new("force_limit", self.force_limit, "positive"));
        }
        if self.force_limit < self.friction.static_force {
            return Err(DriveError::new(
                "force_limit",
                self.force_limit,
                format!(
                    "at least the static friction, {}",
                    self.friction.static_force
                ),
            ));
        }
        for (field, value) in [
            ("feedforward: velocity", self.feedforward.velocity),
            ("feedforward: acceleration", self.feedforward.acceleration),
        ] {
            if !(0.0..=2.0).contains(&value) {
                return Err(DriveError::new(field, value, "from 0 to 2"));
            }
        }
        if !(self.feedforward.friction_velocity > 0.0
            && self.feedforward.friction_velocity.is_finite())
        {
            return Err(DriveError::new(
                "feedforward: friction_velocity",
                self.feedforward.friction_velocity,
                "positive and finite",
            ));
        }
        not_negative("backlash", self.backlash)?;
        if self.backlash > 0.0 && !self.measures_motor {
            return Err(DriveError::new(
                "backlash",
                self.backlash,
                "0 where the encoder measures the table",
            ));
        }
        self.plant().check(period)?;
        self.gains.check()
    }
}

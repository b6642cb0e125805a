//! Computes the friction force of an axis by elastic elements that slip at a share of the Stribeck force.
//!
//! Source: the generalised Maxwell-slip model in its rate-independent limit (Al-Bender, Lampaert and Swevers 2005) with the
//! Stribeck curve as strength. Backward Euler in velocity makes each step one scalar equation with a rising left side and a
//! falling right side: it has exactly one solution, sticks exactly and never gains energy. Not here: viscous friction, which
//! is linear and belongs to the plant.

use crate::error::DriveError;

/// Elastic elements in parallel.
pub(crate) const ELEMENTS: usize = 4;

/// Steps of the search for the force: one or two are taken as a rule.
const MAX_STEPS: usize = 60;

/// The force is found to this share of the static friction.
const PRECISION: f64 = 1e-10;

/// Shortest stretch of an element, mm or rad: friction without presliding.
const SHORTEST_STRETCH: f64 = 1e-9;

/// Multiples of the Stribeck velocity beyond which the exponential is below rounding.
const BEYOND_STRIBECK: f64 = 6.0;

/// Largest slope of `(v / vs)² exp(-(v / vs)²)` in its argument, `sqrt(2 / e)`.
const STEEPEST: f64 = 0.857_763_884_960_706_8;

/// Largest change of friction within a step by its own falling slope for which one step is accurate.
const STEEP: f64 = 0.5;

/// Most substeps of a servo period.
pub(crate) const MAX_SUBSTEPS: u32 = 10;

/// Friction of an axis: specific forces in mm/s² or rad/s² (force per mass), velocities in mm/s or rad/s, distances in mm
/// or rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Force of fast sliding.
    pub coulomb: f64,
    /// Force that must be overcome to break away; not below `coulomb`.
    pub static_force: f64,
    /// Velocity at which friction falls from the static to the Coulomb force.
    pub stribeck: f64,
    /// Distance after a reversal over which the force builds up; 0 for none.
    pub presliding: f64,
}

impl Friction {
    /// No friction.
    pub const NONE: Self = Self {
        coulomb: 0.0,
        static_force: 0.0,
        stribeck: 1.0,
        presliding: 0.0,
    };

    /// Force of steady sliding at a velocity, without the viscous part.
    #[must_use]
    pub fn at(&self, velocity: f64) -> f64 {
        let share = velocity / self.stribeck;
        if share.abs() > BEYOND_STRIBECK || self.static_force <= self.coulomb {
            return self.coulomb;
        }
        self.coulomb + (self.static_force - self.coulomb) * (-share * share).exp()
    }

    /// Checks all values.
    ///
    /// # Errors
    /// [`DriveError`] for a value that is negative or not finite, a static force below the Coulomb force, and a Stribeck
    /// velocity of 0 where the static force exceeds the Coulomb force.
    pub fn check(&self) -> Result<(), DriveError> {
        for (field, value) in [
            ("friction: coulomb", self.coulomb),
            ("friction: static", self.static_force),
            ("friction: stribeck", self.stribeck),
            ("friction: presliding", self.presliding),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(DriveError::new(field, value, "finite and not negative"));
            }
        }
        if self.static_force < self.coulomb {
            return Err(DriveError::new(
                "friction: static",
                self.static_force,
                format!("at least the Coulomb friction, {}", self.coulomb),
            ));
        }
        if self.stribeck <= 0.0 && self.static_force > self.coulomb {
            return Err(DriveError::new(
                "friction: stribeck",
                self.stribeck,
                "positive where static friction exceeds Coulomb friction",
            ));
        }
        Ok(())
    }

    /// How many substeps a period, s, needs so that friction does not fall too steeply within one.
    ///
    /// # Errors
    /// [`DriveError`] where it needs more than ten.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the value is checked to be small and positive"
    )]
    pub fn substeps(&self, period: f64) -> Result<u32, DriveError> {
        let falls = self.static_force - self.coulomb;
        if falls <= 0.0 {
            return Ok(1);
        }
        let needed = (STEEPEST * falls * period / (self.stribeck * STEEP)).ceil();
        if needed > f64::from(MAX_SUBSTEPS) {
            return Err(DriveError::new(
                "friction: stribeck",
                self.stribeck,
                format!(
                    "at least {:.4} for this fall of friction and servo period, so that ten substeps follow it",
                    STEEPEST * falls * period / (STEEP * f64::from(MAX_SUBSTEPS))
                ),
            ));
        }
        Ok((needed as u32).max(1))
    }
}

/// State of the elements.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slip {
    law: Friction,
    stiffness: [f64; ELEMENTS],
    forces: [f64; ELEMENTS],
    /// Force of sliding at the last step.
    strength: f64,
}

impl Slip {
    /// Elements without force.
    pub(crate) fn new(law: &Friction) -> Self {
        // From reversal to reversal an element turns over by twice its own stretch, so elements of equal strength begin to
        // slip at 1/4, 2/4, 3/4 and all of half the presliding distance.
        #[allow(clippy::cast_precision_loss, reason = "there are four elements")]
        let stretch = |i: usize| 0.5 * law.presliding * (i + 1) as f64 / ELEMENTS as f64;
        #[allow(clippy::cast_precision_loss, reason = "there are four elements")]
        let share = law.static_force / ELEMENTS as f64;
        Self {
            law: *law,
            stiffness: std::array::from_fn(|i| share / stretch(i).max(SHORTEST_STRETCH)),
            forces: [0.0; ELEMENTS],
            strength: f64::INFINITY,
        }
    }

    /// The force over a step of time `period`.
    ///
    /// Without it the velocity at the end of the step would be `free`, and each unit of it takes away `gain`. The equation
    /// `f = sum clamp(f_i + k_i T (free - gain f), ±S / 4)` is solved by Newton steps inside a bracket.
    #[inline]
    pub(crate) fn step(&mut self, free: f64, gain: f64, velocity: f64, period: f64) -> f64 {
        if self.law.static_force <= 0.0 {
            return 0.0;
        }
        #[allow(clippy::cast_precision_loss, reason = "there are four elements")]
        let elements = ELEMENTS as f64;
        let most = self.law.at(velocity) / elements;
        // While all elements slip they go on slipping at the new strength: the first guess is then the answer.
        let before: f64 = self.forces.iter().sum();
        let slides = before.abs() >= self.strength * (1.0 - 1e-12);
        self.strength = most * elements;
        let (mut low, mut high) = (-self.strength, self.strength);
        let mut force = if slides {
            before.signum() * self.strength
        } else {
            before.clamp(low, high)
        };
        for _ in 0..MAX_STEPS {
            let (mut sum, mut slope) = (0.0, 0.0);
            let stretch = period * (free - gain * force);
            for (element, stiffness) in self.forces.iter().zip(&self.stiffness) {
                let stretched = element + stiffness * stretch;
                sum += stretched.clamp(-most, most);
                if stretched.abs() < most {
                    slope += stiffness * period * gain;
                }
            }
            let off = force - sum;
            if off.abs() <= PRECISION * self.law.static_force {
                break;
            }
            if off > 0.0 {
                high = force;
            } else {
                low = force;
            }
            let newton = force - off / (1.0 + slope);
            force = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
        }
        let stretch = period * (free - gain * force);
        for (element, stiffness) in self.forces.iter_mut().zip(&self.stiffness) {
            *element = (*element + stiffness * stretch).clamp(-most, most);
        }
        force
    }
}

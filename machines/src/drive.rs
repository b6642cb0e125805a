//! Describes the drives of a machine file: control loop, feedforward, force, friction, encoder.
//!
//! Source: the fields that controls show and data sheets print. Not here: whether a drive can be, which the simulation
//! checks.

use schemars::JsonSchema;
use serde::Deserialize;

/// How set-points are refined to the servo period.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum InterpolationConfig {
    /// Straight from one to the next.
    Linear,
    /// A cubic through four of them.
    Cubic,
}

/// What the encoder measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum MeasuresConfig {
    /// The table, behind any play.
    Table,
    /// The motor.
    Motor,
}

/// Feedforward of a drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FeedforwardConfig {
    /// Share of the velocity of the set-points.
    pub velocity: Option<f64>,
    /// Share of their acceleration.
    pub acceleration: Option<f64>,
    /// Whether Coulomb friction is given in the direction of motion.
    pub friction: Option<bool>,
    /// Whether set-points pass through a zero-phase-error tracking filter.
    pub zero_phase: Option<bool>,
}

/// Friction of a drive: as forces in N or N m, which need the mass or inertia, or per mass in mm/s² or rad/s².
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionConfig {
    /// Coulomb friction of a linear axis, N.
    pub coulomb_n: Option<f64>,
    /// Static friction of a linear axis, N.
    pub static_n: Option<f64>,
    /// Coulomb friction of a linear axis per mass, mm/s².
    pub coulomb_mm_s2: Option<f64>,
    /// Static friction of a linear axis per mass, mm/s².
    pub static_mm_s2: Option<f64>,
    /// Coulomb friction of a rotary axis, N m.
    pub coulomb_nm: Option<f64>,
    /// Static friction of a rotary axis, N m.
    pub static_nm: Option<f64>,
    /// Coulomb friction of a rotary axis per inertia, rad/s².
    pub coulomb_rad_s2: Option<f64>,
    /// Static friction of a rotary axis per inertia, rad/s².
    pub static_rad_s2: Option<f64>,
    /// Stribeck velocity of a linear axis, mm/s.
    pub stribeck_mm_s: Option<f64>,
    /// Stribeck velocity of a rotary axis, degrees/s.
    pub stribeck_deg_s: Option<f64>,
    /// Distance after a reversal over which friction of a linear axis builds up, µm.
    pub presliding_um: Option<f64>,
    /// The same of a rotary axis, arc seconds.
    pub presliding_arcsec: Option<f64>,
    /// Viscous friction of a linear axis, N s/m.
    pub viscous_n_s_m: Option<f64>,
    /// Viscous friction of a rotary axis, N m s/rad.
    pub viscous_nm_s_rad: Option<f64>,
    /// Viscous friction per mass or inertia, 1/s.
    pub viscous_per_s: Option<f64>,
}

/// A drive. Each field may stand in `[drive]` for all axes or in `drive` of one axis, which goes before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DriveConfig {
    /// Period of position and velocity control, s; it divides `period_s`.
    pub servo_period_s: Option<f64>,
    /// How set-points are refined to it.
    pub interpolation: Option<InterpolationConfig>,
    /// Frequency at which the position loop without feedforward falls to -3 dB, Hz; instead of gains.
    pub bandwidth_hz: Option<f64>,
    /// Natural frequency of the velocity loop over the position gain; with `bandwidth_hz`.
    pub velocity_ratio: Option<f64>,
    /// Damping ratio of the velocity loop; with `bandwidth_hz`.
    pub velocity_damping: Option<f64>,
    /// Position gain (Kv factor), 1/s.
    pub position_gain: Option<f64>,
    /// Velocity gain, 1/s; with `integral_gain`.
    pub velocity_gain: Option<f64>,
    /// Integral gain of the velocity loop, 1/s².
    pub integral_gain: Option<f64>,
    /// Bandwidth of the velocity loop, Hz; instead of `velocity_gain`.
    pub velocity_loop_hz: Option<f64>,
    /// Integral time of the velocity loop, s; instead of `integral_gain`.
    pub integral_time_s: Option<f64>,
    /// Feedforward.
    pub feedforward: Option<FeedforwardConfig>,
    /// Bandwidth of the current loop, Hz.
    pub current_loop_hz: Option<f64>,
    /// Time between measurement and force, s.
    pub dead_time_s: Option<f64>,
    /// Corner frequency of the low-pass filter of the measured velocity, Hz.
    pub velocity_filter_hz: Option<f64>,
    /// Step of the encoder of a linear axis, µm.
    pub encoder_um: Option<f64>,
    /// Step of the encoder of a rotary axis, arc seconds.
    pub encoder_arcsec: Option<f64>,
    /// Moved mass of a linear axis, kg; needed with forces in N.
    pub mass_kg: Option<f64>,
    /// Inertia of a rotary axis, kg m²; needed with torques in N m.
    pub inertia_kg_m2: Option<f64>,
    /// Largest force of a linear axis, N.
    pub force_limit_n: Option<f64>,
    /// Largest torque of a rotary axis, N m.
    pub torque_limit_nm: Option<f64>,
    /// Largest force of a linear axis per mass, mm/s².
    pub force_limit_mm_s2: Option<f64>,
    /// Largest torque of a rotary axis per inertia, rad/s².
    pub torque_limit_rad_s2: Option<f64>,
    /// Friction.
    pub friction: Option<FrictionConfig>,
    /// Play between motor and table of a linear axis, µm; where the motor is measured.
    pub backlash_um: Option<f64>,
    /// The same of a rotary axis, arc seconds.
    pub backlash_arcsec: Option<f64>,
    /// What the encoder measures.
    pub measures: Option<MeasuresConfig>,
}

/// The fields of one structure, those of the other where they are not given.
macro_rules! over {
    ($one:expr, $other:expr, $kind:ident { $($field:ident),* $(,)? }) => {
        $kind { $($field: $one.$field.or($other.$field)),* }
    };
}

impl FrictionConfig {
    /// The fields of this, those of `other` where they are not given. Where this gives forces in another unit, those of
    /// `other` do not count.
    #[must_use]
    fn over(self, other: Self) -> Self {
        let mut other = other;
        if self.coulomb_n.or(self.static_n).is_some() {
            (other.coulomb_mm_s2, other.static_mm_s2) = (None, None);
        }
        if self.coulomb_mm_s2.or(self.static_mm_s2).is_some() {
            (other.coulomb_n, other.static_n) = (None, None);
        }
        if self.coulomb_nm.or(self.static_nm).is_some() {
            (other.coulomb_rad_s2, other.static_rad_s2) = (None, None);
        }
        if self.coulomb_rad_s2.or(self.static_rad_s2).is_some() {
            (other.coulomb_nm, other.static_nm) = (None, None);
        }
        over!(
            self,
            other,
            FrictionConfig {
                coulomb_n,
                static_n,
                coulomb_mm_s2,
                static_mm_s2,
                coulomb_nm,
                static_nm,
                coulomb_rad_s2,
                static_rad_s2,
                stribeck_mm_s,
                stribeck_deg_s,
                presliding_um,
                presliding_arcsec,
                viscous_n_s_m,
                viscous_nm_s_rad,
                viscous_per_s,
            }
        )
    }
}

impl FeedforwardConfig {
    #[must_use]
    fn over(self, other: Self) -> Self {
        over!(
            self,
            other,
            FeedforwardConfig {
                velocity,
                acceleration,
                friction,
                zero_phase,
            }
        )
    }
}

impl DriveConfig {
    /// Whether gains are given directly or as controls show them.
    #[must_use]
    pub fn has_gains(&self) -> bool {
        self.position_gain
            .or(self.velocity_gain)
            .or(self.integral_gain)
            .or(self.velocity_loop_hz)
            .or(self.integral_time_s)
            .is_some()
    }

    /// The fields of this, those of `other` where they are not given. Where this says the gains in one way, what `other`
    /// says of them in another way does not count.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        let mut other = other;
        if self.bandwidth_hz.is_some() && !self.has_gains() {
            (
                other.position_gain,
                other.velocity_gain,
                other.integral_gain,
            ) = (None, None, None);
            (other.velocity_loop_hz, other.integral_time_s) = (None, None);
        }
        if self.has_gains() && self.bandwidth_hz.is_none() {
            (
                other.bandwidth_hz,
                other.velocity_ratio,
                other.velocity_damping,
            ) = (None, None, None);
        }
        let mut merged = over!(
            self,
            other,
            DriveConfig {
                servo_period_s,
                interpolation,
                bandwidth_hz,
                velocity_ratio,
                velocity_damping,
                position_gain,
                velocity_gain,
                integral_gain,
                velocity_loop_hz,
                integral_time_s,
                feedforward,
                current_loop_hz,
                dead_time_s,
                velocity_filter_hz,
                encoder_um,
                encoder_arcsec,
                mass_kg,
                inertia_kg_m2,
                force_limit_n,
                torque_limit_nm,
                force_limit_mm_s2,
                torque_limit_rad_s2,
                friction,
                backlash_um,
                backlash_arcsec,
                measures,
            }
        );
        merged.friction = match (self.friction, other.friction) {
            (Some(one), Some(other)) => Some(one.over(other)),
            (one, other) => one.or(other),
        };
        merged.feedforward = match (self.feedforward, other.feedforward) {
            (Some(one), Some(other)) => Some(one.over(other)),
            (one, other) => one.or(other),
        };
        merged
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_goes_before_the_machine_field_by_field() {
        let all = DriveConfig {
            bandwidth_hz: Some(35.0),
            velocity_ratio: Some(1.6),
            friction: Some(FrictionConfig {
                coulomb_n: Some(12.0),
                static_n: Some(18.0),
                stribeck_mm_s: Some(0.6),
                ..FrictionConfig::default()
            }),
            ..DriveConfig::default()
        };
        let axis = DriveConfig {
            friction: Some(FrictionConfig {
                coulomb_mm_s2: Some(400.0),
                ..FrictionConfig::default()
            }),
            position_gain: Some(100.0),
            ..DriveConfig::default()
        };
        let merged = axis.over(all);
        assert_eq!(merged.bandwidth_hz, None, "gains instead of a bandwidth");
        let friction = merged.friction.unwrap();
        assert_eq!(friction.coulomb_n, None, "another unit");
        assert_eq!(friction.coulomb_mm_s2, Some(400.0));
        assert_eq!(friction.stribeck_mm_s, Some(0.6));
        let unchanged = DriveConfig::default().over(all);
        assert_eq!(unchanged, all);
    }
}

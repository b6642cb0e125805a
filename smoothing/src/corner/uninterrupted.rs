//! Blends a corner by uninterrupted acceleration at constant jerk.
//!
//! Source: sections 2.2.3 and 3.2, equations 2.34 to 2.44 and 3.5 to 3.9, in vector form: the motion
//! is a cubic Bezier curve whose two inner control points are the corner. Not here: how corners share a
//! short move.

use toolglide_kinematics::numeric::SEARCH_PRECISION;
use toolglide_kinematics::{Corner, Limits, PathLimits, largest_multiple};
use toolglide_profiles::{BlendError, BlendPhase, BlendShape, Blender, Boundary, SpeedRamp};

/// Turns a corner with one phase of constant jerk, losing speed into it and regaining it after.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Corner, Limits, Tolerance, Vector};
/// use toolglide_profiles::Blender;
/// use toolglide_smoothing::Uninterrupted;
/// let corner = Corner {
///     point: Vector::<2>::zeros(),
///     incoming: Vector::<2>::x(),
///     outgoing: Vector::<2>::y(),
///     speed_in: 100.0,
///     speed_out: 100.0,
///     tolerance: Tolerance::new(0.1)?,
/// };
/// let blender = Uninterrupted::new(Limits::uniform(500.0, 2500.0, 2e5)?);
/// let shape = blender.blend(&corner, 10.0, 10.0)?;
/// assert!((shape.entry.speed - 46.058).abs() < 1e-3);
/// assert!((shape.corner_error(&corner) - 0.1).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uninterrupted<const N: usize> {
    limits: Limits<N>,
    ratio: f64,
    /// Corner error of a unit reach at the entry, over twice the sine of half the turn angle.
    unit_error: f64,
}

impl<const N: usize> Uninterrupted<N> {
    /// Corners within these limits, left at the speed at which they are entered.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self::unequal(limits, 1.0)
    }

    /// Corners that are left at `ratio` (positive) times the speed at which they are entered, faster
    /// only into the longer move: where the moves beside them differ in length.
    #[must_use]
    pub fn unequal(limits: Limits<N>, ratio: f64) -> Self {
        let ratio = ratio.max(f64::MIN_POSITIVE);
        Self {
            limits,
            ratio,
            unit_error: ratio / (1.0 + ratio.cbrt()).powi(3),
        }
    }
}

impl<const N: usize> Blender<N> for Uninterrupted<N> {
    /// # Errors
    /// [`BlendError::Straight`] where the path goes straight on: this motion would slow down for
    /// nothing. [`BlendError::Impossible`] where unequal speeds would make the longer move the slower
    /// one.
    fn blend(&self, corner: &Corner<N>, before: f64, after: f64) -> Result<BlendShape, BlendError> {
        let is_equal = (self.ratio - 1.0).abs() < f64::EPSILON;
        if !is_equal && (after > before) != (self.ratio > 1.0) {
            return Err(BlendError::Impossible {
                turn_angle: corner.turn_angle(),
                reason: "the longer move would be the slower one",
            });
        }
        let half_sine = corner.half_turn_sine();
        if 2.0 * half_sine <= crate::STRAIGHT {
            return Err(BlendError::Straight {
                turn_angle: corner.turn_angle(),
            });
        }
        let Corner {
            incoming, outgoing, ..
        } = corner;
        let error = corner.tolerance.length();
        let limits = &self.limits;
        let family = Family {
            ratio: self.ratio,
            // Corner error by speed and duration: 2 s2 Ls Le / (cbrt Ls + cbrt Le)^3.
            error_per_reach: 2.0 / 3.0 * half_sine * self.unit_error,
            error,
            acceleration: largest_multiple(incoming, limits.acceleration())
                .min(largest_multiple(outgoing, limits.acceleration()) / self.ratio),
            jerk: largest_multiple(&(incoming + outgoing * self.ratio), limits.jerk()),
            before: limits.along(incoming),
            after: limits.along(outgoing),
            speed_in: corner.speed_in,
            speed_out: corner.speed_out,
        };
        family.fastest().shape()
    }
}

/// One phase of constant jerk, and where it leaves and joins the moves.
struct Cubic {
    entry: Boundary,
    exit: Boundary,
    duration: f64,
}

impl Cubic {
    fn shape(&self) -> Result<BlendShape, BlendError> {
        if self.duration <= 0.0 {
            return Ok(BlendShape::reversal(self.entry.acceleration));
        }
        let jerk = self.entry.acceleration / self.duration;
        let phase = BlendPhase {
            duration: self.duration,
            jerk_in: jerk,
            jerk_out: jerk * (self.exit.acceleration / self.entry.acceleration),
        };
        BlendShape::between(self.entry, self.exit, self.duration, &[phase])
    }
}

/// The corners of one geometry, a family in the speed at the entry and the acceleration there.
struct Family {
    ratio: f64,
    error_per_reach: f64,
    error: f64,
    /// Largest acceleration at the entry.
    acceleration: f64,
    /// Largest factor of the jerk vector `incoming + ratio * outgoing`.
    jerk: f64,
    before: PathLimits,
    after: PathLimits,
    speed_in: f64,
    speed_out: f64,
}

impl Family {
    /// The fastest of the family, from which the acceleration can run out below the feedrate on both
    /// sides; the printed method forgets the latter.
    fn fastest(&self) -> Cubic {
        let reach = self.error / self.error_per_reach;
        let by_acceleration = (0.5 * self.acceleration * reach).sqrt(); // 2.43
        let by_jerk_cubed = 0.5 * self.jerk * reach * reach; // 2.42
        let speed = if by_jerk_cubed < by_acceleration.powi(3) {
            by_jerk_cubed.cbrt()
        } else {
            by_acceleration
        };
        let for_error = |speed: f64| 2.0 * speed * speed * self.error_per_reach / self.error;
        let full = self.shape(speed, for_error(speed));
        if self.runs_out(&full) {
            return full;
        }
        // Slower at the same corner error, or within less of it in less time.
        let most = |speed: f64| (2.0 * self.jerk * speed).sqrt().min(self.acceleration);
        let wide = self.slowed(speed, for_error);
        let tight = self.slowed(speed, most);
        if self.loss(&tight) < self.loss(&wide) {
            tight
        } else {
            wide
        }
    }

    fn shape(&self, speed: f64, acceleration: f64) -> Cubic {
        let duration = 2.0 * speed / acceleration;
        let entry = Boundary {
            distance: speed * duration / 3.0,
            speed,
            acceleration,
        };
        Cubic {
            entry,
            exit: Boundary {
                distance: self.ratio * entry.distance,
                speed: self.ratio * speed,
                acceleration: self.ratio * acceleration,
            },
            duration,
        }
    }

    /// The largest speed up to `most` from which the acceleration can run out below the feedrate; the
    /// peak grows with the speed, so the bound is searched.
    fn slowed(&self, most: f64, acceleration_at: impl Fn(f64) -> f64) -> Cubic {
        let (mut low, mut high) = (
            0.0,
            most.min(self.speed_in).min(self.speed_out / self.ratio),
        );
        let shape = |speed: f64| self.shape(speed, acceleration_at(speed));
        while high - low > SEARCH_PRECISION * high {
            let middle = 0.5 * (low + high);
            if self.runs_out(&shape(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        shape(low)
    }

    fn runs_out(&self, shape: &Cubic) -> bool {
        let peak = |boundary: &Boundary, jerk| {
            SpeedRamp::least_peak(boundary.speed, boundary.acceleration, jerk)
        };
        peak(&shape.entry, self.before.jerk) <= self.speed_in
            && peak(&shape.exit, self.after.jerk) <= self.speed_out
    }

    /// Time lost against passing at the feedrate.
    fn loss(&self, shape: &Cubic) -> f64 {
        let beside = |boundary: &Boundary, limits: &PathLimits, feedrate: f64| {
            let rise = SpeedRamp::to_peak(
                boundary.speed,
                boundary.acceleration,
                feedrate,
                limits.acceleration,
                limits.jerk,
            );
            rise.duration() - (rise.distance + boundary.distance) / feedrate
        };
        shape.duration
            + beside(&shape.entry, &self.before, self.speed_in)
            + beside(&shape.exit, &self.after, self.speed_out)
    }
}

//! Uninterrupted corners: deceleration runs into the corner and acceleration out of it, at constant
//! jerk.
//!
//! Source: sections 2.2.3 and 3.2, equations 2.34 to 2.44 and 3.5 to 3.9, in vector form: the motion
//! is a cubic Bezier curve whose two inner control points are the corner. Not here: unequal speeds.

use crate::turn::{Form, Turn, TurnShape};
use toolglide_kinematics::numeric::SEARCH_PRECISION;
use toolglide_kinematics::{Corner, Limits, largest_multiple};
use toolglide_profiles::{BlendError, Blender, Rise};

/// Turns a corner with one phase of constant jerk, losing speed into it and regaining it after.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Corner, Limits, Tolerance, Vector};
/// use toolglide_profiles::{Blender, CornerMotion};
/// use toolglide_smoothing::Uninterrupted;
/// let corner = Corner {
///     point: Vector::<2>::zeros(),
///     incoming: Vector::<2>::x(),
///     outgoing: Vector::<2>::y(),
///     speed_in: 100.0,
///     speed_out: 100.0,
///     tolerance: Tolerance::new(0.1)?,
/// };
/// let turn = Uninterrupted::new(Limits::uniform(500.0, 2500.0, 2e5)?).blend(&corner)?;
/// assert!((turn.entry().speed - 46.058).abs() < 1e-3);
/// assert!((turn.corner_error() - 0.1).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uninterrupted<const N: usize> {
    limits: Limits<N>,
}

impl<const N: usize> Uninterrupted<N> {
    /// Corners within these limits.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self { limits }
    }
}

impl<const N: usize> Blender<Corner<N>> for Uninterrupted<N> {
    type Motion = Turn<N>;

    /// # Errors
    /// [`BlendError::Straight`] where the path goes straight on: this motion would slow down for
    /// nothing.
    fn blend(&self, corner: &Corner<N>) -> Result<Turn<N>, BlendError> {
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
        let acceleration = largest_multiple(incoming, limits.acceleration())
            .min(largest_multiple(outgoing, limits.acceleration()));
        let jerk = largest_multiple(&(incoming + outgoing), limits.jerk());
        let by_acceleration = (6.0 * acceleration * error / half_sine).sqrt(); // 2.43
        let by_jerk = (72.0 * jerk * error * error / (half_sine * half_sine)).cbrt(); // 2.42
        let speed = by_acceleration.min(by_jerk);
        let within = Neighbours {
            feedrate: corner.speed_in.min(corner.speed_out),
            jerk: largest_multiple(incoming, limits.jerk())
                .min(largest_multiple(outgoing, limits.jerk())),
            acceleration,
        };
        let for_error = |speed: f64| speed * speed * half_sine / (6.0 * error);
        let shape = if within.fits(speed, for_error(speed)) {
            shape_of(speed, for_error(speed))
        } else {
            // Slower at the same corner error, or within less of it in less time.
            let most = |speed: f64| (2.0 * jerk * speed).sqrt().min(acceleration);
            let wide = shape_of_fitting(&within, speed, for_error);
            let tight = shape_of_fitting(&within, speed, most);
            if within.loss(&tight) < within.loss(&wide) {
                tight
            } else {
                wide
            }
        };
        Ok(Turn::new(shape, *corner))
    }
}

fn shape_of(speed: f64, acceleration: f64) -> TurnShape {
    let duration = 2.0 * speed / acceleration;
    TurnShape {
        speed,
        acceleration,
        reach: speed * duration / 3.0,
        duration,
        form: Form::Uninterrupted,
    }
}

fn shape_of_fitting(
    within: &Neighbours,
    most: f64,
    acceleration_at: impl Fn(f64) -> f64,
) -> TurnShape {
    let speed = within.speed(most, &acceleration_at);
    shape_of(speed, acceleration_at(speed))
}

/// What the straight moves beside the corner allow.
struct Neighbours {
    feedrate: f64,
    jerk: f64,
    acceleration: f64,
}

impl Neighbours {
    fn fits(&self, speed: f64, acceleration: f64) -> bool {
        Rise::least_peak(speed, acceleration, self.jerk) <= self.feedrate
    }

    /// The largest speed up to `most` from which the acceleration can run out below the feedrate.
    ///
    /// The printed method forgets this; the peak grows with the speed, so the bound is searched.
    fn speed(&self, most: f64, acceleration_at: impl Fn(f64) -> f64) -> f64 {
        let (mut low, mut high) = (0.0, most.min(self.feedrate));
        while high - low > SEARCH_PRECISION * high {
            let middle = 0.5 * (low + high);
            if self.fits(middle, acceleration_at(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Time lost against passing at the feedrate.
    fn loss(&self, shape: &TurnShape) -> f64 {
        let rise = Rise::to_peak(
            shape.speed,
            shape.acceleration,
            self.feedrate,
            self.acceleration,
            self.jerk,
        );
        shape.duration + 2.0 * (rise.duration() - (rise.distance + shape.reach) / self.feedrate)
    }
}

//! Blends a corner by interrupted acceleration, which is zero at both ends of the corner.
//!
//! Source: section 2.2.2 and 2.3, equations 2.19 to 2.33, in vector form; a corner whose speed the
//! feedrate limits is the same motion at that speed. Not here: how corners share a short move.

use toolglide_kinematics::{Corner, Limits, largest_multiple};
use toolglide_profiles::{BlendError, BlendPhase, BlendShape, Blender, Boundary};

/// Turns a corner at one speed, exchanging the incoming velocity for the outgoing one along an
/// S-curve that saturates the jerk, and the acceleration where it lasts long enough.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Corner, Limits, Tolerance, Vector};
/// use toolglide_profiles::Blender;
/// use toolglide_smoothing::Interrupted;
/// let corner = Corner {
///     point: Vector::<2>::zeros(),
///     incoming: Vector::<2>::x(),
///     outgoing: Vector::<2>::y(),
///     speed_in: 100.0,
///     speed_out: 100.0,
///     tolerance: Tolerance::new(0.1)?,
/// };
/// let blender = Interrupted::new(Limits::uniform(500.0, 2500.0, 2e5)?);
/// let shape = blender.blend(&corner, 10.0, 10.0)?;
/// assert!((shape.entry.speed - 32.995).abs() < 1e-3);
/// assert!((shape.corner_error(&corner) - 0.1).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interrupted<const N: usize> {
    limits: Limits<N>,
}

impl<const N: usize> Interrupted<N> {
    /// Corners within these limits.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self { limits }
    }
}

impl<const N: usize> Blender<N> for Interrupted<N> {
    /// Going straight on is a blend of no duration.
    ///
    /// # Errors
    /// [`BlendError::NotClosed`] should the phases miss the boundaries, which no test has produced.
    fn blend(&self, corner: &Corner<N>, _: f64, _: f64) -> Result<BlendShape, BlendError> {
        let turned = corner.outgoing - corner.incoming;
        let feedrate = corner.speed_in.min(corner.speed_out);
        let size = turned.norm();
        if size <= crate::STRAIGHT {
            return Ok(BlendShape::through(feedrate));
        }
        let acceleration = largest_multiple(&turned, self.limits.acceleration());
        let jerk = largest_multiple(&turned, self.limits.jerk());
        let error = corner.tolerance.length() / size;
        let speed = speed_for_error(error, acceleration, jerk).min(feedrate);
        let (ramp, hold) = ramps(speed, acceleration, jerk);
        let duration = 2.0 * ramp + hold;
        let boundary = Boundary {
            distance: 0.5 * speed * duration,
            speed,
            acceleration: 0.0,
        };
        let jerk = speed / ((ramp + hold) * ramp);
        // The velocity that is taken from the incoming move is given to the outgoing one.
        let phase = |duration, jerk: f64| BlendPhase {
            duration,
            jerk_in: -jerk,
            jerk_out: jerk,
        };
        let phases = [phase(ramp, jerk), phase(hold, 0.0), phase(ramp, -jerk)];
        BlendShape::between(boundary, boundary, duration, &phases)
    }
}

#[allow(
    clippy::many_single_char_names,
    reason = "transcribed equations keep the letters of the text"
)]
fn speed_for_error(error: f64, acceleration: f64, jerk: f64) -> f64 {
    let (e, a, j) = (error, acceleration, jerk);
    if e <= a * a * a / (6.0 * j * j) {
        (36.0 * e * e * j).cbrt() // (6 e sqrt(j))^(2/3), the hold phase vanishes
    } else {
        (8.0 * a * e - a * a * a * a / (3.0 * j * j)).sqrt()
    }
}

fn ramps(speed: f64, acceleration: f64, jerk: f64) -> (f64, f64) {
    let ramp = acceleration / jerk;
    let hold = speed / acceleration - ramp;
    if hold > 0.0 {
        (ramp, hold)
    } else {
        ((speed / jerk).sqrt(), 0.0)
    }
}

//! Blends a corner by an overlapped stop and start: it brakes along the incoming move while it
//! starts along the outgoing one.
//!
//! Source: ours; section 2.4 of our derivation of chapters 2 and 3, which has the uninterrupted
//! corner as its case of a single jerk phase. Where that corner is limited by acceleration, this one
//! turns up to four hundredths faster. Not here: unequal speeds.

use toolglide_kinematics::numeric::SEARCH_PRECISION;
use toolglide_kinematics::{Corner, Limits, Vector, largest_multiple};
use toolglide_profiles::{BlendError, BlendPhase, BlendShape, Blender, Boundary};

/// Turns a corner by a stop along the incoming and a start along the outgoing move, which overlap
/// completely.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Corner, Limits, Tolerance, Vector};
/// use toolglide_profiles::Blender;
/// use toolglide_smoothing::StopStart;
/// let corner = Corner {
///     point: Vector::<2>::zeros(),
///     incoming: Vector::<2>::x(),
///     outgoing: Vector::<2>::y(),
///     speed_in: 100.0,
///     speed_out: 100.0,
///     tolerance: Tolerance::new(0.1)?,
/// };
/// let blender = StopStart::new(Limits::uniform(500.0, 2500.0, 2e5)?);
/// let shape = blender.blend(&corner, 10.0, 10.0)?;
/// assert!((shape.corner_error(&corner) - 0.1).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopStart<const N: usize> {
    limits: Limits<N>,
}

impl<const N: usize> StopStart<N> {
    /// Corners within these limits.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self { limits }
    }
}

impl<const N: usize> Blender<N> for StopStart<N> {
    /// # Errors
    /// [`BlendError::Straight`] where the path goes straight on, and [`BlendError::Impossible`] where
    /// one jerk phase is all there is, which is the uninterrupted corner.
    fn blend(&self, corner: &Corner<N>, _: f64, _: f64) -> Result<BlendShape, BlendError> {
        let half_sine = corner.half_turn_sine();
        if 2.0 * half_sine <= crate::STRAIGHT {
            return Err(BlendError::Straight {
                turn_angle: corner.turn_angle(),
            });
        }
        let Corner {
            incoming, outgoing, ..
        } = corner;
        let bound = |vector: &Vector<N>| largest_multiple(vector, self.limits.jerk());
        let jerk = bound(incoming)
            .min(bound(outgoing))
            .min(bound(&(incoming + outgoing)));
        let bound = |vector: &Vector<N>| largest_multiple(vector, self.limits.acceleration());
        let most = bound(incoming).min(bound(outgoing));
        let distance = 0.5 * corner.tolerance.length() / half_sine;
        let start = |acceleration: f64| {
            let start = Start { jerk, acceleration };
            (start, 2.0 * start.time_over(distance))
        };
        let fits = |acceleration: f64| {
            let (start, duration) = start(acceleration);
            let ramp = start.ramp();
            [0.0, duration - ramp, ramp, 0.5 * duration, duration]
                .iter()
                .filter(|time| (0.0..=duration).contains(*time))
                .all(|&time| {
                    let sum = outgoing * start.acceleration_at(time)
                        - incoming * start.acceleration_at(duration - time);
                    bound(&sum) >= 1.0
                })
        };
        let acceleration = if fits(most) {
            most
        } else {
            let (mut low, mut high) = (0.0, most);
            while high - low > SEARCH_PRECISION * high {
                let middle = 0.5 * (low + high);
                if fits(middle) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            low
        };
        let (start, duration) = start(acceleration);
        if acceleration <= 0.0 || duration <= start.ramp() {
            return Err(BlendError::Impossible {
                turn_angle: corner.turn_angle(),
                reason: "its jerk never reaches the acceleration limit",
            });
        }
        let boundary = Boundary {
            distance: start.distance_at(duration),
            speed: start.speed_at(duration),
            acceleration,
        };
        BlendShape::between(boundary, boundary, duration, &start.overlapped(duration))
    }
}

/// A start from rest: constant jerk up to an acceleration that is then held.
#[derive(Clone, Copy, Debug)]
struct Start {
    jerk: f64,
    acceleration: f64,
}

impl Start {
    fn ramp(&self) -> f64 {
        self.acceleration / self.jerk
    }

    /// The phases of this start and of its mirror image along the incoming move, over one duration of more than a ramp.
    fn overlapped(&self, duration: f64) -> [BlendPhase; 3] {
        let ramp = self.ramp();
        let jerk = self.acceleration / ramp;
        let phase = |duration, jerk_in, jerk_out| BlendPhase {
            duration,
            jerk_in,
            jerk_out,
        };
        if duration >= 2.0 * ramp {
            let hold = duration - 2.0 * ramp;
            [
                phase(ramp, 0.0, jerk),
                phase(hold, 0.0, 0.0),
                phase(ramp, jerk, 0.0),
            ]
        } else {
            let alone = duration - ramp;
            [
                phase(alone, 0.0, jerk),
                phase(ramp - alone, jerk, jerk),
                phase(alone, jerk, 0.0),
            ]
        }
    }

    fn acceleration_at(&self, time: f64) -> f64 {
        (self.jerk * time).min(self.acceleration)
    }

    fn speed_at(&self, time: f64) -> f64 {
        let ramp = self.ramp().min(time);
        0.5 * self.jerk * ramp * ramp + self.acceleration * (time - ramp)
    }

    fn distance_at(&self, time: f64) -> f64 {
        let ramp = self.ramp().min(time);
        let held = time - ramp;
        let speed = 0.5 * self.jerk * ramp * ramp;
        self.jerk * ramp * ramp * ramp / 6.0 + held * (speed + 0.5 * self.acceleration * held)
    }

    fn time_over(&self, distance: f64) -> f64 {
        let by_jerk = (6.0 * distance / self.jerk).cbrt();
        let ramp = self.ramp();
        if by_jerk <= ramp {
            return by_jerk;
        }
        let speed = 0.5 * self.acceleration * ramp;
        let left = distance - self.acceleration * ramp * ramp / 6.0;
        ramp + ((speed * speed + 2.0 * self.acceleration * left).sqrt() - speed) / self.acceleration
    }
}

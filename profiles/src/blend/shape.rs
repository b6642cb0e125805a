//! Describes a corner blend in numbers: boundaries and phases of constant jerk along the two moves.
//!
//! Source: sections 2.3 and 3.2, in the vector form where a corner is a mixture of the incoming and the
//! outgoing direction: the motion along the incoming move comes to rest at the corner while the motion
//! along the outgoing move begins there. Not here: how large a blend may be, see the blenders.

use crate::blend::{BlendError, Boundary};
use crate::phase::{Phase, integrate};
use crate::profile::State;
use toolglide_kinematics::numeric::CLOSURE;

/// Most phases of a blend: two trapezoidal accelerations that overlap partly have seven.
pub const MAX_PHASES: usize = 8;

/// Share of their scale by which phases may miss the boundaries that are given beside them: far above
/// the rounding of eight phases, far below what a limit would notice.
const CLOSED: f64 = 1e-9;

/// A stretch of constant jerk of a corner blend.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlendPhase {
    /// How long it lasts, s; not negative.
    pub duration: f64,
    /// Jerk along the incoming direction, mm/s³.
    pub jerk_in: f64,
    /// Jerk along the outgoing direction, mm/s³.
    pub jerk_out: f64,
}

/// A corner blend without its geometry.
///
/// # Examples
/// A single phase of constant jerk is the uninterrupted corner.
/// ```
/// use toolglide_profiles::{BlendPhase, BlendShape};
/// let phase = BlendPhase { duration: 0.01, jerk_in: 2e5, jerk_out: 2e5 };
/// let shape = BlendShape::of_phases(&[phase])?;
/// assert!((shape.entry.speed - 10.0).abs() < 1e-12);
/// assert!((shape.exit.acceleration - 2000.0).abs() < 1e-9);
/// # Ok::<(), toolglide_profiles::BlendError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlendShape {
    /// Where and how it leaves the incoming move.
    pub entry: Boundary,
    /// Where and how it joins the outgoing move.
    pub exit: Boundary,
    /// How long the corner takes, s.
    pub duration: f64,
    phases: [BlendPhase; MAX_PHASES],
    count: u8,
}

impl BlendShape {
    /// A full stop at the corner itself.
    pub const STOP: Self = Self::through(0.0);

    /// Straight on at a speed, mm/s, without any phase.
    #[must_use]
    pub const fn through(speed: f64) -> Self {
        Self::at(Boundary {
            distance: 0.0,
            speed,
            acceleration: 0.0,
        })
    }

    /// A corner that is passed in another way than by phases of constant jerk, between two equal
    /// boundaries: the planner must unroll it by itself.
    #[must_use]
    pub const fn at(boundary: Boundary) -> Self {
        const NONE: BlendPhase = BlendPhase {
            duration: 0.0,
            jerk_in: 0.0,
            jerk_out: 0.0,
        };
        Self {
            entry: boundary,
            exit: boundary,
            duration: 0.0,
            phases: [NONE; MAX_PHASES],
            count: 0,
        }
    }

    /// An exact reversal without any distance: the acceleration in mm/s² that stops the motion starts it again.
    #[must_use]
    pub const fn reversal(acceleration: f64) -> Self {
        let mut shape = Self::at(Boundary {
            distance: 0.0,
            speed: 0.0,
            acceleration,
        });
        shape.count = 1;
        shape
    }

    /// The blend of these phases, in order: its boundaries follow from them, because the motion along
    /// the incoming move ends at rest at the corner, and the motion along the outgoing move begins so.
    ///
    /// # Errors
    /// [`BlendError::TooManyPhases`] for more than [`MAX_PHASES`], and [`BlendError::NoMotion`] for a
    /// negative duration, for a quantity that is not finite, and for phases that lead to a negative
    /// distance, speed or acceleration at a boundary.
    pub fn of_phases(phases: &[BlendPhase]) -> Result<Self, BlendError> {
        let mut shape = Self::at(Boundary::default());
        shape.fill(phases)?;
        shape.duration = phases.iter().map(|phase| phase.duration).sum();
        shape.entry = reached_backwards(phases).0;
        shape.exit = reached_forwards(phases).0;
        shape.check()
    }

    /// The blend of these phases between boundaries that are known in closed form, over a duration in s.
    ///
    /// # Errors
    /// As [`BlendShape::of_phases`], and [`BlendError::NotClosed`] where the phases do not lead to the
    /// boundaries.
    pub fn between(
        entry: Boundary,
        exit: Boundary,
        duration: f64,
        phases: &[BlendPhase],
    ) -> Result<Self, BlendError> {
        let mut shape = Self::at(entry);
        shape.fill(phases)?;
        shape.exit = exit;
        shape.duration = duration;
        let sum: f64 = phases.iter().map(|phase| phase.duration).sum();
        close("duration", sum - duration, duration)?;
        meets(&entry, reached_backwards(phases))?;
        meets(&exit, reached_forwards(phases))?;
        shape.check()
    }

    fn fill(&mut self, phases: &[BlendPhase]) -> Result<(), BlendError> {
        let count = phases.len();
        let Some(places) = self.phases.get_mut(..count) else {
            return Err(BlendError::TooManyPhases { count });
        };
        places.copy_from_slice(phases);
        self.count = u8::try_from(count).map_err(|_| BlendError::TooManyPhases { count })?;
        for phase in phases {
            for (quantity, value, low) in [
                ("duration", phase.duration, 0.0),
                ("jerk along the incoming move", phase.jerk_in, f64::MIN),
                ("jerk along the outgoing move", phase.jerk_out, f64::MIN),
            ] {
                if !(value.is_finite() && value >= low) {
                    return Err(BlendError::NoMotion { quantity, value });
                }
            }
        }
        Ok(())
    }

    fn check(self) -> Result<Self, BlendError> {
        for boundary in [&self.entry, &self.exit] {
            for (quantity, value) in [
                ("distance at a boundary", boundary.distance),
                ("speed at a boundary", boundary.speed),
                ("acceleration at a boundary", boundary.acceleration),
            ] {
                if !(value.is_finite() && value >= 0.0) {
                    return Err(BlendError::NoMotion { quantity, value });
                }
            }
        }
        Ok(self)
    }

    /// The phases, in order.
    #[must_use]
    #[inline]
    pub fn phases(&self) -> &[BlendPhase] {
        &self.phases[..usize::from(self.count)]
    }

    /// The same blend with all times multiplied by `scale` (0 to 1) at the same jerk.
    ///
    /// Accelerations shrink with the scale, speeds with its square, lengths and the corner error with
    /// its cube, so that a smaller blend keeps every limit that the full one keeps.
    #[must_use]
    #[inline]
    pub fn scaled(&self, scale: f64) -> Self {
        let mut scaled = *self;
        scaled.entry = self.entry.scaled(scale);
        scaled.exit = self.exit.scaled(scale);
        scaled.duration = self.duration * scale;
        for phase in &mut scaled.phases[..usize::from(self.count)] {
            phase.duration *= scale;
        }
        scaled
    }

    /// Whether the motion rests at the corner.
    #[must_use]
    #[inline]
    pub fn is_stop(&self) -> bool {
        self.entry.speed <= 0.0
    }

    /// Whether the jerk is constant over the whole corner.
    #[must_use]
    #[inline]
    pub fn is_uninterrupted(&self) -> bool {
        self.count == 1
    }
}

impl Boundary {
    /// The same boundary of a blend that is scaled, see [`BlendShape::scaled`].
    #[must_use]
    #[inline]
    pub fn scaled(&self, scale: f64) -> Self {
        let square = scale * scale;
        Self {
            distance: self.distance * square * scale,
            speed: self.speed * square,
            acceleration: self.acceleration * scale,
        }
    }
}

/// The boundary that a motion from rest reaches after phases of these durations and jerks, and its scale.
fn reached(phases: impl Iterator<Item = Phase> + Clone) -> (Boundary, Boundary) {
    let mut state = State::default();
    let (mut time, mut most) = (0.0, 0.0_f64);
    for phase in phases {
        state = integrate(state, &[phase]);
        time += phase.duration;
        most = most.max(phase.jerk.abs());
    }
    let scale = Boundary {
        distance: most * time * time * time,
        speed: most * time * time,
        acceleration: most * time,
    };
    // What rounding leaves of nothing is nothing.
    let value = |value: f64, scale: f64| {
        if value.abs() > CLOSURE * scale {
            value
        } else {
            0.0
        }
    };
    let boundary = Boundary {
        distance: value(state.position, scale.distance),
        speed: value(state.velocity, scale.speed),
        acceleration: value(state.acceleration, scale.acceleration),
    };
    (boundary, scale)
}

/// What the phases of the incoming move come from; mirrored in time they begin at rest.
fn reached_backwards(phases: &[BlendPhase]) -> (Boundary, Boundary) {
    reached(phases.iter().rev().map(|phase| Phase {
        duration: phase.duration,
        jerk: phase.jerk_in,
    }))
}

/// What the phases of the outgoing move lead to.
fn reached_forwards(phases: &[BlendPhase]) -> (Boundary, Boundary) {
    reached(phases.iter().map(|phase| Phase {
        duration: phase.duration,
        jerk: phase.jerk_out,
    }))
}

fn meets(boundary: &Boundary, (reached, scale): (Boundary, Boundary)) -> Result<(), BlendError> {
    for (quantity, value, reached, scale) in [
        (
            "distance",
            boundary.distance,
            reached.distance,
            scale.distance,
        ),
        ("speed", boundary.speed, reached.speed, scale.speed),
        (
            "acceleration",
            boundary.acceleration,
            reached.acceleration,
            scale.acceleration,
        ),
    ] {
        close(quantity, reached - value, scale)?;
    }
    Ok(())
}

fn close(quantity: &'static str, miss: f64, scale: f64) -> Result<(), BlendError> {
    if miss.abs() <= CLOSED * scale {
        Ok(())
    } else {
        Err(BlendError::NotClosed { quantity, miss })
    }
}

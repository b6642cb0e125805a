//! Blends a corner by two feed pulses that overlap behind a chain of two moving averages.
//!
//! Source: section 4.3, where the pause between two pulses decides how far the motion passes from the
//! corner. A moving average of a moving average turns a step of feedrate into phases of constant jerk,
//! so the corner is a blend as any other. Not here: more than two pulses within a chain, which the
//! look-ahead of this crate plans.

use crate::error::FirError;
use crate::filter::chain::FilterChain;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::{Corner, Limits, Vector, largest_multiple};
use toolglide_profiles::{BlendError, BlendPhase, BlendShape, Blender};

/// Two directions that differ by less are one: the velocity jumps by less than a billionth.
const STRAIGHT: f64 = 1e-12;

/// Filters of the chain.
const FILTERS: usize = 2;

/// Times at which the jerk of a step behind two filters changes.
const SWITCHES: usize = 4;

/// Turns a corner by two pulses: the incoming one ends while the outgoing one begins, each smoothed by
/// two moving averages, with no longer a pause between them than the tolerance asks for.
///
/// Both pulses have the feedrate of the corner, lowered to what the limits allow behind the chain.
///
/// # Examples
/// ```
/// use toolglide_fir::{FilterChain, PulseCorner};
/// use toolglide_kinematics::{Corner, Limits, Tolerance, Vector};
/// use toolglide_profiles::Blender;
/// let corner = Corner {
///     point: Vector::<2>::zeros(),
///     incoming: Vector::<2>::x(),
///     outgoing: Vector::<2>::y(),
///     speed_in: 50.0,
///     speed_out: 50.0,
///     tolerance: Tolerance::new(0.1)?,
/// };
/// let chain = FilterChain::with_time_constants(&[0.02, 0.0125])?;
/// let blender = PulseCorner::new(Limits::uniform(500.0, 2500.0, 2e5)?, &chain)?;
/// let shape = blender.blend(&corner, 10.0, 10.0)?;
/// assert!((shape.entry.speed - 50.0).abs() < 1e-9);
/// assert!((shape.corner_error(&corner) - 0.1).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseCorner<const N: usize> {
    limits: Limits<N>,
    step: Step,
}

impl<const N: usize> PulseCorner<N> {
    /// Corners within these limits behind a chain of two filters.
    ///
    /// # Errors
    /// [`FirError::FilterCount`] for a chain of another number of filters.
    pub fn new(limits: Limits<N>, chain: &FilterChain) -> Result<Self, FirError> {
        let &[long, short] = chain.time_constants() else {
            return Err(FirError::FilterCount {
                given: chain.time_constants().len(),
                most: FILTERS,
            });
        };
        Ok(Self {
            limits,
            step: Step { long, short },
        })
    }

    /// The chain of two filters behind which every axis may step to a feedrate in mm/s, and to no more:
    /// section 4.2.2.
    #[must_use]
    pub fn designed(limits: Limits<N>, feedrate: f64) -> Self {
        let chain = crate::settings::designed_for(&limits, feedrate);
        Self {
            limits,
            step: Step {
                long: chain.long(),
                short: chain.short(),
            },
        }
    }

    /// The largest feedrate of both pulses, mm/s. While they overlap, however much, each adds between
    /// nothing and all of its acceleration, and its jerk in either direction or none.
    fn feedrate(&self, corner: &Corner<N>) -> f64 {
        let Corner {
            incoming, outgoing, ..
        } = corner;
        let least = |vectors: &[&Vector<N>], bound: &Vector<N>| {
            let multiples = vectors.iter().map(|vector| largest_multiple(vector, bound));
            multiples.fold(f64::INFINITY, f64::min)
        };
        let (difference, sum) = (outgoing - incoming, outgoing + incoming);
        let Step { long, short } = self.step;
        corner
            .speed_in
            .min(corner.speed_out)
            .min(least(&[incoming, outgoing], self.limits.velocity()))
            .min(
                long * least(
                    &[incoming, outgoing, &difference],
                    self.limits.acceleration(),
                ),
            )
            .min(long * short * least(&[incoming, outgoing, &difference, &sum], self.limits.jerk()))
    }
}

impl<const N: usize> Blender<N> for PulseCorner<N> {
    /// # Errors
    /// [`BlendError::Straight`] where the path goes straight on: pulses of one direction need no blend.
    fn blend(&self, corner: &Corner<N>, _: f64, _: f64) -> Result<BlendShape, BlendError> {
        let turned = (corner.outgoing - corner.incoming).norm();
        if turned <= STRAIGHT {
            return Err(BlendError::Straight {
                turn_angle: corner.turn_angle(),
            });
        }
        let feedrate = self.feedrate(corner);
        let pause = self
            .step
            .pause_for(corner.tolerance.length() / (feedrate * turned));
        self.step.overlapped(pause, feedrate)
    }
}

/// The response of the chain to a step of feedrate: constant jerk for the shorter time constant, constant
/// acceleration, and the opposite jerk.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    /// The longer time constant, s.
    long: f64,
    /// The shorter one, s.
    short: f64,
}

impl Step {
    /// Times at which the jerk changes.
    fn switches(&self) -> [f64; 4] {
        [0.0, self.short, self.long, self.long + self.short]
    }

    /// Jerk of a unit step at a time.
    fn jerk_at(&self, time: f64) -> f64 {
        let [begin, hold, fall, end] = self.switches();
        let jerk = 1.0 / (self.long * self.short);
        if (begin..hold).contains(&time) {
            jerk
        } else if (fall..end).contains(&time) {
            -jerk
        } else {
            0.0
        }
    }

    /// The pause between two pulses of a unit feedrate that leaves them this distance from their corner
    /// in the middle of the blend, s.
    ///
    /// What the outgoing pulse has done there is what the incoming one has left, because the response is
    /// the same backwards.
    fn pause_for(&self, distance: f64) -> f64 {
        let Self { long, short } = *self;
        let by_jerk = (6.0 * long * short * distance).cbrt();
        let time = if by_jerk <= short {
            by_jerk
        } else {
            // Behind the jerk, at `short / 2 / long` of speed and an acceleration of `1 / long`.
            let left = distance - short * short / (6.0 * long);
            let speed = 0.5 * short / long;
            short + long * ((speed * speed + 2.0 * left / long).sqrt() - speed)
        };
        (long + short - 2.0 * time).max(0.0)
    }

    /// The blend of two pulses of one feedrate, mm/s, with a pause between them, s.
    fn overlapped(&self, pause: f64, feedrate: f64) -> Result<BlendShape, BlendError> {
        let mut times = [0.0; 2 * SWITCHES];
        for (index, switch) in self.switches().into_iter().enumerate() {
            times[index] = switch;
            times[SWITCHES + index] = switch + pause;
        }
        times.sort_unstable_by(f64::total_cmp);
        let mut phases = [BlendPhase::default(); 2 * SWITCHES];
        let mut count = 0;
        for pair in times.windows(2) {
            let duration = pair[1] - pair[0];
            if duration > 0.0 {
                let middle = 0.5 * (pair[0] + pair[1]);
                phases[count] = BlendPhase {
                    duration,
                    jerk_in: -feedrate * self.jerk_at(middle),
                    jerk_out: feedrate * self.jerk_at(middle - pause),
                };
                count += 1;
            }
        }
        BlendShape::of_phases(&phases[..count])
    }
}

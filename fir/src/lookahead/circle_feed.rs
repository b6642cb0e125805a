//! Computes the largest feedrate of a circle: the mean of points on a circle lies inside it.
//!
//! Source: section 4.2.3, equations 4.15 to 4.20. The printed quartic always errs to the unsafe side
//! and has no root for large tolerances; the exact root is found instead. Not here: centripetal
//! acceleration, which the planner bounds.

use crate::error::FirError;
use crate::filter::chain::FilterChain;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Most steps towards the root; some ten are enough.
const STEPS: u32 = 60;

/// Relative width at which the bracket is narrow enough: its lower end keeps the tolerance.
const NARROW: f64 = 1e-11;

/// Largest feedrate at which a circle of a radius is cut by no more than a tolerance.
///
/// Behind the filters a circle of radius `R` at feedrate `F` has the radius `R |G(F/R)|`, where `G`
/// is the [gain](FilterChain::gain); starting and stopping never cut more.
///
/// # Source
/// Equation 4.16 with the magnitude; the root of `R (1 - |G|) = tolerance` below the first notch.
///
/// # Errors
/// [`FirError::NotPositive`] for a radius or tolerance that is not positive and finite,
/// [`FirError::ToleranceAboveRadius`] where no feedrate is too fast.
///
/// # Examples
/// ```
/// use toolglide_fir::{FilterChain, largest_circle_feed};
/// let chain = FilterChain::with_time_constants(&[0.05, 0.03])?;
/// let feed = largest_circle_feed(&chain, 10.0, 0.1)?;
/// assert!((feed - 84.176269484936).abs() < 1e-9);
/// # Ok::<(), toolglide_fir::FirError>(())
/// ```
pub fn largest_circle_feed(
    chain: &FilterChain,
    radius: f64,
    tolerance: f64,
) -> Result<f64, FirError> {
    for (quantity, value) in [("radius", radius), ("tolerance", tolerance)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(FirError::NotPositive { quantity, value });
        }
    }
    if tolerance >= radius {
        return Err(FirError::ToleranceAboveRadius { tolerance, radius });
    }
    let notch = core::f64::consts::TAU / chain.time_constants()[0];
    let start = (2.0 * tolerance / (radius * chain.variance())).sqrt();
    Ok(radius * angular_velocity(|w| chain.gain(w), tolerance / radius, start, notch))
}

/// The angular velocity at which a gain has fallen by a share, between one that is slow enough and
/// the first notch: never above it.
pub(crate) fn angular_velocity(
    gain: impl Fn(f64) -> f64,
    share: f64,
    slow_enough: f64,
    notch: f64,
) -> f64 {
    let missing = |w: f64| 1.0 - gain(w) - share;
    let (mut low, mut high) = (slow_enough.min(notch), notch);
    let (mut below, mut above) = (missing(low), missing(high));
    if above <= 0.0 {
        return high;
    }
    // False position; an end that stays counts half the next time, so that both ends close in.
    let mut stayed = 0_i32;
    for _ in 0..STEPS {
        if high - low <= NARROW * high || below >= 0.0 {
            break;
        }
        let middle = (low + (high - low) * (below / (below - above))).clamp(low, high);
        let value = missing(middle);
        if value > 0.0 {
            (high, above) = (middle, value);
            if stayed < 0 {
                below *= 0.5;
            }
            stayed = -1;
        } else {
            (low, below) = (middle, value);
            if stayed > 0 {
                above *= 0.5;
            }
            stayed = 1;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_smaller_than_its_tolerance_has_no_largest_feed() {
        let chain = FilterChain::with_time_constants(&[0.05, 0.03]).unwrap();
        assert!(
            matches!(
                largest_circle_feed(&chain, 0.1, 0.2),
                Err(FirError::ToleranceAboveRadius { .. })
            ),
            "tolerance above radius"
        );
        for (radius, tolerance) in [(0.0, 0.1), (f64::NAN, 0.1), (10.0, 0.0), (10.0, -1.0)] {
            assert!(
                matches!(
                    largest_circle_feed(&chain, radius, tolerance),
                    Err(FirError::NotPositive { .. })
                ),
                "{radius}, {tolerance}"
            );
        }
    }

    #[test]
    fn the_root_uses_the_tolerance_up_where_the_printed_quartic_exceeds_it() {
        let chain = FilterChain::with_time_constants(&[0.1, 0.06]).unwrap();
        for share in [1e-6, 0.01, 0.5, 0.9, 0.99] {
            let feed = largest_circle_feed(&chain, 1.0, share).unwrap();
            let cut = 1.0 - chain.gain(feed).abs();
            assert!((cut / share - 1.0).abs() < 1e-9, "{share}: {cut}");
        }
    }
}

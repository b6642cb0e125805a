//! Holds the share of the limits that a plan leaves to the execution.
//!
//! Source: ours. A motion that uses a limit up cannot be slowed down at once: with one axis braking and another
//! accelerating at their jerk limits no other rate of time is possible. A plan within `rho^2` of the acceleration and
//! `rho^3` of the jerk has the slack of a motion executed at the rate `rho`.

use crate::error::LimitsError;

/// The largest reserve.
const MAX_RESERVE: f64 = 0.5;

/// How much slower than the limits allow a plan is made, as a share of time, so that its execution can react.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reserve(f64);

impl Reserve {
    /// Nothing is left: a stop may have to wait for the next rest of the plan.
    pub const NONE: Self = Self(0.0);

    /// A share from 0 to 0.5; a plan takes at most this much longer.
    ///
    /// # Errors
    /// [`LimitsError::Reserve`] for a share outside, or no number.
    pub fn new(share: f64) -> Result<Self, LimitsError> {
        if (0.0..=MAX_RESERVE).contains(&share) {
            Ok(Self(share))
        } else {
            Err(LimitsError::Reserve {
                value: share,
                most: MAX_RESERVE,
            })
        }
    }

    /// The share.
    #[must_use]
    pub fn share(self) -> f64 {
        self.0
    }

    /// The rate at which the plan uses up what it keeps: 1 less the share.
    #[must_use]
    pub fn rho(self) -> f64 {
        1.0 - self.0
    }
}

impl Default for Reserve {
    /// One per cent.
    fn default() -> Self {
        Self(0.01)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reserve_is_a_share_from_nothing_to_a_half() {
        for value in [-0.01, 0.51, f64::NAN, f64::INFINITY] {
            assert!(Reserve::new(value).is_err(), "{value}");
        }
        assert!(
            (Reserve::new(0.02).unwrap().rho() - 0.98).abs() < 1e-15,
            "rho"
        );
    }
}

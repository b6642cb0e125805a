//! Holds limits, method and filters of a plan.
//!
//! Source: section 4.2.2 for the choice of time constants. Not here: the planning.

use crate::error::FirError;
use crate::filter::chain::FilterChain;
use crate::filter::cubic::CubicChain;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::{Limits, Vector};

/// What is left of a limit for rounding.
const ROUNDING: f64 = 1.0 - 1e-9;

/// How corners are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Without a stop, inside the tolerance.
    NonStop,
    /// A full stop at the end of every move.
    PointToPoint,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 2] = [Self::NonStop, Self::PointToPoint];

    /// The name as commands and reports write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NonStop => "fir",
            Self::PointToPoint => "fir-p2p",
        }
    }

    /// The method of a name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }
}

/// Time constants that are chosen are no shorter than this, s: below any servo period, and long enough
/// that acceleration, which grows within one of them, keeps its digits beside those of time.
const SHORTEST: f64 = 1e-4;

/// What a plan must keep, and which filters it may use.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings<const N: usize> {
    pub(crate) limits: Limits<N>,
    pub(crate) method: Method,
    pub(crate) chain: Option<CubicChain>,
}

impl<const N: usize> Settings<N> {
    /// Non-stop, with time constants chosen from the limits and the feedrates.
    ///
    /// Where the feedrate changes by more than a factor of two, the motion rests and goes on with other
    /// time constants.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self {
            limits,
            method: Method::NonStop,
            chain: None,
        }
    }

    /// The same with another method.
    #[must_use]
    pub fn with_method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// The same with a chain for the whole motion; feedrates are lowered to what it and the limits
    /// allow.
    ///
    /// # Errors
    /// [`FirError::SingleFilter`] for a single filter, whose jerk has no bound.
    pub fn with_chain(mut self, chain: &FilterChain) -> Result<Self, FirError> {
        self.chain = Some(CubicChain::of(chain)?);
        Ok(self)
    }
}

/// Largest difference of the commanded velocities of each axis within the window of a chain.
///
/// Acceleration is a difference of two means of them over the longest time constant, jerk a sum of
/// two differences over the product of the two longest.
pub(crate) fn largest_change<const N: usize>(limits: &Limits<N>, chain: &CubicChain) -> Vector<N> {
    let (long, short) = (chain.long(), chain.short());
    (limits.acceleration() * long).inf(&(limits.jerk() * (0.5 * long * short))) * ROUNDING
}

/// The chain with which every axis may step to its share of a feedrate, and to no more.
///
/// # Source
/// Section 4.2.2: the longest time constant from the acceleration, the other from the jerk, twice as
/// long because ramps of two steps may coincide.
pub(crate) fn designed_for<const N: usize>(limits: &Limits<N>, feed: f64) -> CubicChain {
    let (mut longest, mut product) = (0.0_f64, 0.0_f64);
    for axis in 0..N {
        let velocity = feed.min(limits.velocity()[axis]);
        longest = longest.max(velocity / limits.acceleration()[axis]);
        product = product.max(2.0 * velocity / limits.jerk()[axis]);
    }
    let longest = longest.max(product.sqrt()).max(SHORTEST);
    let shortest = (product / longest).max(SHORTEST);
    CubicChain::of_two(longest / ROUNDING, shortest / ROUNDING)
}

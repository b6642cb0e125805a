//! Holds the settings of a pose planner: method, filters, tolerances.
//!
//! Source: sections 5.2 and 5.3. Not here: what legs say for themselves.

use crate::error::FiveAxisError;
use toolglide_fir::FilterChain;
use toolglide_kinematics::SamplePeriod;

/// How corners of tool poses are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PoseMethod {
    /// Rest at every pose.
    PointToPoint,
    /// The dwell between two moves is as short as both tolerances allow: NS-DCB, section 5.3.1.
    DwellControlled,
    /// No dwell; both moves are slow near the corner: NS-VCB, section 5.3.2.
    VelocityControlled,
    /// Axes go straight between the poses, without dwell and without regard to tolerances: NS-JCB,
    /// the usual way of today, to compare with.
    JointSpace {
        /// Poses put between those of the program, on every move.
        way_points: u32,
    },
}

/// Filters, method, and the largest rate of the tool.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseSettings {
    chain: FilterChain,
    method: PoseMethod,
    turn_rate: f64,
    keeps_axis_limits: bool,
    choice: Option<SamplePeriod>,
}

impl PoseSettings {
    /// Settings of a method with a chain of two filters, whose tool turns as fast as the axes can.
    ///
    /// # Errors
    /// [`FiveAxisError::FilterCount`] for a chain of any other number of filters: one has no finite
    /// jerk, and three make no motion of constant jerk.
    pub fn new(chain: FilterChain, method: PoseMethod) -> Result<Self, FiveAxisError> {
        let given = chain.time_constants().len();
        if given != 2 {
            return Err(FiveAxisError::FilterCount { given });
        }
        Ok(Self {
            chain,
            method,
            turn_rate: f64::INFINITY,
            keeps_axis_limits: true,
            choice: None,
        })
    }

    /// The same with a largest rate at which the tool turns, rad/s: positive.
    #[must_use]
    pub fn with_turn_rate(mut self, rate: f64) -> Self {
        if rate > 0.0 {
            self.turn_rate = rate;
        }
        self
    }

    /// The same, timed by feedrates alone: whoever has no machine, or looks at one block.
    #[must_use]
    pub fn without_axis_limits(mut self) -> Self {
        self.keeps_axis_limits = false;
        self
    }

    /// The same, where other filters may be tried than those of the chain: each stretch between two rests keeps
    /// those with which it is fastest, of time constants that are whole numbers of `period`.
    ///
    /// For programs of which nobody says how they are filtered: no option, no machine file, no mode of vibration.
    /// NS-JCB, which keeps no tolerance, stays with the chain.
    #[must_use]
    pub fn choosing_filters(mut self, period: SamplePeriod) -> Self {
        self.choice = Some(period);
        self
    }

    /// Period of which the time constants of other filters are whole numbers; `None` where the chain is asked for.
    #[must_use]
    pub fn choice(&self) -> Option<SamplePeriod> {
        self.choice
    }

    /// The filters; those tried first where they are chosen.
    #[must_use]
    pub fn chain(&self) -> &FilterChain {
        &self.chain
    }

    /// How corners are taken.
    #[must_use]
    pub fn method(&self) -> PoseMethod {
        self.method
    }

    /// Largest rate at which the tool turns, rad/s; infinite where the axes alone bound it.
    #[must_use]
    pub fn turn_rate(&self) -> f64 {
        self.turn_rate
    }

    /// Whether blocks are slowed down until every axis keeps its limits.
    #[must_use]
    pub fn keeps_axis_limits(&self) -> bool {
        self.keeps_axis_limits
    }
}

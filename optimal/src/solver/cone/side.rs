//! Implements one inequality, and the state that all constraints share.
//!
//! Source: as [`cone`](super). Not here: second-order cones.

use crate::solver::cone::MIN_SLACK;

/// What all rows of a problem add up to in one iteration.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// Slacks times multipliers.
    pub(crate) complementarity: f64,
    /// Largest miss between a slack and what is left to the bound.
    pub(crate) residual: f64,
}

/// How far slacks and multipliers may go along a direction, and what that does to the complementarity.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Reach {
    /// Reciprocal of the longest step of the slacks.
    pub(crate) primal: f64,
    /// Reciprocal of the longest step of the multipliers.
    pub(crate) dual: f64,
    /// Changes of slacks times multipliers.
    pub(crate) by_slack: f64,
    /// Slacks times changes of multipliers.
    pub(crate) by_multiplier: f64,
    /// Changes times changes.
    pub(crate) by_both: f64,
}

/// What the correcting step aims at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Centre {
    /// Complementarity of every row.
    pub(crate) complementarity: f64,
    /// Share of the second order of the predicted step that is corrected.
    pub(crate) second_order: f64,
    /// Share of what the first multipliers missed that the step leaves.
    pub(crate) kept: f64,
}

/// One inequality: a quantity that must stay positive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    slack: f64,
    multiplier: f64,
    /// What the multiplier started at: what it missed then is what may be left for later.
    first_multiplier: f64,
    residual: f64,
    weight: f64,
    target: f64,
    slack_change: f64,
    multiplier_change: f64,
}

impl Default for Side {
    fn default() -> Self {
        Self {
            slack: 1.0,
            multiplier: 1.0,
            first_multiplier: 1.0,
            residual: 0.0,
            weight: 1.0,
            target: 0.0,
            slack_change: 0.0,
            multiplier_change: 0.0,
        }
    }
}

impl Side {
    /// Starts at the value of the quantity, or inside where that is not; gives what is missing.
    pub(crate) fn reset(&mut self, value: f64) -> f64 {
        self.reset_inside(value, MIN_SLACK)
    }

    /// The same where inside is above `least`.
    pub(crate) fn reset_inside(&mut self, value: f64, least: f64) -> f64 {
        self.slack = value.max(least);
        self.multiplier = 1.0 / self.slack;
        self.first_multiplier = self.multiplier;
        self.slack - value
    }

    /// Takes the value of the quantity; gives weight and weighted residual.
    #[inline(always)]
    pub(crate) fn weigh(&mut self, value: f64, sums: &mut Sums) -> (f64, f64) {
        self.residual = value - self.slack;
        self.weight = self.multiplier / self.slack;
        sums.complementarity += self.slack * self.multiplier;
        sums.residual = sums.residual.max(self.residual.abs());
        (self.weight, self.weight * self.residual)
    }

    /// Takes the change of the quantity in the predicting step.
    #[inline(always)]
    pub(crate) fn predict(&mut self, change: f64, reach: &mut Reach) {
        let slack_change = change + self.residual;
        let multiplier_change = -self.multiplier - self.weight * slack_change;
        let share = slack_change / self.slack;
        reach.primal = reach.primal.max(-share);
        reach.dual = reach.dual.max(1.0 + share);
        let both = slack_change * multiplier_change;
        reach.by_slack += slack_change * self.multiplier;
        reach.by_multiplier += self.slack * multiplier_change;
        reach.by_both += both;
        self.target = both;
    }

    /// Weighted residual of the correcting step towards a centre.
    #[inline(always)]
    pub(crate) fn correct(&mut self, centre: Centre) -> f64 {
        self.target = (centre.complementarity - centre.second_order * self.target) / self.slack;
        self.weight * self.residual - self.target + centre.kept * self.first_multiplier
    }

    /// Takes the change of the quantity in the final step.
    #[inline(always)]
    pub(crate) fn aim(&mut self, change: f64, reach: &mut Reach) {
        self.slack_change = change + self.residual;
        self.multiplier_change = self.target - self.multiplier - self.weight * self.slack_change;
        reach.primal = reach.primal.max(-self.slack_change / self.slack);
        reach.dual = reach.dual.max(-self.multiplier_change / self.multiplier);
    }

    /// Goes the given steps.
    #[inline(always)]
    pub(crate) fn advance(&mut self, primal: f64, dual: f64) {
        self.slack += primal * self.slack_change;
        self.multiplier += dual * self.multiplier_change;
    }
}

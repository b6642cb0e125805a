//! Checks a plan with its final times against limits and feedrates.
//!
//! Source: ours. Shares nothing with the search of feedrates but the bound on the change of velocity.
//! Not here: what is done where it is broken.

use crate::lookahead::LookAhead;
use crate::lookahead::bound::TOUCH;
use toolglide_kinematics::Vector;

/// What a change of velocity may exceed its bound by, relative.
const SLACK: f64 = 1e-10;

impl<const N: usize> LookAhead<N> {
    /// Whether no axis changes its velocity by too much within the longest filter, as all is timed.
    pub(super) fn in_step(&self) -> bool {
        let long = self.chain.long();
        let much = |change: Vector<N>| {
            (0..N).any(|axis| change[axis].abs() > self.change[axis] * (1.0 + SLACK))
        };
        let velocity = |index: usize| self.pulses[index].direction * self.pulses[index].feed;
        let count = self.pulses.len();
        let end = |index: usize| self.schedule.end(index);
        // The rest at the end of all that is known.
        if count > 0 {
            let last = end(count - 1);
            for index in (0..count).rev() {
                if end(index) + long <= last + TOUCH {
                    break;
                }
                if much(velocity(index)) {
                    return false;
                }
            }
        }
        for index in self.fixed..count {
            let begin = self.schedule.begin(index);
            let here = velocity(index);
            for earlier in (0..=index).rev() {
                let starts = earlier == 0 && !self.underway;
                if starts && self.schedule.begin(0) + long > begin + TOUCH && much(here) {
                    return false;
                }
                if earlier == 0 {
                    break;
                }
                let (stops, goes_on) = (end(earlier - 1), self.schedule.begin(earlier));
                if goes_on > stops {
                    if goes_on + long > begin + TOUCH && much(here) {
                        return false;
                    }
                    if earlier == index {
                        for before in (0..earlier).rev() {
                            if end(before) + long <= stops + TOUCH {
                                break;
                            }
                            if much(velocity(before)) {
                                return false;
                            }
                        }
                    }
                }
                if stops + long <= begin + TOUCH {
                    break;
                }
                if much(here - velocity(earlier - 1)) {
                    return false;
                }
            }
        }
        true
    }
}

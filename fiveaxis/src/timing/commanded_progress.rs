//! Evaluates the commanded progress of a block behind the filters.
//!
//! Source: equations 5.3 and 5.17, as sums of step responses instead of case tables. Not here: when
//! the steps are, see `timing`.

use toolglide_fir::FilterChain;
use toolglide_kinematics::CubicInTime;

/// Most steps of a block: slow, fast, slow, and an end.
const MAX_STEPS: usize = 4;

/// Steps of the rate of progress of one block; progress goes from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Steps {
    list: [(f64, f64); MAX_STEPS],
    count: usize,
}

impl Steps {
    /// A pulse of constant rate.
    pub(crate) fn pulse(start: f64, duration: f64) -> Self {
        let mut steps = Self::default();
        steps.push(start, 1.0 / duration);
        steps.push(start + duration, -1.0 / duration);
        steps
    }

    /// Adds a step: when, and by how much the rate changes, 1/s.
    pub(crate) fn push(&mut self, time: f64, change: f64) {
        debug_assert!(self.count < MAX_STEPS, "a block has at most three pulses");
        self.list[self.count] = (time, change);
        self.count += 1;
    }

    pub(crate) fn times(&self) -> impl Iterator<Item = f64> + '_ {
        self.list[..self.count].iter().map(|step| step.0)
    }

    /// When the block begins to move.
    pub(crate) fn begin(&self) -> f64 {
        self.list[0].0
    }

    /// When its command is over; the filters need their delay more.
    pub(crate) fn command_end(&self) -> f64 {
        self.list[self.count.saturating_sub(1)].0
    }

    /// Filtered progress as a polynomial from `time` on, up to the next knot; `inside` is an instant
    /// before it.
    ///
    /// All of it is taken inside, where rounding cannot mistake the side of a knot: the rest of an
    /// acceleration that is over would grow with the square of a long interval.
    pub(crate) fn cubic(&self, chain: &FilterChain, time: f64, inside: f64) -> CubicInTime {
        let [position, velocity, acceleration, jerk] = self.state(chain, inside);
        let back = time - inside;
        [
            position + (velocity + (acceleration / 2.0 + jerk / 6.0 * back) * back) * back,
            velocity + (acceleration + jerk / 2.0 * back) * back,
            (acceleration + jerk * back) / 2.0,
            jerk / 6.0,
        ]
    }

    /// Filtered progress and its first three derivatives at an instant.
    pub(crate) fn state(&self, chain: &FilterChain, time: f64) -> [f64; 4] {
        let mut state = [0.0; 4];
        for &(at, change) in &self.list[..self.count] {
            for (sum, part) in state.iter_mut().zip(chain.state(time - at)) {
                *sum += change * part;
            }
        }
        state
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::cubic_at;

    #[test]
    fn a_pulse_of_hours_goes_straight_on_between_its_ramps() {
        let chain = FilterChain::with_time_constants(&[0.011, 0.0043]).unwrap();
        for start in [0.0, 1_412.456, 52_345.678] {
            let duration = 4_321.987;
            let pulse = Steps::pulse(start, duration);
            let (begin, end) = (start + chain.total_delay(), start + duration);
            let cubic = pulse.cubic(&chain, begin, 0.5 * (begin + end));
            for share in [0.0, 0.3, 1.0] {
                let time = share * (end - begin);
                let gone = (begin + time - start - 0.5 * chain.total_delay()) / duration;
                let miss = (cubic_at(&cubic, time) - gone).abs();
                assert!(miss < 1e-14, "{start} s, {share}: {miss}");
            }
        }
    }
}

//! Divides time into intervals: how many serve each segment, and how long they are.
//!
//! Source: the relative grid on which the minimum of time is one convex program; only a common factor
//! is left open. Not here: that factor.

/// Intervals of time, in order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Grid {
    /// First interval of each leg, and the number of all intervals.
    pub(crate) firsts: Vec<usize>,
    /// Duration of each interval, s.
    pub(crate) steps: Vec<f64>,
    /// The leg that each interval serves.
    pub(crate) serves: Vec<usize>,
}

impl Grid {
    /// `counts[i]` equal intervals for leg `i`, which lasts `times[i]`.
    #[allow(clippy::cast_precision_loss, reason = "counts stay below 2^53")]
    pub(crate) fn new(times: &[f64], counts: &[usize]) -> Self {
        let mut grid = Self {
            firsts: vec![0],
            steps: Vec::new(),
            serves: Vec::new(),
        };
        for (leg, (&time, &count)) in times.iter().zip(counts).enumerate() {
            for _ in 0..count {
                grid.steps.push(time / count as f64);
                grid.serves.push(leg);
            }
            grid.firsts.push(grid.steps.len());
        }
        grid
    }

    /// How many intervals there are.
    pub(crate) fn intervals(&self) -> usize {
        self.steps.len()
    }

    /// How long all of them last.
    pub(crate) fn duration(&self) -> f64 {
        self.steps.iter().sum()
    }

    /// How long the intervals of each leg last, s.
    pub(crate) fn leg_times(&self) -> Vec<f64> {
        let bounds = self.firsts.windows(2);
        bounds
            .map(|pair| self.steps[pair[0]..pair[1]].iter().sum())
            .collect()
    }

    /// The same intervals, all `factor` times as long.
    pub(crate) fn stretched(&self, factor: f64) -> Self {
        let mut grid = self.clone();
        grid.steps.iter_mut().for_each(|step| *step *= factor);
        grid
    }
}

/// Shares about `intervals` intervals among legs that last `times`: each has at least `least`, and
/// none where it takes no time.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts are positive and far below 2^53"
)]
pub(crate) fn share(times: &[f64], intervals: usize, least: usize) -> Vec<usize> {
    let total: f64 = times.iter().sum();
    times
        .iter()
        .map(|&time| {
            if time > 0.0 {
                ((intervals as f64 * time / total).round() as usize).max(least)
            } else {
                0
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_shared_by_duration_and_add_up() {
        let times = [0.3, 0.0, 0.1, 0.001];
        let counts = share(&times, 40, 3);
        assert_eq!(counts, [30, 0, 10, 3]);
        let grid = Grid::new(&times, &counts);
        assert_eq!(grid.firsts, [0, 30, 30, 40, 43]);
        assert!((grid.duration() - 0.401).abs() < 1e-12, "{grid:?}");
    }
}

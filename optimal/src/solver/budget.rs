//! Counts the work of planning, and says how much of it a stretch of motion may cost.
//!
//! Source: ours. Work is counted in intervals times steps of the interior-point method, never in seconds:
//! same input, same bytes. Motion earns what planning may spend, up to a store that covers the start of a
//! stretch. Not here: what becomes of a stretch whose windows cost more.

/// Most work of one window, all attempts included: some 0.15 s on a core of today.
const WINDOW: u64 = 180_000;

/// Most work that is saved up: what a stretch may cost beyond what its motion earns.
const STORE: u64 = 400_000;

/// Work that a second of motion earns on up to two axes, and on more, where a step costs twice as much.
const EARNED: [f64; 2] = [4e5, 2e5];

/// Steps of the interior-point method without which no window is begun: those of a usual one.
const USUAL_STEPS: u64 = 100;

/// Percent more that a smoothed window costs, and one of motion that leaves a mode of vibration at rest.
const SMOOTHING: u64 = 25;
const MODE: u64 = 25;

/// How much larger than the usual one a window is.
#[allow(clippy::cast_precision_loss, reason = "some millions at the most")]
fn scale(window: u64) -> f64 {
    window as f64 / WINDOW as f64
}

fn count(modes: usize) -> u64 {
    u64::try_from(modes).unwrap_or(0)
}

/// What finding a motion may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Linearised problems.
    pub solves: usize,
    /// Intervals times steps of the interior-point method; a solver takes away what it has done.
    pub work: u64,
}

impl Default for Budget {
    /// As much as is wanted.
    fn default() -> Self {
        Self::solves(usize::MAX)
    }
}

impl Budget {
    /// So many linearised problems of any size.
    #[must_use]
    pub fn solves(solves: usize) -> Self {
        Self {
            solves,
            work: u64::MAX,
        }
    }

    /// Steps that are left for a window of so many intervals.
    pub(crate) fn steps(&self, intervals: usize) -> u64 {
        self.work / u64::try_from(intervals.max(1)).unwrap_or(u64::MAX)
    }

    /// Takes away steps on a window of so many intervals.
    pub(crate) fn spend(&mut self, intervals: usize, steps: u32) {
        let intervals = u64::try_from(intervals).unwrap_or(u64::MAX);
        let spent = intervals.saturating_mul(u64::from(steps));
        self.work = self.work.saturating_sub(spent);
    }
}

/// What planning may still cost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Credit {
    left: u64,
    spent: u64,
    earned: f64,
    window: u64,
    store: u64,
}

impl Credit {
    /// The whole store, for motion of so many axes; `smooth` motion needs one problem more a window, and modes of
    /// vibration make every one costlier.
    pub(crate) fn new(axes: usize, smooth: bool, modes: usize) -> Self {
        let share = if smooth { 100 + SMOOTHING } else { 100 };
        let scaled = |work: u64| work * share / 100 + work * MODE * count(modes) / 100;
        let (store, window) = (scaled(STORE), scaled(WINDOW));
        Self {
            left: store,
            spent: 0,
            earned: EARNED[usize::from(axes > 2)] * scale(window),
            window,
            store,
        }
    }

    /// What motion of a duration (s) earns.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive number of work, cut off at the store"
    )]
    pub(crate) fn earn(&mut self, duration: f64) {
        let earned = (self.earned * duration).max(0.0) as u64;
        self.left = self.left.saturating_add(earned).min(self.store);
    }

    /// What the next window may cost; `None` where that is too little for its `intervals`, unless it
    /// `must` be planned.
    pub(crate) fn window(&self, intervals: usize, must: bool) -> Option<u64> {
        if must {
            return Some(self.window);
        }
        let intervals = u64::try_from(intervals).unwrap_or(u64::MAX);
        let usual = USUAL_STEPS.saturating_mul(intervals).min(self.window);
        (self.left >= usual).then_some(usual.max(self.left / 2).min(self.window))
    }

    /// Takes away what a window has cost.
    pub(crate) fn pay(&mut self, work: u64) {
        self.left = self.left.saturating_sub(work);
        self.spent = self.spent.saturating_add(work);
    }

    /// Whether there is hardly anything left.
    pub(crate) fn is_short(&self) -> bool {
        self.left < self.window / 4
    }

    /// Work of all windows so far.
    pub(crate) fn spent(&self) -> u64 {
        self.spent
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_is_begun_while_there_is_enough_for_it() {
        let mut credit = Credit::new(3, false, 0);
        assert_eq!(credit.window(500, false), Some(WINDOW));
        credit.pay(STORE - 10_000);
        assert_eq!(credit.window(101, false), None, "99 steps");
        assert_eq!(credit.window(101, true), Some(WINDOW), "it must be planned");
        assert_eq!(credit.window(100, false), Some(10_000));
        assert_eq!(credit.window(10, false), Some(5000), "half of what is left");
        credit.earn(0.01);
        assert_eq!(credit.window(120, false), Some(12_000));
        credit.earn(1e300);
        assert_eq!(credit.window(500, false), Some(WINDOW));
    }

    #[test]
    fn work_is_intervals_times_steps() {
        let mut budget = Budget {
            solves: 5,
            work: 1000,
        };
        budget.spend(20, 30);
        assert_eq!((budget.work, budget.steps(20)), (400, 20));
        budget.spend(20, 30);
        assert_eq!(budget.work, 0);
    }
}

//! Bounds the deviation of a filtered motion from its path, for any pulses, dwells and corners
//! inside the filters.
//!
//! Source: ours; equations 4.24 to 4.26 know one corner alone and break their own tolerance where
//! corners are dense. The filtered position is a mean of commanded ones, so it lies near the point
//! of the path at the mean distance, off by at most each turn `|t2 - t1|` times the smaller of what
//! is missing before the corner and what is gained behind it. The sum is largest where the mean
//! distance is that of a corner, and there it bounds the corner error, too. A longer dwell anywhere
//! never increases it. Not here: what is done about it.

use crate::filter::cubic::CubicChain;
use crate::pulse::{NEARLY, Pulse};
use toolglide_kinematics::Vector;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Most steps in the search of the instant; Newton needs three or four.
const STEPS: u32 = 40;

/// Precision of that instant as a share of the delay, dimensionless: the bound changes by less.
const INSTANT_PRECISION: f64 = 1e-7;

/// Pulses that are together in the longest filter for less than this are not, s: the rounding of the times
/// of steps that follow each other at its length.
pub(crate) const TOUCH: f64 = 1e-13;

/// When each pulse begins and ends, and the bound at each corner.
#[derive(Clone, Debug, Default)]
pub(crate) struct Schedule {
    begin: Vec<f64>,
    end: Vec<f64>,
    /// When the run of each pulse begins: those that go on along the same arc.
    since: Vec<f64>,
    /// Whether any pulse waits for others to leave the longest filter.
    waits: bool,
    /// Progress of the pulses in the window of the last corner asked for.
    progress: Vec<f64>,
    /// Shares of that window that the pulses have.
    shares: Vec<f64>,
    /// What each corner of that window contributes, and the index of the first.
    contributions: Vec<f64>,
    first: usize,
    /// How fast the mean of that window goes on.
    rate: f64,
}

impl Schedule {
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        let room = || Vec::with_capacity(capacity);
        Self {
            begin: room(),
            end: room(),
            since: room(),
            waits: false,
            progress: room(),
            shares: room(),
            contributions: room(),
            first: 0,
            rate: 0.0,
        }
    }

    pub(crate) fn begin(&self, pulse: usize) -> f64 {
        self.begin[pulse]
    }

    pub(crate) fn end(&self, pulse: usize) -> f64 {
        self.end[pulse]
    }

    /// Whether any pulse waits; a wait is shorter where feedrates fall, otherwise dwells only grow.
    pub(crate) fn waits(&self) -> bool {
        self.waits
    }

    /// Whether a corner is in the middle of a run that fills the whole window of a chain.
    ///
    /// Were all feedrates the same, the window would reach as far to both sides. Where they are not, what
    /// is faster reaches further, and the mean of what is on one side is at most a quarter of the window.
    ///
    /// `ahead` is where the window of a corner before this one ended.
    pub(crate) fn is_steady(&self, corner: usize, chain: &CubicChain, ahead: &mut usize) -> bool {
        let half = (0.5 + 0.25 * (1.0 / NEARLY - 1.0)) * chain.total();
        let (since, end) = (self.since[corner], self.end[corner]);
        if end - since < half {
            return false;
        }
        while *ahead < self.end.len() && self.end[*ahead] - end < half {
            *ahead += 1;
        }
        self.since.get(*ahead).is_some_and(|&other| other <= since)
    }

    /// The corners that contributed to the bound asked for last, with their shares.
    pub(crate) fn contributions(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        (self.first..).zip(self.contributions.iter().copied())
    }

    /// What the turns inside an arc contributed to the bound asked for last.
    pub(crate) fn contribution_of<const N: usize>(&self, pulses: &[Pulse<N>], arc: u32) -> f64 {
        self.contributions()
            .filter(|&(corner, _)| pulses[corner].smooth && pulses[corner].arc == Some(arc))
            .map(|(_, contribution)| contribution)
            .sum()
    }

    /// How fast the mean of the window of the bound asked for last goes on.
    pub(crate) fn rate(&self) -> f64 {
        self.rate
    }

    /// Whether all of the window of the bound asked for last lies on an arc.
    pub(crate) fn lies_on<const N: usize>(&self, pulses: &[Pulse<N>], arc: u32) -> bool {
        let mut window = pulses[self.first..].iter().zip(&self.shares);
        window.all(|(pulse, _)| pulse.arc == Some(arc))
    }

    /// How much the path turns where the window of the bound asked for last is, per length, 1/mm; turns
    /// count up to `most`.
    pub(crate) fn turning<const N: usize>(&self, pulses: &[Pulse<N>], most: f64) -> f64 {
        let mut turning = 0.0;
        let mut before = 0.0;
        let mut turn = 0.0;
        for (pulse, share) in pulses[self.first..].iter().zip(&self.shares) {
            let density = share / pulse.length;
            turning += turn * 0.5 * (before + density);
            (before, turn) = (density, pulse.turn.min(most));
        }
        turning
    }

    /// Times the pulses; those before `fixed` keep the gaps that were handed out.
    ///
    /// Two pulses whose velocities differ on an axis by more than `change` must not be in the longest
    /// filter together: the later one waits, where there is a dwell between them, or at once if it may
    /// wait `anywhere`.
    pub(crate) fn time<const N: usize>(
        &mut self,
        pulses: &[Pulse<N>],
        fixed: usize,
        chain: &CubicChain,
        change: &Vector<N>,
        anywhere: bool,
    ) {
        self.begin.clear();
        self.end.clear();
        self.since.clear();
        self.waits = false;
        let mut clock = 0.0;
        let (mut since, mut in_step_since) = (0.0, 0.0);
        let mut could_clash = false;
        let total = chain.total();
        for (index, pulse) in pulses.iter().enumerate() {
            if let Some(before) = index.checked_sub(1).map(|before| &pulses[before]) {
                let gap = if index < fixed {
                    pulse.gap
                } else {
                    total - before.overlap
                };
                clock += gap;
                if gap > 0.0 || !before.goes_on(pulse) {
                    since = clock;
                }
                if gap > 0.0 || !before.turns_on(pulse) {
                    in_step_since = clock;
                }
            }
            let velocity = pulse.direction * pulse.feed;
            could_clash =
                could_clash || (0..N).any(|axis| velocity[axis].abs() > 0.5 * change[axis]);
            // Turns of one arc are in step with each other.
            let steady = in_step_since + chain.long() <= clock;
            if could_clash && index >= fixed && !steady {
                // Where it may wait: the latest dwell.
                let mut waits = anywhere.then_some(index);
                for earlier in (0..index).rev() {
                    let free = self.end[earlier] + chain.long();
                    if free <= clock + TOUCH {
                        break;
                    }
                    let other = &pulses[earlier];
                    if waits.is_none() && earlier + 1 >= fixed {
                        let dwells = !other.pass || other.overlap < total;
                        waits = dwells.then_some(earlier + 1);
                    }
                    let gap = velocity - other.direction * other.feed;
                    if let Some(waits) = waits
                        && (0..N).any(|axis| gap[axis].abs() > change[axis])
                    {
                        let late = free - clock;
                        for delayed in waits..index {
                            self.begin[delayed] += late;
                            self.end[delayed] += late;
                            self.since[delayed] = self.begin[delayed];
                        }
                        clock = free;
                        (since, in_step_since) = (clock, clock);
                        self.waits = true;
                        break;
                    }
                }
            }
            self.begin.push(clock);
            self.since.push(since);
            clock += pulse.length / pulse.feed;
            self.end.push(clock);
        }
    }

    /// Bound of the distance from the path, at the instant at which the mean distance is that of the
    /// corner at the end of pulse `corner`.
    pub(crate) fn at_corner<const N: usize>(
        &mut self,
        pulses: &[Pulse<N>],
        chain: &CubicChain,
        corner: usize,
    ) -> f64 {
        let (mut low, mut high) = (self.end[corner], self.begin[corner + 1] + chain.total());
        let mut time = 0.5 * (low + high);
        for _ in 0..STEPS {
            let (excess, rate) = self.look(pulses, chain, corner, time);
            if excess > 0.0 {
                high = time;
            } else {
                low = time;
            }
            let mut next = time - excess / rate;
            if !(next >= low && next <= high) {
                next = 0.5 * (low + high);
            }
            let step = (next - time).abs();
            time = next;
            if step <= INSTANT_PRECISION * chain.total() {
                break;
            }
        }
        self.sum(pulses)
    }

    /// Progress of the pulses in the window at a time: by how much its mean is beyond the corner, and
    /// how fast it grows.
    fn look<const N: usize>(
        &mut self,
        pulses: &[Pulse<N>],
        chain: &CubicChain,
        corner: usize,
        time: f64,
    ) -> (f64, f64) {
        let mut first = corner;
        while first > 0 && time - self.end[first - 1] < chain.total() {
            first -= 1;
        }
        self.first = first;
        self.progress.clear();
        self.shares.clear();
        let (mut excess, mut rate) = (0.0, 0.0);
        let mut commanded = f64::NEG_INFINITY;
        let mut since = (0.0, 0.0);
        for (index, pulse) in pulses.iter().enumerate().skip(first) {
            let begin = self.begin[index];
            if time <= begin {
                break;
            }
            if begin > commanded {
                since = chain.response(time - begin);
            }
            commanded = self.end[index];
            let after = chain.response(time - commanded);
            let progress = pulse.feed * (since.0 - after.0);
            self.progress.push(progress);
            excess += progress;
            if index <= corner {
                excess -= pulse.length;
            }
            let share = since.1 - after.1;
            self.shares.push(share);
            rate += pulse.feed * share;
            since = after;
        }
        self.rate = rate;
        (excess, rate)
    }

    /// The bound at the instant looked at last.
    fn sum<const N: usize>(&mut self, pulses: &[Pulse<N>]) -> f64 {
        let mut gained: f64 = self.progress.iter().sum();
        let mut missing = 0.0;
        let mut bound = 0.0;
        self.contributions.clear();
        for (pulse, progress) in pulses[self.first..].iter().zip(&self.progress) {
            gained -= progress;
            missing += pulse.length - progress;
            let contribution = pulse.turn * gained.min(missing).max(0.0);
            self.contributions.push(contribution);
            bound += contribution;
        }
        bound
    }
}

//! Plans motion along a straight line that leaves the modes of vibration at rest, in closed form.
//!
//! Source: impulse shaping (zero vibration and derivative) of the seven phases of section 3.3.1. The shaped motion is
//! a mean of the same motion begun at several times, so that it keeps every limit that the motion keeps, and it stays
//! on the line. It takes one period of every mode longer; no iteration has to converge. Not here: when that is.

use toolglide_kinematics::{AxisMode, Vector};
use toolglide_profiles::SCurve;

/// Most impulses of a shaper: of more modes than that allows, those beyond keep their swing.
const MAX_IMPULSES: usize = 243;

/// An axis that takes part in a line with less than this share of its speed does not swing by it.
const MIN_PART: f64 = 1e-9;

/// Breaks nearer than this are one, s.
const SAME_TIME: f64 = 1e-12;

/// A weighted mean of delays.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shaper {
    impulses: Vec<(f64, f64)>,
    scratch: Vec<(f64, f64)>,
    breaks: Vec<f64>,
    jerks: Vec<f64>,
}

impl Shaper {
    /// With room for any.
    pub(crate) fn with_room() -> Self {
        Self {
            impulses: Vec::with_capacity(MAX_IMPULSES),
            scratch: Vec::with_capacity(MAX_IMPULSES),
            breaks: Vec::with_capacity(8 * MAX_IMPULSES),
            jerks: Vec::with_capacity(8 * MAX_IMPULSES),
        }
    }

    /// Shapes for the modes of the axes that a direction moves; nothing to shape leaves one impulse.
    pub(crate) fn fit<const N: usize>(&mut self, modes: &[AxisMode], direction: &Vector<N>) {
        self.impulses.clear();
        self.impulses.push((0.0, 1.0));
        for (index, mode) in modes.iter().enumerate() {
            let moved = direction[mode.axis].abs() > MIN_PART;
            let known = modes[..index]
                .iter()
                .any(|before| before.mode == mode.mode && direction[before.axis].abs() > MIN_PART);
            if !moved || known || self.impulses.len() * 3 > MAX_IMPULSES {
                continue;
            }
            let pole = mode.mode.pole();
            let half = std::f64::consts::PI / pole.im;
            let decay = (pole.re * half).exp();
            let whole = (1.0 + decay) * (1.0 + decay);
            self.scratch.clear();
            for (delay, weight) in &self.impulses {
                let weight = weight / whole;
                self.scratch.push((*delay, weight));
                self.scratch.push((delay + half, 2.0 * decay * weight));
                self.scratch
                    .push((delay + 2.0 * half, decay * decay * weight));
            }
            std::mem::swap(&mut self.impulses, &mut self.scratch);
        }
    }

    /// The longest and the mean delay, s.
    pub(crate) fn delays(&self) -> (f64, f64) {
        let longest = self
            .impulses
            .iter()
            .fold(0.0_f64, |most, one| most.max(one.0));
        (longest, self.impulses.iter().map(|(d, w)| d * w).sum())
    }

    /// Durations and jerks of the shaped motion.
    pub(crate) fn shape(&mut self, feed: &SCurve) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.breaks.clear();
        for (delay, _) in &self.impulses {
            let mut at = *delay;
            self.breaks.push(at);
            for phase in feed.phases() {
                at += phase.duration;
                self.breaks.push(at);
            }
        }
        self.breaks.sort_unstable_by(f64::total_cmp);
        self.breaks
            .dedup_by(|next, before| *next - *before <= SAME_TIME);
        self.jerks.clear();
        for pair in self.breaks.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let jerk = self
                .impulses
                .iter()
                .map(|(delay, weight)| weight * jerk_at(feed, middle - delay))
                .sum();
            self.jerks.push(jerk);
        }
        let spans = self.breaks.windows(2).map(|pair| pair[1] - pair[0]);
        spans.zip(self.jerks.iter().copied())
    }
}

fn jerk_at(feed: &SCurve, time: f64) -> f64 {
    if time < 0.0 {
        return 0.0;
    }
    let mut until = 0.0;
    for phase in feed.phases() {
        until += phase.duration;
        if time < until {
            return phase.jerk;
        }
    }
    0.0
}

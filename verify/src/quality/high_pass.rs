//! Filters what lies above a frequency out of samples, and adds up its energy.
//!
//! Source: the high-pass of Butterworth, of eighth order so that hardly anything below the frequency counts, as
//! four sections of second order by the bilinear transform; run forward. Not here: what is sampled.

use std::f64::consts::PI;

/// Sections of second order.
const SECTIONS: usize = 4;

/// Order of the filter: two for each.
const ORDER: f64 = 8.0;

/// Largest frequency as a share of that of the samples: above it nothing can be told.
const NYQUIST: f64 = 0.49;

/// One section: its coefficients and its two numbers of memory (transposed direct form).
#[derive(Clone, Copy, Debug, Default)]
struct Section {
    ahead: [f64; 3],
    back: [f64; 2],
    memory: [f64; 2],
}

/// A filter and the energy that it has let pass.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HighPass {
    sections: [Section; SECTIONS],
    energy: f64,
}

impl HighPass {
    /// A filter for a frequency (Hz) and samples so far apart (s).
    pub(super) fn new(frequency: f64, period: f64) -> Self {
        let share = (frequency * period).min(NYQUIST);
        let warped = (PI * share).tan();
        let mut sections = [Section::default(); SECTIONS];
        for (index, section) in (0_u32..).zip(&mut sections) {
            // Poles of the prototype lie on a circle.
            let angle = PI * f64::from(2 * index + 1) / (2.0 * ORDER);
            let damping = 2.0 * angle.sin() * warped;
            let scale = 1.0 / (1.0 + damping + warped * warped);
            section.ahead = [scale, -2.0 * scale, scale];
            section.back = [
                2.0 * (warped * warped - 1.0) * scale,
                (1.0 - damping + warped * warped) * scale,
            ];
        }
        Self {
            sections,
            energy: 0.0,
        }
    }

    /// Takes the next sample.
    pub(super) fn take(&mut self, sample: f64) {
        let mut value = sample;
        for section in &mut self.sections {
            let out = section.ahead[0] * value + section.memory[0];
            section.memory[0] =
                section.ahead[1] * value - section.back[0] * out + section.memory[1];
            section.memory[1] = section.ahead[2] * value - section.back[1] * out;
            value = out;
        }
        self.energy += value * value;
    }

    /// Sum of the squares of what has passed.
    pub(super) fn energy(&self) -> f64 {
        self.energy
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share of the energy of a wave that passes.
    fn passes(frequency: f64) -> f64 {
        let mut filter = HighPass::new(50.0, 1e-3);
        let mut whole = 0.0;
        for index in 0..20_000_u32 {
            let sample = (2.0 * PI * frequency * f64::from(index) * 1e-3).sin();
            whole += sample * sample;
            filter.take(sample);
        }
        filter.energy() / whole
    }

    #[test]
    fn what_is_above_passes_and_what_is_below_does_not() {
        assert!((passes(50.0) - 0.5).abs() < 0.01, "{}", passes(50.0));
        assert!(passes(100.0) > 0.99, "{}", passes(100.0));
        assert!(passes(70.0) > 0.98, "{}", passes(70.0));
        assert!(passes(35.0) < 0.01, "{}", passes(35.0));
        assert!(passes(20.0) < 1e-5, "{}", passes(20.0));
    }
}

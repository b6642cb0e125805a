//! Stores curves of any length in fixed memory: least and greatest value per interval of time.
//!
//! When the time runs out of stretches, neighbours are joined and the width doubles, so that a
//! peak is never lost however long the motion is.

/// Most stretches that are kept: about two for every pixel of a chart.
const MAX_BINS: usize = 2048;

/// Width of a stretch at the beginning, s: the shortest motions have enough of them.
const FIRST_WIDTH: f64 = 1e-6;

/// Least and greatest value of several curves over time.
#[derive(Clone, Debug)]
pub(crate) struct Envelope {
    curves: usize,
    width: f64,
    filled: usize,
    bins: Vec<(f64, f64)>,
}

/// Nothing was seen.
const NOTHING: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

impl Envelope {
    /// An envelope of some curves over no time.
    pub(crate) fn new(curves: usize) -> Self {
        Self {
            curves,
            width: FIRST_WIDTH,
            filled: 0,
            bins: vec![NOTHING; curves * MAX_BINS],
        }
    }

    /// Makes room for the time up to `end`, and gives the stretches that `start..end` touches.
    pub(crate) fn stretches(&mut self, start: f64, end: f64) -> std::ops::RangeInclusive<usize> {
        while self.index(end) >= MAX_BINS {
            self.double();
        }
        let last = self.index(end);
        self.filled = self.filled.max(last + 1);
        self.index(start)..=last
    }

    /// Time at which a stretch begins.
    #[allow(clippy::cast_precision_loss, reason = "there are only some thousand")]
    pub(crate) fn begin(&self, stretch: usize) -> f64 {
        stretch as f64 * self.width
    }

    /// Width of a stretch, s.
    pub(crate) fn width(&self) -> f64 {
        self.width
    }

    /// Adds a value of a curve in a stretch.
    #[inline]
    pub(crate) fn add(&mut self, stretch: usize, curve: usize, value: f64) {
        let bin = &mut self.bins[stretch * self.curves + curve];
        bin.0 = bin.0.min(value);
        bin.1 = bin.1.max(value);
    }

    /// Least and greatest value of a curve in each stretch, where there are any.
    pub(crate) fn curve(&self, curve: usize) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        (0..self.filled).filter_map(move |stretch| {
            let (low, high) = self.bins[stretch * self.curves + curve];
            (low <= high).then_some((stretch, low, high))
        })
    }

    /// Least value of a curve; 0 of one that was never seen.
    pub(crate) fn least(&self, curve: usize) -> f64 {
        self.curve(curve)
            .map(|(_, low, _)| low)
            .reduce(f64::min)
            .unwrap_or(0.0)
    }

    /// Largest magnitude of a curve.
    pub(crate) fn peak(&self, curve: usize) -> f64 {
        self.curve(curve).fold(0.0, |peak: f64, (_, low, high)| {
            peak.max(high.abs()).max(low.abs())
        })
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "times are not negative, and what is too large is compared with MAX_BINS"
    )]
    fn index(&self, time: f64) -> usize {
        (time / self.width) as usize
    }

    fn double(&mut self) {
        let curves = self.curves;
        for stretch in 0..MAX_BINS / 2 {
            for curve in 0..curves {
                let one = self.bins[2 * stretch * curves + curve];
                let two = self.bins[(2 * stretch + 1) * curves + curve];
                self.bins[stretch * curves + curve] = (one.0.min(two.0), one.1.max(two.1));
            }
        }
        self.bins[MAX_BINS / 2 * curves..].fill(NOTHING);
        self.filled = self.filled.div_ceil(2);
        self.width *= 2.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_outlives_any_number_of_doublings() {
        let mut envelope = Envelope::new(2);
        for step in 0..100_000 {
            let time = f64::from(step) * 0.01;
            for stretch in envelope.stretches(time, time + 0.01) {
                envelope.add(stretch, 0, if step == 777 { 9.0 } else { 1.0 });
                envelope.add(stretch, 1, -2.0);
            }
        }
        assert!((envelope.peak(0) - 9.0).abs() < 1e-15, "peak");
        assert!((envelope.peak(1) - 2.0).abs() < 1e-15, "magnitude");
        let count = envelope.curve(0).count();
        assert!((MAX_BINS / 2..=MAX_BINS).contains(&count), "{count}");
        let (at, _, _) = envelope.curve(0).find(|bin| bin.2 > 8.0).unwrap();
        assert!(
            (envelope.begin(at) - 7.77).abs() <= envelope.width(),
            "its time"
        );
    }
}

//! Measures how much speed varies where the programmed feedrate does not.
//!
//! Source: ours, after the feed fluctuation of spline interpolation. Over a stretch of one feedrate at nine tenths of
//! it and more, the ripple is the largest speed less the least, as a share of the feedrate. Not here: the speed.

/// Share of the feedrate above which a motion follows it.
const FOLLOWS: f64 = 0.9;

/// Ripple of all stretches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeedRipple {
    /// Stretches at a feedrate.
    pub stretches: u64,
    /// Root of the mean square over them, as a share of the feedrate.
    pub rms: f64,
    /// The largest.
    pub worst: f64,
}

/// A stretch under way and those before.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ripple {
    under_way: Option<[f64; 3]>,
    squares: f64,
    found: FeedRipple,
}

impl Ripple {
    /// Takes a speed where a feedrate is programmed, mm/s.
    #[allow(clippy::float_cmp, reason = "one programmed number")]
    pub(super) fn see(&mut self, speed: f64, feedrate: f64) {
        if self
            .under_way
            .is_some_and(|[before, ..]| before != feedrate)
            || speed < FOLLOWS * feedrate
        {
            self.interrupt();
        }
        if speed >= FOLLOWS * feedrate {
            let [_, least, most] = self.under_way.unwrap_or([feedrate, speed, speed]);
            self.under_way = Some([feedrate, least.min(speed), most.max(speed)]);
        }
    }

    /// Ends the stretch under way.
    pub(super) fn interrupt(&mut self) {
        if let Some([feedrate, least, most]) = self.under_way.take() {
            let ripple = (most - least) / feedrate;
            self.squares += ripple * ripple;
            self.found.stretches += 1;
            self.found.worst = self.found.worst.max(ripple);
        }
    }

    #[allow(clippy::cast_precision_loss, reason = "fewer stretches than 2^53")]
    pub(super) fn finish(&mut self) -> FeedRipple {
        self.interrupt();
        let count = self.found.stretches.max(1) as f64;
        self.found.rms = (self.squares / count).sqrt();
        self.found
    }
}

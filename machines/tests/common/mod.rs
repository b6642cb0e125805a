//! Random numbers that are the same on every computer.

/// A source of random numbers.
pub(crate) struct Chance(u64);

impl Chance {
    /// The source that starts from this seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number from 0 to 1.
    pub(crate) fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let [high, low] = [bits >> 32, bits & 0xffff_ffff].map(|half| half as u32);
        (f64::from(high) + f64::from(low) / 4_294_967_296.0) / 4_294_967_296.0
    }

    /// A number from `low` to `high`.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }
}

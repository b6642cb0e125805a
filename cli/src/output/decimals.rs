//! Formats numbers with a fixed number of decimals.
//!
//! Whoever writes three decimals leaves half of the third open; whoever writes all digits of an
//! `f64` leaves nothing open.

/// Digits from which a number is as exact as an `f64` can be.
const FULL_DIGITS: u32 = 15;

/// The finest of the numbers seen so far.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Decimals {
    most: u32,
    full: bool,
}

impl Decimals {
    /// Takes a number as it is written.
    pub(crate) fn take(&mut self, cell: &str) {
        let (digits, exponent) = match cell.split_once(['e', 'E']) {
            Some((digits, exponent)) => (digits, exponent.parse::<i64>().unwrap_or(0)),
            None => (cell, 0),
        };
        let mut significant = 0_u32;
        let mut after_point = 0_i64;
        let mut point = false;
        for digit in digits.bytes() {
            match digit {
                b'.' => point = true,
                b'0'..=b'9' => {
                    after_point += i64::from(point);
                    if digit != b'0' || significant > 0 {
                        significant += 1;
                    }
                }
                _ => {}
            }
        }
        let decimals = u32::try_from((after_point - exponent).max(0)).unwrap_or(u32::MAX);
        self.most = self.most.max(decimals);
        self.full |= significant >= FULL_DIGITS;
    }

    /// The step in which the numbers are written; 0 when they are as exact as an `f64` can be.
    pub(crate) fn resolution(self) -> f64 {
        if self.full {
            0.0
        } else {
            10.0_f64.powi(-i32::try_from(self.most).unwrap_or(i32::MAX))
        }
    }
}

//! Represents a code such as `G1` or `G91.1`.
//!
//! Not here: what it means.

use std::fmt;

/// A number as near as this to a code is that code: the rounding of one multiplication by ten.
const CODE_ROUNDING: f64 = 1e-9;

/// Largest number of a `G` or `M` code.
const LARGEST_CODE: f64 = 999.0;

/// A code such as `G1` or `G91.1`, or the letter of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Code {
    letter: u8,
    tenths: Option<u16>,
}

impl Code {
    /// A letter alone.
    pub(crate) fn letter(letter: u8) -> Self {
        Self {
            letter,
            tenths: None,
        }
    }

    /// A letter and ten times its number.
    pub(crate) const fn new(letter: u8, tenths: u16) -> Self {
        Self {
            letter,
            tenths: Some(tenths),
        }
    }

    /// The code of a number, if it is a multiple of `step` tenths.
    pub(crate) fn of_number(letter: u8, value: f64, step: u16) -> Option<Self> {
        let tenths = (value * 10.0).round();
        if !(0.0..=LARGEST_CODE).contains(&value) || (value * 10.0 - tenths).abs() > CODE_ROUNDING {
            return None;
        }
        // A whole number up to 9990, as checked above.
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked above"
        )]
        let tenths = tenths as u16;
        tenths
            .is_multiple_of(step)
            .then_some(Self::new(letter, tenths))
    }

    pub(crate) fn initial(self) -> u8 {
        self.letter
    }

    pub(crate) fn tenths(self) -> Option<u16> {
        self.tenths
    }
}

impl fmt::Display for Code {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", char::from(self.letter))?;
        match self.tenths {
            None => Ok(()),
            Some(tenths) if tenths % 10 == 0 => write!(out, "{}", tenths / 10),
            Some(tenths) => write!(out, "{}.{}", tenths / 10, tenths % 10),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_multiples_of_a_tenth() {
        let code = |value| Code::of_number(b'G', value, 1).map(|code| code.to_string());
        assert_eq!(code(91.1).as_deref(), Some("G91.1"), "tenths");
        assert_eq!(code(1.0).as_deref(), Some("G1"), "whole");
        assert_eq!(code(59.3).as_deref(), Some("G59.3"), "59.3");
        for wrong in [1.25, -1.0, 1e6, 999.5, -0.1] {
            assert_eq!(code(wrong), None, "{wrong}");
        }
        assert_eq!(Code::of_number(b'M', 3.5, 10), None, "M codes are whole");
    }
}

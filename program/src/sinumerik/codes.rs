//! Translates codes of Sinumerik into those of RS274/NGC.
//!
//! Not here: what they do.

use crate::error::Fault;
use crate::sinumerik::{Line, unknown};
use crate::text::place::Span;
use toolglide_kinematics::Vector;

impl Line<'_> {
    /// A `G` code, by the number that RS274/NGC has for it.
    pub(crate) fn code(&mut self, value: f64, span: Span) -> Result<(), Fault> {
        let number = value.round();
        let is = |list: &[f64]| list.iter().any(|&one| (one - number).abs() < 0.5);
        let same = [
            0.0, 1.0, 2.0, 3.0, 17.0, 18.0, 19.0, 40.0, 41.0, 42.0, 53.0, 54.0, 55.0, 56.0, 57.0,
            64.0, 90.0, 91.0, 93.0, 94.0, 97.0,
        ];
        if (value - number).abs() > 1e-9 {
            return Err(unknown(&format!("G{value}"), span));
        }
        // Fine ways of stopping, circles around corners, and the language of this page.
        if is(&[290.0, 450.0, 601.0, 602.0, 603.0]) {
            return Ok(());
        }
        if is(&[500.0]) {
            self.state.offsets.set_origin(Vector::zeros(), 0.0);
            self.state.program = self.state.offsets.in_program(self.state.position);
            return Ok(());
        }
        let mapped = if is(&same) {
            number
        } else if is(&[4.0]) {
            self.dwell = true;
            4.0
        } else if is(&[60.0, 9.0]) {
            61.0
        } else if is(&[641.0, 642.0, 643.0, 644.0, 645.0]) {
            64.0
        } else if is(&[70.0, 700.0]) {
            20.0
        } else if is(&[71.0, 710.0]) {
            21.0
        } else if is(&[153.0]) {
            53.0
        } else {
            return Err(unknown(&format!("G{number}"), span));
        };
        self.add(b'G', mapped, span)
    }
}

/// Codes of RS274/NGC alone.
pub(crate) fn is_foreign(value: f64) -> bool {
    [
        60.0, 62.0, 63.0, 64.0, 65.0, 66.0, 67.0, 68.0, 70.0, 71.0, 72.0, 73.0, 98.0, 99.0, 128.0,
        129.0, 428.0, 429.0,
    ]
    .iter()
    .any(|one| (one - value).abs() < 0.5)
}

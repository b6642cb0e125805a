//! Packs columns of numbers into one compressed block of bytes that a browser can read.
//!
//! Floats are stored byte plane by byte plane: neighbours have like signs and exponents, which compress well.
//! Whole numbers are stored as differences in a variable number of bytes. Not here: what the numbers mean.

use base64::write::EncoderStringWriter;
use flate2::{Compression, write::GzEncoder};
use serde::Serialize;
use std::io::{self, Write};

/// How the numbers of a column are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    /// Four planes of bytes of floats.
    F32,
    /// Differences, zigzag, seven bits a byte.
    Delta,
}

/// Where a column stands in the block.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Column {
    name: String,
    kind: Kind,
    count: usize,
    bytes: usize,
    /// Value of one step of a whole number; 1 where it is a count.
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<f64>,
}

/// Columns on their way into a block.
pub(crate) struct Packer {
    columns: Vec<Column>,
    block: GzEncoder<EncoderStringWriter<'static, base64::engine::GeneralPurpose, String>>,
}

/// Largest whole number of steps that a browser holds exactly.
const MAX_STEPS: f64 = 9.0e15;

impl Packer {
    /// No columns.
    pub(crate) fn new() -> Self {
        let text = EncoderStringWriter::new(&base64::engine::general_purpose::STANDARD);
        Self {
            columns: Vec::new(),
            block: GzEncoder::new(text, Compression::default()),
        }
    }

    /// Adds floats that keep so many bits of their mantissa, 23 at the most.
    pub(crate) fn f32(
        &mut self,
        name: &str,
        bits: u32,
        values: impl ExactSizeIterator<Item = f64>,
    ) -> io::Result<()> {
        let raw: Vec<_> = values
            .map(|value| rounded(value, bits).to_le_bytes())
            .collect();
        self.planes(name, Kind::F32, &raw)
    }

    /// Adds values that are rounded to whole multiples of `step`.
    pub(crate) fn steps(
        &mut self,
        name: &str,
        step: f64,
        values: impl ExactSizeIterator<Item = f64>,
    ) -> io::Result<()> {
        #[allow(
            clippy::cast_possible_truncation,
            reason = "the value is clamped to what a double holds exactly"
        )]
        let whole = values.map(|value| (value / step).round().clamp(-MAX_STEPS, MAX_STEPS) as i64);
        self.delta(name, Some(step), whole)
    }

    /// Adds counts.
    pub(crate) fn counts(
        &mut self,
        name: &str,
        values: impl ExactSizeIterator<Item = u32>,
    ) -> io::Result<()> {
        self.delta(name, None, values.map(i64::from))
    }

    fn delta(
        &mut self,
        name: &str,
        step: Option<f64>,
        values: impl ExactSizeIterator<Item = i64>,
    ) -> io::Result<()> {
        let count = values.len();
        let mut bytes = Vec::with_capacity(2 * count);
        let mut before = 0_i64;
        for value in values {
            let difference = value.wrapping_sub(before);
            before = value;
            let mut rest = ((difference << 1) ^ (difference >> 63)).cast_unsigned();
            while rest >= 0x80 {
                bytes.push(rest.to_le_bytes()[0] | 0x80);
                rest >>= 7;
            }
            bytes.push(rest.to_le_bytes()[0]);
        }
        self.add(name, Kind::Delta, count, step, &bytes)
    }

    fn planes<const W: usize>(
        &mut self,
        name: &str,
        kind: Kind,
        raw: &[[u8; W]],
    ) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(W * raw.len());
        for plane in 0..W {
            bytes.extend(raw.iter().map(|value| value[plane]));
        }
        self.add(name, kind, raw.len(), None, &bytes)
    }

    fn add(
        &mut self,
        name: &str,
        kind: Kind,
        count: usize,
        step: Option<f64>,
        bytes: &[u8],
    ) -> io::Result<()> {
        self.columns.push(Column {
            name: name.to_owned(),
            kind,
            count,
            bytes: bytes.len(),
            step,
        });
        self.block.write_all(bytes)
    }

    /// Adds text as it is.
    pub(crate) fn text(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.block.write_all(bytes)
    }

    /// The index of the columns, and the block in base 64.
    pub(crate) fn finish(self) -> io::Result<(Vec<Column>, String)> {
        Ok((self.columns, self.block.finish()?.into_inner()))
    }
}

/// A float with the last bits of its mantissa rounded away; finite values stay finite.
fn rounded(value: f64, bits: u32) -> f32 {
    #[allow(
        clippy::cast_possible_truncation,
        reason = "the page shows seven digits; what is larger than a float becomes the largest"
    )]
    let single = value.clamp(-f64::from(f32::MAX), f64::from(f32::MAX)) as f32;
    if single.is_nan() {
        return 0.0; // a page holds numbers only
    }
    let drop = 23_u32.saturating_sub(bits);
    if drop == 0 || !single.is_finite() {
        return single;
    }
    let raw = single.to_bits();
    let half = 1_u32 << (drop - 1);
    let kept = f32::from_bits(raw.saturating_add(half) >> drop << drop);
    if kept.is_finite() { kept } else { single }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base64::Engine;
    use std::io::Read;

    fn unpacked(packer: Packer) -> (Vec<Column>, Vec<u8>) {
        let (columns, text) = packer.finish().unwrap();
        let packed = base64::engine::general_purpose::STANDARD
            .decode(text)
            .unwrap();
        let mut bytes = Vec::new();
        flate2::read::GzDecoder::new(packed.as_slice())
            .read_to_end(&mut bytes)
            .unwrap();
        (columns, bytes)
    }

    #[test]
    fn whole_numbers_take_a_byte_a_step_of_63_and_two_beyond() {
        let mut packer = Packer::new();
        packer.counts("n", [0_u32, 63, 0, 200].into_iter()).unwrap();
        let (columns, bytes) = unpacked(packer);
        assert_eq!(columns[0].count, 4, "all of them");
        assert_eq!(bytes, [0, 126, 125, 0x90, 0x03], "differences, zigzag");
    }

    #[test]
    fn floats_stand_plane_by_plane() {
        let mut packer = Packer::new();
        packer.f32("v", 23, [1.0_f64, -2.0].into_iter()).unwrap();
        let (_, bytes) = unpacked(packer);
        let (one, two) = (1.0_f32.to_le_bytes(), (-2.0_f32).to_le_bytes());
        let expected: Vec<_> = (0..4).flat_map(|plane| [one[plane], two[plane]]).collect();
        assert_eq!(bytes, expected, "byte 0 of both, then byte 1 of both");
    }

    #[test]
    fn rounding_keeps_the_bits_that_are_asked_for() {
        for value in [1.0, -3.3e5, 6.02e-7, 1.999_999_9] {
            let kept = f64::from(rounded(value, 15));
            assert!(
                (kept / value - 1.0).abs() <= 1.0 / 65_536.0,
                "{value}: {kept}"
            );
        }
        assert!(
            rounded(f64::MAX, 15).is_finite(),
            "the largest stays finite"
        );
    }
}

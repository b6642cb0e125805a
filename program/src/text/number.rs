//! Parses decimal numbers as programs write them, to the nearest float.
//!
//! Source: RS274/NGC, section on real values. Not here: parameters and expressions, which may stand
//! where a number stands.

/// Whole numbers up to this are floats exactly.
const EXACT_MANTISSA: u64 = 1 << 53;

/// Powers of ten that are floats exactly; the quotient of two exact floats is rounded once, so a
/// short number is read without the general algorithm and to the same bit.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Digits that a mantissa of 64 bits holds whatever they are.
const SAFE_DIGITS: u32 = 19;

/// The number that begins at `start`, blanks inside it allowed, and where it ends; none when no
/// digit stands there, with where the search ended. Too large a number is infinite.
pub(crate) fn number(line: &[u8], start: usize) -> Result<(f64, usize), usize> {
    let mut at = start;
    let mut mantissa = 0_u64;
    let mut digits = 0_u32;
    let mut decimals = 0_usize;
    let mut point = false;
    let mut negative = false;
    let mut sign_allowed = true;
    let mut end = at;
    while let Some(&byte) = line.get(at) {
        match byte {
            b'0'..=b'9' => {
                if digits < SAFE_DIGITS {
                    mantissa = mantissa * 10 + u64::from(byte - b'0');
                }
                digits += 1;
                decimals += usize::from(point);
                sign_allowed = false;
            }
            b'.' if !point => {
                point = true;
                sign_allowed = false;
            }
            b'+' | b'-' if sign_allowed => {
                negative = byte == b'-';
                sign_allowed = false;
            }
            b' ' | b'\t' => {
                at += 1;
                continue;
            }
            _ => break,
        }
        at += 1;
        end = at;
    }
    if digits == 0 {
        return Err(at);
    }
    let magnitude = match EXACT_POWERS.get(decimals) {
        // Below 2^53 both conversions and the division are correctly rounded.
        Some(power) if digits <= SAFE_DIGITS && mantissa <= EXACT_MANTISSA => {
            mantissa as f64 / power
        }
        _ => long_number(&line[start..end]),
    };
    Ok((if negative { -magnitude } else { magnitude }, end))
}

/// A number with more digits than the short way takes.
fn long_number(text: &[u8]) -> f64 {
    let digits: String = text
        .iter()
        .filter(|byte| matches!(byte, b'0'..=b'9' | b'.'))
        .map(|&byte| char::from(byte))
        .collect();
    // Digits and one point are always a number, so that the other branch is never taken.
    digits.parse().unwrap_or(f64::INFINITY)
}

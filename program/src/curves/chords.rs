//! Divides arcs of pose programs into chords.
//!
//! Source: the sagitta of a chord, r (1 - cos(φ/2)). Not here: arcs of plain programs, which stay arcs.

/// Most chords of one arc.
const MAX_CHORDS: f64 = 100_000.0;

/// How many chords keep within `error` of an arc, both in mm; `sweep` in rad.
pub(crate) fn count(radius: f64, sweep: f64, error: f64) -> u32 {
    let cosine = (1.0 - error / radius).clamp(-1.0, 1.0);
    // A chord of more than a quarter turn follows nothing.
    let step = (2.0 * cosine.acos()).min(std::f64::consts::FRAC_PI_2);
    let wanted = (sweep.abs() / step).ceil().clamp(1.0, MAX_CHORDS);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole and between 1 and a hundred thousand"
    )]
    let count = wanted as u32;
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_keep_within_the_error_and_hardly_fewer_do() {
        let (radius, sweep, error) = (20.0, 4.0, 1e-3);
        let sagitta = |chords: u32| radius * (1.0 - (0.5 * sweep / f64::from(chords)).cos());
        let chords = count(radius, sweep, error);
        assert!(sagitta(chords) <= error, "{chords}");
        assert!(sagitta(chords - 1) > error, "{chords}");
    }
}

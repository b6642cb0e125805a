//! Represents motion of one coordinate by contiguous polynomials, the exact form of every profile.
//!
//! Source: section 2.2 for constant jerk; filtered pulses of chapter 4 are polynomials of a higher
//! degree. Not here: how a motion comes about.

use crate::error::ProfileError;
use crate::phase::Phase;
use crate::profile::{Profile, State};
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::numeric::CLOSURE;

/// A polynomial of time since the start of its piece, lowest power first.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// A polynomial from its coefficients, lowest power first.
    ///
    /// # Errors
    /// [`ProfileError::OutOfRange`] for a coefficient that is not finite.
    pub fn new(coefficients: Vec<f64>) -> Result<Self, ProfileError> {
        for &value in &coefficients {
            if !value.is_finite() {
                return Err(ProfileError::OutOfRange {
                    quantity: "coefficient",
                    value,
                    low: f64::MIN,
                    high: f64::MAX,
                });
            }
        }
        Ok(Self { coefficients })
    }

    /// Value and first three derivatives.
    #[must_use]
    pub fn state(&self, time: f64) -> State {
        // Horner's scheme for the value and the Taylor coefficients of the derivatives.
        let mut taylor = [0.0; 4];
        for &coefficient in self.coefficients.iter().rev() {
            taylor[3] = taylor[3] * time + taylor[2];
            taylor[2] = taylor[2] * time + taylor[1];
            taylor[1] = taylor[1] * time + taylor[0];
            taylor[0] = taylor[0] * time + coefficient;
        }
        State {
            position: taylor[0],
            velocity: taylor[1],
            acceleration: 2.0 * taylor[2],
            jerk: 6.0 * taylor[3],
        }
    }
}

/// Contiguous polynomial pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise {
    pieces: Vec<Polynomial>,
    knots: Vec<f64>,
}

impl Piecewise {
    /// Pieces with their durations, in order.
    ///
    /// # Errors
    /// [`ProfileError::NotPositive`] for a duration that is negative or not finite, and
    /// [`ProfileError::NotClosed`] where a piece does not start where the last one ended.
    pub fn new(pieces: impl IntoIterator<Item = (f64, Polynomial)>) -> Result<Self, ProfileError> {
        let mut result = Self {
            pieces: Vec::new(),
            knots: vec![0.0],
        };
        let mut end: Option<State> = None;
        let mut time = 0.0;
        for (duration, piece) in pieces {
            if !(duration >= 0.0 && duration.is_finite()) {
                return Err(ProfileError::NotPositive {
                    quantity: "duration",
                    value: duration,
                });
            }
            if let Some(end) = end {
                let miss = piece.state(0.0).position - end.position;
                if miss.abs() > CLOSURE * (1.0 + end.position.abs()) {
                    return Err(ProfileError::NotClosed {
                        quantity: "position",
                        miss,
                    });
                }
            }
            end = Some(piece.state(duration));
            time += duration;
            result.pieces.push(piece);
            result.knots.push(time);
        }
        Ok(result)
    }

    /// The exact form of phases of constant jerk.
    ///
    /// # Errors
    /// As [`Piecewise::new`].
    pub fn from_phases(start: State, phases: &[Phase]) -> Result<Self, ProfileError> {
        let mut state = start;
        let mut pieces = Vec::with_capacity(phases.len());
        for phase in phases {
            state.jerk = phase.jerk;
            pieces.push((
                phase.duration,
                Polynomial::new(vec![
                    state.position,
                    state.velocity,
                    0.5 * state.acceleration,
                    state.jerk / 6.0,
                ])?,
            ));
            state = state.after(phase.duration);
        }
        Self::new(pieces)
    }
}

impl Profile for Piecewise {
    fn duration(&self) -> f64 {
        self.knots.last().copied().unwrap_or(0.0)
    }

    fn at(&self, time: f64) -> State {
        let time = time.clamp(0.0, self.duration());
        let after = self.knots.partition_point(|&knot| knot <= time);
        let index = after
            .saturating_sub(1)
            .min(self.pieces.len().saturating_sub(1));
        self.pieces.get(index).map_or_else(State::default, |piece| {
            piece.state(time - self.knots[index])
        })
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jlap::Jlap;

    #[test]
    fn a_profile_and_its_polynomials_agree_at_every_time() {
        let start = State::moving(10.0, 300.0);
        let change = Jlap::between(start, 90.0, -100.0, 2500.0, 2e5).unwrap();
        let exact = Piecewise::from_phases(start, change.phases()).unwrap();
        for step in 0..=100 {
            let time = exact.duration() * f64::from(step) / 100.0;
            let (a, b) = (change.at(time), exact.at(time));
            assert!((a.position - b.position).abs() < 1e-12, "{time}");
            assert!((a.velocity - b.velocity).abs() < 1e-10, "{time}");
            assert!((a.acceleration - b.acceleration).abs() < 1e-8, "{time}");
        }
    }

    #[test]
    fn a_gap_between_pieces_is_refused() {
        let one = Polynomial::new(vec![0.0, 1.0]).unwrap();
        let two = Polynomial::new(vec![1.5, 1.0]).unwrap();
        assert!(
            Piecewise::new([(1.0, one), (1.0, two)]).is_err(),
            "gap of 0.5"
        );
    }

    #[test]
    fn higher_degrees_give_exact_derivatives() {
        let quintic = Polynomial::new(vec![0.0, 0.0, 0.0, 10.0, -15.0, 6.0]).unwrap();
        let end = quintic.state(1.0);
        assert!((end.position - 1.0).abs() < 1e-14, "{end:?}");
        assert!(
            end.velocity.abs() < 1e-13 && end.acceleration.abs() < 1e-13,
            "{end:?}"
        );
        assert!((end.jerk - 60.0).abs() < 1e-12, "{end:?}");
    }
}

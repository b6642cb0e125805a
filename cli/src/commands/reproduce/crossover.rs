//! Finds the turn above which an uninterrupted corner is faster than an interrupted one.
//!
//! Source: figure 2.9. Two moves of 10 mm, as in section 2.3.1, are planned by both methods; the
//! turn between them is searched by halving an interval.

use crate::commands::reproduce::run::Runs;
use crate::error::CliError;
use crate::methods::Tuning;

/// Acceleration and jerk of both axes, mm/s² and mm/s³.
const LIMITS: (f64, f64) = (2_500.0, 2e5);

/// Turns between which the crossover is searched, degrees: a smaller turn is interrupted at the
/// feedrate, a larger one is slower interrupted than stopped at.
const TURNS: (f64, f64) = (4.0, 150.0);

/// Precision of the turn, degrees: a tenth of what is shown.
const PRECISION: f64 = 0.01;

/// The turn in degrees, for corners within a tolerance in mm.
pub(super) fn crossover(tolerance: f64, runs: &mut Runs) -> Result<f64, CliError> {
    let (mut low, mut high) = TURNS;
    while high - low > PRECISION {
        let middle = 0.5 * (low + high);
        if gain(middle, tolerance, runs)? > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(0.5 * (low + high))
}

/// What uninterrupted acceleration gains at a turn, s; negative where it loses.
fn gain(turn: f64, tolerance: f64, runs: &mut Runs) -> Result<f64, CliError> {
    let (sine, cosine) = turn.to_radians().sin_cos();
    let (x, y) = (10.0 + 10.0 * cosine, 10.0 * sine);
    let text = format!("G64 P{tolerance}\nG1 X10 F6000\nG1 X{x:.9} Y{y:.9}\n");
    let name = format!("a turn of {turn:.2} degrees");
    let mut time = |method| {
        runs.plan((&text, &name), LIMITS, method, &Tuning::default(), None)
            .map(|outcome| outcome.cycle_time)
    };
    Ok(time("kcs-interrupted")? - time("kcs-uninterrupted")?)
}

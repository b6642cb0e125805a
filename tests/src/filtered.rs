//! Plans a course as filtered pulses behind several chains and judges each plan.
//!
//! Not here: the courses.

use crate::course::{Course, Numbers, limits};
use proptest::prelude::*;
use toolglide_fir::{FilterChain, Method, Settings, plan};
use toolglide_kinematics::{Plan, Trajectory, Vector};
use toolglide_verify::{verify, verify_set_points};

/// Time constants that are tried; none where the planner chooses.
const CHAINS: [&[f64]; 4] = [&[], &[0.05, 0.03], &[0.02, 0.02], &[0.06, 0.04, 0.015]];

/// Set-points that are judged of one motion.
const MAX_SET_POINTS: f64 = 4000.0;

/// Plans a course behind one of the chains, with stops and without, and has it judged.
///
/// # Errors
/// As [`keeps`].
///
/// # Panics
/// When the planner refuses a move.
pub fn keeps_behind_one<const N: usize>(
    course: &Course<N>,
    numbers: &Numbers<N>,
) -> Result<(), TestCaseError> {
    // Any bits of the case that are as good as random.
    let which = usize::from(numbers[0][1].to_bits().to_le_bytes()[2]) % CHAINS.len();
    keeps_behind(course, numbers, CHAINS[which])
}

/// Plans a course behind every chain, with stops and without, and has it judged.
///
/// # Errors
/// What the judge found, or that going on is slower than stopping.
///
/// # Panics
/// When the planner refuses a move.
pub fn keeps<const N: usize>(
    course: &Course<N>,
    numbers: &Numbers<N>,
) -> Result<(), TestCaseError> {
    CHAINS
        .iter()
        .try_for_each(|lengths| keeps_behind(course, numbers, lengths))
}

fn keeps_behind<const N: usize>(
    course: &Course<N>,
    numbers: &Numbers<N>,
    lengths: &[f64],
) -> Result<(), TestCaseError> {
    let path = course.toolpath();
    let limits = limits(numbers);
    let mut settings = Settings::new(limits);
    if !lengths.is_empty() {
        let chain = FilterChain::with_time_constants(lengths).unwrap();
        settings = settings.with_chain(&chain).unwrap();
    }
    let mut durations = Vec::new();
    for method in Method::ALL {
        let motion = plan(&path, &settings.clone().with_method(method)).unwrap();
        let report = verify(&motion, &path, &limits);
        prop_assert!(
            report.passes(),
            "{} behind {lengths:?}: {} violations, {:#?}",
            method.name(),
            report.violations,
            report.examples
        );
        for (what, ratio) in [
            ("deviation", report.deviation_ratio.value),
            ("corner error", report.corner_ratio.value),
        ] {
            prop_assert!(ratio <= 1.0, "{what} is {ratio} of the tolerance");
        }
        prop_assert!(
            (motion.end() - path.end()).norm() < 1e-9,
            "it ends {} mm from the end",
            (motion.end() - path.end()).norm()
        );
        let told = verify_set_points(set_points(&motion), &path, &limits, 0.0);
        let told = told.map_err(|reason| TestCaseError::fail(reason.to_string()))?;
        prop_assert!(
            told.violations == 0,
            "set-points of {} behind {lengths:?}: {:#?}",
            method.name(),
            told.examples
        );
        durations.push(motion.duration());
    }
    prop_assert!(
        lengths.is_empty() || durations[0] <= durations[1] * (1.0 + 1e-9) + 1e-9,
        "non-stop takes {} s, stopping {} s behind {lengths:?}",
        durations[0],
        durations[1]
    );
    Ok(())
}

/// Set-points of a motion every millisecond, or fewer of a long one.
fn set_points<const N: usize>(motion: &Plan<N>) -> Vec<(f64, Vector<N>)> {
    let period = (motion.duration() / MAX_SET_POINTS).max(0.001);
    let mut points: Vec<_> = (0..)
        .map(|tick| f64::from(tick) * period)
        .take_while(|&time| time < motion.duration() - 0.5 * period)
        .map(|time| (time, motion.sample(time).position))
        .collect();
    points.push((motion.duration(), motion.end()));
    points
}

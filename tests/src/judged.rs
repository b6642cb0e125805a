//! Plans a course by every method and judges each plan.
//!
//! Not here: the courses.

use crate::bounds::NEVER_SLOWER;
use crate::course::{Course, Numbers, limits};
use proptest::prelude::*;
use toolglide_kinematics::{Plan, Trajectory};
use toolglide_smoothing::{Method, Settings, plan};
use toolglide_verify::verify;

/// Windows tried: the shortest, the shortest that looks ahead, a short one, and the default.
const WINDOWS: [usize; 4] = [1, 2, 5, 512];

/// Plans a course with every method and window and has each judged; gives how many there were.
///
/// # Errors
/// What the judge found, or that smoothing is slower than stopping.
///
/// # Panics
/// When the planner refuses a move.
pub fn judge<const N: usize>(
    course: &Course<N>,
    numbers: &Numbers<N>,
) -> Result<u32, TestCaseError> {
    let path = course.toolpath();
    let limits = limits(numbers);
    let mut plans = 0;
    for window in WINDOWS {
        let settings = Settings::new(limits).with_window(window);
        let with = |method| -> Result<Plan<N>, TestCaseError> {
            let planned = plan(&path, &settings.with_method(method)).unwrap();
            let report = verify(&planned, &path, &limits);
            prop_assert!(
                report.passes(),
                "{} in a window of {window}: {} violations, {:#?}",
                method.name(),
                report.violations,
                report.examples
            );
            Ok(planned)
        };
        let stopping = with(Method::ExactStop)?.duration();
        for method in Method::ALL {
            plans += 1;
            let duration = with(method)?.duration();
            prop_assert!(
                method != Method::Kcs || duration <= stopping * (1.0 + NEVER_SLOWER),
                "in a window of {window} kcs takes {duration} s, stopping {stopping} s"
            );
        }
    }
    Ok(plans)
}

/// Plans a course with every method and window and has each judged.
///
/// # Panics
/// When the judge finds something, or smoothing is slower than stopping.
pub fn holds<const N: usize>(course: &Course<N>, numbers: &Numbers<N>) {
    if let Err(failure) = judge(course, numbers) {
        panic!("{failure}");
    }
}

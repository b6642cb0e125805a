//! Runs a property over random cases and prints a failure as Rust to paste into a test.
//!
//! Not here: any property.

use crate::course::{Course, Numbers};
use crate::strategies;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestError, TestRunner};

/// The seed of the random cases, so that every run tries the same; `PROPTEST_RNG_SEED` tries others.
const SEED: u64 = 7;

/// Tries a property on random courses, each with random limits: `cases` of them, and in proportion
/// more when the environment asks proptest for more than its 256.
///
/// # Panics
/// When the property does not hold.
pub fn try_all<const N: usize>(
    courses: impl Strategy<Value = Course<N>>,
    cases: u32,
    property: impl Fn(&Course<N>, &Numbers<N>) -> Result<(), TestCaseError>,
) {
    let asked = Config::default().cases;
    let mut config = Config {
        cases: cases.max(cases.saturating_mul(asked) / 256),
        failure_persistence: None,
        ..Config::default()
    };
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(SEED);
    }
    let tried = TestRunner::new(config).run(
        &(courses, strategies::limits::<N>()),
        |(course, numbers)| property(&course, &numbers),
    );
    match tried {
        Err(TestError::Fail(reason, (course, numbers))) => {
            panic!("{reason}\nlet course = {course:?};\nlet numbers = {numbers:?};")
        }
        Err(abort) => panic!("{abort}"),
        Ok(()) => {}
    }
}

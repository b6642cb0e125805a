//! Choosing among everything is hardly ever slower than any single method, nor with more tolerance, whatever the
//! feedrates of a program do.
//!
//! Not here: that it is no slower than stopping, see the random courses.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use toolglide_kinematics::Trajectory;
use toolglide_smoothing::{Method, Settings, plan};
use toolglide_tests::bounds::SLOWER;
use toolglide_tests::course::{Course, Numbers, limits};
use toolglide_tests::feeds::{AXES, programs};
use toolglide_verify::verify;

/// Programs that are tried, and in proportion more when the environment asks proptest for more than its 256.
const PROGRAMS: u32 = 500;

/// The seed of the random programs, so that every run tries the same; `PROPTEST_RNG_SEED` tries others.
const SEED: u64 = 7;

/// By what the tolerance is divided, in turn.
const TIGHTER: [f64; 4] = [1.2, 1.5, 2.0, 4.0];

/// What the durations of `kcs` are compared with: how often it may be slower by more than [`SLOWER`], a share of all
/// programs, and by how much at the most.
const COMPARED: [(&str, f64, f64); 5] = [
    ("kcs-interrupted", 0.0, SLOWER),
    ("kcs-uninterrupted", 0.0, SLOWER),
    ("kcs-global", 0.0, SLOWER),
    ("fir", 0.0, SLOWER),
    ("a smaller tolerance", 0.036, 0.2),
];

/// How long a program takes by `kcs`, which the judge must pass, and by what that is compared with.
fn durations(course: &Course<AXES>, numbers: &Numbers<AXES>, tighter: f64) -> (f64, [f64; 5]) {
    let limits = limits(numbers);
    let path = course.toolpath();
    let settings = Settings::new(limits);
    let motion = toolglide_fastest::plan(&path, &limits).unwrap();
    let report = verify(&motion, &path, &limits);
    assert!(
        report.passes(),
        "{:#?}\n{course:?}\n{numbers:?}",
        report.examples
    );
    let by = |method| {
        plan(&path, &settings.with_method(method))
            .unwrap()
            .duration()
    };
    let filtered = toolglide_fir::Settings::new(limits);
    let mut tight = course.clone();
    for leg in &mut tight.legs {
        leg.tolerance /= tighter;
    }
    let others = [
        by(Method::KcsInterrupted),
        by(Method::KcsUninterrupted),
        by(Method::KcsGlobal),
        toolglide_fir::plan(&path, &filtered).unwrap().duration(),
        toolglide_fastest::plan(&tight.toolpath(), &limits)
            .unwrap()
            .duration(),
    ];
    (motion.duration(), others)
}

#[test]
fn everything_together_is_hardly_slower_than_any_method_or_a_smaller_tolerance() {
    let asked = Config::default().cases;
    let cases = PROGRAMS.max(PROGRAMS.saturating_mul(asked) / 256);
    let mut config = Config::default();
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(SEED);
    }
    let mut runner = TestRunner::new(config);
    let strategy = programs();
    let mut slower = [0_u32; COMPARED.len()];
    for case in 0..cases {
        let (course, numbers) = strategy.new_tree(&mut runner).unwrap().current();
        let tighter = TIGHTER[case as usize % TIGHTER.len()];
        let (duration, others) = durations(&course, &numbers, tighter);
        for (index, other) in others.into_iter().enumerate() {
            let (name, _, most) = COMPARED[index];
            assert!(
                duration <= other * (1.0 + most),
                "program {case}: {duration} s, by {name} {other} s (divided by {tighter})\n{course:?}\n{numbers:?}"
            );
            slower[index] += u32::from(duration > other * (1.0 + SLOWER));
        }
    }
    for ((name, share, _), count) in COMPARED.into_iter().zip(slower) {
        assert!(
            f64::from(count) <= share * f64::from(cases),
            "{count} of {cases} programs are slower than by {name}"
        );
    }
}

/// A circle travelled several times in chords of a fifth of a millimetre, as a program has them: four digits.
fn circle() -> Vec<[f64; AXES]> {
    (1..=1500_u32)
        .map(|chord| {
            let angle = 0.02 * f64::from(chord);
            [10.0 * angle.cos() - 10.0, 10.0 * angle.sin(), 0.0].map(|at| (at * 1e4).round() / 1e4)
        })
        .collect()
}

/// The circle with a feedrate for each chord, of some length.
fn fed(feedrate: impl Fn(usize, f64) -> f64) -> Course<AXES> {
    let mut course = Course::of_lines([0.0; AXES], &circle(), 1.0, 0.02);
    let mut from = course.start;
    for (index, (leg, to)) in course.legs.iter_mut().zip(circle()).enumerate() {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        leg.feedrate = feedrate(index, length);
        from = to;
    }
    course
}

/// The duration of the circle by `kcs`, which the judge must pass, and with every chord at its feedrate.
fn around(feedrate: impl Fn(usize, f64) -> f64) -> (f64, f64) {
    let course = fed(&feedrate);
    let limits = limits(&[[500.0, 2_500.0, 2e5]; AXES]);
    let path = course.toolpath();
    let motion = plan(&path, &Settings::new(limits)).unwrap();
    let report = verify(&motion, &path, &limits);
    assert!(report.passes(), "{:#?}", report.examples);
    let mut from = course.start;
    let mut least = 0.0;
    for (leg, to) in course.legs.iter().zip(circle()) {
        least += (to[0] - from[0]).hypot(to[1] - from[1]) / leg.feedrate;
        from = to;
    }
    (motion.duration(), least)
}

#[test]
fn feedrates_that_differ_by_nothing_cost_nothing() {
    let feed = 2000.0 / 60.0;
    let two = |index: usize, _: f64| {
        if index.is_multiple_of(2) {
            feed
        } else {
            2001.0 / 60.0
        }
    };
    let jitter =
        |index: usize, _: f64| feed * (1.0 + 1e-4 * [0.3, -0.9, 0.7, 0.1, -0.4][index % 5]);
    let inverse = |_: usize, length: f64| {
        let rounded = (feed * 60.0 / length * 100.0).round() / 100.0;
        rounded * length / 60.0
    };
    let same = |_: usize, _: f64| feed;
    for (name, (takes, least)) in [
        ("one feedrate", around(same)),
        ("two in turn", around(two)),
        ("jitter", around(jitter)),
        ("inverse time", around(inverse)),
    ] {
        assert!(
            takes <= least * 1.002 + 0.1,
            "{name}: {takes} s, {least} s at the feedrate"
        );
    }
}

#[test]
fn a_feedrate_in_turn_with_a_higher_one_is_kept_by_fine_chords() {
    for more in [0.01, 0.1, 0.5] {
        let feed = 2000.0 / 60.0;
        let (takes, _) = around(|index, _| {
            if index.is_multiple_of(2) {
                feed
            } else {
                feed * (1.0 + more)
            }
        });
        let (slow, _) = around(|_, _| feed);
        assert!(
            takes <= slow * (1.0 + SLOWER),
            "{takes} s with every other feedrate {more} higher, {slow} s without"
        );
    }
}

//! Rounding of large coordinates is no violation: lines, arcs and helices up to a kilometre from zero, by every method.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{AxisLimits, Limits, Toolpath, Trajectory};
use toolglide_tests::course::{Course, Lead, arc, go};
use toolglide_verify::verify;

/// Lines, half circles of every size in a row, and a helix, from a point on.
fn course(far: f64) -> Course<3> {
    let start = [far, -0.7 * far, 0.3 * far];
    let mut at = start;
    let mut legs = Vec::new();
    for k in 0..40_u32 {
        let radius = 0.3 + f64::from(k * k % 17) * 0.6;
        let center = [at[0] + radius, at[1], at[2]];
        at[0] += 2.0 * radius;
        at[1] += if k % 3 == 0 { radius } else { 0.0 };
        if k % 3 == 0 {
            let corner = [at[0] - radius, at[1], at[2]];
            legs.push(go(Lead::Line(corner), 50.0, 0.01));
            legs.push(go(Lead::Line(at), 80.0, 0.01));
        } else {
            legs.push(go(arc(center, at, [0, 1], k % 2 == 0, 0), 50.0, 0.01));
        }
    }
    let mut center = at;
    center[1] += 4.0;
    at[2] -= 3.0;
    legs.push(go(arc(center, at, [0, 1], true, 2), 60.0, 0.005));
    Course { start, legs }
}

fn path(far: f64) -> Toolpath<3> {
    course(far).toolpath()
}

fn limits() -> Limits<3> {
    Limits::uniform(500.0, 2500.0, 200_000.0).unwrap()
}

#[test]
fn every_method_keeps_everything_a_kilometre_away() {
    for far in [0.0, 1e3, 32_000.0, 1e5, 1e6] {
        let path = path(far);
        assert!(path.moves().len() > 50, "{}", path.moves().len());
        let plans = toolglide_smoothing::Method::ALL.map(|method| {
            let settings = toolglide_smoothing::Settings::new(limits()).with_method(method);
            let plan = toolglide_smoothing::plan(&path, &settings).unwrap();
            (method.name(), plan)
        });
        let filtered = toolglide_fir::Method::ALL.map(|method| {
            let settings = toolglide_fir::Settings::new(limits()).with_method(method);
            (
                method.name(),
                toolglide_fir::plan(&path, &settings).unwrap(),
            )
        });
        let bezier = toolglide_baselines::plan_bezier(&path, &limits()).unwrap();
        let all = plans.into_iter().chain(filtered);
        for (name, plan) in all.chain([("bezier", bezier)]) {
            let report = verify(&plan, &path, &limits());
            assert!(report.passes(), "{name} at {far}: {:#?}", report.examples);
            assert_eq!(plan.end(), path.end(), "{name} at {far}");
        }
    }
}

#[test]
fn how_long_a_motion_takes_does_not_depend_on_where_it_is() {
    let settings = toolglide_smoothing::Settings::new(limits());
    let at = |far| {
        let plan = toolglide_smoothing::plan(&path(far), &settings).unwrap();
        plan.duration()
    };
    let near = at(0.0);
    for far in [1e3, 1e6] {
        assert!(
            (at(far) / near - 1.0).abs() < 2e-3,
            "{} at {far}, {near} at 0",
            at(far)
        );
    }
}

/// A kilometre from zero, three micrometres of a slow line do not tell its direction well enough for its velocity.
#[test]
fn a_slow_line_is_divided_near_its_start_without_a_jump() {
    let start = [
        -378_061.768_449_008_1,
        -27_437.684_468_479_58,
        17_852.278_690_121_74,
    ];
    let corner = [
        -378_061.270_108_494_97,
        -27_438.397_686_967_644,
        17_853.030_398_578_9,
    ];
    let end = [
        -378_061.037_374_567_53,
        -27_439.093_390_656_275,
        17_852.850_758_974_342,
    ];
    let course = Course {
        start,
        legs: vec![
            go(Lead::Line(corner), 1.740_397_622_994, 0.001),
            go(Lead::Line(end), 1e9, 0.003),
        ],
    };
    let axis =
        |velocity, acceleration, jerk| AxisLimits::new(velocity, acceleration, jerk).unwrap();
    let limits = Limits::new([
        axis(1_117.549_638, 14_278.365_65, 91_002.893_88),
        axis(890.777_208, 5_026.276_282, 566_099.296),
        axis(0.335_258_975_254_702_9, 247_255.476, 175_723_358.75),
    ]);
    let path = course.toolpath();
    for method in toolglide_smoothing::Method::ALL {
        let settings = toolglide_smoothing::Settings::new(limits).with_method(method);
        let motion = toolglide_smoothing::plan(&path, &settings).unwrap();
        let report = verify(&motion, &path, &limits);
        assert!(report.passes(), "{}: {:#?}", method.name(), report.examples);
    }
}

/// Where an axis is all but locked, a leg reaches its velocity within less than coordinates can tell.
#[test]
fn a_leg_along_a_locked_axis_is_not_divided_at_its_start() {
    let axis = |velocity| AxisLimits::new(velocity, 16_833.0, 278_603.0).unwrap();
    let limits = Limits::new([axis(1e-7), axis(145.9)]);
    let course = Course {
        start: [-337_364.418_484_999, -276_683.977_962_386_6],
        legs: vec![
            go(
                Lead::Line([-337_364.414_250_203_8, -276_683.976_720_326]),
                130.7,
                0.16,
            ),
            go(
                Lead::Line([-1_337_364.414_250_203_8, -276_666.744_516_457]),
                1e9,
                3e-4,
            ),
            go(
                Lead::Line([-1_337_374.097_545_090_4, -276_631.161_765_437]),
                0.26,
                0.47,
            ),
        ],
    };
    let path = course.toolpath();
    for method in toolglide_smoothing::Method::ALL {
        let settings = toolglide_smoothing::Settings::new(limits).with_method(method);
        let motion = toolglide_smoothing::plan(&path, &settings).unwrap();
        let report = verify(&motion, &path, &limits);
        assert!(report.passes(), "{}: {:#?}", method.name(), report.examples);
    }
}

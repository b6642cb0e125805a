//! Rounding of large coordinates is no violation: lines, arcs and helices up to a kilometre from zero, by every method.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{Limits, Toolpath, Trajectory};
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
        let bezier = toolglide_smoothing::plan_bezier(&path, &limits()).unwrap();
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

//! Searches against dense sampling.

use proptest::prelude::*;

use crate::path::bernstein::{Cubic, Largest, squared_speed};
use crate::path::closest_approach::{closest, enters};
use crate::path::deviation;
use crate::path::route::Route;
use toolglide_kinematics::{Arc, Feedrate, Move, Sample, Tolerance, Vector};

fn point() -> impl Strategy<Value = Vector<3>> {
    [-3.0..3.0_f64, -3.0..3.0, -3.0..3.0].prop_map(Vector::from)
}

fn curve() -> impl Strategy<Value = Cubic<3>> {
    [point(), point(), point(), point()].prop_map(|points| Cubic { points })
}

#[test]
fn the_deviation_of_one_curve_from_very_many_moves_is_found() {
    let mut route = Route::new(Vector::<2>::zeros());
    let tolerance = Tolerance::new(0.1).unwrap();
    for number in 1..=20_000_u32 {
        let along = f64::from(number) * 0.01;
        let end = Vector::<2>::new(along, 0.002 * (0.37 * f64::from(number)).sin());
        let step = Move::line_to(end, Feedrate::RAPID, tolerance).unwrap();
        route.expect(&step).unwrap();
    }
    let at = |share: f64| Vector::<2>::new(200.0 * share, 0.0);
    let points = [at(0.0), at(1.0 / 3.0), at(2.0 / 3.0), at(1.0)];
    let found = deviation::largest(&route, &Cubic { points }, 0, route.len() - 1, [0.0; 2]);
    assert!(
        found.bounds[0] > 0.0015 && found.bounds[0] < 0.0021,
        "{found:?}"
    );
}

const STEPS: u32 = 250;

fn shares() -> impl Iterator<Item = f64> {
    (0..=STEPS).map(|k| f64::from(k) / f64::from(STEPS))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn the_deviation_from_lines_and_an_arc_is_the_largest_sampled(
        curve in curve(),
        points in proptest::collection::vec((point(), 0.01..1.0_f64), 1..5),
        arc in proptest::option::of((0.3..3.0_f64, -6.0..6.0_f64, -2.0..2.0_f64, 0.0..0.002_f64)),
    ) {
        let mut route = Route::new(Vector::<3>::zeros());
        for (end, tolerance) in &points {
            let tolerance = Tolerance::new(*tolerance).unwrap();
            route.expect(&Move::line_to(*end, Feedrate::RAPID, tolerance).unwrap()).unwrap();
        }
        if let Some((radius, sweep, lift, growth)) = arc {
            let start = route.end();
            let center = start - Vector::<3>::new(radius, 0.0, 0.0);
            let end = center
                + Vector::<3>::new(sweep.cos(), sweep.sin(), 0.0) * (radius + growth)
                + Vector::<3>::new(0.0, 0.0, lift);
            let arc = Arc::about(start, end, center, [0, 1], sweep > 0.0, 0).unwrap();
            route.expect(&Move::arc(arc, Feedrate::RAPID, Tolerance::new(0.1).unwrap())).unwrap();
        }
        let last = route.len() - 1;
        let found = deviation::largest(&route, &curve, 0, last, [0.0; 2]);
        let mut sampled = [0.0_f64; 2];
        for u in shares() {
            let at = curve.at(u);
            let mut nearest = [f64::INFINITY; 2];
            for leg in route.range(0, last) {
                nearest[0] = nearest[0].min(leg.distance(&at));
                nearest[1] = nearest[1].min(leg.distance(&at) / leg.allowed);
            }
            sampled = [sampled[0].max(nearest[0]), sampled[1].max(nearest[1])];
        }
        let measures = found.bounds.into_iter().zip(found.attained).zip(sampled);
        // Neighbouring samples are at most 32/250 apart along the curve; tolerances are above 0.01.
        for (((bound, attained), sampled), apart) in measures.zip([0.13, 13.0]) {
            prop_assert!(bound >= sampled * (1.0 - 1e-12), "{bound} {sampled}");
            prop_assert!(bound <= attained.value * (1.0 + 2e-6) + 1e-6, "{found:?}");
            prop_assert!(bound <= sampled + apart, "{bound} {sampled}");
        }
    }

    #[test]
    fn the_distance_from_a_helix_is_the_smallest_sampled(
        at in point(), radius in 0.3..3.0_f64, sweep in -15.0..15.0_f64, lift in -4.0..4.0_f64,
    ) {
        let start = Vector::<3>::new(radius, 0.0, 0.0);
        let turns = (1..=2).filter(|k| sweep.abs() > f64::from(*k) * std::f64::consts::TAU).count();
        let turns = u32::try_from(turns).unwrap();
        let end = Vector::<3>::new(radius * sweep.cos(), radius * sweep.sin(), lift);
        let center = Vector::<3>::zeros();
        let arc =
            Arc::about(start, end, center, [0, 1], sweep > 0.0, turns).unwrap();
        let mut route = Route::new(start);
        route.expect(&Move::arc(arc, Feedrate::RAPID, Tolerance::new(0.1).unwrap())).unwrap();
        let found = route.get(0).unwrap().distance(&at);
        let sampled = shares().map(|u| (arc.point(u) - at).norm()).fold(f64::INFINITY, f64::min);
        prop_assert!(found <= sampled + 1e-12, "{found} {sampled}");
        let apart = arc.length() / f64::from(STEPS);
        prop_assert!(found >= sampled - apart, "{found} {sampled}");
    }

    #[test]
    fn the_closest_approach_is_the_smallest_sampled(curve in curve(), to in point()) {
        let found = closest(&curve, &to, f64::INFINITY, 0.0).unwrap();
        let sampled = shares().map(|u| (curve.at(u) - to).norm()).fold(f64::INFINITY, f64::min);
        prop_assert!(found.distance <= sampled * (1.0 + 2e-6) + 2e-9, "{found:?} {sampled}");
        prop_assert!(((curve.at(found.at) - to).norm() - found.distance).abs() < 1e-12, "{found:?}");
        prop_assert!(closest(&curve, &to, 0.5 * found.distance, 0.0).is_none(), "no closer");
    }

    #[test]
    fn motion_that_uses_its_whole_tolerance_passes_the_corner(
        curve in curve(), to in point(), from in 0.0..1.0_f64,
    ) {
        let near = closest(&curve, &to, f64::INFINITY, 0.0).unwrap();
        // The polished minimum is a little below the value that a search of its own would accept.
        let allowed = near.distance * (1.0 + 1e-9) + 1e-9;
        let from = from * near.at;
        let at = enters(&curve, &to, allowed, from);
        prop_assert!(at.is_some_and(|at| at >= from && (curve.at(at) - to).norm() <= allowed + 1e-4), "{at:?}");
        let sampled = shares().find(|u| *u >= from && (curve.at(*u) - to).norm() <= allowed);
        prop_assert!(at <= sampled.or(at), "{at:?} is not the first, {sampled:?} is before");
        prop_assert!(enters(&curve, &to, near.distance * (1.0 - 3e-6) - 3e-9, from).is_none(), "out of reach");
        let wider = 1.5 * near.distance;
        let first = enters(&curve, &to, wider, 0.0);
        let sampled = shares().find(|u| (curve.at(*u) - to).norm() <= wider);
        prop_assert!(first <= sampled.or(first), "{first:?} {sampled:?}");
    }

    #[test]
    fn the_largest_speed_is_the_largest_sampled(
        velocity in point(), acceleration in point(), jerk in point(), time in 0.0..3.0_f64,
    ) {
        let start = Sample { position: Vector::zeros(), velocity, acceleration, jerk };
        let found = Largest::above(0.0, &squared_speed(&start, time)).bound.sqrt();
        let speed = |u: f64| {
            let t = u * time;
            (velocity + (acceleration + jerk * (0.5 * t)) * t).norm()
        };
        let sampled = shares().map(speed).fold(0.0, f64::max);
        prop_assert!(found >= sampled * (1.0 - 1e-12), "{found} {sampled}");
        prop_assert!(found <= sampled * (1.0 + 3e-2) + 1e-12, "{found} {sampled}");
    }
}

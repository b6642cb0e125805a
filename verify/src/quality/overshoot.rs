//! Measures how far a point lies beyond a straight line on the outer side of the corner next to it.
//!
//! Source: ours. The inner side of a corner is where its other line lies. A third of a line belongs to the corner at
//! either end. Not here: the tolerance.

use crate::path::leg::Leg;
use crate::path::route::Route;
use toolglide_kinematics::{PathSide, Vector};

/// Share of a line that belongs to the corner at either end.
const NEAR: f64 = 1.0 / 3.0;

/// Sine of a turn below which there is no corner.
const STRAIGHT: f64 = 1e-6;

/// Distance of a point beyond a straight move on the side that is kept, mm.
pub(super) fn beyond<const N: usize>(
    route: &Route<N>,
    mv: u32,
    point: &Vector<N>,
    side: PathSide,
) -> f64 {
    if side == PathSide::Inside {
        return overshoot(route, mv, point);
    }
    let Some(leg) = route.get(mv) else { return 0.0 };
    leg.direction()
        .and_then(|direction| side.across(&direction))
        .map_or(0.0, |across| across.dot(&(point - leg.start)).max(0.0))
}

/// Distance of a point beyond a move on the outer side, mm; 0 inside, on arcs, and where there is no corner.
pub(super) fn overshoot<const N: usize>(route: &Route<N>, mv: u32, point: &Vector<N>) -> f64 {
    let Some(direction) = route.get(mv).and_then(Leg::direction) else {
        return 0.0;
    };
    let Some(leg) = route.get(mv) else { return 0.0 };
    let along = (point - leg.start).dot(&direction);
    let (other, corner) = if along < NEAR * leg.length {
        let before = mv.checked_sub(1).and_then(|mv| route.get(mv));
        (
            before.and_then(Leg::direction).map(|other| -other),
            leg.start,
        )
    } else if along > (1.0 - NEAR) * leg.length {
        let next = route.get(mv.saturating_add(1));
        (next.and_then(Leg::direction), leg.end)
    } else {
        return 0.0;
    };
    let Some(other) = other else { return 0.0 };
    let inside = other - direction * direction.dot(&other);
    let sine = inside.norm();
    if sine < STRAIGHT {
        return 0.0;
    }
    (-(point - corner).dot(&inside) / sine).max(0.0)
}

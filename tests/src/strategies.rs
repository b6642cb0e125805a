//! Generates random courses and limits with reversals, repeats, tiny turns and moves, full circles,
//! stops and changes of feedrate.
//!
//! Not here: what must hold for them.

use crate::course::{Course, Lead, Leg, Numbers, arc, go, numbers};
use proptest::prelude::*;
use std::f64::consts::TAU;
use toolglide_kinematics::Vector;

/// A stroke of the pen, relative to the one before.
#[derive(Clone, Debug)]
enum Stroke {
    /// A direction and a length.
    Line(Vec<f64>, f64),
    /// Straight on.
    On(f64),
    /// Back the way it came.
    Back(f64),
    /// Back to exactly where the last move began.
    Return,
    /// On with a turn of some angle towards an axis.
    Turn(f64, usize, f64),
    /// To where it is.
    Repeat,
    /// Radius, angle of the start, sweep as a share of a turn, lift, plane, sense, turns.
    Arc(f64, f64, f64, f64, [usize; 2], bool, u32),
    /// Standing still.
    Dwell(f64),
}

/// How a stroke is to be followed.
#[derive(Clone, Debug)]
struct Manner {
    feedrate: Option<f64>,
    tolerance: Option<f64>,
    stop: bool,
}

fn logarithmic(least: f64, most: f64) -> impl Strategy<Value = f64> + Clone {
    (least.ln()..most.ln()).prop_map(f64::exp)
}

fn lengths() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        6 => logarithmic(1e-4, 20.0),
        1 => Just(1e-6),
        1 => Just(1.0),
    ]
}

fn directions(axes: usize) -> impl Strategy<Value = Vec<f64>> {
    prop_oneof![
        3 => prop::collection::vec(-1.0..1.0_f64, axes),
        2 => prop::collection::vec(prop_oneof![Just(-1.0), Just(0.0), Just(1.0)], axes),
    ]
}

fn planes(axes: usize) -> impl Strategy<Value = [usize; 2]> {
    (0..axes, 1..axes).prop_map(move |(first, apart)| [first, (first + apart) % axes])
}

fn strokes(axes: usize) -> impl Strategy<Value = Stroke> {
    let arc = (
        logarithmic(1e-3, 20.0),
        prop_oneof![Just(0.0), 0.0..TAU],
        prop_oneof![2 => 1e-3..1.0_f64, 1 => Just(1.0), 1 => Just(0.25)],
        prop_oneof![2 => Just(0.0), 1 => -10.0..10.0_f64],
        planes(axes),
        any::<bool>(),
        prop_oneof![4 => Just(0_u32), 1 => 1..3_u32],
    );
    prop_oneof![
        6 => (directions(axes), lengths()).prop_map(|(way, length)| Stroke::Line(way, length)),
        1 => lengths().prop_map(Stroke::On),
        1 => lengths().prop_map(Stroke::Back),
        1 => Just(Stroke::Return),
        2 => (logarithmic(1e-7, 1.5), 0..axes, lengths())
            .prop_map(|(angle, axis, length)| Stroke::Turn(angle, axis, length)),
        1 => (Just(1e-6), 0..axes, lengths())
            .prop_map(|(angle, axis, length)| Stroke::Turn(angle, axis, length)),
        1 => Just(Stroke::Repeat),
        2 => arc.prop_map(|(radius, from, sweep, lift, plane, ccw, turns)| {
            Stroke::Arc(radius, from, sweep, lift, plane, ccw, turns)
        }),
        1 => prop_oneof![Just(0.0), 0.0..0.2_f64].prop_map(Stroke::Dwell),
    ]
}

fn manners() -> impl Strategy<Value = Manner> {
    (
        prop_oneof![
            6 => Just(None),
            1 => Just(Some(f64::INFINITY)),
            2 => logarithmic(0.5, 1000.0).prop_map(Some),
        ],
        prop_oneof![5 => Just(None), 1 => logarithmic(1e-3, 0.5).prop_map(Some)],
        prop::bool::weighted(0.08),
    )
        .prop_map(|(feedrate, tolerance, stop)| Manner {
            feedrate,
            tolerance,
            stop,
        })
}

/// Courses of 2 to 30 moves in `N` axes.
pub fn courses<const N: usize>() -> impl Strategy<Value = Course<N>> {
    (
        prop_oneof![
            2 => Just(vec![0.0; N]),
            1 => prop::collection::vec(-500.0..500.0_f64, N),
        ],
        logarithmic(1.0, 1000.0),
        logarithmic(1e-3, 0.5),
        prop::collection::vec((strokes(N), manners()), 2..=30),
    )
        .prop_map(|(start, feedrate, tolerance, strokes)| {
            draw(&start, feedrate, tolerance, &strokes)
        })
}

/// Courses of straight moves alone, with corners of any angle and moves of the same size.
pub fn zigzags<const N: usize>() -> impl Strategy<Value = Course<N>> {
    (
        logarithmic(1.0, 1000.0),
        logarithmic(1e-3, 0.5),
        logarithmic(1e-3, 10.0),
        prop::collection::vec((directions(N), 0.5..1.5_f64), 2..=30),
    )
        .prop_map(|(feedrate, tolerance, size, ways)| {
            let manner = Manner {
                feedrate: None,
                tolerance: None,
                stop: false,
            };
            let strokes: Vec<_> = ways
                .into_iter()
                .map(|(way, share)| (Stroke::Line(way, size * share), manner.clone()))
                .collect();
            draw(&[0.0; N], feedrate, tolerance, &strokes)
        })
}

/// Courses that turn gently by about the same angle, as curves that were cut into chords do.
pub fn curves<const N: usize>() -> impl Strategy<Value = Course<N>> {
    (
        logarithmic(1.0, 1000.0),
        logarithmic(1e-3, 0.5),
        logarithmic(1e-3, 5.0),
        logarithmic(1e-4, 0.5),
        prop::collection::vec((0.9..1.1_f64, -0.2..1.0_f64), 2..=60),
    )
        .prop_map(|(feedrate, tolerance, size, turn, shares)| {
            let mut legs = Vec::with_capacity(shares.len());
            let (mut at, mut heading) = ([0.0; N], 0.3_f64);
            for (length, angle) in shares {
                heading += turn * angle;
                at[0] += size * length * heading.cos();
                at[1] += size * length * heading.sin();
                if N > 2 {
                    at[2] += 0.1 * size * length;
                }
                legs.push(at);
            }
            Course::of_lines([0.0; N], &legs, feedrate, tolerance)
        })
}

/// Courses of lines and arcs in the plane of the first two axes that meet without a corner, or with
/// hardly one.
pub fn bends<const N: usize>() -> impl Strategy<Value = Course<N>> {
    let bend = (
        prop_oneof![1 => Just(None), 3 => logarithmic(0.1, 40.0).prop_map(Some)],
        logarithmic(0.02, 5.5),
        any::<bool>(),
        prop_oneof![4 => Just(0.0), 1 => logarithmic(1e-5, 0.3)],
    );
    (
        logarithmic(1.0, 1000.0),
        logarithmic(1e-3, 0.5),
        prop_oneof![2 => Just(None), 1 => logarithmic(0.1, 40.0).prop_map(Some)],
        prop::collection::vec(bend, 2..=20),
    )
        .prop_map(|(feedrate, tolerance, of_all, bends)| {
            let mut legs = Vec::with_capacity(bends.len());
            let (mut at, mut heading) = ([0.0; N], 0.3_f64);
            for (radius, long, ccw, kink) in bends {
                heading += kink;
                let Some(radius) = radius.map(|radius| of_all.unwrap_or(radius)) else {
                    at[0] += long * heading.cos();
                    at[1] += long * heading.sin();
                    legs.push(go(Lead::Line(at), feedrate, tolerance));
                    continue;
                };
                let towards = if ccw { radius } else { -radius };
                let mut center = at;
                center[0] -= towards * heading.sin();
                center[1] += towards * heading.cos();
                heading += long.copysign(towards);
                at[0] = center[0] + towards * heading.sin();
                at[1] = center[1] - towards * heading.cos();
                legs.push(go(arc(center, at, [0, 1], ccw, 0), feedrate, tolerance));
            }
            Course {
                start: [0.0; N],
                legs,
            }
        })
}

fn draw<const N: usize>(
    start: &[f64],
    feedrate: f64,
    tolerance: f64,
    strokes: &[(Stroke, Manner)],
) -> Course<N> {
    let mut at = Vector::<N>::from_fn(|axis, _| start[axis]);
    let mut before = at;
    let mut heading = Vector::<N>::zeros();
    heading[0] = 1.0;
    let (mut feedrate, mut tolerance) = (feedrate, tolerance);
    let start = numbers(&at);
    let mut legs = Vec::with_capacity(strokes.len());
    for (stroke, manner) in strokes {
        feedrate = manner.feedrate.unwrap_or(feedrate);
        tolerance = manner.tolerance.unwrap_or(tolerance);
        let from = at;
        let mut lead = None;
        match stroke {
            Stroke::Line(way, length) => {
                let way = Vector::<N>::from_fn(|axis, _| way[axis]);
                if way.norm() > 0.0 {
                    heading = way.normalize();
                }
                at += heading * *length;
            }
            Stroke::On(length) => at += heading * *length,
            Stroke::Back(length) => {
                heading = -heading;
                at += heading * *length;
            }
            Stroke::Return => {
                at = before;
                heading = -heading;
            }
            Stroke::Turn(angle, axis, length) => {
                let mut towards = Vector::<N>::zeros();
                towards[*axis] = 1.0;
                towards -= heading * heading.dot(&towards);
                if towards.norm() > 0.0 {
                    heading = heading * angle.cos() + towards.normalize() * angle.sin();
                }
                at += heading * *length;
            }
            Stroke::Repeat => {}
            Stroke::Dwell(duration) => lead = Some(Lead::Dwell(*duration)),
            Stroke::Arc(radius, from_angle, sweep, lift, plane, ccw, turns) => {
                let signed = if *ccw { TAU * sweep } else { -TAU * sweep };
                let outward = |angle: f64| {
                    let mut way = Vector::<N>::zeros();
                    way[plane[0]] = angle.cos();
                    way[plane[1]] = angle.sin();
                    way * *radius
                };
                let center = at - outward(*from_angle);
                // A full circle ends bit for bit where it began.
                let full = (*sweep).to_bits() == 1.0_f64.to_bits();
                if !full {
                    at = center + outward(from_angle + signed);
                }
                if let Some(axis) = (0..N).find(|axis| !plane.contains(axis)) {
                    at[axis] += lift;
                }
                let step = 1e-3_f64.copysign(signed);
                let tangent = outward(from_angle + signed) - outward(from_angle + signed - step);
                if tangent.norm() > 0.0 {
                    heading = tangent.normalize();
                }
                lead = Some(Lead::Arc {
                    center: numbers(&center),
                    end: numbers(&at),
                    plane: *plane,
                    ccw: *ccw,
                    turns: *turns,
                });
            }
        }
        before = from;
        legs.push(Leg {
            lead: lead.unwrap_or_else(|| Lead::Line(numbers(&at))),
            feedrate,
            tolerance,
            stop: manner.stop,
        });
    }
    Course { start, legs }
}

/// Limits of `N` axes, equal or not.
pub fn limits<const N: usize>() -> impl Strategy<Value = Numbers<N>> {
    let axis = || {
        (
            logarithmic(10.0, 2000.0),
            logarithmic(100.0, 30_000.0),
            logarithmic(3.0, 1000.0),
        )
            .prop_map(|(velocity, acceleration, ratio)| {
                [velocity, acceleration, acceleration * ratio]
            })
    };
    prop_oneof![
        2 => axis().prop_map(|numbers| vec![numbers; N]),
        3 => prop::collection::vec(axis(), N),
        2 => Just(vec![[500.0, 2_000.0, 5e4]; N]),
    ]
    .prop_map(|axes| std::array::from_fn(|axis| axes[axis]))
}

//! Random programs as people write them: lines, arcs and fine chords, under feedrates that stay, alternate,
//! ramp, jitter, or come from inverse time, on three machines.
//!
//! Not here: what must hold for them.

use crate::course::{Course, Lead, Leg, Numbers, USUAL, arc, go};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Axes of a program: two in the plane of arcs, and one across.
pub const AXES: usize = 3;

/// Velocity, acceleration and jerk of three machines: a quick gantry, a usual mill, and one whose axes differ.
const MACHINES: [Numbers<AXES>; 3] = [
    [[500.0, 2_500.0, 2e5]; AXES],
    [USUAL; AXES],
    [
        [400.0, 3_000.0, 6e4],
        [300.0, 1_200.0, 3e4],
        [80.0, 400.0, 1e4],
    ],
];

/// A part of a path.
#[derive(Clone, Debug)]
enum Section {
    /// Straight moves: turn, length and lift of each.
    Lines(Vec<(f64, f64, f64)>),
    /// Chords of a curve whose curvature (1/mm) changes at a rate, of some length, so many; coordinates have
    /// so many digits.
    Chords {
        curvature: f64,
        rate: f64,
        length: f64,
        count: usize,
        digits: i32,
    },
    /// Arcs and straight moves: radius (none for a line), sweep or length, sense, kink before it.
    Bends(Vec<(Option<f64>, f64, bool, f64)>),
    /// Back and forth over a width, so many times, apart by a step.
    Raster(f64, f64, usize),
}

/// How the feedrate changes from move to move.
#[derive(Clone, Debug)]
enum SCurve {
    /// It stays.
    Constant,
    /// Two take turns, one faster by a share.
    Alternate(f64),
    /// It goes evenly to another, by a factor.
    Ramp(f64),
    /// Each differs by up to a ten-thousandth.
    Jitter(Vec<f64>),
    /// Inverse time, rounded to so many digits of moves a minute.
    InverseTime(i32),
}

fn logarithmic(least: f64, most: f64) -> impl Strategy<Value = f64> + Clone {
    (least.ln()..most.ln()).prop_map(f64::exp)
}

fn sections() -> impl Strategy<Value = Section> {
    let line = (
        prop_oneof![
            2 => -3.1..3.1_f64,
            2 => -0.8..0.8_f64,
            1 => Just(0.0),
        ],
        logarithmic(0.05, 30.0),
        prop_oneof![5 => Just(0.0), 1 => -2.0..2.0_f64],
    );
    let bend = (
        prop_oneof![1 => Just(None), 3 => logarithmic(0.05, 40.0).prop_map(Some)],
        logarithmic(0.1, 6.0),
        any::<bool>(),
        prop_oneof![2 => Just(0.0), 1 => logarithmic(1e-3, 0.5), 1 => -3.1..3.1_f64],
    );
    let small = (
        logarithmic(0.02, 0.5).prop_map(Some),
        1.0..4.0_f64,
        any::<bool>(),
        -3.1..3.1_f64,
    );
    let chords = (
        prop_oneof![logarithmic(0.005, 2.0), Just(0.0)],
        prop_oneof![Just(0.0), -0.05..0.05_f64],
        logarithmic(0.02, 1.5),
        10..250_usize,
        3..6_i32,
    );
    prop_oneof![
        2 => prop::collection::vec(line, 1..20).prop_map(Section::Lines),
        3 => chords.prop_map(|(curvature, rate, length, count, digits)| Section::Chords {
            curvature,
            rate,
            length,
            count,
            digits,
        }),
        2 => prop::collection::vec(bend, 1..12).prop_map(Section::Bends),
        1 => prop::collection::vec(small, 2..25).prop_map(Section::Bends),
        1 => (logarithmic(0.2, 20.0), logarithmic(0.02, 1.0), 2..12_usize)
            .prop_map(|(width, step, count)| Section::Raster(width, step, count)),
    ]
}

fn feeds() -> impl Strategy<Value = SCurve> {
    prop_oneof![
        2 => Just(SCurve::Constant),
        3 => prop_oneof![Just(5e-4), Just(0.01), 0.0..0.2_f64, 0.2..4.0_f64].prop_map(SCurve::Alternate),
        2 => (0.3..3.0_f64).prop_map(SCurve::Ramp),
        2 => prop::collection::vec(-1e-4..1e-4_f64, 7).prop_map(SCurve::Jitter),
        2 => (0..4_i32).prop_map(SCurve::InverseTime),
    ]
}

/// Programs, each with the limits of one of the machines.
pub fn programs() -> impl Strategy<Value = (Course<AXES>, Numbers<AXES>)> {
    (
        prop::collection::vec(sections(), 1..4),
        feeds(),
        logarithmic(3.0, 300.0),
        logarithmic(2e-3, 0.2),
        0..MACHINES.len(),
        prop_oneof![4 => Just(usize::MAX), 1 => 5..60_usize],
    )
        .prop_map(|(sections, feed, feedrate, tolerance, machine, stops)| {
            let mut course = drawn(&sections, feedrate, tolerance);
            let count = course.legs.len();
            let mut from = course.start;
            for (index, leg) in course.legs.iter_mut().enumerate() {
                leg.feedrate = fed(&feed, index, count, leg, &from);
                leg.stop = index % stops == stops - 1;
                from = end_of(leg);
            }
            (course, MACHINES[machine])
        })
}

fn end_of(leg: &Leg<AXES>) -> [f64; AXES] {
    match leg.lead {
        Lead::Line(end) | Lead::Arc { end, .. } => end,
        Lead::Dwell(_) => [0.0; AXES],
    }
}

/// The feedrate of a move that begins at a point.
#[allow(clippy::cast_precision_loss, reason = "counts are small")]
fn fed(feed: &SCurve, index: usize, count: usize, leg: &Leg<AXES>, from: &[f64; AXES]) -> f64 {
    let feedrate = leg.feedrate;
    match feed {
        SCurve::Constant => feedrate,
        SCurve::Alternate(more) if index % 2 == 1 => feedrate * (1.0 + more),
        SCurve::Alternate(_) => feedrate,
        SCurve::Ramp(factor) => feedrate * (1.0 + (factor - 1.0) * index as f64 / count as f64),
        SCurve::Jitter(shares) => feedrate * (1.0 + shares[index * index % shares.len()]),
        SCurve::InverseTime(digits) => {
            let length = length_of(leg, from);
            let unit = 10.0_f64.powi(-digits);
            let inverse = (60.0 * feedrate / length / unit).round().max(1.0) * unit;
            length * inverse / 60.0
        }
    }
}

fn length_of(leg: &Leg<AXES>, from: &[f64; AXES]) -> f64 {
    match leg.lead {
        Lead::Line(end) => distance(from, &end),
        Lead::Arc {
            center, end, ccw, ..
        } => {
            let angle = |at: &[f64; AXES]| (at[1] - center[1]).atan2(at[0] - center[0]);
            let turned = if ccw {
                angle(&end) - angle(from)
            } else {
                angle(from) - angle(&end)
            };
            distance(from, &center) * turned.rem_euclid(TAU).max(1e-9)
        }
        Lead::Dwell(_) => 1.0,
    }
}

fn distance(from: &[f64; AXES], to: &[f64; AXES]) -> f64 {
    from.iter()
        .zip(to)
        .map(|(one, other)| (one - other) * (one - other))
        .sum::<f64>()
        .sqrt()
        .max(1e-9)
}

fn drawn(sections: &[Section], feedrate: f64, tolerance: f64) -> Course<AXES> {
    let (mut at, mut heading) = ([0.0; AXES], 0.3_f64);
    let mut legs = Vec::new();
    for section in sections {
        match section {
            Section::Lines(lines) => {
                for &(turn, length, lift) in lines {
                    heading += turn;
                    at[0] += length * heading.cos();
                    at[1] += length * heading.sin();
                    at[2] += lift;
                    legs.push(go(Lead::Line(at), feedrate, tolerance));
                }
            }
            &Section::Chords {
                curvature,
                rate,
                length,
                count,
                digits,
            } => {
                let unit = 10.0_f64.powi(digits);
                let mut bending = curvature;
                for _ in 0..count {
                    heading += bending * length;
                    bending += rate * curvature;
                    at[0] += length * heading.cos();
                    at[1] += length * heading.sin();
                    let rounded = at.map(|coordinate| (coordinate * unit).round() / unit);
                    legs.push(go(Lead::Line(rounded), feedrate, tolerance));
                }
                at = at.map(|coordinate| (coordinate * unit).round() / unit);
            }
            Section::Bends(bends) => {
                for &(radius, long, ccw, kink) in bends {
                    heading += kink;
                    let Some(radius) = radius else {
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
            }
            &Section::Raster(width, step, count) => {
                for line in 0..count {
                    let way = if line % 2 == 0 { width } else { -width };
                    at[0] += way;
                    legs.push(go(Lead::Line(at), feedrate, tolerance));
                    at[1] += step;
                    legs.push(go(Lead::Line(at), feedrate, tolerance));
                }
            }
        }
    }
    Course {
        start: [0.0; AXES],
        legs,
    }
}

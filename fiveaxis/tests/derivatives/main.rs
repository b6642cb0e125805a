//! Derives the motion of the axes a second time: Taylor series of the third order carried through
//! inverse kinematics written out here, which share nothing with the planner or its judge.
//!
//! Source: the derivatives of a function are the coefficients of its series. Not here: positions at
//! nodes, whose rounding grows with every derivative.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]
#![allow(clippy::print_stdout, reason = "the numbers are worth a look")]

#[path = "../common/mod.rs"]
mod common;
mod follower;
mod jet;
mod machines;
mod rotary;

use common::{judge, legs, plan, settings, start_of};
use follower::{Follower, Peaks};
use machines::{Case, cases, limits};
use std::f64::consts::TAU;
use toolglide_fiveaxis::PoseMethod;
use toolglide_kinematics::{Axis, AxisLimits, PosePiece};

/// What is looked for between instants is at least this share of its limit.
pub(crate) const NOTABLE: f64 = 0.3;

/// By how much a limit may be exceeded, as a share.
const EXCESS: f64 = 1e-6;

/// By how much the judge may see less than there is, between the instants that it looks at.
const AGREES: f64 = 1e-3;

/// A chain of poses, and how it is moved along.
#[derive(Debug)]
struct Chain {
    rows: Vec<[f64; 6]>,
    speed: f64,
    tolerances: [f64; 2],
    method: PoseMethod,
    /// The motion is planned for limits that are so many times those that it is judged by.
    haste: f64,
}

/// Largest shares of limits by jets and by the judge, and whether the judge lets the motion pass.
fn both(case: &Case, chain: &Chain) -> (Peaks, Peaks, bool) {
    let machine = case.machine.as_ref();
    let start = start_of(machine, &chain.rows[0]);
    let [tip, orientation] = chain.tolerances;
    let legs = legs(&chain.rows, chain.speed, tip, orientation);
    let hasty: Vec<Axis> = case
        .axes
        .iter()
        .map(|axis| {
            let [velocity, acceleration, jerk] = limits(axis).map(|limit| limit * chain.haste);
            Axis {
                limits: AxisLimits::new(velocity, acceleration, jerk).unwrap(),
                ..axis.clone()
            }
        })
        .collect();
    let settings = settings([0.1, 0.05], chain.method);
    let planned = plan(machine, &hasty, start, &legs, &settings);
    let report = judge(machine, &case.axes, &legs, &planned);
    let mut follower = Follower {
        case,
        near: planned.start,
        peaks: [[0.0; 3]; 5],
    };
    for piece in &planned.pieces {
        let PosePiece::Tool(piece) = piece else {
            panic!("tool motion, and not motion of axes");
        };
        if piece.duration > 0.0 {
            follower.piece(piece);
        }
    }
    let judged = std::array::from_fn(|axis| {
        let (found, limits) = (&report.axes[axis], limits(&case.axes[axis]));
        [
            found.velocity.value / limits[0],
            found.acceleration.value / limits[1],
            found.jerk.value / limits[2],
        ]
    });
    (follower.peaks, judged, report.passes())
}

const METHODS: [PoseMethod; 3] = [
    PoseMethod::PointToPoint,
    PoseMethod::VelocityControlled,
    PoseMethod::DwellControlled,
];

/// A pose whose tool leans by so much along X and Y.
fn leaning([x, y, z]: [f64; 3], [i, j]: [f64; 2]) -> [f64; 6] {
    [x, y, z, i, j, (1.0 - i * i - j * j).sqrt()]
}

/// Two moves of which the first passes the pole, at a distance of so much.
fn past_the_pole(distance: f64, from: f64, turn: f64, length: f64) -> Vec<[f64; 6]> {
    let (sin, cos) = turn.sin_cos();
    let at = |along: f64| [along * cos - distance * sin, along * sin + distance * cos];
    vec![
        leaning([0.0, 0.0, 0.0], at(-from)),
        leaning([length, 0.3 * length, 0.0], at(0.6 * from)),
        leaning([length, length, 1.0], at(from)),
    ]
}

/// Uniform numbers from 0 to 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(self.0 >> 32).unwrap()) / f64::from(u32::MAX)
    }

    fn within(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.next()
    }

    fn of<T: Copy>(&mut self, first: T, second: T, share: f64) -> T {
        if self.next() < share { first } else { second }
    }
}

/// What both derivations found in some motions.
#[derive(Debug, Default)]
struct Found {
    motions: u32,
    /// Largest share of a limit by jets.
    most: f64,
    /// By how much the judge is below and above jets, as shares.
    below: f64,
    above: f64,
}

impl Found {
    /// Compares both derivations of a motion.
    fn compare(&mut self, case: &Case, chain: &Chain) {
        self.take(case, chain, chain.haste, both(case, chain));
    }

    /// Compares what both derivations found.
    fn take(
        &mut self,
        case: &Case,
        chain: &dyn std::fmt::Debug,
        haste: f64,
        (jets, judged, passes): (Peaks, Peaks, bool),
    ) {
        let mut most = 0.0_f64;
        for (place, (jet, judged)) in jets
            .as_flattened()
            .iter()
            .zip(judged.as_flattened())
            .enumerate()
        {
            most = most.max(*jet);
            if *jet > NOTABLE {
                self.below = self.below.max(1.0 - judged / jet);
                self.above = self.above.max(judged / jet - 1.0);
            }
            let (axis, order) = (place / 3, place % 3 + 1);
            assert!(
                *jet <= NOTABLE || *judged >= jet * (1.0 - AGREES),
                "{}, axis {axis}, derivative {order}: {judged} of the limit instead of {jet}: {chain:?}",
                case.name
            );
        }
        self.most = self.most.max(most);
        self.motions += 1;
        if haste <= 1.0 {
            assert!(
                most <= 1.0 + EXCESS && passes,
                "{}: {most} of a limit, passes: {passes}: {chain:?}",
                case.name
            );
        }
        // What the judge grants, and what it may miss between its instants.
        assert!(
            most <= 1.0 + 1e-4 + AGREES || !passes,
            "{}: {most} of a limit passes: {chain:?}",
            case.name
        );
    }
}

/// How many motions of each machine are looked at.
fn motions(usual: usize) -> usize {
    std::env::var("MOTIONS").map_or(usual, |count| count.parse().unwrap())
}

/// Random moves past the pole of each machine.
fn past(count: usize, numbers: &mut Numbers, most_haste: f64) -> Found {
    let mut found = Found::default();
    let cases = cases();
    for number in 0..count {
        for case in &cases {
            let distance = 1e-5 * 5e3_f64.powf(numbers.next());
            let (from, turn) = (numbers.within(0.05, 0.4), TAU * numbers.next());
            let length = numbers.of(20.0, 1.0, 0.5);
            let chain = Chain {
                rows: past_the_pole(distance, from, turn, length),
                speed: numbers.within(10.0, 200.0),
                tolerances: [0.05, 0.002],
                method: METHODS[number % METHODS.len()],
                haste: most_haste.powf(numbers.next()),
            };
            found.compare(case, &chain);
        }
    }
    found
}

#[test]
fn moves_past_the_pole_keep_every_limit_by_both_derivations() {
    let found = past(motions(9), &mut Numbers(1), 1.0);
    println!("{found:?}");
    assert!(found.most > 0.99, "nothing comes near a limit: {found:?}");
    assert!(found.above < AGREES, "the judge sees noise: {found:?}");
}

#[test]
fn motion_too_fast_for_a_limit_does_not_pass_by_either_derivation() {
    let found = past(motions(6), &mut Numbers(2), 4.0);
    println!("{found:?}");
    assert!(found.most > 2.0, "nothing exceeds a limit: {found:?}");
    assert!(found.above < AGREES, "the judge sees noise: {found:?}");
}

#[test]
fn chains_around_the_pole_keep_every_limit_by_both_derivations() {
    let mut numbers = Numbers(7);
    let mut found = Found::default();
    let cases = cases();
    for number in 0..motions(6) {
        for case in &cases {
            let moves = number % 5 + 2;
            let mut rows = Vec::with_capacity(moves + 1);
            for _ in 0..=moves {
                let near = numbers.of(0.0, 0.001, 0.5);
                let width = numbers.of(near, 0.15, 0.4);
                let lean = [numbers.within(-width, width), numbers.within(-width, width)];
                let x = numbers.within(-10.0, 10.0);
                rows.push(leaning([x, numbers.within(-10.0, 10.0), 0.1 * x], lean));
            }
            let chain = Chain {
                rows,
                speed: numbers.within(5.0, 200.0),
                tolerances: [numbers.within(0.005, 0.2), numbers.within(0.0005, 0.02)],
                method: METHODS[number % METHODS.len()],
                haste: 1.0,
            };
            found.compare(case, &chain);
        }
    }
    println!("{found:?}");
    assert!(found.above < AGREES, "the judge sees noise: {found:?}");
}

#[test]
fn corners_beside_the_pole_whose_blend_turns_far_around_it_keep_the_jerk_of_c() {
    let chain = Chain {
        rows: [
            [9.9731, -1.9081, -0.063871, -0.104949],
            [8.2071, -4.5617, -0.020196, -0.007428],
            [4.2315, 6.3710, 0.057241, -0.148864],
            [-8.5045, -3.8289, -0.035090, 0.040321],
            [-6.0237, -0.3113, 0.0, 0.0],
            [1.3764, -4.5683, -0.000609, -0.000551],
            [-2.8552, 6.9271, -0.053098, 0.030817],
            [-7.2780, 2.6977, -0.000446, 0.000534],
        ]
        .map(|[x, y, i, j]| leaning([x, y, 0.1 * x], [i, j]))
        .to_vec(),
        speed: 179.309,
        tolerances: [0.0967079, 0.001415],
        method: PoseMethod::DwellControlled,
        haste: 1.0,
    };
    let mut found = Found::default();
    for case in &cases() {
        found.compare(case, &chain);
    }
    println!("{found:?}");
}

//! Prints what planning costs: processor time a move and a chord, and the longest push, for each program and
//! each method.
//!
//! `cargo bench -p toolglide-tests --bench work -- kcs arcs` measures the methods and the programs whose
//! names contain one of these words; without words, the methods `kcs` and `fir` on all programs. A line that
//! ends with `over` exceeds what a controller may count on.
#![allow(clippy::unwrap_used, reason = "a bench that cannot start may panic")]
#![allow(clippy::print_stdout, reason = "a table has no other place")]

mod programs;

use cpu_time::ThreadTime;
use programs::{Program, programs};
use std::hint::black_box;
use std::time::Duration;
use toolglide_fastest::Fastest;
use toolglide_fir::FirInterpolation;
use toolglide_kinematics::{Limits, MotionPlanner, Move, Path, Vector};
use toolglide_optimal::{Effort, TimeOptimal};
use toolglide_smoothing::{KinematicSmoothing, Method};

/// Methods that are measured unless others are asked for.
const DEFAULT_METHODS: [&str; 2] = ["kcs", "fir"];

/// Kinematic corner smoothing by itself, without the methods that `kcs` compares it with.
const SMOOTHING: &str = "smoothing";

/// Rounds over which the least time of each push counts, which leaves out what else the computer did.
const ROUNDS: usize = 2;

/// Share of the tolerance that chords are counted with, and the largest angle of one.
const CHORD_SHARE: f64 = 0.05;
const CHORD_ANGLE: f64 = std::f64::consts::FRAC_PI_2;

/// What a program is allowed, s: a move, a chord, and any push.
const A_MOVE: f64 = 20e-6;
const A_CHORD: f64 = 1e-6;
const A_PUSH: f64 = 10e-3;

/// What planning a program took.
struct Cost {
    /// Processor time of all pushes and pulls, s.
    whole: f64,
    /// The longest push with the pulls after it, s, and its number.
    longest: (f64, usize),
    /// Duration of the motion, s.
    motion: f64,
    /// Moves that were pushed before the first piece.
    latency: usize,
}

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with("--"))
        .collect();
    let known: Vec<&str> = Method::ALL
        .map(Method::name)
        .into_iter()
        .chain(toolglide_fir::Method::ALL.map(toolglide_fir::Method::name))
        .chain(["optimal", SMOOTHING])
        .collect();
    let (mut methods, names): (Vec<&str>, Vec<&str>) = words
        .iter()
        .map(String::as_str)
        .partition(|word| known.contains(word));
    if methods.is_empty() {
        methods.extend(DEFAULT_METHODS);
    }
    let limits = Limits::uniform(500.0, 2_500.0, 2e5).unwrap();
    println!(
        "{:44} {:16} {:>7} {:>8} {:>10} {:>9} {:>8} {:>13} {:>8} {:>5}",
        "program",
        "method",
        "moves",
        "chords",
        "motion s",
        "whole s",
        "us/move",
        "longest ms",
        "of bound",
        "first"
    );
    for program in programs() {
        if !(names.is_empty() || names.iter().any(|name| program.name.contains(name))) {
            continue;
        }
        let Some(moves) = program.moves() else {
            continue;
        };
        for method in &methods {
            print_line(&program, &moves, method, limits);
        }
    }
}

fn print_line(program: &Program, moves: &[Move<3>], method: &str, limits: Limits<3>) {
    let cost = measure(moves, method, limits);
    let chords: f64 = moves.iter().map(chords_of).sum();
    let count = moves.len().max(1) as f64;
    let share = cost.whole / (A_MOVE * count + A_CHORD * chords);
    let (longest, at) = cost.longest;
    let over = if share > 1.0 || longest > A_PUSH {
        "over"
    } else {
        ""
    };
    println!(
        "{:44} {method:16} {:>7} {chords:>8} {:>10.3} {:>9.3} {:>8.2} {:>7.2} @{at:<5} {share:>7.2} {:>5} {over}",
        program.name,
        moves.len(),
        cost.motion,
        cost.whole,
        cost.whole * 1e6 / count,
        longest * 1e3,
        cost.latency,
    );
}

/// Chords of an arc at a share of its tolerance.
fn chords_of(step: &Move<3>) -> f64 {
    let Path::Arc(arc) = step.path() else {
        return 0.0;
    };
    let angle = (8.0 * CHORD_SHARE * step.tolerance().length() / arc.bending())
        .sqrt()
        .min(CHORD_ANGLE);
    (arc.sweep().abs() / angle).ceil().max(1.0)
}

fn measure(moves: &[Move<3>], method: &str, limits: Limits<3>) -> Cost {
    let mut least = vec![Duration::MAX; moves.len() + 1];
    let (mut motion, mut latency) = (0.0, 0);
    let mut whole = f64::INFINITY;
    for round in 0..ROUNDS {
        let mut planner = planner(method, limits);
        (motion, latency) = (0.0, 0);
        let began = ThreadTime::now();
        let mut last = Duration::ZERO;
        for (number, step) in moves.iter().map(Some).chain([None]).enumerate() {
            match step {
                Some(step) => planner.push(step).unwrap(),
                None => planner.finish().unwrap(),
            }
            while let Some(piece) = planner.pull() {
                if latency == 0 {
                    latency = number + 1;
                }
                motion += piece.duration();
                black_box(&piece);
            }
            let now = began.elapsed();
            least[number] = least[number].min(now - last);
            last = now;
        }
        whole = whole.min(last.as_secs_f64());
        // What takes long is not taken again.
        if round == 0 && whole > 20.0 {
            break;
        }
    }
    let (at, longest) = least
        .iter()
        .enumerate()
        .max_by_key(|(_, took)| **took)
        .unwrap();
    Cost {
        whole,
        longest: (longest.as_secs_f64(), at),
        motion,
        latency,
    }
}

/// The planner of a method.
fn planner(method: &str, limits: Limits<3>) -> Box<dyn MotionPlanner<3>> {
    let start = Vector::zeros();
    if method == Method::Kcs.name() {
        return Box::new(Fastest::new(start, limits));
    }
    let method = if method == SMOOTHING {
        Method::Kcs.name()
    } else {
        method
    };
    if let Some(method) = Method::find(method) {
        let settings = toolglide_smoothing::Settings::new(limits).with_method(method);
        return Box::new(KinematicSmoothing::new(start, &settings));
    }
    if let Some(method) = toolglide_fir::Method::find(method) {
        let settings = toolglide_fir::Settings::new(limits).with_method(method);
        return Box::new(FirInterpolation::new(start, &settings));
    }
    let settings = toolglide_optimal::Settings::new(limits).with_effort(Effort::default());
    Box::new(TimeOptimal::new(start, &settings))
}

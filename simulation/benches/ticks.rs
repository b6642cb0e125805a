//! Times a servo period of three axes in processor time, contour errors included.
//!
//! `cargo bench -p toolglide-simulation` prints how many times faster than real time the simulation runs.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a bench"
)]

use cpu_time::ThreadTime;
use toolglide_kinematics::{Feedrate, Move, MoveRange, Piece, Sample, Tolerance, Vector};
use toolglide_simulation::{
    DriveModel, DriveSettings, DrivenAxis, FlexibleMode, Interpolation, SimulationSettings,
    Simulator,
};

/// Simulated time of a run, s.
const DURATION: f64 = 20.0;

/// Motion in pieces of 5 ms along chords of a curve in space.
fn pieces() -> (Vec<Move<3>>, Vec<Piece<3>>) {
    let at = |t: f64| {
        Vector::<3>::new(
            10.0 * (1.0 - (3.0 * t).cos()),
            10.0 * (3.0 * t).sin(),
            2.0 * (5.0 * t).sin(),
        )
    };
    let slope = |t: f64| (at(t + 1e-6) - at(t - 1e-6)) / 2e-6;
    let step = 5e-3;
    let (mut moves, mut pieces) = (Vec::new(), Vec::new());
    let count = (DURATION / step) as u32;
    for k in 0..count {
        let (begin, end) = (f64::from(k) * step, f64::from(k + 1) * step);
        let (from, to) = (at(begin), at(end));
        let (first, last) = (slope(begin), slope(end));
        let span = to - from;
        let state = Sample {
            position: from,
            velocity: first,
            acceleration: (span * 6.0 - (first * 4.0 + last * 2.0) * step) / (step * step),
            jerk: ((first + last) * 6.0 * step - span * 12.0) / step.powi(3),
        };
        pieces.push(Piece::new(&state, step, to, MoveRange::one(k)));
        let tolerance = Tolerance::new(0.01).unwrap();
        moves.push(Move::line_to(to, Feedrate::RAPID, tolerance).unwrap());
    }
    (moves, pieces)
}

fn main() {
    let (moves, pieces) = pieces();
    for (name, modes, friction) in [
        ("rigid, friction", 0, true),
        ("one mode each, friction", 1, true),
        ("three modes each, friction", 3, true),
        ("one mode each, no friction", 1, false),
    ] {
        let mut settings = DriveSettings::textbook(35.0);
        settings.modes = (0..modes)
            .map(|mode| FlexibleMode {
                frequency: 40.0 + 15.0 * f64::from(mode),
                damping: 0.02,
                mass_share: 0.05,
                at_encoder: 0.0,
                at_tool: [0.3, 0.0, 0.0],
            })
            .collect();
        if !friction {
            settings = settings.without_friction();
        }
        let model = DriveModel::new(&settings).unwrap();
        let axes = [('X', 0), ('Y', 1), ('Z', 2)].map(|(name, place)| DrivenAxis {
            name,
            model: model.clone(),
            coordinate: Some(place),
        });
        let mut best = f64::INFINITY;
        let mut error = 0.0;
        for _ in 0..5 {
            let settings = SimulationSettings {
                period: 1e-3,
                interpolation: Interpolation::Cubic,
                window: 0.002,
            };
            let mut simulator = Simulator::new(&axes, Vector::zeros(), settings).unwrap();
            for next in &moves {
                simulator.expect(next).unwrap();
            }
            let begin = ThreadTime::now();
            for piece in &pieces {
                simulator.observe(piece).unwrap();
            }
            best = best.min(begin.elapsed().as_secs_f64());
            error = simulator.finish().unwrap().servo.rms();
        }
        println!(
            "{name:<28} {:>7.1} ns a tick, {:>6.0} times real time at 0.1 ms (servo error {:.2} um RMS)",
            1e9 * best / (DURATION / 1e-4),
            DURATION / best,
            1e3 * error
        );
    }
}

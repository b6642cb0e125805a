//! Tests simulated motions: errors to plan and path, symmetry, memory, modes, random settings.

use super::{mode, model, rigid};
use crate::*;
use std::f64::consts::TAU;
use toolglide_kinematics::{Arc, Feedrate, Move, MoveRange, Piece, Sample, Tolerance, Vector};

const SETTINGS: SimulationSettings = SimulationSettings {
    period: 1e-4,
    interpolation: Interpolation::Cubic,
    window: 0.002,
};

/// The motion of a function of time, in pieces of a millisecond that meet with one velocity.
fn pieces<const N: usize>(at: impl Fn(f64) -> Vector<N>, duration: f64) -> Vec<Piece<N>> {
    let step = 1e-3;
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a test"
    )]
    let count = (duration / step).round() as u32;
    let slope = |t: f64| (at(t + 1e-5) - at(t - 1e-5)) / 2e-5;
    (0..count)
        .map(|k| {
            let (begin, end) = (f64::from(k) * step, f64::from(k + 1) * step);
            let (from, to) = (at(begin), at(end));
            let (first, last) = (slope(begin), slope(end));
            let span = to - from;
            let acceleration = (span * 6.0 - (first * 4.0 + last * 2.0) * step) / (step * step);
            let jerk = ((first + last) * 6.0 * step - span * 12.0) / step.powi(3);
            let start = Sample {
                position: from,
                velocity: first,
                acceleration,
                jerk,
            };
            Piece::new(&start, step, to, MoveRange::one(0))
        })
        .collect()
}

/// One axis that follows a function of time.
pub(super) fn one_axis(axis: &DrivenAxis, at: impl Fn(f64) -> f64, duration: f64) -> Outcome {
    let start = Vector::<1>::new(at(0.0));
    let mut simulator = Simulator::new(std::slice::from_ref(axis), start, SETTINGS).unwrap();
    let far = Move::line_to(
        Vector::<1>::new(1e3),
        Feedrate::RAPID,
        Tolerance::new(0.1).unwrap(),
    );
    simulator.expect(&far.unwrap()).unwrap();
    for piece in pieces(|t| Vector::<1>::new(at(t)), duration) {
        simulator.observe(&piece).unwrap();
    }
    simulator.finish().unwrap()
}

fn plane(settings: &DriveSettings) -> [DrivenAxis; 2] {
    [('X', 0), ('Y', 1)].map(|(name, place)| DrivenAxis {
        name,
        model: model(settings),
        coordinate: Some(place),
    })
}

/// A full circle of radius 20 mm in four seconds, begun and ended at rest.
fn circle(axes: &[DrivenAxis; 2], mirror: f64, shift: Vector<2>) -> (Outcome, Vec<Instant<2>>) {
    let angle = |t: f64| {
        let share = (t / 4.0).clamp(0.0, 1.0);
        TAU * share.powi(3) * (10.0 - 15.0 * share + 6.0 * share * share)
    };
    let at = |t: f64| {
        let turn = angle(t);
        Vector::<2>::new(20.0 * turn.cos(), mirror * 20.0 * turn.sin()) + shift
    };
    let start = Vector::<2>::new(20.0, 0.0);
    let mut simulator = Simulator::new(axes, start + shift, SETTINGS).unwrap();
    let arc = Arc::about(start, start, Vector::zeros(), [0, 1], mirror > 0.0, 0);
    let whole = Move::arc(arc.unwrap(), Feedrate::RAPID, Tolerance::new(0.05).unwrap());
    if shift.norm() < 1e-9 {
        simulator.expect(&whole).unwrap();
    }
    let mut seen = Vec::new();
    for piece in pieces(at, 4.0) {
        simulator
            .observe_with(&piece, &mut |instant| seen.push(*instant))
            .unwrap();
    }
    let outcome = simulator
        .finish_with(&mut |instant| seen.push(*instant))
        .unwrap();
    (outcome, seen)
}

#[test]
fn a_mirrored_circle_has_mirrored_errors_to_the_bit() {
    let axes = plane(&DriveSettings::reference(35.0, 7.125e-4));
    let (one, seen) = circle(&axes, 1.0, Vector::zeros());
    let (other, mirrored) = circle(&axes, -1.0, Vector::zeros());
    assert_eq!(one.servo, other.servo);
    for (one, other) in seen.iter().zip(&mirrored) {
        assert_eq!(one.actual[0].to_bits(), other.actual[0].to_bits());
        assert_eq!(
            one.actual[1].abs().to_bits(),
            other.actual[1].abs().to_bits()
        );
    }
    let (again, _) = circle(&axes, 1.0, Vector::zeros());
    assert_eq!(one, again, "same input, same figures");
}

#[test]
fn the_quadrant_peaks_of_a_circle_follow_its_reversals() {
    let axes = plane(&DriveSettings::reference(35.0, 1e-4));
    let (outcome, seen) = circle(&axes, 1.0, Vector::zeros());
    assert!(
        outcome.servo.largest > 2.0 * outcome.servo.rms(),
        "{outcome:?}"
    );
    let reversing = seen
        .iter()
        .find(|instant| (instant.time - outcome.servo.time).abs() < 1e-9)
        .and_then(|instant| instant.reversing);
    assert!(reversing.is_some(), "{:?}", outcome.servo);
    assert_eq!(outcome.axes[0].reversals, 1, "X turns back half way");
    assert_eq!(outcome.axes[1].reversals, 2, "Y at both quarters");
    // The plan keeps the circle, so both errors are one.
    let apart = (outcome.part.largest - outcome.servo.largest).abs();
    assert!(apart < 1e-5, "{outcome:?}");
}

#[test]
fn stiff_drives_without_friction_follow_to_ten_nanometres() {
    let mut settings = rigid(Gains::scaled(400.0, 2.0, 1.0));
    settings.feedforward = Feedforward {
        acceleration: 1.0,
        ..Feedforward::VELOCITY
    };
    let (outcome, _) = circle(&plane(&settings), 1.0, Vector::zeros());
    assert!(outcome.servo.largest < 1e-5, "{:?}", outcome.servo);
    let lag = outcome.axes[0].tracking.largest;
    assert!(lag < 2e-4, "the drives get the set-point of now: {lag}");
}

#[test]
fn a_motion_beside_its_path_has_that_part_error() {
    let line = Vector::<2>::new(10.0, 0.0);
    let offset = Vector::<2>::new(0.0, 0.005);
    let mut settings = rigid(Gains::scaled(400.0, 2.0, 1.0));
    settings.feedforward.velocity = 1.0;
    let mut simulator = Simulator::new(&plane(&settings), offset, SETTINGS).unwrap();
    let mut course = Simulator::new(&plane(&settings), offset, SETTINGS).unwrap();
    let tolerance = Tolerance::new(0.01).unwrap();
    // The path begins where the machine does, so a step aside comes first.
    for end in [Vector::zeros(), line] {
        let next = Move::line_to(end, Feedrate::RAPID, tolerance).unwrap();
        simulator.expect(&next).unwrap();
        course.expect(&next).unwrap();
    }
    let smooth = |t: f64| {
        let share = (t / 1.0).clamp(0.0, 1.0);
        share.powi(3) * (10.0 - 15.0 * share + 6.0 * share * share)
    };
    for piece in pieces(|t| offset + line * smooth(t), 1.0) {
        let piece = Piece::new(
            &piece.at(0.0),
            piece.duration(),
            piece.end(),
            MoveRange::one(1),
        );
        simulator.observe(&piece).unwrap();
        course.observe_unplanned(&piece, &mut |_| {}).unwrap();
    }
    let outcome = simulator.finish().unwrap();
    assert!(
        (outcome.part.largest - 0.005).abs() < 1e-9,
        "{:?}",
        outcome.part
    );
    assert!(
        (outcome.part.share - 0.5).abs() < 1e-6,
        "{:?}",
        outcome.part
    );
    let unplanned = course.finish().unwrap();
    assert!(
        unplanned.part.largest <= 0.005 + 1e-9,
        "{:?}",
        unplanned.part
    );
}

#[test]
fn what_a_stiff_loop_leaves_in_a_mode_is_what_the_plan_leaves() {
    let mut settings = rigid(Gains::scaled(2000.0, 1.2, 1.0));
    settings.servo_period = 2e-5;
    settings.feedforward = Feedforward {
        acceleration: 1.0,
        ..Feedforward::VELOCITY
    };
    settings.modes = vec![mode(7.4, 0.003, 0.0)];
    let axis = DrivenAxis {
        name: 'X',
        model: model(&settings),
        coordinate: None,
    };
    let duration = 0.3;
    let smooth = |t: f64| {
        let share = (t / duration).clamp(0.0, 1.0);
        10.0 * share.powi(3) * (10.0 - 15.0 * share + 6.0 * share * share)
    };
    let outcome = one_axis_at(&axis, smooth, duration);
    // The oscillator under the planned acceleration, by fine steps of the closed form of a held acceleration.
    let (natural, damping) = (TAU * 7.4, 0.003);
    let damped = natural * (1.0_f64 - damping * damping).sqrt();
    let (mut q, mut v, step) = (0.0_f64, 0.0_f64, 1e-5);
    for k in 0..30_000 {
        let share = (f64::from(k) + 0.5) * step / duration;
        let planned = 10.0 * (60.0 * share - 180.0 * share * share + 120.0 * share.powi(3))
            / (duration * duration);
        let rest = -planned / (natural * natural);
        let (sine, cosine) = (damped * step).sin_cos();
        let decay = (-damping * natural * step).exp();
        let (off, pace) = (q - rest, v);
        let mix = (pace + damping * natural * off) / damped;
        q = rest + decay * (off * cosine + mix * sine);
        v = decay
            * (pace * cosine
                - (natural * natural * off + damping * natural * pace) / damped * sine);
    }
    let expected = settings.modes[0].amplitude(q, v);
    let found = outcome.modes[0].left;
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
}

fn one_axis_at(axis: &DrivenAxis, at: impl Fn(f64) -> f64, duration: f64) -> Outcome {
    let start = Vector::<1>::new(at(0.0));
    let settings = SimulationSettings {
        period: 1e-3,
        ..SETTINGS
    };
    let fine = SimulationSettings {
        period: axis.model.settings().servo_period,
        ..settings
    };
    let mut simulator = Simulator::new(std::slice::from_ref(axis), start, fine).unwrap();
    for piece in pieces(|t| Vector::<1>::new(at(t)), duration) {
        simulator.observe(&piece).unwrap();
    }
    simulator.finish().unwrap()
}

#[test]
fn set_points_of_a_millisecond_are_refined_and_change_little() {
    let axes = plane(&DriveSettings::textbook(35.0));
    let run = |period| {
        let settings = SimulationSettings { period, ..SETTINGS };
        let mut simulator = Simulator::new(&axes, Vector::zeros(), settings).unwrap();
        let at = |t: f64| Vector::<2>::new(1.0, 0.5) * (1.0 - (TAU * t).cos()).powi(3);
        for piece in pieces(at, 1.0) {
            simulator.observe(&piece).unwrap();
        }
        simulator.finish().unwrap().servo.rms()
    };
    let (exact, refined) = (run(1e-4), run(1e-3));
    assert!((refined / exact - 1.0).abs() < 0.01, "{exact} {refined}");
}

#[test]
fn a_tick_allocates_nothing() {
    let mut settings = DriveSettings::textbook(35.0);
    settings.modes = vec![mode(40.0, 0.02, 0.05)];
    let mut simulator = Simulator::new(&plane(&settings), Vector::zeros(), SETTINGS).unwrap();
    let end = Vector::<2>::new(30.0, 10.0);
    let next = Move::line_to(end, Feedrate::RAPID, Tolerance::new(0.01).unwrap()).unwrap();
    simulator.expect(&next).unwrap();
    let all = pieces(|t| end * (0.5 - 0.5 * (TAU * t).cos()), 2.0);
    let counted = allocation_counter::measure(|| {
        for piece in &all {
            simulator.observe(piece).unwrap();
        }
    });
    assert_eq!(counted.count_total, 0, "{counted:?}");
}

#[test]
fn a_loop_that_loses_its_set_points_ends_with_time_and_axis() {
    let mut settings = DriveSettings::textbook(35.0);
    settings.force_limit = 600.0;
    let mut simulator = Simulator::new(&plane(&settings), Vector::zeros(), SETTINGS).unwrap();
    let away = pieces(|t| Vector::<2>::new(0.0, 1e5 * t * t), 1.0);
    let lost = away.iter().find_map(|piece| simulator.observe(piece).err());
    assert!(
        matches!(lost, Some(SimulationError::Diverged { axis: 'Y', .. })),
        "{lost:?}"
    );
    let start = Sample::at_rest(Vector::<2>::new(f64::NAN, 0.0));
    let piece = Piece::new(&start, 0.1, start.position, MoveRange::one(0));
    let mut simulator = Simulator::new(&plane(&settings), Vector::zeros(), SETTINGS).unwrap();
    let lost = simulator.observe(&piece);
    assert!(
        matches!(lost, Err(SimulationError::NotFinite { .. })),
        "{lost:?}"
    );
}

/// Random numbers from 0 to 1 by a fixed generator.
struct Random(u64);

impl Random {
    #[allow(clippy::cast_precision_loss, reason = "53 bits")]
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        (low.ln() + self.next() * (high / low).ln()).exp()
    }
}

/// `RANDOM_DRIVES=1000000 cargo test --release -p toolglide-simulation random` tries a million.
#[test]
fn random_settings_give_finite_motion_or_a_refusal() {
    let count = std::env::var("RANDOM_DRIVES")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(400);
    let mut random = Random(2026);
    let mut accepted = 0;
    for case in 0..count {
        let mut settings = DriveSettings::textbook(random.between(0.5, 500.0));
        settings.servo_period = random.between(2e-5, 4e-3);
        settings.dead_time = settings.servo_period * (random.next() * 4.0).floor() * random.next();
        settings.current_loop = random.between(20.0, 1e5);
        settings.velocity_filter = (random.next() > 0.3).then(|| random.between(10.0, 1e4));
        settings.encoder_step = if random.next() > 0.3 {
            random.between(1e-7, 0.1)
        } else {
            0.0
        };
        settings.friction.coulomb = random.between(1e-3, 1e5);
        settings.friction.static_force =
            settings.friction.coulomb * random.between(0.9, 3.0).max(1.0);
        settings.friction.stribeck = random.between(1e-3, 100.0);
        settings.friction.presliding = random.between(1e-12, 10.0);
        settings.viscous = random.between(1e-3, 1e3);
        if random.next() > 0.5 {
            settings.force_limit = random.between(1.0, 1e6);
        }
        settings.feedforward.acceleration = random.next();
        settings.feedforward.friction = random.next() > 0.5;
        if random.next() > 0.5 {
            settings.modes = vec![mode(
                random.between(0.5, 2000.0),
                random.next(),
                random.next(),
            )];
        }
        let Ok(model) = DriveModel::new(&settings) else {
            continue;
        };
        accepted += 1;
        let mut drive = Drive::new(&model, 0.0);
        let pace = random.between(0.1, 1000.0);
        for k in 0..200 {
            let time = f64::from(k) * settings.servo_period;
            drive.tick(pace * time * (1.0 - time).max(0.0));
            let whole = drive.position() + drive.velocity() + drive.command() + drive.friction();
            assert!(whole.is_finite(), "case {case}: {settings:?}");
        }
    }
    assert!(count < 400 || accepted * 8 > count, "{accepted} of {count}");
}

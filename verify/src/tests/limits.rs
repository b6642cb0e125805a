//! Motion beyond a limit, and motion that jumps: axis, value and time.

use super::build::{limits, line, path, stop_and_go};
use crate::{Place, Violation, verify};
use toolglide_kinematics::{
    Feedrate, Limits, Move, MoveRange, Piece, Plan, Sample, Trajectory, Vector,
};

#[test]
fn too_fast_an_axis_is_named() {
    let path = path(&[line([10.0, 0.0]).with_exact_stop(), line([10.0, 60.0])]);
    let fast = Limits::uniform(100.0, 2_000.0, 50_000.0).unwrap();
    let slow = Limits::new([
        toolglide_kinematics::AxisLimits::new(100.0, 2_000.0, 50_000.0).unwrap(),
        toolglide_kinematics::AxisLimits::new(90.0, 2_000.0, 50_000.0).unwrap(),
    ]);
    let report = verify(&stop_and_go(&path, &fast), &path, &slow);
    for violation in &report.examples {
        let Violation::Velocity {
            axis, value, place, ..
        } = violation
        else {
            panic!("{violation}");
        };
        assert_eq!(
            (*axis, *place),
            (1, Place { mv: 1, line: 11 }),
            "{violation}"
        );
        assert!(*value > 90.0 && *value < 100.0 + 1e-9, "{violation}");
    }
    assert!((report.peak_velocity[1].value - 100.0).abs() < 1e-9, "peak");
}

#[test]
fn velocity_inside_a_piece_is_seen_although_both_ends_are_legal() {
    let path = path(&[line([10.0, 0.0])]);
    // Velocity rises from 80 by 100 t - 1000 t^2/2: 85 at 0.1 s, 80 again at 0.2 s.
    let limits = Limits::uniform(84.0, 2_000.0, 50_000.0).unwrap();
    let start = Sample {
        position: Vector::<2>::zeros(),
        velocity: Vector::<2>::new(80.0, 0.0),
        acceleration: Vector::<2>::new(100.0, 0.0),
        jerk: Vector::<2>::new(-1_000.0, 0.0),
    };
    let mut plan = Plan::starting_at(path.start());
    plan.push(Piece::new(
        &start,
        0.2,
        Vector::<2>::new(80.0 * 0.2 + 50.0 * 0.04 - 1_000.0 * 0.008 / 6.0, 0.0),
        MoveRange { first: 0, last: 0 },
    ));
    let report = verify(&plan, &path, &limits);
    let seen = report
        .examples
        .iter()
        .find(|violation| matches!(violation, Violation::Velocity { .. }));
    let Some(Violation::Velocity { value, time, .. }) = seen else {
        panic!("{:?}", report.examples);
    };
    assert!(
        (value - 85.0).abs() < 1e-12 && (time - 0.1).abs() < 1e-12,
        "{value} {time}"
    );
    assert!((report.peak_speed.value - 85.0).abs() < 1e-9, "speed");
}

#[test]
fn acceleration_between_legal_samples_is_seen() {
    let path = path(&[line([10.0, 0.0])]);
    let harder = Limits::uniform(200.0, 2_100.0, 50_000.0).unwrap();
    let report = verify(&stop_and_go(&path, &harder), &path, &limits());
    assert!(
        (report.peak_acceleration[0].value - 2_100.0).abs() < 1e-6,
        "peak"
    );
    let Violation::Acceleration {
        axis: 0,
        time,
        value,
        limit,
        ..
    } = report.examples[0]
    else {
        panic!("{:?}", report.examples);
    };
    assert!((time - 0.042).abs() < 1e-9, "{time}");
    assert!(
        (value - 2_100.0).abs() < 1e-6 && (limit - 2_000.0).abs() < 1e-9,
        "{value}"
    );
    assert!(
        report
            .examples
            .iter()
            .all(|v| matches!(v, Violation::Acceleration { .. })),
        "{:?}",
        report.examples
    );
}

#[test]
fn jerk_above_its_limit_is_seen() {
    let path = path(&[line([10.0, 0.0])]);
    let harder = Limits::uniform(200.0, 2_000.0, 50_001.0).unwrap();
    let report = verify(&stop_and_go(&path, &harder), &path, &limits());
    assert_eq!(report.violations, 4, "{:?}", report.examples);
    assert!((report.peak_jerk[0].value - 50_001.0).abs() < 1e-6, "peak");
    assert_eq!(
        report.examples[0]
            .to_string()
            .split(" mm/s³ exceeds")
            .nth(1),
        Some(" the limit of 50000 mm/s³ at 0.000 s (move 0, line 10)"),
        "{}",
        report.examples[0]
    );
}

#[test]
fn the_feedrate_is_a_bound_of_its_own() {
    let path = path(&[line([10.0, 10.0])]);
    let mut faster = path.clone();
    faster = {
        let feedrate = Feedrate::new(100.5).unwrap();
        let tolerance = faster.moves()[0].tolerance();
        super::build::path(&[
            Move::line_to(Vector::<2>::new(10.0, 10.0), feedrate, tolerance).unwrap(),
        ])
    };
    let report = verify(&stop_and_go(&faster, &limits()), &path, &limits());
    assert!(
        report
            .examples
            .iter()
            .all(|v| matches!(v, Violation::Feedrate { .. }))
            && !report.passes(),
        "{:?}",
        report.examples
    );
    assert!(
        (report.feedrate_overshoot.value - 0.5).abs() < 1e-9,
        "{:?}",
        report.feedrate_overshoot
    );
}

#[test]
fn jumps_are_measured() {
    let path = path(&[line([10.0, 0.0])]);
    let clean = stop_and_go(&path, &limits());
    for (kind, bump) in [(0, 1e-6), (1, 1e-3), (2, 1e-2)] {
        let mut plan = Plan::starting_at(path.start());
        let mut knot = 0.0;
        for (index, piece) in clean.pieces().iter().enumerate() {
            let mut state = piece.at(0.0);
            if index == 3 {
                knot = plan.duration();
                let moved = Vector::<2>::new(bump, 0.0);
                match kind {
                    0 => state.position += moved,
                    1 => state.velocity -= moved,
                    _ => state.acceleration -= moved,
                }
            }
            plan.push(Piece::new(
                &state,
                piece.duration(),
                piece.end(),
                piece.serves(),
            ));
        }
        let report = verify(&plan, &path, &limits());
        let peak = match kind {
            0 => report.position_jump,
            1 => report.velocity_jump,
            _ => report.acceleration_jump,
        };
        assert!((peak.value / bump - 1.0).abs() < 0.02, "{kind}: {peak:?}");
        assert!(!report.passes(), "{kind}");
        let at_knot = report.examples.iter().any(|violation| match violation {
            Violation::PositionJump { time, .. } => kind == 0 && (time - knot).abs() < 1e-12,
            Violation::VelocityJump { axis: 0, time, .. } => {
                kind == 1 && (time - knot).abs() < 1e-12
            }
            Violation::AccelerationJump { axis: 0, time, .. } => {
                kind == 2 && (time - knot).abs() < 1e-12
            }
            _ => false,
        });
        assert!(at_knot, "{kind}: {:?}", report.examples);
    }
}

//! Corner blends of every kind, at random corners: they keep the limits and the tolerance of the corner, at
//! every scale, and their pieces meet.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use std::sync::Arc;
use toolglide_fir::PulseCorner;
use toolglide_kinematics::{
    AxisLimits, Corner, Feedrate, Limits, MoveRange, Piece, Plan, Tolerance, Toolpath, Trajectory,
    Vector,
};
use toolglide_profiles::{BlendError, BlendPhase, BlendShape, Blender, MAX_PHASES, Part};
use toolglide_smoothing::{
    Interrupted, KinematicSmoothing, Method, Settings, StopStart, Uninterrupted,
};
use toolglide_verify::verify;

/// Room for rounding, relative.
const ROUNDING: f64 = 1e-8;

fn blenders<const N: usize>(limits: Limits<N>, feedrate: f64) -> Vec<Arc<dyn Blender<N>>> {
    let mut blenders = Settings::new(limits).blenders();
    blenders.push(Arc::new(PulseCorner::designed(limits, feedrate)));
    blenders
}

fn pieces<const N: usize>(shape: &BlendShape, corner: &Corner<N>, part: Part) -> Vec<Piece<N>> {
    let mut pieces = Vec::new();
    shape.unroll(corner, part, MoveRange::one(0), |piece| pieces.push(piece));
    pieces
}

/// Checks one blend at one scale against everything that it must keep.
fn check<const N: usize>(shape: &BlendShape, corner: &Corner<N>, limits: &Limits<N>, scale: f64) {
    let shape = shape.scaled(scale);
    let all = pieces(&shape, corner, Part::Whole);
    let begin = corner.point - corner.incoming * shape.entry.distance;
    let end = corner.point + corner.outgoing * shape.exit.distance;
    let mut position = begin;
    let mut velocity = corner.incoming * shape.entry.speed;
    let mut nearest = f64::INFINITY;
    let mut time = 0.0;
    let within = |value: f64, bound: f64| value.abs() <= bound * (1.0 + ROUNDING) + ROUNDING;
    for piece in &all {
        let start = piece.at(0.0);
        let length = 1.0 + shape.entry.distance + shape.exit.distance;
        assert!(
            (start.position - position).norm() <= 1e-9 * length,
            "{shape:?} leaves a gap"
        );
        assert!(
            (start.velocity - velocity).norm() <= 1e-7 * (1.0 + velocity.norm()),
            "{shape:?} jumps"
        );
        for step in 0..=50 {
            let state = piece.at(piece.duration() * f64::from(step) / 50.0);
            nearest = nearest.min((state.position - corner.point).norm());
            for axis in 0..N {
                assert!(
                    within(state.velocity[axis], limits.velocity()[axis]),
                    "velocity {state:?} of {shape:?}"
                );
                assert!(
                    within(state.acceleration[axis], limits.acceleration()[axis]),
                    "acceleration {state:?} of {shape:?}"
                );
                assert!(
                    within(state.jerk[axis], limits.jerk()[axis]),
                    "jerk {state:?} of {shape:?}"
                );
            }
        }
        let last = piece.at(piece.duration());
        (position, velocity) = (last.position, last.velocity);
        time += piece.duration();
    }
    if !all.is_empty() {
        assert!(
            (position - end).norm() <= 1e-9 * (1.0 + end.norm()),
            "{shape:?} misses its end"
        );
        assert!(
            (time - shape.duration).abs() <= 1e-12 + 1e-9 * time,
            "{shape:?} lasts {time}"
        );
    }
    let error = shape.corner_error(corner);
    assert!(
        error <= corner.tolerance.length() * (1.0 + ROUNDING),
        "{error} mm of {shape:?} at {corner:?}"
    );
    assert!(
        nearest >= error - 1e-6 * corner.tolerance.length(),
        "{nearest} by points, {error} by formula: {shape:?}"
    );
    assert!(
        shape.entry.speed <= corner.speed_in * (1.0 + ROUNDING),
        "{shape:?} at {corner:?}"
    );
    assert!(
        shape.exit.speed <= corner.speed_out * (1.0 + ROUNDING),
        "{shape:?} at {corner:?}"
    );
    let halves = [Part::FirstHalf, Part::SecondHalf].map(|part| pieces(&shape, corner, part));
    let halved: f64 = halves.iter().flatten().map(Piece::duration).sum();
    assert!(
        (halved - time).abs() <= 1e-12 + 1e-9 * time,
        "two halves are {halved} of {time}"
    );
}

fn corners<const N: usize>(
    values: [f64; 4],
    axes: [f64; 4],
    limits: [[f64; 3]; 4],
) -> (Corner<N>, Limits<N>) {
    let [turn, feedrate, after, tolerance] = values;
    let incoming = Vector::<N>::from_fn(|axis, _| axes[axis] - 0.5).normalize();
    let other = Vector::<N>::from_fn(|axis, _| if axis % 2 == 0 { axes[3 - axis] } else { -axes[3 - axis] } + 0.1);
    let across = (other - incoming * other.dot(&incoming)).normalize();
    let corner = Corner {
        point: Vector::zeros(),
        incoming,
        outgoing: incoming * turn.cos() + across * turn.sin(),
        speed_in: feedrate,
        speed_out: feedrate * after,
        tolerance: Tolerance::new(tolerance).unwrap(),
    };
    let limits = std::array::from_fn(|axis| {
        let [velocity, acceleration, ratio] = limits[axis];
        AxisLimits::new(velocity, acceleration, acceleration * ratio).unwrap()
    });
    (corner, Limits::new(limits))
}

fn keeps_everything<const N: usize>(
    values: [f64; 4],
    axes: [f64; 4],
    bounds: [[f64; 3]; 4],
    scale: f64,
) {
    let (mut corner, limits) = corners::<N>(values, axes, bounds);
    // A corner is asked for at speeds that its moves can have.
    corner.speed_in = corner.speed_in.min(limits.along(&corner.incoming).velocity);
    corner.speed_out = corner
        .speed_out
        .min(limits.along(&corner.outgoing).velocity);
    let mut count = 0;
    for (before, after) in [(1.0, 2.0), (2.0, 1.0)] {
        for blender in blenders(limits, corner.speed_in) {
            match blender.blend(&corner, before, after) {
                Ok(shape) => {
                    count += 1;
                    // The planner scales down what is too fast.
                    let most = (corner.speed_in / shape.entry.speed)
                        .min(corner.speed_out / shape.exit.speed)
                        .sqrt();
                    let shape = shape.scaled(most.min(1.0));
                    for scale in [1.0, scale, 0.0] {
                        check(&shape, &corner, &limits, scale);
                    }
                }
                Err(BlendError::Impossible { .. }) => {}
                Err(error) => panic!("{error} of {blender:?} at {corner:?}"),
            }
        }
    }
    // Interrupted, uninterrupted, two of the unequal ones and the pulses always have a motion.
    assert!(count >= 10, "{count} blends at {corner:?}");
}

fn turns() -> impl Strategy<Value = f64> {
    prop_oneof![
        1e-6..1e-2_f64,
        0.01..3.1_f64,
        (1e-6..1e-2_f64).prop_map(|less| std::f64::consts::PI - less),
    ]
}

proptest! {
    #[test]
    fn every_blend_keeps_limits_and_tolerance_at_every_scale(
        turn in turns(), feedrate in 1.0..300.0_f64, after in 0.3..3.0_f64, tolerance in 0.001..0.5_f64,
        axes in prop::array::uniform4(0.0..1.0_f64), scale in 0.0..1.0_f64,
        bounds in prop::array::uniform4((50.0..800.0_f64, 500.0..10_000.0_f64, 10.0..300.0_f64)),
    ) {
        let values = [turn, feedrate, after, tolerance];
        let bounds = bounds.map(|(velocity, acceleration, ratio)| [velocity, acceleration, ratio]);
        keeps_everything::<2>(values, axes, bounds, scale);
        keeps_everything::<3>(values, axes, bounds, scale);
        keeps_everything::<4>(values, axes, bounds, scale);
    }
}

/// A right angle that is planned at 10 um.
fn right_angle() -> (Toolpath<2>, Limits<2>) {
    let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
    let path = Toolpath::from_points(
        &points,
        Feedrate::new(50.0).unwrap(),
        Tolerance::new(0.01).unwrap(),
    )
    .unwrap();
    (path, Limits::uniform(500.0, 2500.0, 2e5).unwrap())
}

#[test]
fn filtered_pulses_turn_the_corners_of_kinematic_smoothing() {
    let (path, limits) = right_angle();
    let settings = Settings::new(limits).with_method(Method::KcsInterrupted);
    let pulses: Arc<dyn Blender<2>> = Arc::new(PulseCorner::designed(limits, 50.0));
    let mut planner =
        KinematicSmoothing::with_blenders(path.start(), &settings, vec![Arc::clone(&pulses)]);
    let plan = Plan::of(&path, &mut planner).unwrap();
    let report = verify(&plan, &path, &limits);
    assert!(report.passes(), "{:?}", report.examples);
    assert!(
        (report.corner_error.value - 0.01).abs() < 1e-9,
        "{}",
        report.corner_error.value
    );
    // Among all corners they lose nothing.
    let mut blenders = settings.with_method(Method::Kcs).blenders();
    blenders.push(pulses);
    let settings = Settings::new(limits);
    let alone = toolglide_smoothing::plan(&path, &settings)
        .unwrap()
        .duration();
    let mut planner = KinematicSmoothing::with_blenders(path.start(), &settings, blenders);
    let together = Plan::of(&path, &mut planner).unwrap().duration();
    assert!(together <= alone, "{together} {alone}");
}

#[test]
fn the_blenders_of_a_method_plan_what_the_method_plans() {
    let (path, limits) = right_angle();
    for method in [
        Method::Kcs,
        Method::KcsUninterrupted,
        Method::KcsInterrupted,
        Method::ExactStop,
    ] {
        let settings = Settings::new(limits).with_method(method);
        let own = toolglide_smoothing::plan(&path, &settings).unwrap();
        let mut planner =
            KinematicSmoothing::with_blenders(path.start(), &settings, settings.blenders());
        assert_eq!(
            Plan::of(&path, &mut planner).unwrap().pieces(),
            own.pieces(),
            "{}",
            method.name()
        );
    }
}

#[test]
fn a_corner_that_no_blender_turns_is_a_stop() {
    let (path, limits) = right_angle();
    let settings = Settings::new(limits).with_method(Method::KcsInterrupted);
    let mut planner = KinematicSmoothing::with_blenders(path.start(), &settings, Vec::new());
    let stopping = Plan::of(&path, &mut planner).unwrap();
    let exact =
        toolglide_smoothing::plan(&path, &Settings::new(limits).with_method(Method::ExactStop))
            .unwrap();
    assert!(
        (stopping.duration() - exact.duration()).abs() < 1e-9,
        "{}",
        stopping.duration()
    );
}

#[test]
fn phases_that_are_no_motion_are_refused() {
    let phase = BlendPhase {
        duration: 0.01,
        jerk_in: 1e5,
        jerk_out: 1e5,
    };
    assert!(matches!(
        BlendShape::of_phases(&[phase; MAX_PHASES + 1]),
        Err(BlendError::TooManyPhases { count: 9 })
    ));
    for wrong in [
        BlendPhase {
            duration: -1.0,
            ..phase
        },
        BlendPhase {
            jerk_in: f64::NAN,
            ..phase
        },
        BlendPhase {
            jerk_out: -1e5,
            ..phase
        },
    ] {
        assert!(
            matches!(
                BlendShape::of_phases(&[wrong]),
                Err(BlendError::NoMotion { .. })
            ),
            "{wrong:?}"
        );
    }
    let shape = BlendShape::of_phases(&[phase]).unwrap();
    let closed = BlendShape::between(shape.entry, shape.exit, shape.duration, &[phase]);
    assert_eq!(closed, Ok(shape));
    let mut exit = shape.exit;
    exit.speed *= 1.001;
    assert!(
        matches!(
            BlendShape::between(shape.entry, exit, shape.duration, &[phase]),
            Err(BlendError::NotClosed {
                quantity: "speed",
                ..
            })
        ),
        "a boundary beside the phases"
    );
}

#[test]
fn the_blends_of_a_right_angle_are_those_of_the_text() {
    let corner = Corner {
        point: Vector::<2>::zeros(),
        incoming: Vector::<2>::x(),
        outgoing: Vector::<2>::y(),
        speed_in: 100.0,
        speed_out: 100.0,
        tolerance: Tolerance::new(0.1).unwrap(),
    };
    let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
    let blends: [(&dyn Blender<2>, f64, usize); 3] = [
        (&Interrupted::new(limits), 32.995, 3),
        (&Uninterrupted::new(limits), 46.058, 1),
        (&StopStart::new(limits), 48.620, 3),
    ];
    for (blender, speed, phases) in blends {
        let shape = blender.blend(&corner, 10.0, 10.0).unwrap();
        assert!((shape.entry.speed - speed).abs() < 1e-3, "{shape:?}");
        assert_eq!(shape.phases().len(), phases, "{shape:?}");
        assert!(
            (shape.corner_error(&corner) - 0.1).abs() < 1e-9,
            "{shape:?}"
        );
    }
}

#[test]
fn an_exact_reversal_at_unequal_speeds_is_blended_by_every_kind() {
    let limits = Limits::<3>::uniform(500.0, 2500.0, 2e5).unwrap();
    let corner = Corner {
        point: Vector::<3>::new(10.0, 10.0, -4.0),
        incoming: -Vector::<3>::z(),
        outgoing: Vector::<3>::z(),
        speed_in: 15.0,
        speed_out: 500.0,
        tolerance: Tolerance::new(0.02).unwrap(),
    };
    for blender in blenders(limits, 15.0) {
        match blender.blend(&corner, 1.0, 2.0) {
            Ok(shape) => check(&shape, &corner, &limits, 0.5),
            Err(BlendError::Impossible { .. }) => {}
            Err(error) => panic!("{error} of {blender:?}"),
        }
    }
}

//! Measures of hand-made motions in closed form.

use super::build::limits;
use crate::Judge;
use toolglide_kinematics::{
    AxisMode, AxisModes, Feedrate, Mode, Move, MoveRange, Piece, Sample, Tolerance, Vector,
};

/// From rest to rest along x with the jerk reversed twice, four pieces of a duration.
fn judge(jerk: f64, duration: f64, frequency: f64) -> crate::Smoothness<1> {
    let length = 2.0 * jerk * duration.powi(3);
    let mode = Mode::new(frequency, 0.0).unwrap();
    let modes = AxisModes::new(&[AxisMode { axis: 0, mode }]).unwrap();
    let mut judge = Judge::new(Vector::<1>::zeros(), limits::<1>()).with_modes(&modes, false);
    let (feedrate, tolerance) = (Feedrate::new(200.0).unwrap(), Tolerance::new(0.01).unwrap());
    judge
        .expect(&Move::line_to(Vector::<1>::new(length), feedrate, tolerance).unwrap())
        .unwrap();
    let (mut position, mut velocity, mut acceleration) = (0.0, 0.0, 0.0);
    for sign in [1.0, -1.0, -1.0, 1.0] {
        let j = sign * jerk;
        let start = Sample {
            position: Vector::<1>::new(position),
            velocity: Vector::<1>::new(velocity),
            acceleration: Vector::<1>::new(acceleration),
            jerk: Vector::<1>::new(j),
        };
        let h = duration;
        position += (velocity + (0.5 * acceleration + j * h / 6.0) * h) * h;
        velocity += (acceleration + 0.5 * j * h) * h;
        acceleration += j * h;
        let end = Vector::<1>::new(position);
        judge.observe(&Piece::new(&start, h, end, MoveRange::one(0)));
    }
    let report = judge.finish();
    assert!(report.passes(), "{:#?}", report.examples);
    report.smoothness.unwrap()
}

#[test]
fn the_energy_of_jerk_is_its_square_times_the_duration() {
    let found = judge(4e4, 0.03, 25.0);
    let expected = 4e4_f64.powi(2) * 0.12;
    assert!(
        (found.jerk_energy / expected - 1.0).abs() < 1e-12,
        "{found:?}"
    );
    assert!((found.rms_jerk / 4e4 - 1.0).abs() < 1e-12, "{found:?}");
    assert!(found.rms_offset < 1e-9 && found.outside < 1e-9, "{found:?}");
}

#[test]
fn a_mode_whose_period_is_one_piece_is_left_at_rest_and_others_are_not() {
    // The spectrum of such a motion has a zero where a piece is one period.
    let quiet = judge(4e4, 0.04, 25.0);
    assert!(quiet.modes[0].left < 1e-9, "{quiet:?}");
    assert!(quiet.modes[0].left_worst > 5e-4, "{quiet:?}");
    assert!(quiet.modes[0].peak > 0.5 * quiet.modes[0].bend, "{quiet:?}");
    let loud = judge(4e4, 0.04, 17.0);
    assert!(loud.modes[0].left > 1e-3, "{loud:?}");
}

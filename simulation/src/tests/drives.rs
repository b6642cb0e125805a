//! Tests one drive: errors of ramps and jerks, responses, modes, gains.

use super::{mode, model, rigid};
use crate::linear::{self, c64};
use crate::*;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

const PERIOD: f64 = 1e-4;

fn gains(position: f64, velocity: f64, integral: f64) -> Gains {
    Gains {
        position,
        velocity,
        integral,
    }
}

#[test]
fn a_ramp_is_followed_at_the_feedrate_over_the_position_gain() {
    for integral in [0.0, 1e5] {
        let mut drive = Drive::new(&model(&rigid(gains(50.0, 400.0, integral))), 0.0);
        let feedrate = 100.0;
        let mut ramp = 0.0;
        for k in 0..30_000 {
            ramp = feedrate * f64::from(k) * PERIOD;
            drive.tick(ramp);
        }
        // A tick leaves the state one period later than its set-point.
        let lag = ramp + feedrate * PERIOD - drive.position();
        assert!((lag - feedrate / 50.0).abs() < 1e-6, "{integral}: {lag}");
    }
}

#[test]
fn with_velocity_feedforward_the_error_is_jerk_over_the_product_of_gains() {
    let mut settings = rigid(gains(100.0, 600.0, 9e4));
    settings.feedforward = Feedforward::VELOCITY;
    let mut drive = Drive::new(&model(&settings), 0.0);
    let (jerk, mut lag) = (1e4_f64, 0.0);
    for k in 0..20_000 {
        let time = f64::from(k) * PERIOD;
        let point = jerk * time.powi(3) / 6.0;
        lag = point - drive.position();
        // What sampling and the current loop delay of the acceleration is no part of the formula.
        drive.tick(point);
    }
    let expected = jerk / (9e4 * 100.0);
    assert!((lag / expected - 1.0).abs() < 0.05, "{lag} {expected}");
}

fn flexible() -> DriveSettings {
    DriveSettings {
        gains: GainSettings::Direct(Gains::scaled(60.0, 3.0, 1.0)),
        feedforward: Feedforward::NONE,
        current_loop: 500.0,
        velocity_filter: Some(400.0),
        dead_time: 1.37e-4,
        viscous: 5.0,
        modes: vec![mode(40.0, 0.02, 0.1)],
        ..rigid(Gains::default())
    }
}

#[test]
fn a_steady_sine_has_the_amplitude_of_the_sampled_response_to_nine_digits() {
    let model = model(&flexible());
    let (a, b) = model.loop_matrices();
    for hertz in [2.0, 10.0, 25.0, 50.0, 400.0] {
        let angle = TAU * hertz * PERIOD;
        let z = c64::new(angle.cos(), angle.sin());
        let expected = linear::resolvent(&a, &b, z)[(0, 0)];
        let mut drive = Drive::new(&model, 0.0);
        let (mut re, mut im, count) = (0.0, 0.0, 10_000_u32);
        for k in 0..60_000 + count {
            let turn = f64::from(k) * angle;
            if k >= 60_000 {
                re += drive.position() * turn.sin();
                im += drive.position() * turn.cos();
            }
            drive.tick(turn.sin());
        }
        let found = c64::new(2.0 * re / f64::from(count), 2.0 * im / f64::from(count));
        let off = (found - expected).norm() / expected.norm().max(1e-3);
        assert!(off < 1e-9, "{hertz} Hz: {off:e}");
        let [re, im] = model.position_response(hertz);
        let off = (c64::new(re, im) - expected).norm() / expected.norm();
        assert!(off < 1e-9, "difference equations, {hertz} Hz: {off:e}");
    }
}

#[test]
fn a_free_mode_decays_by_its_damping() {
    let mut settings = rigid(Gains::scaled(20.0, 1.5, 1.0));
    settings.modes = vec![mode(7.4, 0.01, 0.0)];
    let mut drive = Drive::new(&model(&settings), 0.0);
    drive.set_loop_state(3, 1.0);
    for _ in 0..10_000 {
        drive.advance(0.0, 0.0);
    }
    let natural = TAU * 7.4;
    let damped = natural * (1.0_f64 - 1e-4).sqrt();
    let expected =
        (-0.01 * natural).exp() * (damped.cos() + 0.01 * natural / damped * damped.sin());
    let [found, velocity] = drive.mode(0);
    assert!((found - expected).abs() < 1e-10, "{found} {expected}");
    let amplitude = settings.modes[0].amplitude(found, velocity);
    let expected = (-0.01 * natural).exp() * settings.modes[0].amplitude(1.0, 0.0);
    assert!(
        (amplitude - expected).abs() < 1e-10,
        "{amplitude} {expected}"
    );
}

#[test]
fn a_fraction_of_a_period_of_dead_time_is_between_whole_ones() {
    let at = |dead_time| {
        let mut settings = flexible();
        settings.dead_time = dead_time;
        let [re, im] = model(&settings).position_response(60.0);
        im.atan2(re)
    };
    let (none, half, one) = (at(1e-4), at(1.5e-4), at(2e-4));
    assert!(
        (half - 0.5 * (none + one)).abs() < 2e-4,
        "{none} {half} {one}"
    );
    assert!(none > one + 1e-3, "a longer dead time is later");
}

#[test]
fn a_bandwidth_is_where_the_response_falls_to_its_root() {
    for (hertz, position) in [(35.0, 111.3), (50.0, 0.0)] {
        let model = model(&DriveSettings::textbook(hertz));
        let response = model.response(hertz, None).plain;
        assert!((response - FRAC_1_SQRT_2).abs() < 1e-9, "{response}");
        let found = model.gains().position;
        assert!(
            position < 1.0 || (found / position - 1.0).abs() < 1e-3,
            "{found}"
        );
        let bandwidth = model.report().bandwidth;
        assert!((bandwidth / hertz - 1.0).abs() < 1e-3, "{bandwidth}");
        assert!(!model.report().is_lively(), "{:?}", model.report());
    }
}

#[test]
fn a_scale_at_the_table_sees_the_mode_and_the_loop_frequency_lies_between() {
    let mut settings = DriveSettings::textbook(20.0).without_friction();
    settings.modes = vec![mode(60.0, 0.02, 0.3)];
    let found = model(&settings).closed_loop_modes();
    let near = found
        .iter()
        .find(|[frequency, _]| (55.0..80.0).contains(frequency));
    assert!(near.is_some(), "{found:?}");
}

#[test]
fn the_zero_phase_filter_follows_a_sweep_many_times_better() {
    let largest = |feedforward| {
        let mut settings = DriveSettings::textbook(35.0).without_friction();
        settings.encoder_step = 0.0;
        settings.feedforward = feedforward;
        let axis = DrivenAxis {
            name: 'X',
            model: model(&settings),
            coordinate: None,
        };
        super::motions::one_axis(&axis, |t| (1.0 - (TAU * 3.0 * t).cos()).powi(3), 1.0).axes[0]
            .tracking
            .largest
    };
    let plain = largest(Feedforward::VELOCITY);
    let shaped = largest(Feedforward {
        zero_phase: true,
        ..Feedforward::NONE
    });
    assert!(shaped < 0.05 * plain, "{shaped} {plain}");
}

#[test]
fn halving_the_servo_period_converges_with_order_one_or_better() {
    let step = |period: f64| {
        let mut settings = rigid(gains(60.0, 300.0, 2e4));
        settings.servo_period = period;
        settings.friction = Friction {
            coulomb: 300.0,
            static_force: 300.0,
            stribeck: 1.0,
            presliding: 0.01,
        };
        let mut drive = Drive::new(&model(&settings), 0.0);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a test"
        )]
        let count = (0.2 / period).round() as u32;
        for k in 0..count {
            let time = f64::from(k) * period;
            drive.tick(5.0 * (1.0 - (TAU * 2.0 * time).cos()));
        }
        drive.position()
    };
    let exact = step(6.25e-6);
    let coarse = (step(4e-4) - exact).abs();
    let middle = (step(2e-4) - exact).abs();
    let fine = (step(1e-4) - exact).abs();
    assert!(
        coarse > 1.9 * middle && middle > 1.9 * fine,
        "{coarse} {middle} {fine}"
    );
}

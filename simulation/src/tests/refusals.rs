//! Tests that a drive that cannot be is refused with field, value and bound.

use super::mode;
use crate::*;

fn refused(change: impl FnOnce(&mut DriveSettings)) -> DriveError {
    let mut settings = DriveSettings::textbook(35.0);
    change(&mut settings);
    DriveModel::new(&settings).unwrap_err()
}

#[test]
fn every_field_is_checked() {
    type Change = fn(&mut DriveSettings);
    let cases: [(&str, Change); 22] = [
        ("servo_period_s", |s| s.servo_period = f64::NAN),
        ("servo_period_s", |s| s.servo_period = 0.0),
        ("dead_time_s", |s| s.dead_time = -1e-4),
        ("dead_time_s", |s| s.dead_time = 2.1e-3),
        ("velocity_filter_hz", |s| s.velocity_filter = Some(0.0)),
        ("encoder", |s| s.encoder_step = 1.5),
        ("friction: coulomb", |s| s.friction.coulomb = f64::INFINITY),
        ("friction: static", |s| s.friction.static_force = 300.0),
        ("friction: stribeck", |s| s.friction.stribeck = 0.0),
        ("friction: presliding", |s| s.friction.presliding = -1.0),
        ("friction: viscous", |s| s.viscous = -1.0),
        ("force_limit", |s| s.force_limit = 500.0),
        ("force_limit", |s| s.force_limit = f64::NAN),
        ("current_loop_hz", |s| s.current_loop = 0.0),
        ("feedforward: velocity", |s| s.feedforward.velocity = 3.0),
        ("backlash", |s| s.backlash = 0.01),
        ("mode: frequency_hz", |s| {
            s.modes = vec![mode(5000.0, 0.0, 0.0)]
        }),
        ("mode: damping", |s| s.modes = vec![mode(10.0, 1.0, 0.0)]),
        ("mode: mass_share", |s| s.modes = vec![mode(10.0, 0.0, 1.0)]),
        ("mode: mass_share, the sum of all", |s| {
            s.modes = vec![mode(10.0, 0.1, 0.6), mode(20.0, 0.1, 0.6)];
        }),
        ("mode", |s| s.modes = vec![mode(10.0, 0.1, 0.0); 5]),
        ("bandwidth_hz", |s| {
            s.gains = GainSettings::Bandwidth {
                frequency: 6000.0,
                velocity_ratio: 1.5,
                velocity_damping: 1.0,
            };
        }),
    ];
    for (field, change) in cases {
        let error = refused(change);
        assert_eq!(error.field, field, "{error}");
        assert!(
            !error.value.is_empty() && !error.bound.is_empty(),
            "{error}"
        );
    }
}

#[test]
fn an_unstable_loop_is_refused_with_its_radius_and_what_would_be_stable() {
    let error = refused(|settings| {
        settings.servo_period = 1e-3;
        settings.dead_time = 1e-3;
        settings.gains = GainSettings::Direct(Gains::scaled(100.0, 3.0, 1.0));
    });
    assert_eq!(error.field, "gains", "{error}");
    let text = error.to_string();
    assert!(text.contains("radius 1."), "{text}");
    let limit: f64 = text
        .split("at most ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .and_then(|number| number.parse().ok())
        .unwrap();
    let mut settings = DriveSettings::textbook(35.0);
    settings.servo_period = 1e-3;
    settings.dead_time = 1e-3;
    let velocity = std::f64::consts::TAU * limit * 0.98;
    let scale = velocity / 600.0;
    settings.gains = GainSettings::Direct(Gains {
        position: 100.0 * scale,
        velocity,
        integral: (300.0 * scale).powi(2),
    });
    assert!(DriveModel::new(&settings).is_ok(), "{text}");
}

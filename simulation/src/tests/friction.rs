//! Tests friction: sticking, sliding, halting, energy, rest.

use super::{model, rigid};
use crate::friction::Slip;
use crate::*;

fn sliding(friction: Friction) -> Drive {
    let mut settings = rigid(Gains::scaled(20.0, 1.5, 1.0));
    settings.friction = friction;
    settings.current_loop = 1.6e3;
    Drive::new(&model(&settings), 0.0)
}

#[test]
fn an_axis_sticks_below_the_static_force_and_slides_above_it() {
    for presliding in [0.01, 1e-4, 1e-6, 0.0] {
        let mut drive = sliding(Friction {
            coulomb: 400.0,
            static_force: 500.0,
            stribeck: 5.0,
            presliding,
        });
        for k in 0..20_000 {
            let force = 490.0 * (f64::from(k) / 10_000.0).min(1.0);
            drive.advance(force, force);
        }
        let rest = drive.position();
        assert!(drive.velocity().abs() < 1e-6, "sticks, {presliding}");
        assert!(rest <= 0.525 * presliding + 1e-5, "{presliding}: {rest}");
        for _ in 0..20_000 {
            drive.advance(490.0, 490.0);
        }
        let crept = drive.position() - rest;
        assert!(crept.abs() < 1e-9, "creeps, {presliding}: {crept}");
        for _ in 0..1000 {
            drive.advance(600.0, 600.0);
        }
        let before = drive.velocity();
        for _ in 0..1000 {
            drive.advance(600.0, 600.0);
        }
        let acceleration = (drive.velocity() - before) / 0.1;
        assert!((acceleration - 200.0).abs() < 0.5, "slides: {acceleration}");
    }
}

#[test]
fn a_thrown_mass_halts_by_coulomb_friction_and_stays() {
    let mut drive = sliding(Friction {
        coulomb: 400.0,
        static_force: 400.0,
        stribeck: 5.0,
        presliding: 1e-6,
    });
    drive.set_loop_state(1, 80.0);
    for _ in 0..5000 {
        drive.advance(0.0, 0.0);
    }
    let way = drive.position();
    assert!((way - 8.0).abs() < 8e-3, "v² / 2 Fc is 8 mm: {way}");
    assert!(drive.velocity().abs() < 1e-9, "{}", drive.velocity());
}

#[test]
fn friction_never_gives_energy_over_a_closed_cycle() {
    let law = Friction {
        coulomb: 400.0,
        static_force: 600.0,
        stribeck: 0.8,
        presliding: 0.02,
    };
    for amplitude in [1e-4, 3e-3, 0.02, 1.0] {
        let mut slip = Slip::new(&law);
        let (mut work, mut cycles, period) = (0.0, Vec::new(), 1e-4);
        for k in 0..40_000_u32 {
            let turn = std::f64::consts::TAU * f64::from(k) / 4000.0;
            let velocity = amplitude * turn.cos() * 15.7;
            // No gain: the velocity is given.
            let force = slip.step(velocity, 0.0, velocity, period);
            work += force * velocity * period;
            if k % 4000 == 3999 {
                cycles.push(work);
            }
        }
        for pair in cycles.windows(2) {
            assert!(pair[1] - pair[0] >= -1e-9, "{amplitude}: {cycles:?}");
        }
        let full = cycles[9] - cycles[8];
        // Far beyond presliding the loss is four times force times amplitude, between Coulomb and static.
        let loss = full / (4.0 * amplitude);
        assert!(amplitude < 0.5 || (390.0..605.0).contains(&loss), "{loss}");
    }
}

#[test]
fn a_plan_at_rest_stays_at_rest_for_ten_seconds() {
    for settings in [
        DriveSettings::textbook(35.0),
        DriveSettings::reference(50.0, 7.125e-4),
    ] {
        let encoder = settings.encoder_step;
        let start = 3.000_23;
        let mut drive = Drive::new(&model(&settings), start);
        let mut off = 0.0_f64;
        for _ in 0..100_000 {
            drive.tick(start);
            off = off.max((drive.position() - start).abs());
        }
        assert!(off < 2.0 * encoder, "{off} {encoder}");
    }
}

#[test]
fn steep_friction_takes_substeps_and_too_steep_friction_is_refused() {
    let law = |stribeck| Friction {
        coulomb: 400.0,
        static_force: 600.0,
        stribeck,
        presliding: 0.01,
    };
    assert_eq!(law(5.0).substeps(1e-4), Ok(1));
    assert_eq!(law(0.02).substeps(1e-4), Ok(2));
    let refused = law(0.002).substeps(1e-4).unwrap_err();
    assert_eq!(refused.field, "friction: stribeck");
}

//! Tests drives and simulations against closed forms.

mod drives;
mod friction;
mod motions;
mod refusals;

use crate::{DriveModel, DriveSettings, Feedforward, FlexibleMode, Friction, GainSettings, Gains};

/// A rigid axis without friction and filters, whose current loop is as fast as may be.
fn rigid(gains: Gains) -> DriveSettings {
    DriveSettings {
        gains: GainSettings::Direct(gains),
        feedforward: Feedforward::NONE,
        current_loop: 1e5,
        dead_time: 0.0,
        velocity_filter: None,
        encoder_step: 0.0,
        friction: Friction::NONE,
        viscous: 0.0,
        ..DriveSettings::textbook(35.0)
    }
}

fn model(settings: &DriveSettings) -> DriveModel {
    DriveModel::new(settings).unwrap()
}

fn mode(frequency: f64, damping: f64, mass_share: f64) -> FlexibleMode {
    FlexibleMode {
        frequency,
        damping,
        mass_share,
        at_encoder: 0.0,
        at_tool: [0.0; 3],
    }
}

//! Tells how smooth a motion is, as JSON names it and in a line for people.
//!
//! Source: the judge's measures; the glossary defines each. Not here: measuring.

use crate::input::setup::Setup;
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::fmt::Write;
use toolglide_verify::{ModeSwing, Smoothness};

/// Micrometres of a millimetre.
const MICROMETRES: f64 = 1e3;

/// Measures of one motion; those with a frequency carry it in their name.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(transparent)]
pub(crate) struct Measures {
    named: Map<String, Value>,
    #[serde(skip)]
    lines: String,
}

impl Measures {
    /// The measures of a report; none where it has none.
    pub(crate) fn of<const N: usize>(found: Option<&Smoothness<N>>, setup: &Setup) -> Self {
        let Some(found) = found else {
            return Self::default();
        };
        let mut named = Map::new();
        let mut put = |name: &str, value: Value| named.insert(name.to_owned(), value);
        put("rms_jerk_mm_s3", json!(found.rms_jerk));
        put(
            "rms_jerk_by_axis_mm_s3",
            json!(found.rms_jerk_by_axis.to_vec()),
        );
        put("jerk_energy_mm2_s5", json!(found.jerk_energy));
        put("jerk_at_limit_share", json!(found.jerk_at_limit));
        let above = format!("acceleration_above_{}_hz", found.high_pass);
        put(&format!("{above}_mm_s2"), json!(found.acceleration_above));
        put(
            &format!("{above}_by_axis_mm_s2"),
            json!(found.acceleration_above_by_axis.to_vec()),
        );
        put(
            "feed_ripple",
            json!({
                "stretches": found.feed_ripple.stretches,
                "rms": found.feed_ripple.rms,
                "worst": found.feed_ripple.worst,
            }),
        );
        put("rms_offset_mm", json!(found.rms_offset));
        put("rms_offset_share", json!(found.rms_offset_share));
        put("outside_mm", json!(found.outside));
        if !found.modes.is_empty() {
            let modes = found.modes.iter().map(|swing| mode(swing, setup));
            put("modes", modes.collect());
        }
        Self {
            named,
            lines: lines(found, setup),
        }
    }

    /// What people are told: a line for jerk, and one for the modes where there are any.
    pub(crate) fn lines(&self) -> &str {
        &self.lines
    }
}

fn mode(swing: &ModeSwing, setup: &Setup) -> Value {
    json!({
        "axis": letter(swing, setup),
        "frequency_hz": swing.mode.frequency(),
        "damping": swing.mode.damping(),
        "bend_um": MICROMETRES * swing.bend,
        "peak_um": MICROMETRES * swing.peak,
        "left_um": MICROMETRES * swing.left,
        "left_worst_um": MICROMETRES * swing.left_worst,
        "ringing_um": MICROMETRES * swing.ringing,
    })
}

fn letter(swing: &ModeSwing, setup: &Setup) -> char {
    setup.axes.get(swing.axis).map_or('?', |axis| axis.name)
}

fn lines<const N: usize>(found: &Smoothness<N>, setup: &Setup) -> String {
    let mut text = format!(
        "smooth       {:.0} mm/s³ rms jerk, {:.1} mm/s² of acceleration above {} Hz, {:.1} µm rms off the path\n",
        found.rms_jerk,
        found.acceleration_above,
        found.high_pass,
        MICROMETRES * found.rms_offset,
    );
    let mut worst: Option<&ModeSwing> = None;
    for swing in &found.modes {
        if worst.is_none_or(|worst| swing.left > worst.left) {
            worst = Some(swing);
        }
    }
    if let Some(swing) = worst {
        let left = MICROMETRES * swing.left;
        let word = if swing.left <= LOUD * swing.bend {
            "quiet"
        } else {
            "swings"
        };
        let _ = writeln!(
            text,
            "{word:<12} {left:.1} µm left at {} Hz on {}, {:.1} µm if that is off by 5 %",
            swing.mode.frequency(),
            letter(swing, setup),
            MICROMETRES * swing.left_worst,
        );
    }
    text
}

/// A mode that is left with more than this share of what full acceleration bends swings on.
const LOUD: f64 = 0.05;

//! Follows a mode of vibration under a motion, and what it would do at other frequencies.
//!
//! Source: section 4.2.2; the oscillator is that of [`Resonator`]. Not here: planning.

use toolglide_kinematics::{AxisMode, Mode, Resonator, Sample};

/// Other frequencies at which the mode is followed too, as shares of its own.
const OTHERS: [f64; 4] = [0.95, 0.975, 1.025, 1.05];

/// Between the ends of pieces a mode is looked at so many times a period.
const LOOKS: f64 = 20.0;

/// How a mode of vibration swings under a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeSwing {
    /// The axis, counted from 0.
    pub axis: usize,
    /// The mode.
    pub mode: Mode,
    /// What the largest acceleration bends at rest, mm.
    pub bend: f64,
    /// Largest deflection, mm.
    pub peak: f64,
    /// Largest amplitude of the free oscillation wherever the motion rests, mm.
    pub left: f64,
    /// The same with a frequency that is wrong by a twentieth at the most.
    pub left_worst: f64,
    /// Root of the mean square of the deflection beyond what the acceleration bends, mm.
    pub ringing: f64,
}

/// A mode under way.
#[derive(Clone, Debug)]
pub(super) struct Swing {
    own: Resonator,
    others: Vec<Resonator>,
    ringing: f64,
    found: ModeSwing,
}

impl Swing {
    /// A mode at rest, on an axis of this largest acceleration.
    pub(super) fn new(mode: &AxisMode, acceleration: f64) -> Self {
        let natural = mode.mode.natural();
        Self {
            own: Resonator::new(&mode.mode),
            others: OTHERS
                .iter()
                .filter_map(|share| mode.mode.detuned(*share).ok())
                .map(|mode| Resonator::new(&mode))
                .collect(),
            ringing: 0.0,
            found: ModeSwing {
                axis: mode.axis,
                mode: mode.mode,
                bend: acceleration / (natural * natural),
                peak: 0.0,
                left: 0.0,
                left_worst: 0.0,
                ringing: 0.0,
            },
        }
    }

    /// Lets a piece pass.
    pub(super) fn pass<const N: usize>(&mut self, start: &Sample<N>, duration: f64) {
        let axis = self.found.axis;
        let (acceleration, jerk) = (start.acceleration[axis], start.jerk[axis]);
        for other in &mut self.others {
            other.pass(acceleration, jerk, duration);
        }
        let natural = self.own.natural();
        let longest = std::f64::consts::TAU / natural / LOOKS;
        let parts = (duration / longest).ceil().clamp(1.0, 1e4);
        let part = duration / parts;
        let mut time = 0.0;
        let mut index = 0.0;
        while index < parts {
            self.own.pass(acceleration + jerk * time, jerk, part);
            index += 1.0;
            time = part * index;
            let bent = (acceleration + jerk * time) / (natural * natural);
            let deflection = self.own.deflection();
            self.found.peak = self.found.peak.max(deflection.abs());
            self.ringing += (deflection + bent).powi(2) * part;
        }
    }

    /// The motion rests.
    pub(super) fn rest(&mut self) {
        self.found.left = self.found.left.max(self.own.displacement());
        for other in self.others.iter().chain([&self.own]) {
            self.found.left_worst = self.found.left_worst.max(other.displacement());
        }
    }

    /// What was found, over the reciprocal of a time.
    pub(super) fn found(&self, by_time: f64) -> ModeSwing {
        ModeSwing {
            ringing: (self.ringing * by_time).sqrt(),
            ..self.found
        }
    }
}

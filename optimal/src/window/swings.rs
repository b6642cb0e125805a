//! Follows the modes of vibration through the motion that is handed out.
//!
//! Source: ours; see [`Transition`]. Not here: how windows silence them.

use crate::window::Silence;
use toolglide_kinematics::{AxisMode, AxisModes, Limits, ModeState, Transition, Vector};

/// Modes, and how they swing where motion has been handed out to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Swings {
    pub(crate) modes: Vec<AxisMode>,
    pub(crate) states: Vec<ModeState>,
    /// Reciprocals of the accelerations that scale the states, and the last step of each mode with its duration.
    by_scale: Vec<f64>,
    steps: Vec<(f64, Transition)>,
}

impl Swings {
    /// Modes at rest.
    pub(crate) fn new<const N: usize>(modes: &AxisModes, limits: &Limits<N>) -> Self {
        let modes: Vec<AxisMode> = modes.iter().filter(|mode| mode.axis < N).collect();
        Self {
            states: vec![ModeState::default(); modes.len()],
            by_scale: modes
                .iter()
                .map(|mode| limits.acceleration()[mode.axis].recip())
                .collect(),
            steps: modes
                .iter()
                .map(|mode| (0.0, Transition::new(&mode.mode, 0.0)))
                .collect(),
            modes,
        }
    }

    /// The modes and their states, for a window that must bring them to rest.
    pub(crate) fn silence(&self) -> Silence<'_> {
        Silence {
            modes: &self.modes,
            start: &self.states,
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.modes.is_empty()
    }

    /// Lets an interval pass: acceleration at its start, jerk, duration.
    pub(crate) fn pass<const N: usize>(
        &mut self,
        acceleration: &Vector<N>,
        jerk: &Vector<N>,
        duration: f64,
    ) {
        for (index, mode) in self.modes.iter().enumerate() {
            let (lasted, step) = &mut self.steps[index];
            if lasted.to_bits() != duration.to_bits() {
                *step = Transition::new(&mode.mode, duration);
                *lasted = duration;
            }
            let scale = self.by_scale[index];
            self.states[index] = step.after(
                &self.states[index],
                acceleration[mode.axis] * scale,
                jerk[mode.axis] * scale,
            );
        }
    }

    /// As swung at the start of another motion.
    pub(crate) fn start_from(&mut self, states: &[ModeState]) {
        self.states.clear();
        self.states.extend_from_slice(states);
    }

    /// The largest deflection or rate, as a share of what full acceleration bends.
    pub(crate) fn largest(&self) -> f64 {
        self.states
            .iter()
            .flat_map(|state| &state[..2])
            .fold(0.0, |most, value| most.max(value.abs()))
    }
}

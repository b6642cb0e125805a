//! Shapes set-points ahead of a loop so that it follows them with no phase error.
//!
//! Source: Tomizuka (1987). Of the sampled loop `z^-d B+ B- / A` the poles and the zeros that damp well are cancelled; every
//! other zero `b` is answered by its mirror image `(1 / z - b) / (1 - b)`, which leaves a gain near 1 and no phase. The
//! sections act one after the other, each of gain 1 at rest, so that no polynomial of high order is ever formed. Not here: the
//! loop.

use crate::axes::DrivenAxis;
use crate::linear::{Mat, c64, eigenvalues, zeros};
use crate::model::DriveModel;

/// Zeros with less damping than this, outside the unit circle, or left of the imaginary axis, are not cancelled.
const DAMPED: f64 = 0.1;

/// Poles and zeros nearer to 0 than this are delays.
const DELAY: f64 = 0.02;

/// One factor of the filter, of gain 1 at rest.
#[derive(Clone, Copy, Debug)]
enum Section {
    /// `(z - p) / (1 - p)` for a pole of the loop: looks one set-point ahead.
    Pole(c64),
    /// `(1 - b) / (z - b)` for a zero that is cancelled.
    Cancelled(c64),
    /// `(1 / z - b) / (1 - b)` for any other zero.
    Mirrored(c64),
}

/// The filter of one axis.
#[derive(Clone, Debug)]
struct Shaper {
    sections: Vec<Section>,
    /// Input and output of each section one set-point before.
    memory: Vec<[c64; 2]>,
    preview: u64,
    primed: bool,
}

impl Shaper {
    fn new(model: &DriveModel, start: f64) -> Self {
        let (a, b) = model.loop_matrices();
        let c = Mat::from_fn(1, a.nrows(), |_, j| f64::from(u8::from(j == 0)));
        let still = |place: &c64| -> c64 {
            if place.norm() < DELAY {
                c64::new(0.0, 0.0)
            } else {
                *place
            }
        };
        let poles = eigenvalues(&a);
        let mut sections: Vec<Section> = poles
            .iter()
            .map(|pole| Section::Pole(still(pole)))
            .collect();
        for zero in zeros(&a, &b, &c) {
            let zero = still(&zero);
            // A mode that no loop moves has a pole beside its zero: both cancel.
            sections.push(if is_damped(zero) || pairs(&poles, zero) {
                Section::Cancelled(zero)
            } else {
                Section::Mirrored(zero)
            });
        }
        let rest = c64::new(start, 0.0);
        Self {
            memory: vec![[rest; 2]; sections.len()],
            preview: poles.len() as u64,
            sections,
            primed: false,
        }
    }

    #[inline]
    fn pass(&mut self, set_point: f64) -> f64 {
        let one = c64::new(1.0, 0.0);
        let mut signal = c64::new(set_point, 0.0);
        for (section, memory) in self.sections.iter().zip(&mut self.memory) {
            let [input, output] = *memory;
            let next = match *section {
                Section::Pole(pole) => input + (signal - input) / (one - pole),
                Section::Cancelled(zero) => output * zero + input * (one - zero),
                Section::Mirrored(zero) => signal + (input - signal) / (one - zero),
            };
            *memory = [signal, next];
            signal = next;
        }
        signal.re
    }
}

/// Whether a zero is inside the unit circle, on the right, and damps well.
fn is_damped(zero: c64) -> bool {
    if zero.norm() < DELAY {
        return true;
    }
    let (rate, turn) = (zero.norm().ln(), zero.im.atan2(zero.re));
    zero.norm() < 1.0 && zero.re >= 0.0 && -rate >= DAMPED * rate.hypot(turn)
}

/// Whether a pole lies so near to a zero that they cancel.
fn pairs(poles: &[c64], zero: c64) -> bool {
    poles.iter().any(|pole| (*pole - zero).norm() < 1e-6)
}

/// The filters of all axes that have one.
#[derive(Clone, Debug)]
pub(crate) struct Shapers<const A: usize> {
    shapers: Vec<Option<Shaper>>,
    preview: u64,
}

impl<const A: usize> Shapers<A> {
    /// Filters at rest at the start of each axis.
    pub(crate) fn new(axes: &[DrivenAxis], start: &[f64]) -> Self {
        let shapers: Vec<Option<Shaper>> = axes
            .iter()
            .zip(start)
            .map(|(axis, &start)| {
                let wanted = axis.model.settings().feedforward.zero_phase;
                wanted.then(|| Shaper::new(&axis.model, start))
            })
            .collect();
        let preview = shapers
            .iter()
            .flatten()
            .map(|shaper| shaper.preview)
            .max()
            .unwrap_or(0);
        Self { shapers, preview }
    }

    /// Set-points that must be known ahead.
    pub(crate) fn preview(&self) -> u64 {
        self.preview
    }

    /// What the drives get at a tick instead of `plain`; `at` gives the set-points of any tick up to the preview.
    #[inline]
    pub(crate) fn shape(
        &mut self,
        now: u64,
        plain: [f64; A],
        at: impl Fn(u64) -> [f64; A],
    ) -> [f64; A] {
        let mut shaped = plain;
        if self.preview == 0 {
            return shaped;
        }
        for (axis, shaper) in self.shapers.iter_mut().enumerate() {
            let Some(shaper) = shaper else { continue };
            if !shaper.primed {
                shaper.primed = true;
                for tick in 0..shaper.preview {
                    shaper.pass(at(tick)[axis]);
                }
            }
            shaped[axis] = shaper.pass(at(now + shaper.preview)[axis]);
        }
        shaped
    }
}

//! Turns polar coordinates by `G16` into straight ones: the first axis of the plane is a radius, the second an
//! angle.
//!
//! Source: the operator's manual of FANUC: with `G90` the centre is the origin of the workpiece; a radius in
//! `G91` has its centre where the tool is. Not here: `@` and `^` of LinuxCNC.

use crate::block::AXES;
use crate::block::codes::Distance;
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::fanuc::Fanuc;
use crate::fanuc::block::{position, word};
use crate::fanuc::words::Word;
use crate::program::Program;
use crate::text::place::Span;
use std::io::BufRead;

/// Where polar coordinates count from, and the last ones; mm and degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Polar {
    center: [f64; 2],
    radius: f64,
    angle: f64,
}

impl Fanuc {
    /// `G16` and `G15`.
    pub(crate) fn set_polar<R: BufRead>(&mut self, on: bool, program: &mut Program<R>) {
        self.memory.groups[17] = if on { 16.0 } else { 15.0 };
        let plane = program.block.plane.unwrap_or(program.lowering.modal.plane);
        let here = plane.axes().map(|axis| program.lowering.program[axis]);
        self.polar = on.then(|| Polar {
            center: [0.0; 2],
            radius: here[0].hypot(here[1]),
            angle: here[1].atan2(here[0]).to_degrees(),
        });
    }

    /// Replaces radius and angle by coordinates of the distance mode in force.
    pub(crate) fn straighten<R: BufRead>(
        &mut self,
        list: &mut Vec<Word>,
        program: &Program<R>,
    ) -> Result<(), Fault> {
        let state = &program.lowering;
        let plane = program.block.plane.unwrap_or(state.modal.plane);
        let units = program.block.units.unwrap_or(state.modal.units);
        let distance = program.block.distance.unwrap_or(state.modal.distance);
        let incremental = distance == Distance::Incremental;
        let axes = plane.axes();
        let [radius, angle] = axes.map(|axis| word(list, AXES[axis]));
        let Some(mut polar) = self.polar.filter(|_| radius.is_some() || angle.is_some()) else {
            return Ok(());
        };
        if let Some(repetitions) = word(list, b'L').filter(|word| incremental && word.value > 1.0) {
            let word = "L".into();
            let what = "repetitions in polar coordinates with G91";
            let reason = Reason::WordNotSupported { word, what };
            return Err(Fault::new(repetitions.span, reason));
        }
        let here = axes.map(|axis| state.program[axis]);
        if let Some(radius) = radius {
            polar.center = if incremental { here } else { [0.0; 2] };
            polar.radius = units.length(radius.value);
        }
        if let Some(angle) = angle {
            let from = if incremental { polar.angle } else { 0.0 };
            polar.angle = (from + angle.value) % 360.0;
        }
        let (sine, cosine) = polar.angle.to_radians().sin_cos();
        let along = [polar.radius * cosine, polar.radius * sine];
        let span = radius.or(angle).map_or(Span::default(), |word| word.span);
        for (index, axis) in axes.into_iter().enumerate() {
            let target = polar.center[index] + along[index];
            let from = if incremental { here[index] } else { 0.0 };
            let value = units.written(target - from);
            let letter = AXES[axis];
            match position(list, letter) {
                Some(at) => list[at].value = value,
                None => list.push(Word {
                    letter,
                    comma: false,
                    value,
                    point: true,
                    span,
                }),
            }
        }
        self.polar = Some(polar);
        Ok(())
    }
}

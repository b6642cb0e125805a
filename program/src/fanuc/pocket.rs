//! Mills circular pockets: in on a half circle, round, further out on half circles, and back to the centre.
//!
//! Source: `G12` and `G13` of the operator's manual of Haas mills. `I` is the radius of the first circle, `K` that of
//! the last one, `Q` the step between them; the radius of the tool `D` is taken off all circles. Not here:
//! pockets of another shape.

use crate::block::codes::{Distance, FeedMode, Plane};
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::error::{Fault, Notice};
use crate::fanuc::Fanuc;
use crate::fanuc::actions::length;
use crate::fanuc::block::{Taken, axes, word};
use crate::fanuc::modes::whole;
use crate::fanuc::words::Word;
use crate::interpreter::MAX_MOVES;
use crate::interpreter::tools::LARGEST_TOOL;
use crate::program::Program;
use std::io::BufRead;
use toolglide_kinematics::{Feedrate, Vector};

/// Steps between the circles of one pocket, and its levels.
const MAX_STEPS: f64 = 10_000.0;

/// The circles of a pocket, mm.
struct Circles {
    first: f64,
    last: f64,
    step: f64,
    counter_clockwise: bool,
    feedrate: Feedrate,
}

impl Fanuc {
    /// `G12` and `G13`.
    pub(crate) fn pocket<R: BufRead>(
        &mut self,
        taken: Taken,
        counter_clockwise: bool,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let code = taken.code;
        let refuse = |state| {
            let reason = MachiningError::NotNow { code, state };
            Err(Fault::new(taken.span, reason.into()))
        };
        if program.lowering.modal.plane != Plane::Xy {
            return refuse("outside the plane XY (G17)");
        }
        if program.lowering.turns_arcs() {
            return refuse("in a plane that is turned or scaled unevenly");
        }
        if program.lowering.modal.feed_mode == FeedMode::InverseTime {
            return refuse("with inverse time (G93)");
        }
        let feedrate = program.lowering.feedrate(&program.block, 1.0)?;
        let circles = self.circles(taken, counter_clockwise, feedrate, words, program)?;
        let levels = match word(words, b'L') {
            Some(levels) => whole(&levels, "levels of a pocket", 1, MAX_MOVES)?,
            None => 1,
        };
        let incremental = program.lowering.modal.distance == Distance::Incremental;
        if levels > 1 && !incremental {
            return refuse("with L and absolute distances: the levels need G91");
        }
        let mut center = program.lowering.program;
        let mut depth = 0.0;
        for (axis, word) in axes(words).into_iter().enumerate() {
            let Some(word) = word else {
                continue;
            };
            let value = length(&word, program)?;
            match (axis, incremental) {
                (2, true) => depth = value,
                (_, true) => center[axis] += value,
                (_, false) => center[axis] = value,
            }
        }
        let bottom = center[2];
        let mut above = center;
        above[2] = program.lowering.program[2];
        self.feed(above, &circles, taken, program)?;
        for level in 1..=levels {
            let mut start = center;
            start[2] = bottom + depth * f64::from(level);
            self.feed(start, &circles, taken, program)?;
            Self::circle(start, &circles, taken, program)?;
        }
        Ok(())
    }

    fn circles<R: BufRead>(
        &mut self,
        taken: Taken,
        counter_clockwise: bool,
        feedrate: Feedrate,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<Circles, Fault> {
        let code = taken.code;
        let radius = match word(words, b'D') {
            Some(number) => self.tool_radius(&number, program)?,
            None => 0.0,
        };
        let of = |letter: u8| -> Result<Option<f64>, Fault> {
            let Some(word) = word(words, letter) else {
                return Ok(None);
            };
            let length = length(&word, program)?;
            if length <= 0.0 {
                let (quantity, value) = ("radius or step of a pocket", word.value);
                return Err(Fault::new(
                    word.span,
                    Reason::NotPositive { quantity, value },
                ));
            }
            Ok(Some(length))
        };
        let missing = |letter| Fault::new(taken.span, Reason::WordMissing { code, letter });
        let first = of(b'I')?.ok_or_else(|| missing('I'))?;
        let (last, step) = match (of(b'K')?, of(b'Q')?) {
            (None, _) => (first, 1.0),
            (Some(last), Some(step)) => (last.max(first), step),
            (Some(_), None) => return Err(missing('Q')),
        };
        if first <= radius {
            let reason = MachiningError::ToolTooLarge { radius, arc: first };
            return Err(Fault::new(taken.span, reason.into()));
        }
        if (last - first) / step > MAX_STEPS {
            let bound = MAX_MOVES;
            let reason = MachiningError::TooManyMoves { bound };
            return Err(Fault::new(taken.span, reason.into()));
        }
        Ok(Circles {
            first: first - radius,
            last: last - radius,
            step,
            counter_clockwise,
            feedrate,
        })
    }

    /// The radius of the tool that a `D` word names, mm.
    fn tool_radius<R: BufRead>(
        &mut self,
        number: &Word,
        program: &mut Program<R>,
    ) -> Result<f64, Fault> {
        let tool = whole(number, "tool number", 0, LARGEST_TOOL)?;
        self.memory.set_letter(b'D', number.value);
        let tools = &program.lowering.tools;
        if tool == 0 {
            return Ok(0.0);
        }
        if let Some(found) = tools.get(tool) {
            return Ok(0.5 * found.diameter.abs());
        }
        if tools.is_empty() {
            program
                .remarks
                .push((number.span, Notice::NoToolTable { tool }));
            return Ok(0.0);
        }
        Err(Fault::new(
            number.span,
            MachiningError::NoSuchTool { tool }.into(),
        ))
    }

    fn feed<R: BufRead>(
        &self,
        end: Vector<3>,
        circles: &Circles,
        taken: Taken,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        if end == program.lowering.program {
            return Ok(());
        }
        let (state, waiting) = (&mut program.lowering, &mut program.waiting);
        state.go(end, circles.feedrate, taken.span, waiting)
    }

    /// The circles of one level, from the centre and back to it.
    fn circle<R: BufRead>(
        center: Vector<3>,
        circles: &Circles,
        taken: Taken,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let (state, waiting) = (&mut program.lowering, &mut program.waiting);
        let at = |x: f64| center + Vector::<3>::new(x, 0.0, 0.0);
        let mut go = |to: f64, middle: f64| {
            let how = (circles.counter_clockwise, circles.feedrate);
            state.go_round((at(to), at(middle)), how, taken.span, waiting)
        };
        // Each half circle leads from one side of the centre to the other.
        let mut place = 0.0;
        let mut radius = circles.first;
        let mut side = 1.0;
        loop {
            let next = side * radius;
            go(next, 0.5 * (place + next))?;
            place = next;
            go(place, 0.0)?;
            if radius >= circles.last {
                break;
            }
            radius = (radius + circles.step).min(circles.last);
            side = -side;
        }
        go(0.0, 0.5 * place)
    }
}

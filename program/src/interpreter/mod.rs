//! Interprets blocks as moves.
//!
//! Source: the order of execution of RS274/NGC. The position is kept twice: where the program says
//! the tool is, and where that is on the machine. Not here: what each code does in detail.

pub(crate) mod feed;
pub(crate) mod frame;
pub(crate) mod g10;
pub(crate) mod modal;
pub(crate) mod non_modal;
pub(crate) mod offsets;
pub(crate) mod point;
pub(crate) mod secondary_axes;
pub(crate) mod tool_codes;
pub(crate) mod tools;
pub(crate) mod units;

use crate::block::Block;
use crate::block::codes::{Group, Motion, Once, PathControl, Saving, Stop};
use crate::block::word_usage::{check, motion_of, motion_span};
use crate::compensation::Compensation;
use crate::curves::arcs::arc;
use crate::curves::corner_breaks::Corner;
use crate::curves::knot_spline::KnotSpline;
use crate::curves::splines::Nurbs;
use crate::cycles::words::CycleState;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::error::{Fault, Notice, Remark};
use crate::expression::parameters::Parameters;
use crate::printer::Printer;
use crate::settings::Settings;
use crate::sinumerik::tool_vector::ToolVector;
use crate::text::lexer::Assignment;
use crate::text::place::Span;
use modal::Modal;
use offsets::Offsets;
use secondary_axes::Others;
use std::collections::{BTreeSet, VecDeque};
use toolglide_kinematics::{Feedrate, Move, Vector};
use tools::ToolTable;
use units::per_minute;

/// Moves that one block may make: more than any spline or cycle of a real program, and a bound on
/// what waits for the planner.
pub(crate) const MAX_MOVES: u32 = 100_000;

/// Tools that are remembered as used.
const MAX_TOOLS: usize = 10_000;

/// Turns blocks into moves, one after the other.
#[derive(Debug)]
pub(crate) struct Interpreter {
    pub(crate) settings: Settings,
    pub(crate) modal: Modal,
    pub(crate) parameters: Parameters,
    pub(crate) offsets: Offsets,
    pub(crate) tools: ToolTable,
    /// The tool in the spindle.
    pub(crate) loaded: u32,
    /// Where the program is, in its own coordinates, mm.
    pub(crate) program: Vector<3>,
    /// Where that is on the machine, mm.
    pub(crate) position: Vector<3>,
    /// Axes A, B, C, U, V and W.
    pub(crate) others: Others,
    /// Whether the axis words are those of the tool tip.
    pub(crate) tip: bool,
    /// Whether the tool turns along a great circle to where rotary words point it.
    pub(crate) great_circle: bool,
    /// Where a vector points the tool.
    pub(crate) tool_vector: ToolVector,
    pub(crate) compensation: Option<Compensation>,
    /// Whether compensation begins on the normal of its second move, as for Sinumerik and FANUC.
    pub(crate) leads_to_normal: bool,
    /// Whether cycles keep their words and dwells as FANUC has it.
    pub(crate) fanuc: bool,
    /// A move whose corner waits for the next one.
    pub(crate) corner: Option<Corner>,
    /// Reference points of the machine beyond the second one: X Y Z in mm, A B C in degrees.
    pub(crate) references: Vec<[f64; 6]>,
    pub(crate) nurbs: Option<Nurbs>,
    pub(crate) knot_spline: Option<KnotSpline>,
    /// What the next spline of two offsets continues, if it does.
    pub(crate) spline_end: Option<[f64; 2]>,
    pub(crate) cycle: Option<CycleState>,
    /// Modal states saved by the main program and by each subroutine that runs, and whether they
    /// come back when it ends.
    pub(crate) saved: Vec<Option<(Modal, bool)>>,
    pub(crate) line: u32,
    /// Whether this block named its end so that it does not matter where the tool was.
    pub(crate) arrived: bool,
    pub(crate) tools_used: BTreeSet<u32>,
    /// What is to be told of the block, and whether it was told of a rounded arc.
    pub(crate) own_remark: Option<Remark>,
    pub(crate) rounding_told: bool,
    /// Extrusion, for programs of printers.
    pub(crate) printer: Option<Printer>,
}

impl Interpreter {
    pub(crate) fn new(settings: Settings) -> Self {
        Self {
            settings,
            modal: Modal::new(&settings),
            parameters: Parameters::new(),
            offsets: Offsets::new(),
            tools: ToolTable::new(),
            loaded: 0,
            program: settings.start,
            position: settings.start,
            others: Others::default(),
            tip: false,
            great_circle: false,
            tool_vector: ToolVector::default(),
            compensation: None,
            leads_to_normal: false,
            fanuc: false,
            corner: None,
            references: Vec::new(),
            nurbs: None,
            knot_spline: None,
            spline_end: None,
            cycle: None,
            saved: vec![None],
            line: 0,
            arrived: false,
            tools_used: BTreeSet::new(),
            own_remark: None,
            rounding_told: false,
            printer: None,
        }
    }

    /// Gives parameters the values that a line has for them.
    pub(crate) fn assign(&mut self, assignments: &mut Vec<Assignment>) -> Result<(), Fault> {
        for assignment in assignments.drain(..) {
            self.set_parameter(&assignment)?;
        }
        Ok(())
    }

    /// Begins a subroutine.
    pub(crate) fn enter(&mut self, arguments: &[f64]) {
        self.parameters.enter(arguments);
        self.saved.push(None);
    }

    /// Begins a subprogram, whose parameters are those of its caller.
    pub(crate) fn enter_subprogram(&mut self) {
        self.saved.push(None);
    }

    /// Ends a subroutine, with the value that it returns.
    pub(crate) fn leave(&mut self, value: Option<f64>) {
        self.parameters.leave();
        self.return_value(value);
        self.leave_subprogram();
    }

    /// Ends a subprogram.
    pub(crate) fn leave_subprogram(&mut self) {
        if let Some(Some((modal, true))) = self.saved.pop() {
            self.modal = modal;
        }
    }

    /// Appends the moves of a block to `moves`; true when the program ends with it.
    pub(crate) fn block(
        &mut self,
        block: &Block,
        line: u32,
        moves: &mut VecDeque<Move<3>>,
        remarks: &mut Vec<Remark>,
    ) -> Result<bool, Fault> {
        self.line = line;
        let motion = motion_of(block, self.modal.motion)?;
        check(block, motion, &self.settings, remarks)?;
        self.check_open_spline(block, motion)?;
        self.check_compensated(block)?;
        let former = self.modal.motion;
        self.modal.take(block, &self.settings, remarks)?;
        if self.modal.feedrate_is_old {
            self.tell_old_feedrate(block, motion, remarks);
        }
        let before = self.position;
        if block.has(b'T') && self.tools_used.len() < MAX_TOOLS {
            self.tools_used.insert(self.modal.tool);
        }
        if motion.is_some_and(Motion::is_cycle) {
            self.mind_dwell(block, remarks);
        }
        if block.is_plain() {
            // Most blocks of long programs are motion alone.
            if let Some(motion) = motion {
                self.motion(block, motion, former, moves)?;
            }
            if self.printer.is_some() {
                self.extrude(block, motion, before, moves)?;
            }
            return Ok(false);
        }
        if block.tool_change {
            self.loaded = self.modal.tool;
        }
        self.set_up(block, remarks, moves)?;
        if block.once == Some(Once::Dwell) {
            let rest = self.dwell(block)?.from_line(line);
            self.mind_dwell(block, remarks);
            self.emit(rest, moves)?;
        }
        self.once(block, moves)?;
        if block.end_of_nurbs {
            self.end_nurbs(block, moves)?;
        }
        if let Some(motion) = motion {
            self.motion(block, motion, former, moves)?;
        }
        if self.printer.is_some() {
            self.extrude(block, motion, before, moves)?;
        }
        if let Some(saving) = block.saving {
            self.save(saving, block)?;
        }
        match block.stop {
            Some(Stop::Pause) => {
                let rest = self.rest(0.0, motion_span(block))?;
                self.emit(rest, moves)?;
                Ok(false)
            }
            Some(Stop::End) => Ok(true),
            None => Ok(false),
        }
    }

    /// Makes the moves that wait for one that never comes.
    pub(crate) fn finish(&mut self, moves: &mut VecDeque<Move<3>>) -> Result<(), Fault> {
        if self.corner.is_some() {
            return Err(self.corner_left(Span::default()));
        }
        if let Some(compensation) = &mut self.compensation {
            compensation.flush(moves);
        }
        self.check_no_spline()
            .map_err(|reason| Fault::new(Span::default(), reason.into()))
    }

    /// Tells of a feedrate that nobody wrote since inverse time ended, once it is used.
    fn tell_old_feedrate(
        &mut self,
        block: &Block,
        motion: Option<Motion>,
        remarks: &mut Vec<Remark>,
    ) {
        let Some(feedrate) = self.modal.feedrate else {
            return;
        };
        if motion.is_some_and(|motion| motion != Motion::Rapid) {
            self.modal.feedrate_is_old = false;
            let feedrate = per_minute(feedrate);
            let notice = Notice::OldFeedrate { feedrate };
            remarks.push((motion_span(block), notice));
        }
    }

    fn motion(
        &mut self,
        block: &Block,
        motion: Motion,
        former: Motion,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        match motion {
            Motion::Cycle(_) | Motion::BackBore => self.cycle(block, motion, former, moves),
            Motion::Cubic | Motion::Quadratic => self.spline(block, motion, moves),
            Motion::Nurbs => self.control_point(block),
            Motion::Knots => self.knot_block(block, moves),
            _ => {
                self.spline_end = None;
                self.step(block, motion, moves)
            }
        }
    }

    /// A straight or circular move.
    fn step(
        &mut self,
        block: &Block,
        motion: Motion,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let end = self.end(block)?;
        if motion.is_arc() && !self.offsets.frame().is_even(self.modal.plane.axes()) {
            let reason = MachiningError::UnevenArc;
            return Err(Fault::new(motion_span(block), reason.into()));
        }
        if motion.is_arc() && self.turns_arcs() {
            if self.corner.is_some() {
                return Err(self.corner_left(motion_span(block)));
            }
            return self.turned_arc(block, motion, end, moves);
        }
        let start = self.position;
        let there = self.offsets.on_machine(end);
        let tolerance = self.modal.tolerance;
        // Even where the move itself is refused, the next one starts at its end.
        (self.program, self.position) = (end, there);
        let step = if motion.is_arc() {
            let (arc, mismatch) = arc(block, self, motion, start, there)?;
            self.tell_rounding(block, mismatch);
            Move::arc(arc, self.feedrate(block, arc.length())?, tolerance)
        } else {
            let feedrate = match motion {
                Motion::Rapid if !self.paces_rapids() => Feedrate::RAPID,
                _ => self.feedrate(block, (there - start).norm())?,
            };
            Move::line_to(there, feedrate, tolerance)
                .map_err(|error| Fault::new(motion_span(block), Reason::Path(error)))?
        };
        let step = step.from_line(self.line);
        let step = match self.modal.path_control {
            PathControl::ExactStop => step.with_exact_stop(),
            PathControl::Blend => step,
        };
        let (step, start) = match self.corner.take() {
            Some(corner) => self.break_corner(corner, step, motion_span(block), moves)?,
            None => (step, start),
        };
        match block.corner {
            Some(corner) => self.hold_corner(corner, step, start),
            None => self.hand_on(step, start, motion_span(block), moves),
        }
    }

    /// Hands a move of the program on, through cutter compensation where it is on.
    pub(crate) fn hand_on(
        &mut self,
        step: Move<3>,
        start: Vector<3>,
        span: Span,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        match &mut self.compensation {
            None => moves.push_back(step),
            Some(compensation) => {
                let more = compensation
                    .push(step, start, moves)
                    .map_err(|reason| Fault::new(span, reason))?;
                if !more {
                    self.compensation = None;
                }
            }
        }
        Ok(())
    }

    /// Hands a move on, behind what waits.
    pub(crate) fn emit(
        &mut self,
        step: Move<3>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        if self.corner.is_some() {
            return Err(self.corner_left(Span::default()));
        }
        match &mut self.compensation {
            Some(compensation) => compensation.pass(step, moves),
            None => moves.push_back(step),
        }
        Ok(())
    }

    /// A straight move to a point of the program, without cutter compensation.
    pub(crate) fn go(
        &mut self,
        end: Vector<3>,
        feedrate: Feedrate,
        span: Span,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        if moves.len() >= MAX_MOVES as usize {
            let bound = MAX_MOVES;
            return Err(Fault::new(
                span,
                MachiningError::TooManyMoves { bound }.into(),
            ));
        }
        if self.corner.is_some() {
            return Err(self.corner_left(span));
        }
        let there = self.offsets.on_machine(end);
        (self.program, self.position) = (end, there);
        let step = Move::line_to(there, feedrate, self.modal.tolerance)
            .map_err(|error| Fault::new(span, Reason::Path(error)))?;
        moves.push_back(step.from_line(self.line));
        Ok(())
    }

    fn save(&mut self, saving: Saving, block: &Block) -> Result<(), Fault> {
        let modal = self.modal;
        let Some(place) = self.saved.last_mut() else {
            return Ok(());
        };
        match saving {
            Saving::Save => *place = Some((modal, false)),
            Saving::SaveForCall => *place = Some((modal, true)),
            Saving::Forget => *place = None,
            Saving::Restore => match place {
                Some((modal, _)) => self.modal = *modal,
                None => {
                    let span = block
                        .taker(Group::Saving)
                        .map_or(Span::default(), |(_, at)| at);
                    return Err(Fault::new(span, MachiningError::NothingSaved.into()));
                }
            },
        }
        Ok(())
    }
}

//! Reads cutter location files (APT): tool poses by GOTO, circles, feedrates.
//!
//! Source: ISO 4343 (APT) as CAM systems write it. The tool tip is in mm or inch by `UNITS`; `RAPID`
//! holds for one move; `CIRCLE` names centre, axis and radius of the arc that the next `GOTO` ends,
//! counter-clockwise about its axis. Not here: systems and feedrates, see `cl_system`, and statements that are not
//! read, see `cl_kinds`.

pub(crate) mod arc;
pub(crate) mod coordinate_system;
pub(crate) mod kinds;
pub(crate) mod moves;
pub(crate) mod statement;

use crate::error::reason::Reason;
use crate::error::statement::StatementError;
use crate::error::{Fault, Notice, ProgramError, Warning};
use crate::interpreter::frame::Frame;
use crate::interpreter::tools::LARGEST_TOOL;
use crate::interpreter::units::Units;
use crate::program::MAX_WARNINGS;
use crate::settings::Settings;
use crate::text::lines::{LONGEST_LINE, Lines};
use crate::text::place::{Place, Span};
use arc::Circle;
use kinds::{Kind, kind};
use statement::Statement;
use std::collections::{BTreeSet, VecDeque};
use std::io::BufRead;
use std::sync::Arc;
use toolglide_kinematics::{PoseEnd, PoseFeed, PoseMove, Vector};

/// A cutter location file.
#[derive(Debug)]
pub(crate) struct CutterLocations<R> {
    file: Arc<str>,
    pub(crate) lines: Lines<R>,
    /// The statement being read, over all its lines.
    text: Vec<u8>,
    pub(crate) settings: Settings,
    pub(crate) units: Units,
    pub(crate) feedrate: Option<f64>,
    /// Feedrate for each turn of the spindle, mm, where that is what was asked for.
    pub(crate) per_turn: Option<f64>,
    /// Speed of the spindle in turns a minute, where it is known.
    pub(crate) spindle_speed: Option<f64>,
    /// Where the points of the file are.
    pub(crate) frame: Frame,
    /// Kinds of statements of which was told that they move nothing.
    told: BTreeSet<String>,
    pub(crate) rapid: bool,
    pub(crate) tip: Vector<3>,
    pub(crate) orientation: Vector<3>,
    pub(crate) circle: Option<Circle>,
    pub(crate) waiting: VecDeque<PoseMove>,
    pub(crate) warnings: Vec<Warning>,
    pub(crate) more_warnings: u64,
    pub(crate) statements: u64,
    pub(crate) tools_used: BTreeSet<u32>,
    pub(crate) past_refusals: bool,
    ended: bool,
}

impl<R: BufRead> CutterLocations<R> {
    pub(crate) fn new(reader: R, file: &str, settings: Settings) -> Self {
        Self {
            file: Arc::from(file),
            lines: Lines::new(reader),
            text: Vec::new(),
            settings,
            units: Units::Millimeter,
            feedrate: None,
            per_turn: None,
            spindle_speed: None,
            frame: Frame::NONE,
            told: BTreeSet::new(),
            rapid: false,
            tip: settings.start,
            orientation: Vector::<3>::z(),
            circle: None,
            waiting: VecDeque::new(),
            warnings: Vec::new(),
            more_warnings: 0,
            statements: 0,
            tools_used: BTreeSet::new(),
            past_refusals: false,
            ended: false,
        }
    }

    pub(crate) fn lines(&self) -> u64 {
        self.lines.count()
    }

    pub(crate) fn line_text(&self) -> std::borrow::Cow<'_, str> {
        String::from_utf8_lossy(&self.text)
    }

    /// Reads one statement.
    fn statement(&mut self) -> Result<(), Fault> {
        self.text.clear();
        loop {
            let more = self.lines.advance().map_err(|reason| {
                self.past_refusals = false;
                Fault::new(Span::new(0, 0), reason)
            })?;
            if !more {
                self.ended = true;
                let unfinished = !self.text.is_empty();
                return if unfinished {
                    Err(Fault::new(
                        Span::new(0, 1),
                        StatementError::Unfinished.into(),
                    ))
                } else {
                    Ok(())
                };
            }
            self.text.extend_from_slice(self.lines.text());
            if self.text.len() > LONGEST_LINE {
                let bound = LONGEST_LINE;
                return Err(Fault::new(Span::new(0, 1), Reason::LineTooLong { bound }));
            }
            let trimmed = self.text.trim_ascii_end();
            if trimmed.ends_with(b"$") && !trimmed.ends_with(b"$$") {
                let length = trimmed.len() - 1;
                self.text.truncate(length);
                continue;
            }
            break;
        }
        crate::text::lexer::check_text(&self.text, 0)?;
        let text = String::from_utf8_lossy(&self.text).into_owned();
        match Statement::of(&text) {
            Some(statement) => self.obey(&statement),
            None => Ok(()),
        }
    }

    fn obey(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        self.statements += 1;
        let at = |reason: StatementError| Fault::new(statement.span, reason.into());
        let name = statement.name.as_str();
        if self.circle.is_some() && matches!(name, "FROM" | "GODLTA" | "CIRCLE" | "GOHOME") {
            self.circle = None;
            return Err(at(StatementError::CircleAlone));
        }
        match name {
            "UNITS" => {
                let (name, wanted) = ("UNITS", "MM or INCHES");
                self.units = if statement.has("MM") {
                    Units::Millimeter
                } else if statement.has("INCHES") || statement.has("INCH") {
                    Units::Inch
                } else {
                    return Err(at(StatementError::WrongWord { name, wanted }));
                };
            }
            "FEDRAT" => self.feedrate(statement)?,
            "RAPID" => self.rapid = true,
            "FROM" => {
                (self.tip, self.orientation) = self.pose(statement, "FROM")?;
            }
            "GOTO" => self.go_to(statement)?,
            "GODLTA" => {
                let numbers = statement.numbers(false)?;
                let [x, y, z] = numbers[..] else {
                    return Err(at(StatementError::WrongCount {
                        name: "GODLTA",
                        given: numbers.len(),
                        wanted: "3",
                    }));
                };
                let step = Vector::<3>::new(x, y, z).map(|length| self.units.length(length));
                let end = self.tip + self.frame.direction(step);
                self.check_reach(end, statement)?;
                self.line(end, self.orientation, statement)?;
            }
            "CIRCLE" => self.circle = Some(self.circle(statement)?),
            "DELAY" => {
                let numbers = statement.numbers(true)?;
                let duration = numbers.first().copied().unwrap_or(0.0);
                let end = PoseEnd::Dwell { duration };
                self.push(end, PoseFeed::Rapid, self.settings.tolerance, statement)?;
            }
            "STOP" | "OPSTOP" => {
                let end = PoseEnd::Dwell { duration: 0.0 };
                self.push(end, PoseFeed::Rapid, self.settings.tolerance, statement)?;
            }
            "MSYS" => self.system(statement)?,
            "SPINDL" => self.spindle(statement)?,
            "LOADTL" => self.load_tool(statement)?,
            "LOAD" if statement.has("TOOL") => self.load_tool(statement)?,
            "END" | "FINI" => self.ended = true,
            _ => self.pass(statement)?,
        }
        Ok(())
    }

    /// A statement that is not read.
    fn pass(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        let name = statement.name.as_str();
        let items: Vec<&str> = statement.items().map(|(item, _)| item).collect();
        let refused = |reason: StatementError| Fault::new(statement.span, reason.into());
        match kind(name, &items) {
            Kind::Silent => {}
            Kind::Told(what) => {
                if self.told.insert(name.to_owned()) {
                    let word = name.into();
                    self.warn(statement.span, Notice::Noted { word, what });
                }
            }
            Kind::Moving(what) => {
                let name = name.into();
                return Err(refused(StatementError::Moves { name, what }));
            }
            Kind::Unknown => {
                let name = name.into();
                let fault = refused(StatementError::NotSupported { name });
                if !self.settings.lenient {
                    return Err(fault);
                }
                self.warn(fault.span, Notice::Skipped(fault.reason));
            }
        }
        Ok(())
    }

    fn load_tool(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        let numbers = statement.numbers(true)?;
        let number = numbers.first().copied().unwrap_or(0.0);
        if !(0.0..=f64::from(LARGEST_TOOL)).contains(&number) || number.fract() != 0.0 {
            let reason = Reason::NotWhole {
                quantity: "tool number",
                value: number,
                least: 0,
                most: LARGEST_TOOL,
            };
            return Err(Fault::new(statement.span, reason));
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and within the bounds checked above"
        )]
        self.tools_used.insert(number as u32);
        Ok(())
    }

    fn warn(&mut self, span: Span, notice: Notice) {
        if self.warnings.len() < MAX_WARNINGS {
            let place = self.place(span);
            self.warnings.push(Warning::new(place, notice, &self.text));
        } else {
            self.more_warnings += 1;
        }
    }

    fn place(&self, span: Span) -> Place {
        Place::new(&self.file, self.lines.count(), &self.text, span)
    }
}

impl<R: BufRead> Iterator for CutterLocations<R> {
    type Item = Result<PoseMove, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(next) = self.waiting.pop_front() {
                return Some(Ok(next));
            }
            if self.ended {
                return None;
            }
            if let Err(fault) = self.statement() {
                if !self.past_refusals {
                    self.ended = true;
                }
                self.waiting.clear();
                return Some(Err(ProgramError::new(self.place(fault.span), fault.reason)));
            }
        }
    }
}

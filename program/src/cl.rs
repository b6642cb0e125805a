//! Cutter location files: tool poses by GOTO, circles, feedrates.
//!
//! Source: ISO 4343 (APT) as CAM systems write it. The tool tip is in mm or inch by `UNITS`; `RAPID`
//! holds for one move; `CIRCLE` names centre, axis and radius of the arc that the next `GOTO` ends,
//! counter-clockwise about its axis. Not here: cycles and definitions of geometry, which are refused.

use crate::cl_arc::Circle;
use crate::error::{Fault, Notice, ProgramError, Warning};
use crate::lines::{LONGEST_LINE, Lines};
use crate::place::{Place, Span};
use crate::program::MOST_WARNINGS;
use crate::reason::Reason;
use crate::settings::Settings;
use crate::statement::Statement;
use crate::statement_error::StatementError;
use crate::tools::LARGEST_TOOL;
use crate::units::Units;
use std::collections::{BTreeSet, VecDeque};
use std::io::BufRead;
use std::sync::Arc;
use toolglide_kinematics::{PoseEnd, PoseFeed, PoseMove, Vector};

/// Statements that say nothing about the motion.
const SILENT: [&str; 28] = [
    "AIR",
    "CAMERA",
    "CHECK",
    "CLAMP",
    "COOLNT",
    "CUTTER",
    "DISPLY",
    "END-OF-PATH",
    "HEAD",
    "INTOL",
    "MACHIN",
    "MODE",
    "MULTAX",
    "OUTTOL",
    "PAINT",
    "PARTNO",
    "PLUNGE",
    "PPRINT",
    "REMARK",
    "SELCTL",
    "SPINDL",
    "SYN",
    "TLAXIS",
    "TOLER",
    "TOOL PATH",
    "TPRINT",
    "VERIFY",
    "ZSURF",
];

/// One minute, s.
const MINUTE: f64 = 60.0;

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
        crate::lexer::check_text(&self.text, 0)?;
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
                let end = self.tip + step;
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
            "LOADTL" | "LOAD" => self.load_tool(statement)?,
            "END" | "FINI" => self.ended = true,
            _ if SILENT.iter().any(|silent| name.starts_with(silent)) => {}
            _ => {
                let name = statement.name.as_str().into();
                let fault = at(StatementError::NotSupported { name });
                if !self.settings.lenient {
                    return Err(fault);
                }
                self.warn(fault);
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

    fn warn(&mut self, fault: Fault) {
        if self.warnings.len() < MOST_WARNINGS {
            let place = self.place(fault.span);
            let notice = Notice::Skipped(fault.reason);
            self.warnings.push(Warning::new(place, notice, &self.text));
        } else {
            self.more_warnings += 1;
        }
    }

    fn feedrate(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        let (name, wanted) = ("FEDRAT", "a number, and MMPM, IPM or nothing");
        let wrong = || {
            Fault::new(
                statement.span,
                StatementError::WrongWord { name, wanted }.into(),
            )
        };
        if statement.has("RAPID") {
            self.rapid = true;
            return Ok(());
        }
        let numbers = statement.numbers(true)?;
        let (Some(&value), false) = (numbers.first(), numbers.len() > 1) else {
            return Err(wrong());
        };
        let units = if statement.has("MMPM") {
            Units::Millimeter
        } else if statement.has("IPM") {
            Units::Inch
        } else if statement.has("MMPR") || statement.has("IPR") {
            return Err(wrong());
        } else {
            self.units
        };
        if value <= 0.0 {
            let quantity = "feedrate";
            return Err(Fault::new(
                statement.span,
                Reason::NotPositive { quantity, value },
            ));
        }
        self.feedrate = Some(units.length(value) / MINUTE);
        Ok(())
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

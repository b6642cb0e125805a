//! Cutter location files: tool poses by GOTO, circles, feedrates.
//!
//! Source: ISO 4343 (APT) as CAM systems write it. The tool tip is in mm or inch by `UNITS`; `RAPID`
//! holds for one move; `CIRCLE` names centre, axis and radius of the arc that the next `GOTO` ends,
//! counter-clockwise about its axis. Not here: cycles and definitions of geometry, which are refused.

use crate::chords::count;
use crate::error::{Fault, Notice, ProgramError, Warning};
use crate::lines::{LONGEST_LINE, Lines};
use crate::place::{Place, Span};
use crate::program::MOST_WARNINGS;
use crate::reason::Reason;
use crate::settings::Settings;
use crate::splines::CHORD_SHARE;
use crate::statement::Statement;
use crate::statement_error::StatementError;
use crate::tools::LARGEST_TOOL;
use crate::units::{Units, within_reach};
use std::collections::{BTreeSet, VecDeque};
use std::io::BufRead;
use std::sync::Arc;
use toolglide_kinematics::numeric::{ARC_RADIUS_MISMATCH, ARC_RADIUS_MISMATCH_SHARE};
use toolglide_kinematics::{Feedrate, PoseEnd, PoseFeed, PoseMove, Tolerance, ToolPose, Vector};

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
    lines: Lines<R>,
    /// The statement being read, over all its lines.
    text: Vec<u8>,
    settings: Settings,
    units: Units,
    feedrate: Option<f64>,
    rapid: bool,
    tip: Vector<3>,
    orientation: Vector<3>,
    circle: Option<Circle>,
    waiting: VecDeque<PoseMove>,
    pub(crate) warnings: Vec<Warning>,
    pub(crate) more_warnings: u64,
    pub(crate) statements: u64,
    pub(crate) tools_used: BTreeSet<u32>,
    pub(crate) past_refusals: bool,
    ended: bool,
}

/// The arc that the next GOTO ends.
#[derive(Clone, Copy, Debug)]
struct Circle {
    center: Vector<3>,
    axis: Vector<3>,
    radius: f64,
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

    /// Tip and orientation of a statement; without an orientation the last one stays.
    fn pose(
        &self,
        statement: &Statement<'_>,
        name: &'static str,
    ) -> Result<(Vector<3>, Vector<3>), Fault> {
        let numbers = statement.numbers(false)?;
        let (tip, orientation) = match numbers[..] {
            [x, y, z] => ([x, y, z], self.orientation),
            [x, y, z, i, j, k] => ([x, y, z], Vector::<3>::new(i, j, k)),
            _ => {
                let (given, wanted) = (numbers.len(), "3 or 6");
                let reason = StatementError::WrongCount {
                    name,
                    given,
                    wanted,
                };
                return Err(Fault::new(statement.span, reason.into()));
            }
        };
        let tip = Vector::<3>::from(tip).map(|length| self.units.length(length));
        self.check_reach(tip, statement)?;
        let pose = ToolPose::new(tip, orientation)
            .map_err(|reason| Fault::new(statement.span, Reason::Path(reason)))?;
        Ok((pose.tip(), pose.orientation()))
    }

    fn check_reach(&self, point: Vector<3>, statement: &Statement<'_>) -> Result<(), Fault> {
        for (letter, &length) in ['X', 'Y', 'Z'].into_iter().zip(point.iter()) {
            within_reach(letter, length).map_err(|reason| Fault::new(statement.span, reason))?;
        }
        Ok(())
    }

    fn circle(&self, statement: &Statement<'_>) -> Result<Circle, Fault> {
        let numbers = statement.numbers(true)?;
        let [x, y, z, i, j, k, radius] = numbers[..] else {
            let (name, given, wanted) = ("CIRCLE", numbers.len(), "7: centre, axis and radius");
            let reason = StatementError::WrongCount {
                name,
                given,
                wanted,
            };
            return Err(Fault::new(statement.span, reason.into()));
        };
        let center = Vector::<3>::new(x, y, z).map(|length| self.units.length(length));
        self.check_reach(center, statement)?;
        let axis = ToolPose::new(center, Vector::<3>::new(i, j, k))
            .map_err(|reason| Fault::new(statement.span, Reason::Path(reason)))?
            .orientation();
        let radius = self.units.length(radius);
        if !(radius > 0.0 && radius.is_finite()) {
            let (quantity, value) = ("radius of the circle", radius);
            let reason = Reason::NotPositive { quantity, value };
            return Err(Fault::new(statement.span, reason));
        }
        Ok(Circle {
            center,
            axis,
            radius,
        })
    }

    fn go_to(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        let (tip, orientation) = self.pose(statement, "GOTO")?;
        match self.circle.take() {
            Some(circle) => self.arc(&circle, tip, orientation, statement),
            None => self.line(tip, orientation, statement),
        }
    }

    fn line(
        &mut self,
        tip: Vector<3>,
        orientation: Vector<3>,
        statement: &Statement<'_>,
    ) -> Result<(), Fault> {
        (self.tip, self.orientation) = (tip, orientation);
        let feed = self.feed(statement)?;
        let pose = self.tool_pose(tip, orientation, statement)?;
        self.push(
            PoseEnd::Pose(pose),
            feed,
            self.settings.tolerance,
            statement,
        )
    }

    fn tool_pose(
        &self,
        tip: Vector<3>,
        orientation: Vector<3>,
        statement: &Statement<'_>,
    ) -> Result<ToolPose, Fault> {
        ToolPose::new(tip, orientation)
            .map_err(|reason| Fault::new(statement.span, Reason::Path(reason)))
    }

    /// Chords of an arc, rising evenly along its axis; the orientation turns evenly too.
    fn arc(
        &mut self,
        circle: &Circle,
        tip: Vector<3>,
        orientation: Vector<3>,
        statement: &Statement<'_>,
    ) -> Result<(), Fault> {
        let (start, before) = (self.tip, self.orientation);
        (self.tip, self.orientation) = (tip, orientation);
        let radius = circle.radius;
        let allowed = ARC_RADIUS_MISMATCH.max(ARC_RADIUS_MISMATCH_SHARE * radius);
        let across = |point: Vector<3>| {
            let from = point - circle.center;
            from - circle.axis * from.dot(&circle.axis)
        };
        let (from, to) = (across(start), across(tip));
        for (which, out) in [("start", from), ("end", to)] {
            let distance = out.norm();
            if (distance - radius).abs() > allowed {
                let reason = StatementError::OffCircle {
                    which,
                    distance,
                    radius,
                    allowed,
                };
                return Err(Fault::new(statement.span, reason.into()));
            }
        }
        let turn = circle.axis.dot(&from.cross(&to)).atan2(from.dot(&to));
        let sweep = if turn > 0.0 {
            turn
        } else {
            turn + std::f64::consts::TAU
        };
        let rise = circle.axis * (tip - start).dot(&circle.axis);
        let tolerance = self.settings.tolerance.length();
        let chords = count(radius, sweep, CHORD_SHARE * tolerance);
        let kept =
            Tolerance::new(tolerance * (1.0 - CHORD_SHARE)).unwrap_or(self.settings.tolerance);
        let feed = self.feed(statement)?;
        let base = start - from;
        for chord in 1..=chords {
            let share = f64::from(chord) / f64::from(chords);
            let (sine, cosine) = (share * sweep).sin_cos();
            let out = from * cosine + circle.axis.cross(&from) * sine;
            let point = if chord == chords {
                tip
            } else {
                base + out + rise * share
            };
            let blend = before + (orientation - before) * share;
            let length = blend.norm();
            let turned = if length > 0.5 {
                blend / length
            } else {
                orientation
            };
            let turned = if chord == chords { orientation } else { turned };
            let pose = self.tool_pose(point, turned, statement)?;
            self.push(PoseEnd::Pose(pose), feed, kept, statement)?;
        }
        Ok(())
    }

    fn feed(&mut self, statement: &Statement<'_>) -> Result<PoseFeed, Fault> {
        if std::mem::take(&mut self.rapid) {
            return Ok(PoseFeed::Rapid);
        }
        let fault = |reason| Fault::new(statement.span, reason);
        let speed = self.feedrate.ok_or_else(|| fault(Reason::NoFeedrate))?;
        let feedrate = Feedrate::new(speed).map_err(|_| fault(Reason::Feedrate { speed }))?;
        Ok(PoseFeed::Speed(feedrate))
    }

    fn push(
        &mut self,
        end: PoseEnd,
        feed: PoseFeed,
        tolerance: Tolerance,
        statement: &Statement<'_>,
    ) -> Result<(), Fault> {
        let line = u32::try_from(self.lines.count()).unwrap_or(u32::MAX);
        let next = PoseMove::new(end, feed, tolerance)
            .map_err(|reason| Fault::new(statement.span, Reason::Path(reason)))?;
        self.waiting.push_back(next.from_line(line));
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

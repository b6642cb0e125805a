//! Applies coordinate systems and feedrates of cutter location files.
//!
//! Source: `MSYS` of NX, which names origin, X axis and Y axis of the system in which the points behind it are
//! written; `FEDRAT` and `SPINDL` of ISO 4343. A system moves the part, so that all points and directions are taken to
//! the system of the file before any `MSYS`. Not here: moves.

use crate::apt::CutterLocations;
use crate::apt::statement::Statement;
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::error::statement::StatementError;
use crate::interpreter::frame::Frame;
use crate::interpreter::units::Units;
use std::io::BufRead;
use toolglide_kinematics::numeric::UNIT_LENGTH_ERROR;
use toolglide_kinematics::{Feedrate, Vector};

/// One minute, s.
const MINUTE: f64 = 60.0;

impl<R: BufRead> CutterLocations<R> {
    /// `MSYS/x,y,z,i,j,k,i,j,k`.
    pub(crate) fn system(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        let at = |reason: StatementError| Fault::new(statement.span, reason.into());
        let numbers = statement.numbers(false)?;
        let [x, y, z, i, j, k, l, m, n] = numbers[..] else {
            return Err(at(StatementError::WrongCount {
                name: "MSYS",
                given: numbers.len(),
                wanted: "9: origin, X axis and Y axis",
            }));
        };
        let along = Vector::<3>::new(i, j, k);
        let across = Vector::<3>::new(l, m, n);
        let lengths = [along.norm(), across.norm()];
        let upright = lengths
            .iter()
            .all(|length| (length - 1.0).abs() <= UNIT_LENGTH_ERROR);
        if !upright || along.dot(&across).abs() > UNIT_LENGTH_ERROR {
            return Err(at(StatementError::NoSystem {
                lengths,
                product: along.dot(&across),
            }));
        }
        let origin = Vector::<3>::new(x, y, z).map(|length| self.units.length(length));
        self.check_reach(origin, statement)?;
        let frame = Frame::of(origin, along, across);
        if frame != self.frame {
            self.frame = frame;
            // Until a point says otherwise the tool stands along the Z of the new system.
            self.orientation = frame.direction(Vector::<3>::z());
        }
        Ok(())
    }

    /// `FEDRAT`.
    pub(crate) fn feedrate(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        let at = |reason: StatementError| Fault::new(statement.span, reason.into());
        let (name, wanted) = ("FEDRAT", "a number, and MMPM, IPM, MMPR, IPR or nothing");
        let wrong = || at(StatementError::WrongWord { name, wanted });
        if statement.has("RAPID") {
            self.rapid = true;
            return Ok(());
        }
        if statement.has("INVERS") || statement.has("FRN") {
            return Err(at(StatementError::InverseTime));
        }
        let numbers = statement.numbers(true)?;
        let (Some(&value), false) = (numbers.first(), numbers.len() > 1) else {
            return Err(wrong());
        };
        let has = |word| statement.has(word);
        let (units, per_turn) = if has("MMPM") {
            (Units::Millimeter, false)
        } else if has("IPM") {
            (Units::Inch, false)
        } else if has("MMPR") {
            (Units::Millimeter, true)
        } else if has("IPR") {
            (Units::Inch, true)
        } else {
            (self.units, false)
        };
        if value <= 0.0 {
            let quantity = "feedrate";
            return Err(Fault::new(
                statement.span,
                Reason::NotPositive { quantity, value },
            ));
        }
        let length = units.length(value);
        self.per_turn = per_turn.then_some(length);
        if per_turn {
            return self.pace_by_turns(statement);
        }
        self.feedrate = Some(length / MINUTE);
        Ok(())
    }

    /// `SPINDL`: a speed in turns a minute is one that a feedrate for each turn needs.
    pub(crate) fn spindle(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        let Some(&speed) = statement.numbers(true)?.first() else {
            return Ok(());
        };
        let surface = ["SFM", "SMM", "SFPM", "SMPM"];
        let turns = !surface.iter().any(|word| statement.has(word));
        self.spindle_speed = Some(speed).filter(|&speed| turns && speed > 0.0);
        if self.per_turn.is_some() {
            return self.pace_by_turns(statement);
        }
        Ok(())
    }

    /// The feedrate of a feedrate for each turn.
    fn pace_by_turns(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        let (Some(length), Some(speed)) = (self.per_turn, self.spindle_speed) else {
            let reason = StatementError::NoSpindleSpeed;
            return Err(Fault::new(statement.span, reason.into()));
        };
        let speed = length * speed / MINUTE;
        Feedrate::new(speed).map_err(|_| Fault::new(statement.span, Reason::Feedrate { speed }))?;
        self.feedrate = Some(speed);
        Ok(())
    }
}

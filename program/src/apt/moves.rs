//! Builds moves of cutter location files, with or without an orientation.
//!
//! Source: `GOTO`, `GODLTA`, `FROM`, `RAPID`. Not here: arcs, see `cl_arc`.

use crate::apt::CutterLocations;
use crate::apt::statement::Statement;
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::error::statement::StatementError;
use crate::interpreter::units::within_reach;
use std::io::BufRead;
use toolglide_kinematics::{Feedrate, PoseEnd, PoseFeed, PoseMove, Tolerance, ToolPose, Vector};

impl<R: BufRead> CutterLocations<R> {
    /// Tip and orientation of a statement; without an orientation the last one stays.
    pub(crate) fn pose(
        &self,
        statement: &Statement<'_>,
        name: &'static str,
    ) -> Result<(Vector<3>, Vector<3>), Fault> {
        let numbers = statement.numbers(false)?;
        let (tip, orientation) = match numbers[..] {
            [x, y, z] => ([x, y, z], self.orientation),
            [x, y, z, i, j, k] => {
                let way = Vector::<3>::new(i, j, k);
                ([x, y, z], self.frame.direction(way))
            }
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
        let tip = self.frame.out(tip);
        self.check_reach(tip, statement)?;
        let pose = ToolPose::new(tip, orientation)
            .map_err(|reason| Fault::new(statement.span, Reason::Path(reason)))?;
        Ok((pose.tip(), pose.orientation()))
    }

    pub(crate) fn check_reach(
        &self,
        point: Vector<3>,
        statement: &Statement<'_>,
    ) -> Result<(), Fault> {
        for (letter, &length) in ['X', 'Y', 'Z'].into_iter().zip(point.iter()) {
            within_reach(letter, length).map_err(|reason| Fault::new(statement.span, reason))?;
        }
        Ok(())
    }

    pub(crate) fn go_to(&mut self, statement: &Statement<'_>) -> Result<(), Fault> {
        let (tip, orientation) = self.pose(statement, "GOTO")?;
        match self.circle.take() {
            Some(circle) => self.arc(&circle, tip, orientation, statement),
            None => self.line(tip, orientation, statement),
        }
    }

    pub(crate) fn line(
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

    pub(crate) fn tool_pose(
        &self,
        tip: Vector<3>,
        orientation: Vector<3>,
        statement: &Statement<'_>,
    ) -> Result<ToolPose, Fault> {
        ToolPose::new(tip, orientation)
            .map_err(|reason| Fault::new(statement.span, Reason::Path(reason)))
    }

    pub(crate) fn feed(&mut self, statement: &Statement<'_>) -> Result<PoseFeed, Fault> {
        if std::mem::take(&mut self.rapid) {
            return Ok(PoseFeed::Rapid);
        }
        let fault = |reason| Fault::new(statement.span, reason);
        let speed = self.feedrate.ok_or_else(|| fault(Reason::NoFeedrate))?;
        let feedrate = Feedrate::new(speed).map_err(|_| fault(Reason::Feedrate { speed }))?;
        Ok(PoseFeed::Speed(feedrate))
    }

    pub(crate) fn push(
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
}

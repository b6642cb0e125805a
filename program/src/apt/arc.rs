//! Builds arcs of cutter location files.
//!
//! Source: `CIRCLE/x,y,z,i,j,k,r`, behind which NX writes four numbers more, and the `GOTO` where the arc ends: counter-clockwise about its axis, as
//! chords within a share of the tolerance. Not here: other statements.

use crate::apt::CutterLocations;
use crate::apt::statement::Statement;
use crate::curves::arcs::allowed_mismatch;
use crate::curves::chords::count;
use crate::curves::splines::CHORD_SHARE;
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::error::statement::StatementError;
use std::io::BufRead;
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{PoseEnd, Tolerance, ToolPose, Vector};

/// The arc that the next GOTO ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle {
    pub(crate) center: Vector<3>,
    pub(crate) axis: Vector<3>,
    pub(crate) radius: f64,
}

impl<R: BufRead> CutterLocations<R> {
    pub(crate) fn circle(&self, statement: &Statement<'_>) -> Result<Circle, Fault> {
        let numbers = statement.numbers(true)?;
        let wrong = |given| {
            let (name, wanted) = ("CIRCLE", "7 to 11: centre, axis, radius");
            let reason = StatementError::WrongCount {
                name,
                given,
                wanted,
            };
            Fault::new(statement.span, reason.into())
        };
        let [x, y, z, i, j, k, radius, ref more @ ..] = numbers[..] else {
            return Err(wrong(numbers.len()));
        };
        // NX writes tolerances and the size of the tool behind the radius.
        if more.len() > 4 {
            return Err(wrong(numbers.len()));
        }
        let center = Vector::<3>::new(x, y, z).map(|length| self.units.length(length));
        let center = self.frame.out(center);
        self.check_reach(center, statement)?;
        let axis = self.frame.direction(Vector::<3>::new(i, j, k));
        let axis = ToolPose::new(center, axis)
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

    /// Chords of an arc, rising evenly along its axis; the orientation turns evenly too.
    pub(crate) fn arc(
        &mut self,
        circle: &Circle,
        tip: Vector<3>,
        orientation: Vector<3>,
        statement: &Statement<'_>,
    ) -> Result<(), Fault> {
        let (start, before) = (self.tip, self.orientation);
        (self.tip, self.orientation) = (tip, orientation);
        let radius = circle.radius;
        let allowed = allowed_mismatch(self.units, radius);
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
        let growth = if from.norm() > SHORTEST_LENGTH {
            to.norm() / from.norm()
        } else {
            1.0
        };
        for chord in 1..=chords {
            let share = f64::from(chord) / f64::from(chords);
            let (sine, cosine) = (share * sweep).sin_cos();
            // Ends that were rounded are on circles of their own.
            let size = 1.0 + share * (growth - 1.0);
            let out = (from * cosine + circle.axis.cross(&from) * sine) * size;
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
}

//! Judges set-points of axes against a path of poses.
//!
//! Source: forward kinematics of every row; divided differences for the limits, of which rounding takes
//! its part, so that what is reported is certain. The axes are judged in `axes`, the tool in `course`. Tip and
//! tool are followed each for itself. Not here: motion between the rows, stops inside the path, and whether tip
//! and tool are on the same move at once.

mod axes;
mod course;
mod parts;
mod spacing;
mod track;

use crate::VerifyError;
use crate::poses::MEETING_SLACK;
use crate::poses::report::{AxisPeaks, PoseReport, PoseViolation};
use crate::report::{Peak, Place};
use parts::{Followed, Row, Way, add};
use std::collections::VecDeque;
use toolglide_kinematics::AxisVector;
use toolglide_kinematics::ToolPose;
use toolglide_kinematics::Vector;
use toolglide_kinematics::angle_between;
use toolglide_kinematics::{Axis, MachineKinematics};
use toolglide_kinematics::{PoseLeg, PosePath};
use track::Track;

/// How far from the machine's zero a tip may be beyond its own distance, for rounding of angles, mm.
const LEVER: f64 = 500.0;

/// What an orientation may be rounded by, rad: some operations on numbers up to 1.
const ORIENTATION_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Axis positions at a time, and by what more than in writing rotary axes may have been rounded there, rad.
#[derive(Clone, Copy, Debug)]
struct Sighting {
    time: f64,
    axes: AxisVector,
    wobble: f64,
    /// Distance from the axes at which the wobble moves the linear ones, mm.
    lever: f64,
}

/// Judges set-points of the axes of a machine row by row.
pub struct PoseSetPointJudge<'m> {
    machine: &'m dyn MachineKinematics,
    axes: Vec<Axis>,
    rounding: Vec<f64>,
    /// Moves of the path, and the pose at its end, where it ends with a move of the tool.
    moves: u32,
    end: Option<ToolPose>,
    place: Place,
    tip: Track,
    tool: Track,
    rows: VecDeque<Sighting>,
    /// The row that waits for the next one, the one before, and how the tool bends there.
    held: Option<Row>,
    before: Option<Row>,
    bends: [Vector<3>; 2],
    start: f64,
    report: PoseReport,
}

impl std::fmt::Debug for PoseSetPointJudge<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PoseSetPointJudge")
            .field("place", &self.place())
            .field("report", &self.report)
            .finish_non_exhaustive()
    }
}

impl<'m> PoseSetPointJudge<'m> {
    /// A judge for a machine with the limits of `axes`, whose set-points are rounded by at most
    /// `rounding`, one per axis, mm and rad.
    #[must_use]
    pub fn new(machine: &'m dyn MachineKinematics, axes: Vec<Axis>, rounding: &[f64]) -> Self {
        let peaks = axes
            .iter()
            .map(|axis| AxisPeaks {
                name: axis.name,
                velocity: Peak::default(),
                acceleration: Peak::default(),
                jerk: Peak::default(),
                lowest: f64::INFINITY,
                highest: f64::NEG_INFINITY,
            })
            .collect();
        Self {
            machine,
            axes,
            rounding: rounding.to_vec(),
            moves: 0,
            end: None,
            place: Place::default(),
            tip: Track::default(),
            tool: Track::default(),
            rows: VecDeque::with_capacity(4),
            held: None,
            before: None,
            bends: [Vector::zeros(); 2],
            start: 0.0,
            report: PoseReport::new(peaks),
        }
    }

    /// Takes the next leg of the path; all of them before the first row.
    pub fn expect(&mut self, leg: &PoseLeg) {
        let (linear, rotary) = leg.way_of_axes(&self.axes);
        self.report.path_length += leg.length() + linear;
        self.report.path_angle += leg.angle() + rotary;
        let place = Place {
            mv: self.moves,
            line: leg.line,
        };
        self.moves = self.moves.saturating_add(1);
        self.end = match &leg.path {
            PosePath::Tool { tip, turn } => ToolPose::new(tip[1], turn.end()).ok(),
            PosePath::Rotary { tip, axes, .. } => {
                let tool = self.machine.forward(&axes[1]).ok();
                tool.and_then(|tool| ToolPose::new(tip[1], tool.orientation()).ok())
            }
            _ => None,
        };
        self.place = place;
        add(&mut self.tip.parts, Followed::Tip, leg, place);
        add(&mut self.tool.parts, Followed::Tool, leg, place);
    }

    /// Judges the next row.
    ///
    /// # Errors
    /// [`VerifyError::Time`] for a time that does not come after the one before.
    pub fn observe(&mut self, time: f64, at: &AxisVector) -> Result<(), VerifyError> {
        if let Some(before) = self.rows.back() {
            if !(time > before.time && time.is_finite()) {
                return Err(VerifyError::Time {
                    index: self.report.observed,
                    time,
                    before: before.time,
                });
            }
        } else {
            self.start = time;
        }
        self.report.observed += 1;
        self.report.cycle_time = time - self.start;
        let place = self.place();
        if self.rows.len() == 4 {
            self.rows.pop_front();
        }
        let pose = self.machine.forward(at);
        self.rows.push_back(Sighting {
            time,
            axes: *at,
            wobble: pose.as_ref().map_or(0.0, |pose| self.wobble(pose)),
            lever: pose.as_ref().map_or(0.0, |pose| pose.tip().norm()) + LEVER,
        });
        self.judge_axes(place);
        match pose {
            Ok(pose) => self.judge_pose(time, &pose, at),
            Err(reason) => self.report.add(PoseViolation::Unreachable {
                reason: reason.to_string(),
                time,
                place,
            }),
        }
        Ok(())
    }

    /// The report, once all rows were seen.
    #[must_use]
    pub fn finish(mut self) -> PoseReport {
        self.report.moves = self.moves;
        if let Some(last) = self.held {
            self.follow(&last, [Vector::zeros(); 2]);
            if let Some(end) = self.end {
                let [tip, tool] = last.slack;
                let there = (last.pose.tip() - end.tip()).norm() <= tip + MEETING_SLACK
                    && angle_between(&last.pose.orientation(), &end.orientation())
                        <= tool + MEETING_SLACK;
                if !there {
                    let place = self.place;
                    self.report.add(PoseViolation::StopNotMade { place });
                }
            }
        }
        for followed in [Followed::Tip, Followed::Tool] {
            self.tell(followed);
        }
        self.report
    }

    /// Reports what was found of the tip or of the tool.
    fn tell(&mut self, followed: Followed) {
        let (track, report) = match followed {
            Followed::Tip => (&mut self.tip, &mut self.report),
            Followed::Tool => (&mut self.tool, &mut self.report),
        };
        let found = track.finish();
        let (share, away) = (track.share, track.away);
        if followed == Followed::Tip {
            report.raise_tip(share.value, away.value, away.time, away.place);
            (report.tip_corner_ratio, report.tip_corner) = (found.corner_share, found.corner);
        } else {
            report.raise_orientation(share.value, away.value, away.time, away.place);
            report.orientation_corner_ratio = found.corner_share;
            report.orientation_corner = found.corner;
        }
        report.violations += found.more;
        for outside in found.outside {
            let part = &track.parts[outside.part];
            let (value, time, place) = (outside.value, outside.time, part.place);
            let tolerance = if outside.at_end {
                part.at_end
            } else {
                part.tolerance
            };
            // Straight moves of axes are followed with the tip and with the tool, and told once.
            if part.is_of_axes() && followed == Followed::Tool {
                continue;
            }
            report.add(match (&part.way, outside.at_end) {
                (Way::Axes(_), _) => PoseViolation::AxesDeviation { value, time, place },
                (Way::Line(_), false) => PoseViolation::TipDeviation {
                    value,
                    tolerance,
                    time,
                    place,
                },
                (Way::Line(_), true) => PoseViolation::TipCorner {
                    value,
                    tolerance,
                    place,
                },
                (Way::Arc(_) | Way::Rotary(_), false) => PoseViolation::OrientationDeviation {
                    value,
                    tolerance,
                    time,
                    place,
                },
                (Way::Arc(_) | Way::Rotary(_), true) => PoseViolation::OrientationCorner {
                    value,
                    tolerance,
                    place,
                },
            });
        }
    }

    fn place(&self) -> Place {
        self.tip.place().unwrap_or_default()
    }

    /// What rounding of an orientation may do to an axis: beside a pole of the machine it turns by the more the
    /// nearer the tool is to the pole.
    fn wobble(&self, pose: &ToolPose) -> f64 {
        let tool = pose.orientation();
        self.machine.pole(&tool).map_or(0.0, |pole| {
            ORIENTATION_ROUNDING / angle_between(&pole, &tool).max(ORIENTATION_ROUNDING)
        })
    }

    /// What rounding of the axes may do to the tip and to the orientation.
    fn slack(&self, pose: &ToolPose) -> [f64; 2] {
        let rounding = self
            .rounding
            .iter()
            .fold(0.0, |most: f64, one| most.max(*one));
        let angle = 3.0 * rounding;
        [angle * (1.0 + pose.tip().norm() + LEVER), angle]
    }
}

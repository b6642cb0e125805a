//! Judges pose motion: both tolerances, and the axes of a machine behind its inverse kinematics.
//!
//! Source: the meaning of [`toolglide_kinematics::Tolerance`] and [`toolglide_kinematics::OrientationTolerance`], and the limits of
//! every axis at every instant. Not here: any formula of any planner or machine.

mod axes;
mod axis_limits;
mod corners_and_stops;
mod course;
mod pose_course;
mod report;
mod route;
mod set_points;
mod swing;
mod tool_deviation;

pub use pose_course::{PoseCourse, PoseFoot};
pub use report::{AxisPeaks, AxisQuantity, PoseReport, PoseViolation};
pub use set_points::PoseSetPointJudge;

use crate::report::{Peak, Place};
use axes::{Derivatives, Follower};
use route::Route;
use swing::Swing;
use toolglide_kinematics::AxisVector;
use toolglide_kinematics::MoveRange;
use toolglide_kinematics::PoseLeg;
use toolglide_kinematics::PosePiece;
use toolglide_kinematics::ToolPose;
use toolglide_kinematics::{Axis, MachineKinematics};

/// Relative room granted to limits that were found by interpolation: its error and its rounding.
const FOUND_SLACK: f64 = 1e-4;

/// Room granted to where two pieces meet, mm and rad: the rounding of their coefficients.
const MEETING_SLACK: f64 = 1e-8;

/// Jumps of velocity and acceleration below this share of the limit are noise of interpolation.
const JUMP_SHARE: f64 = 1e-3;

/// How far axes may leave a straight move of axes, mm and rad.
const STRAIGHT_SLACK: f64 = 1e-6;

/// Whether pieces of motion, which begin at rest at the axis positions `start`, keep the limits and the travel of every
/// axis, as [`PoseJudge`] sees it; tolerances and feedrates are not looked at.
#[must_use]
pub fn keeps_axis_limits<'p>(
    machine: &dyn MachineKinematics,
    axes: &[Axis],
    start: &AxisVector,
    pieces: impl IntoIterator<Item = &'p PosePiece>,
) -> bool {
    let mut judge = PoseJudge::new(machine, axes.to_vec(), start);
    for piece in pieces {
        judge.judge_axes(piece, Place::default());
        judge.time += piece.duration();
        if !judge.report.passes() {
            return false;
        }
    }
    true
}

/// Judges a motion of poses piece by piece while it is planned.
///
/// Legs are expected in path order, any number ahead of the motion. A piece is compared with the
/// legs that it says it serves, which must go forward.
pub struct PoseJudge<'m> {
    follower: Follower<'m>,
    route: Route,
    report: PoseReport,
    time: f64,
    served: Option<MoveRange>,
    /// State of the axes where the last piece ended.
    state: Vec<Derivatives>,
    rested: f64,
    /// Pose where the last piece ended, and how fast it did; no pose where the machine has none.
    pose: Option<ToolPose>,
    moving: f64,
}

impl std::fmt::Debug for PoseJudge<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PoseJudge")
            .field("time", &self.time)
            .field("report", &self.report)
            .finish_non_exhaustive()
    }
}

impl<'m> PoseJudge<'m> {
    /// A judge of motion from rest at the axis positions `start`.
    ///
    /// `axes` are those of the machine, with the limits to keep.
    #[must_use]
    pub fn new(machine: &'m dyn MachineKinematics, axes: Vec<Axis>, start: &AxisVector) -> Self {
        let peaks = axes
            .iter()
            .zip(start.iter())
            .map(|(axis, &position)| AxisPeaks {
                name: axis.name,
                velocity: Peak::default(),
                acceleration: Peak::default(),
                jerk: Peak::default(),
                lowest: position,
                highest: position,
            })
            .collect();
        Self {
            state: start
                .iter()
                .map(|&position| [position, 0.0, 0.0, 0.0])
                .collect(),
            follower: Follower::new(machine, axes, start),
            route: Route::default(),
            report: PoseReport::new(peaks),
            time: 0.0,
            served: None,
            rested: 0.0,
            pose: machine.forward(start).ok(),
            moving: 0.0,
        }
    }

    /// Takes the next leg of the path.
    pub fn expect(&mut self, leg: &PoseLeg) {
        let (linear, rotary) = leg.way_of_axes(&self.follower.axes);
        self.report.path_length += leg.length() + linear;
        self.report.path_angle += leg.angle() + rotary;
        self.route.expect(leg.clone());
    }

    /// Judges the next piece of the motion. The legs that it serves have been expected before.
    pub fn observe(&mut self, piece: &PosePiece) {
        self.report.observed += 1;
        let Some((first, last)) = self.claim(piece.serves()) else {
            return;
        };
        let place = self.route.place(first);
        let duration = piece.duration();
        if !(duration >= 0.0 && duration.is_finite()) {
            let time = self.time;
            self.report.add(PoseViolation::NotFinite { time, place });
            return;
        }
        self.judge_axes(piece, place);
        match piece {
            PosePiece::Tool(tool) => self.judge_tool(tool, first, last),
            PosePiece::Rotary(moved) => self.judge_rotary(moved, first, last),
            PosePiece::Axes(moved) => {
                let machine = self.follower.machine;
                self.see_speed(moved, first);
                let mut position = moved.end;
                let mut pose = |time: f64| {
                    moved.at(time, &mut position);
                    machine.forward(&position).ok()
                };
                if self.straight(first, last) {
                    self.judge_straight(piece, first, last);
                } else if let Some(mut known) = pose(0.0) {
                    let mut sound = |time: f64| {
                        known = pose(time).unwrap_or(known);
                        known
                    };
                    self.judge_course(&mut sound, duration, first, last);
                    let positions = moved.positions.iter().map(|cubic| Some(*cubic)).collect();
                    self.judge_swing(
                        &Swing::of(self.follower.machine, positions, duration),
                        first,
                        last,
                    );
                }
            }
        }
        self.record_rest(piece, first, last);
        self.time += duration;
    }

    /// The report, once the motion is over.
    #[must_use]
    pub fn finish(mut self) -> PoseReport {
        self.pass(self.route.len());
        self.close(u32::MAX);
        if let Some(place) = self.route.last_unfinished() {
            self.report.add(PoseViolation::StopNotMade { place });
        }
        let still = self
            .state
            .iter()
            .zip(&self.follower.axes)
            .all(|(state, axis)| {
                state[1].abs() <= JUMP_SHARE * axis.limits.velocity()
                    && state[2].abs() <= JUMP_SHARE * axis.limits.acceleration()
            });
        if !still {
            let place = self.route.place(self.route.len().saturating_sub(1));
            self.report.add(PoseViolation::StopNotMade { place });
        }
        self.report.cycle_time = self.time;
        self.report.moves = self.route.len();
        self.report
    }

    /// The legs to judge a piece by; those behind are closed.
    fn claim(&mut self, serves: MoveRange) -> Option<(u32, u32)> {
        let MoveRange { first, last } = serves;
        let before = self.served.unwrap_or(MoveRange { first: 0, last: 0 });
        if first > last || last >= self.route.len() || first < before.first || last < before.last {
            let time = self.time;
            self.report
                .add(PoseViolation::MovesOutOfOrder { first, last, time });
            return None;
        }
        self.pass(first);
        self.served = Some(serves);
        self.close(first.saturating_sub(1));
        Some((first, last))
    }
}

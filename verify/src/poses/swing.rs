//! Measures how far the tool, and each rotary axis, are from the way that the rotary axes should go.
//!
//! Source: ours. At every instant the motion is held against a point of a move, and a point between those of two
//! instants is as good as any: so the difference of the rotary axes is a polynomial of the third degree, whose points of
//! Bezier bound it, and the tool differs by no more than the axes swing it. Where the bound is not near enough to what is
//! attained, the stretch of time is halved. Not here: the tool tip.

use crate::poses::tool_deviation::approach;
use crate::poses::{FOUND_SLACK, MEETING_SLACK, PoseJudge, PoseViolation};
use toolglide_kinematics::OrientationTolerance;
use toolglide_kinematics::PosePath;
use toolglide_kinematics::ToolPose;
use toolglide_kinematics::Vector;
use toolglide_kinematics::angle_between;
use toolglide_kinematics::{AxisKind, MachineKinematics};
use toolglide_kinematics::{AxisVector, MAX_AXES};
use toolglide_kinematics::{CubicInTime, RotaryPiece, cubic_at};

/// The bound is taken for the value when it is above what is attained by this share at most.
const PRECISION: f64 = 1e-5;

/// Shares of a tolerance below this are not told apart.
const MIN_RATIO: f64 = 1e-3;

/// How often a stretch is halved at most.
const HALVINGS: u32 = 30;

/// Share of the difference of an axis that counts where the tool does not tell it.
const FLOOR: f64 = 1.0 / OrientationTolerance::OF_AXIS;

/// Rotary axes against time.
pub(super) struct Swing<'m> {
    machine: &'m dyn MachineKinematics,
    /// One for each axis; none for those that are not looked at.
    cubics: Vec<Option<CubicInTime>>,
    duration: f64,
}

/// What is found at an instant on a move: which move, how far along, and the share of its tolerance.
#[derive(Clone, Copy)]
struct Seen {
    leg: u32,
    ends: [AxisVector; 2],
    share: f64,
    tolerance: f64,
}

/// The largest share of a tolerance, which is certain, and where.
struct Largest {
    share: f64,
    at: f64,
    leg: u32,
    tolerance: f64,
}

/// A move that counts, and its tolerance.
type Candidate = (u32, [AxisVector; 2], f64);

impl<'m> Swing<'m> {
    pub(super) fn of(
        machine: &'m dyn MachineKinematics,
        cubics: Vec<Option<CubicInTime>>,
        duration: f64,
    ) -> Self {
        Self {
            machine,
            cubics,
            duration,
        }
    }

    /// Rotary axes at a time; the others are 0.
    fn at(&self, time: f64) -> AxisVector {
        let mut at = AxisVector::zeros(self.machine.axes().len());
        for ((at, cubic), axis) in at.iter_mut().zip(&self.cubics).zip(self.machine.axes()) {
            if let (Some(cubic), AxisKind::Rotary) = (cubic, axis.kind) {
                *at = cubic_at(cubic, time);
            }
        }
        at
    }

    /// Where on a move the rotary axes are nearest to `at`, as a share, by what the tool shows of it.
    fn foot(&self, at: &AxisVector, ends: &[AxisVector; 2]) -> f64 {
        let Ok(swings) = self.machine.swings(at) else {
            return 0.0;
        };
        let (mut span, mut gone) = (Vector::<3>::zeros(), Vector::<3>::zeros());
        let (mut squares, mut products) = (0.0, 0.0);
        for (axis, limits) in self.machine.axes().iter().enumerate() {
            if limits.kind == AxisKind::Rotary {
                let (whole, part) = (ends[1][axis] - ends[0][axis], at[axis] - ends[0][axis]);
                span += swings[axis] * whole;
                gone += swings[axis] * part;
                squares += FLOOR * FLOOR * whole * whole;
                products += FLOOR * FLOOR * whole * part;
            }
        }
        squares += span.norm_squared();
        products += span.dot(&gone);
        if squares > 0.0 {
            (products / squares).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    /// The share of the tolerance at an instant, by the move that gives the least.
    fn seen(&self, at: &AxisVector, legs: &[Candidate]) -> Option<Seen> {
        let mut least: Option<Seen> = None;
        for &(leg, ends, tolerance) in legs {
            let share = self.foot(at, &ends);
            let away = self.apart(at, &between(&ends, share)) / tolerance;
            if least.is_none_or(|least| away < least.share) {
                least = Some(Seen {
                    leg,
                    ends,
                    share: away,
                    tolerance,
                });
            }
        }
        least
    }

    /// Angle between the tools at two positions of the rotary axes, or so much of the difference of an axis as counts.
    fn apart(&self, one: &AxisVector, other: &AxisVector) -> f64 {
        from_position(self.machine, one, other)
    }

    fn largest(&self, legs: &[Candidate], known: f64) -> Largest {
        let mut found = Largest {
            share: 0.0,
            at: 0.0,
            leg: 0,
            tolerance: 1.0,
        };
        self.search([0.0, self.duration], legs, known, 0, &mut found);
        found
    }

    fn search(
        &self,
        [begin, end]: [f64; 2],
        legs: &[Candidate],
        known: f64,
        depth: u32,
        found: &mut Largest,
    ) {
        let middle = 0.5 * (begin + end);
        let mut attained = found.share.max(known).max(MIN_RATIO);
        let mut nearest = None;
        for time in [begin, middle, end] {
            let at = self.at(time);
            let Some(seen) = self.seen(&at, legs) else {
                return;
            };
            if seen.share > found.share {
                (found.share, found.at, found.leg) = (seen.share, time, seen.leg);
                found.tolerance = seen.tolerance;
            }
            attained = attained.max(seen.share);
            if time <= middle {
                nearest = Some(seen);
            }
        }
        let Some(seen) = nearest else {
            return;
        };
        let bound = self.bound([begin, end], &seen.ends) / seen.tolerance;
        if bound <= attained * (1.0 + PRECISION) {
            return;
        }
        if depth >= HALVINGS {
            found.share = found.share.max(bound);
            return;
        }
        self.search([begin, middle], legs, known, depth + 1, found);
        self.search([middle, end], legs, known, depth + 1, found);
    }

    /// What the rotary axes are at most from a move over a stretch of time, in what the tool shows.
    fn bound(&self, [begin, end]: [f64; 2], ends: &[AxisVector; 2]) -> f64 {
        let feet = [begin, end].map(|time| self.foot(&self.at(time), ends));
        let middle = self.at(0.5 * (begin + end));
        let Ok(swings) = self.machine.swings(&middle) else {
            return f64::INFINITY;
        };
        // Points of Bezier of the difference, axis by axis; how far the axes are from the middle, all together.
        let mut points = [[0.0; MAX_AXES]; 4];
        let mut radius = 0.0;
        for (axis, cubic) in self.cubics.iter().enumerate() {
            if self
                .machine
                .axes()
                .get(axis)
                .is_none_or(|axis| axis.kind != AxisKind::Rotary)
            {
                continue;
            }
            let Some(cubic) = cubic else {
                continue;
            };
            let (span, origin) = (ends[1][axis] - ends[0][axis], ends[0][axis]);
            let bezier = bezier(cubic, begin, end);
            let mut farthest: f64 = 0.0;
            for (point, value) in bezier.into_iter().enumerate() {
                let share = feet[0]
                    + (feet[1] - feet[0]) * f64::from(u8::try_from(point).unwrap_or(3)) / 3.0;
                let on_leg = origin + span * share;
                points[point][axis] = value - on_leg;
                farthest = farthest
                    .max((value - middle[axis]).abs())
                    .max((on_leg - middle[axis]).abs());
            }
            radius += farthest;
        }
        points
            .iter()
            .map(|point| {
                let mut shown = Vector::<3>::zeros();
                let (mut sum, mut most) = (0.0, 0.0_f64);
                for (value, swing) in point.iter().zip(&swings) {
                    shown += swing * *value;
                    sum += value.abs();
                    most = most.max(value.abs());
                }
                (shown.norm() + radius * sum).max(FLOOR * most)
            })
            .fold(0.0, f64::max)
    }
}

/// Points of Bezier of a polynomial over a stretch.
fn bezier(cubic: &CubicInTime, begin: f64, end: f64) -> [f64; 4] {
    let slope = |time: f64| cubic[1] + (2.0 * cubic[2] + 3.0 * cubic[3] * time) * time;
    let third = (end - begin) / 3.0;
    let (first, last) = (cubic_at(cubic, begin), cubic_at(cubic, end));
    [
        first,
        first + third * slope(begin),
        last - third * slope(end),
        last,
    ]
}

fn between(ends: &[AxisVector; 2], share: f64) -> AxisVector {
    let mut at = ends[0];
    for (at, end) in at.iter_mut().zip(ends[1].iter()) {
        *at += (end - *at) * share;
    }
    at
}

/// Angle between the tools at two positions of the rotary axes, rad, or the share of the largest difference of an axis
/// that counts where the tool does not tell it.
pub(super) fn from_position(
    machine: &dyn MachineKinematics,
    one: &AxisVector,
    other: &AxisVector,
) -> f64 {
    let (Ok(first), Ok(second)) = (machine.forward(one), machine.forward(other)) else {
        return f64::INFINITY;
    };
    let angle = angle_between(&first.orientation(), &second.orientation());
    angle.max(FLOOR * apart(machine, one, other).1)
}

/// The rotary axis that differs most, and by how much.
fn apart(machine: &dyn MachineKinematics, one: &AxisVector, other: &AxisVector) -> (usize, f64) {
    let mut most = (0, 0.0);
    for (axis, limits) in machine.axes().iter().enumerate() {
        let by = (one[axis] - other[axis]).abs();
        if limits.kind == AxisKind::Rotary && by > most.1 {
            most = (axis, by);
        }
    }
    most
}

/// Whether the rotary axes are where they should be.
pub(super) fn are_at(
    machine: &dyn MachineKinematics,
    one: &AxisVector,
    other: &AxisVector,
) -> bool {
    apart(machine, one, other).1 < MEETING_SLACK
}

impl PoseJudge<'_> {
    pub(super) fn judge_rotary(&mut self, piece: &RotaryPiece, first: u32, last: u32) {
        let machine = self.follower.machine;
        let near = self.follower.near;
        let mut known = self
            .pose
            .unwrap_or_else(|| ToolPose::rounded(piece.end_tip, Vector::<3>::z()));
        let mut pose = |time: f64| {
            let (tip, at) = piece.at(time, &near);
            if let Ok(tool) = machine.forward(&at) {
                known = ToolPose::rounded(tip, tool.orientation());
            }
            known
        };
        self.judge_course(&mut pose, piece.duration, first, last);
        let swing = Swing::of(machine, piece.rotary.clone(), piece.duration);
        self.judge_swing(&swing, first, last);
        self.judge_speed(&piece.tip, piece.duration, first, last);
    }

    /// How far the tool and the rotary axes are from the moves whose words say where the axes turn.
    pub(super) fn judge_swing(&mut self, swing: &Swing<'_>, first: u32, last: u32) {
        let mut legs: Vec<Candidate> = Vec::new();
        self.route.each(first, last, |number, leg| {
            if let PosePath::Rotary { axes, .. } = &leg.path {
                legs.push((number, *axes, leg.orientation_tolerance.angle()));
            }
        });
        if legs.is_empty() {
            return;
        }
        let found = swing.largest(&legs, self.report.orientation_ratio.value);
        let (time, place) = (self.time + found.at, self.route.place(found.leg));
        let (value, tolerance) = (found.share * found.tolerance, found.tolerance);
        self.report
            .raise_orientation(found.share, value, time, place);
        if value > tolerance * (1.0 + FOUND_SLACK) + MEETING_SLACK {
            self.report
                .add(swing.violation(found.at, &legs, value, tolerance, (time, place)));
        }
        let begin = self.time;
        self.route
            .each_end(first.saturating_sub(1), last, |leg, end| {
                let PosePath::Rotary { axes, .. } = &leg.path else {
                    return;
                };
                let found = approach(swing.duration, |time| {
                    swing.apart(&swing.at(time), &axes[1])
                });
                if found.0 < end.orientation.0 {
                    end.orientation = (found.0, begin + found.1);
                }
            });
    }
}

impl Swing<'_> {
    /// What is wrong at an instant: the tool, or an axis that it does not tell.
    fn violation(
        &self,
        at: f64,
        legs: &[Candidate],
        value: f64,
        tolerance: f64,
        (time, place): (f64, crate::report::Place),
    ) -> PoseViolation {
        let here = self.at(at);
        let seen = self.seen(&here, legs);
        let on_leg = seen.map(|seen| between(&seen.ends, self.foot(&here, &seen.ends)));
        let by = on_leg.map_or((0, 0.0), |on_leg| apart(self.machine, &here, &on_leg));
        if FLOOR * by.1 >= value * (1.0 - PRECISION) {
            PoseViolation::RotaryDeviation {
                axis: self.machine.axes().get(by.0).map_or('?', |axis| axis.name),
                value: by.1,
                tolerance: tolerance / FLOOR,
                time,
                place,
            }
        } else {
            PoseViolation::OrientationDeviation {
                value,
                tolerance,
                time,
                place,
            }
        }
    }
}

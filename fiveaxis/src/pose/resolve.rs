//! Resolves the words of a pose move into a leg on a machine.
//!
//! Source: tool-tip mode gives the tip in workpiece coordinates and the tool by rotary words, which
//! forward kinematics turns into an orientation; plain mode gives positions of axes. Not here:
//! reading programs.

use crate::error::FiveAxisError;
use crate::pose::block::PoseBlock;
use crate::singularity::{Spin, at_pole};
use toolglide_kinematics::numeric::SAME_ORIENTATION;
use toolglide_kinematics::{
    AxisKind, AxisVector, GreatCircle, KinematicsError, MachineKinematics, OrientationTolerance,
    PoseEnd, PoseFeed, PoseLeg, PoseMove, PosePath, ToolPose, ToolpathError, Vector, angle_between,
};

/// The angle that a tool sweeps is added up over turns of the axes of so much, rad, or so many of them.
const SWEPT: f64 = 0.01;
const MAX_SWEPT: f64 = 4096.0;

/// Turns moves into legs, one after the other.
pub struct Resolver<'m> {
    machine: &'m dyn MachineKinematics,
    orientation_tolerance: OrientationTolerance,
    about: Option<Vector<3>>,
    at: AxisVector,
    pose: ToolPose,
    count: u32,
}

impl std::fmt::Debug for Resolver<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Resolver")
            .field("at", &self.at)
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

impl<'m> Resolver<'m> {
    /// A resolver for a machine at the axis positions `start`.
    ///
    /// # Errors
    /// [`FiveAxisError::Machine`] when the machine cannot stand there.
    pub fn new(
        machine: &'m dyn MachineKinematics,
        start: AxisVector,
        orientation_tolerance: OrientationTolerance,
    ) -> Result<Self, FiveAxisError> {
        let pose = machine
            .forward(&start)
            .map_err(|reason| FiveAxisError::Machine { index: 0, reason })?;
        Ok(Self {
            machine,
            orientation_tolerance,
            about: None,
            at: start,
            pose,
            count: 0,
        })
    }

    /// The same, turning about `axis`, in workpiece coordinates, between orientations that point opposite
    /// ways.
    #[must_use]
    pub fn turning_about(mut self, axis: Vector<3>) -> Self {
        self.about = Some(axis);
        self
    }

    /// Where the path has come to.
    #[must_use]
    pub fn pose(&self) -> ToolPose {
        self.pose
    }

    /// The leg of the next move.
    ///
    /// # Errors
    /// [`FiveAxisError`] names the move and what is wrong with it.
    pub fn leg(&mut self, next: &PoseMove) -> Result<PoseLeg, FiveAxisError> {
        let index = self.count;
        self.count = self.count.saturating_add(1);
        let path = |reason| FiveAxisError::Path { index, reason };
        let machine = |reason| FiveAxisError::Machine { index, reason };
        let within = self.orientation_tolerance;
        let leg = |path| PoseLeg {
            path,
            feed: next.feed(),
            tip_tolerance: next.tolerance(),
            orientation_tolerance: within,
            stop: next.stops(),
            line: next.line(),
        };
        // Where no axis is called so, X, Y and Z can only be the tool tip.
        let has_linear = ['X', 'Y', 'Z']
            .iter()
            .all(|letter| self.machine.axes().iter().any(|axis| axis.name == *letter));
        let (end, axes) = match *next.end() {
            PoseEnd::Dwell { duration } => return Ok(leg(PosePath::Dwell { duration })),
            PoseEnd::Pose(pose) => {
                let pose = at_pole(self.machine, &pose, self.orientation_tolerance);
                // What is wrong with the move itself comes before what the machine says.
                self.turn(index, &pose)?;
                let axes = self.machine.inverse(&pose, &self.at).map_err(machine)?;
                (pose, axes)
            }
            PoseEnd::Axes {
                linear,
                rotary,
                tip,
                great_circle,
            } if tip || !has_linear => {
                let near = self.words(index, None, rotary, next)?;
                if !great_circle && let Some(axes) = self.placed(&linear, &near).map_err(machine)? {
                    return self.rotary(index, (linear, axes), next.feed(), leg);
                }
                let tool = self.machine.forward(&near).map_err(machine)?.orientation();
                let pose = ToolPose::new(linear, tool).map_err(path)?;
                let axes = self.machine.inverse(&pose, &near).map_err(machine)?;
                // A rapid goes to the very turns that its words say, straight on all axes: whoever
                // programs one wants to be there, and a table unwinds.
                if next.feed() == PoseFeed::Rapid && self.turns(&axes) {
                    let start = self.at;
                    self.at = axes;
                    self.pose = pose;
                    return Ok(leg(PosePath::Axes { start, end: axes }));
                }
                (pose, axes)
            }
            PoseEnd::Axes { linear, rotary, .. } => {
                let end = self.words(index, Some(linear), rotary, next)?;
                self.check_travel(&end).map_err(machine)?;
                let start = self.at;
                let turns = self.turns(&end);
                let pose = self.machine.forward(&end).map_err(machine)?;
                if turns {
                    self.at = end;
                    self.pose = pose;
                    return Ok(leg(PosePath::Axes { start, end }));
                }
                (pose, end)
            }
            _ => return Err(FiveAxisError::NoRate { index }),
        };
        let end = self.unturned(end);
        let made = leg(PosePath::Tool {
            tip: [self.pose.tip(), end.tip()],
            turn: self.turn(index, &end)?,
        });
        match self.follow(index, &made) {
            Ok(at) => self.at = at.unwrap_or(axes),
            // A rapid may take the axes another way round when theirs has come to its end.
            Err(FiveAxisError::Machine {
                reason: KinematicsError::Travel { .. },
                ..
            }) if next.feed() == PoseFeed::Rapid => {
                let start = std::mem::replace(&mut self.at, axes);
                self.pose = end;
                return Ok(leg(PosePath::Axes { start, end: axes }));
            }
            Err(refused) => return Err(refused),
        }
        self.pose = end;
        Ok(made)
    }

    /// Axis positions with the tip there and the rotary axes as in `near`; `None` for a machine of which these are not
    /// independent.
    fn placed(
        &self,
        tip: &Vector<3>,
        near: &AxisVector,
    ) -> Result<Option<AxisVector>, KinematicsError> {
        self.check_travel(near)?;
        match self.machine.place(tip, near) {
            Err(KinematicsError::Unreachable { .. }) => Ok(None),
            placed => placed.map(Some),
        }
    }

    /// A leg of which the words say how far the rotary axes turn.
    fn rotary(
        &mut self,
        index: u32,
        (tip, axes): (Vector<3>, AxisVector),
        feed: PoseFeed,
        leg: impl Fn(PosePath) -> PoseLeg,
    ) -> Result<PoseLeg, FiveAxisError> {
        let start = std::mem::replace(&mut self.at, axes);
        let refused = |reason| FiveAxisError::Machine { index, reason };
        let tool = self.machine.forward(&axes).map_err(refused)?;
        let pose = ToolPose::new(tip, tool.orientation());
        let pose = pose.map_err(|reason| FiveAxisError::Path { index, reason })?;
        let before = std::mem::replace(&mut self.pose, pose);
        // A rapid goes straight on all axes: whoever programs one wants to be there, and a table unwinds.
        if feed == PoseFeed::Rapid && self.turned(&start, &axes) {
            return Ok(leg(PosePath::Axes { start, end: axes }));
        }
        let only_rotary = |at: &AxisVector| {
            let mut at = *at;
            for (position, axis) in at.iter_mut().zip(self.machine.axes()) {
                if axis.kind == AxisKind::Linear {
                    *position = 0.0;
                }
            }
            at
        };
        let ends = [only_rotary(&start), only_rotary(&axes)];
        let angle = self.swept(&ends).map_err(refused)?;
        Ok(leg(PosePath::Rotary {
            tip: [before.tip(), tip],
            axes: ends,
            angle,
        }))
    }

    /// Angle that the tool sweeps while the rotary axes go evenly, rad: the sum over some parts.
    fn swept(&self, [start, end]: &[AxisVector; 2]) -> Result<f64, KinematicsError> {
        let turned: f64 = start
            .iter()
            .zip(end.iter())
            .map(|(start, end)| (end - start).abs())
            .sum();
        let parts = (turned / SWEPT).ceil().clamp(1.0, MAX_SWEPT);
        let mut tool = self.machine.forward(start)?.orientation();
        let (mut swept, mut part) = (0.0, 1.0);
        while part <= parts {
            let mut at = *start;
            for (at, end) in at.iter_mut().zip(end.iter()) {
                *at += (end - *at) * (part / parts);
            }
            let next = self.machine.forward(&at)?.orientation();
            swept += angle_between(&tool, &next);
            tool = next;
            part += 1.0;
        }
        Ok(swept)
    }

    /// The pose with the orientation that the tool has, where it is as good as the same: what is not turned
    /// is not left behind for the next move to jump over.
    fn unturned(&self, end: ToolPose) -> ToolPose {
        let now = self.pose.orientation();
        if angle_between(&now, &end.orientation()) < SAME_ORIENTATION {
            ToolPose::new(end.tip(), now).unwrap_or(end)
        } else {
            end
        }
    }

    /// The turn of the tool to a pose.
    fn turn(&self, index: u32, end: &ToolPose) -> Result<GreatCircle, FiveAxisError> {
        GreatCircle::between(&self.pose, end)
            .or_else(|reason| match (reason, &self.about) {
                (ToolpathError::Opposite { .. }, Some(axis)) => {
                    GreatCircle::about(&self.pose, end, axis)
                }
                (reason, _) => Err(reason),
            })
            .map_err(|reason| match reason {
                ToolpathError::Opposite { .. } => FiveAxisError::Opposite {
                    index,
                    from: self.pose.orientation().into(),
                    to: end.orientation().into(),
                },
                reason => FiveAxisError::Path { index, reason },
            })
    }

    /// Whether a rotary axis, or one that no tool pose knows, has to move to be at `end`.
    fn turns(&self, end: &AxisVector) -> bool {
        self.turned(&self.at, end)
    }

    fn turned(&self, start: &AxisVector, end: &AxisVector) -> bool {
        let axes = self.machine.axes();
        // Without an X of its own a machine calls the drives of its tool so.
        let second = axes.iter().any(|axis| axis.name == 'X');
        axes.iter()
            .zip(start.iter().zip(end.iter()))
            .any(|(axis, (start, end))| {
                let beside = second && matches!(axis.name, 'U' | 'V' | 'W');
                let apart = axis.kind == AxisKind::Rotary || beside;
                apart && (end - start).abs() > SAME_ORIENTATION
            })
    }

    /// Where the axes come to when they follow a leg without a jump; `None` for a leg that leads nowhere.
    fn follow(&self, index: u32, leg: &PoseLeg) -> Result<Option<AxisVector>, FiveAxisError> {
        let Some(block) = PoseBlock::of(leg, index, f64::INFINITY) else {
            return Ok(None);
        };
        Spin::arrival(&block, self.machine, &self.at).map(Some)
    }

    /// Axis positions by words: those of linear axes as they are where none are given.
    fn words(
        &self,
        index: u32,
        linear: Option<Vector<3>>,
        rotary: [f64; 3],
        next: &PoseMove,
    ) -> Result<AxisVector, FiveAxisError> {
        let axes = self.machine.axes();
        let mut positions = self.at;
        let mut words: Vec<(char, f64)> = Vec::with_capacity(9);
        if let Some(linear) = linear {
            words.extend(['X', 'Y', 'Z'].into_iter().zip(linear.iter().copied()));
        }
        let turning = ['A', 'B', 'C'].into_iter().zip(rotary);
        let turning = turning.zip(next.rotary_held());
        words.extend(turning.filter_map(|(word, held)| (!held).then_some(word)));
        words.extend(['U', 'V', 'W'].into_iter().zip(next.secondary()));
        for (letter, value) in words {
            match axes.iter().position(|axis| axis.name == letter) {
                Some(axis) => positions[axis] = value,
                None if value.abs() > 0.0 => {
                    return Err(FiveAxisError::NoAxis {
                        index,
                        axis: letter,
                        axes: axes.iter().map(|axis| axis.name).collect(),
                    });
                }
                None => {}
            }
        }
        Ok(positions)
    }

    fn check_travel(&self, at: &AxisVector) -> Result<(), KinematicsError> {
        for (axis, &position) in self.machine.axes().iter().zip(at.iter()) {
            if let Some((low, high)) = axis.travel
                && !(low..=high).contains(&position)
            {
                return Err(KinematicsError::Travel {
                    axis: axis.name,
                    kind: axis.kind,
                    position,
                    low,
                    high,
                });
            }
        }
        Ok(())
    }
}

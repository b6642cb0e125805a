//! Executes planned tool poses behind the inverse kinematics, by the law for every plan.
//!
//! Source: ours. The law asks of the axes only that the plan keeps their limits less the reserve, so no derivative of the
//! inverse kinematics is needed: one scalar, the rate of planned time, is controlled. With the planned peaks of the
//! motion instead of the limits of the machine it reacts sooner.

use crate::commands::Commands;
use crate::executor::Activity;
use crate::law::{Law, Rate, Ratios, snapped};
use crate::terms::Caps;
use alloc::collections::VecDeque;
use toolglide_kinematics::{
    AxisLimits, AxisVector, KinematicsError, MachineKinematics, MoveRange, PosePiece, Reserve,
    SamplePeriod,
};

/// Steps of planned time that are kept in hand beyond the braking distance and the time to settle.
const SPARE_STEPS: f64 = 8.0;

/// The numbers that an executor of poses is made with.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseSettings {
    ratios: Ratios,
    reserve: Reserve,
    period: SamplePeriod,
    greatest: f64,
    ahead: usize,
    behind: usize,
}

impl PoseSettings {
    /// The limits of each axis, mm or rad and s, which the plan keeps less the usual reserve, and the period of the ticks.
    #[must_use]
    pub fn new<'a>(limits: impl IntoIterator<Item = &'a AxisLimits>, period: SamplePeriod) -> Self {
        let mut ratios = Ratios {
            rise: 0.0,
            by_jerk: 0.0,
            by_acceleration: 0.0,
        };
        for axis in limits {
            let (v, a, j) = (axis.velocity(), axis.acceleration(), axis.jerk());
            ratios.rise = ratios.rise.max(a / j);
            ratios.by_jerk = ratios.by_jerk.max(v / j);
            ratios.by_acceleration = ratios.by_acceleration.max(v / a);
        }
        Self {
            ratios,
            reserve: Reserve::default(),
            period,
            greatest: 1.0,
            ahead: 4096,
            behind: 256,
        }
    }

    /// The same for a plan made with another reserve.
    #[must_use]
    pub fn with_reserve(mut self, reserve: Reserve) -> Self {
        self.reserve = reserve;
        self
    }

    /// The same for a plan whose fastest axis never exceeds this share of its velocity limit.
    #[must_use]
    pub fn with_velocity_share(mut self, share: f64) -> Self {
        if share > 0.0 && share < 1.0 {
            self.ratios.by_jerk *= share;
            self.ratios.by_acceleration *= share;
        }
        self
    }

    /// The same with room for so many pieces ahead, and as many kept behind for going backwards.
    #[must_use]
    pub fn with_room(mut self, ahead: usize, behind: usize) -> Self {
        (self.ahead, self.behind) = (ahead.max(16), behind);
        self
    }
}

/// One tick of executed poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExecutedPose {
    /// Axis positions, mm and rad.
    pub axes: AxisVector,
    /// Planned time by time.
    pub rate: f64,
    /// The moves that are followed.
    pub serves: MoveRange,
    /// What the executor does.
    pub activity: Activity,
}

/// Executes planned tool poses under commands: hold, resume, uniform override, reverse.
///
/// Nothing is allocated after construction but what the pieces themselves hold.
#[derive(Debug)]
pub struct PoseExecutor {
    law: Law,
    commands: Commands,
    pieces: VecDeque<(f64, PosePiece)>,
    room: usize,
    behind: usize,
    end: f64,
    at: usize,
    tau: f64,
    rate: Rate,
    axes: AxisVector,
    period: f64,
    /// Whether nothing comes behind what is known, which ends at rest.
    finished: bool,
    starved: bool,
    activity: Activity,
    serves: MoveRange,
}

impl PoseExecutor {
    /// An executor at rest at axis positions.
    #[must_use]
    pub fn new(axes: AxisVector, settings: &PoseSettings) -> Self {
        let period = settings.period.seconds();
        Self {
            law: Law::new(settings.ratios, settings.reserve.rho(), period),
            commands: Commands::new(Caps {
                feed: settings.greatest,
                rapid: 1.0,
                top: settings.greatest,
                uniform: true,
            }),
            pieces: VecDeque::with_capacity(settings.ahead + settings.behind + 1),
            room: settings.ahead,
            behind: settings.behind,
            end: 0.0,
            at: 0,
            tau: 0.0,
            rate: Rate { r: 0.0, s: 0.0 },
            axes,
            period,
            finished: false,
            starved: false,
            activity: Activity::Idle,
            serves: MoveRange::one(0),
        }
    }

    /// Takes the piece that follows; gives it back when there is no room.
    ///
    /// # Errors
    /// The piece, while as many are ahead as there is room for.
    #[allow(
        clippy::result_large_err,
        reason = "the piece is given back without allocation"
    )]
    pub fn feed(&mut self, piece: PosePiece) -> Result<(), PosePiece> {
        if self.pieces.len() - self.at > self.room || self.commands.is_aborted() {
            return Err(piece);
        }
        while self.at > self.behind {
            self.pieces.pop_front();
            self.at -= 1;
        }
        let duration = piece.duration();
        self.pieces.push_back((self.end, piece));
        self.end += duration;
        self.finished = false;
        Ok(())
    }

    /// Says that what was fed ends at rest and may be executed to its end.
    pub fn finish(&mut self) {
        self.finished = true;
    }

    /// What the operator wants.
    pub fn command(&mut self) -> &mut Commands {
        &mut self.commands
    }

    /// Planned time ahead of the motion, s.
    #[must_use]
    pub fn in_hand(&self) -> f64 {
        (self.end - self.tau).max(0.0)
    }

    /// Planned time that must be in hand for full rate, s.
    #[must_use]
    pub fn needs_in_hand(&self) -> f64 {
        self.law.uses_from(1.0) + self.law.rise() + SPARE_STEPS * self.period
    }

    /// Longest time in which a hold is over, s: the law from full rate, and the time to settle before it.
    #[must_use]
    pub fn stops_within(&self) -> f64 {
        self.law.steps_from(1.0) * self.period + 2.0 * self.law.rise()
    }

    /// The axis positions of the next tick.
    ///
    /// # Errors
    /// [`KinematicsError`] when the machine cannot take a pose of the plan.
    pub fn tick(
        &mut self,
        machine: &dyn MachineKinematics,
    ) -> Result<ExecutedPose, KinematicsError> {
        self.place(machine)?;
        let out = ExecutedPose {
            axes: self.axes,
            rate: self.rate.r,
            serves: self.serves,
            activity: self.activity,
        };
        self.advance();
        Ok(out)
    }

    /// Finds the axis positions at the present planned time.
    fn place(&mut self, machine: &dyn MachineKinematics) -> Result<(), KinematicsError> {
        while self.at + 1 < self.pieces.len() && self.pieces[self.at + 1].0 <= self.tau {
            // At a singularity the tool does not tell where an axis is: it stays where its own move has ended.
            if let PosePiece::Axes(piece) = &self.pieces[self.at].1 {
                self.axes = piece.end;
            }
            self.at += 1;
        }
        while self.at > 0 && self.pieces[self.at].0 > self.tau {
            self.at -= 1;
        }
        let Some((begin, piece)) = self.pieces.get(self.at) else {
            return Ok(());
        };
        let since = if self.tau >= self.end {
            piece.duration()
        } else {
            (self.tau - begin).max(0.0)
        };
        self.serves = piece.serves();
        self.axes = match piece {
            PosePiece::Tool(piece) => machine.follow(&piece.at(since), &self.axes)?,
            PosePiece::Rotary(piece) => {
                let (tip, at) = piece.at(since, &self.axes);
                machine.place(&tip, &at)?
            }
            PosePiece::Axes(piece) => {
                let mut axes = self.axes;
                piece.at(since, &mut axes);
                axes
            }
        };
        Ok(())
    }

    /// Decides the rate until the next tick, and goes there.
    fn advance(&mut self) {
        let direction = self.commands.direction();
        let begin = self.pieces.front().map_or(self.end, |first| first.0);
        let (known, open) = if direction > 0.0 {
            (self.end - self.tau, !self.finished)
        } else {
            (self.tau - begin, begin > 0.0)
        };
        self.starved = open && known < self.needs_in_hand();
        let caps = self.commands.caps();
        let held = self.commands.is_held() || caps.feed <= 0.0;
        let c = if held || self.starved {
            0.0
        } else {
            direction * caps.feed / caps.top
        };
        let at_rest = if direction > 0.0 {
            self.tau <= 0.0
        } else {
            self.tau >= self.end && self.finished
        };
        if at_rest && self.rate.r.abs() <= 0.0 && known > 0.0 {
            // The plan rests here: any rate may follow.
            self.rate = Rate { r: c, s: 0.0 };
        }
        let h = self.period;
        let u = self.law.decide(self.rate, c);
        let way = (self.rate.r + (0.5 * self.rate.s + u * h / 6.0) * h) * h;
        self.rate = snapped(self.rate.after(u, h), c, h);
        self.tau += way;
        if self.tau >= self.end || self.tau <= begin {
            // Both ends are rests when they are reached.
            self.tau = self.tau.clamp(begin, self.end);
            let leaves = if self.tau >= self.end {
                self.rate.r > 0.0
            } else {
                self.rate.r < 0.0
            };
            if leaves {
                self.rate = Rate { r: 0.0, s: 0.0 };
            }
        }
        let standing = self.rate.r.abs() <= 0.0 && self.rate.s.abs() <= 0.0;
        self.activity = if held && standing {
            if self.commands.is_aborted() {
                Activity::Aborted
            } else {
                Activity::Held
            }
        } else if held {
            Activity::Holding
        } else if self.tau >= self.end && (self.finished || self.pieces.is_empty()) {
            Activity::Idle
        } else if self.starved {
            Activity::Starved
        } else {
            Activity::Running
        };
    }
}

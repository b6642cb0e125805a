//! Gives tool tip and tool orientation of a move one duration.
//!
//! Source: section 5.2, equations 5.6 to 5.9: tip and orientation share the duration of the slower
//! one; inverse-time feed gives the duration itself. Not here: corners.

use crate::pose::swing::{RotarySwing, Swing};
use toolglide_kinematics::{PoseFeed, PoseLeg, PosePath, Vector};

/// A line of the tip and a turn of the tool that take the same time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseBlock {
    /// Number of the leg, counted from 0 in path order.
    pub leg: u32,
    /// Line of the program; 0 for none.
    pub line: u32,
    /// Tool tip at the start.
    pub start: Vector<3>,
    /// Tool tip at the end.
    pub end: Vector<3>,
    /// Length of the line.
    pub length: f64,
    /// The turn of the tool.
    pub turn: Swing,
    /// How long the commanded pulse lasts, s; 0 where nothing but axis limits bounds it.
    pub duration: f64,
    /// Tolerance of the tip, mm.
    pub tip_tolerance: f64,
    /// Tolerance of the orientation, rad.
    pub orientation_tolerance: f64,
}

impl PoseBlock {
    /// The block of a leg of tool motion that takes no more than `turn_rate`, rad/s; `None` for a
    /// leg that leads nowhere, or moves no tool.
    ///
    /// # Source
    /// Equations 5.8 and 5.9: the longer of the duration by feedrate and that by turn rate.
    #[must_use]
    pub fn of(leg: &PoseLeg, number: u32, turn_rate: f64) -> Option<Self> {
        let turn = match &leg.path {
            PosePath::Tool { turn, .. } => Swing::Circle(*turn),
            PosePath::Rotary { axes, .. } => Swing::Rotary(RotarySwing::new(axes)),
            _ => return None,
        };
        let tip = leg.tip()?;
        let (length, angle) = (leg.length(), leg.angle());
        if length <= toolglide_kinematics::numeric::SHORTEST_LENGTH && turn.amount() <= 0.0 {
            return None;
        }
        let by_feed = match leg.feed {
            PoseFeed::Rapid => 0.0,
            PoseFeed::Speed(feedrate) => length / feedrate.speed(),
            PoseFeed::Duration(duration) => duration,
        };
        Some(Self {
            leg: number,
            line: leg.line,
            start: tip[0],
            end: tip[1],
            length,
            turn,
            duration: by_feed.max(angle / turn_rate),
            tip_tolerance: leg.tip_tolerance.length(),
            orientation_tolerance: leg.orientation_tolerance.angle(),
        })
    }

    /// Feedrate of the tip, mm/s.
    #[must_use]
    pub fn feedrate(&self) -> f64 {
        self.length / self.duration
    }

    /// Rate at which the tool turns, rad/s; of rotary axes a bound of it.
    #[must_use]
    pub fn turn_rate(&self) -> f64 {
        self.turn.amount() / self.duration
    }
}

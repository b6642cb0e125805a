//! Measures the distance of poses from a path of tool poses whose legs are known one after the other.
//!
//! Source: lines of the tool tip, and great circles of the tool. Not here: which legs count, and motion.

use crate::poses::tool_deviation::{from_arc, from_segment};
use crate::report::Place;
use std::collections::VecDeque;
use toolglide_kinematics::{PoseLeg, PosePath, ToolPose};

/// The legs of a path of tool poses that are still needed.
#[derive(Clone, Debug, Default)]
pub struct PoseCourse {
    legs: VecDeque<PoseLeg>,
    base: u32,
}

/// How far a pose is from a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseFoot {
    /// Leg and program line to which the tool tip is nearest.
    pub place: Place,
    /// Distance of the tool tip, mm.
    pub tip: f64,
    /// Tolerance of the tool tip there, mm.
    pub tip_tolerance: f64,
    /// Angle of the tool, rad; `None` where no leg says along which great circle the tool turns.
    pub orientation: Option<f64>,
    /// Tolerance of the orientation there, rad.
    pub orientation_tolerance: f64,
}

impl PoseCourse {
    /// A path of no legs.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the next leg.
    pub fn expect(&mut self, leg: PoseLeg) {
        self.legs.push_back(leg);
    }

    /// Forgets all legs before one, counted from 0.
    pub fn forget_before(&mut self, leg: u32) {
        while self.base < leg && self.legs.pop_front().is_some() {
            self.base = self.base.saturating_add(1);
        }
    }

    /// How far a pose is from legs `first..=last`; `None` where none of them leads the tool tip along a line.
    #[must_use]
    pub fn nearest(&self, pose: &ToolPose, first: u32, last: u32) -> Option<PoseFoot> {
        let skip = usize::try_from(first.saturating_sub(self.base)).ok()?;
        let count = usize::try_from(last.checked_sub(first.max(self.base))?).ok()?;
        let mut foot: Option<PoseFoot> = None;
        let mut number = first.max(self.base);
        let mut turned: Option<(f64, f64)> = None;
        for leg in self.legs.iter().skip(skip).take(count + 1) {
            if let Some([start, end]) = leg.tip() {
                let tip = from_segment(&pose.tip(), &start, &end);
                if foot.is_none_or(|foot| tip < foot.tip) {
                    foot = Some(PoseFoot {
                        place: Place {
                            mv: number,
                            line: leg.line,
                        },
                        tip,
                        tip_tolerance: leg.tip_tolerance.length(),
                        ..PoseFoot::default()
                    });
                }
            }
            if let PosePath::Tool { turn, .. } = &leg.path {
                let angle = from_arc(&pose.orientation(), turn);
                if turned.is_none_or(|(least, _)| angle < least) {
                    turned = Some((angle, leg.orientation_tolerance.angle()));
                }
            }
            number = number.saturating_add(1);
        }
        foot.map(|foot| PoseFoot {
            orientation: turned.map(|(angle, _)| angle),
            orientation_tolerance: turned.map_or(0.0, |(_, tolerance)| tolerance),
            ..foot
        })
    }
}

//! Represents a move of tool tip and tool orientation as a program asks for it.
//!
//! Source: section 5.2, where a block leads from one pair (P, O) to the next; inverse-time feed and
//! axis words as programs of five axes write them. Not here: what the words mean on a machine.

use crate::error::ToolpathError;
use crate::numeric::LONGEST_DURATION;
use crate::pose::tool_pose::ToolPose;
use crate::tolerance::{Feedrate, Tolerance};
use crate::vector::{Vector, check};

/// Where a pose move leads.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PoseEnd {
    /// Tool tip and tool orientation in workpiece coordinates.
    Pose(ToolPose),
    /// Words of axes.
    Axes {
        /// Words X, Y and Z, mm: the tool tip in workpiece coordinates when `tip`, else positions of
        /// the linear axes of the machine.
        linear: Vector<3>,
        /// Words A, B and C, rad; those that were never programmed are 0.
        rotary: [f64; 3],
        /// Whether the linear words are those of the tool tip.
        tip: bool,
        /// Whether the tool turns along a great circle to where the rotary words point it, instead of as the rotary
        /// axes turn it; for words of the tool tip.
        great_circle: bool,
    },
    /// Standing still, s.
    Dwell {
        /// For how long.
        duration: f64,
    },
}

/// How fast a pose move is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PoseFeed {
    /// As fast as the machine can.
    Rapid,
    /// Largest speed of the tool tip.
    Speed(Feedrate),
    /// How long the whole move takes, s: inverse-time feed.
    Duration(f64),
}

/// One move of a program of tool poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseMove {
    end: PoseEnd,
    feed: PoseFeed,
    tolerance: Tolerance,
    stop: bool,
    line: u32,
    secondary: [f64; 3],
    held: [bool; 3],
}

impl PoseMove {
    /// A move to `end`, whose tool tip may leave its line by `tolerance`.
    ///
    /// # Errors
    /// [`ToolpathError::NotFinite`] for words that are not finite, [`ToolpathError::TooFar`] for coordinates beyond
    /// [`LARGEST_COORDINATE`](crate::numeric::LARGEST_COORDINATE), [`ToolpathError::TooLarge`] for a dwell beyond
    /// [`LONGEST_DURATION`], [`ToolpathError::NotPositive`]
    /// for a dwell that is negative or endless, or a duration that is not positive and finite.
    ///
    /// # Examples
    /// ```
    /// use toolglide_kinematics::{PoseEnd, PoseFeed, PoseMove, Tolerance, ToolPose, Vector};
    /// let pose = ToolPose::new(Vector::<3>::new(10.0, 0.0, 0.0), Vector::<3>::z())?;
    /// let tolerance = Tolerance::new(0.01)?;
    /// assert!(PoseMove::new(PoseEnd::Pose(pose), PoseFeed::Duration(0.5), tolerance).is_ok());
    /// assert!(PoseMove::new(PoseEnd::Pose(pose), PoseFeed::Duration(0.0), tolerance).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(end: PoseEnd, feed: PoseFeed, tolerance: Tolerance) -> Result<Self, ToolpathError> {
        let mut stop = false;
        match &end {
            PoseEnd::Pose(_) => {}
            PoseEnd::Axes { linear, rotary, .. } => {
                check(linear)?;
                if !rotary.iter().all(|angle| angle.is_finite()) {
                    return Err(ToolpathError::NotFinite);
                }
            }
            PoseEnd::Dwell { duration } => {
                stop = true;
                if !(*duration >= 0.0 && duration.is_finite()) {
                    return Err(ToolpathError::NotPositive {
                        quantity: "dwell",
                        value: *duration,
                    });
                }
                if *duration > LONGEST_DURATION {
                    return Err(ToolpathError::TooLarge {
                        quantity: "dwell",
                        value: *duration,
                        bound: LONGEST_DURATION,
                    });
                }
            }
        }
        if let PoseFeed::Duration(value) = feed
            && !(value > 0.0 && value.is_finite())
        {
            return Err(ToolpathError::NotPositive {
                quantity: "duration of the move",
                value,
            });
        }
        Ok(Self {
            end,
            feed,
            tolerance,
            stop,
            line: 0,
            secondary: [0.0; 3],
            held: [false; 3],
        })
    }

    /// The same move, on a machine with a second set of straight axes: their words U, V and W, mm.
    ///
    /// # Errors
    /// [`ToolpathError::NotFinite`] for words that are not finite.
    pub fn with_secondary(mut self, words: [f64; 3]) -> Result<Self, ToolpathError> {
        if words.iter().any(|word| !word.is_finite()) {
            return Err(ToolpathError::NotFinite);
        }
        self.secondary = words;
        Ok(self)
    }

    /// The same move, at whose end some of the rotary axes A, B and C are where they were before, whatever their words
    /// say: a tool pose has put them there.
    #[must_use]
    pub fn with_rotary_held(mut self, axes: [bool; 3]) -> Self {
        self.held = axes;
        self
    }

    /// Which of the rotary axes A, B and C stay where they are, for words of axes.
    #[must_use]
    pub fn rotary_held(&self) -> [bool; 3] {
        self.held
    }

    /// Words U, V and W, mm; those that were never programmed are 0.
    #[must_use]
    pub fn secondary(&self) -> [f64; 3] {
        self.secondary
    }

    /// The same move, coming to rest exactly at its end.
    #[must_use]
    pub fn with_exact_stop(mut self) -> Self {
        self.stop = true;
        self
    }

    /// The same move, coming from a line of a program (counted from 1; 0 means none).
    #[must_use]
    pub fn from_line(mut self, line: u32) -> Self {
        self.line = line;
        self
    }

    /// Where the move leads.
    #[must_use]
    pub fn end(&self) -> &PoseEnd {
        &self.end
    }

    /// How fast it is followed.
    #[must_use]
    pub fn feed(&self) -> PoseFeed {
        self.feed
    }

    /// How far the tool tip may leave its line.
    #[must_use]
    pub fn tolerance(&self) -> Tolerance {
        self.tolerance
    }

    /// Whether the motion must come to rest exactly at the end of this move.
    #[must_use]
    pub fn stops(&self) -> bool {
        self.stop
    }

    /// Line of the program, counted from 1; 0 when the move comes from none.
    #[must_use]
    pub fn line(&self) -> u32 {
        self.line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_durations_that_are_no_numbers_are_refused() {
        let tolerance = Tolerance::new(0.01).unwrap();
        let words = |x, a| PoseEnd::Axes {
            linear: Vector::<3>::new(x, 0.0, 0.0),
            rotary: [a, 0.0, 0.0],
            tip: true,
            great_circle: false,
        };
        let made = |end, feed| PoseMove::new(end, feed, tolerance);
        assert!(made(words(1.0, 2.0), PoseFeed::Rapid).is_ok(), "sound");
        assert!(made(words(f64::NAN, 0.0), PoseFeed::Rapid).is_err(), "X");
        assert!(
            made(words(0.0, f64::INFINITY), PoseFeed::Rapid).is_err(),
            "A"
        );
        let dwell = |duration| PoseEnd::Dwell { duration };
        assert!(made(dwell(0.0), PoseFeed::Rapid).unwrap().stops(), "dwell");
        assert!(made(dwell(-1.0), PoseFeed::Rapid).is_err(), "negative");
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let feed = PoseFeed::Duration(value);
            assert!(made(words(0.0, 0.0), feed).is_err(), "{value}");
        }
    }
}

//! Holds the modal state: what a program has said that stays in force.
//!
//! Source: the order of execution of RS274/NGC. Not here: motion.

use crate::block::Block;
use crate::block::codes::{Distance, FeedMode, Motion, PathControl, Plane};
use crate::error::reason::Reason;
use crate::error::{Fault, Notice, Remark};
use crate::interpreter::tools::LARGEST_TOOL;
use crate::interpreter::units::Units;
use crate::settings::Settings;
use toolglide_kinematics::{Tolerance, ToolpathError};

/// A number as near as this to a whole one is whole: it may come from an expression.
const WHOLE: f64 = 1e-4;

/// The modal state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Modal {
    pub(crate) motion: Motion,
    pub(crate) plane: Plane,
    pub(crate) units: Units,
    pub(crate) distance: Distance,
    pub(crate) arc_distance: Distance,
    pub(crate) feed_mode: FeedMode,
    /// Feedrate of the mode per minute, mm/s; none before the first.
    pub(crate) feedrate: Option<f64>,
    /// Whether that is one from before inverse time, which nobody has used or written again.
    pub(crate) feedrate_is_old: bool,
    pub(crate) path_control: PathControl,
    pub(crate) tolerance: Tolerance,
    pub(crate) spindle_speed: f64,
    /// Whether cycles go back to where they began.
    pub(crate) return_to_start: bool,
    /// The tool that was asked for last.
    pub(crate) tool: u32,
}

impl Modal {
    pub(crate) fn new(settings: &Settings) -> Self {
        Self {
            motion: Motion::Off,
            plane: Plane::Xy,
            units: Units::Millimeter,
            distance: Distance::Absolute,
            arc_distance: Distance::Incremental,
            feed_mode: FeedMode::PerMinute,
            feedrate: None,
            feedrate_is_old: false,
            path_control: PathControl::Blend,
            tolerance: settings.tolerance,
            spindle_speed: 0.0,
            return_to_start: false,
            tool: 0,
        }
    }

    /// Takes what a block changes, in the order of execution.
    pub(crate) fn take(
        &mut self,
        block: &Block,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        if let Some(mode) = block.feed_mode
            && mode != self.feed_mode
        {
            // Rates of inverse time leave the feedrate per minute alone.
            self.feed_mode = mode;
            self.feedrate_is_old = mode == FeedMode::PerMinute && self.feedrate.is_some();
        }
        self.take_feedrate(block, remarks)?;
        self.take_speed_and_tool(block)?;
        self.plane = block.plane.unwrap_or(self.plane);
        self.units = block.units.unwrap_or(self.units);
        self.take_path_control(block, settings, remarks)?;
        self.distance = block.distance.unwrap_or(self.distance);
        self.arc_distance = block.arc_distance.unwrap_or(self.arc_distance);
        self.return_to_start = block.return_to_start.unwrap_or(self.return_to_start);
        self.motion = block.motion.unwrap_or(self.motion);
        Ok(())
    }

    fn take_feedrate(&mut self, block: &Block, remarks: &mut Vec<Remark>) -> Result<(), Fault> {
        let Some(value) = not_negative(block, b'F', "feedrate")? else {
            return Ok(());
        };
        if self.feed_mode == FeedMode::PerMinute {
            self.feedrate = Some(self.units.feedrate(value));
            self.feedrate_is_old = false;
            if block.units.is_some_and(|units| units != self.units) {
                let former = self.units.name();
                remarks.push((block.span(b'F'), Notice::FeedBeforeUnits { former }));
            }
        }
        Ok(())
    }

    fn take_speed_and_tool(&mut self, block: &Block) -> Result<(), Fault> {
        if let Some(speed) = not_negative(block, b'S', "spindle speed")? {
            self.spindle_speed = speed;
        }
        if let Some(tool) = whole(block, b'T', "tool number", 0, LARGEST_TOOL)? {
            self.tool = tool;
        }
        Ok(())
    }

    fn take_path_control(
        &mut self,
        block: &Block,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        let Some(control) = block.path_control else {
            return Ok(());
        };
        self.path_control = control;
        if control == PathControl::ExactStop {
            return Ok(());
        }
        not_negative(block, b'Q', "tolerance of merging")?;
        self.tolerance = settings.tolerance;
        if let Some(value) = not_negative(block, b'P', "tolerance")?
            && !settings.override_tolerance
        {
            let at = |reason| Fault::new(block.span(b'P'), reason);
            let length = self.units.bounded_length('P', value).map_err(at)?;
            if length <= 0.0 {
                self.path_control = PathControl::ExactStop;
                remarks.push((block.span(b'P'), Notice::NoTolerance));
                return Ok(());
            }
            let quantity = "tolerance";
            self.tolerance = Tolerance::new(length).map_err(|reason| match reason {
                ToolpathError::TooSmall { .. } | ToolpathError::TooLarge { .. } => {
                    at(Reason::Path(reason))
                }
                _ => at(Reason::NotPositive { quantity, value }),
            })?;
        }
        Ok(())
    }
}

/// The number after a letter, if it stands in the block.
pub(crate) fn not_negative(
    block: &Block,
    letter: u8,
    quantity: &'static str,
) -> Result<Option<f64>, Fault> {
    match block.get(letter) {
        Some(value) if value < 0.0 => Err(Fault::new(
            block.span(letter),
            Reason::Negative { quantity, value },
        )),
        value => Ok(value),
    }
}

/// The whole number after a letter, if it stands in the block.
pub(crate) fn whole(
    block: &Block,
    letter: u8,
    quantity: &'static str,
    least: u32,
    most: u32,
) -> Result<Option<u32>, Fault> {
    let Some(value) = block.get(letter) else {
        return Ok(None);
    };
    let nearest = value.round();
    let legal = (f64::from(least)..=f64::from(most)).contains(&nearest);
    if !legal || (value - nearest).abs() > WHOLE {
        let reason = Reason::NotWhole {
            quantity,
            value,
            least,
            most,
        };
        return Err(Fault::new(block.span(letter), reason));
    }
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole and between two numbers of the type"
    )]
    Ok(Some(nearest as u32))
}

//! Represents the tool in the workpiece: its tip and its orientation.
//!
//! Source: section 5.2, where a pose is a pair (P, O). Not here: interpolation of poses.

use crate::error::ToolpathError;
use crate::numeric::UNIT_LENGTH_ERROR;
use crate::vector::{Vector, check, is_finite};

/// Tool tip, mm, and tool orientation, a unit vector from the tip into the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolPose {
    tip: Vector<3>,
    orientation: Vector<3>,
}

impl ToolPose {
    /// A pose from a tip and an orientation of about unit length, which is made exactly so.
    ///
    /// # Errors
    /// [`ToolpathError::NotFinite`] for coordinates that are not finite, [`ToolpathError::TooFar`] for those beyond
    /// [`LARGEST_COORDINATE`](crate::numeric::LARGEST_COORDINATE), and [`ToolpathError::NotUnit`] when the length is off by more than [`UNIT_LENGTH_ERROR`].
    pub fn new(tip: Vector<3>, orientation: Vector<3>) -> Result<Self, ToolpathError> {
        check(&tip)?;
        if !is_finite(&orientation) {
            return Err(ToolpathError::NotFinite);
        }
        let length = orientation.norm();
        if (length - 1.0).abs() > UNIT_LENGTH_ERROR {
            return Err(ToolpathError::NotUnit { length });
        }
        Ok(Self {
            tip,
            orientation: orientation / length,
        })
    }

    /// A pose of a tool that points straight up, as on a three-axis machine.
    ///
    /// # Errors
    /// [`ToolpathError::NotFinite`] for coordinates that are not finite.
    pub fn upright(tip: Vector<3>) -> Result<Self, ToolpathError> {
        Self::new(tip, Vector::<3>::z())
    }

    /// The same orientation with the tip moved by `offset`, mm.
    #[must_use]
    pub fn moved_by(&self, offset: Vector<3>) -> Self {
        Self {
            tip: self.tip + offset,
            orientation: self.orientation,
        }
    }

    /// A pose from finite numbers and an orientation that lacks unit length by rounding only.
    pub fn rounded(tip: Vector<3>, orientation: Vector<3>) -> Self {
        Self {
            tip,
            orientation: orientation / orientation.norm(),
        }
    }

    /// The tool tip.
    #[must_use]
    pub fn tip(&self) -> Vector<3> {
        self.tip
    }

    /// The tool orientation, of unit length.
    #[must_use]
    pub fn orientation(&self) -> Vector<3> {
        self.orientation
    }
}

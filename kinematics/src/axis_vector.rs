//! Holds positions of the axes of a machine, and all solutions of a pose.
//!
//! Source: ours; both are of fixed capacity, because set-points are made without allocation. Not
//! here: machines.

use crate::machine::KinematicsError;
use core::fmt;
use core::ops::{Deref, DerefMut};

/// Most axes that a machine has: X, Y, Z, A, B, C, U, V and W.
pub const MAX_AXES: usize = 9;

/// Most branches in which a machine takes one pose: an arm may reach forward or backward, with the
/// elbow up or down, and with the wrist on either side.
pub const MAX_SOLUTIONS: usize = 8;

/// A position for each axis of a machine, in machine order: mm for linear axes, rad for rotary ones.
///
/// It is used as the slice that it dereferences to.
///
/// # Examples
/// ```
/// use toolglide_kinematics::AxisVector;
/// let mut axes = AxisVector::from([10.0, 20.0, 0.5]);
/// axes[1] += 5.0;
/// assert_eq!(axes[..], [10.0, 25.0, 0.5]);
/// assert!(AxisVector::from_slice(&[0.0; 10]).is_err());
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct AxisVector {
    positions: [f64; MAX_AXES],
    axes: usize,
}

impl AxisVector {
    /// So many axes, all at 0.
    ///
    /// # Panics
    /// When there are more than [`MAX_AXES`].
    #[must_use]
    pub const fn zeros(axes: usize) -> Self {
        assert!(axes <= MAX_AXES, "a machine has at most nine axes");
        Self {
            positions: [0.0; MAX_AXES],
            axes,
        }
    }

    /// These positions, one per axis.
    ///
    /// # Errors
    /// [`KinematicsError::AxisCount`] when there are more than [`MAX_AXES`].
    pub fn from_slice(positions: &[f64]) -> Result<Self, KinematicsError> {
        if positions.len() > MAX_AXES {
            return Err(KinematicsError::AxisCount {
                given: positions.len(),
                axes: MAX_AXES,
            });
        }
        let mut axes = Self::zeros(positions.len());
        axes.copy_from_slice(positions);
        Ok(axes)
    }
}

impl<const N: usize> From<[f64; N]> for AxisVector {
    fn from(positions: [f64; N]) -> Self {
        const { assert!(N <= MAX_AXES, "a machine has at most nine axes") };
        let mut axes = Self::zeros(N);
        axes.copy_from_slice(&positions);
        axes
    }
}

impl Deref for AxisVector {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.positions[..self.axes]
    }
}

impl DerefMut for AxisVector {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.positions[..self.axes]
    }
}

impl fmt::Debug for AxisVector {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self[..].fmt(formatter)
    }
}

/// Axis positions that give one pose, the nearest first.
///
/// It is used as the slice that it dereferences to.
#[derive(Clone, Copy)]
pub struct Solutions {
    list: [AxisVector; MAX_SOLUTIONS],
    count: usize,
}

impl Solutions {
    /// No solution.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            list: [AxisVector::zeros(0); MAX_SOLUTIONS],
            count: 0,
        }
    }

    /// Adds a solution behind those that there are.
    ///
    /// # Panics
    /// When there are [`MAX_SOLUTIONS`] already.
    pub fn push(&mut self, axes: AxisVector) {
        self.list[self.count] = axes;
        self.count += 1;
    }
}

impl From<AxisVector> for Solutions {
    fn from(axes: AxisVector) -> Self {
        let mut solutions = Self::none();
        solutions.push(axes);
        solutions
    }
}

impl Deref for Solutions {
    type Target = [AxisVector];

    fn deref(&self) -> &[AxisVector] {
        &self.list[..self.count]
    }
}

impl DerefMut for Solutions {
    fn deref_mut(&mut self) -> &mut [AxisVector] {
        &mut self.list[..self.count]
    }
}

impl fmt::Debug for Solutions {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self[..].fmt(formatter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_those_that_were_given_and_no_more() {
        let axes = AxisVector::from([1.0, 2.0]);
        assert_eq!(axes.len(), 2, "two axes");
        assert_eq!(axes, AxisVector::from_slice(&[1.0, 2.0]).unwrap(), "equal");
        assert_ne!(axes, AxisVector::from([1.0, 2.0, 0.0]), "one axis more");
        assert_eq!(format!("{axes:?}"), "[1.0, 2.0]", "printed");
    }

    #[test]
    fn too_many_axes_are_refused() {
        assert_eq!(
            AxisVector::from_slice(&[0.0; MAX_AXES + 1]),
            Err(KinematicsError::AxisCount {
                given: MAX_AXES + 1,
                axes: MAX_AXES
            })
        );
    }

    #[test]
    fn solutions_keep_their_order() {
        let mut solutions = Solutions::from(AxisVector::from([1.0]));
        solutions.push(AxisVector::from([2.0]));
        assert_eq!(
            solutions[..],
            [AxisVector::from([1.0]), AxisVector::from([2.0])]
        );
    }
}

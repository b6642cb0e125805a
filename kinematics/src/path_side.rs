//! Names the sides of straight lines on which a motion stays.
//!
//! Source: ours. Not here: how far it may go on the other side.

#[cfg(not(feature = "std"))]
use crate::no_std::*;

/// On which side of straight lines a motion stays inside its tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PathSide {
    /// On both.
    #[default]
    Both,
    /// At each corner on the inner side, where the other line lies: corners are cut, never swung around.
    Inside,
    /// On the left in the sense of the motion, seen from above the plane of the first two axes.
    Left,
    /// On the right.
    Right,
}

impl PathSide {
    /// Unit vector across a line to the side that is kept, where the side does not depend on corners; `None` where the
    /// line does not move the first two axes.
    #[must_use]
    pub fn across<const N: usize>(self, direction: &crate::Vector<N>) -> Option<crate::Vector<N>> {
        if N < 2 {
            return None;
        }
        let sign = match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
            Self::Both | Self::Inside => return None,
        };
        let length = direction[0].hypot(direction[1]);
        if length <= 1e-9 {
            return None;
        }
        let mut across = crate::Vector::<N>::zeros();
        across[0] = sign * direction[1] / length;
        across[1] = -sign * direction[0] / length;
        Some(across)
    }
}

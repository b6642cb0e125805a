//! Checks a path against the travel of the axes, and reduces moves to the axes of the machine.
//!
//! Not here: the motion, which stays within the tolerance of its path.

use crate::error::CliError;
use toolglide_kinematics::numeric::LENGTH_SLACK;
use toolglide_kinematics::{Arc, Axis, Move, Path, ToolpathError, Vector};
use toolglide_program::AxisMove;

/// Why a move is refused.
const NEEDS_ANOTHER: &str = "the move needs an axis that the machine has not";

/// The ends of all axes.
#[derive(Clone, Debug)]
pub(crate) struct Travel<const N: usize> {
    letters: [char; N],
    low: Vector<N>,
    high: Vector<N>,
}

impl<const N: usize> Travel<N> {
    /// The ends of the first `N` axes.
    pub(crate) fn of(axes: &[Axis]) -> Self {
        let ends = |axis: usize| axes.get(axis).and_then(|axis| axis.travel);
        Self {
            letters: std::array::from_fn(|axis| axes.get(axis).map_or('?', |axis| axis.name)),
            low: Vector::from_fn(|axis, _| ends(axis).map_or(f64::NEG_INFINITY, |ends| ends.0)),
            high: Vector::from_fn(|axis, _| ends(axis).map_or(f64::INFINITY, |ends| ends.1)),
        }
    }

    /// Checks a move; `program` and the line of the move say where it stands.
    pub(crate) fn check(&self, next: &Move<N>, program: &str) -> Result<(), CliError> {
        let outside = match next.path() {
            Path::Line { end } => self.outside(end),
            Path::Arc(arc) => farthest(arc).iter().find_map(|point| self.outside(point)),
            _ => None,
        };
        match outside {
            None => Ok(()),
            Some((axis, position)) => Err(CliError::Line {
                program: program.to_owned(),
                line: next.line(),
                reason: format!(
                    "axis {}: position {position} is outside the travel {} to {}",
                    self.letters[axis], self.low[axis], self.high[axis]
                ),
            }),
        }
    }

    fn outside(&self, point: &Vector<N>) -> Option<(usize, f64)> {
        (0..N)
            .find(|&axis| {
                !(self.low[axis] - LENGTH_SLACK..=self.high[axis] + LENGTH_SLACK)
                    .contains(&point[axis])
            })
            .map(|axis| (axis, point[axis]))
    }
}

/// The end of an arc, and the points where one of its axes turns back.
fn farthest<const N: usize>(arc: &Arc<N>) -> Vec<Vector<N>> {
    let (radial, lateral) = arc.frame();
    let half = std::f64::consts::PI;
    let mut points = vec![arc.end()];
    for axis in 0..N {
        if radial[axis].hypot(lateral[axis]) > 0.0 {
            // More than one turn passes the same points again.
            let turn = arc.sweep().clamp(-2.0 * half, 2.0 * half);
            let peak = lateral[axis].atan2(radial[axis]);
            points.extend(
                (-2..=2)
                    .map(|turns| (peak + f64::from(turns) * half) / turn)
                    .filter(|share| (0.0..=1.0).contains(share))
                    .map(|share| arc.point(share * turn / arc.sweep())),
            );
        }
    }
    points
}

/// A move of a program on the axes of a machine.
pub(crate) trait OnAxes: Sized {
    /// The move on the axes with these letters, without those that the machine has not; else why that
    /// cannot be.
    fn on_axes(next: &AxisMove, letters: &[char]) -> Result<Self, String>;
}

/// Runs a function that is generic over the number of axes.
macro_rules! by_axes {
    ($count:expr, $run:ident($($argument:expr),*)) => {
        match $count {
            2 => $run::<2>($($argument),*),
            3 => $run::<3>($($argument),*),
            4 => $run::<4>($($argument),*),
            5 => $run::<5>($($argument),*),
            _ => $run::<6>($($argument),*),
        }
    };
}

pub(crate) use by_axes;

/// Moves that take other axes along.
macro_rules! takes_others_along {
    ($($count:literal),*) => {
        $(impl OnAxes for Move<$count> {
            fn on_axes(next: &AxisMove, letters: &[char]) -> Result<Self, String> {
                beside(next, letters)
            }
        })*
    };
}

takes_others_along!(4, 5, 6);

/// The move on axes of which some stand beside X, Y and Z.
fn beside<const N: usize>(next: &AxisMove, letters: &[char]) -> Result<Move<N>, String> {
    let letters = letters.try_into().map_err(|_| NEEDS_ANOTHER.to_owned())?;
    next.on_axes(letters).map_err(|reason| match reason {
        ToolpathError::ArcPlane { .. } => NEEDS_ANOTHER.to_owned(),
        other => other.to_string(),
    })
}

impl OnAxes for Move<3> {
    fn on_axes(next: &AxisMove, letters: &[char]) -> Result<Self, String> {
        if letters == ['X', 'Y', 'Z'] {
            Ok(*next.step())
        } else {
            beside(next, letters)
        }
    }
}

impl OnAxes for Move<2> {
    fn on_axes(next: &AxisMove, _letters: &[char]) -> Result<Self, String> {
        on_plane(next.step()).ok_or_else(|| NEEDS_ANOTHER.to_owned())
    }
}

/// The move on X and Y; `None` for an arc that needs Z.
fn on_plane(next: &Move<3>) -> Option<Move<2>> {
    let flat = |point: Vector<3>| Vector::<2>::new(point.x, point.y);
    let mut same = match next.path() {
        Path::Line { end } => Move::line_to(flat(*end), next.feedrate(), next.tolerance()).ok()?,
        Path::Dwell { duration } => Move::dwell(*duration, next.tolerance()).ok()?,
        Path::Arc(arc) => {
            let about = |turns| {
                Arc::about(
                    flat(arc.start()),
                    flat(arc.end()),
                    flat(arc.center()),
                    [0, 1],
                    arc.sweep() > 0.0,
                    turns,
                )
                .ok()
            };
            let (radial, lateral) = arc.frame();
            if radial.z.abs().max(lateral.z.abs()) > 0.0 {
                return None;
            }
            let once = about(0)?;
            let more = ((arc.sweep() - once.sweep()) / std::f64::consts::TAU)
                .abs()
                .round();
            Move::arc(about(whole(more))?, next.feedrate(), next.tolerance())
        }
    };
    if next.stops() {
        same = same.with_exact_stop();
    }
    Some(same.from_line(next.line()))
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the number of turns came from a u32"
)]
fn whole(turns: f64) -> u32 {
    turns as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{AxisKind, AxisLimits, Feedrate, Tolerance};

    fn travel() -> Travel<2> {
        let axis = |name, travel| Axis {
            name,
            kind: AxisKind::Linear,
            limits: AxisLimits::new(1.0, 1.0, 1.0).unwrap(),
            travel,
        };
        Travel::of(&[axis('X', Some((-1.0, 10.0))), axis('Y', None)])
    }

    fn half_circle(turns: u32) -> Move<3> {
        let arc = Arc::about(
            Vector::<3>::new(0.0, 0.0, 0.0),
            Vector::<3>::new(0.0, 12.0, 0.0),
            Vector::<3>::new(0.0, 6.0, 0.0),
            [0, 1],
            true,
            turns,
        )
        .unwrap();
        Move::arc(arc, Feedrate::RAPID, Tolerance::new(0.01).unwrap()).from_line(7)
    }

    #[test]
    fn an_arc_that_bulges_over_the_end_of_an_axis_is_refused() {
        for turns in 0..3 {
            let flat = on_plane(&half_circle(turns)).unwrap();
            let refused = travel().check(&flat, "a.ngc");
            assert!(
                refused.is_ok() == (turns == 0),
                "{turns} more turns: {refused:?}"
            );
        }
        let beyond = Move::line_to(
            Vector::<2>::new(10.5, 1e6),
            Feedrate::RAPID,
            Tolerance::new(0.01).unwrap(),
        )
        .unwrap();
        assert_eq!(
            travel()
                .check(&beyond.from_line(3), "a.ngc")
                .unwrap_err()
                .to_string(),
            "a.ngc:3: axis X: position 10.5 is outside the travel -1 to 10"
        );
    }

    #[test]
    fn an_arc_keeps_its_turns_on_two_axes() {
        let arc = half_circle(2);
        let flat = on_plane(&arc).unwrap();
        let (Path::Arc(three), Path::Arc(two)) = (arc.path(), flat.path()) else {
            panic!("both are arcs");
        };
        assert!((three.sweep() - two.sweep()).abs() < 1e-12, "sweep");
        assert_eq!(flat.line(), 7, "line");
    }
}

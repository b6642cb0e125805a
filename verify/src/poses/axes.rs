//! Computes the motion of the axes while the tool follows a piece.
//!
//! Source: interpolation at the nodes of Chebyshev, which is as exact as the last coefficients are
//! small, and its derivatives. Not here: any formula of a machine but its inverse kinematics.

use std::sync::LazyLock;
use toolglide_kinematics::AxisVector;
use toolglide_kinematics::{AxesPiece, CubicInTime, PosePiece};
use toolglide_kinematics::{Axis, KinematicsError, MachineKinematics};

/// Nodes of one interpolation.
const NODES: usize = 12;

/// Instants of one interpolation that are looked at, ends included.
const INSTANTS: usize = 17;

/// Shorter stretches are interpolated beyond their ends, s: derivatives of a shorter one would be
/// lost in the rounding of positions.
const MIN_HALF: f64 = 3e-3;

/// Least half-length of a stretch, s, however awkward the motion is.
const SHORTEST_HALF: f64 = 2e-5;

/// What the last coefficients may add to the jerk, as a share of the limit.
const TRUNCATION: f64 = 1e-5;

/// What the last coefficients may add to a position, mm and rad: far below what may jump.
const TRUNCATION_LENGTH: f64 = 1e-10;

/// Below this, mm and rad, coefficients that do not fall any more are the rounding of positions, which
/// shorter stretches would only enlarge: beside a pole that of an orientation is a million times its own.
const ROUNDING: f64 = 1e-8;

/// Coefficients up to this many times the rounding are rounding.
const ROUNDED: f64 = 4.0;

/// Coefficients fall when the last two are less than this share of the two before them.
const FALLING: f64 = 0.2;

/// Derivatives of the position of one axis at one instant, the position first.
pub(super) type Derivatives = [f64; 4];

/// Takes every instant looked at: the time in the piece, the axis, and its derivatives.
pub(super) type Take<'a> = &'a mut dyn FnMut(f64, usize, Derivatives);

/// Follows tool motion through inverse kinematics.
pub(super) struct Follower<'m> {
    pub(super) machine: &'m dyn MachineKinematics,
    pub(super) axes: Vec<Axis>,
    /// Where the axes are.
    pub(super) near: AxisVector,
    values: Vec<[f64; NODES]>,
}

impl<'m> Follower<'m> {
    pub(super) fn new(
        machine: &'m dyn MachineKinematics,
        axes: Vec<Axis>,
        start: &AxisVector,
    ) -> Self {
        let count = axes.len();
        Self {
            machine,
            axes,
            near: *start,
            values: vec![[0.0; NODES]; count],
        }
    }

    /// The derivatives of all axes over a piece of tool motion, or of motion of the tip with the rotary axes, in the
    /// order of time.
    pub(super) fn tool(
        &mut self,
        piece: &PosePiece,
        take: Take<'_>,
    ) -> Result<(), (f64, KinematicsError)> {
        let duration = piece.duration();
        if duration > 0.0 {
            self.stretch(piece, [0.0, duration], MIN_HALF, take)?;
        }
        self.near = match piece {
            PosePiece::Tool(piece) => self.machine.inverse(&piece.end, &self.near),
            PosePiece::Rotary(piece) => {
                let (tip, at) = piece.at(duration, &self.near);
                self.machine.place(&tip, &at)
            }
            PosePiece::Axes(piece) => Ok(piece.end),
        }
        .map_err(|reason| (duration, reason))?;
        Ok(())
    }

    fn stretch(
        &mut self,
        piece: &PosePiece,
        [begin, end]: [f64; 2],
        least: f64,
        take: Take<'_>,
    ) -> Result<(), (f64, KinematicsError)> {
        let middle = 0.5 * (begin + end);
        let half = (0.5 * (end - begin)).max(least);
        let before = self.near;
        let mut near = before;
        for node in 0..NODES {
            // From the start of the stretch to its end.
            let at = middle - half * node_at(node);
            near = match piece.extended(at, self.machine, &near) {
                Ok(near) => near,
                // Beyond the ends of the piece the machine need not get anywhere.
                Err(_) if !(0.0..=piece.duration()).contains(&at) => {
                    self.near = before;
                    return self.stretch(piece, [begin, end], 0.5 * least, take);
                }
                Err(reason) => return Err((at, reason)),
            };
            for (values, position) in self.values.iter_mut().zip(near.iter()) {
                values[node] = *position;
            }
        }
        let mut series: Vec<_> = self.values.iter().map(coefficients).collect();
        let scale = TRUNCATION * half.powi(3) / last_jerk();
        let mut resolved = true;
        for (series, axis) in series.iter_mut().zip(&self.axes) {
            let last = series[NODES - 1].abs().max(series[NODES - 2].abs());
            let before = series[NODES - 3].abs().max(series[NODES - 4].abs());
            if last < (scale * axis.limits.jerk()).min(TRUNCATION_LENGTH) {
                continue;
            }
            if half <= MIN_HALF && last < ROUNDING && last > FALLING * before {
                for coefficient in &mut series[4..] {
                    if coefficient.abs() <= ROUNDED * last.max(before) {
                        *coefficient = 0.0;
                    }
                }
            } else {
                resolved = false;
            }
        }
        if !resolved && 0.5 * (end - begin) > SHORTEST_HALF {
            self.near = before;
            let least = 0.5 * least;
            self.stretch(piece, [begin, middle], least, take)?;
            return self.stretch(piece, [middle, end], least, take);
        }
        self.near = near;
        for instant in 0..INSTANTS {
            let share = fraction(instant) / fraction(INSTANTS - 1);
            let time = begin + (end - begin) * share;
            for (axis, series) in series.iter().enumerate() {
                take(
                    time,
                    axis,
                    derivatives(series, (time - middle) / half, half),
                );
            }
        }
        Ok(())
    }

    /// The derivatives of all axes over a piece of axis motion, which are known exactly.
    pub(super) fn axes(&mut self, piece: &AxesPiece, take: Take<'_>) {
        for (axis, cubic) in piece.positions.iter().enumerate() {
            let mut times = vec![0.0, piece.duration];
            if cubic[3].abs() > 0.0 {
                times.push((-cubic[2] / (3.0 * cubic[3])).clamp(0.0, piece.duration));
            }
            times.sort_by(f64::total_cmp);
            for time in times {
                take(time, axis, cubic_derivatives(cubic, time));
            }
        }
        self.near = piece.end;
    }
}

fn cubic_derivatives(cubic: &CubicInTime, time: f64) -> Derivatives {
    [
        toolglide_kinematics::cubic_at(cubic, time),
        cubic[1] + (2.0 * cubic[2] + 3.0 * cubic[3] * time) * time,
        2.0 * cubic[2] + 6.0 * cubic[3] * time,
        6.0 * cubic[3],
    ]
}

/// A small count as a number.
#[allow(
    clippy::cast_precision_loss,
    reason = "counts of nodes and instants are below a hundred"
)]
fn fraction(count: usize) -> f64 {
    count as f64
}

/// Where a node is, from 1 down to -1.
fn node_at(node: usize) -> f64 {
    (std::f64::consts::PI * (fraction(node) + 0.5) / fraction(NODES)).cos()
}

/// Third derivative of the last polynomial of the series at its end.
fn last_jerk() -> f64 {
    let n = fraction(NODES - 1).powi(2);
    n * (n - 1.0) * (n - 4.0) / 15.0
}

/// From values at the nodes, which run from -1 to 1, to the coefficients of the series through them.
static TO_SERIES: LazyLock<[[f64; NODES]; NODES]> = LazyLock::new(|| {
    std::array::from_fn(|order| {
        // The nodes run the other way than those of the formula, which changes the sign of odd orders.
        let sign = if order % 2 == 0 { 1.0 } else { -1.0 };
        let share = if order == 0 { 1.0 } else { 2.0 };
        std::array::from_fn(|node| {
            let angle =
                std::f64::consts::PI * fraction(order) * (fraction(node) + 0.5) / fraction(NODES);
            sign * share * angle.cos() / fraction(NODES)
        })
    })
});

/// Coefficients of the series through the values at the nodes.
fn coefficients(values: &[f64; NODES]) -> [f64; NODES] {
    TO_SERIES.map(|row| {
        row.iter()
            .zip(values)
            .map(|(weight, value)| weight * value)
            .sum()
    })
}

fn derivative(series: &[f64; NODES]) -> [f64; NODES] {
    let mut slopes = [0.0; NODES];
    for order in (1..NODES).rev() {
        let above = if order + 1 < NODES {
            slopes[order + 1]
        } else {
            0.0
        };
        slopes[order - 1] = above + 2.0 * fraction(order) * series[order];
    }
    slopes[0] *= 0.5;
    slopes
}

fn value(series: &[f64; NODES], at: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for &coefficient in series[1..].iter().rev() {
        (one, two) = (coefficient + 2.0 * at * one - two, one);
    }
    series[0] + at * one - two
}

fn derivatives(series: &[f64; NODES], at: f64, half: f64) -> Derivatives {
    let first = derivative(series);
    let second = derivative(&first);
    let third = derivative(&second);
    [
        value(series, at),
        value(&first, at) / half,
        value(&second, at) / half.powi(2),
        value(&third, at) / half.powi(3),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_a_sine_are_exact() {
        let half = 0.01;
        let rate = 40.0;
        let mut values = [0.0; NODES];
        for (node, value) in values.iter_mut().enumerate() {
            *value = (-rate * half * node_at(node)).sin();
        }
        let series = coefficients(&values);
        for at in [-1.0_f64, -0.3, 0.0, 0.9, 1.0] {
            let [position, velocity, acceleration, jerk] = derivatives(&series, at, half);
            let angle = rate * half * at;
            assert!((position - angle.sin()).abs() < 1e-14, "{at}");
            assert!((velocity - rate * angle.cos()).abs() < 1e-9, "{at}");
            assert!(
                (acceleration + rate * rate * angle.sin()).abs() < 1e-6,
                "{at}"
            );
            assert!(
                (jerk + rate.powi(3) * angle.cos()).abs() < 1e-3,
                "{at}: {jerk}"
            );
        }
    }
}

//! Represents a programmed path that can be mirrored, permuted and scaled before it becomes a
//! toolpath.
//!
//! Not here: how it is drawn at random.

use std::fmt;
use toolglide_kinematics::{Arc, Feedrate, Limits, Move, Tolerance, Toolpath, Vector};

/// Where a move of a course leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lead<const N: usize> {
    /// Straight to a point.
    Line([f64; N]),
    /// About a centre to an end, in a plane, counter-clockwise or not, with whole turns added.
    Arc {
        /// Centre; the coordinates outside the plane do not matter.
        center: [f64; N],
        /// End.
        end: [f64; N],
        /// Axes of the plane.
        plane: [usize; 2],
        /// The sense of the turn.
        ccw: bool,
        /// Whole turns beyond the first.
        turns: u32,
    },
    /// Standing still, s.
    Dwell(f64),
}

/// A move of a course.
#[derive(Clone, Copy, PartialEq)]
pub struct Leg<const N: usize> {
    /// Where it leads.
    pub lead: Lead<N>,
    /// Feedrate; infinite for a rapid.
    pub feedrate: f64,
    /// Tolerance.
    pub tolerance: f64,
    /// Whether the motion stops at its end.
    pub stop: bool,
}

/// A start and moves, in numbers.
#[derive(Clone, PartialEq)]
pub struct Course<const N: usize> {
    /// Where it begins.
    pub start: [f64; N],
    /// The moves.
    pub legs: Vec<Leg<N>>,
}

/// One line a move, whatever the format, as it stands in Rust.
impl<const N: usize> fmt::Debug for Leg<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = if self.stop { "stop" } else { "go" };
        let Self {
            feedrate,
            tolerance,
            ..
        } = self;
        match self.lead {
            Lead::Line(end) => write!(f, "{name}(Lead::Line({end:?})"),
            Lead::Dwell(duration) => write!(f, "{name}(Lead::Dwell({duration:?})"),
            Lead::Arc {
                center,
                end,
                plane,
                ccw,
                turns,
            } => write!(
                f,
                "{name}(arc({center:?}, {end:?}, {plane:?}, {ccw}, {turns})"
            ),
        }?;
        write!(f, ", {feedrate:?}, {tolerance:?})")
    }
}

/// As it stands in Rust.
impl<const N: usize> fmt::Debug for Course<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Course {{ start: {:?}, legs: vec![", self.start)?;
        for leg in &self.legs {
            writeln!(f, "    {leg:?},")?;
        }
        write!(f, "] }}")
    }
}

/// A leg along which the motion goes on.
#[must_use]
pub fn go<const N: usize>(lead: Lead<N>, feedrate: f64, tolerance: f64) -> Leg<N> {
    Leg {
        lead,
        feedrate,
        tolerance,
        stop: false,
    }
}

/// A leg at whose end the motion stops.
#[must_use]
pub fn stop<const N: usize>(lead: Lead<N>, feedrate: f64, tolerance: f64) -> Leg<N> {
    Leg {
        stop: true,
        ..go(lead, feedrate, tolerance)
    }
}

/// A way about a centre to an end.
#[must_use]
pub fn arc<const N: usize>(
    center: [f64; N],
    end: [f64; N],
    plane: [usize; 2],
    ccw: bool,
    turns: u32,
) -> Lead<N> {
    Lead::Arc {
        center,
        end,
        plane,
        ccw,
        turns,
    }
}

impl<const N: usize> Course<N> {
    /// Straight moves at one feedrate and tolerance.
    #[must_use]
    pub fn of_lines(start: [f64; N], ends: &[[f64; N]], feedrate: f64, tolerance: f64) -> Self {
        let legs = ends
            .iter()
            .map(|end| go(Lead::Line(*end), feedrate, tolerance));
        Self {
            start,
            legs: legs.collect(),
        }
    }

    /// The toolpath; moves that cannot be (an arc of no radius) are left out.
    #[must_use]
    pub fn toolpath(&self) -> Toolpath<N> {
        let mut path = Toolpath::starting_at(self.start.into()).unwrap();
        for (leg, line) in self.legs.iter().zip(1..) {
            let tolerance = Tolerance::new(leg.tolerance).unwrap();
            let feedrate = if leg.feedrate.is_finite() {
                Feedrate::new(leg.feedrate).unwrap()
            } else {
                Feedrate::RAPID
            };
            let step = match leg.lead {
                Lead::Line(end) => Move::line_to(end.into(), feedrate, tolerance).unwrap(),
                Lead::Dwell(duration) => Move::dwell(duration, tolerance).unwrap(),
                Lead::Arc {
                    center,
                    end,
                    plane,
                    ccw,
                    turns,
                } => {
                    let start = path.end();
                    match Arc::about(start, end.into(), center.into(), plane, ccw, turns) {
                        Ok(arc) => Move::arc(arc, feedrate, tolerance),
                        Err(_) => continue,
                    }
                }
            };
            let step = if leg.stop {
                step.with_exact_stop()
            } else {
                step
            };
            path.push(step.from_line(line)).unwrap();
        }
        path
    }

    /// The course with every point mapped, and with it the sense of the turns.
    fn mapped(
        &self,
        point: impl Fn([f64; N]) -> [f64; N],
        plane: impl Fn([usize; 2], bool) -> ([usize; 2], bool),
        lengths: f64,
        times: f64,
    ) -> Self {
        let legs = self.legs.iter().map(|leg| Leg {
            lead: match leg.lead {
                Lead::Line(end) => Lead::Line(point(end)),
                Lead::Dwell(duration) => Lead::Dwell(duration * times),
                Lead::Arc {
                    center,
                    end,
                    plane: axes,
                    ccw,
                    turns,
                } => {
                    let (plane, ccw) = plane(axes, ccw);
                    Lead::Arc {
                        center: point(center),
                        end: point(end),
                        plane,
                        ccw,
                        turns,
                    }
                }
            },
            feedrate: leg.feedrate * lengths / times,
            tolerance: leg.tolerance * lengths,
            stop: leg.stop,
        });
        Self {
            start: point(self.start),
            legs: legs.collect(),
        }
    }

    /// The course seen in a mirror that reverses one axis.
    #[must_use]
    pub fn mirrored(&self, axis: usize) -> Self {
        let point = |mut at: [f64; N]| {
            at[axis] = -at[axis];
            at
        };
        let plane = |plane: [usize; 2], ccw: bool| (plane, ccw != plane.contains(&axis));
        self.mapped(point, plane, 1.0, 1.0)
    }

    /// The course with its axes taken in rotation: what was axis `k` becomes axis `k + by`.
    #[must_use]
    pub fn rotated(&self, by: usize) -> Self {
        let point = |at: [f64; N]| rotated(at, by);
        let plane = |[first, second]: [usize; 2], ccw| ([(first + by) % N, (second + by) % N], ccw);
        self.mapped(point, plane, 1.0, 1.0)
    }

    /// The course with all lengths times `scale^3` and all times times `scale`, which leaves jerk as
    /// it is.
    #[must_use]
    pub fn scaled(&self, scale: f64) -> Self {
        let cube = scale * scale * scale;
        self.mapped(
            |at| at.map(|coordinate| coordinate * cube),
            |plane, ccw| (plane, ccw),
            cube,
            scale,
        )
    }
}

/// Limits in numbers: velocity, acceleration and jerk of each axis.
pub type Numbers<const N: usize> = [[f64; 3]; N];

/// Velocity, acceleration and jerk of a slow axis.
pub const SLOW: [f64; 3] = [10.0, 100.0, 300.0];

/// Velocity, acceleration and jerk of a usual axis.
pub const USUAL: [f64; 3] = [500.0, 2_000.0, 50_000.0];

/// The limits that the numbers say.
#[must_use]
pub fn limits<const N: usize>(numbers: &Numbers<N>) -> Limits<N> {
    Limits::new(numbers.map(|[velocity, acceleration, jerk]| {
        toolglide_kinematics::AxisLimits::new(velocity, acceleration, jerk).unwrap()
    }))
}

/// What was element `k` becomes element `k + by`.
#[must_use]
pub fn rotated<T: Copy, const N: usize>(of: [T; N], by: usize) -> [T; N] {
    std::array::from_fn(|axis| of[(axis + N - by % N) % N])
}

/// A vector as the numbers of a course.
#[must_use]
pub fn numbers<const N: usize>(vector: &Vector<N>) -> [f64; N] {
    std::array::from_fn(|axis| vector[axis])
}

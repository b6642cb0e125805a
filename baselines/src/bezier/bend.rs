//! Rounds a corner by a quintic: its size, its speed, and its pieces of constant jerk.
//!
//! Source: the classical scheme of corner splines, at constant speed between the two straight parts.
//! A quintic is no motion of constant jerk, so equally spaced points of it are the control points of a
//! cubic spline over equal time steps, whose accelerations are second differences and whose jerks are
//! third ones; what is judged is therefore the motion itself. Three points on each straight part make
//! it join there without acceleration. Not here: changes of speed.

use super::quintic::{Offset, PARTS, Quintic};
use toolglide_kinematics::{
    Corner, Limits, MoveRange, PathLimits, Piece, Sample, Vector, largest_multiple,
};
use toolglide_profiles::{BlendShape, Boundary, SCurveBoundary};
use toolglide_smoothing::parts::STRAIGHT;

/// Pieces of one corner: its parts, and one on each straight side.
pub(super) const PIECES: usize = PARTS + 2;

/// Share of each leg that one corner may use. With a half, corners on short legs would touch, and the
/// speed of the first one, which is slow, would stay for all.
const LEG_SHARE: f64 = 0.4;

/// Share of the tolerance that a corner uses: all of it, less rounding.
const TOLERANCE_SHARE: f64 = 1.0 - 1e-6;

/// Cosine of half the turn below which the path counts as reversing: a turn of 177.7 degrees.
const REVERSAL: f64 = 0.02;

/// A corner at full speed is made no smaller than this, mm.
const SMALLEST: f64 = 1e-3;

/// A rounded corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BezierBlend {
    /// The first half of the control points in units of their distance.
    offsets: [Offset; PARTS / 2 + 1],
    /// Distance between control points; zero where the corner is not rounded.
    spacing: f64,
    /// Distance of both ends from the corner.
    pub(super) reach: f64,
    /// Largest speed through it.
    pub(super) speed: f64,
}

impl BezierBlend {
    /// A full stop at the corner itself.
    pub(super) const STOP: Self = Self {
        offsets: [[0.0; 2]; PARTS / 2 + 1],
        spacing: 0.0,
        reach: 0.0,
        speed: 0.0,
    };

    /// The corner between two legs of these lengths and limits, rounded as widely as tolerance and legs
    /// allow, but no wider than the feedrate asks for.
    pub(super) fn new<const N: usize>(
        corner: &Corner<N>,
        lengths: [f64; 2],
        legs: [&PathLimits; 2],
        limits: &Limits<N>,
    ) -> Self {
        let (half_sine, half_cosine) = (corner.half_turn_sine(), corner.half_turn_cosine());
        let feedrate = corner.speed_in.min(corner.speed_out);
        if 2.0 * half_sine <= STRAIGHT {
            return Self {
                speed: feedrate,
                ..Self::STOP
            };
        }
        if half_cosine < REVERSAL {
            return Self::STOP;
        }
        let mut bend = Self {
            offsets: Quintic::optimal(half_sine, half_cosine).offsets(),
            spacing: 1.0,
            ..Self::STOP
        };
        let (points, seconds) = bend.points(corner);
        let (mut speed, mut acceleration, mut jerk) = (feedrate, f64::INFINITY, f64::INFINITY);
        for pair in points.windows(2) {
            let first = pair[1] - pair[0];
            speed = speed
                .min(largest_multiple(&first, limits.velocity()))
                .min(feedrate / first.norm());
        }
        for second in &seconds {
            acceleration = acceleration.min(largest_multiple(second, limits.acceleration()));
        }
        for pair in seconds.windows(2) {
            jerk = jerk.min(largest_multiple(&(pair[1] - pair[0]), limits.jerk()));
        }
        // At spacing 1 the speed may be this; it grows with the square root and with the cube root of
        // the square of the spacing.
        let (by_acceleration, by_jerk) = (acceleration.sqrt(), jerk.cbrt());
        let unit_reach = bend.offsets[0][0] + 1.0;
        let widest = TOLERANCE_SHARE * corner.tolerance.length() / bend.unit_error(half_sine);
        let longest = LEG_SHARE * lengths[0].min(lengths[1]) / unit_reach;
        let [share, sharpness] = [speed / by_acceleration, speed / by_jerk];
        let enough = (share * share)
            .max(sharpness * sharpness.sqrt())
            .max(SMALLEST / unit_reach);
        bend.spacing = widest.min(longest).min(enough);
        bend.reach = unit_reach * bend.spacing;
        bend.speed = speed
            .min(by_acceleration * bend.spacing.sqrt())
            .min(by_jerk * bend.spacing.cbrt().powi(2));
        if bend.is_faster_than_a_stop(bend.speed, legs) {
            bend
        } else {
            Self::STOP
        }
    }

    /// How the straight parts before and after see the corner at a speed: as a stop where that is
    /// faster.
    pub(super) fn turn(&self, speed: f64, legs: [&PathLimits; 2]) -> BlendShape {
        if self.is_faster_than_a_stop(speed, legs) {
            let boundary = Boundary {
                distance: self.reach,
                speed,
                acceleration: 0.0,
            };
            BlendShape::at(boundary)
        } else {
            BlendShape::STOP
        }
    }

    /// Unrolls the corner at a speed; nothing where it is not rounded.
    pub(super) fn unroll<const N: usize>(
        &self,
        corner: &Corner<N>,
        speed: f64,
        serves: MoveRange,
        mut take: impl FnMut(Piece<N>),
    ) {
        if self.spacing <= 0.0 || speed <= 0.0 {
            return;
        }
        let step = self.spacing / speed;
        let (points, seconds) = self.points(corner);
        let knot = |index: usize| {
            let position = points[index + 1] + seconds[index] / 6.0;
            let velocity = match index {
                0 => corner.incoming * speed,
                PIECES => corner.outgoing * speed,
                _ => (points[index + 2] - points[index]) * (0.5 * speed),
            };
            Sample {
                position: corner.point + position * self.spacing,
                velocity,
                acceleration: seconds[index] * (speed / step),
                jerk: Vector::zeros(),
            }
        };
        let mut start = knot(0);
        start.position = corner.point - corner.incoming * self.reach;
        for index in 0..PIECES {
            let mut end = knot(index + 1);
            if index + 1 == PIECES {
                end.position = corner.point + corner.outgoing * self.reach;
            }
            start.jerk = (end.acceleration - start.acceleration) / step;
            take(Piece::new(&start, step, end.position, serves));
            start = end;
        }
    }

    /// The control points about the corner in units of their distance, two on each straight side
    /// included, and the second differences at the knots, which vanish at both ends.
    fn points<const N: usize>(
        &self,
        corner: &Corner<N>,
    ) -> ([Vector<N>; PIECES + 3], [Vector<N>; PIECES + 1]) {
        let begin = self.offsets[0][0];
        let points: [Vector<N>; PIECES + 3] = std::array::from_fn(|index| {
            let [incoming, outgoing] = match index {
                0 => [begin + 2.0, 0.0],
                1 => [begin + 1.0, 0.0],
                _ if index <= PARTS / 2 + 2 => self.offsets[index - 2],
                _ if index <= PARTS + 2 => {
                    let [incoming, outgoing] = self.offsets[PARTS + 2 - index];
                    [outgoing, incoming]
                }
                _ if index == PARTS + 3 => [0.0, begin + 1.0],
                _ => [0.0, begin + 2.0],
            };
            corner.outgoing * outgoing - corner.incoming * incoming
        });
        let seconds = std::array::from_fn(|index| {
            if index == 0 || index == PIECES {
                Vector::zeros()
            } else {
                (points[index + 2] - points[index + 1]) - (points[index + 1] - points[index])
            }
        });
        (points, seconds)
    }

    /// Distance between the corner and the middle of the motion, in units of the spacing.
    fn unit_error(&self, half_sine: f64) -> f64 {
        let [beside, middle] = [self.offsets[PARTS / 2 - 1], self.offsets[PARTS / 2]];
        (beside[0] + beside[1] + 4.0 * middle[0]) / 6.0 * 2.0 * half_sine
    }

    /// Whether the corner takes less time at a speed than coming to rest within its reach.
    fn is_faster_than_a_stop(&self, speed: f64, legs: [&PathLimits; 2]) -> bool {
        if speed <= 0.0 {
            return false;
        }
        let mut stop = 0.0;
        for leg in legs {
            let connection = SCurveBoundary {
                from: [0.0, 0.0],
                to: [speed, 0.0],
                limits: *leg,
            };
            match connection.duration_over(self.reach) {
                Some(duration) => stop += duration,
                None => return true,
            }
        }
        #[allow(clippy::cast_precision_loss, reason = "a small constant")]
        let pieces = PIECES as f64;
        pieces * self.spacing / speed < stop
    }
}

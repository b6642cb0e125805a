//! Makes random planned motion of any number of axes inside given limits, without a planner.
//!
//! Jerks walk at random, pieces last from a microsecond to some hundredths of a second, axes come to rest and turn back,
//! and the motion dwells in between.

use toolglide_kinematics::{Limits, MoveRange, Piece, Sample, Vector};

/// A generator of Marsaglia.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The generator of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// A number from 0 to 1.
    #[allow(clippy::cast_precision_loss, reason = "53 bits")]
    pub fn share(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A whole number below `count`.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "small"
    )]
    pub fn below(&mut self, count: u32) -> u32 {
        (self.share() * f64::from(count)) as u32
    }
}

/// Planned motion under construction.
#[derive(Clone, Debug)]
pub struct Motion<const N: usize> {
    limits: Limits<N>,
    at: Sample<N>,
    /// The pieces so far.
    pub pieces: Vec<Piece<N>>,
    block: u32,
}

impl<const N: usize> Motion<N> {
    /// At rest at zero, within the limits of a plan.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self {
            limits,
            at: Sample::at_rest(Vector::zeros()),
            pieces: Vec::new(),
            block: 0,
        }
    }

    /// Appends constant jerk for a time.
    pub fn push(&mut self, duration: f64, jerk: Vector<N>) {
        let start = Sample { jerk, ..self.at };
        let t = duration;
        let end = start.position
            + (start.velocity + (start.acceleration * 0.5 + jerk * (t / 6.0)) * t) * t;
        let piece = Piece::new(&start, t, end, MoveRange::one(self.block));
        let last = piece.at(t);
        self.at = Sample {
            position: end,
            ..last
        };
        self.pieces.push(piece);
    }

    /// The pieces that follow serve the next move.
    pub fn next_block(&mut self) {
        self.block += 1;
    }

    /// Jerks of each axis with their durations, side by side.
    ///
    /// # Panics
    /// Never for finite durations.
    pub fn push_all(&mut self, axes: &[Vec<(f64, f64)>; N]) {
        let mut knots: Vec<f64> = Vec::new();
        for axis in axes {
            let mut time = 0.0;
            for (duration, _) in axis {
                time += duration;
                knots.push(time);
            }
        }
        knots.sort_by(f64::total_cmp);
        let mut begin = 0.0;
        for end in knots {
            if end - begin < 1e-9 {
                continue;
            }
            let middle = 0.5 * (begin + end);
            let jerk = Vector::from_fn(|axis, _| {
                let mut time = 0.0;
                for (duration, jerk) in &axes[axis] {
                    time += duration;
                    if middle < time {
                        return *jerk;
                    }
                }
                0.0
            });
            self.push(end - begin, jerk);
            begin = end;
        }
    }

    /// Brings every axis to rest.
    pub fn stop(&mut self) {
        let axes = std::array::from_fn(|axis| {
            let (v, a) = (self.at.velocity[axis], self.at.acceleration[axis]);
            let (most, jerk) = (self.limits.acceleration()[axis], self.limits.jerk()[axis]);
            let first = a.abs() / jerk;
            let speed = v + 0.5 * a * first;
            let sign = -1.0_f64.copysign(speed);
            let rise = (speed.abs() / jerk).sqrt().min(most / jerk);
            let hold = if rise > 0.0 {
                speed.abs() / (rise * jerk) - rise
            } else {
                0.0
            };
            vec![
                (first, -jerk.copysign(a)),
                (rise, sign * jerk),
                (hold.max(0.0), 0.0),
                (rise, -sign * jerk),
            ]
        });
        self.push_all(&axes);
        self.at.velocity = Vector::zeros();
        self.at.acceleration = Vector::zeros();
    }

    /// Stands still.
    pub fn dwell(&mut self, duration: f64) {
        self.push(duration, Vector::zeros());
    }

    /// Goes on at random for a number of pieces; every axis can still stop within its limits after each.
    pub fn wander(&mut self, random: &mut Random, count: u32) {
        for _ in 0..count {
            if random.below(12) == 0 {
                self.next_block();
            }
            let mut duration = match random.below(8) {
                0 => 1e-6,
                1 => 1e-4,
                _ => 0.03 * random.share(),
            };
            for attempt in 0_u32.. {
                let jerk = Vector::from_fn(|axis, _| {
                    let most = self.limits.jerk()[axis];
                    match (attempt, random.below(4)) {
                        (20.., _) => -most.copysign(self.at.acceleration[axis]),
                        (_, 0) => most,
                        (_, 1) => -most,
                        (_, 2) => 0.0,
                        _ => most * (2.0 * random.share() - 1.0),
                    }
                });
                if self.allows(duration, &jerk) || duration < 1e-7 {
                    self.push(duration, jerk);
                    break;
                }
                duration *= if attempt >= 20 { 0.5 } else { 0.8 };
            }
        }
    }

    fn allows(&self, t: f64, jerk: &Vector<N>) -> bool {
        (0..N).all(|axis| {
            let (v, a, j) = (
                self.at.velocity[axis],
                self.at.acceleration[axis],
                jerk[axis],
            );
            let (top, most, strong) = (
                self.limits.velocity()[axis],
                self.limits.acceleration()[axis],
                self.limits.jerk()[axis],
            );
            let (v1, a1) = (v + (a + 0.5 * j * t) * t, a + j * t);
            let reached = v1 + 0.5 * a1 * a1.abs() / strong;
            // Turning points inside lie between this and the start's own bound.
            let inside = a * a1 >= 0.0 || (v - 0.5 * a * a / j).abs() <= top;
            a1.abs() <= most && reached.abs() <= 0.999 * top && v1.abs() <= top && inside
        })
    }
}

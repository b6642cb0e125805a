//! Judges executed motion between its ticks, as polynomials of time.
//!
//! The judge knows the planned pieces and how planned time passed; it composes both to polynomials of the ninth degree
//! and bounds their derivatives by Bernstein coefficients, cut in halves until the bound is sharp. It shares no formula
//! with the executor.

use std::collections::VecDeque;
use toolglide_kinematics::{Limits, Piece, TimeLaw, Vector};

/// What executed motion may exceed a limit by, as a share.
pub const EXECUTED_SLACK: f64 = 1e-9;

/// Coefficients by increasing powers.
type Polynomial = Vec<f64>;

/// The judge of one motion.
#[derive(Clone, Debug)]
pub struct ExecutedJudge<const N: usize> {
    limits: Limits<N>,
    pieces: VecDeque<(f64, Piece<N>)>,
    end: f64,
    /// Index of the piece looked at last.
    near: usize,
    planned: f64,
    /// Largest velocity, acceleration and jerk of any axis, as shares of the limits.
    pub worst: [f64; 3],
    /// Largest gap in planned time between two steps, s.
    pub gap: f64,
}

impl<const N: usize> ExecutedJudge<N> {
    /// A judge of motion within these limits.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self {
            limits,
            pieces: VecDeque::new(),
            end: 0.0,
            near: 0,
            planned: 0.0,
            worst: [0.0; 3],
            gap: 0.0,
        }
    }

    /// Takes the planned piece that follows.
    pub fn expect(&mut self, piece: &Piece<N>) {
        if piece.duration() > 0.0 {
            self.pieces.push_back((self.end, *piece));
        }
        self.end += piece.duration();
    }

    /// Begins in the middle of the motion, at a planned time.
    pub fn begin_at(&mut self, planned: f64) {
        self.planned = planned;
    }

    /// Forgets the pieces that end before a planned time.
    pub fn forget(&mut self, planned: f64) {
        while self.pieces.get(1).is_some_and(|next| next.0 < planned) {
            self.pieces.pop_front();
            self.near = self.near.saturating_sub(1);
        }
    }

    /// The planned time seen last, s.
    #[must_use]
    pub fn planned(&self) -> f64 {
        self.planned
    }

    /// Planned position at a planned time.
    #[must_use]
    pub fn place(&self, planned: f64) -> Option<Vector<N>> {
        let after = self.pieces.partition_point(|(begin, _)| *begin <= planned);
        let (begin, piece) = self.pieces.get(after.saturating_sub(1))?;
        Some(piece.position_at(planned - begin))
    }

    /// Takes a stretch of executed motion.
    pub fn observe(&mut self, law: &TimeLaw) {
        let stands = law.rate.abs() <= 0.0 && law.change.abs() <= 0.0 && law.bend.abs() <= 0.0;
        if !stands {
            self.gap = self.gap.max((law.planned - self.planned).abs());
        }
        let t = law.duration;
        // Planned time as a polynomial of a time from 0 to 1.
        let tau = [
            law.planned,
            law.rate * t,
            law.change * t * t / 2.0,
            law.bend * t * t * t / 6.0,
        ];
        self.planned = tau.iter().sum();
        if self.pieces.is_empty() || t <= 0.0 {
            return;
        }
        let mut cuts = vec![0.0, 1.0];
        // Where the rate is 0 planned time turns.
        let (a, b, c) = (3.0 * tau[3], 2.0 * tau[2], tau[1]);
        let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
        for value in [(-b + root) / (2.0 * a), (-b - root) / (2.0 * a), -c / b] {
            if value > 0.0 && value < 1.0 {
                cuts.push(value);
            }
        }
        cuts.sort_by(f64::total_cmp);
        for pair in cuts.windows(2) {
            self.monotone(&tau, pair[0], pair[1], t);
        }
    }

    /// A part in which planned time does not turn.
    fn monotone(&mut self, tau: &[f64; 4], from: f64, to: f64, t: f64) {
        let at = |x: f64| ((tau[3] * x + tau[2]) * x + tau[1]) * x + tau[0];
        let (low, high) = (at(from).min(at(to)), at(from).max(at(to)));
        while self.near > 0 && self.pieces[self.near].0 > low {
            self.near -= 1;
        }
        while self.near + 1 < self.pieces.len() && self.pieces[self.near + 1].0 <= low {
            self.near += 1;
        }
        let rising = at(to) >= at(from);
        let cross = |knot: f64| {
            if knot <= low {
                return if rising { from } else { to };
            }
            if knot >= high {
                return if rising { to } else { from };
            }
            let (mut a, mut b) = (from, to);
            for _ in 0..100 {
                let middle = 0.5 * (a + b);
                if (at(middle) < knot) == rising {
                    a = middle;
                } else {
                    b = middle;
                }
            }
            0.5 * (a + b)
        };
        let mut index = self.near;
        while index < self.pieces.len() && self.pieces[index].0 <= high {
            let (begin, piece) = self.pieces[index];
            let end = self.pieces.get(index + 1).map_or(self.end, |next| next.0);
            let (a, b) = (cross(begin), cross(end));
            self.judge(&piece, begin, tau, a.min(b), a.max(b), t);
            index += 1;
        }
    }

    fn judge(&mut self, piece: &Piece<N>, begin: f64, tau: &[f64; 4], from: f64, to: f64, t: f64) {
        if to <= from {
            return;
        }
        // Around the planned time at the start of the part, for the digits.
        let at = |x: f64| ((tau[3] * x + tau[2]) * x + tau[1]) * x + tau[0];
        let start = piece.at(at(from) - begin);
        let local = shifted(tau, from);
        let mut inner = local.clone();
        inner[0] = 0.0;
        for axis in 0..N {
            let cubic = [
                0.0,
                start.velocity[axis],
                start.acceleration[axis] / 2.0,
                start.jerk[axis] / 6.0,
            ];
            let mut position: Polynomial = vec![0.0; 10];
            let mut power: Polynomial = vec![1.0];
            for factor in cubic {
                for (sum, value) in position.iter_mut().zip(&power) {
                    *sum += factor * value;
                }
                power = product(&power, &inner);
            }
            let mut motion = position;
            let mut scale = 1.0;
            let bounds = [
                self.limits.velocity()[axis],
                self.limits.acceleration()[axis],
                self.limits.jerk()[axis],
            ];
            for (worst, bound) in self.worst.iter_mut().zip(bounds) {
                motion = derivative(&motion);
                scale *= t;
                let found = largest(&motion, to - from, *worst * bound * scale);
                *worst = worst.max(found / (bound * scale));
            }
        }
    }
}

/// The polynomial around another zero.
fn shifted(polynomial: &[f64; 4], by: f64) -> Polynomial {
    let [a, b, c, d] = *polynomial;
    vec![
        a + (b + (c + d * by) * by) * by,
        b + (2.0 * c + 3.0 * d * by) * by,
        c + 3.0 * d * by,
        d,
    ]
}

fn product(a: &[f64], b: &[f64]) -> Polynomial {
    let mut out = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] += x * y;
        }
    }
    out
}

#[allow(clippy::cast_precision_loss, reason = "at most nine")]
fn derivative(polynomial: &[f64]) -> Polynomial {
    polynomial
        .iter()
        .enumerate()
        .skip(1)
        .map(|(power, value)| value * power as f64)
        .collect()
}

/// Largest magnitude over `0..=width`, or `known` where it is no larger than that.
fn largest(polynomial: &[f64], width: f64, known: f64) -> f64 {
    let degree = polynomial.len() - 1;
    let mut scaled = polynomial.to_vec();
    let mut power = 1.0;
    for value in &mut scaled {
        *value *= power;
        power *= width;
    }
    let coefficients: Vec<f64> = (0..=degree)
        .map(|i| {
            (0..=i)
                .map(|k| choose(i, k) / choose(degree, k) * scaled[k])
                .sum()
        })
        .collect();
    halved(&coefficients, known, 0)
}

fn halved(coefficients: &[f64], known: f64, depth: u32) -> f64 {
    let bound = coefficients
        .iter()
        .fold(0.0_f64, |most, c| most.max(c.abs()));
    let ends = coefficients[0]
        .abs()
        .max(coefficients.last().copied().unwrap_or(0.0).abs())
        .max(known);
    if bound <= ends * (1.0 + 0.1 * EXECUTED_SLACK) || depth > 40 {
        return bound.min(ends.max(bound));
    }
    // De Casteljau at the middle.
    let mut row = coefficients.to_vec();
    let (mut left, mut right) = (vec![row[0]], vec![row[row.len() - 1]]);
    while row.len() > 1 {
        row = row
            .windows(2)
            .map(|pair| 0.5 * (pair[0] + pair[1]))
            .collect();
        left.push(row[0]);
        right.push(row[row.len() - 1]);
    }
    right.reverse();
    let first = halved(&left, ends, depth + 1);
    halved(&right, first.max(ends), depth + 1).max(first)
}

#[allow(clippy::cast_precision_loss, reason = "at most nine")]
fn choose(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |value, i| value * (n - i) as f64 / (i + 1) as f64)
}

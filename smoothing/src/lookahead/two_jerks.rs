//! Connects two states by two jerks an axis over a common duration.
//!
//! Source: equations 3.27 to 3.32. For a given duration each axis has one pair of jerks and one instant
//! between them, in closed form; the durations at which an axis gains or loses its pair are roots of
//! two quadratics. Not here: whether limits are kept.

use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::CLOSURE;
use toolglide_profiles::BlendShape;

/// The state in the middle of a corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Middle<const N: usize> {
    pub(crate) position: Vector<N>,
    pub(crate) velocity: Vector<N>,
    pub(crate) acceleration: Vector<N>,
}

impl<const N: usize> Middle<N> {
    pub(crate) fn of(
        shape: &BlendShape,
        point: &Vector<N>,
        incoming: &Vector<N>,
        outgoing: &Vector<N>,
    ) -> Self {
        Self {
            position: point
                + (outgoing * shape.exit.distance - incoming * shape.entry.distance) * 0.125,
            velocity: (incoming * shape.entry.speed + outgoing * shape.exit.speed) * 0.25,
            acceleration: (outgoing * shape.exit.acceleration
                - incoming * shape.entry.acceleration)
                * 0.5,
        }
    }
}

/// How one axis gets from middle to middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwoJerks {
    /// Instant between the two, as a share of the duration.
    pub(crate) switch: f64,
    pub(crate) first: f64,
    pub(crate) second: f64,
}

/// Most durations at which some axis gains or loses its pair of jerks: four an axis, and both ends.
const MAX_MARKS: usize = 4 * 8 + 2;

/// Durations at which some axis gains or loses its pair of jerks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Marks {
    at: [f64; MAX_MARKS],
    count: usize,
}

impl Marks {
    pub(crate) fn between(shortest: f64, longest: f64) -> Self {
        let mut at = [longest; MAX_MARKS];
        at[0] = shortest;
        Self { at, count: 2 }
    }

    /// With `D` and `N` as in [`solve`] times the cube of the duration, the instant between the jerks
    /// lies within the duration where `N` and `D - N` have the same sign.
    #[allow(
        clippy::many_single_char_names,
        reason = "transcribed equations keep the letters of the text"
    )]
    pub(crate) fn add_axis<const N: usize>(
        &mut self,
        start: &Middle<N>,
        end: &Middle<N>,
        axis: usize,
    ) {
        let (v0, a0) = (start.velocity[axis], start.acceleration[axis]);
        let (v1, a1) = (end.velocity[axis], end.acceleration[axis]);
        let s = end.position[axis] - start.position[axis];
        for [a, b, c] in [
            [a0, 2.0 * v1 + 4.0 * v0, -6.0 * s],
            [a1, -(4.0 * v1 + 2.0 * v0), 6.0 * s],
        ] {
            for root in roots(a, b, c) {
                if root > self.at[0] && root < self.at[1] && self.count < MAX_MARKS {
                    self.at[self.count] = root;
                    self.count += 1;
                }
            }
        }
    }

    /// The spans between marks, in order.
    pub(crate) fn spans(&mut self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.at[..self.count].sort_unstable_by(f64::total_cmp);
        let marks = &self.at[..self.count];
        marks.windows(2).map(|pair| (pair[0], pair[1]))
    }
}

/// The real roots of `a x^2 + b x + c`; NaN where there is none.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let half = -0.5 * (b + b.signum() * (b * b - 4.0 * a * c).sqrt());
    [half / a, c / half]
}

/// Two jerks for each axis, or `None` where an axis has none over this duration.
#[allow(
    clippy::many_single_char_names,
    reason = "transcribed equations keep the letters of the text"
)]
pub(crate) fn solve<const N: usize>(
    start: &Middle<N>,
    end: &Middle<N>,
    duration: f64,
) -> Option<[TwoJerks; N]> {
    let t = duration;
    let mut axes = [TwoJerks {
        switch: 0.5,
        first: 0.0,
        second: 0.0,
    }; N];
    for (i, axis) in axes.iter_mut().enumerate() {
        let (s0, v0, a0) = (start.position[i], start.velocity[i], start.acceleration[i]);
        let (s1, v1, a1) = (end.position[i], end.velocity[i], end.acceleration[i]);
        // Mean jerks that the acceleration, the velocity and the position ask for.
        let al = (a1 - a0) / t;
        let be = 2.0 * (v1 - v0 - a0 * t) / (t * t);
        let ga = 6.0 * (s1 - s0 - v0 * t - 0.5 * a0 * t * t) / (t * t * t);
        let scale = al.abs() + be.abs() + ga.abs();
        if (al - be).abs() <= CLOSURE * scale {
            if (be - ga).abs() > CLOSURE * scale {
                return None;
            }
            *axis = TwoJerks {
                switch: 0.5,
                first: al,
                second: al,
            };
            continue;
        }
        let mu = (be - ga) / (al - be);
        if !(mu > 0.0 && mu < 1.0) {
            return None;
        }
        let d = (al - be) / (mu * (1.0 - mu));
        let first = al - d * mu;
        *axis = TwoJerks {
            switch: 1.0 - mu,
            first,
            second: first + d,
        };
    }
    Some(axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn middle(numbers: [f64; 6]) -> Middle<2> {
        let [x, y, vx, vy, ax, ay] = numbers;
        Middle {
            position: Vector::<2>::new(x, y),
            velocity: Vector::<2>::new(vx, vy),
            acceleration: Vector::<2>::new(ax, ay),
        }
    }

    /// Middles of two corners of a curve of short moves.
    fn ends() -> [Middle<2>; 2] {
        [
            middle([0.0, 0.01, 12.0, 1.0, 150.0, 700.0]),
            middle([0.95, 0.2, 11.0, 4.5, -300.0, 650.0]),
        ]
    }

    #[test]
    fn both_jerks_together_lead_to_the_end() {
        let [start, end] = ends();
        let mut found = 0;
        for tick in 1..400 {
            let duration = 5e-4 * f64::from(tick);
            let Some(axes) = solve(&start, &end, duration) else {
                continue;
            };
            found += 1;
            for (axis, jerks) in axes.iter().enumerate() {
                let (mut s, mut v, mut a) = (
                    start.position[axis],
                    start.velocity[axis],
                    start.acceleration[axis],
                );
                let first = jerks.switch * duration;
                for (jerk, t) in [(jerks.first, first), (jerks.second, duration - first)] {
                    s += (v + (a / 2.0 + jerk * t / 6.0) * t) * t;
                    v += (a + jerk * t / 2.0) * t;
                    a += jerk * t;
                }
                let scale = jerks.first.abs() * duration.powi(3) + 1.0;
                assert!((s - end.position[axis]).abs() < 1e-9 * scale, "{duration}");
                assert!(
                    (v - end.velocity[axis]).abs() < 1e-9 * scale / duration,
                    "{duration}"
                );
                let square = duration * duration;
                assert!(
                    (a - end.acceleration[axis]).abs() < 1e-9 * scale / square,
                    "{duration}"
                );
            }
        }
        assert!(found > 10, "{found} durations");
    }

    #[test]
    fn between_two_marks_the_jerks_exist_everywhere_or_nowhere() {
        let [start, end] = ends();
        let mut marks = Marks::between(0.01, 0.4);
        for axis in 0..2 {
            marks.add_axis(&start, &end, axis);
        }
        let (mut with, mut without) = (0, 0);
        for (from, to) in marks.spans() {
            let exist = |share: f64| solve(&start, &end, from + (to - from) * share).is_some();
            let first = exist(1e-6);
            for cut in 1..200 {
                let share = f64::from(cut) / 200.0;
                assert_eq!(exist(share), first, "{from} to {to} at {share}");
            }
            if first { with += 1 } else { without += 1 }
        }
        assert!(
            with > 0 && without > 0,
            "{with} spans with, {without} without"
        );
    }
}

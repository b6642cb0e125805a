//! Represents motion of constant jerk per interval as a cubic B-spline.
//!
//! At node `k` the motion depends on three coefficients; the next interval brings one more and
//! forgets one. Position, velocity and acceleration at a node follow from its coefficients and the
//! other way round. In coefficients neighbours differ little and third differences are jerks, so
//! that what is eliminated in their terms keeps its digits, where in terms of states it loses them.
//!
//! Source: section 2.2 for the motion, de Boor's recursion for its basis. Not here: any bound.

use toolglide_kinematics::Vector;

/// Position, velocity and acceleration, or changes of them.
pub(crate) type State<const N: usize> = [Vector<N>; 3];

/// How a node's coefficients make what is bounded there; durations in s.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Basis {
    pub(crate) position: [f64; 3],
    pub(crate) velocity: [f64; 3],
    pub(crate) acceleration: [f64; 3],
    /// Inner Bezier points of position after and before the node.
    pub(crate) after: [f64; 3],
    pub(crate) before: [f64; 3],
    /// Inner Bezier point of velocity after the node.
    pub(crate) speed: [f64; 3],
    /// Jerk after the node, from its coefficients and the next one.
    pub(crate) jerk: [f64; 4],
    /// Sums of three durations, before and after, and the two next to the node.
    sums: [f64; 2],
    next: [f64; 2],
}

impl Basis {
    /// Basis at a node between intervals of these durations; `further` is the one after them.
    pub(crate) fn new(durations: [f64; 4], further: f64) -> Self {
        let mut basis = Self::without_jerk(durations);
        let [_, before, after, second] = durations;
        let next = Self::without_jerk([before, after, second, further]);
        let by_duration = 1.0 / after;
        let (here, there) = (basis.acceleration, next.acceleration);
        basis.jerk = [
            -here[0] * by_duration,
            (there[0] - here[1]) * by_duration,
            (there[1] - here[2]) * by_duration,
            there[2] * by_duration,
        ];
        basis
    }

    fn without_jerk([second_before, before, after, second_after]: [f64; 4]) -> Self {
        let first = second_before + before + after;
        let middle = before + after;
        let last = before + after + second_after;
        let (low, high) = (
            after * after / (first * middle),
            before * before / (last * middle),
        );
        let (by_first, by_last) = (3.0 / first, 3.0 / last);
        let (slow, fast) = (after / middle * by_first, before / middle * by_last);
        let double = 2.0 / middle;
        let (ahead, behind) = (before / last, after / first);
        Self {
            position: [low, 1.0 - low - high, high],
            velocity: [-slow, slow - fast, fast],
            acceleration: [
                double * by_first,
                -double * (by_first + by_last),
                double * by_last,
            ],
            after: [0.0, 1.0 - ahead, ahead],
            before: [behind, 1.0 - behind, 0.0],
            speed: [0.0, -by_last, by_last],
            jerk: [0.0; 4],
            sums: [first, last],
            next: [before, after],
        }
    }

    /// Position, velocity and acceleration of coefficients.
    #[inline(always)]
    pub(crate) fn state<const N: usize>(&self, coefficients: &[Vector<N>; 3]) -> State<N> {
        [&self.position, &self.velocity, &self.acceleration].map(|weights| {
            coefficients[0] * weights[0]
                + coefficients[1] * weights[1]
                + coefficients[2] * weights[2]
        })
    }

    /// The coefficients of a state.
    #[inline(always)]
    pub(crate) fn coefficients<const N: usize>(&self, state: &State<N>) -> [Vector<N>; 3] {
        let [position, velocity, acceleration] = state;
        let low = (velocity - acceleration * (0.5 * self.next[0])) * (self.sums[0] / 3.0);
        let high = (velocity + acceleration * (0.5 * self.next[1])) * (self.sums[1] / 3.0);
        let middle = position + low * self.position[0] - high * self.position[2];
        [middle - low, middle, middle + high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DURATIONS: [f64; 5] = [0.3, 0.2, 0.5, 0.4, 0.6];

    fn basis() -> Basis {
        Basis::new([0.3, 0.2, 0.5, 0.4], 0.6)
    }

    fn state() -> State<1> {
        [1.5, -2.0, 7.0].map(Vector::<1>::new)
    }

    #[test]
    fn coefficients_give_back_their_state() {
        let basis = basis();
        let back = basis.state(&basis.coefficients(&state()));
        for (value, expected) in back.iter().zip(&state()) {
            assert!((value - expected).norm() < 1e-14, "{value} {expected}");
        }
    }

    #[test]
    fn bezier_points_are_those_of_the_state() {
        let basis = basis();
        let coefficients = basis.coefficients(&state());
        let point = |weights: &[f64; 3]| {
            (0..3)
                .map(|index| weights[index] * coefficients[index][0])
                .sum::<f64>()
        };
        let (before, after) = (DURATIONS[1], DURATIONS[2]);
        assert!(
            (point(&basis.after) - (1.5 - 2.0 * after / 3.0)).abs() < 1e-14,
            "after"
        );
        assert!(
            (point(&basis.before) - (1.5 + 2.0 * before / 3.0)).abs() < 1e-14,
            "before"
        );
        assert!(
            (point(&basis.speed) - (-2.0 + 7.0 * after / 2.0)).abs() < 1e-13,
            "speed"
        );
    }

    #[test]
    fn one_more_coefficient_is_the_jerk() {
        let basis = basis();
        let [first, second, third] = basis.coefficients(&state());
        let jerk = 11.0;
        let known = [first, second, third]
            .iter()
            .zip(basis.jerk)
            .map(|(coefficient, weight)| coefficient[0] * weight)
            .sum::<f64>();
        let fourth = Vector::<1>::new((jerk - known) / basis.jerk[3]);
        let next = Basis::new([0.2, 0.5, 0.4, 0.6], 0.6);
        let [position, velocity, acceleration] = next.state(&[second, third, fourth]);
        let h = DURATIONS[2];
        assert!(
            (position[0] - (1.5 + h * (-2.0 + h * (3.5 + h * jerk / 6.0)))).abs() < 1e-13,
            "{position}"
        );
        assert!(
            (velocity[0] - (-2.0 + h * (7.0 + 0.5 * h * jerk))).abs() < 1e-13,
            "{velocity}"
        );
        assert!(
            (acceleration[0] - (7.0 + h * jerk)).abs() < 1e-12,
            "{acceleration}"
        );
    }
}

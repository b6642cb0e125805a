//! Finds the servo error: the offset of an actual point from the planned motion within a window of time.
//!
//! Source: geometry. The foot is at most `lag` set-points behind and `lead` ahead of now, so that a path which crosses itself
//! is no trap, and neither is a tool that rests in friction while the plan drives on. It may go back within the window: where
//! a path doubles back, a foot that never did could step on the way back too early and stay there. Not here: the error to the program, see `toolglide_verify::Course`.

use crate::ring::Ring;
use toolglide_kinematics::Vector;

/// The planned points, one servo period apart, and the foot of the actual one.
#[derive(Clone, Debug)]
pub(crate) struct Foot<const N: usize> {
    points: Ring<Vector<N>>,
    /// Length of the planned path up to each point.
    lengths: Ring<f64>,
    length: f64,
    foot: u64,
    lag: u64,
}

impl<const N: usize> Foot<N> {
    /// A window of `lag` set-points behind now; up to `ahead` of them are given ahead.
    pub(crate) fn new(lag: u64, ahead: u64) -> Self {
        let kept = usize::try_from(lag + ahead + 4).unwrap_or(usize::MAX);
        Self {
            points: Ring::new(kept, Vector::zeros()),
            lengths: Ring::new(kept, 0.0),
            length: 0.0,
            foot: 0,
            lag,
        }
    }

    /// Takes the next planned point.
    #[inline]
    pub(crate) fn give(&mut self, planned: Vector<N>) {
        if self.points.count() > 0 {
            self.length += (planned - self.points.get(self.points.count() - 1)).norm();
        }
        self.lengths.push(self.length);
        self.points.push(planned);
    }

    /// Planned point of a set-point in the window.
    #[inline]
    pub(crate) fn planned(&self, number: u64) -> Vector<N> {
        self.points.get(number)
    }

    /// Offset of the actual point at set-point `now` from its foot, which is at most `lead` set-points ahead.
    #[inline]
    pub(crate) fn offset(&mut self, now: u64, lead: u64, actual: &Vector<N>) -> Vector<N> {
        let newest = (now + lead).min(self.points.count().saturating_sub(1));
        let oldest = now.saturating_sub(self.lag).min(newest);
        // The foot before is probably near: it makes the search short.
        let mut at = self.foot.clamp(oldest, newest);
        let mut best = self.part(at, actual);
        let mut least = best.norm();
        let mut next = oldest;
        while next <= newest {
            let one = self.part(next, actual);
            let distance = one.norm();
            if distance < least {
                (best, least, at) = (one, distance, next);
            }
            // What is farther than the best by d cannot be followed by anything better before the plan has gone d.
            next = self.first_at(next, newest, distance - least);
        }
        self.foot = at;
        best
    }

    /// The first step after one whose end is at least so far along the path from the start of that one.
    #[inline]
    fn first_at(&self, from: u64, newest: u64, ahead: f64) -> u64 {
        let target = self.lengths.get(from) + ahead;
        let (mut low, mut stride) = (from + 1, 1);
        while low + stride <= newest && self.lengths.get(low + stride) <= target {
            low += stride;
            stride *= 2;
        }
        while stride > 1 {
            stride /= 2;
            if low + stride <= newest && self.lengths.get(low + stride) <= target {
                low += stride;
            }
        }
        if low < newest && self.lengths.get(low + 1) <= target {
            low + 1
        } else {
            low
        }
    }

    /// Offset from the nearest point of the step from a set-point to the next.
    #[inline]
    fn part(&self, number: u64, actual: &Vector<N>) -> Vector<N> {
        let start = self.points.get(number);
        let span = self.points.get(number + 1) - start;
        let offset = actual - start;
        let square = span.norm_squared();
        let share = if square > 0.0 {
            (offset.dot(&span) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        offset - span * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path of points on a figure, walked with an actual point that is `late` set-points behind and `aside` off.
    fn largest(figure: impl Fn(f64) -> Vector<2>, late: u64, aside: Vector<2>, steps: u64) -> f64 {
        let (lag, lead) = (400, 100);
        let mut foot = Foot::<2>::new(lag, lead);
        #[allow(clippy::cast_precision_loss, reason = "a few thousand steps")]
        let at = |k: u64| figure(k as f64);
        for k in 0..lead {
            foot.give(at(k));
        }
        let mut most = 0.0_f64;
        for k in 0..steps {
            foot.give(at(k + lead));
            let actual = at(k.saturating_sub(late)) + aside;
            most = most.max(foot.offset(k, lead, &actual).norm());
        }
        most
    }

    #[test]
    fn a_tool_on_its_path_but_late_has_no_error_where_the_path_crosses_itself() {
        let eight = |k: f64| {
            let turn = 0.002 * k;
            Vector::<2>::new(10.0 * turn.sin(), 5.0 * (2.0 * turn).sin())
        };
        let most = largest(eight, 300, Vector::zeros(), 5000);
        assert!(most < 1e-9, "{most}");
    }

    #[test]
    fn an_offset_is_measured_across_a_path_that_doubles_back() {
        let back = |k: f64| Vector::<2>::new((k - 1000.0).abs() * -0.01, 0.0);
        let most = largest(back, 50, Vector::<2>::new(0.0, 0.003), 2000);
        assert!((most - 0.003).abs() < 1e-12, "{most}");
    }

    #[test]
    fn a_rest_of_the_plan_is_a_step_of_no_length() {
        let dwell = |k: f64| Vector::<2>::new(0.01 * k.min(500.0), 0.0);
        let most = largest(dwell, 200, Vector::<2>::new(0.0, 0.002), 3000);
        assert!((most - 0.002).abs() < 1e-12, "{most}");
    }

    #[test]
    fn an_error_along_the_path_is_none_however_the_tool_leads_or_lags() {
        let line = |k: f64| Vector::<2>::new(0.01 * k, 0.02 * k);
        assert!(largest(line, 350, Vector::zeros(), 3000) < 1e-12, "late");
        let early = largest(line, 0, Vector::<2>::new(0.3, 0.6), 3000);
        assert!(early < 1e-12, "{early}");
    }
}

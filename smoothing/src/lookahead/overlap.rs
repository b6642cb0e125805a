//! Overlaps two corners: motion from the middle of one uninterrupted corner to the middle of the
//! next.
//!
//! Source: section 3.3.2. Two jerks an axis join both middles, in closed form for a given duration; the
//! shortest duration found that keeps every limit and the tolerance replaces the printed choice of
//! equal halves, one of whose two roots leaves the path. Not here: which corners overlap, and the two
//! jerks.

use crate::lookahead::two_jerks::{Marks, Middle, TwoJerks, solve};
use crate::segment::Segment;
use toolglide_kinematics::numeric::{CLOSURE, LIMIT_SLACK};
use toolglide_kinematics::{Limits, MoveRange, Piece, Sample, Vector};
use toolglide_profiles::BlendShape;

/// Durations tried, as shares of the distance over the mean speed.
const SHORTEST: f64 = 0.6;
const LONGEST: f64 = 1.8;
/// Durations tried between two at which an axis gains or loses its pair of jerks.
const CUTS: u32 = 6;
/// Halvings between the last duration that fails and the first that fits.
const HALVINGS: usize = 8;
/// Parts into which a piece is cut where its Bezier points are compared with the leg.
const PARTS: usize = 4;

/// A leg between two corners, with the legs beside it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OverlappedPair<'a, const N: usize> {
    pub(crate) before: &'a Segment<N>,
    pub(crate) leg: &'a Segment<N>,
    pub(crate) after: &'a Segment<N>,
}

impl<const N: usize> OverlappedPair<'_, N> {
    /// The least duration found from the middle of one corner to the middle of the next, or `None`
    /// when these two cannot overlap, or not in less than `most`.
    pub(crate) fn duration(
        &self,
        from: &BlendShape,
        to: &BlendShape,
        limits: &Limits<N>,
        most: f64,
    ) -> Option<f64> {
        if !(from.is_uninterrupted() && to.is_uninterrupted()) {
            return None;
        }
        let (start, end) = self.middles(from, to);
        let distance = (end.position - start.position).norm();
        let typical = 2.0 * distance / (start.velocity.norm() + end.velocity.norm());
        if !typical.is_finite() || SHORTEST * typical >= most {
            return None;
        }
        let fits = |duration: f64| self.fits(&start, &end, duration, limits);
        let mut marks = Marks::between(SHORTEST * typical, LONGEST * typical);
        for axis in 0..N {
            marks.add_axis(&start, &end, axis);
        }
        let mut failed = 0.0;
        for (from, to) in marks.spans() {
            if from >= most {
                return None;
            }
            if fits(from) {
                return Some(from);
            }
            // Between two marks an axis has its two jerks everywhere or nowhere.
            if solve(&start, &end, 0.5 * (from + to)).is_none() {
                failed = to;
                continue;
            }
            failed = from;
            for cut in 1..=CUTS {
                let duration = from + (to - from) * f64::from(cut) / f64::from(CUTS);
                if fits(duration) {
                    return Some(least(fits, failed, duration));
                }
                failed = duration;
            }
        }
        (failed > 0.0 && fits(failed)).then_some(failed)
    }

    /// The motion from middle to middle over a duration that was found to fit.
    pub(crate) fn pieces(
        &self,
        from: &BlendShape,
        to: &BlendShape,
        duration: f64,
        mut take: impl FnMut(Piece<N>),
    ) {
        let (start, end) = self.middles(from, to);
        let Some(axes) = solve(&start, &end, duration) else {
            debug_assert!(false, "an overlap was chosen that does not exist");
            return;
        };
        let serves = MoveRange {
            first: self.before.serves.first,
            last: self.after.serves.last,
        };
        for_each_part(&start, &axes, duration, |state, length, is_last| {
            let mut piece_end = position_after(state, length);
            if is_last {
                piece_end = end.position;
            }
            take(Piece::new(state, length, piece_end, serves));
            true
        });
    }

    fn middles(&self, from: &BlendShape, to: &BlendShape) -> (Middle<N>, Middle<N>) {
        let Self { before, leg, after } = self;
        (
            Middle::of(from, &leg.start, &before.direction, &leg.direction),
            Middle::of(to, &leg.end, &leg.direction, &after.direction),
        )
    }

    fn fits(&self, start: &Middle<N>, end: &Middle<N>, duration: f64, limits: &Limits<N>) -> bool {
        let Some(axes) = solve(start, end, duration) else {
            return false;
        };
        for (axis, jerks) in axes.iter().enumerate() {
            let TwoJerks {
                switch,
                first,
                second,
            } = *jerks;
            let bound = limits.jerk()[axis] * (1.0 - LIMIT_SLACK);
            let apex = start.acceleration[axis] + first * switch * duration;
            if first.abs() > bound
                || second.abs() > bound
                || apex.abs() > limits.acceleration()[axis] * (1.0 - LIMIT_SLACK)
            {
                return false;
            }
        }
        let feedrate = self
            .before
            .feedrate
            .min(self.leg.feedrate)
            .min(self.after.feedrate)
            * (1.0 - LIMIT_SLACK);
        let room = self.leg.room().length() * (1.0 + CLOSURE);
        let mut kept = true;
        for_each_part(start, &axes, duration, |state, length, _| {
            kept = self.part_fits(state, length, feedrate, room, limits);
            kept
        });
        kept
    }

    /// Whether a part of constant jerk keeps the velocities and the tolerance.
    fn part_fits(
        &self,
        state: &Sample<N>,
        length: f64,
        feedrate: f64,
        room: f64,
        limits: &Limits<N>,
    ) -> bool {
        // Bezier points of the velocity, a quadratic.
        let middle = state.velocity + state.acceleration * (0.5 * length);
        let last = state.velocity + (state.acceleration + state.jerk * (0.5 * length)) * length;
        for velocity in [state.velocity, middle, last] {
            let within = (0..N)
                .all(|axis| velocity[axis].abs() <= limits.velocity()[axis] * (1.0 - LIMIT_SLACK));
            if !within || velocity.norm() > feedrate {
                return false;
            }
        }
        let part = length / PARTS as f64;
        let mut from = *state;
        for _ in 0..PARTS {
            let to = after(&from, part);
            let points = [
                from.position,
                from.position + from.velocity * (part / 3.0),
                to.position - to.velocity * (part / 3.0),
                to.position,
            ];
            if points.iter().any(|point| self.off_leg(point) > room) {
                return false;
            }
            from = to;
        }
        true
    }

    fn off_leg(&self, point: &Vector<N>) -> f64 {
        let along = (point - self.leg.start)
            .dot(&self.leg.direction)
            .clamp(0.0, self.leg.length);
        (point - self.leg.start - self.leg.direction * along).norm()
    }
}

/// The least duration that fits, between one that does not and one that does.
fn least(fits: impl Fn(f64) -> bool, failed: f64, fitting: f64) -> f64 {
    let (mut low, mut high) = (failed, fitting);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if fits(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// Runs through the parts of constant jerk: state at the start, length, and whether it is the last;
/// stops when told `false`.
fn for_each_part<const N: usize>(
    start: &Middle<N>,
    axes: &[TwoJerks; N],
    duration: f64,
    mut take: impl FnMut(&Sample<N>, f64, bool) -> bool,
) {
    let mut cuts = axes.map(|axis| axis.switch * duration);
    cuts.sort_unstable_by(f64::total_cmp);
    let mut state = Sample {
        position: start.position,
        velocity: start.velocity,
        acceleration: start.acceleration,
        jerk: Vector::zeros(),
    };
    let mut time = 0.0;
    for cut in cuts.iter().copied().chain([duration]) {
        let length = cut - time;
        if length > CLOSURE * duration {
            let middle = 0.5 * (time + cut);
            for (axis, jerks) in axes.iter().enumerate() {
                let is_first = middle < jerks.switch * duration;
                state.jerk[axis] = if is_first { jerks.first } else { jerks.second };
            }
            let is_last = duration - cut <= CLOSURE * duration;
            let length = if is_last { duration - time } else { length };
            if !take(&state, length, is_last) || is_last {
                return;
            }
            state = after(&state, length);
            time = cut;
        }
    }
}

fn position_after<const N: usize>(state: &Sample<N>, time: f64) -> Vector<N> {
    state.position
        + (state.velocity + (state.acceleration * 0.5 + state.jerk * (time / 6.0)) * time) * time
}

fn after<const N: usize>(state: &Sample<N>, time: f64) -> Sample<N> {
    Sample {
        position: position_after(state, time),
        velocity: state.velocity + (state.acceleration + state.jerk * (0.5 * time)) * time,
        acceleration: state.acceleration + state.jerk * time,
        jerk: state.jerk,
    }
}

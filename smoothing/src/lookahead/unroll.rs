//! Unrolls a segment and the corner at its end into pieces.
//!
//! Source: sections 3.2 and 3.3. Each leg and each corner is anchored at programmed points, so that
//! rounding does not add up along the path. Not here: the choice of the corner.

use crate::segment::Segment;
use toolglide_kinematics::{Corner, MoveRange, Piece, Sample, Tolerance};
use toolglide_profiles::{BlendShape, Part, ProfileError, SCurve, SCurveBoundary};

/// Most pieces of a leg, its corner and a pause.
pub const MAX_PIECES: usize = 16;

fn feed_on<const N: usize>(
    leg: &Segment<N>,
    from: &BlendShape,
    to: &BlendShape,
) -> Result<SCurve, ProfileError> {
    let connection = SCurveBoundary {
        from: [from.exit.speed, from.exit.acceleration],
        to: [to.entry.speed, to.entry.acceleration],
        limits: leg.limits,
    };
    let length = leg.length - from.exit.distance - to.entry.distance;
    SCurve::over(length.max(0.0), &connection)
}

/// Unrolls the leg between two corner motions.
pub fn unroll_leg<const N: usize>(
    leg: &Segment<N>,
    from: &BlendShape,
    to: &BlendShape,
    mut take: impl FnMut(Piece<N>),
) {
    let (reach, left) = (from.exit.distance, to.entry.distance);
    let feed = match feed_on(leg, from, to) {
        Ok(feed) => feed,
        Err(error) => {
            debug_assert!(false, "the window promised that this fits: {error}");
            return;
        }
    };
    let Some(last) = feed.phases().iter().rposition(|phase| phase.duration > 0.0) else {
        return;
    };
    let end = if left > 0.0 {
        leg.end - leg.direction * left
    } else {
        leg.end
    };
    let at = |position: f64| {
        if position > 0.0 {
            leg.start + leg.direction * position
        } else {
            leg.start
        }
    };
    for (index, phase) in feed.phases().iter().enumerate() {
        if phase.duration <= 0.0 {
            continue;
        }
        let state = feed.starts()[index];
        let start = Sample {
            position: at(reach + state.position),
            velocity: leg.direction * state.velocity,
            acceleration: leg.direction * state.acceleration,
            jerk: leg.direction * state.jerk,
        };
        let reached = reach + state.after(phase.duration).position;
        let piece_end = if index == last { end } else { at(reached) };
        take(Piece::new(&start, phase.duration, piece_end, leg.serves));
    }
}

/// The corner between two legs.
#[must_use]
pub fn corner_between<const N: usize>(
    leg: &Segment<N>,
    next: &Segment<N>,
    tolerance: Tolerance,
) -> Corner<N> {
    Corner {
        point: leg.end,
        incoming: leg.direction,
        outgoing: next.direction,
        speed_in: leg.limits.velocity,
        speed_out: next.limits.velocity,
        tolerance,
    }
}

/// Unrolls a part of the corner motion between two legs.
pub(crate) fn unroll_corner<const N: usize>(
    shape: &BlendShape,
    part: Part,
    corner: Corner<N>,
    leg: &Segment<N>,
    next: &Segment<N>,
    take: impl FnMut(Piece<N>),
) {
    let serves = MoveRange {
        first: leg.serves.first,
        last: next.serves.last,
    };
    shape.unroll(&corner, part, serves, take);
}

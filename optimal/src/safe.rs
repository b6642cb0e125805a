//! From rest to rest along a straight line: the motion that is always there.
//!
//! Source: the seven phases of section 3.3.1. Where no window can be solved, the next straight line is
//! travelled from stop to stop. Not here: when that is.

use crate::span::Span;
use toolglide_kinematics::{Piece, Sample, Vector};
use toolglide_profiles::{Connection, Feed};

/// Spans from the beginning that lie on one line.
pub(crate) fn on_one_line<'a, const N: usize>(spans: impl Iterator<Item = &'a Span<N>>) -> usize {
    let mut count = 0;
    for span in spans {
        count += 1;
        if !span.goes_on {
            break;
        }
    }
    count
}

/// Duration of a span from rest to rest, s.
pub(crate) fn stop_to_stop<const N: usize>(span: &Span<N>) -> f64 {
    connection(span)
        .duration_over(span.length)
        .unwrap_or(f64::INFINITY)
}

fn connection<const N: usize>(span: &Span<N>) -> Connection {
    Connection {
        from: [0.0, 0.0],
        to: [0.0, 0.0],
        limits: span.limits,
    }
}

/// Pieces from rest at the start of `first` to rest at the end of `last`, which lie on one line.
pub(crate) fn travel<const N: usize>(
    first: &Span<N>,
    last: &Span<N>,
    mut take: impl FnMut(Piece<N>),
) {
    let length = (last.end - first.start).norm();
    let Ok(feed) = Feed::over(length, &connection(first)) else {
        debug_assert!(false, "a line from rest to rest can be travelled: {length}");
        return;
    };
    let at = |position: f64| -> Vector<N> {
        if position > 0.0 {
            first.start + first.direction * position
        } else {
            first.start
        }
    };
    let Some(final_phase) = feed.phases().iter().rposition(|phase| phase.duration > 0.0) else {
        return;
    };
    for (index, (phase, state)) in feed.phases().iter().zip(feed.starts()).enumerate() {
        if phase.duration <= 0.0 {
            continue;
        }
        let start = Sample {
            position: at(state.position),
            velocity: first.direction * state.velocity,
            acceleration: first.direction * state.acceleration,
            jerk: first.direction * state.jerk,
        };
        let end = if index == final_phase {
            last.end
        } else {
            at(state.after(phase.duration).position)
        };
        take(Piece::new(&start, phase.duration, end, first.serves));
    }
}

//! Finds places that two motions along the same path pass in the same state.
//!
//! Source: ours. Both rest at the end of the same move, or both pass a place on the line of a move at one velocity,
//! without acceleration: there the one motion may go on with the other. Not here: which one goes on.

use toolglide_kinematics::numeric::{JUMP_SLACK, LENGTH_SLACK, TIME_SLACK};
use toolglide_kinematics::{Piece, Sample};

/// Whether a piece keeps its velocity, which is not zero.
pub(crate) fn is_steady<const N: usize>(piece: &Piece<N>) -> bool {
    let start = piece.at(0.0);
    start.jerk.norm_squared() <= 0.0
        && start.acceleration.norm_squared() <= 0.0
        && start.velocity.norm_squared() > 0.0
        && piece.duration() > 4.0 * TIME_SLACK
}

/// Whether a motion rests at the end of a move between two pieces.
pub(crate) fn is_rest<const N: usize>(before: &Piece<N>, after: &Piece<N>) -> bool {
    let start = after.at(0.0);
    start.velocity.norm_squared() <= 0.0
        && start.acceleration.norm_squared() <= 0.0
        && before.serves().last < after.serves().first
}

/// Whether another motion rests at the same end of the same move, between its own two pieces.
pub(crate) fn is_same_rest<const N: usize>(ours: [&Piece<N>; 2], theirs: [&Piece<N>; 2]) -> bool {
    is_rest(theirs[0], theirs[1])
        && ours[0].serves().last == theirs[0].serves().last
        && ours[1].serves().first == theirs[1].serves().first
        && (ours[1].start() - theirs[1].start()).norm() <= 0.1 * LENGTH_SLACK
}

/// Two steady pieces of the same moves cut in two where both pass, if there is such a place.
pub(crate) fn cut<const N: usize>(
    ours: &Piece<N>,
    theirs: &Piece<N>,
) -> Option<[[Piece<N>; 2]; 2]> {
    if ours.serves() != theirs.serves() || !is_steady(theirs) {
        return None;
    }
    let [our_start, their_start] = [ours.at(0.0), theirs.at(0.0)];
    let velocity = our_start.velocity;
    let square = velocity.norm_squared();
    if (their_start.velocity - velocity).norm_squared() > (0.1 * JUMP_SLACK).powi(2) * square {
        return None;
    }
    // When they begin on the clock of our piece.
    let way = their_start.position - our_start.position;
    let ahead = way.dot(&velocity) / square;
    if (way - velocity * ahead).norm() > 0.1 * LENGTH_SLACK {
        return None;
    }
    let begin = ahead.max(0.0);
    let end = (ahead + theirs.duration()).min(ours.duration());
    if end - begin <= 4.0 * TIME_SLACK {
        return None;
    }
    let at = 0.5 * (begin + end);
    let position = ours.position_at(at);
    let parts = |piece: &Piece<N>, time: f64| {
        let start = piece.at(0.0);
        let middle = Sample { position, ..start };
        [
            Piece::new(&start, time, position, piece.serves()),
            Piece::new(
                &middle,
                piece.duration() - time,
                piece.end(),
                piece.serves(),
            ),
        ]
    };
    Some([parts(ours, at), parts(theirs, at - ahead)])
}

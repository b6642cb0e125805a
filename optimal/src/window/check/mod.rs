//! Checks whether the motion through a window may be executed.
//!
//! Source: ours. Nothing that a solver says is believed: its jerks are integrated from where the motion
//! is, the end is met exactly by the smallest change of the jerks that does so, and then every limit is
//! looked at again. Acceleration and jerk are extreme at the ends of the intervals; position and velocity
//! lie in the hull of their Bezier points, which is cut in halves where it is too wide to tell. Not here:
//! any formula of a solver.

mod hull;
pub(crate) mod silence;

use crate::window::{EndState, Wall, Window, WindowMotion, WindowSegment};
use hull::{distance, hull, share_of};
use toolglide_kinematics::Vector;
use toolglide_kinematics::nalgebra::{Matrix3, Vector3};
use toolglide_kinematics::numeric::LENGTH_SLACK;

/// Relative room granted to a limit: a tenth of what the judge of a whole motion grants.
const SLACK: f64 = 1e-10;

/// Room granted to a side that is kept, mm: what the solver leaves of its excess.
const WALL_SLACK: f64 = 8e-7;

/// How often a hull is cut in halves at most.
const MAX_HALVINGS: u32 = 5;

/// How often the end is corrected: once for the error, once for the rounding of that.
const CORRECTIONS: usize = 3;

/// Largest correction of a jerk as a share of its limit: what asks for more has not been solved.
const LARGEST_CORRECTION: f64 = 1e-2;

/// How far the end may be missed after the correction, as a share of the limits of velocity and
/// acceleration: a tenth of what counts as rest.
const END_SLACK: f64 = 1e-10;

/// Why a motion may not be executed, and by how much: value over bound.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Refused {
    /// The motion has another shape than the window, or is no motion.
    #[error("it is no motion through this window")]
    NoMotion,
    /// It does not lead to the end of the window.
    #[error("it misses the end of the window")]
    MissesEnd,
    /// A limit is exceeded in an interval.
    #[error("interval {interval} uses {share} of its {limit}")]
    Exceeds {
        /// Which one.
        limit: &'static str,
        /// Where.
        interval: usize,
        /// How much of it is used.
        share: f64,
    },
}

/// Makes a motion exact, and refuses it when it breaks any limit of `window`.
///
/// What is accepted starts and ends in the states of the window to the last bit but one, and its states
/// follow from its jerks.
pub(crate) fn accept<const N: usize>(
    window: &Window<'_, N>,
    motion: &mut WindowMotion<N>,
) -> Result<(), Refused> {
    let steps = window.steps();
    let fine = motion.durations.len() == window.segments.len()
        && motion.jerks.len() == steps
        && motion
            .durations
            .iter()
            .all(|duration| *duration > 0.0 && duration.is_finite())
        && motion
            .jerks
            .iter()
            .all(|jerk| jerk.iter().all(|value| value.is_finite()));
    if !fine {
        return Err(Refused::NoMotion);
    }
    close(window, motion)?;
    check(window, motion)
}

/// Durations of the intervals, in order.
pub(super) fn intervals<'a, const N: usize>(
    segments: &'a [WindowSegment<N>],
    durations: &'a [f64],
) -> impl Iterator<Item = (usize, f64)> + 'a {
    segments
        .iter()
        .zip(durations)
        .enumerate()
        .flat_map(|(index, (segment, duration))| {
            let interval = duration / crate::path::spans::steps(segment.steps);
            std::iter::repeat_n((index, interval), segment.steps)
        })
}

/// Integrates the jerks from the start, relative to it so that rounding stays small.
fn integrate<const N: usize>(window: &Window<'_, N>, motion: &mut WindowMotion<N>) {
    let origin = window.start.position;
    let mut state = EndState {
        position: Vector::zeros(),
        ..window.start
    };
    motion.states.clear();
    motion.states.push(window.start);
    let WindowMotion {
        durations,
        states,
        jerks,
    } = motion;
    for ((_, interval), jerk) in intervals(window.segments, durations).zip(jerks.iter()) {
        state = state.after(interval, jerk);
        states.push(EndState {
            position: origin + state.position,
            ..state
        });
    }
}

/// Meets the end by the smallest change of the jerks.
fn close<const N: usize>(
    window: &Window<'_, N>,
    motion: &mut WindowMotion<N>,
) -> Result<(), Refused> {
    let total = motion.duration();
    let limits = window.limits;
    // What a unit of jerk in an interval does to acceleration, velocity and position at the end, in
    // units of the total duration.
    let effect = |interval: f64, left: f64| {
        let (h, r) = (interval / total, left / total);
        Vector3::new(
            h,
            h * (0.5 * h + r),
            h * (h * (h / 6.0 + 0.5 * r) + 0.5 * r * r),
        )
    };
    let mut matrix = Matrix3::<f64>::zeros();
    let mut left = total;
    for (_, interval) in intervals(window.segments, &motion.durations) {
        left -= interval;
        let effect = effect(interval, left.max(0.0));
        matrix += effect * effect.transpose();
    }
    let inverse = matrix.try_inverse().ok_or(Refused::MissesEnd)?;
    for round in 0..=CORRECTIONS {
        integrate(window, motion);
        let Some(last) = motion.states.last() else {
            return Err(Refused::NoMotion);
        };
        let position = window.end.position - last.position;
        let velocity = window.end.velocity - last.velocity;
        let acceleration = window.end.acceleration - last.acceleration;
        let met = (0..N).all(|axis| {
            position[axis].abs() <= 0.1 * LENGTH_SLACK
                && velocity[axis].abs() <= END_SLACK * limits.velocity()[axis]
                && acceleration[axis].abs() <= END_SLACK * limits.acceleration()[axis]
        });
        if round == CORRECTIONS {
            if !met {
                return Err(Refused::MissesEnd);
            }
            break;
        }
        let mut change = [Vector3::<f64>::zeros(); N];
        for axis in 0..N {
            let missing = Vector3::new(
                acceleration[axis] / total,
                velocity[axis] / total.powi(2),
                position[axis] / total.powi(3),
            );
            change[axis] = inverse * missing;
        }
        let mut left = total;
        for ((_, interval), jerk) in
            intervals(window.segments, &motion.durations).zip(motion.jerks.iter_mut())
        {
            left -= interval;
            let effect = effect(interval, left.max(0.0));
            for axis in 0..N {
                let correction = effect.dot(&change[axis]);
                if correction.abs() > LARGEST_CORRECTION * limits.jerk()[axis]
                    || !correction.is_finite()
                {
                    return Err(Refused::MissesEnd);
                }
                jerk[axis] += correction;
            }
        }
    }
    if let Some(last) = motion.states.last_mut() {
        *last = window.end;
    }
    Ok(())
}

/// Whether the hull of some places reaches the part of a segment along which a side must be kept.
fn is_beside<const N: usize>(
    wall: &Wall<N>,
    segment: &WindowSegment<N>,
    places: &[Vector<N>],
) -> bool {
    let direction = (segment.end - segment.start).normalize();
    let along = |place: &Vector<N>| direction.dot(&(place - segment.start));
    let [from, to] = wall.between;
    places.iter().any(|place| along(place) < to) && places.iter().any(|place| along(place) > from)
}

/// Looks at every limit in every interval.
fn check<const N: usize>(window: &Window<'_, N>, motion: &WindowMotion<N>) -> Result<(), Refused> {
    let limits = window.limits;
    let mut left_in_segment = 0;
    for (node, (index, interval)) in intervals(window.segments, &motion.durations).enumerate() {
        let segment = &window.segments[index];
        if left_in_segment == 0 {
            left_in_segment = segment.steps;
        }
        left_in_segment -= 1;
        let (from, to) = (&motion.states[node], &motion.states[node + 1]);
        let jerk = &motion.jerks[node];
        let exceeds = |limit: &'static str, share: f64| {
            if share <= 1.0 + SLACK {
                Ok(())
            } else {
                Err(Refused::Exceeds {
                    limit,
                    interval: node,
                    share,
                })
            }
        };
        exceeds("jerk", share_of(jerk, limits.jerk()))?;
        exceeds(
            "acceleration",
            share_of(&to.acceleration, limits.acceleration()),
        )?;
        let speeds = [
            from.velocity,
            from.velocity + from.acceleration * (0.5 * interval),
            to.velocity,
        ];
        exceeds(
            "velocity",
            hull(speeds, MAX_HALVINGS, &|velocity| {
                share_of(velocity, limits.velocity())
            }),
        )?;
        exceeds(
            "feedrate",
            hull(speeds, MAX_HALVINGS, &|velocity| {
                velocity.norm() / segment.feedrate
            }),
        )?;
        let third = interval / 3.0;
        let places = [
            from.position,
            from.position + from.velocity * third,
            to.position - to.velocity * third,
            to.position,
        ];
        let room = LENGTH_SLACK * 0.1;
        exceeds(
            "tolerance",
            hull(places, MAX_HALVINGS, &|place| {
                (distance(segment, place) - room) / segment.tolerance
            }),
        )?;
        for wall in segment.walls.iter().flatten() {
            if is_beside(wall, segment, &places) {
                exceeds(
                    "side",
                    hull(places, MAX_HALVINGS, &|place| {
                        let beyond = wall.outward.dot(&(place - segment.start)) - wall.allowed;
                        1.0 + (beyond - WALL_SLACK) / segment.tolerance
                    }),
                )?;
            }
        }
        if left_in_segment == 0
            && let Some(ball) = segment.corner_tolerance
        {
            let miss = (to.position - segment.end).norm() - room;
            exceeds("corner tolerance", miss / ball)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::Limits;

    fn limits() -> Limits<2> {
        Limits::uniform(100.0, 2000.0, 5e4).unwrap()
    }

    /// From rest to rest along x with the jerk reversed twice: four intervals.
    fn straight(length: f64, duration: f64) -> (Vec<WindowSegment<2>>, WindowMotion<2>) {
        let segments = vec![WindowSegment {
            start: Vector::<2>::zeros(),
            end: Vector::<2>::new(length, 0.0),
            tolerance: 0.01,
            corner_tolerance: None,
            feedrate: 100.0,
            steps: 4,
            follow: None,
            walls: [None; 2],
        }];
        let jerk = Vector::<2>::new(32.0 * length / duration.powi(3), 0.0);
        let motion = WindowMotion {
            durations: vec![duration],
            states: Vec::new(),
            jerks: vec![jerk, -jerk, -jerk, jerk],
        };
        (segments, motion)
    }

    fn judge(segments: &[WindowSegment<2>], motion: &mut WindowMotion<2>) -> Result<(), Refused> {
        let window = Window {
            start: EndState::rest(segments[0].start),
            end: EndState::rest(segments[segments.len() - 1].end),
            segments,
            limits: &limits(),
            silence: None,
        };
        accept(&window, motion)
    }

    #[test]
    fn a_move_of_bang_bang_jerk_is_accepted_at_its_limit_and_not_above() {
        // The jerk of 5e4 mm/s³ gives 4 (L / 2 J)^(1/3).
        let least = 4.0 * (1.0_f64 / 1e5).cbrt();
        let (segments, mut motion) = straight(1.0, least * (1.0 + 1e-12));
        assert_eq!(judge(&segments, &mut motion), Ok(()));
        let (segments, mut motion) = straight(1.0, least * (1.0 - 1e-6));
        let refused = judge(&segments, &mut motion);
        assert!(
            matches!(refused, Err(Refused::Exceeds { limit: "jerk", .. })),
            "{refused:?}"
        );
    }

    #[test]
    fn a_small_error_at_the_end_is_closed_exactly() {
        let (segments, mut motion) = straight(1.0, 0.1);
        for (index, jerk) in motion.jerks.iter_mut().enumerate() {
            jerk[1] += if index % 2 == 0 { 0.3 } else { -0.1 };
            jerk[0] *= 1.0 - 1e-6;
        }
        assert_eq!(judge(&segments, &mut motion), Ok(()));
        let mut state = motion.states[0];
        for jerk in &motion.jerks {
            state = state.after(0.025, jerk);
        }
        assert!(
            (state.position - segments[0].end).norm() < 1e-13,
            "{state:?}"
        );
        assert!(state.velocity.norm() < 1e-11, "{state:?}");
    }

    #[test]
    fn every_limit_is_noticed() {
        let broken = |change: &dyn Fn(&mut Vec<WindowSegment<2>>, &mut WindowMotion<2>)| {
            let (mut segments, mut motion) = straight(2.0, 0.15);
            change(&mut segments, &mut motion);
            judge(&segments, &mut motion)
        };
        assert_eq!(broken(&|_, _| {}), Ok(()));
        let slow = broken(&|segments, _| segments[0].feedrate = 20.0);
        assert!(
            matches!(
                slow,
                Err(Refused::Exceeds {
                    limit: "feedrate",
                    ..
                })
            ),
            "{slow:?}"
        );
        let far = broken(&|_, motion| {
            for (jerk, sign) in motion.jerks.iter_mut().zip([1.0, -3.0, 3.0, -1.0]) {
                jerk[1] = 4e3 * sign;
            }
        });
        assert!(
            matches!(
                far,
                Err(Refused::Exceeds {
                    limit: "tolerance",
                    ..
                })
            ),
            "{far:?}"
        );
        let nan = broken(&|_, motion| motion.jerks[1][0] = f64::NAN);
        assert_eq!(nan, Err(Refused::NoMotion));
        let elsewhere = broken(&|segments, _| segments[0].end[0] = 2.5);
        assert_eq!(elsewhere, Err(Refused::MissesEnd));
    }
}

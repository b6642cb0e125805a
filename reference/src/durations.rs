//! Finds the time fractions of the segments by exact solutions and linearized steps in turn.
//!
//! Source: for given shares the optimum is one convex program; its dependence on them has kinks, so
//! gradients are of little use. A second program, linearized in the durations, proposes a step
//! inside a trust region; it counts only if the first then takes less time. Every iterate is a
//! motion that is allowed. Not here: proofs of optimality, see [`bound`](crate::bound).

use crate::course::Course;
use crate::formulation::Kind;
use crate::grid::Grid;
use crate::motion::{Least, best_change, least_time};

/// Largest relative change of a duration in the first step.
const FIRST_CHANGE: f64 = 0.2;

/// Largest relative change of a duration in any step: none may vanish.
const LARGEST_CHANGE: f64 = 0.5;

/// Below this relative change a step is no step.
const SMALLEST_CHANGE: f64 = 1e-6;

/// A step whose promise is below this share of the time is not worth a solve: a tenth of what the
/// grid itself gets wrong.
const WORTH: f64 = 2e-6;

/// Steps at most: fourteen were needed for forty legs.
const STEPS: usize = 40;

/// Steps that saved less than [`WORTH`] before no more are tried.
const IDLE_STEPS: usize = 2;

/// The best durations near those of `grid`; `None` when not even these can be solved.
pub(crate) fn best_durations<const N: usize>(
    course: &Course<N>,
    grid: &Grid,
    kind: Kind,
    margin: f64,
) -> Option<Least<N>> {
    let mut best = least_time(course, grid, kind, None, margin)?;
    if course.legs.len() == 1 {
        return Some(best);
    }
    let mut most = FIRST_CHANGE;
    let mut idle = 0;
    for _ in 0..STEPS {
        if most < SMALLEST_CHANGE {
            break;
        }
        let step = best_change(course, &best.grid, kind, margin, &best.motion, most);
        let Some((changes, promised)) = step else {
            most /= 3.0;
            continue;
        };
        if promised < WORTH {
            break;
        }
        let changed = changed(&best.grid, &changes);
        let next = least_time(course, &changed, kind, None, margin);
        let saved = next
            .as_ref()
            .map_or(-1.0, |next| 1.0 - next.duration / best.duration);
        match next {
            Some(next) if saved > 0.0 => {
                best = next;
                if saved > 0.7 * promised {
                    most = (2.0 * most).min(LARGEST_CHANGE);
                } else if saved < 0.3 * promised {
                    most *= 0.5;
                }
                idle = if saved < WORTH { idle + 1 } else { 0 };
                if idle >= IDLE_STEPS {
                    break;
                }
            }
            _ => {
                let largest = changes
                    .iter()
                    .fold(0.0, |most: f64, change| most.max(change.abs()));
                most = 0.25 * most.min(largest);
            }
        }
    }
    Some(best)
}

fn changed(grid: &Grid, changes: &[f64]) -> Grid {
    let mut grid = grid.clone();
    for (step, &leg) in grid.steps.iter_mut().zip(&grid.serves) {
        *step *= 1.0 + changes[leg];
    }
    grid
}

//! One name per asserted bound, with its reason.
//!
//! Not here: limits and tolerances, which the judge holds the motion to.

use std::time::Duration;

/// A plan that may stop everywhere is never slower than stopping everywhere, but for the rounding of
/// the sum of its durations, relative.
pub const NEVER_SLOWER: f64 = 1e-9;

/// The same for paths with arcs, relative: stopping beside an arc cuts it into chords afresh, and an arc
/// smaller than the tolerance may be merged whole where it is taken by itself. A known shortfall, which
/// the courses of the fixed seed keep to: of 62,456 other random plans with arcs 25 were slower by more
/// than this, the worst 2.1 times; of 55,144 without arcs none was slower at all.
pub const NEVER_SLOWER_WITH_ARCS: f64 = 0.05;

/// Mirrored, permuted and scaled paths take the same time, relative: searches end within
/// [`SEARCH_PRECISION`](toolglide_kinematics::numeric::SEARCH_PRECISION) of a value that rounding may
/// bring to either side.
pub const SAME_DURATION: f64 = 1e-6;

/// Durations that were printed or derived with five digits, relative.
pub const PRINTED: f64 = 1e-3;

/// Fewest plans that one run of the random paths judges.
pub const FEWEST_PLANS: u32 = 2_000;

/// Longest planning of a course of some thirty moves: milliseconds are usual, and a search without
/// bound once took minutes.
pub const LONGEST_PLANNING: Duration = Duration::from_secs(1);

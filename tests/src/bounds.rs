//! Names each asserted bound and its reason.
//!
//! Not here: limits and tolerances, which the judge holds the motion to.

use std::time::Duration;

/// A plan by `kcs` is never slower than stopping at the end of every move, but for the rounding of the sum
/// of its durations, relative.
pub const NEVER_SLOWER: f64 = 1e-9;

/// Mirrored, permuted and scaled paths take the same time, relative: searches end within
/// [`SEARCH_PRECISION`](toolglide_kinematics::numeric::SEARCH_PRECISION) of a value that rounding may
/// bring to either side.
pub const SAME_DURATION: f64 = 1e-6;

/// Durations that were printed or derived with five digits, relative.
pub const PRINTED: f64 = 1e-3;

/// Fewest plans that one run of the random paths judges.
pub const MIN_PLANS: u32 = 2_000;

/// Longest planning of a course of some thirty moves: milliseconds are usual, and a search without
/// bound once took minutes.
pub const LONGEST_PLANNING: Duration = Duration::from_secs(1);

/// A plan by `kcs` is no slower than by another method, or with less tolerance, but for this, relative.
pub const SLOWER: f64 = 0.005;

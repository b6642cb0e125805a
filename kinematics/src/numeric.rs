//! Every numerical threshold of the workspace, each with its unit and its reason.
//!
//! What a user may want different is an argument; what only float arithmetic needs stands here.

/// Points nearer than this coincide, mm: a tenth of a picometre, far below any encoder and above the
/// rounding of coordinates of some metres.
pub const SHORTEST_LENGTH: f64 = 1e-10;

/// Relative room granted to a limit before it counts as broken: the rounding of a few hundred
/// operations on a bound that the planner uses up entirely.
pub const LIMIT_SLACK: f64 = 1e-9;

/// Room granted to a length, mm: rounding of coordinates of up to some ten metres, added over one
/// corner.
pub const LENGTH_SLACK: f64 = 1e-9;

/// Two halves of a motion whose relative mismatch is below this meet, dimensionless: a closed form
/// evaluated and integrated forward agree to about 1e-13.
pub const CLOSURE: f64 = 1e-11;

/// Relative precision to which a peak speed or a corner scale is searched, dimensionless: what is
/// lost in cycle time stays below a part in a million.
pub const SEARCH_PRECISION: f64 = 1e-7;

/// Start and end radius of an arc may always differ by this, mm: programs round their centres to
/// three decimals.
pub const ARC_RADIUS_MISMATCH: f64 = 0.005;

/// Start and end radius of an arc may differ by this share of the radius.
pub const ARC_RADIUS_MISMATCH_SHARE: f64 = 0.001;

/// Start and end radius of an arc may never differ by more than this, mm.
pub const ARC_RADIUS_MISMATCH_MOST: f64 = 0.5;

/// A tool orientation may miss unit length by this before it is refused instead of normalised:
/// programs write four decimals and more.
pub const UNIT_LENGTH_ERROR: f64 = 1e-3;

/// Share of a tolerance that remains however much of it was used, so that a tolerance stays positive.
pub const LEAST_SHARE: f64 = 1e-3;

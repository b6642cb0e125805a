//! Lists the numerical thresholds that several files share, each with its unit and its reason.
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

/// Room granted to an angle, rad: rounding of some thousand turns, far below any encoder.
pub const ANGLE_SLACK: f64 = 1e-9;

/// Two halves of a motion whose relative mismatch is below this meet, dimensionless: a closed form
/// evaluated and integrated forward agree to about 1e-13.
pub const CLOSURE: f64 = 1e-11;

/// Relative precision to which a peak speed or a corner scale is searched, dimensionless: what is
/// lost in cycle time stays below a part in a million.
pub const SEARCH_PRECISION: f64 = 1e-7;

/// Start and end radius of an arc may always differ by this, mm: two roundings of both coordinates to a
/// thousandth of an inch, which is what LinuxCNC grants programs in inches. What a program in mm may do is the
/// business of its reader.
pub const ARC_RADIUS_MISMATCH: f64 = 2.0 * 0.001 * core::f64::consts::SQRT_2 * 25.4;

/// Start and end radius of an arc may differ by this share of the radius.
pub const ARC_RADIUS_MISMATCH_SHARE: f64 = 0.001;

/// Start and end radius of an arc may never differ by more than this, mm: a hundred times what they always may,
/// as for LinuxCNC.
pub const ARC_RADIUS_MISMATCH_MOST: f64 = 100.0 * ARC_RADIUS_MISMATCH;

/// A tool orientation may miss unit length by this before it is refused instead of normalised:
/// programs write four decimals and more.
pub const UNIT_LENGTH_ERROR: f64 = 1e-3;

/// Share of a tolerance that remains however much of it was used, so that a tolerance stays positive.
pub const MIN_SHARE: f64 = 1e-3;

/// Room granted to a length per mm of coordinate, dimensionless: the rounding of some sixteen
/// operations on a coordinate.
pub const COORDINATE_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Relative room granted to velocity and acceleration where two pieces meet, and to rest, as a
/// share of the limit of the axis: both sides are sums of a few products below the limit, so their
/// rounding stays far below.
pub const JUMP_SLACK: f64 = 1e-9;

/// Most of a limit that a change between two pieces may be put down to the rounding of coordinates, as a share: a
/// thousand such changes are a thousandth of the limit.
pub const COORDINATE_JUMP: f64 = 1e-6;

/// Room granted to a duration, s: a nanosecond, far below any period and far above the rounding of
/// the durations that are added.
pub const TIME_SLACK: f64 = 1e-9;

/// Rows of set-points at most this far apart, s, are what a drive is given, with nothing between them to
/// judge: the usual period of controllers.
pub const SERVO_PERIOD: f64 = 1e-3;

/// Relative precision to which the judge finds the largest deviation and the closest approach to
/// a corner: a ten-thousandth of a micrometre for a tolerance of 0.1 mm.
pub const JUDGE_PRECISION: f64 = 1e-6;

/// Relative precision to which the judge finds the square of the largest speed: well inside
/// [`LIMIT_SLACK`].
pub const SPEED_PRECISION: f64 = 1e-12;

/// How often the judge halves a piece of motion at most: a share of 1e-12 of any piece is shorter
/// than a picometre.
pub const JUDGE_HALVINGS: u32 = 40;

/// How many parts of one piece the judge looks at before it takes the bound for the value: never
/// reached by motion that follows its path, a fraction of a second for motion made to be awkward.
pub const JUDGE_PARTS: u32 = 50_000;

/// How many more it looks at for every move that the piece may be on: some ten are needed where each
/// of them bends away from the motion by as much as the others.
pub const JUDGE_PARTS_OF_A_MOVE: u32 = 64;

/// Numbers beyond this are no motion, mm, s and their quotients: sixth powers of them must still be
/// finite.
pub const LARGEST_MAGNITUDE: f64 = 1e30;

/// Coordinates beyond this are refused, mm: ten kilometres, where a float of 64 bits still resolves
/// two millionths of a micrometre.
pub const LARGEST_COORDINATE: f64 = 1e7;

/// Limits and feedrates beyond this are refused, mm, rad and their quotients with s: their cubes and quotients,
/// times any length, must stay finite and keep their digits.
pub const LARGEST_QUANTITY: f64 = 1e15;

/// A tolerance below this share of the radius of its arc is refused: a turn would have more than 200,000 chords, and
/// float arithmetic would leave less than six digits of the tolerance.
pub const MIN_SHARE_OF_RADIUS: f64 = 1e-10;

/// Dwells beyond this are refused, s: thirty years.
pub const LONGEST_DURATION: f64 = 1e9;

/// Limits, feedrates and tolerances below this are refused, mm, rad and their quotients with s: no axis is so
/// slow and no encoder so fine, and motion within them would outlast the digits of its time.
pub const MIN_QUANTITY: f64 = 1e-9;

/// How many moves ahead the judge of set-points looks at most for a motion that has left its path:
/// enough for moves of a hundredth of the tolerance, and a millisecond at worst.
pub const LOOK_AHEAD_MOVES: u32 = 1024;

/// Limits of acceleration and jerk below this are refused, mm, rad and their quotients with s: over ten kilometres a
/// motion would take months.
pub const MIN_ACCELERATION: f64 = 1e-6;

/// An axis that takes longer than this to build up its acceleration, or to reach its velocity at that, is refused, s:
/// a quarter of an hour of one phase beside the milliseconds of another leaves too few digits of either.
pub const LONGEST_RAMP: f64 = 1e3;

/// Orientations nearer than this are one, rad: a nanometre at the end of a tool of a metre.
pub const SAME_ORIENTATION: f64 = 1e-9;

/// Orientations nearer than this to opposite have no axis to turn about, rad: a thousandfold of the
/// rounding of programs with nine decimals, so that the axis would be noise.
pub const OPPOSITE_ANGLE: f64 = 1e-6;

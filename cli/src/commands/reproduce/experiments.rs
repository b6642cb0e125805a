//! Lists the figures and tables of the dissertation with their printed numbers.
//!
//! Programs, feedrates and tolerances are those of `examples/dissertation/`; the limits of both axes
//! stand here. Where the geometry is not printed it is our own construction, and says so.

use crate::commands::reproduce::poses::{PosePath, STAR_50, STAR_100, TABLE_5_1};
use crate::commands::reproduce::quantity::{Planned, Quantity};
use toolglide_fiveaxis::PoseMethod;

/// A program and the limits of its axes.
#[derive(Debug)]
pub(super) struct Course {
    pub(super) name: &'static str,
    pub(super) text: &'static str,
    /// mm/s²
    pub(super) acceleration: f64,
    /// mm/s³
    pub(super) jerk: f64,
    /// Time constants of filters, s; none for methods without.
    pub(super) filters: &'static [f64],
}

/// A figure or table.
#[derive(Debug)]
pub(super) struct Experiment {
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    pub(super) entries: &'static [Entry],
}

/// One number of it.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) quantity: Quantity,
    /// As it is printed; with < where it is a bound, empty where nothing is printed.
    pub(super) printed: &'static str,
    /// Why ours differs.
    pub(super) note: &'static str,
}

macro_rules! course {
    ($file:literal, $acceleration:literal, $jerk:literal) => {
        course!($file, $acceleration, $jerk, &[])
    };
    ($file:literal, $acceleration:literal, $jerk:literal, $filters:expr) => {
        Course {
            name: $file,
            text: include_str!(concat!("../../../../examples/dissertation/", $file)),
            acceleration: $acceleration,
            jerk: $jerk,
            filters: $filters,
        }
    };
}

static RIGHT_100: Course = course!("right_angle_100um.ngc", 2_500.0, 2e5);
static RIGHT_10: Course = course!("right_angle_10um.ngc", 2_500.0, 2e5);
static SIX: Course = course!("six_corners.ngc", 3_000.0, 1e5);
static TURN_20: Course = course!("cornering_20deg.ngc", 3_000.0, 1e5);
static TURN_160: Course = course!("cornering_160deg.ngc", 3_000.0, 1e5);
static TWO_9: Course = course!("two_corners_9um.ngc", 3_000.0, 1e5);
static TWO_80: Course = course!("two_corners_80um.ngc", 3_000.0, 1e5);
static SPIRAL: Course = course!("spiral.ngc", 2_000.0, 5e4);
static HEART: Course = course!("heart.ngc", 2_000.0, 5e4);

static ARC: Course = course!("arc_after_lines.ngc", 10_000.0, 1e6, &[0.05, 0.03]);
static CLOVER: Course = course!("clover.ngc", 20_000.0, 2e6, &[0.03, 0.025]);
static STARFISH: Course = course!("starfish.ngc", 2_500.0, 2e5, &[0.1351, 0.1087]);
static STARFISH_PRINTED: Course = course!("starfish.ngc", 2_500.0, 2e5, &[0.1361, 0.1109]);

const INTERRUPTED: &str = "kcs-interrupted";
const UNINTERRUPTED: &str = "kcs-uninterrupted";
const LOCAL: &str = "kcs-local";
const GLOBAL: &str = "kcs-global";
const BEZIER: &str = "bezier";
const STOP: &str = "exact-stop";
const KCS: &str = "kcs";
const FIR: &str = "fir";
const FIR_STOP: &str = "fir-p2p";

const SPEEDS: &str = "print rounds phases up to 0.1 ms and truncates the speed (inferred)";
const MADE: &str = "geometry not printed, so ours differs";
const NOT_PRINTED: &str = "not printed";

const JOINT: PoseMethod = PoseMethod::JointSpace { way_points: 0 };

const fn pose_time(
    path: &'static PosePath,
    method: PoseMethod,
    printed: &'static str,
    note: &'static str,
) -> Entry {
    Entry {
        quantity: Quantity::PoseTime(path, method),
        printed,
        note,
    }
}

const fn planned(course: &'static Course, method: &'static str) -> Planned {
    Planned { course, method }
}

const fn time(
    course: &'static Course,
    method: &'static str,
    printed: &'static str,
    note: &'static str,
) -> Entry {
    entry(Quantity::CycleTime(planned(course, method)), printed, note)
}

const fn speed(
    course: &'static Course,
    method: &'static str,
    printed: &'static str,
    note: &'static str,
) -> Entry {
    entry(
        Quantity::CornerSpeed(planned(course, method)),
        printed,
        note,
    )
}

const fn ratio(
    course: &'static Course,
    method: &'static str,
    printed: &'static str,
    note: &'static str,
) -> Entry {
    entry(
        Quantity::Ratio(planned(course, method), STOP),
        printed,
        note,
    )
}

/// By how much a method is slower than uninterrupted acceleration at each of six corners.
const fn per_corner(
    course: &'static Course,
    method: &'static str,
    printed: &'static str,
    note: &'static str,
) -> Entry {
    let more = Quantity::PerCorner(planned(course, method), UNINTERRUPTED, 6);
    entry(more, printed, note)
}

const fn entry(quantity: Quantity, printed: &'static str, note: &'static str) -> Entry {
    Entry {
        quantity,
        printed,
        note,
    }
}

const fn gain(course: &'static Course, frequency: f64, note: &'static str) -> Entry {
    entry(Quantity::Gain(course, frequency), "", note)
}

const fn deviation(
    course: &'static Course,
    method: &'static str,
    printed: &'static str,
    note: &'static str,
) -> Entry {
    entry(Quantity::Deviation(planned(course, method)), printed, note)
}

const fn crossover(tolerance: f64, note: &'static str) -> Entry {
    entry(Quantity::Crossover(tolerance), "<20", note)
}

/// All of them, in the order of the text.
pub(super) static EXPERIMENTS: &[Experiment] = &[
    Experiment {
        name: "section-2.3.1",
        title: "a right angle between two moves of 10 mm",
        entries: &[
            speed(&RIGHT_100, INTERRUPTED, "32.9", SPEEDS),
            time(&RIGHT_100, INTERRUPTED, ".296", ""),
            speed(&RIGHT_100, UNINTERRUPTED, "45.9", SPEEDS),
            time(&RIGHT_100, UNINTERRUPTED, ".290", ""),
            time(&RIGHT_100, STOP, "", NOT_PRINTED),
            time(&RIGHT_100, KCS, "", NOT_PRINTED),
            speed(&RIGHT_10, INTERRUPTED, "7.07", SPEEDS),
            time(&RIGHT_10, INTERRUPTED, ".310", ""),
            speed(&RIGHT_10, UNINTERRUPTED, "14.1", SPEEDS),
            time(&RIGHT_10, UNINTERRUPTED, ".293", ""),
            time(
                &RIGHT_10,
                STOP,
                "",
                "not printed; faster than interrupted at 10 µm",
            ),
            time(&RIGHT_10, KCS, "", NOT_PRINTED),
        ],
    },
    Experiment {
        name: "fig-2.9",
        title: "the turn above which uninterrupted corners are faster, by search over two moves of 10 mm",
        entries: &[
            crossover(0.005, ""),
            crossover(0.01, "the claim holds up to about 10 µm"),
            crossover(0.02, ""),
            crossover(0.05, ""),
            crossover(
                0.1,
                "gentle turns must slow down so that acceleration runs out below the feedrate",
            ),
            crossover(0.2, ""),
        ],
    },
    Experiment {
        name: "table-2.1",
        title: "a path of six corners; geometry, limits and tolerance are our construction",
        entries: &[
            time(
                &SIX,
                UNINTERRUPTED,
                "2.3510",
                "a fit: the edges were chosen to give this time",
            ),
            time(&SIX, INTERRUPTED, "2.4644", MADE),
            time(
                &SIX,
                BEZIER,
                "2.5015",
                "taken for the spline corners; geometry not printed, so ours differs",
            ),
            per_corner(
                &SIX,
                INTERRUPTED,
                "18.9",
                "from the printed times; grows with turn and tolerance",
            ),
            per_corner(&SIX, BEZIER, "25.1", "from the printed times"),
            per_corner(
                &SIX,
                STOP,
                "",
                "not printed; here stopping is faster than interrupting",
            ),
        ],
    },
    Experiment {
        name: "fig-3.3",
        title: "cornering speeds; both turns and the tolerance are inferred from the speeds",
        entries: &[
            speed(&TURN_20, LOCAL, "48", ""),
            speed(
                &TURN_160,
                LOCAL,
                "23",
                "turns of 94 and 144 to 170 degrees all print 23",
            ),
        ],
    },
    Experiment {
        name: "fig-3.9",
        title: "two corners of 45 degrees, 0.5 mm apart",
        entries: &[
            speed(&TWO_9, LOCAL, "13.26", ""),
            time(&TWO_9, LOCAL, ".357", ""),
            time(
                &TWO_80,
                GLOBAL,
                ".317",
                "print rounds phases up to 0.1 ms (inferred)",
            ),
        ],
    },
    Experiment {
        name: "table-3.1",
        title: "a spiral of 36 moves of 1 mm; geometry is our construction, so the ratios count",
        entries: &[
            time(
                &SPIRAL,
                STOP,
                "3.4832",
                "print seems to limit the path, ours each axis: slanted moves are faster",
            ),
            ratio(&SPIRAL, LOCAL, ".835", MADE),
            ratio(&SPIRAL, GLOBAL, ".541", MADE),
            ratio(&SPIRAL, KCS, "", NOT_PRINTED),
        ],
    },
    Experiment {
        name: "table-3.2",
        title: "a heart; geometry is our construction, so the ratio counts",
        entries: &[
            ratio(&HEART, GLOBAL, ".551", MADE),
            ratio(&HEART, KCS, "", NOT_PRINTED),
        ],
    },
    Experiment {
        name: "fig-4.13",
        title: "two lines and a half circle; the directions are our construction",
        entries: &[
            entry(
                Quantity::CircleFeed(&ARC, 10.0, 0.1),
                "84.2",
                "radius of 10 mm inferred",
            ),
            time(&ARC, FIR_STOP, "1.137", ""),
            time(
                &ARC,
                FIR,
                "1.074",
                "arcs are planned with 99.8 % of the tolerance",
            ),
            deviation(&ARC, FIR, "<100", ""),
        ],
    },
    Experiment {
        name: "clover",
        title: "five arcs and five lines of section 4.5.1; geometry and filters are our construction",
        entries: &[
            deviation(&CLOVER, FIR, "<100", ""),
            time(&CLOVER, FIR, "", NOT_PRINTED),
            time(&CLOVER, FIR_STOP, "", NOT_PRINTED),
        ],
    },
    Experiment {
        name: "starfish",
        title: "modes of 7.4 and 9.2 Hz under 125 moves of section 4.5.2; geometry is our construction",
        entries: &[
            gain(
                &STARFISH_PRINTED,
                7.4,
                "printed time constants: 136.1 and 110.9 ms",
            ),
            gain(&STARFISH_PRINTED, 9.2, "printed time constants"),
            gain(
                &STARFISH,
                7.4,
                "the periods of the modes: 135.1 and 108.7 ms",
            ),
            gain(&STARFISH, 9.2, "the periods of the modes"),
            deviation(&STARFISH, FIR, "<30", ""),
            time(&STARFISH, FIR, "", NOT_PRINTED),
            time(&STARFISH, FIR_STOP, "", NOT_PRINTED),
        ],
    },
    Experiment {
        name: "table-5.1",
        title: "three tool poses; tolerances follow from the printed blend times",
        entries: &[
            pose_time(&TABLE_5_1, PoseMethod::PointToPoint, "", NOT_PRINTED),
            pose_time(&TABLE_5_1, PoseMethod::DwellControlled, "0.620", ""),
            pose_time(&TABLE_5_1, PoseMethod::VelocityControlled, "0.679", ""),
            Entry {
                quantity: Quantity::PoseOverlap(&TABLE_5_1, PoseMethod::DwellControlled),
                printed: "100.4",
                note: "print takes both turn rates for one; ours allows for their difference",
            },
            Entry {
                quantity: Quantity::PoseOverlap(&TABLE_5_1, PoseMethod::VelocityControlled),
                printed: "160",
                note: "the delay of the filters: nothing dwells",
            },
        ],
    },
    Experiment {
        name: "table-5.2",
        title: "the star path; feedrate and tolerances are not printed, 50 mm/s matches the text best",
        entries: &[
            pose_time(&STAR_50, PoseMethod::PointToPoint, "", NOT_PRINTED),
            pose_time(&STAR_50, PoseMethod::DwellControlled, "", NOT_PRINTED),
            pose_time(&STAR_50, PoseMethod::VelocityControlled, "", NOT_PRINTED),
            pose_time(&STAR_50, JOINT, "", NOT_PRINTED),
            Entry {
                quantity: Quantity::PoseGain(
                    &STAR_50,
                    PoseMethod::DwellControlled,
                    PoseMethod::PointToPoint,
                ),
                printed: "40",
                note: "printed 40 to 50 %; does not reproduce: no dwell at all gains 13 % here",
            },
            pose_time(&STAR_100, PoseMethod::PointToPoint, "", NOT_PRINTED),
            pose_time(&STAR_100, PoseMethod::DwellControlled, "", NOT_PRINTED),
            pose_time(&STAR_100, PoseMethod::VelocityControlled, "", NOT_PRINTED),
            pose_time(&STAR_100, JOINT, "", NOT_PRINTED),
        ],
    },
];

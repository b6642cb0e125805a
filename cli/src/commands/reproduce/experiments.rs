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
    /// The drives behind it; none where nothing is measured on a machine.
    pub(super) drives: Option<Drives>,
}

/// Drives behind a program.
#[derive(Clone, Copy, Debug)]
pub(super) enum Drives {
    /// The reference drive at the printed bandwidth, Hz, with the printed encoder step, mm.
    Reference { bandwidth: f64, encoder: f64 },
    /// The textbook drive at a bandwidth, Hz, with the two beams of section 4.5.2.
    Beams { bandwidth: f64 },
}

/// Drives of section 2.3.2.
const STAGE_35: Drives = Drives::Reference {
    bandwidth: 35.0,
    encoder: 7.125e-4,
};

/// Drives of section 3.5.
const STAGE_50: Drives = Drives::Reference {
    bandwidth: 50.0,
    encoder: 1e-4,
};

/// Drives of section 4.5.2.
const STAGE_BEAMS: Drives = Drives::Beams { bandwidth: 50.0 };

/// A figure or table.
#[derive(Debug)]
pub(super) struct Experiment {
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    pub(super) entries: &'static [Entry],
}

/// One number of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) quantity: Quantity,
    /// As it is printed; with < where it is a bound, empty where nothing is printed.
    pub(super) printed: &'static str,
    /// Why ours differs.
    pub(super) note: &'static str,
}

macro_rules! course {
    ($file:literal, $acceleration:literal, $jerk:literal) => {
        course!($file, $acceleration, $jerk, &[], None)
    };
    ($file:literal, $acceleration:literal, $jerk:literal, $filters:expr) => {
        course!($file, $acceleration, $jerk, $filters, None)
    };
    ($file:literal, $acceleration:literal, $jerk:literal, $filters:expr, $drives:expr) => {
        Course {
            name: $file,
            text: include_str!(concat!("../../../../examples/dissertation/", $file)),
            acceleration: $acceleration,
            jerk: $jerk,
            filters: $filters,
            drives: $drives,
        }
    };
}

static RIGHT_100: Course = course!("right_angle_100um.ngc", 2_500.0, 2e5);
static RIGHT_10: Course = course!("right_angle_10um.ngc", 2_500.0, 2e5);
static SIX: Course = course!("six_corners.ngc", 2_000.0, 1e5, &[], Some(STAGE_35));
static TURN_20: Course = course!("cornering_20deg.ngc", 3_000.0, 1e5);
static TURN_160: Course = course!("cornering_160deg.ngc", 3_000.0, 1e5);
static TWO_9: Course = course!("two_corners_9um.ngc", 3_000.0, 1e5);
static TWO_80: Course = course!("two_corners_80um.ngc", 3_000.0, 1e5);
static SPIRAL: Course = course!("spiral.ngc", 2_000.0, 5e4, &[], Some(STAGE_50));
static HEART: Course = course!("heart.ngc", 2_000.0, 5e4, &[], Some(STAGE_50));

static ARC: Course = course!("arc_after_lines.ngc", 10_000.0, 1e6, &[0.05, 0.03]);
static CLOVER: Course = course!("clover.ngc", 20_000.0, 2e6, &[0.03, 0.025]);
static STARFISH: Course = course!(
    "starfish.ngc",
    2_500.0,
    2e5,
    &[0.1351, 0.1087],
    Some(STAGE_BEAMS)
);
static STARFISH_PRINTED: Course = course!("starfish.ngc", 2_500.0, 2e5, &[0.1361, 0.1109]);

const INTERRUPTED: &str = "kcs-interrupted";
const UNINTERRUPTED: &str = "kcs-uninterrupted";
const LOCAL: &str = "kcs-local";
const GLOBAL: &str = "kcs-global";
const BEZIER: &str = "bezier";
const BEZIER_FREE: &str = "bezier-free";
const FIR_LOCAL: &str = "fir-local";
const STOP: &str = "exact-stop";
const KCS: &str = "kcs";
const FIR: &str = "fir";
const FIR_STOP: &str = "fir-p2p";

const SPEEDS: &str = "print rounds phases to whole periods of 0.1 ms; that it rounds up and truncates the speed is inferred";
const MADE: &str = "geometry not printed, so ours differs";
const FITTED: &str =
    "masses, gains and friction are not printed: one drive is fitted to all three tables";
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

const fn pose_servo(method: PoseMethod, note: &'static str) -> Entry {
    entry(Quantity::PoseServo(&STAR_50, method), "", note)
}

const fn pose_part(method: PoseMethod, note: &'static str) -> Entry {
    entry(Quantity::PosePart(&STAR_50, method), "", note)
}

const fn beam_left(
    course: &'static Course,
    method: &'static str,
    beam: usize,
    note: &'static str,
) -> Entry {
    entry(Quantity::BeamLeft(planned(course, method), beam), "", note)
}

const fn beam_acceleration(
    course: &'static Course,
    method: &'static str,
    beam: usize,
    note: &'static str,
) -> Entry {
    entry(
        Quantity::BeamAcceleration(planned(course, method), beam),
        "",
        note,
    )
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

/// Root mean square and largest distance from the planned motion behind the reference drive.
const fn contour(
    course: &'static Course,
    method: &'static str,
    printed: [&'static str; 2],
    note: &'static str,
) -> [Entry; 2] {
    let planned = planned(course, method);
    [
        entry(Quantity::ContourRms(planned), printed[0], note),
        entry(Quantity::ContourLargest(planned), printed[1], ""),
    ]
}

/// Entries of contour errors, two for each motion.
const fn contours<const N: usize, const M: usize>(pairs: [[Entry; 2]; N]) -> [Entry; M] {
    assert!(2 * N == M, "two entries each");
    let mut all = [pairs[0][0]; M];
    let mut index = 0;
    while index < M {
        all[index] = pairs[index / 2][index % 2];
        index += 1;
    }
    all
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
        title: "a path of six corners; limits, feedrate and tolerance as printed, the geometry is our construction",
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
                BEZIER_FREE,
                "2.5015",
                "no jerk limit at the corner, as print says; its speed there is ours",
            ),
            time(
                &SIX,
                BEZIER,
                "",
                "ours keeps the jerk limit in its corners; print says that its spline corners do not",
            ),
            per_corner(
                &SIX,
                INTERRUPTED,
                "18.9",
                "from the printed times; grows with turn and tolerance",
            ),
            per_corner(&SIX, BEZIER_FREE, "25.1", "from the printed times"),
            per_corner(&SIX, STOP, "", "not printed"),
        ],
    },
    Experiment {
        name: "table-2.1-contour",
        title: "contour errors of the six corners to the planned motion, behind the reference drive at the printed 35 Hz",
        entries: &contours::<4, 8>([
            contour(&SIX, UNINTERRUPTED, ["3.0637", "21.2576"], FITTED),
            contour(&SIX, INTERRUPTED, ["2.8062", "16.1245"], ""),
            contour(
                &SIX,
                BEZIER_FREE,
                ["3.1517", "22.5685"],
                "no jerk limit at the corner, as print says",
            ),
            contour(
                &SIX,
                BEZIER,
                ["", ""],
                "not printed: with a jerk limit the spline is no longer the worst",
            ),
        ]),
    },
    Experiment {
        name: "fig-3.3",
        title: "cornering speeds; limits and tolerance as printed, both turns are inferred from the speeds",
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
                "print rounds phases to whole periods of 0.1 ms; that it rounds up is inferred",
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
        name: "table-3.1-contour",
        title: "contour errors of the spiral to the planned motion, behind the reference drive at the printed 50 Hz",
        entries: &contours::<3, 6>([
            contour(&SPIRAL, GLOBAL, ["2.5867", "12.8730"], FITTED),
            contour(&SPIRAL, LOCAL, ["2.2025", "12.5822"], ""),
            contour(&SPIRAL, STOP, ["2.0071", "9.3338"], ""),
        ]),
    },
    Experiment {
        name: "table-3.2",
        title: "a heart; geometry is our construction, so the ratio counts",
        entries: &[
            ratio(&HEART, GLOBAL, ".551", MADE),
            ratio(
                &HEART,
                FIR_LOCAL,
                ".602",
                "the printed rule of one corner; filters not printed",
            ),
            ratio(&HEART, FIR, "", "not printed: bounded over a whole window"),
            ratio(&HEART, BEZIER, ".653", MADE),
            ratio(&HEART, KCS, "", NOT_PRINTED),
        ],
    },
    Experiment {
        name: "table-3.2-contour",
        title: "contour errors of the heart to the planned motion, behind the reference drive at the printed 50 Hz",
        entries: &contours::<4, 8>([
            contour(&HEART, GLOBAL, ["2.4001", "12.7891"], FITTED),
            contour(
                &HEART,
                FIR,
                ["2.1930", "8.7736"],
                "not in the fit; by fir, which bounds a whole window",
            ),
            contour(&HEART, BEZIER, ["2.1038", "9.0324"], FITTED),
            contour(&HEART, STOP, ["2.1446", "12.0504"], FITTED),
        ]),
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
        title: "five arcs and five lines of section 4.5.1; filters, feedrate and tolerance as printed, the geometry is our construction",
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
            time(
                &STARFISH,
                BEZIER,
                "",
                "print has FIR up to 20 % faster than its spline at like accelerations; not so here",
            ),
        ],
    },
    Experiment {
        name: "beams",
        title: "two flexible beams under the starfish, section 4.5.2, behind drives of 50 Hz; damping and friction are ours",
        entries: &[
            beam_left(&STARFISH, FIR, 0, "print: FIR does not excite the beams"),
            beam_left(&STARFISH, FIR, 1, ""),
            beam_left(&STARFISH, BEZIER, 0, "print: the spline excites both"),
            beam_left(&STARFISH, BEZIER, 1, ""),
            beam_left(&STARFISH, KCS, 0, "not in print"),
            beam_left(&STARFISH, KCS, 1, ""),
            beam_acceleration(
                &STARFISH,
                FIR,
                0,
                "a notch silences what is left, not what swings meanwhile",
            ),
            beam_acceleration(&STARFISH, FIR, 1, ""),
            beam_acceleration(&STARFISH, BEZIER, 0, ""),
            beam_acceleration(&STARFISH, BEZIER, 1, ""),
        ],
    },
    Experiment {
        name: "table-5.1",
        title: "three tool poses within the printed 800 µm and 0.02 rad",
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
            Entry {
                quantity: Quantity::PoseGain(
                    &TABLE_5_1,
                    PoseMethod::DwellControlled,
                    PoseMethod::VelocityControlled,
                ),
                printed: "8.7",
                note: "",
            },
            Entry {
                quantity: Quantity::PoseAcceleration(
                    &TABLE_5_1,
                    PoseMethod::DwellControlled,
                    PoseMethod::VelocityControlled,
                ),
                printed: "1.70",
                note: "print: 70 % larger",
            },
        ],
    },
    Experiment {
        name: "table-5.2",
        title: "the star path within the printed 200 µm and 1 mrad; the feedrate is not printed, 50 mm/s matches the text best",
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
            pose_servo(
                PoseMethod::PointToPoint,
                "friction is ours; the same drive for all",
            ),
            pose_servo(PoseMethod::VelocityControlled, "print: 10 % below ns-dcb"),
            pose_servo(PoseMethod::DwellControlled, ""),
            pose_part(
                PoseMethod::VelocityControlled,
                "to the program, rounding included",
            ),
            pose_part(PoseMethod::DwellControlled, ""),
            pose_part(
                PoseMethod::JointSpace { way_points: 9 },
                "9 way-points; print: up to 75 % worse",
            ),
            pose_time(&STAR_100, PoseMethod::PointToPoint, "", NOT_PRINTED),
            pose_time(&STAR_100, PoseMethod::DwellControlled, "", NOT_PRINTED),
            pose_time(&STAR_100, PoseMethod::VelocityControlled, "", NOT_PRINTED),
            pose_time(&STAR_100, JOINT, "", NOT_PRINTED),
        ],
    },
];

//! Programs made by others: those read wholly, and where the others are refused.
//!
//! Counts and extents of the feed moves were found by another reader of the language; those of the
//! program in polar coordinates, of the spline as chords, and of rapids to points of the machine are
//! ours, and agree with LinuxCNC move by move (`tests/linuxcnc/compare.py`).

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{FILE, settings};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use toolglide_kinematics::{Feedrate, Path, PoseFeed, Vector};
use toolglide_program::{Language, Poses, Program, Settings};

/// Where the programs lie; they are not part of this project.
const CORPUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/gcode/corpus");

/// Points of an arc that its extent is taken from.
const SAMPLES: u32 = 1000;

/// Extents are given with five digits, mm.
const EXTENT_ROUNDING: f64 = 0.005;

/// The other reader takes an arc at a few points, so that it may miss this much of it, mm.
const ARC_MISSED: f64 = 0.2;

/// A program that is read wholly: straight feed moves, arcs and rapids of some length, and the
/// least and largest X, Y and Z of the feed moves.
struct Whole {
    file: &'static str,
    counts: [usize; 3],
    extent: [[f64; 2]; 3],
}

const fn whole(file: &'static str, counts: [usize; 3], extent: [[f64; 2]; 3]) -> Whole {
    Whole {
        file,
        counts,
        extent,
    }
}

const WHOLE: [Whole; 25] = [
    whole(
        "camotics/flower_mold.nc",
        [16553, 0, 4],
        [[0.025, 57.125], [0.025, 57.099], [-9.235, 5.08]],
    ),
    whole(
        "camotics/tiger.nc",
        [65183, 0, 2241],
        [[-1.833, 92.43], [-1.833, 89.31], [-31.5, 1.0]],
    ),
    whole(
        "camotics/vcarve.ngc",
        [3616, 0, 118],
        [[-1.648, 12.271], [1.208, 4.834], [-0.411, 0.0]],
    ),
    whole(
        "linuxcnc/arcspiral.ngc",
        [1, 999, 3],
        [[-49.476, 47.88], [-50.274, 48.678], [-2.54, 25.4]],
    ),
    whole(
        "linuxcnc/tort.ngc",
        [56, 138, 74],
        [[-31.04, 48.113], [-29.615, 49.925], [-17.802, 40.661]],
    ),
    whole(
        "linuxcnc/tp_contour.ngc",
        [10000, 0, 0],
        [[-25.4, 25.4], [-25.4, 25.4], [0.0, 0.0]],
    ),
    whole(
        "linuxcnc/tp_random_lines.ngc",
        [4001, 0, 1],
        [[-0.1, 0.316], [-0.265, 0.132], [-0.167, 0.353]],
    ),
    whole(
        "linuxcnc/tp_tight-corner-tolerance.ngc",
        [222, 0, 0],
        [[-25.396, 25.4], [-25.379, 25.392], [0.0, 0.0]],
    ),
    whole(
        "linuxcnc/tp_trochoidal.ngc",
        [11340, 0, 11],
        [[-34.071, 59.071], [15.145, 108.57], [-1.0, 5.0]],
    ),
    whole(
        "pcb2gcode/D1MiniGSR_back.ngc",
        [21606, 0, 8],
        [[-25.16, -0.1], [0.1, 19.88], [-0.05, 5.0]],
    ),
    whole(
        "tinyg/FordEmblem.gcode",
        [12551, 452, 43],
        [[10.566, 218.55], [34.308, 143.0], [-1.27, 5.08]],
    ),
    whole(
        "ugs/stress_test.gcode",
        [11999, 0, 0],
        [[0.0, 1.0], [0.0, 1.0], [0.0, 0.29]],
    ),
    whole(
        "ugs/arc_rword_test.gcode",
        [28, 168, 4],
        [[9.258, 114.05], [9.606, 82.647], [-20.955, 6.35]],
    ),
    whole(
        "linuxcnc/cds.ngc",
        [191, 50, 24],
        [[0.0, 101.6], [-6.35, 101.6], [27.02, 53.34]],
    ),
    whole(
        "linuxcnc/spiral.ngc",
        [801, 0, 3],
        [[-48.26, 50.8], [-46.99, 49.53], [-2.54, 25.4]],
    ),
    whole(
        "linuxcnc/flowsnake.ngc",
        [3073, 0, 3],
        [[0.25, 3.75], [-0.01, 3.95], [0.0, 1.0]],
    ),
    whole(
        "linuxcnc/comp.ngc",
        [24, 12, 7],
        [[-19.05, 5.08], [-5.08, 44.45], [-5.08, 44.45]],
    ),
    whole(
        "linuxcnc/tp_LHchips4.ngc",
        [9610, 225, 71],
        [[-7.413, 75.516], [-6.959, 107.5], [-37.0, -0.085]],
    ),
    whole(
        "linuxcnc/tp_Cereal.ngc",
        [2102, 87, 55],
        [[-96.382, 97.789], [-36.282, -3.079], [-4.057, 20.0]],
    ),
    whole(
        "linuxcnc/tp_rgh.ngc",
        [186, 643, 3],
        [[-16.084, -6.001], [-27.45, -16.941], [-2.54, 1.27]],
    ),
    whole(
        "camotics/heart.ngc",
        [9, 144, 13],
        [[-32.253, 32.253], [-29.867, 29.867], [-6.0, 5.0]],
    ),
    whole(
        "cncjs/helical-thread-milling.gcode",
        [2, 10, 0],
        [[-3.078, 3.096], [-3.096, 3.051], [-16.594, 0.0]],
    ),
    whole(
        "pcb2gcode/D1MiniGSR_drill.ngc",
        [20, 0, 45],
        [[1.2, 24.06], [1.0, 18.78], [-2.5, 5.0]],
    ),
    whole(
        "gcode-preview/benchy.gcode",
        // The homing at its end goes straight to 0 of X and Y.
        [49687, 0, 1],
        [[0.0, 129.5], [0.0, 115.98], [0.0, 48.0]],
    ),
    whole(
        "linuxcnc/nurbs_G5.2_trident-xy.ngc",
        [249, 0, 4],
        [[3.541, 16.453], [0.0, 16.0], [0.0, 1.0]],
    ),
];

/// Files refused, with line, column and word of the first thing that is not read, and the reason.
const REFUSED: [(&str, u64, u32, &str, &str); 3] = [
    (
        "cncjs/Circle_Diamond_Square_Calibration.gcode",
        624,
        18,
        "I20",
        "centre off by 1.4 mm",
    ),
    (
        "linuxcnc/5ax_impeller-7bl-xyzac.ngc",
        4,
        1,
        "M428",
        "change of the kinematics",
    ),
    ("siemens-5ax/Achskreuz.mpf", 3, 5, "D", "another language"),
];

fn corpus() -> Option<PathBuf> {
    let path = PathBuf::from(CORPUS);
    let found = path.is_dir();
    if !found {
        eprintln!("skipped: there are no programs in {CORPUS}");
    }
    found.then_some(path)
}

fn open(path: &std::path::Path, settings: Settings) -> Program<BufReader<File>> {
    let mut reader = BufReader::with_capacity(1 << 16, File::open(path).unwrap());
    let language = Language::of(path, reader.fill_buf().unwrap());
    let language = match language {
        Language::Printer => language,
        _ => Language::Ngc,
    };
    Program::new(reader, FILE, settings).in_language(language)
}

#[test]
fn every_file_is_listed_as_read_or_refused() {
    let Some(corpus) = corpus() else { return };
    let mut found = Vec::new();
    for folder in std::fs::read_dir(&corpus).unwrap() {
        for file in std::fs::read_dir(folder.unwrap().path()).unwrap() {
            let path = file.unwrap().path();
            let name = path.strip_prefix(&corpus).unwrap().to_str().unwrap();
            found.push(name.replace('\\', "/"));
        }
    }
    let listed = WHOLE.iter().map(|whole| whole.file);
    let mut listed: Vec<&str> = listed
        .chain(REFUSED.iter().map(|refused| refused.0))
        .collect();
    found.sort_unstable();
    listed.sort_unstable();
    assert_eq!(found, listed, "files");
}

#[test]
fn whole_programs_have_the_moves_and_the_extent_that_another_reader_found() {
    let Some(corpus) = corpus() else { return };
    for expected in &WHOLE {
        let file = expected.file;
        let (mut lines, mut arcs, mut rapids) = (0, 0, 0);
        let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        let mut at = Vector::zeros();
        for step in open(&corpus.join(file), settings()) {
            let step = step.unwrap_or_else(|error| panic!("{file}: {error}"));
            let start = at;
            at = step.end(start);
            if step.length(start) <= 0.0 {
                continue;
            }
            let mut meet = |point: Vector<3>| {
                for (axis, [least, largest]) in extent.iter_mut().enumerate() {
                    *least = least.min(point[axis]);
                    *largest = largest.max(point[axis]);
                }
            };
            match step.path() {
                Path::Arc(arc) => {
                    arcs += 1;
                    (0..=SAMPLES).for_each(|n| meet(arc.point(f64::from(n) / f64::from(SAMPLES))));
                }
                _ if step.feedrate() == Feedrate::RAPID => rapids += 1,
                _ => {
                    lines += 1;
                    meet(start);
                    meet(at);
                }
            }
        }
        let counts = [lines, arcs, rapids];
        assert_eq!(counts, expected.counts, "{file}: lines, arcs and rapids");
        let missed = if arcs > 0 { ARC_MISSED } else { 0.0 };
        for ([least, largest], [other_least, other_largest]) in extent.iter().zip(&expected.extent)
        {
            for beyond in [other_least - least, largest - other_largest] {
                let close = (-EXTENT_ROUNDING..=EXTENT_ROUNDING + missed).contains(&beyond);
                assert!(
                    close,
                    "{file}: {extent:.3?}, expected {:?}",
                    expected.extent
                );
            }
        }
    }
}

#[test]
fn the_filament_of_a_print_is_what_its_slicer_says() {
    let Some(corpus) = corpus() else { return };
    let mut program = open(&corpus.join("gcode-preview/benchy.gcode"), settings());
    program
        .by_ref()
        .for_each(|step| assert!(step.is_ok(), "{step:?}"));
    let filament = program.filament().unwrap();
    // The slicer does not count that the last move draws 2 mm back.
    assert!((filament + 2.0 - 4913.4).abs() < 0.1, "{filament} mm");
}

#[test]
fn other_programs_are_refused_at_their_first_word_that_is_not_read() {
    let Some(corpus) = corpus() else { return };
    for (file, line, column, word, why) in REFUSED {
        let error = open(&corpus.join(file), settings())
            .find_map(Result::err)
            .unwrap_or_else(|| panic!("{file} is read, although: {why}"));
        let place = (error.line(), error.column(), error.word());
        assert_eq!(
            place,
            (line, column, word),
            "{file}, because of {why}: {error}"
        );
    }
}

#[test]
fn programs_of_rotary_axes_are_read_as_poses() {
    let Some(corpus) = corpus() else { return };
    for (file, moves, rapids) in [
        ("linuxcnc/5ax_impeller-7bl-xyzac.ngc", 4492, 186),
        // Arcs are chords.
        ("siemens-5ax/Achskreuz.mpf", 17945, 569),
    ] {
        let path = corpus.join(file);
        let reader = BufReader::new(File::open(&path).unwrap());
        let poses = Poses::new(reader, FILE, settings(), Language::of(&path, b""));
        let found: Vec<_> = poses
            .collect::<Result<_, _>>()
            .unwrap_or_else(|error| panic!("{file}: {error}"));
        let rapid = found.iter().filter(|step| step.feed() == PoseFeed::Rapid);
        assert_eq!((found.len(), rapid.count()), (moves, rapids), "{file}");
    }
}

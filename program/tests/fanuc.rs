//! The language of FANUC and Haas mills: words, motion and data. Macros are in `fanuc_macros`.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a failed unwrap is a failed test"
)]

mod common;
mod common_fanuc;

use common::{CLOSE, assert_close, dwell, is_rapid};
use common_fanuc::{assert_ends, ends, moves, noted, refusal, refuses};
use toolglide_kinematics::{Path, Vector};
use toolglide_program::Reason;

#[test]
fn the_head_of_a_post_is_read_with_what_it_modes() {
    let text = "BEGIN OF TAPE\n%\nO01001 (PART-1)\n(T1 D=10. - FLAT)\nN10 G90 G94 G17 G49 G40 G80\nN15 G21\n\
                N20 G28 G91 Z0.\nN25 G90\nN30 T1 M6\nN35 S5000 M3\nN40 G54\nN45 G05.1 Q1\nN50 G0 X10. Y5.\n\
                N55 G43 Z15. H1\nN60 G1 Z-1. F300.\n/N65 X99.\nN70 X20./Y99.\nN75 G5.1 Q0\nN80 M9\nN85 G53 G0 Z0.\n\
                N90 M30\n%\nafter the end X1\n";
    assert_ends(
        text,
        &[
            [10.0, 5.0, 0.0],
            [10.0, 5.0, 15.0],
            [10.0, 5.0, -1.0],
            [20.0, 5.0, -1.0],
            [20.0, 5.0, 0.0],
        ],
    );
    // The second mention of a mode is not said again; without a tool table a tool is a point.
    assert_eq!(noted(text).len(), 2, "{:?}", noted(text));
}

#[test]
fn modes_that_move_no_axis_are_noted_once_each() {
    let text = "G187 P3 E0.02\nG187 P1\nG5 P10000\nG5 P0\nG8 P1\nG103 P1\nG64\nG62\nG22 X1 Y1 Z1 I0 J0 K0\n\
                M88\nM88\nM31 P5\nG255\nG13.1\nG92 S3000\nM30\n";
    let found = noted(text);
    let words = [
        "G187", "G5", "G8", "G103", "G62", "G22", "M88", "M31", "G255", "G13.1", "G92 S",
    ];
    assert_eq!(found.len(), words.len(), "{found:?}");
    for (word, said) in words.iter().zip(&found) {
        assert!(said.starts_with(&format!("{word} is noted")), "{said}");
    }
    assert!(moves(text).is_empty(), "no motion");
}

#[test]
fn what_cannot_be_known_or_done_is_refused_by_name() {
    for (text, word, says) in [
        ("G31 Z-5 F50", "G31", "signal"),
        ("G38.2 Z-5 F50", "G38.2", "probing"),
        ("G37 Z1 H1", "G37", "probing"),
        ("G8", "G8", "lathe"),
        ("G95", "G95", "spindle"),
        ("G96 S100", "G96", "surface speed"),
        ("G70 P1 Q2", "G70", "lathe"),
        ("G150 P1", "G150", "pockets"),
        ("G68.2 X0 Y0 Z0 I0 J0 K0", "G68.2", "tilted"),
        ("G5 X1 Y1 I1 J1", "G5", "splines"),
        ("G5 P10003", "G5", "data of the control"),
        ("G107 C1", "G107", "cylinder"),
        ("G12.1", "G12.1", "polar"),
        ("G33 Z1 F1", "G33", "spindle"),
        ("G84.2 Z1", "G84.2", "spindle"),
        ("G254", "G254", "dynamic"),
        ("G10 L50", "L50", "data"),
        ("G1 X1 ,A45. F100", ",A45.", "drawings"),
        ("M96 P10", "M96", "signal"),
        ("X2.35e-12", "X2.35e-12", "exponents"),
        ("G1 X1 E5 F1", "E5", "nothing"),
        ("M99", "M99", "without end"),
        ("G333", "G333", "not known"),
    ] {
        let (line, _, found, reason) = refusal(text);
        let said = reason.to_string();
        assert_eq!((line, found.as_str()), (1, word), "{text}: {said}");
        assert!(said.contains(says), "{text}: {said}");
    }
}

#[test]
fn dwells_are_in_ms_but_in_s_with_a_point_or_behind_x() {
    for (text, expected) in [
        ("G4 P500", 0.5),
        ("G04 P1.5", 1.5),
        ("G4 X2.", 2.0),
        ("G4 U0.25", 0.25),
        ("#1=250\nG4 P#1", 0.25),
        ("G4", 0.0),
    ] {
        let durations: Vec<f64> = moves(text).iter().filter_map(dwell).collect();
        assert_close(&durations, &[expected], text);
    }
    let cycle = moves("G82 X1 Y1 Z-1 R1 P500 F100");
    let durations: Vec<f64> = cycle.iter().filter_map(dwell).collect();
    assert_close(&durations, &[0.5], "G82");
    assert!(noted("G4 P500").is_empty(), "half a second");
    assert!(noted("G4 X61.")[0].contains("61 s"), "more than a minute");
}

#[test]
fn the_motion_before_a_cycle_goes_on_behind_it() {
    let text = "G0 X1. Z5.\nG81 X2. Z-1. R1. F100\nG80\nX3.\n";
    let list = moves(text);
    assert!(is_rapid(list.last().unwrap()), "G0");
    let text = "G1 X1. Z5. F100\nG81 X2. Z-1. R1.\nG80 X3.\n";
    let list = moves(text);
    assert!(!is_rapid(list.last().unwrap()), "G1");
    assert_close(&ends(text).last().unwrap()[..1], &[3.0], "moves");
}

#[test]
fn cycles_return_to_their_beginning_and_keep_their_words() {
    // G98 holds when the control is turned on; K repeats; another cycle keeps R and Z.
    let text = "G0 Z10.\nG81 X1. Y0 Z-1. R2. F100\nG82 X2. P100\nG91 X1. K2\n";
    let found = ends(text);
    let bottoms = found.iter().filter(|end| (end[2] + 1.0).abs() < CLOSE);
    let mut places: Vec<f64> = bottoms.map(|end| end[0]).collect();
    // A dwell ends where it begins.
    places.dedup();
    assert_close(&places, &[1.0, 2.0, 3.0, 4.0], "holes");
    assert!(
        (found.last().unwrap()[2] - 10.0).abs() < CLOSE,
        "initial level"
    );
}

#[test]
fn boring_cycles_leave_beside_the_wall() {
    assert_ends(
        "G0 Z10.\nG76 X0 Y0 Z-5. R1. Q0.5 F100\n",
        &[
            [0.0, 0.0, 10.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -5.0],
            [0.5, 0.0, -5.0],
            [0.5, 0.0, 10.0],
            [0.0, 0.0, 10.0],
        ],
    );
    assert_ends(
        "G0 Z10.\nG87 X0 Y0 Z-5. R-20. Q0.5 F100\n",
        &[
            [0.0, 0.0, 10.0],
            [0.5, 0.0, 10.0],
            [0.5, 0.0, -20.0],
            [0.0, 0.0, -20.0],
            [0.0, 0.0, -5.0],
            [0.5, 0.0, -5.0],
            [0.5, 0.0, 10.0],
            [0.0, 0.0, 10.0],
        ],
    );
}

#[test]
fn exact_stop_holds_for_its_block_alone() {
    let list = moves("G1 X1 F100\nG9 X2\nX3\nG61 X4\nG64 X5\n");
    let stops: Vec<bool> = list.iter().map(toolglide_kinematics::Move::stops).collect();
    assert_eq!(stops, [false, true, false, true, false], "stops");
}

#[test]
fn work_offsets_are_set_added_and_selected() {
    let text = "G90 G10 L2 P1 X10. Y20.\nG10 L2 P0 Z1.\nG91 G10 L2 P1 X1.\nG90 G54 G0 X0 Y0 Z0\n\
                G10 L20 P3 X100.\nG54.1 P3 X0 Y0\nG154 P3 X1.\nG110 X2.\nG54 P3 X3.\n#5221=5.\nG54 X0\n#5201=7.\nX0\n";
    assert_ends(
        text,
        &[
            [11.0, 20.0, 1.0],
            [100.0, 0.0, 1.0],
            [101.0, 0.0, 1.0],
            [2.0, 0.0, 1.0],
            [103.0, 0.0, 1.0],
            [5.0, 0.0, 1.0],
            [12.0, 0.0, 1.0],
        ],
    );
    let inch = "G20\nG10 L2 P1 X1.\n#101=#5221\nG21\nG54 G0 X0\nY#101\n";
    assert_ends(inch, &[[25.4, 0.0, 0.0], [25.4, 1.0, 0.0]]);
}

#[test]
fn tool_offsets_are_written_and_stay_until_another() {
    let text = "G10 L10 P1 R100.\nG10 L11 P1 R-0.5\nG10 L10 P2 R50.\nG43 G0 Z0 H1\nZ1. H2\nG49 Z0\nG44 H2 Z0\n";
    assert_ends(
        text,
        &[
            [0.0, 0.0, 99.5],
            [0.0, 0.0, 51.0],
            [0.0, 0.0, 0.0],
            [0.0, 0.0, -50.0],
        ],
    );
    // The radius is D of the block, or the last one.
    let text = "G10 L12 P5 R2.\nG41 D5 G1 X10. Y0 F100\nY20.\nX30.\nG40 X40.\n";
    let found = ends(text);
    assert!((found[0][0] - 8.0).abs() < CLOSE, "{found:?}");
}

#[test]
fn scaling_mirror_and_rotation_map_points_and_arcs() {
    assert_ends(
        "G0 X10. Y0\nG51 X0 Y0 P2.\nX10. Y5.\nG50\nX10. Y5.\n",
        &[[10.0, 0.0, 0.0], [20.0, 10.0, 0.0], [10.0, 5.0, 0.0]],
    );
    assert_ends("G51 X0 Y0 P2000\nG0 X1.\n", &[[2.0, 0.0, 0.0]]);
    assert_ends(
        "G51.1 X5.\nG0 X7. Y1.\nG50.1 X0\nX7.\nG101 X0\nX7.\nG100 X0\nX7.\n",
        &[
            [3.0, 1.0, 0.0],
            [7.0, 1.0, 0.0],
            [-7.0, 1.0, 0.0],
            [7.0, 1.0, 0.0],
        ],
    );
    assert_ends(
        "G68 X10. Y0 R90.\nG0 X20. Y0\nG91 X5.\nG90 G69\nX0 Y0\n",
        &[[10.0, 10.0, 0.0], [10.0, 15.0, 0.0], [0.0, 0.0, 0.0]],
    );
    // An arc stays an arc, and goes the other way round behind a mirror.
    for (text, sign, radius) in [
        (
            "G68 X0 Y0 R30.\nG0 X10. Y0\nG3 X0 Y10. I-10. J0 F100",
            1.0,
            10.0,
        ),
        ("G51.1 X0\nG0 X10. Y0\nG3 X0 Y10. R10. F100", -1.0, 10.0),
        ("G51 X0 Y0 P3.\nG0 X10. Y0\nG3 X0 Y10. R10. F100", 1.0, 30.0),
    ] {
        let list = moves(text);
        let Path::Arc(arc) = list.last().unwrap().path() else {
            panic!("{text}: no arc")
        };
        assert!(
            arc.sweep() * sign > 1.5 && arc.sweep() * sign < 1.6,
            "{text}: {}",
            arc.sweep()
        );
        assert!(arc.center().norm() < CLOSE, "{text}: centre");
        assert!((arc.radii().0 - radius).abs() < CLOSE, "{text}: radius");
    }
    refuses(
        "G51 X0 Y0 I2. J1.\nG0 X10. Y0\nG3 X0 Y10. R10. F100",
        3,
        "unequally",
    );
}

#[test]
fn rotations_in_a_repeated_subprogram_add_up() {
    let text = "G0 X0 Y0\nM98 P100 L3\nM30\nO100\nG68 X0 Y0 G91 R90.\nG90 G0 X10. Y0\nM99\n";
    assert_ends(
        text,
        &[
            [0.0, 0.0, 0.0],
            [0.0, 10.0, 0.0],
            [-10.0, 0.0, 0.0],
            [0.0, -10.0, 0.0],
        ],
    );
}

#[test]
fn local_coordinates_and_shifts_are_two_things() {
    assert_ends(
        "G52 X10.\nG0 X0\nG92 X5.\nX0\nG52 X0\nX0\n",
        &[[10.0, 0.0, 0.0], [5.0, 0.0, 0.0], [-5.0, 0.0, 0.0]],
    );
}

#[test]
fn polar_coordinates_have_radius_and_angle() {
    let text =
        "G0 Z5.\nG16\nG81 X10. Y30. Z-1. R1. F100\nG91 Y60.\nY90. L1\nG90 G15 G80\nG0 X1. Y2.\n";
    let found = ends(text);
    let bottoms: Vec<[f64; 3]> = found
        .iter()
        .copied()
        .filter(|end| (end[2] + 1.0).abs() < CLOSE)
        .collect();
    let angles = [30.0_f64, 90.0, 180.0].map(f64::to_radians);
    assert_eq!(bottoms.len(), 3, "{found:?}");
    for (hole, angle) in bottoms.iter().zip(angles) {
        let off = (hole[0] - 10.0 * angle.cos()).hypot(hole[1] - 10.0 * angle.sin());
        assert!(off < CLOSE, "{hole:?}");
    }
    assert_close(&found.last().unwrap()[..2], &[1.0, 2.0], "straight again");
}

#[test]
fn axes_go_to_their_reference_points_by_way_of_a_point() {
    let text = "G0 X10. Y10. Z10.\nG91 G28 Z5.\nG28 X0 Y0\nG90 G29 X1. Y2.\nG30 P2 Z20.\n";
    let settings = common::settings();
    let program = toolglide_program::Program::new(text.as_bytes(), "a.nc", settings)
        .in_language(toolglide_program::Language::Fanuc)
        .with_reference_points(&[
            [300.0, 200.0, 100.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 50.0, 0.0, 0.0, 0.0],
        ]);
    let mut at = Vector::zeros();
    let mut found = Vec::new();
    for step in program {
        at = step.unwrap().end(at);
        found.extend(<[f64; 3]>::from(at));
    }
    let expected = [
        [10.0, 10.0, 10.0],
        [10.0, 10.0, 15.0],
        [10.0, 10.0, 100.0],
        [300.0, 200.0, 100.0],
        [10.0, 10.0, 100.0],
        [1.0, 2.0, 100.0],
        [1.0, 2.0, 20.0],
        [1.0, 2.0, 50.0],
    ];
    assert_close(&found, &expected.concat(), "way");
    let missing = toolglide_program::Program::new("G30 P3 Z0\n".as_bytes(), "a.nc", settings)
        .in_language(toolglide_program::Language::Fanuc)
        .with_reference_points(&[[1.0; 6]]);
    let refused = missing.filter_map(Result::err).next().unwrap();
    assert!(
        refused.to_string().contains("without this reference point"),
        "{refused}"
    );
    refuses("G68 X0 Y0 R10.\nG28 Z0", 2, "turned");
}

#[test]
fn machine_coordinates_are_reached_at_rapid() {
    let text = "G10 L2 P1 X10. Z-100.\nG54 G1 X0 Z0 F100\nG53 Z0\nX5.\n";
    let list = moves(text);
    assert!(is_rapid(&list[1]) && !is_rapid(&list[2]), "rapid once");
    assert_ends(
        text,
        &[[10.0, 0.0, -100.0], [10.0, 0.0, 0.0], [15.0, 0.0, 0.0]],
    );
}

#[test]
fn circular_pockets_go_round_and_come_back() {
    let text = "G0 X10. Y0\nG13 I3. K6. Q1.5 Z-2. F400 D0\n";
    let list = moves(text);
    let arcs: Vec<_> = list
        .iter()
        .filter_map(|step| match step.path() {
            Path::Arc(arc) => Some(*arc),
            _ => None,
        })
        .collect();
    // In, three circles, two ways between them, and out.
    assert_eq!(arcs.len(), 7, "arcs");
    assert!(
        arcs.iter().all(|arc| arc.sweep() > 0.0),
        "counter-clockwise"
    );
    let whole: Vec<f64> = arcs
        .iter()
        .filter(|arc| arc.sweep() > 6.0)
        .map(|arc| arc.radii().0)
        .collect();
    assert_close(&whole, &[3.0, 4.5, 6.0], "radii");
    for pair in arcs.windows(2) {
        let turn = pair[0].tangent(1.0) - pair[1].tangent(0.0);
        assert!(turn.norm() < 1e-9, "tangents meet: {turn}");
    }
    assert_close(ends(text).last().unwrap(), &[10.0, 0.0, -2.0], "centre");
    let levels = ends("G0 Z1.\nG91 G12 I3. Z-1. L3 F400\n");
    assert!(
        (levels.last().unwrap()[2] + 2.0).abs() < CLOSE,
        "{levels:?}"
    );
    refuses("G10 L12 P1 R5.\nG12 I4. D1 F100", 2, "fit");
    refuses("G12 I4. L2 Z-1. F100", 1, "G91");
    refuses("G12 F100", 1, "I word");
}

#[test]
fn corners_are_rounded_and_cut() {
    assert_ends(
        "G1 X10. F100 ,R2.\nY10. ,C1.\nX0\n",
        &[
            [8.0, 0.0, 0.0],
            [10.0, 2.0, 0.0],
            [10.0, 9.0, 0.0],
            [9.0, 10.0, 0.0],
            [0.0, 10.0, 0.0],
        ],
    );
    // Between a line and an arc the centre is as far from the line as from the arc.
    let text = "G1 X10. F100,R2.\nG2 X20. Y10. I10. J0\n";
    let list = moves(text);
    let Path::Arc(round) = list[1].path() else {
        panic!("no arc")
    };
    let center = round.center();
    assert!((center[1].abs() - 2.0).abs() < CLOSE, "line: {center}");
    let from_arc = (center - Vector::<3>::new(20.0, 0.0, 0.0)).norm();
    assert!((from_arc - 12.0).abs() < CLOSE, "arc: {center}");
    let Path::Arc(rest) = list[2].path() else {
        panic!("no arc")
    };
    assert!(
        (rest.tangent(0.0) - round.tangent(1.0)).norm() < 1e-9,
        "smooth"
    );
    assert_close(ends(text).last().unwrap(), &[20.0, 10.0, 0.0], "end");
    // Moves that go straight on have no corner.
    assert_ends(
        "G1 X1. F100,R1.\nX2.\n",
        &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
    );
    for (text, line) in [
        ("G1 X10. F100,R20.\nY10.\n", 2),
        ("G1 X10. F100,C2.\nX0\n", 2),
        ("G1 X10. F100,R2.\nZ10.\n", 2),
        ("G1 X10. F100,R2.\nG0 Y10.\n", 2),
        ("G1 X10. F100,R2.\nG4 P100\n", 2),
        ("G1 X10. F100,R2.\nG28 Z0\n", 2),
        ("G0 X10.,R2.\nY10.\n", 1),
        ("G1 X10. F100,R2.\nM30\n", 2),
    ] {
        refuses(text, line, "corner");
    }
}

#[test]
fn a_corner_is_broken_before_the_tool_is_moved_aside() {
    let text = "G10 L12 P1 R1.\nG42 D1 G1 X5. Y0 F100\nX10.,R3.\nY10.\nG40 X20.\n";
    let list = moves(text);
    let arc = list.iter().find_map(|step| match step.path() {
        Path::Arc(arc) => Some(*arc),
        _ => None,
    });
    let arc = arc.expect("an arc");
    assert!(
        (arc.radii().0 - 4.0).abs() < CLOSE,
        "outside the corner: {:?}",
        arc.radii()
    );
    assert!(
        (arc.center() - Vector::<3>::new(7.0, 3.0, 0.0)).norm() < CLOSE,
        "centre"
    );
}

#[test]
fn text_before_the_first_percent_is_no_program() {
    assert_ends(
        "HEADER 12\nmore text!\n%\nO1\nG0 X1.\n%\nG0 X9.\n",
        &[[1.0, 0.0, 0.0]],
    );
    // Blocks before it are.
    assert_ends("G0 X1.\nX2.\n%\n", &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    assert_ends(
        "%O7\nG0 X1.;\nX2. ; a remark\nM30\n",
        &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
    );
    refuses("G0 X1.; G1 Y2.", 1, "behind the end of a block");
}

#[test]
fn the_next_program_of_a_file_ends_the_first() {
    let text = "O1\nG0 X1.\nO2\nG0 X2.\n";
    assert_ends(text, &[[1.0, 0.0, 0.0]]);
    assert!(
        noted(text)[0].contains("O2 begins here"),
        "{:?}",
        noted(text)
    );
}

#[test]
fn rotary_axes_go_home_with_a_move_of_their_own() {
    let text = "G0 X1. A30.\nG91 G28 A0\nG90 X2.\n";
    let settings = common::settings();
    let poses = toolglide_program::Poses::new(
        text.as_bytes(),
        "a.nc",
        settings,
        toolglide_program::Language::Fanuc,
    )
    .with_reference_points(&[[0.0, 0.0, 0.0, 90.0, 0.0, 0.0]]);
    let turned: Vec<f64> = poses
        .map(|step| match step.unwrap().end() {
            toolglide_kinematics::PoseEnd::Axes { rotary, .. } => rotary[0].to_degrees(),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_close(&turned, &[30.0, 90.0, 90.0], "A");
}

#[test]
fn a_plain_program_is_the_same_for_linuxcnc() {
    let text = "G21 G90 G17\nG0 X5. Y5. Z2.\nG1 Z-1. F100.\nG2 X15. Y5. I5. J0\nG3 X20. R4.\nG1 Y10.\nG61 X0\nG64 Y0\n\
                G20 X1. F10.\nG19 G3 Y1. Z0 R1.\nG55 G0 X0\nG4 P0\nM30\n";
    assert_eq!(moves(text), common::read(text));
}

#[test]
fn rotary_words_need_their_axis() {
    let (line, _, word, reason) = refusal("G1 X10. Y5. A45. F500");
    assert_eq!((line, word.as_str()), (1, "A45."), "place");
    assert!(
        matches!(reason, Reason::NoSuchAxis { letter: 'A', .. }),
        "{reason}"
    );
    refuses("G28 G91 A5", 1, "no axis A");
    assert_ends(
        "G0 X1. A0.\nG28 G91 X0 A0.\n",
        &[[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    );
}

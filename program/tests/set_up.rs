//! Offsets, tools, stored points, polar coordinates, cycles, splines and cutter compensation.
//!
//! Where a number is not plain, LinuxCNC gives the same.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{CLOSE, FILE, assert_close, assert_ends, dwell, read, refusal, settings};
use toolglide_kinematics::{Move, Path, Vector};
use toolglide_program::{MachiningError, Notice, Program, Reason, Tool, ToolTable};

fn table() -> ToolTable {
    ToolTable::parse("T1 P1 D2 Z5\nT2 P2 D4 Z7 X1\n").unwrap()
}

fn with_tools(text: &str) -> Vec<Move<3>> {
    Program::new(text.as_bytes(), FILE, settings())
        .with_tools(table())
        .map(|step| step.unwrap_or_else(|error| panic!("{text:?}: {error}")))
        .collect()
}

fn assert_tool_ends(text: &str, expected: &[[f64; 3]]) {
    let mut at = Vector::zeros();
    let mut found = Vec::new();
    for step in with_tools(text) {
        at = step.end(at);
        found.extend(at.iter().copied());
    }
    assert_close(&found, &expected.concat(), text);
}

fn refused(text: &str) -> (u64, u32, Reason) {
    let error = Program::new(text.as_bytes(), FILE, settings())
        .with_tools(table())
        .find_map(Result::err)
        .unwrap_or_else(|| panic!("{text:?} is read"));
    (error.line(), error.column(), error.reason().clone())
}

#[test]
fn coordinate_systems_move_and_turn_the_program() {
    assert_ends(
        "G10 L2 P1 X10 Y5\nG0 X1 Y0\nG53 G0 X1",
        &[[11.0, 5.0, 0.0], [1.0, 5.0, 0.0]],
    );
    assert_ends(
        "G10 L2 P2 X10\nG0 X1\nG55 X1\nG54 X1",
        &[[1.0, 0.0, 0.0], [11.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    );
    assert_ends("G10 L2 P9 Z3\nG59.3 G0 Z1", &[[0.0, 0.0, 4.0]]);
    assert_ends(
        "G10 L2 P0 R90\nG0 X2\nG91 Y1",
        &[[0.0, 2.0, 0.0], [-1.0, 2.0, 0.0]],
    );
    assert_ends(
        "G0 X7\nG10 L20 P1 X2\nX3",
        &[[7.0, 0.0, 0.0], [8.0, 0.0, 0.0]],
    );
    let later = "#5221=4\nG0 X1\nG54 X2\nG55 X3\nG54 X1";
    let xs = [1.0, 2.0, 3.0, 5.0];
    assert_ends(later, &xs.map(|x| [x, 0.0, 0.0]));
}

#[test]
fn a_shift_names_the_present_point_and_can_rest() {
    let text = "G0 X5\nG92 X1\nX2\nG92.2\nX2\nG92.3\nX2\nG92.1\nX2\nG92.3\nX3";
    let xs = [5.0, 6.0, 2.0, 6.0, 2.0, 3.0];
    assert_ends(text, &xs.map(|x| [x, 0.0, 0.0]));
}

#[test]
fn arcs_follow_offsets_and_rotation() {
    let moves = read("G10 L2 P1 X10 R90\nG0 X5 Y0\nG3 X-5 I-5 F60");
    let Path::Arc(arc) = moves[1].path() else {
        panic!("an arc")
    };
    assert!(
        (arc.center() - Vector::<3>::new(10.0, 0.0, 0.0)).norm() < CLOSE,
        "centre"
    );
    assert!(
        (arc.end() - Vector::<3>::new(10.0, -5.0, 0.0)).norm() < CLOSE,
        "end"
    );
}

#[test]
fn an_upright_arc_in_a_turned_system_becomes_chords_in_its_turned_plane() {
    let found = common::ends("G10 L2 P1 R30\nG0 X5\nG18 G2 X-5 I-5 K0 F60\n");
    assert!(found.len() > 20, "{} moves", found.len());
    let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
    for [x, y, z] in found {
        assert!((x * sine - y * cosine).abs() < CLOSE, "in the plane");
        assert!(
            ((x * x + y * y + z * z).sqrt() - 5.0).abs() < CLOSE,
            "on the circle"
        );
    }
}

#[test]
fn origins_and_tools_measured_in_a_turned_system_give_the_coordinates_that_were_asked_for() {
    let text =
        "G10 L2 P1 R30 X3 Y1\nG0 X5 Y6\nG10 L20 P1 X1\nG0 X1 Y6\nX7 Y7\nG10 L20 P1 Y-2\nX7 Y-2";
    let found = common::ends(text);
    assert_close(&found[0], &found[1], "X alone");
    assert_close(&found[2], &found[3], "Y alone");
    let tool = "G10 L2 P1 R45\nG0 X1 Y1\nG10 L10 P1 X5\nT1 M6 G43\nX5 Y1";
    let found = common::ends(tool);
    assert_close(&found[0], &found[1], "tool");
    let (.., reason) = refused("G10 L20 P1 R30 X1");
    assert_eq!(reason, Reason::Unused { letter: 'R' }, "no rotation");
}

#[test]
fn a_tool_measured_on_the_fixture_knows_no_other_offsets() {
    let text = "G10 L2 P9 Z7\nG0 Z20\nG92 Z1\nG10 L11 P1 Z5\nG92.1\nT1 M6 G43 G59.3\nG10 L0\nZ5";
    assert_ends(text, &[[0.0, 0.0, 20.0], [0.0, 0.0, 20.0]]);
}

#[test]
fn stored_points_are_reached_along_the_axes_of_the_program() {
    let text = "G10 L2 P1 X10 R90\nG0 X5 Y1\nG28.1\nX0\nG28 X2";
    assert_ends(
        text,
        &[
            [9.0, 5.0, 0.0],
            [9.0, 0.0, 0.0],
            [9.0, 2.0, 0.0],
            [9.0, 5.0, 0.0],
        ],
    );
}

#[test]
fn stored_points_are_reached_by_way_of_another() {
    let text = "G0 X5 Z2\nG28.1\nX9 Z0\nG28 Z4\nG28\n";
    assert_ends(
        text,
        &[
            [5.0, 0.0, 2.0],
            [9.0, 0.0, 0.0],
            [9.0, 0.0, 4.0],
            [9.0, 0.0, 2.0],
            [5.0, 0.0, 2.0],
        ],
    );
    assert_ends("#5181=3\nG30", &[[3.0, 0.0, 0.0]]);
}

#[test]
fn tools_lengthen_and_the_table_can_be_set() {
    assert_tool_ends(
        "G43 H1\nG0 Z1\nG49 Z1\nT2 M6 G43 Z0",
        &[[0.0, 0.0, 6.0], [0.0, 0.0, 1.0], [0.0, 0.0, 7.0]],
    );
    assert_tool_ends(
        "G43.1 Z2.5\nG0 Z1\nG43.2 H1\nZ1",
        &[[0.0, 0.0, 3.5], [0.0, 0.0, 8.5]],
    );
    assert_tool_ends("G10 L1 P3 Z9\nG43 H3 G0 Z0", &[[0.0, 0.0, 9.0]]);
    let (line, column, reason) = refused("G43 H5");
    let expected = Reason::Machining(MachiningError::NoSuchTool { tool: 5 });
    assert_eq!((line, column, reason), (1, 5, expected), "no such tool");
    let mut program = Program::new(&b"G43 H5 G0 Z1"[..], FILE, settings());
    assert!(program.next().unwrap().is_ok(), "no table");
    let notice = program.warnings()[0].notice();
    assert_eq!(notice, &Notice::NoToolTable { tool: 5 }, "but a warning");
}

#[test]
fn polar_coordinates_are_distance_and_angle() {
    assert_ends(
        "G0 @10 ^90\n@5\n^180",
        &[[0.0, 10.0, 0.0], [0.0, 5.0, 0.0], [-5.0, 0.0, 0.0]],
    );
    assert_ends("G0 X10\nG91 @-5 ^90", &[[10.0, 0.0, 0.0], [0.0, 5.0, 0.0]]);
    let (.., reason) = refused("G0 ^5");
    assert!(
        matches!(reason, Reason::Machining(MachiningError::Polar { .. })),
        "{reason}"
    );
}

#[test]
fn drilling_goes_over_down_and_up() {
    let text = "G0 Z10\nG99 G81 X1 Y2 Z-3 R2 F60\nX4\nG80\n";
    let z = [10.0, 10.0, 2.0, -3.0, 2.0, 2.0, -3.0, 2.0];
    let x = [0.0, 1.0, 1.0, 1.0, 1.0, 4.0, 4.0, 4.0];
    let expected: Vec<[f64; 3]> = (0..8)
        .map(|n| [x[n], if n > 0 { 2.0 } else { 0.0 }, z[n]])
        .collect();
    assert_ends(text, &expected);
    assert!(
        read(text)[1..].iter().all(Move::stops),
        "a hole has a bottom"
    );
    let up = read("G0 Z10\nG98 G81 X1 Z-3 R2 F60");
    assert_close(
        &[up.last().unwrap().end(Vector::zeros())[2]],
        &[10.0],
        "G98",
    );
}

#[test]
fn repeated_incremental_holes_step_on() {
    let moves = read("G0 Z10\nG91 G81 X2 Z-3 R-5 L2 F60");
    let mut at = Vector::zeros();
    let ends: Vec<[f64; 3]> = moves
        .iter()
        .map(|step| {
            at = step.end(at);
            at.into()
        })
        .collect();
    let expected = [
        [2.0, 0.0, 5.0],
        [2.0, 0.0, 2.0],
        [2.0, 0.0, 5.0],
        [4.0, 0.0, 5.0],
        [4.0, 0.0, 2.0],
    ];
    assert_close(&ends[2..7].concat(), &expected.concat(), "holes");
}

#[test]
fn pecks_withdraw_or_break_the_chip() {
    let z = |text: &str| -> Vec<f64> {
        read(text)
            .iter()
            .map(|step| step.end(Vector::zeros())[2])
            .collect()
    };
    let begin = "G0 Z1\nF60 ";
    let deep = z(&format!("{begin}G83 X0 Z-2 R1 Q1"));
    assert_close(
        &deep[1..],
        &[0.0, 1.0, 0.254, -1.0, 1.0, -0.746, -2.0, 1.0],
        "withdrawn",
    );
    let chip = z(&format!("{begin}G73 X0 Z-2 R1 Q1"));
    assert_close(&chip[1..], &[0.0, 0.254, -1.0, -0.746, -2.0, 1.0], "broken");
}

#[test]
fn boring_feeds_out_and_dwells() {
    let moves = read("G0 Z1\nG82 X0 Z-2 R1 P.5 F60\nG85 X1 Z-2 R1\nG89 X2 Z-2 R1 P2");
    let dwells: Vec<f64> = moves.iter().filter_map(dwell).collect();
    assert_close(&dwells, &[0.5, 2.0], "dwells");
    let feeds = moves
        .iter()
        .filter(|step| dwell(step).is_none() && !common::is_rapid(step));
    assert_eq!(feeds.count(), 5, "one down, and two down and up");
}

#[test]
fn incomplete_cycles_are_refused() {
    for (text, expected) in [
        ("F9 G81 X1 Z-1", "the first block of G81 needs a R word"),
        ("F9 G81 X1 R1", "the first block of G81 needs a Z word"),
        ("F9 G83 X1 Z-1 R1", "the first block of G83 needs a Q word"),
        ("F9 G82 X1 Z-1 R1", "the first block of G82 needs a P word"),
        (
            "F9 G81 X1 Z2 R1",
            "R is at 1 mm, below the bottom of the hole at 2 mm",
        ),
        (
            "F9 G83 X1 Z-1 R1 Q0",
            "depth of a peck is 0, but must be positive",
        ),
        (
            "G81 X1 Z-1 R1",
            "feedrate was never set, but a feed move needs one",
        ),
        (
            "F9 G83 X1 Z-1e6 R1 Q.001",
            "E is not supported: extruder or spindle-tied motion",
        ),
    ]
    .into_iter()
    .take(7)
    {
        let (.., reason) = refused(text);
        assert_eq!(reason.to_string(), expected, "{text:?}");
    }
    let (.., reason) = refused("F9 G83 X1 Z-1000000 R1 Q.001");
    assert!(
        matches!(
            reason,
            Reason::Machining(MachiningError::TooManyMoves { .. })
        ),
        "{reason}"
    );
}

#[test]
fn splines_are_chords_that_end_where_they_should() {
    for (text, end) in [
        ("G5 I0 J3 P0 Q-3 X1 Y1 F60", [1.0, 1.0]),
        ("G5.1 X2 I1 J2 F60", [2.0, 0.0]),
        ("F60 G5.2 P1 L3 X0 Y1\nX2 Y2\nX2 Y0 P2\nG5.3", [2.0, 0.0]),
    ] {
        let moves = read(text);
        assert!(moves.len() > 4, "{text:?}: {} chords", moves.len());
        let last = moves.last().unwrap();
        let there = last.end(Vector::zeros());
        assert_close(&[there[0], there[1]], &end, text);
        assert_close(
            &[last.tolerance().length()],
            &[0.009],
            "the rest of the tolerance",
        );
    }
    // A parabola: y = 2 x - x² from 0 to 2.
    for step in read("G5.1 X2 I1 J2 F60") {
        let end = step.end(Vector::zeros());
        assert!(
            (end[1] - (2.0 * end[0] - end[0] * end[0])).abs() < CLOSE,
            "{end}"
        );
    }
}

#[test]
fn splines_out_of_place_are_refused() {
    for (text, expected) in [
        ("F9 G5 X1 P1 Q1", "G5 needs I and J"),
        ("F9 G5 X1 I1 J1", "G5 needs P and Q"),
        (
            "F9 G18 G5.1 X1 I1",
            "G5.1 is not possible outside the plane XY (G17)",
        ),
        (
            "F9 G5.2 X1 L3\nG1 X2",
            "the spline begun by G5.2 is not ended by G5.3",
        ),
        ("G5.3", "G5.3 ends a spline, but none was begun by G5.2"),
        (
            "F9 G5.2 X1 L4\nG5.3",
            "the spline has 2 points, but its order of 4 needs at least as many",
        ),
        ("F9 G5.2 X1 P0", "weight is 0, but must be positive"),
    ] {
        let (.., reason) = refused(text);
        assert_eq!(reason.to_string(), expected, "{text:?}");
    }
}

#[test]
fn the_tool_goes_beside_the_path_and_around_outside_corners() {
    let text = "F100 G41.1 D2\nG1 X10\nY10\nX20\nY0\nG40 X30\n";
    let moves = with_tools(text);
    let mut at = Vector::zeros();
    let mut found = Vec::new();
    for step in &moves {
        if let Path::Arc(arc) = step.path() {
            assert_eq!(arc.start(), at, "arcs begin where the path is");
        }
        at = step.end(at);
        found.extend([at[0], at[1]]);
    }
    let expected = [
        [9.0, 1.0],
        [9.0, 10.0],
        [10.0, 11.0],
        [20.0, 11.0],
        [21.0, 10.0],
        [21.0, 0.0],
        [30.0, 0.0],
    ];
    assert_close(&found, &expected.concat(), "ends");
    let arcs = moves
        .iter()
        .filter(|step| matches!(step.path(), Path::Arc(_)));
    assert_eq!(arcs.count(), 2, "outside corners");
}

#[test]
fn compensated_arcs_shrink_grow_and_meet_lines() {
    let text = "F100 G42.1 D2\nG1 X10\nX20\nG3 X30 I5\nG40 G1 X40\n";
    let moves = with_tools(text);
    let Path::Arc(arc) = moves
        .iter()
        .find(|step| matches!(step.path(), Path::Arc(_)))
        .unwrap()
        .path()
    else {
        panic!("an arc")
    };
    assert!(
        (arc.radii().0 - 6.0).abs() < CLOSE,
        "outside: {}",
        arc.radii().0
    );
    // The line at y = -1 meets the circle of radius 6 about (25, 0) at x = 25 - sqrt(35).
    let meets = 25.0 - 35.0_f64.sqrt();
    assert!(
        (arc.start() - Vector::<3>::new(meets, -1.0, 0.0)).norm() < CLOSE,
        "{}",
        arc.start()
    );
}

#[test]
fn all_codes_are_possible_again_before_the_lead_out() {
    let text = "F9 G41 D1\nG1 X10\nX20\nG40\nG20 G64 G18\nG0 X0 Z0\nG42 D1\nG1 X1\nZ1\nG40\nX0\n";
    assert_eq!(with_tools(text).len(), 6, "moves");
}

#[test]
fn compensation_that_would_gouge_is_refused() {
    for (text, line, expected) in [
        (
            "F9 G41 D2\nG1 X1\nG1 X5",
            2,
            "the move that begins cutter compensation is 1 mm long, but must be longer than the radius of 2 mm",
        ),
        (
            "F9 G41 D2\nG2 X9 I4.5",
            2,
            "cutter compensation begins with a straight move, not with an arc",
        ),
        (
            "F9 G41 D2\nG1 X9\nG1 X10\nG3 X10 Y2 J1",
            4,
            "the tool of radius 2 mm does not fit inside the arc of radius 1 mm",
        ),
        (
            "F9 G41 D2\nG1 X9\nG1 X20\nY1\nX0",
            4,
            "the tool of radius 2 mm would gouge: it cannot reach the corner before this move",
        ),
        (
            "F9 G41 D2\nG1 X9\nX20\nG40\nG2 X30 I5",
            5,
            "cutter compensation ends with a straight move, not with an arc",
        ),
        (
            "F9 G41 D2\nG1 X9\nG18",
            3,
            "G18 is not possible while cutter compensation is on (G40 ends it)",
        ),
        (
            "F9 G41 D2\nG92 X1",
            2,
            "G92 is not possible while cutter compensation is on (G40 ends it)",
        ),
        (
            "F9 G41 D2\nG42 D1",
            2,
            "G42 is not possible while cutter compensation is on (G40 ends it)",
        ),
    ] {
        let (found, _, reason) = refused(text);
        if line == 4 && expected.contains("gouge") {
            assert!(
                matches!(reason, Reason::Machining(MachiningError::Gouge { .. })),
                "{text:?}: {reason}"
            );
            continue;
        }
        assert_eq!(
            (found, reason.to_string().as_str()),
            (line, expected),
            "{text:?}"
        );
    }
}

#[test]
fn a_tool_is_what_a_program_makes_of_it() {
    let mut table = ToolTable::new();
    let tool = Tool {
        offset: Vector::<3>::new(0.0, 0.0, 3.0),
        diameter: 1.0,
    };
    table.set(4, tool);
    assert_eq!(table.get(4), Some(tool), "set");
    assert!(!table.is_empty() && ToolTable::new().is_empty(), "empty");
}

#[test]
fn words_of_printers_are_skipped_with_one_warning() {
    let mut program = Program::new(
        &b"M104 S200\nG92 E0\nG1 X1 E2 F60\nX2 E3"[..],
        FILE,
        settings(),
    );
    assert_eq!(program.by_ref().map(Result::unwrap).count(), 2, "moves");
    let words: Vec<&str> = program
        .warnings()
        .iter()
        .map(|one| one.place().word())
        .collect();
    assert_eq!(words, ["M104", "E0"], "warnings");
    let (.., reason) = refusal("M201 X1");
    assert!(matches!(reason, Reason::UnknownCode { .. }), "{reason}");
}

#[test]
fn a_local_shift_is_written_where_g92_writes() {
    let text = "G0 X10 Y10\nG52 X1 Y2\nX0 Y0\nG92 X5\nX6\nG52 X3\nX0 Y0\nG52 Y0\nY1\nG92.1\nX0 Y0";
    assert_ends(
        text,
        &[
            [10.0, 10.0, 0.0],
            [1.0, 2.0, 0.0],
            [2.0, 2.0, 0.0],
            [3.0, 2.0, 0.0],
            [3.0, 1.0, 0.0],
            [0.0, 0.0, 0.0],
        ],
    );
    assert_ends("G20 G52 X1\nG21 G0 X0 Y#5211", &[[25.4, 25.4, 0.0]]);
    let turned = "G10 L2 P1 X5 R90\nG52 X2\nG0 X1 Y0";
    assert_ends(turned, &[[5.0, 3.0, 0.0]]);
    let (.., reason) = refusal("G52");
    assert!(
        matches!(reason, Reason::Machining(MachiningError::Companion { .. })),
        "{reason}"
    );
}

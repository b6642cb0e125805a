//! Tools: the table, their lengths, and their radii beside the path.
//!
//! Where a number is not plain, LinuxCNC gives the same.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{CLOSE, FILE, assert_close, assert_ends, settings};
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
fn a_tool_measured_on_the_fixture_knows_no_other_offsets() {
    let text = "G10 L2 P9 Z7\nG0 Z20\nG92 Z1\nG10 L11 P1 Z5\nG92.1\nT1 M6 G43 G59.3\nG10 L0\nZ5";
    assert_ends(text, &[[0.0, 0.0, 20.0], [0.0, 0.0, 20.0]]);
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
        assert_eq!(
            (found, reason.to_string().as_str()),
            (line, expected),
            "{text:?}"
        );
    }
    let (.., reason) = refused("F9 G41 D2\nG1 X9\nG1 X20\nY1\nX0");
    assert!(
        matches!(reason, Reason::Machining(MachiningError::Gouge { .. })),
        "{reason}"
    );
}

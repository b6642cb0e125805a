//! Coordinate systems, shifts, stored points and polar coordinates.
//!
//! Where a number is not plain, LinuxCNC gives the same.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{CLOSE, assert_close, assert_ends, read, refusal};
use toolglide_kinematics::{Path, Vector};
use toolglide_program::{MachiningError, Reason};

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
    let (.., reason) = refusal("G10 L20 P1 R30 X1");
    assert_eq!(reason, Reason::Unused { letter: 'R' }, "no rotation");
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
fn polar_coordinates_are_distance_and_angle() {
    assert_ends(
        "G0 @10 ^90\n@5\n^180",
        &[[0.0, 10.0, 0.0], [0.0, 5.0, 0.0], [-5.0, 0.0, 0.0]],
    );
    assert_ends("G0 X10\nG91 @-5 ^90", &[[10.0, 0.0, 0.0], [0.0, 5.0, 0.0]]);
    let (.., reason) = refusal("G0 ^5");
    assert!(
        matches!(reason, Reason::Machining(MachiningError::Polar { .. })),
        "{reason}"
    );
}

//! Arcs: centres, radii, planes, turns and helices.

mod common;

use common::{CLOSE, assert_close, assert_ends, last_arc};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toolglide_kinematics::Vector;

/// Arcs in tests need a feedrate before them.
fn arc(text: &str) -> toolglide_kinematics::Arc<3> {
    last_arc(&format!("F600\n{text}"))
}

fn center(text: &str) -> [f64; 3] {
    arc(text).center().into()
}

#[test]
fn a_centre_is_an_offset_from_the_start() {
    let quarter = arc("G0 X10 Y5\nG3 X5 Y10 I-5 J0");
    assert_close(
        &<[f64; 3]>::from(quarter.center()),
        &[5.0, 5.0, 0.0],
        "centre",
    );
    assert_close(&[quarter.sweep()], &[FRAC_PI_2], "a quarter to the left");
    assert_close(
        &[arc("G0 X10 Y5\nG2 X5 Y10 I-5").sweep()],
        &[-1.5 * PI],
        "and to the right",
    );
}

#[test]
fn a_centre_may_be_absolute() {
    assert_close(
        &center("G0 X10 Y5\nG90.1\nG3 X5 Y10 I5 J5"),
        &[5.0, 5.0, 0.0],
        "G90.1",
    );
    assert_close(
        &center("G90.1 G0 X10 Y5\nG91.1\nG3 X5 Y10 I-5 J0"),
        &[5.0, 5.0, 0.0],
        "G91.1",
    );
    assert_close(
        &center("G91 G90.1 G0 X10 Y5\nG3 X-5 Y5 I5 J5"),
        &[5.0, 5.0, 0.0],
        "the mode of distances is another",
    );
}

#[test]
fn the_end_may_be_incremental() {
    assert_ends(
        "G91 F60 G0 X10\nG3 X-5 Y5 I-5",
        &[[10.0, 0.0, 0.0], [5.0, 5.0, 0.0]],
    );
}

#[test]
fn inches_scale_offsets_and_radii() {
    assert_close(
        &center("G20\nG0 X1\nG3 X0 Y1 I-1 J0"),
        &[0.0, 0.0, 0.0],
        "I J",
    );
    let by_radius = arc("G20\nG0 X1\nG3 X0 Y1 R1");
    assert_close(
        &[by_radius.radii().0, by_radius.sweep()],
        &[25.4, FRAC_PI_2],
        "R",
    );
    assert_close(
        &center("G20 G90.1\nG0 X2\nG3 X1 Y1 I1 J0"),
        &[25.4, 0.0, 0.0],
        "absolute",
    );
}

#[test]
fn without_an_end_the_arc_is_a_full_circle() {
    for text in ["G2 I5", "G2 X0 Y0 I5", "G2 X0 I5 J0"] {
        let circle = arc(text);
        assert_close(&[circle.sweep(), circle.length()], &[-TAU, 5.0 * TAU], text);
    }
    assert_close(&[arc("G3 J-2").sweep()], &[TAU], "counter-clockwise");
}

#[test]
fn a_modal_arc_needs_only_its_offset() {
    assert_close(&[arc("G2 I5\nI2").length()], &[2.0 * TAU], "another circle");
}

#[test]
fn the_third_axis_makes_a_helix() {
    let helix = arc("G0 Z2\nG3 X0 Y0 Z-1 I4 J3");
    assert_close(&<[f64; 3]>::from(helix.lift()), &[0.0, 0.0, -3.0], "lift");
    assert_close(&[helix.length()], &[(5.0 * TAU).hypot(3.0)], "length");
}

#[test]
fn turns_count_the_one_begun() {
    assert_close(
        &[arc("G2 Z-3 I5 P3").sweep()],
        &[-3.0 * TAU],
        "three circles",
    );
    assert_close(
        &[arc("G0 X5\nG3 X0 Y5 I-5 P2").sweep()],
        &[FRAC_PI_2 + TAU],
        "and a quarter",
    );
    assert_close(
        &[arc("G0 X5\nG3 X0 Y5 I-5 P1").sweep()],
        &[FRAC_PI_2],
        "one is the arc itself",
    );
}

#[test]
fn in_the_plane_zx_a_positive_turn_goes_from_z_to_x() {
    let quarter = arc("G18 G2 X10 Z-10 I10");
    assert_close(
        &[quarter.sweep()],
        &[-FRAC_PI_2],
        "clockwise seen from positive Y",
    );
    assert_close(
        &<[f64; 3]>::from(quarter.center()),
        &[10.0, 0.0, 0.0],
        "centre",
    );
    assert_close(
        &[arc("G18 G3 X10 Z-10 I10").sweep()],
        &[1.5 * PI],
        "the other way",
    );
    assert_close(
        &[arc("G18 G3 X10 Z10 I10 Y4").lift()[1]],
        &[4.0],
        "lift along Y",
    );
}

#[test]
fn in_the_plane_yz_a_positive_turn_goes_from_y_to_z() {
    let quarter = arc("G19 G0 Y10\nG3 Y0 Z10 J-10 K0");
    assert_close(&[quarter.sweep()], &[FRAC_PI_2], "counter-clockwise");
    assert_close(
        &[arc("G19 G0 Y10\nG2 Y0 Z10 J-10").sweep()],
        &[-1.5 * PI],
        "clockwise",
    );
}

/// The middle of the shorter arc, worked out by hand for a chord along X.
#[test]
fn a_positive_radius_takes_the_shorter_arc_and_a_negative_one_the_longer() {
    // Chord of 8 and radius 5: the centre lies 3 beside the middle of the chord.
    for (text, beside, middle) in [
        ("G2 X8 R5", -3.0, 2.0),
        ("G3 X8 R5", 3.0, -2.0),
        ("G2 X8 R-5", 3.0, 8.0),
        ("G3 X8 R-5", -3.0, -8.0),
    ] {
        let arc = arc(text);
        assert_close(&<[f64; 3]>::from(arc.center()), &[4.0, beside, 0.0], text);
        assert_close(&<[f64; 3]>::from(arc.point(0.5)), &[4.0, middle, 0.0], text);
        assert_eq!(arc.sweep().abs() < PI, text.contains("R5"), "{text}");
    }
}

#[test]
fn a_radius_works_in_every_plane() {
    let zx = arc("G18 G3 Z8 R5");
    assert_close(
        &<[f64; 3]>::from(zx.center()),
        &[3.0, 0.0, 4.0],
        "left of Z is X",
    );
    let yz = arc("G19 G3 Y8 R5");
    assert_close(
        &<[f64; 3]>::from(yz.center()),
        &[0.0, 4.0, 3.0],
        "left of Y is Z",
    );
}

#[test]
fn a_radius_of_half_the_chord_makes_half_a_circle() {
    for (text, sign) in [("G2 X10 R5", 1.0), ("G3 X10 R5", -1.0), ("G2 X10 R-5", 1.0)] {
        let half = arc(text);
        assert_close(
            &<[f64; 3]>::from(half.point(0.5)),
            &[5.0, sign * 5.0, 0.0],
            text,
        );
    }
}

#[test]
fn a_radius_slightly_too_short_makes_half_a_circle() {
    let half = arc("G2 X10 R4.996");
    assert_close(&<[f64; 3]>::from(half.center()), &[5.0, 0.0, 0.0], "centre");
    assert_close(&[half.sweep().abs()], &[PI], "sweep");
}

#[test]
fn arcs_end_exactly_where_they_are_told() {
    let arc = arc("G0 X1.2345 Y2.3456\nG3 X-1.9835 Y1.3636 I-1.118 J-2.1");
    assert_eq!(
        arc.end(),
        Vector::<3>::new(-1.9835, 1.3636, 0.0),
        "bit for bit"
    );
    assert!((arc.point(1.0) - arc.end()).norm() < CLOSE, "point");
}

//! Straight moves, dwells, units, distances, feedrates and path control.

mod common;

use common::{assert_close, assert_ends, dwell, ends, is_rapid, read, settings, speeds, try_read};
use toolglide_kinematics::{Tolerance, Vector};
use toolglide_program::{Notice, Program};

#[test]
fn a_program_without_motion_is_an_empty_stream() {
    for text in [
        "",
        "\n\n",
        "%\n%\n",
        "G21 G90\nS1000 M3\nM30\n",
        "(nothing)\n; here\n",
        "N10",
    ] {
        assert!(read(text).is_empty(), "{text:?}");
    }
}

#[test]
fn rapids_and_feed_moves_differ_in_feedrate() {
    let moves = read("G0 X1\nG1 X2 F600\nG0 X3\n");
    let rapid: Vec<bool> = moves.iter().map(is_rapid).collect();
    assert_eq!(rapid, [true, false, true], "rapids");
    assert_close(&[moves[1].feedrate().speed()], &[10.0], "600 mm/min");
}

#[test]
fn moves_know_their_lines() {
    let lines: Vec<u32> = read("G21\n\n(c)\nG0 X1\r\nG1 X2 F600\n\nX3")
        .iter()
        .map(toolglide_kinematics::Move::line)
        .collect();
    assert_eq!(lines, [4, 5, 7], "lines");
}

#[test]
fn a_line_of_axis_words_repeats_the_motion() {
    assert_ends(
        "G1 F60 X1\nY2\nZ3 X4\n",
        &[[1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [4.0, 2.0, 3.0]],
    );
    let moves = read("G0 X1\nX2\nG1 F60 X3\nX4");
    let rapid: Vec<bool> = moves.iter().map(is_rapid).collect();
    assert_eq!(rapid, [true, true, false, false], "modal");
}

#[test]
fn a_motion_word_alone_sets_the_mode_and_moves_nothing() {
    assert_ends("G1 F600\nX5\n", &[[5.0, 0.0, 0.0]]);
    assert_ends("G0 S1000\nX5\n", &[[5.0, 0.0, 0.0]]);
}

#[test]
fn words_may_stand_in_any_order_case_and_spacing() {
    let plain = ends("G1 X10 Y-2.5 F600");
    for text in [
        "f600y-2.5x10g1",
        "  G 0 1\tX1 0 Y - 2 . 5 F6 00 ",
        "N5 X+10. G01 F600.0 Y-02.50",
    ] {
        assert_eq!(ends(text), plain, "{text:?}");
    }
}

#[test]
fn incremental_distances_add_up() {
    assert_ends(
        "G91 G1 F60 X1 Y1\nX1\nG90 X5\nG91 Z-1",
        &[
            [1.0, 1.0, 0.0],
            [2.0, 1.0, 0.0],
            [5.0, 1.0, 0.0],
            [5.0, 1.0, -1.0],
        ],
    );
}

#[test]
fn the_start_of_the_settings_counts() {
    let mut settings = settings();
    settings.start = Vector::<3>::new(1.0, 2.0, 3.0);
    let moves = try_read("G91 G0 X1", settings).unwrap();
    assert_eq!(
        moves[0].end(settings.start),
        Vector::<3>::new(2.0, 2.0, 3.0),
        "end"
    );
}

#[test]
fn inches_apply_to_coordinates_feedrate_and_tolerance() {
    let text = "G20\nG64 P0.01\nG1 X1 Y-2 F60\nG21\nX0\n";
    assert_ends(text, &[[25.4, -50.8, 0.0], [0.0, -50.8, 0.0]]);
    assert_close(&speeds(text), &[25.4, 25.4], "the feedrate is kept in mm/s");
    assert_close(&[read(text)[0].tolerance().length()], &[0.254], "tolerance");
}

#[test]
fn the_units_of_a_block_hold_for_its_coordinates_and_not_for_its_feedrate() {
    let mut program = Program::new(&b"G20 G1 X1 F60"[..], "a.ngc", settings());
    let step = program.next().unwrap().unwrap();
    assert_close(&[step.end(Vector::zeros())[0]], &[25.4], "coordinate");
    assert_close(
        &[step.feedrate().speed()],
        &[1.0],
        "feedrate in mm a minute",
    );
    let warning = &program.warnings()[0];
    assert_eq!(
        warning.notice(),
        &Notice::FeedBeforeUnits { former: "mm" },
        "warning"
    );
    assert_eq!(
        (warning.place().column(), warning.place().word()),
        (11, "F60"),
        "place"
    );
    let mut quiet = Program::new(&b"G21 G1 X1 F60"[..], "a.ngc", settings());
    assert!(
        quiet.next().is_some() && quiet.warnings().is_empty(),
        "no change, no warning"
    );
}

#[test]
fn inverse_time_gives_the_duration_of_the_move() {
    let text = "G93\nG1 X30 Y40 F2\nX0 F30\nG3 X0 Y0 I0 J-20 F1\n";
    let half = std::f64::consts::PI * 20.0;
    let expected = [50.0 / 30.0, 30.0 / 2.0, half / 60.0];
    assert_close(&speeds(text), &expected, "length times F / 60");
    assert_close(
        &speeds("G93 G0 X1\nG1 X2 F60"),
        &[f64::INFINITY, 1.0],
        "no F for rapids",
    );
    assert!(
        is_rapid(&read("G93 G1 X0 F5")[0]),
        "no length, no speed to keep"
    );
}

#[test]
fn inches_do_not_scale_inverse_time() {
    assert_close(
        &speeds("G20 G93 G1 X1 F60"),
        &[25.4],
        "one inch in a second",
    );
}

#[test]
fn the_default_tolerance_holds_until_the_program_says_another() {
    let lengths = |text: &str, settings| -> Vec<f64> {
        let moves = try_read(text, settings).unwrap();
        moves.iter().map(|step| step.tolerance().length()).collect()
    };
    let text = "G0 X1\nG64 P0.2\nX2\nG64\nX3\nG64 P0.3 Q0.1 X4\n";
    assert_close(
        &lengths(text, settings()),
        &[0.01, 0.2, 0.01, 0.3],
        "program",
    );
    let mut own = settings();
    own.tolerance = Tolerance::new(0.5).unwrap();
    own.override_tolerance = true;
    assert_close(&lengths(text, own), &[0.5; 4], "settings");
}

#[test]
fn exact_stop_holds_until_blending_is_asked_for() {
    for code in ["G61", "G61.1"] {
        let text = format!("G0 X1\n{code}\nX2\nG1 X3 F60\nG2 X4 I.5\nG64 G1 X5");
        let stops: Vec<bool> = read(&text)
            .iter()
            .map(toolglide_kinematics::Move::stops)
            .collect();
        assert_eq!(stops, [false, true, true, true, false], "{code}");
    }
}

#[test]
fn a_dwell_is_in_seconds_and_comes_before_the_motion_of_its_block() {
    let moves = read("G4 P1.5\nG1 F60 X1\nG4 P0.25 G0 X2\n");
    let dwells: Vec<Option<f64>> = moves.iter().map(dwell).collect();
    assert_eq!(dwells, [Some(1.5), None, Some(0.25), None], "dwells");
    assert_eq!(dwell(&read("G4 P0")[0]), Some(0.0), "no time is legal");
}

#[test]
fn a_pause_brings_the_motion_to_rest_after_its_block() {
    for code in ["M0", "M1", "M60"] {
        let moves = read(&format!("G0 X1 {code}\nX2"));
        let dwells: Vec<Option<f64>> = moves.iter().map(dwell).collect();
        assert_eq!(dwells, [None, Some(0.0), None], "{code}");
        assert_eq!((moves[1].line(), moves[1].stops()), (1, true), "{code}");
    }
}

#[test]
fn the_program_ends_where_it_says_so() {
    for end in ["M2", "M30", "%"] {
        let text = format!("%\nG0 X1\n{end}\nX2 this is not read #");
        assert_ends(&text, &[[1.0, 0.0, 0.0]]);
    }
    assert_ends("G0 X1 M2\nX2", &[[1.0, 0.0, 0.0]]);
    assert_ends("G0 X1\n%\nX2", &[[1.0, 0.0, 0.0]]);
    assert_ends("\n(head)\n %\t\nG0 X1", &[[1.0, 0.0, 0.0]]);
}

#[test]
fn deleted_blocks_are_skipped() {
    assert_ends(
        "G0 X1\n/X2 [#1]\n  / G28\nX3",
        &[[1.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
    );
}

#[test]
fn codes_without_effect_are_accepted() {
    let text = "G17 G21 G40 G49 G54 G80 G90 G91.1 G94 G64\nT3 M6\nS12000 M3 M8\nM7 M8\nM48\n\
                N100 G0 X1 M9 M5\nM49 M4\nM30";
    assert_ends(text, &[[1.0, 0.0, 0.0]]);
    let mut program = Program::new(text.as_bytes(), "a.ngc", settings());
    assert_eq!(program.by_ref().count(), 1, "moves");
    assert_eq!(program.tool(), 3, "tool");
    assert_close(&[program.spindle_speed()], &[12000.0], "spindle");
    assert_eq!((program.lines(), program.blocks()), (8, 8), "counts");
    assert!(program.warnings().is_empty(), "warnings");
}

#[test]
fn lines_and_blocks_are_counted() {
    let mut program = Program::new(&b"%\n\n(c)\nG0 X1\nX2 ; c\n/X3\n%\nX4"[..], "a", settings());
    assert_eq!(program.by_ref().count(), 2, "moves");
    assert_eq!((program.lines(), program.blocks()), (7, 2), "counts");
    assert_eq!(
        program.position(),
        Vector::<3>::new(2.0, 0.0, 0.0),
        "position"
    );
}

#[test]
fn a_cancelled_cycle_beside_a_motion_is_of_no_effect() {
    assert_ends("G90 G80 G0 X1\nX2", &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    assert_ends("G0 G80 X1\nX2", &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
}

#[test]
fn comments_may_hold_any_text() {
    let text = "(MSG, hello)\n(µ / % # [ ;)\nG0 (here) X1 ; (there\n(\u{fc})";
    assert_ends(text, &[[1.0, 0.0, 0.0]]);
    let latin = b"(\xb5m \xff) G0 X1 ;\x80\n";
    assert_eq!(
        Program::new(&latin[..], "a", settings()).count(),
        1,
        "not UTF-8"
    );
}

#[test]
fn moves_of_no_length_are_moves() {
    assert_eq!(read("G1 X0 Y0 F100\nX0\nG0 Z0").len(), 3, "moves");
}

#[test]
fn a_machine_of_two_axes_reads_its_own_words() {
    let mut flat = settings();
    flat.axes = [true, true, false];
    assert_eq!(
        try_read("G0 X1 Y2\nG2 X2 I.5 F60", flat).unwrap().len(),
        2,
        "moves"
    );
}

//! Cutter location files as NX and Creo write them: systems, circles, feedrates, and what is never skipped.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{FILE, assert_close, lenient, settings};
use toolglide_kinematics::{PoseEnd, PoseFeed, PoseMove};
use toolglide_program::{Language, Notice, Poses, ProgramError, Settings};

fn poses(text: &str, settings: Settings) -> Poses<&[u8]> {
    Poses::new(text.as_bytes(), FILE, settings, Language::CutterLocations)
}

fn try_read(text: &str) -> Result<Vec<PoseMove>, ProgramError> {
    poses(text, settings()).collect()
}

fn read(text: &str) -> Vec<PoseMove> {
    try_read(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// Tip and orientation of a move.
fn pose(step: &PoseMove) -> [f64; 6] {
    let PoseEnd::Pose(pose) = step.end() else {
        panic!("{step:?}")
    };
    let (tip, tool) = (pose.tip(), pose.orientation());
    [tip[0], tip[1], tip[2], tool[0], tool[1], tool[2]]
}

fn speed(step: &PoseMove) -> f64 {
    match step.feed() {
        PoseFeed::Speed(feedrate) => feedrate.speed(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_system_moves_and_turns_what_follows_it() {
    let text = "TOOL PATH/PROFILE,TOOL,MILL\nTLDATA/MILL,10.0,0.0,75.0,0.0,0.0\n\
        MSYS/100.0,50.0,0.0,0.0,1.0,0.0,-1.0,0.0,0.0\nRAPID\nGOTO/0.0,0.0,10.0,0.0,0.0,1.0\n\
        FEDRAT/MMPM,250.0\nGOTO/20.0,0.0,10.0\nGODLTA/0,5,0\nEND-OF-PATH\n";
    let moves = read(text);
    let up = [0.0, 0.0, 1.0];
    let at = |x: f64, y: f64| [[x, y, 10.0], up].concat();
    assert_close(&pose(&moves[0]), &at(100.0, 50.0), "origin");
    assert_close(&pose(&moves[1]), &at(100.0, 70.0), "along its X");
    assert_close(&pose(&moves[2]), &at(95.0, 70.0), "along its Y");
}

#[test]
fn a_tilted_system_turns_the_tool_and_circles_too() {
    // X stays, Y goes up: the Z of the system points to -Y.
    let system = "MSYS/0,0,5,1,0,0,0,0,1\nFEDRAT/60\n";
    let moves = read(&format!("{system}GOTO/1,2,3\nGOTO/1,2,3,0.6,0,0.8\n"));
    assert_close(&pose(&moves[0]), &[1.0, -3.0, 7.0, 0.0, -1.0, 0.0], "tip");
    assert_close(&pose(&moves[1])[3..], &[0.6, -0.8, 0.0], "tool");
    let arc = format!("{system}GOTO/5,0,0\nCIRCLE/0,0,0,0,0,1,5,0.06,0.5,10,0\nGOTO/0,5,0\n");
    for step in &read(&arc)[1..] {
        let [x, y, z, ..] = pose(step);
        assert_close(&[y], &[0.0], "in its plane");
        assert!((x.hypot(z - 5.0) - 5.0).abs() < 1e-9, "on its circle");
    }
    assert_close(
        &pose(read(&arc).last().unwrap())[..3],
        &[0.0, 0.0, 10.0],
        "end",
    );
    let inches = read("UNITS/INCHES\nMSYS/1,0,0,1,0,0,0,1,0\nRAPID\nGOTO/1,0,0\n");
    assert_close(&pose(&inches[0])[..1], &[50.8], "origin in inches");
}

#[test]
fn axes_that_are_no_system_are_refused() {
    for text in [
        "MSYS/0,0,0,1,0,0,1,0,0",
        "MSYS/0,0,0,2,0,0,0,1,0",
        "MSYS/0,0,0,1,0,0",
        "MSYS/0,0,0,0,0,0,0,1,0",
    ] {
        let shown = try_read(text).unwrap_err().to_string();
        assert!(shown.contains("MSYS"), "{shown}");
    }
}

#[test]
fn a_circle_has_seven_to_eleven_numbers() {
    let text = |circle: &str| format!("FEDRAT/60\nFROM/10,20,0\nCIRCLE/{circle}\nGOTO/30,20,0\n");
    let nx = "20,20,0,0,0,-1,10,0.0600,0.5000,10.0000,0.0000";
    let moves = read(&text(nx));
    let middle = pose(&moves[moves.len() / 2 - 1]);
    assert!(middle[1] > 29.9, "clockwise over the top: {middle:?}");
    assert!(try_read(&text("20,20,0,0,0,-1")).is_err(), "six");
    assert!(try_read(&text(&format!("{nx},1"))).is_err(), "twelve");
}

#[test]
fn what_is_for_the_post_processor_is_told_once_a_kind() {
    let text = "TOOL PATH/CAVITY_MILL,TOOL,MILL\nTLDATA/MILL,10,0,75,0,0\n$$ centerline data\nPAINT/PATH\n\
        PAINT/SPEED,10\nPPWORD/CLAMP\nLOAD/TOOL,1\nPPWORD/UNCLAMP\nAUXFUN/8\nPPFUN/1\nARCSLP/ON\nRAPID\nGOTO/1,2,3\n\
        MULTAX/ON\nCUTCOM/OFF\nCYCLE/OFF\nEND-OF-PATH\n";
    let mut program = poses(text, settings());
    assert_eq!(program.by_ref().map(Result::unwrap).count(), 1, "moves");
    let words: Vec<&str> = program
        .warnings()
        .iter()
        .map(|warning| match warning.notice() {
            Notice::Noted { word, .. } => &**word,
            other => panic!("{other}"),
        })
        .collect();
    assert_eq!(words, ["PPWORD", "AUXFUN", "PPFUN"], "told");
    assert_eq!(program.tools_used(), [1], "tool");
}

#[test]
fn what_moves_an_axis_or_the_part_is_refused_even_in_lenient_reading() {
    for statement in [
        "CYCLE/DRILL,10",
        "DRILL/10",
        "ROTATE/AAXIS,ABSOL,30",
        "ROTABL/90,CLW",
        "ROTHED/30",
        "TRACUT/1,0,0,5,0,1,0,0,0,0,1,0",
        "COPY/1,SAME,2",
        "INDEX/1",
        "GOHOME",
        "GOFWD/C1",
        "CUTCOM/LEFT",
        "PREFUN/28",
        "INSERT/G0 X5",
        "ORIGIN/1,2,3",
        "RETRCT",
        "MOVNRB/ON",
    ] {
        let text = format!("{statement}\nRAPID\nGOTO/1,2,3\n");
        let refused = poses(&text, lenient()).find_map(Result::err);
        let shown = refused.map(|error| error.to_string()).unwrap_or_default();
        assert!(shown.contains("nor ever skipped"), "{statement}: {shown}");
    }
    let unknown = "WIGGLE/1\nRAPID\nGOTO/1,2,3\n";
    assert_eq!(poses(unknown, lenient()).count(), 1, "lenient");
    assert!(try_read(unknown).is_err(), "strict");
}

#[test]
fn a_feedrate_for_each_turn_needs_the_speed_of_the_spindle() {
    let text = "SPINDL/RPM,1200,CLW\nFEDRAT/MMPR,0.1\nGOTO/1,0,0\nSPINDL/600\nGOTO/2,0,0\nFEDRAT/0.01,IPR\n\
        GOTO/3,0,0\nFEDRAT/MMPM,300\nSPINDL/900\nGOTO/4,0,0\n";
    let speeds: Vec<f64> = read(text).iter().map(speed).collect();
    assert_close(&speeds, &[2.0, 1.0, 2.54, 5.0], "mm/s");
    for text in [
        "FEDRAT/MMPR,0.1\nGOTO/35,20,0",
        "SPINDL/SFM,300\nFEDRAT/IPR,0.01\nGOTO/1,0,0",
        "SPINDL/100\nFEDRAT/MMPR,0.1\nSPINDL/SMM,20\nGOTO/1,0,0",
    ] {
        let shown = try_read(text).unwrap_err().to_string();
        assert!(shown.contains("turns a minute"), "{shown}");
    }
    assert!(try_read("FEDRAT/INVERS,2\nGOTO/1,0,0").is_err(), "inverse");
}

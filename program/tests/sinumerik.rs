//! The first cut of the language of Sinumerik 840D.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::float_cmp,
    reason = "a failed unwrap is a failed test, and values are small whole numbers"
)]

mod common;

use common::{CLOSE, FILE, settings};
use toolglide_kinematics::{PoseEnd, PoseFeed, PoseMove, Vector};
use toolglide_program::{Language, Poses, ProgramError};

fn try_read(text: &str) -> Result<Vec<PoseMove>, ProgramError> {
    Poses::new(text.as_bytes(), FILE, settings(), Language::Sinumerik).collect()
}

fn ends(text: &str) -> Vec<Vector<3>> {
    let moves = try_read(text).unwrap_or_else(|error| panic!("{text:?}: {error}"));
    moves
        .iter()
        .map(|step| match step.end() {
            PoseEnd::Axes { linear, .. } => *linear,
            other => panic!("{other:?}"),
        })
        .collect()
}

fn assert_ends(text: &str, expected: &[[f64; 3]]) {
    let found = ends(text);
    assert_eq!(found.len(), expected.len(), "{text:?}: {found:?}");
    for (one, other) in found.iter().zip(expected) {
        let off = (one - Vector::<3>::from(*other)).norm();
        assert!(off < CLOSE, "{text:?}: {found:?}, expected {expected:?}");
    }
}

#[test]
fn addresses_take_numbers_and_expressions() {
    let text = "N10 DEF REAL _SAFE = 5, _DEEP\nN20 _DEEP = -(2 + 1) * 2\nN30 G0 X=_SAFE+1 Z = _SAFE\n\
                N40 R1=4.5 G1 Z=_DEEP Y=SIN(30)*R1 F600 ; remark\n";
    assert_ends(text, &[[6.0, 0.0, 5.0], [6.0, 2.25, -6.0]]);
}

#[test]
fn absolute_and_incremental_values_stand_side_by_side() {
    assert_ends(
        "G90 G0 X5 Y5\nX=IC(2) Y1\nG91 X1 Y=AC(0)\n",
        &[[5.0, 5.0, 0.0], [7.0, 1.0, 0.0], [8.0, 0.0, 0.0]],
    );
}

#[test]
fn frames_shift_and_turn_and_end() {
    let text = "TRANS X10\nG0 X1\nAROT Z90\nG0 X2 Y0\nATRANS X1\nG0 X0\nTRANS\nG0 X0 Y0\n";
    assert_ends(
        text,
        &[
            [11.0, 0.0, 0.0],
            [10.0, 2.0, 0.0],
            [10.0, 1.0, 0.0],
            [0.0, 0.0, 0.0],
        ],
    );
}

#[test]
fn an_arc_in_a_turned_frame_keeps_its_radius() {
    let text = "AROT X30.\nG0 X10 Y0 Z0\nG3 X-10 Y0 I-10 J0 F600\n";
    let found = ends(text);
    assert!(found.len() > 20, "{} chords", found.len());
    for end in &found {
        assert!((end.norm() - 10.0).abs() < CLOSE, "{end}");
    }
    let top = found.iter().map(|end| end[2]).fold(0.0, f64::max);
    assert!((top - 5.0).abs() < 0.01, "half the radius high: {top}");
}

#[test]
fn machine_coordinates_know_no_frame() {
    assert_ends(
        "TRANS X10 Y10\nSUPA G0 Z50 D0\nSUPA G0 X-3 Y=1+1\n",
        &[[0.0, 0.0, 50.0], [-3.0, 2.0, 50.0]],
    );
}

#[test]
fn the_tool_tip_moves_between_traori_and_trafoof() {
    let moves = try_read("G0 B90. C0.0\nTRAORI\nG0 X1\nTRAFOOF\nG0 X2\n").unwrap();
    let tips: Vec<bool> = moves
        .iter()
        .map(|step| matches!(step.end(), PoseEnd::Axes { tip: true, .. }))
        .collect();
    assert_eq!(tips, [false, true, false], "tips");
    let PoseEnd::Axes { rotary, .. } = moves[2].end() else {
        panic!("axis words")
    };
    assert!(
        (rotary[1] - std::f64::consts::FRAC_PI_2).abs() < CLOSE,
        "B stays"
    );
}

#[test]
fn rotary_words_turn_axes_by_oriaxes_and_point_the_tool_by_orivect_and_oriplane() {
    let text = "TRAORI\nG0 A-45 C0\nORIVECT\nC10\nORIAXES\nC20\nORIPLANE\nC30\nORIAXES C40\n";
    let moves = try_read(text).unwrap();
    let circles: Vec<bool> = moves
        .iter()
        .map(|step| {
            matches!(
                step.end(),
                PoseEnd::Axes {
                    great_circle: true,
                    ..
                }
            )
        })
        .collect();
    assert_eq!(circles, [false, true, false, true, false], "great circles");
}

#[test]
fn vectors_point_the_tool_until_rotary_words_do() {
    let text = "TRAORI\nG1 X1 A3=0.6 B3=0 C3=.8 F600\nX2\nA3=2 C3=0\nX3 A3=AC(1)\n";
    assert!(try_read(text).is_err(), "AC() of a component");
    let text = "TRAORI\nG1 X1 A3=0.6 B3=0 C3=.8 F600\nX2\nA3=2 C3=0\nC30\nTRAFOOF\nX5\nA0 B0 C0\n";
    let moves = try_read(text).unwrap();
    let tools: Vec<Option<[f64; 3]>> = moves
        .iter()
        .map(|step| match step.end() {
            PoseEnd::Pose(pose) => Some(pose.orientation().into()),
            _ => None,
        })
        .collect();
    let leaning = Some([0.6, 0.0, 0.8]);
    let expected = [leaning, leaning, Some([1.0, 0.0, 0.0]), None, None, None];
    assert_eq!(tools, expected, "where the tool points");
    let held: Vec<[bool; 3]> = moves.iter().map(PoseMove::rotary_held).collect();
    assert_eq!(held[3], [true, true, false], "C has a word");
    assert_eq!(held[4], [true, true, false], "nothing new is said");
    assert_eq!(held[5], [false; 3], "all have words");
}

#[test]
fn a_vector_is_one_of_the_frame_and_turns_evenly_along_an_arc() {
    let moves = try_read("TRAORI\nROT Z90\nG1 X1 A3=1 F600\n").unwrap();
    let tool = |step: &PoseMove| match step.end() {
        PoseEnd::Pose(pose) => pose.orientation(),
        other => panic!("{other:?}"),
    };
    assert!((tool(&moves[0])[1] - 1.0).abs() < CLOSE, "{:?}", moves[0]);
    let text = "TRAORI\nG1 X0 Y0 C3=1 F600\nG2 X10 Y0 I5 J0 A3=1 C3=1\n";
    let moves = try_read(text).unwrap();
    let lean: Vec<f64> = moves[1..].iter().map(|step| tool(step)[0].asin()).collect();
    let share = std::f64::consts::FRAC_PI_4 / f64::from(u32::try_from(lean.len()).unwrap());
    assert!(lean.len() > 10, "{} chords", lean.len());
    let mut before = 0.0;
    for (chord, lean) in lean.iter().enumerate() {
        assert!(
            (lean - before - share).abs() < 1e-9,
            "chord {chord}: {lean}"
        );
        before = *lean;
    }
}

#[test]
fn vectors_are_refused_where_they_say_nothing_certain() {
    for (text, what) in [
        ("G1 X1 A3=1 F600\n", "need TRAORI"),
        ("TRAORI\nG1 X1 A3=0 F600\n", "length of the vector"),
        ("TRAORI\nG1 X1 A3=1 C30 F600\n", "beside words A, B or C"),
        ("TRAORI\nG1 X1 A3=1 A3=2 F600\n", "written twice"),
        ("TRAORI\nG1 X1 A3=1 F600\nC=IC(3)\n", "write its place"),
        ("TRAORI\nG1 X1 A3=1 F600\nC=DC(3)\n", "write its place"),
        (
            "TRAORI\nG1 X0 Y0 C0 F600\nG2 X10 I5 J0 A3=1\n",
            "end of an arc",
        ),
        ("TRAORI\nG1 X1 A2=1 F600\n", "orientations by angles"),
    ] {
        let refused = try_read(text).unwrap_err().to_string();
        assert!(refused.contains(what), "{text}: {refused}");
    }
}

#[test]
fn cycle832_sets_the_tolerance_and_ends_it() {
    let text = "G60\nG1 X1 F600\nCYCLE832(.02,1,1)\nX2\nCYCLE832()\nX3\n";
    let moves = try_read(text).unwrap();
    let tolerances: Vec<f64> = moves.iter().map(|step| step.tolerance().length()).collect();
    assert!((tolerances[1] - 0.02).abs() < CLOSE, "{tolerances:?}");
    assert!((tolerances[2] - 0.01).abs() < CLOSE, "{tolerances:?}");
    let stops: Vec<bool> = moves.iter().map(PoseMove::stops).collect();
    assert_eq!(stops, [true, false, false], "exact stop before");
}

#[test]
fn radius_turns_dwells_and_tool_names_are_read() {
    let text =
        "T=\"MILL 12\" M6\nMSG(\"hello (there)\")\nG0 X0 Y0\nG2 X10 Y0 CR=5 F600\nG4 F2\nM17\nX9\n";
    let moves = try_read(text).unwrap();
    let last = moves.last().unwrap();
    assert_eq!(
        last.end(),
        &PoseEnd::Dwell { duration: 2.0 },
        "G4 F is a time"
    );
    assert!(
        matches!(moves[1].feed(), PoseFeed::Speed(speed) if (speed.speed() - 10.0).abs() < CLOSE),
        "feedrate"
    );
}

#[test]
fn what_is_not_read_is_refused_at_its_place() {
    for (text, expected) in [
        (
            "G0 X1\n  GOTOF ENDE",
            "part.ngc:2:9: there is no line ENDE to jump to",
        ),
        (
            "G43 X1",
            "part.ngc:1:1: G43 is not supported in this dialect",
        ),
        (
            "X=_NO",
            "part.ngc:1:3: parameter #<_no> has no value: it was never set here",
        ),
        (
            "_NO=5",
            "part.ngc:1:1: _NO is not supported in this dialect",
        ),
        (
            "CYCLE800(1,2)",
            "part.ngc:1:1: CYCLE800 with arguments is not supported in this dialect",
        ),
        (
            "G0 X=(1+2",
            "part.ngc:1:6: \"[\" is not closed: an operator or \"]\" is missing",
        ),
        ("G0 X1/0 !", "part.ngc:1:6: character '/' begins no word"),
    ] {
        let shown = try_read(text).unwrap_err().to_string();
        assert_eq!(shown, expected, "{text:?}");
    }
}

#[test]
fn blocks_run_as_their_conditions_say() {
    let text = "DEF INT A=2\nIF A==1\nG0 X1\nELSE\nIF (A>1) AND NOT (A>=3)\nX2\nENDIF\nX3\nENDIF\n\
                IF A<>2\nX4\nENDIF\nX5\n";
    let text = text.replacen("X2", "G0 X2", 1);
    assert_ends(&text, &[[2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [5.0, 0.0, 0.0]]);
}

#[test]
fn loops_run_as_often_as_they_should() {
    let x = |text: &str| -> Vec<f64> { ends(text).iter().map(|end| end[0]).collect() };
    let counted = "DEF INT I\nFOR I = 1 TO 3\nG0 X=I\nENDFOR\nX=I*10\n";
    assert_eq!(x(counted), [1.0, 2.0, 3.0, 40.0], "FOR");
    assert_eq!(
        x("DEF INT I\nFOR I=2 TO 1\nG0 X1\nENDFOR\nG0 X9\n"),
        [9.0],
        "no turn"
    );
    let nested =
        "R1=0\nWHILE R1<2\nR1=R1+1 R2=0\nREPEAT\nR2=R2+1\nG0 X=R1*10+R2\nUNTIL R2==2\nENDWHILE\n";
    assert_eq!(x(nested), [11.0, 12.0, 21.0, 22.0], "WHILE and REPEAT");
    let endless = "R1=0\nLOOP\nR1=R1+1\nG0 X=R1\nIF R1>=3 GOTOF OUT\nENDLOOP\nOUT: X9\n";
    assert_eq!(x(endless), [1.0, 2.0, 3.0, 9.0], "LOOP, left by a jump");
    let twice = "R2=0\nAGAIN: R2=R2+1\nDEF INT I\nFOR I=1 TO 2\nG0 X=R2*10+I\nENDFOR\nIF R2<2 GOTOB AGAIN\n";
    assert_eq!(
        x(twice),
        [11.0, 12.0, 21.0, 22.0],
        "a loop in a loop of jumps"
    );
}

#[test]
fn jumps_find_marks_and_block_numbers() {
    let x = |text: &str| -> Vec<f64> { ends(text).iter().map(|end| end[0]).collect() };
    assert_eq!(
        x("N10 G0 X1\nGOTOF N040\nN30 X3\nN40 X4\n"),
        [1.0, 4.0],
        "number"
    );
    let text = "R1=0\nN10 UP_1: G0 X=R1\nR1=R1+1\nIF R1<3 GOTOB up_1\nM30\n";
    assert_eq!(x(text), [0.0, 1.0, 2.0], "back, words behind the mark");
    let both = "GOTO THERE\nHERE: G0 X2\nM30\nTHERE: G0 X1\nGOTO HERE\n";
    assert_eq!(x(both), [1.0, 2.0], "either way");
    let chain = "R1=2\nIF R1==1 GOTOF ONE IF R1==2 GOTOF TWO\nG0 X0\nONE: G0 X1\nTWO: G0 X2\n";
    assert_eq!(x(chain), [2.0], "one of several");
    assert_eq!(x("GOTOC NOWHERE\nG0 X1\n"), [1.0], "GOTOC goes on");
}

#[test]
fn expressions_know_functions_comparisons_and_parameters_by_index() {
    let x = |text: &str| ends(&format!("R1=3 R[2]=4\nG0 X={text}\n"))[0][0];
    for (text, expected) in [
        ("R[R1-1]+R1", 7.0),
        ("7 DIV 2 + 7 MOD 4", 6.0),
        ("ATAN2(30,80)", 20.556_045_219_583_467),
        ("ASIN(0.5)+ACOS(0.5)", 90.0),
        ("POT(R1)+SQRT(R[2])", 11.0),
        (
            "MINVAL(3,2)+MAXVAL(3,2)+TRUNC(2.7)+ROUND(2.5)+ROUNDUP(2.1)",
            13.0,
        ),
        ("LN(EXP(2))", 2.0),
        ("(R1==3)+(R1<2)+TRUE-FALSE", 2.0),
        ("1==1 AND 0", 0.0),
        ("(1==1) XOR (2==2) OR NOT 0", 1.0),
    ] {
        assert!((x(text) - expected).abs() < CLOSE, "{text}: {}", x(text));
    }
}

#[test]
fn compensation_begins_on_the_normal_of_the_contour() {
    use toolglide_program::{Tool, ToolTable};
    let mut tools = ToolTable::parse("T3 P1 Z10 D6 ;mill_6\n").unwrap();
    assert_eq!(tools.named("MILL_6"), Some(3), "by its remark");
    let read = |text: &str, tools: ToolTable| {
        Poses::new(text.as_bytes(), FILE, settings(), Language::Sinumerik)
            .with_tools(tools)
            .map(|step| match step.map(|step| *step.end()) {
                Ok(PoseEnd::Axes { linear, .. }) => [linear[0], linear[1]],
                other => panic!("{other:?}"),
            })
            .collect::<Vec<_>>()
    };
    let text = "T=\"MILL_6\" M6 D1\nG0 X-20 Y-10\nG41 G1 X0 Y0 F600\nX0 Y30\nG40 X-20\nM30\n";
    let expected = [[-20.0, -10.0], [-3.0, 0.0], [-3.0, 30.0], [-20.0, 30.0]];
    let close = |found: Vec<[f64; 2]>, expected: &[[f64; 2]]| {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (one, other) in found.iter().zip(expected) {
            let off = (one[0] - other[0]).hypot(one[1] - other[1]);
            assert!(off < CLOSE, "{found:?}");
        }
    };
    close(read(text, tools.clone()), &expected);
    let (offset, diameter) = (Vector::zeros(), 2.0);
    tools.set(7, Tool { offset, diameter });
    let by_number = text.replace("T=\"MILL_6\"", "T7");
    close(
        read(&by_number, tools),
        &[[-20.0, -10.0], [-1.0, 0.0], [-1.0, 30.0], [-20.0, 30.0]],
    );
}

#[test]
fn polar_words_and_words_without_effect_are_read() {
    assert_ends(
        "WORKPIECE(,,,\"BOX\",112,0,-20,-80,0,0,100,100)\nG290 G450 G500 DYNFINISH\nG0 RP=5 AP=90\nSPOS=30\nPROC A(INT B)\nMCALL\nRET\nG0 X9\n",
        &[[0.0, 5.0, 0.0]],
    );
}

#[test]
fn what_is_known_but_not_read_is_refused_with_its_kind() {
    for (text, expected) in [
        (
            "G0 X1\nCYCLE83(5,0,1,-10)",
            "2:1: CYCLE83 is not supported: cycles",
        ),
        (
            "MCALL CYCLE81(1,2)",
            "1:1: MCALL is not supported: calls of subprograms",
        ),
        (
            "G1 X1 RND=2 F9",
            "1:7: RND is not supported: rounding between blocks",
        ),
        (
            "R1=$AA_IM[X]",
            "1:4: $AA_IM is not supported: variables of the system",
        ),
        (
            "$P_UIFR[1]=0",
            "1:1: $P_UIFR is not supported: variables of the system",
        ),
        ("MIRROR X0", "1:1: MIRROR is not supported: mirrored frames"),
        ("G451", "1:1: G451 is not supported in this dialect"),
        ("GOTOF OUT", "1:7: there is no line OUT to jump to"),
        (
            "WHILE 1==1\nG0 X1",
            "1:1: WHILE is not closed: ENDWHILE is missing",
        ),
        ("G0 X1\nENDFOR", "2:1: ENDFOR without its FOR"),
        (
            "IF 1==1 X5\nENDIF",
            "1:9: X5 is not supported in this dialect",
        ),
        ("FOR I=1 X 2\nENDFOR", "1:9: character 'X' begins no word"),
        ("ELSE", "1:1: IF is not closed: ENDIF is missing"),
    ] {
        let refused = try_read(text).unwrap_err().to_string();
        assert_eq!(refused, format!("{FILE}:{expected}"), "{text:?}");
    }
}

#[test]
fn a_loop_without_end_ends_with_an_error() {
    let (changes_nothing, counts) = ("nothing changed", "without a move");
    for (text, expected) in [
        ("LOOP\nENDLOOP\n", changes_nothing),
        ("AGAIN: G4 F0\nGOTOB AGAIN\n", changes_nothing),
        ("AGAIN: G0 X1\nX0\nGOTOB AGAIN\n", changes_nothing),
        ("WHILE TRUE\nG1 F100 X=10\nX0\nENDWHILE\n", changes_nothing),
        (
            "R1=0\nREPEAT\nG91 G0 X1\nG90 X0\nUNTIL R1==5\n",
            changes_nothing,
        ),
        ("R1=0\nLOOP\nR1=R1+1\nENDLOOP\n", counts),
        ("DEF INT I\nFOR I=1 TO 100000000\nG0 X0\nENDFOR\n", counts),
    ] {
        let mut poses = Poses::new(text.as_bytes(), FILE, settings(), Language::Sinumerik);
        let refused = poses.find_map(Result::err).expect("an end").to_string();
        assert!(refused.contains(expected), "{text:?}: {refused}");
    }
    let text = "R1=0\nDEF INT I\nFOR I=1 TO 300\nG0 X1\nX0\nENDFOR\nLOOP\nX1\nX0\nR1=R1+1\nIF R1>300 GOTOF OUT\nENDLOOP\nOUT: X9\n";
    assert_eq!(try_read(text).unwrap().len(), 1203, "loops that end");
}

#[test]
fn refusals_within_loops_do_not_go_on_for_ever() {
    for text in [
        "WHILE R9<2\nG0 X1\nENDWHILE\n",
        "DEF INT I\nFOR I=1 TO R9\nG0 X1\nENDFOR\n",
        "R1=0\nWHILE R1<2\nR1=R1+R9\nENDWHILE\n",
        "AGAIN: G0 X1\nR1=R9\nGOTOB AGAIN\n",
    ] {
        let poses = Poses::new(text.as_bytes(), FILE, settings(), Language::Sinumerik);
        let refused = poses.past_refusals().filter(Result::is_err).count();
        assert!((1..=1001).contains(&refused), "{text:?}: {refused}");
    }
}

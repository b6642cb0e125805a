//! Checks the reading of any text.

use toolglide_kinematics::{Path, PoseEnd, Tolerance, Vector};
use toolglide_program::{Language, Poses, Program, ProgramError, Settings, Tool, ToolTable};

/// Moves after which a program is long enough.
const ENOUGH: usize = 20_000;

/// Rounding of coordinates, mm, for each mm of them.
const ROUNDING: f64 = 1e-9;

fn settings(lenient: bool) -> Settings {
    let tolerance = Tolerance::new(0.01).expect("positive");
    Settings {
        lenient,
        steps: 2_000,
        still_steps: 1_000,
        ..Settings::new(tolerance)
    }
}

fn tools() -> ToolTable {
    let mut table = ToolTable::new();
    for number in 1..4 {
        let offset = Vector::<3>::new(0.0, 0.0, f64::from(number));
        let diameter = 0.5 * f64::from(number);
        table.set(number, Tool { offset, diameter });
    }
    table
}

/// Reads a text to the end; which way depends on the text.
pub fn read(text: &[u8]) {
    let way = text.iter().fold(0_u32, |sum, &byte| {
        sum.wrapping_mul(31).wrapping_add(byte.into())
    });
    match way % 7 {
        0 | 1 => read_moves(text, false, Language::Ngc),
        2 => read_moves(text, true, Language::Ngc),
        4 => read_moves(text, false, Language::Fanuc),
        5 => read_moves(text, true, Language::Fanuc),
        3 => {
            read_poses(text, Language::Ngc);
            read_poses(text, Language::Sinumerik);
            read_poses(text, Language::Fanuc);
        }
        _ => read_poses(text, Language::CutterLocations),
    }
}

fn read_moves(text: &[u8], lenient: bool, language: Language) {
    // Recognising a language ends, whatever the text.
    let _ = Language::of(std::path::Path::new("fuzz"), text);
    let mut program = Program::new(text, "fuzz", settings(lenient))
        .in_language(language)
        .with_tools(tools())
        .with_subroutines(|name| {
            Ok(match name {
                "sub" => Some(b"o<sub> sub\nG1X1\no<sub> endsub".to_vec()),
                "O0003" => Some(b"%\nO3\nG1X#1\nM99\n%".to_vec()),
                _ => None,
            })
        });
    if lenient {
        program = program
            .with_rotary_axes()
            .with_secondary_axes()
            .past_refusals();
    }
    let mut at = Vector::<3>::zeros();
    for step in program.by_ref().take(ENOUGH) {
        match step {
            Ok(step) => {
                if let (Path::Arc(arc), false) = (step.path(), lenient) {
                    let room = ROUNDING * (1.0 + at.norm());
                    assert!((arc.start() - at).norm() <= room, "an arc begins elsewhere");
                }
                at = step.end(at);
                assert!(at.iter().all(|value| value.is_finite()), "finite");
                assert!(step.feedrate().speed() > 0.0, "speed");
            }
            Err(error) => told(&error),
        }
    }
}

fn read_poses(text: &[u8], language: Language) {
    for step in Poses::new(text, "fuzz", settings(false), language).take(ENOUGH) {
        match step {
            Ok(step) => {
                if let PoseEnd::Pose(pose) = step.end() {
                    assert!(pose.tip().iter().all(|value| value.is_finite()), "finite");
                }
            }
            Err(error) => told(&error),
        }
    }
}

fn told(error: &ProgramError) {
    assert!(error.line() >= 1 && error.column() >= 1, "counted from 1");
    assert!(error.length() >= 1, "a caret has a width");
    assert!(!error.to_string().is_empty(), "message");
}

//! Lists the programs whose planning is measured: those at hand beside the project, the examples, and paths that
//! are hard on a planner, made up.

use std::fmt::Write;
use std::path::Path;
use toolglide_kinematics::Move;
use toolglide_tests::corpus;

/// Tolerance where nothing else is said, mm.
const TOLERANCE: f64 = 0.01;

/// Tolerance beyond what machines resolve, mm.
const EXTREME: f64 = 1e-7;

/// Where the examples lie.
const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples");

/// A program and the tolerance that it is planned within.
pub(crate) struct Program {
    pub(crate) name: String,
    tolerance: f64,
    text: Vec<u8>,
}

impl Program {
    fn made(name: &str, tolerance: f64, text: String) -> Self {
        Self {
            name: format!("made/{name}"),
            tolerance,
            text: text.into_bytes(),
        }
    }

    /// The moves; `None` where the program is refused.
    pub(crate) fn moves(&self) -> Option<Vec<Move<3>>> {
        corpus::moves(&self.text, &self.name, self.tolerance).ok()
    }
}

/// All programs.
pub(crate) fn programs() -> Vec<Program> {
    let mut programs = made();
    programs.extend(examples());
    for name in corpus::names()
        .into_iter()
        .chain(corpus::names_in("faults"))
    {
        if let Some(text) = corpus::text(&name) {
            programs.push(Program {
                name,
                tolerance: TOLERANCE,
                text,
            });
        }
    }
    programs
}

fn examples() -> Vec<Program> {
    let mut programs = Vec::new();
    for name in ["bracket", "corner", "dome", "helix_bore", "star"] {
        let file = Path::new(EXAMPLES).join(format!("{name}.ngc"));
        let Ok(text) = std::fs::read(file) else {
            continue;
        };
        for tolerance in [TOLERANCE, EXTREME] {
            programs.push(Program {
                name: format!("examples/{name}, {tolerance:e} mm"),
                tolerance,
                text: text.clone(),
            });
        }
    }
    programs
}

/// Numbers between 0 and 1 that look random, always the same.
struct Shares(f64);

impl Shares {
    fn next(&mut self) -> f64 {
        self.0 = (self.0 + 0.618_033_988_75).fract();
        self.0
    }
}

/// Paths that are hard on a planner.
fn made() -> Vec<Program> {
    let mut programs = vec![
        Program::made(
            "semicircles of 0.02 mm",
            TOLERANCE,
            waves(3_000, 0.02, 0.02, 0.55),
        ),
        Program::made(
            "arcs of 0.2 to 0.5 mm",
            TOLERANCE,
            waves(2_000, 0.2, 0.5, 0.58),
        ),
        Program::made(
            "arcs of 0.2 to 0.5 mm, 0.1 mm",
            0.1,
            waves(2_000, 0.2, 0.5, 0.58),
        ),
        Program::made("arcs of 2 to 5 mm", TOLERANCE, waves(1_000, 2.0, 5.0, 0.7)),
        Program::made(
            "arcs of 20 to 50 mm",
            TOLERANCE,
            waves(200, 20.0, 50.0, 0.7),
        ),
        Program::made("slots", TOLERANCE, slots(500)),
        Program::made("helices", TOLERANCE, helices(40)),
        Program::made("feeds that alternate", TOLERANCE, feeds(4_000, 0.2, 0.3)),
        Program::made(
            "feeds that differ by 0.01 %",
            TOLERANCE,
            feeds(4_000, 0.2, 1e-4),
        ),
        Program::made("square of 50 mm moves", TOLERANCE, square(400)),
        Program::made("zigzag", TOLERANCE, zigzag(2_000)),
        Program::made("raster of 169,000 moves", TOLERANCE, raster(9_170, 169_000)),
    ];
    for tolerance in [1e-5, EXTREME] {
        programs.push(Program::made(
            &format!("arcs of 2 to 5 mm, {tolerance:e} mm"),
            tolerance,
            waves(100, 2.0, 5.0, 0.7),
        ));
    }
    programs
}

/// Arcs that bulge to either side in turn, over chords of two lengths and what is between them, and with a
/// radius that is a share of the chord.
fn waves(count: u32, least: f64, most: f64, share: f64) -> String {
    let mut text = String::from("G21 G90 F3000\nG0 X0 Y0\n");
    let (mut x, mut shares) = (0.0, Shares(0.0));
    for number in 0..count {
        let chord = least + (most - least) * shares.next();
        x += chord;
        let word = 2 + number % 2;
        writeln!(text, "G{word} X{x:.5} Y0 R{:.5}", share * chord + 5e-6).unwrap();
    }
    text
}

/// Slots: two lines and two half circles each.
fn slots(count: u32) -> String {
    let mut text = String::from("G21 G90 F2000\nG0 X0 Y0\n");
    for number in 0..count {
        let x = 8.0 * f64::from(number % 20);
        let y = 6.0 * f64::from(number / 20);
        writeln!(
            text,
            "G0 X{x} Y{y}\nG1 X{}\nG3 Y{} J1.5\nG1 X{x}\nG3 Y{y} J-1.5",
            x + 5.0,
            y + 3.0
        )
        .unwrap();
    }
    text
}

/// Helices of five turns with a way up.
fn helices(count: u32) -> String {
    let mut text = String::from("G21 G90 F1500\nG0 X0 Y0 Z0\n");
    for number in 0..count {
        let x = 12.0 * f64::from(number);
        writeln!(text, "G0 X{x} Y0 Z0").unwrap();
        for turn in 1..=5 {
            writeln!(text, "G2 X{x} Y0 Z{:.2} I3 J0", -0.5 * f64::from(turn)).unwrap();
        }
    }
    text
}

/// Chords of a wave whose feedrate changes from block to block.
fn feeds(count: u32, length: f64, change: f64) -> String {
    let mut text = String::from("G21 G90\nG0 X0 Y0\n");
    let mut shares = Shares(0.0);
    for number in 1..=count {
        let x = length * f64::from(number);
        let feed = 2_500.0 * (1.0 + change * shares.next());
        writeln!(text, "G1 X{x:.4} Y{:.4} F{feed:.3}", 8.0 * (0.1 * x).sin()).unwrap();
    }
    text
}

/// Moves of 50 mm that meet at right angles.
fn square(count: u32) -> String {
    let mut text = String::from("G21 G90 F6000\nG0 X0 Y0\n");
    for number in 0..count {
        let (x, y) = [(50, 0), (50, 50), (0, 50), (0, 0)][number as usize % 4];
        writeln!(text, "G1 X{x} Y{y}").unwrap();
    }
    text
}

/// Moves of 2 to 5 mm that meet at all angles.
fn zigzag(count: u32) -> String {
    let mut text = String::from("G21 G90 F6000\nG0 X0 Y0\n");
    let (mut x, mut y) = (0.0, 0.0);
    let (mut angles, mut lengths) = (Shares(0.0), Shares(0.3));
    for _ in 0..count {
        let angle = std::f64::consts::TAU * angles.next();
        let length = 2.0 + 3.0 * lengths.next();
        x += length * angle.cos();
        y += length * angle.sin();
        writeln!(text, "G1 X{x:.4} Y{y:.4}").unwrap();
    }
    text
}

/// A finished surface: short lines, among them small arcs, in rows.
fn raster(arcs: u32, moves: u32) -> String {
    let mut text = String::from("G21 G90 F4000\nG0 X0 Y0 Z0\n");
    let mut shares = Shares(0.0);
    let (mut x, mut way) = (0.0, 1.0);
    let (mut row, mut arc) = (0.0_f64, 0_u32);
    for number in 0..moves {
        let length = 0.1 + 0.4 * shares.next();
        x += way * length;
        let z = 2.0 * (0.15 * x).sin() * (0.1 * row).cos();
        if u64::from(number) * u64::from(arcs) / u64::from(moves) >= u64::from(arc) {
            arc += 1;
            writeln!(
                text,
                "G18 G{} X{x:.4} Y{row:.2} Z{z:.4} R{:.4}",
                2 + arc % 2,
                3.0 * length
            )
            .unwrap();
        } else {
            writeln!(text, "G1 X{x:.4} Z{z:.4}").unwrap();
        }
        if x.abs() > 80.0 && x * way > 0.0 {
            way = -way;
            row += 0.2;
            writeln!(text, "G1 Y{row:.2}").unwrap();
        }
    }
    text
}

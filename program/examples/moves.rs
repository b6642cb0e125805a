//! Reads a part program and prints its moves, one a line, with all digits: what another reader of the
//! language can be compared with.
//!
//! Columns: line, `rapid` `feed` `arc` or `dwell`, feedrate in mm/s, end X Y Z in mm; for an arc also its
//! centre X Y Z, its axis, and its sweep in rad.

use std::io::{BufReader, BufWriter, Write};
use toolglide_kinematics::{Feedrate, Path, Tolerance, Vector};
use toolglide_program::{Program, Settings, ToolTable};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("usage: moves PROGRAM [TOOLS]")?;
    let settings = Settings::new(Tolerance::new(0.01)?);
    let reader = BufReader::new(std::fs::File::open(&file)?);
    let mut program = Program::new(reader, &file, settings);
    if let Some(tools) = arguments.next() {
        program = program.with_tools(ToolTable::parse(&std::fs::read_to_string(tools)?)?);
    }
    let mut out = BufWriter::new(std::io::stdout().lock());
    let mut at = Vector::<3>::zeros();
    for step in program {
        // As people read it, not as programs print it.
        let step = step.map_err(|refused| refused.to_string())?;
        let end = step.end(at);
        let kind = match step.path() {
            Path::Arc(_) => "arc",
            Path::Dwell { .. } => "dwell",
            _ if step.feedrate() == Feedrate::RAPID => "rapid",
            _ => "feed",
        };
        let speed = step.feedrate().speed();
        write!(out, "{} {kind} {speed:e}", step.line())?;
        write!(out, " {:e} {:e} {:e}", end[0], end[1], end[2])?;
        if let Path::Arc(arc) = step.path() {
            let center = arc.center();
            let (radial, lateral) = arc.frame();
            let axis = radial.cross(&lateral);
            let axis = axis.iamax();
            write!(out, " {:e} {:e} {:e}", center[0], center[1], center[2])?;
            write!(out, " {axis} {:e}", arc.sweep())?;
        }
        writeln!(out)?;
        at = end;
    }
    Ok(())
}

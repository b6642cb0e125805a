//! Programs made by others.

use toolglide_kinematics::Tolerance;
use toolglide_program::{Program, Settings};
#[test]
fn survey() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/gcode");
    for sub in [
        "corpus/camotics",
        "corpus/cncjs",
        "corpus/gcode-preview",
        "corpus/linuxcnc",
        "corpus/pcb2gcode",
        "corpus/siemens-5ax",
        "corpus/tinyg",
        "corpus/ugs",
        "bench",
    ] {
        let mut files: Vec<_> = std::fs::read_dir(format!("{root}/{sub}"))
            .unwrap()
            .map(|f| f.unwrap().path())
            .collect();
        files.sort();
        for f in files {
            let file = std::io::BufReader::new(std::fs::File::open(&f).unwrap());
            let mut p = Program::new(
                file,
                f.file_name().unwrap().to_str().unwrap(),
                Settings::new(Tolerance::new(0.01).unwrap()),
            );
            let mut n = 0;
            let mut err = None;
            for m in &mut p {
                match m {
                    Ok(_) => n += 1,
                    Err(e) => err = Some(e),
                }
            }
            println!(
                "{sub} {:?} moves {n} lines {} blocks {} {:?}",
                f.file_name().unwrap(),
                p.lines(),
                p.blocks(),
                err.map(|e| e.to_string())
            );
            for w in p.warnings() {
                println!("   W {w}");
            }
        }
    }
}

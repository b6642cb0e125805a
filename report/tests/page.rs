//! Writes pages and checks what stands in them.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use sha2::{Digest, Sha256};
use toolglide_kinematics::{Feedrate, Limits, Move, MoveRange, Piece, Sample, Tolerance, Vector};
use toolglide_report::{AxisInfo, MAX_PIECES, MotionRecorder, Page, PathRecorder};

fn page(pieces: usize, title: &str, program: &[u8]) -> String {
    let limits = Limits::<2>::uniform(100.0, 1e3, 1e4).unwrap();
    let mut path = PathRecorder::starting_at(Vector::zeros());
    let (feedrate, tolerance) = (Feedrate::new(10.0).unwrap(), Tolerance::new(0.01).unwrap());
    #[allow(clippy::cast_precision_loss, reason = "small counts")]
    let far = Vector::<2>::new(0.01 * pieces as f64, 0.0);
    let one = Move::line_to(far, feedrate, tolerance).unwrap();
    path.expect(&one.from_line(3));
    let mut motion = MotionRecorder::new(limits);
    let mut at = Vector::<2>::zeros();
    for _ in 0..pieces {
        let start = Sample {
            velocity: Vector::<2>::new(10.0, 0.0),
            ..Sample::at_rest(at)
        };
        at += Vector::<2>::new(0.01, 0.0);
        motion.observe(
            &path,
            &Piece::new(&start, 0.001, at, MoveRange::one(0)),
            0.0,
        );
    }
    let axes = ['X', 'Y'].map(|name| AxisInfo { name, unit: "mm" });
    let motions = [motion.finish("kcs", true, "every limit and tolerance is kept", [0.0; 2])];
    let page = Page {
        title,
        machine: "gantry",
        axes: &axes,
        limits,
        path: &path,
        motions: &motions,
        program,
    };
    let mut out = Vec::new();
    page.write(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

#[test]
fn a_page_asks_no_network_and_leaves_no_mark_unfilled() {
    let text = page(10, "part.ngc", b"G1 X0.1");
    assert!(
        text.contains("default-src 'none'"),
        "its policy forbids requests"
    );
    for mark in [
        "@@TITLE@@",
        "@@META@@",
        "@@DATA@@",
        "@@SCRIPTS@@",
        "@@STYLES@@",
    ] {
        assert!(!text.contains(mark), "{mark}");
    }
    for loads in ["<link", "src=\"", "@import", "url(", "fetch("] {
        assert!(!text.contains(loads), "{loads}");
    }
}

#[test]
fn neither_title_nor_program_can_end_a_script() {
    let text = page(1, "</script><b>.ngc", b"(</script>)");
    assert_eq!(
        text.matches("</script>").count(),
        3,
        "only the page's own three"
    );
    assert!(
        text.contains("<title>&lt;/script&gt;&lt;b&gt;.ngc"),
        "as text"
    );
}

#[test]
fn a_motion_without_pieces_makes_a_page() {
    assert!(
        page(0, "none.ngc", b"").contains("\"cycle_time\":0.0"),
        "it lasts no time"
    );
}

#[test]
fn a_motion_of_too_many_pieces_becomes_an_envelope() {
    let few = page(MAX_PIECES, "few.ngc", b"");
    assert!(!few.contains("\"envelope_width\":"), "each piece is kept");
    let many = page(MAX_PIECES + 1, "many.ngc", b"");
    assert!(many.contains("\"envelope_width\":"), "the page says so");
}

#[test]
fn the_chart_library_is_the_one_that_was_vendored() {
    let digest = |bytes: &[u8]| {
        let hash = Sha256::digest(bytes);
        hash.iter()
            .map(|byte| format!("{byte:02x}"))
            .collect::<String>()
    };
    assert_eq!(
        digest(include_bytes!("../assets/uPlot.iife.min.js")),
        "19c8d4c6ad88929a79f4ae49d6f7161566dfd0ba3d15cc495e974f787eb78f1f",
        "uPlot 1.6.32"
    );
}

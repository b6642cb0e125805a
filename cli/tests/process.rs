//! The binary itself: exit codes, broken pipes, interruption.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

const BINARY: &str = env!("CARGO_BIN_EXE_toolglide");

/// A program that takes a while to plan and to write.
fn long_program(folder: &std::path::Path) -> std::path::PathBuf {
    let mut text = String::from("G64 P0.01\nG1 F600\n");
    for step in 0..4_000 {
        text.push_str(&format!("X{} Y{}\n", step % 50, step % 3));
    }
    let path = folder.join("long.ngc");
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_reader_that_goes_away_is_no_mistake() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = Command::new(BINARY)
        .args([
            "plan",
            long_program(folder.path()).to_str().unwrap(),
            "-o",
            "-",
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = String::new();
    let mut reader = BufReader::new(child.stdout.take().unwrap());
    reader.read_line(&mut first).unwrap();
    assert_eq!(first, "t_s,x_mm,y_mm,z_mm\n");
    drop(reader);
    let mut err = String::new();
    child
        .stderr
        .take()
        .unwrap()
        .read_to_string(&mut err)
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0), "{err}");
    assert_eq!(err, "", "quiet");
}

#[test]
fn wrong_use_exits_with_two() {
    let status = Command::new(BINARY)
        .args(["plan", "no-such-program.ngc"])
        .stderr(Stdio::null())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(2));
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_run_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let program = long_program(folder.path());
    let output = folder.path().join("motion.csv");
    let mut child = Command::new(BINARY)
        .args(["plan", program.to_str().unwrap(), "--period", "1e-7", "-o"])
        .arg(&output)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // The file beside the place of the output shows that the run is at work.
    while std::fs::read_dir(folder.path()).unwrap().count() < 2 {
        assert!(
            child.try_wait().unwrap().is_none(),
            "it takes longer than that"
        );
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let killed = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success(), "the signal is sent");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        1,
        "only the program"
    );
}

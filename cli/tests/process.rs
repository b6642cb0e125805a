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

/// A run of the command that ends with the test.
#[cfg(target_os = "linux")]
struct Run(std::process::Child);

#[cfg(target_os = "linux")]
impl Drop for Run {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[cfg(target_os = "linux")]
impl Run {
    /// Starts the command and waits until it waits for signals.
    fn start(folder: &std::path::Path, arguments: &[&str], stdin: Stdio) -> Self {
        Self::begin(folder, arguments, stdin, Stdio::piped())
    }

    fn begin(folder: &std::path::Path, arguments: &[&str], stdin: Stdio, stderr: Stdio) -> Self {
        let child = Command::new(BINARY)
            .args(arguments)
            .current_dir(folder)
            .stdin(stdin)
            .stdout(Stdio::piped())
            .stderr(stderr)
            .spawn()
            .unwrap();
        let mut run = Self(child);
        let status = format!("/proc/{}/status", run.0.id());
        run.wait_until("it waits for signals", |_| {
            let status = std::fs::read_to_string(&status).unwrap_or_default();
            let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
            let caught = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
            // SIGINT is 2, SIGTERM 15.
            caught.is_some_and(|mask| mask & (1 << 1) != 0 && mask & (1 << 14) != 0)
        });
        run
    }

    /// Waits, and far longer than it should take.
    fn wait_until(&mut self, what: &str, mut reached: impl FnMut(&mut Self) -> bool) {
        for _ in 0..60_000 {
            if reached(self) {
                return;
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        panic!("{what}: not within a minute");
    }

    /// Sends one signal, and gives the exit code and the last line on standard error.
    fn end_by(&mut self, signal: &str) -> (Option<i32>, String) {
        assert_eq!(self.0.try_wait().unwrap(), None, "still at work");
        let id = self.0.id().to_string();
        let sent = Command::new("kill").args([signal, &id]).status().unwrap();
        assert!(sent.success(), "the signal is sent");
        let mut code = None;
        self.wait_until("it ends", |run| {
            code = run.0.try_wait().unwrap();
            code.is_some()
        });
        let mut text = String::new();
        if let Some(mut err) = self.0.stderr.take() {
            err.read_to_string(&mut text).unwrap();
        }
        let last = text.lines().last().unwrap_or_default().to_owned();
        (code.unwrap().code(), last)
    }
}

#[cfg(target_os = "linux")]
fn names(folder: &std::path::Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

#[cfg(target_os = "linux")]
fn pipe(folder: &std::path::Path, name: &str) {
    let made = Command::new("mkfifo").arg(folder.join(name)).status();
    assert!(made.unwrap().success(), "a pipe is made");
}

#[cfg(target_os = "linux")]
const SAYS: &str = "toolglide: interrupted; nothing was written";

#[cfg(target_os = "linux")]
#[test]
fn one_signal_ends_every_command_wherever_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    long_program(path);
    // A hundred right angles keep the solver of the reference busy for minutes.
    let zigzag: String = (0..100)
        .map(|step| format!("X{} Y{}\n", 10 * ((step + 1) / 2), 10 * (step / 2)))
        .collect();
    std::fs::write(path.join("zigzag.ngc"), format!("G1 F6000\n{zigzag}")).unwrap();
    // Nobody writes into this one.
    pipe(path, "silent.ngc");
    let before = names(path);
    for (arguments, signal, code) in [
        (&["check", "silent.ngc"][..], "-INT", 130),
        (&["check", "-"], "-TERM", 143),
        (
            &["plan", "silent.ngc", "--dialect", "ngc", "-o", "a.csv"],
            "-TERM",
            143,
        ),
        (
            &["plan", "-", "-o", "a.csv", "--plot", "a.svg"],
            "-INT",
            130,
        ),
        (
            &["plan", "zigzag.ngc", "--method", "reference", "-o", "a.csv"],
            "-INT",
            130,
        ),
        (
            &["score", "zigzag.ngc", "--plot", "a.svg", "--methods", "kcs"],
            "-TERM",
            143,
        ),
        (&["compare", "-", "--plot", "a.svg"], "-HUP", 129),
        (&["spectrum", "-", "--mode", "X,30"], "-INT", 130),
        (&["verify", "silent.ngc", "long.ngc"], "-INT", 130),
        // Nobody reads what it writes.
        (
            &["plan", "long.ngc", "--period", "1e-6", "-o", "-"],
            "-INT",
            130,
        ),
        (
            &["plan", "long.ngc", "--period", "1e-7", "-o", "a.csv"],
            "-TERM",
            143,
        ),
        (
            &[
                "plan", "long.ngc", "--method", "optimal", "--period", "1e-7", "-o", "a.csv",
            ],
            "-INT",
            130,
        ),
    ] {
        let mut run = Run::start(path, arguments, Stdio::piped());
        if let Some(file) = arguments.iter().find(|word| word.starts_with("a.")) {
            let part = path.join(format!(".{file}.part"));
            run.wait_until("the file is begun", |_| part.exists());
        }
        assert_eq!(
            run.end_by(signal),
            (Some(code), SAYS.to_owned()),
            "{arguments:?}"
        );
        assert_eq!(names(path), before, "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_ends_a_run_whose_messages_nobody_reads() {
    use std::io::Write;
    use std::os::unix::fs::OpenOptionsExt;
    const WITHOUT_WAITING: i32 = 0o4000;
    let folder = tempfile::tempdir().unwrap();
    pipe(folder.path(), "messages");
    let messages = folder.path().join("messages");
    let mut options = std::fs::File::options();
    options.read(true).write(true);
    let mut full = options
        .custom_flags(WITHOUT_WAITING)
        .open(&messages)
        .unwrap();
    while full.write(&[b'.'; 4096]).is_ok() {}
    while full.write(b".").is_ok() {}
    std::fs::write(folder.path().join("wrong.ngc"), "G1 X1 F[\n").unwrap();
    let stderr = std::fs::File::options().write(true).open(&messages);
    let mut run = Run::begin(
        folder.path(),
        &["check", "wrong.ngc"],
        Stdio::null(),
        stderr.unwrap().into(),
    );
    let stat = format!("/proc/{0}/task/{0}/stat", run.0.id());
    let mut asleep = 0;
    run.wait_until("it waits for a reader", |_| {
        let stat = std::fs::read_to_string(&stat).unwrap_or_default();
        asleep = if stat.contains(") S ") { asleep + 1 } else { 0 };
        asleep > 100
    });
    assert_eq!(run.end_by("-INT").0, Some(130));
}

#[cfg(target_os = "linux")]
#[test]
fn what_a_killed_run_leaves_is_used_by_the_next_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    long_program(path);
    let arguments = ["plan", "long.ngc", "--period", "1e-6", "-o", "a.csv"];
    let mut run = Run::start(path, &arguments, Stdio::null());
    let part = path.join(".a.csv.part");
    run.wait_until("rows are written", |_| {
        std::fs::metadata(&part).is_ok_and(|part| part.len() > 0)
    });
    // Another run does not write into the same file.
    let other = Command::new(BINARY)
        .args(arguments)
        .current_dir(path)
        .output()
        .unwrap();
    let said = String::from_utf8(other.stderr).unwrap();
    assert_eq!(other.status.code(), Some(2), "{said}");
    assert!(
        said.contains("a.csv: cannot be written: another run is writing it"),
        "{said}"
    );
    assert_eq!(run.end_by("-KILL").0, None, "killed");
    assert_eq!(names(path), [".a.csv.part", "long.ngc"], "left behind");
    let next = ["check", "plan"].map(|_| ["plan", "long.ngc", "-o", "a.csv"]);
    for arguments in next {
        let status = Command::new(BINARY)
            .args(arguments)
            .current_dir(path)
            .stdout(Stdio::null())
            .status()
            .unwrap();
        assert_eq!(status.code(), Some(0));
        assert_eq!(names(path), ["a.csv", "long.ngc"], "used");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_subroutine_that_is_no_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    pipe(path, "pipe.ngc");
    std::fs::create_dir(path.join("folder.ngc")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", path.join("device.ngc")).unwrap();
    for name in ["pipe", "folder", "device"] {
        std::fs::write(path.join("main.ngc"), format!("o<{name}> call\nM2\n")).unwrap();
        let run = Command::new(BINARY)
            .args(["plan", "main.ngc"])
            .current_dir(path)
            .output()
            .unwrap();
        let said = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(2), "{said}");
        assert!(
            said.contains("main.ngc:1:1: the file of subroutine"),
            "{said}"
        );
        assert!(said.contains("it is no file of text"), "{said}");
    }
}

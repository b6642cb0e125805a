//! Spectra of motions, and what is refused.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, toolglide};

/// The constructed star and the machine with two beams.
const STAR: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../examples/dissertation/starfish.ngc"
);
const BEAMS: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../examples/machines/beams.toml"
);

#[test]
fn filters_on_the_modes_leave_less_than_a_hundredth_of_what_stopping_leaves() {
    let methods = "fir,kcs,exact-stop";
    let run = toolglide(&[
        "spectrum",
        STAR,
        "--machine",
        BEAMS,
        "--methods",
        methods,
        "--json",
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let shown: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    let left = |method: usize, mode: usize| {
        shown["methods"][method]["modes"][mode]["left_um"]
            .as_f64()
            .unwrap()
    };
    for mode in 0..2 {
        assert!(
            left(0, mode) < 0.01 * left(1, mode),
            "mode {mode}: {} of {} µm",
            left(0, mode),
            left(1, mode)
        );
    }
    assert_eq!(
        shown["time_constants_s"],
        serde_json::json!([0.1351, 0.1087])
    );
    let frequencies = shown["frequencies_hz"].as_array().unwrap().len();
    let spectrum = &shown["methods"][0]["spectra"][1]["magnitudes_mm_s"];
    assert_eq!(spectrum.as_array().unwrap().len(), frequencies, "one each");
}

#[test]
fn the_picture_is_drawn_and_nothing_is_left_of_one_that_is_refused() {
    let folder = Folder::new();
    let picture = folder.name("spectrum.svg");
    let run = toolglide(&["spectrum", STAR, "--machine", BEAMS, "--plot", &picture]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        folder
            .read("spectrum.svg")
            .contains("Spectrum of the acceleration of Y")
    );
}

#[test]
fn modes_and_filters_that_cannot_be_are_refused_with_their_values() {
    for (options, said) in [
        (&[][..], "a spectrum needs a mode"),
        (
            &["--mode", "A,7.4"],
            "axis A was given, but the machine has axes XYZ",
        ),
        (&["--mode", "X,0"], "0 is not positive"),
        (&["--mode", "X,nan"], "NaN is not finite"),
        (&["--mode", "X,7,1.0"], "from 0 to below 1"),
        (
            &["--mode", "X,600"],
            "600 Hz was given, but half the frequency of the set-points is 500 Hz",
        ),
        (
            &["--mode", "7.4"],
            "does not begin with the letter of an axis",
        ),
        (
            &["--mode", "X,7.4", "--fir", "0.05"],
            "one filter alone, of 0.05 s, leaves jerk without a bound",
        ),
        (&["--mode", "X,7.4", "--fir", "0.05,0"], "0 is not positive"),
        (
            &["--mode", "X,7.4", "--fir", "0.05,-1"],
            "-1 is not positive",
        ),
        (&["--mode", "X,7.4", "--fir", "nan,1"], "NaN is not finite"),
        (
            &["--mode", "X,7.4", "--fir", "0.05,0.0001"],
            "shorter than half the period",
        ),
        (
            &["--mode", "X,7.4", "--fir", "1,1,1,1,1,1,1,1,1"],
            "a chain has 1 to 8 filters, but 9 were given",
        ),
    ] {
        let mut arguments = vec!["spectrum", STAR];
        arguments.extend(options);
        let run = toolglide(&arguments);
        assert_eq!(run.code, 2, "{options:?}: {}", run.err);
        assert!(run.err.contains(said), "{options:?}: {}", run.err);
        assert!(run.out.is_empty(), "{options:?}");
    }
}

#[test]
fn a_machine_file_gives_time_constants() {
    let folder = Folder::new();
    let text = std::fs::read_to_string(BEAMS).unwrap();
    let text = text.replace("period_s", "fir_s = [0.1, 0.08]\nperiod_s");
    let machine = folder.write("tuned.toml", text);
    let run = toolglide(&["spectrum", STAR, "--machine", &machine, "--methods", "fir"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.out.contains("filters of 100.0 and 80.0 ms"),
        "{}",
        run.out
    );
}

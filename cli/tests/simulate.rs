//! Simulated motions: errors, sweeps, set-points of others, and what is refused.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, toolglide};
use serde_json::Value;

const SIX: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../examples/dissertation/six_corners.ngc"
);
const STAGE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../examples/machines/xy_stage.toml"
);
const STAR: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../examples/dissertation/starfish.ngc"
);
const BEAMS: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../examples/machines/beams.toml"
);

/// A machine file of one gantry with these lines of drives.
fn machine(drives: &str) -> String {
    format!(
        "model = \"gantry\"\nname = \"m\"\ntolerance_mm = 0.05\nperiod_s = 0.001\n\n\
         [[axis]]\nname = \"X\"\nvelocity = 500\nacceleration = 2000\njerk = 1e5\n\n\
         [[axis]]\nname = \"Y\"\nvelocity = 500\nacceleration = 2000\njerk = 1e5\n\n{drives}\n"
    )
}

fn json(arguments: &[&str]) -> Value {
    let run = toolglide(&[arguments, &["--json"]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    serde_json::from_str(&run.out).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn jerk_buys_time_and_costs_error_on_the_part() {
    let shown = json(&[
        "simulate",
        SIX,
        "--machine",
        STAGE,
        "--sweep",
        "jerk=5e4,1e5,2e5",
    ]);
    let cases = shown["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 3, "{shown}");
    for pair in cases.windows(2) {
        let time = |case: &Value| number(&case["cycle_time_s"]);
        let error = |case: &Value| number(&case["servo"]["largest_um"]);
        assert!(time(&pair[1]) < time(&pair[0]), "{pair:?}");
        assert!(error(&pair[1]) > error(&pair[0]), "{pair:?}");
    }
    let servo = number(&cases[1]["servo"]["rms_um"]);
    assert!((3.0..5.0).contains(&servo), "{servo} µm as in table 2.1");
}

#[test]
fn a_stiff_loop_without_friction_leaves_in_a_mode_what_the_spectrum_says() {
    let folder = Folder::new();
    let beams = std::fs::read_to_string(BEAMS).unwrap();
    let stiff = "\n[drive]\nservo_period_s = 2e-5\nposition_gain = 2000\nvelocity_gain = 4800\nintegral_gain = 5.76e6\n\
                 feedforward = { velocity = 1, acceleration = 1 }\ncurrent_loop_hz = 50000\ndead_time_s = 0\n\
                 velocity_filter_hz = 20000\nencoder_um = 0\nfriction = { coulomb_mm_s2 = 0, viscous_per_s = 0 }\n";
    let file = folder.write("stiff.toml", format!("{beams}{stiff}"));
    let simulated = json(&["simulate", STAR, "--machine", &file, "--method", "kcs"]);
    let spectrum = json(&["spectrum", STAR, "--machine", BEAMS, "--methods", "kcs"]);
    for mode in 0..2 {
        let row = &simulated["cases"][0]["modes"][mode];
        let plan = number(&spectrum["methods"][0]["modes"][mode]["left_um"]);
        let left = number(&row["left_at_the_machine_um"]);
        assert!(
            (number(&row["left_by_the_plan_um"]) / plan - 1.0).abs() < 1e-6,
            "{row}"
        );
        assert!((left / plan - 1.0).abs() < 0.01, "{left} {plan}");
    }
}

#[test]
fn matched_filters_leave_under_two_percent_of_what_kcs_leaves_in_the_beams() {
    let shown = json(&[
        "simulate",
        STAR,
        "--machine",
        BEAMS,
        "--drive",
        "textbook",
        "--bandwidth",
        "50",
        "--method",
        "fir,kcs",
    ]);
    assert_eq!(shown["textbook"], true);
    for mode in 0..2 {
        let left =
            |case: usize| number(&shown["cases"][case]["modes"][mode]["left_at_the_machine_um"]);
        assert!(left(0) < 0.02 * left(1), "{} {}", left(0), left(1));
    }
}

#[test]
fn set_points_of_others_give_the_errors_of_the_plan_and_a_gap_is_refused() {
    let folder = Folder::new();
    let rows = folder.name("rows.csv");
    let run = toolglide(&["plan", SIX, "--machine", STAGE, "-o", &rows]);
    assert_eq!(run.code, 0, "{}", run.err);
    let planned = json(&["simulate", SIX, "--machine", STAGE]);
    let given = json(&["simulate", SIX, "--machine", STAGE, "--set-points", &rows]);
    for error in ["servo", "part"] {
        let of = |shown: &Value| number(&shown["cases"][0][error]["rms_um"]);
        let (one, other) = (of(&planned), of(&given));
        assert!((one / other - 1.0).abs() < 0.02, "{error}: {one} {other}");
    }
    let text = folder.read("rows.csv");
    let holed: Vec<&str> = text
        .lines()
        .enumerate()
        .filter(|(line, _)| !(500..520).contains(line))
        .map(|(_, row)| row)
        .collect();
    let holed = folder.write("holed.csv", holed.join("\n"));
    let run = toolglide(&["simulate", SIX, "--machine", STAGE, "--set-points", &holed]);
    assert_eq!(run.code, 2, "{}", run.out);
    assert!(
        run.err.contains("holed.csv:501: ") && run.err.contains("gap"),
        "{}",
        run.err
    );
}

#[test]
fn a_required_error_decides_the_exit_code() {
    let required = |millimetres| {
        toolglide(&[
            "simulate",
            SIX,
            "--machine",
            STAGE,
            "--require",
            millimetres,
        ])
        .code
    };
    assert_eq!(required("0.2"), 0, "wide");
    assert_eq!(required("0.001"), 1, "narrow");
}

#[test]
fn files_and_pictures_are_written_whole() {
    let folder = Folder::new();
    let (rows, plot, response) = (
        folder.name("run.csv"),
        folder.name("run.svg"),
        folder.name("response.svg"),
    );
    let run = toolglide(&[
        "simulate",
        SIX,
        "--machine",
        STAGE,
        "-o",
        &rows,
        "--plot",
        &plot,
        "--response",
        &response,
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let text = folder.read("run.csv");
    let header = text.lines().next().unwrap();
    for column in ["t_s", "planned_x", "actual_y", "servo_error_um", "force_x"] {
        assert!(header.split(',').any(|name| name == column), "{header}");
    }
    assert!(text.lines().count() > 20_000, "every servo period");
    for picture in ["run.svg", "response.svg"] {
        assert!(folder.read(picture).ends_with("</svg>\n"), "{picture}");
    }
    let several = folder.name("several.svg");
    let run = toolglide(&[
        "simulate",
        SIX,
        "--machine",
        STAGE,
        "--method",
        "kcs,exact-stop",
        "--plot",
        &several,
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(folder.read("several.svg").contains("exact-stop"), "legend");
}

#[test]
fn what_a_drive_must_not_be_is_refused_with_field_value_and_bound() {
    let folder = Folder::new();
    for (drives, parts) in [
        ("", &["without [drive]", "--drive textbook"][..]),
        (
            "[drive]\nbandwidth_hz = -3",
            &["bandwidth_hz is -3", "positive"],
        ),
        (
            "[drive]\nbandwidth_hz = nan",
            &["bandwidth_hz is NaN", "positive"],
        ),
        (
            "[drive]\nbandwidth_hz = 35\nposition_gain = 100",
            &["bandwidth_hz is 35 beside gains", "given alone"],
        ),
        (
            "[drive]\nfriction = { coulomb_mm_s2 = 400, static_mm_s2 = 300, stribeck_mm_s = 1 }",
            &[
                "friction: static is 300",
                "at least the Coulomb friction, 400",
            ],
        ),
        (
            "[drive]\nfriction = { coulomb_n = 12 }",
            &["friction: coulomb_n is 12", "mass_kg"],
        ),
        (
            "[drive]\nfriction = { coulomb_mm_s2 = 400, static_mm_s2 = 4000, stribeck_mm_s = 0.001 }",
            &["friction: stribeck is 0.001", "at least"],
        ),
        (
            "[drive]\nservo_period_s = 0.0003",
            &["servo_period_s is 0.0003", "0.001 s"],
        ),
        (
            "[drive]\ndead_time_s = 0.1",
            &["dead_time_s is 0.1", "at most 20 servo periods"],
        ),
        (
            "[drive]\nforce_limit_mm_s2 = 300",
            &["force_limit is 300", "at least the static friction"],
        ),
        (
            "[drive]\nposition_gain = 3000\nvelocity_gain = 9000\nintegral_gain = 1e7",
            &["gains is position 3000", "radius", "at most"],
        ),
        (
            "[drive]\nbacklash_um = 10",
            &["backlash is 0.01", "measures the table"],
        ),
        ("[drive]\nspeed = 3", &["speed"]),
        (
            "[drive]\nservo_period_s = 0.0001\n\n[[mode]]\naxis = \"X\"\nfrequency_hz = 6000",
            &[
                "mode: frequency_hz is 6000",
                "below half the servo rate, 5000 Hz",
            ],
        ),
        (
            "[drive]\n\n[[mode]]\naxis = \"X\"\nfrequency_hz = 20\nmass_share = 1.5",
            &["mass_share is 1.5", "below 1"],
        ),
        (
            "[drive]\n\n[[mode]]\naxis = \"X\"\nfrequency_hz = 20\nmass_share = 0.6\n\n[[mode]]\naxis = \"X\"\nfrequency_hz = 30\nmass_share = 0.6",
            &["the sum of all is 1.2", "below 1"],
        ),
    ] {
        let file = folder.write("m.toml", machine(drives));
        let run = toolglide(&["simulate", SIX, "--machine", &file]);
        assert_eq!(run.code, 2, "{drives}: {}{}", run.out, run.err);
        for part in parts {
            assert!(run.err.contains(part), "{drives}: {}", run.err);
        }
    }
}

#[test]
fn a_recorded_run_gives_its_drive_back_and_one_without_motion_is_refused() {
    let folder = Folder::new();
    let rows = folder.name("run.csv");
    let run = toolglide(&[
        "simulate",
        SIX,
        "--machine",
        STAGE,
        "-o",
        &rows,
        "--set-points",
        &{
            let planned = folder.name("planned.csv");
            let run = toolglide(&["plan", SIX, "--machine", STAGE, "-o", &planned]);
            assert_eq!(run.code, 0, "{}", run.err);
            planned
        },
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let found = json(&["identify", &rows, "--machine", STAGE, "--bandwidth", "30"]);
    for axis in found["axes"].as_array().unwrap() {
        let of = |name: &str| {
            let all = axis["parameters"].as_array().unwrap();
            let found = all.iter().find(|found| found["name"] == name).unwrap();
            number(&found["value"])
        };
        let coulomb = of("Coulomb friction");
        assert!((coulomb / 600.0 - 1.0).abs() < 0.1, "{axis}");
        assert!((of("position gain") / 105.0 - 1.0).abs() < 0.15, "{axis}");
        assert!(number(&axis["condition"]).is_finite(), "{axis}");
    }
    let still: String = (0..300)
        .map(|row| format!("{},1,1,1,1\n", f64::from(row) * 1e-3))
        .collect();
    let still = folder.write(
        "still.csv",
        format!("t_s,planned_x,planned_y,actual_x,actual_y\n{still}"),
    );
    let run = toolglide(&["identify", &still, "--machine", STAGE]);
    assert_eq!(run.code, 2, "{}", run.out);
    assert!(
        run.err.contains("without motion nothing is told"),
        "{}",
        run.err
    );
}

//! Programs made by others, planned and judged as they stream, on three machines.
//!
//! All of them in release; in debug, where planning is slow, the small ones.

use toolglide_kinematics::Limits;
use toolglide_smoothing::{Method, Settings};
use toolglide_tests::bounds::NEVER_SLOWER;
use toolglide_tests::corpus;
use toolglide_tests::course;
use toolglide_tests::stream::{Outcome, plan_and_judge};

/// Tolerance where the program says none, mm.
const TOLERANCE: f64 = 0.01;

/// Longest program that is planned in debug, bytes.
const SMALL: usize = 60_000;

/// Plans every program within limits; prints a line of each.
fn all_programs(name: &str, limits: Limits<3>) {
    let (mut programs, mut failures) = (0, Vec::new());
    for file in corpus::names() {
        let Some(text) = corpus::text(&file) else {
            continue;
        };
        if cfg!(debug_assertions) && text.len() > SMALL {
            continue;
        }
        let Ok(moves) = corpus::moves(&text, &file, TOLERANCE) else {
            continue;
        };
        let settings = Settings::new(limits);
        let smooth = plan_and_judge(&moves, &settings, limits);
        let stopping = settings.with_method(Method::ExactStop);
        let stopping = plan_and_judge(&moves, &stopping, limits);
        print_line(name, &file, &smooth, &stopping);
        for (method, outcome) in [("kcs", &smooth), ("exact stop", &stopping)] {
            let report = &outcome.report;
            if !report.passes() {
                let (count, first) = (report.violations, report.examples.first());
                failures.push(format!("{file}, {method}: {count} violations, {first:?}"));
            }
        }
        let (smooth, stopping) = (smooth.report.cycle_time, stopping.report.cycle_time);
        if smooth > stopping * (1.0 + NEVER_SLOWER) {
            failures.push(format!("{file}: {smooth} s, stopping {stopping} s"));
        }
        programs += 1;
    }
    assert!(
        failures.is_empty(),
        "of {programs} programs on {name}: {failures:#?}"
    );
}

#[allow(clippy::print_stdout, reason = "the figures are of interest")]
fn print_line(machine: &str, file: &str, smooth: &Outcome<3>, stopping: &Outcome<3>) {
    let report = &smooth.report;
    println!(
        "{machine:9} {file:50} {:6} moves {:10.3} s, stopping {:10.3} s, {:7.2} us a move, longest {:7.0} us, \
         {:5} moves held, deviation {:.4}, corner {:.4} of the tolerance",
        report.moves,
        report.cycle_time,
        stopping.report.cycle_time,
        smooth.planning.as_secs_f64() * 1e6 / f64::from(report.moves.max(1)),
        smooth.longest.as_secs_f64() * 1e6,
        smooth.moves_held,
        report.deviation_ratio.value,
        report.corner_ratio.value,
    );
}

#[test]
fn programs_of_others_on_a_gentle_machine() {
    all_programs("gentle", course::limits(&[[1_000.0, 2_000.0, 5e4]; 3]));
}

#[test]
fn programs_of_others_on_a_stiff_machine() {
    all_programs("stiff", course::limits(&[[1_000.0, 2_500.0, 2e5]; 3]));
}

#[test]
fn programs_of_others_on_a_machine_of_unequal_axes() {
    all_programs(
        "unequal",
        course::limits(&[
            [500.0, 3_000.0, 1e5],
            [400.0, 2_000.0, 5e4],
            [200.0, 1_000.0, 2e4],
        ]),
    );
}

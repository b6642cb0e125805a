//! Prints where `kcs` loses time against other methods and smaller tolerances, a row for each random program.
//!
//! Columns: number of the program, largest velocity, tolerance (mm), moves, arcs, stops, seconds by `kcs`; the seconds
//! by `kcs-interrupted`, `kcs-uninterrupted`, `kcs-global`, `fir`, by `kcs` with a smaller tolerance, and by kinematic
//! smoothing alone, each as a share of that; then microseconds of processor time a move by `kcs`, kinematic
//! smoothing alone, and the three kinds of corners. Run it with
//! `cargo run --release -p toolglide-tests --example losses -- FIRST LAST`.
//!
//! Not here: the promise, see the test of that name.

#![allow(
    clippy::unwrap_used,
    clippy::cast_precision_loss,
    reason = "a failed unwrap is a failed run; counts are small"
)]

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::io::Write;
use toolglide_kinematics::Trajectory;
use toolglide_smoothing::{Method, Settings, plan};
use toolglide_tests::course::{Lead, limits};
use toolglide_tests::feeds::programs;

fn main() {
    let mut asked = std::env::args().skip(1).map(|text| text.parse().unwrap());
    let first: usize = asked.next().unwrap_or(0);
    let last: usize = asked.next().unwrap_or(100);
    let seed: usize = asked.next().unwrap_or(7);
    let mut runner = TestRunner::new(Config {
        rng_seed: RngSeed::Fixed(seed as u64),
        ..Config::default()
    });
    let strategy = programs();
    for case in 0..last {
        let (course, numbers) = strategy.new_tree(&mut runner).unwrap().current();
        if case < first {
            continue;
        }
        let path = course.toolpath();
        let settings = Settings::new(limits(&numbers));
        let tighter = [1.2, 1.5, 2.0, 4.0][case % 4];
        let mut tight = course.clone();
        for leg in &mut tight.legs {
            leg.tolerance /= tighter;
        }
        let limits = limits(&numbers);
        let best = |path| toolglide_fastest::plan(path, &limits).unwrap();
        let began = cpu_time::ThreadTime::now();
        let motion = best(&path);
        let took = [began.elapsed().as_secs_f64()];
        let report = toolglide_verify::verify(&motion, &path, &limits);
        assert!(report.passes(), "{case}: {:#?}", report.examples);
        let own = motion.duration();
        let mut took = Vec::from(took);
        let began = cpu_time::ThreadTime::now();
        let alone = plan(&path, &settings).unwrap().duration();
        took.push(began.elapsed().as_secs_f64());
        let mut by = |method| {
            let began = cpu_time::ThreadTime::now();
            let duration = plan(&path, &settings.with_method(method))
                .unwrap()
                .duration();
            took.push(began.elapsed().as_secs_f64());
            duration
        };
        let others = [
            by(Method::KcsInterrupted),
            by(Method::KcsUninterrupted),
            by(Method::KcsGlobal),
            toolglide_fir::plan(&path, &toolglide_fir::Settings::new(limits))
                .unwrap()
                .duration(),
            best(&tight.toolpath()).duration(),
            alone,
        ];
        let arcs = course
            .legs
            .iter()
            .filter(|leg| matches!(leg.lead, Lead::Arc { .. }))
            .count();
        let stops = course.legs.iter().filter(|leg| leg.stop).count();
        let mut out = std::io::stdout().lock();
        write!(
            out,
            "{case},{},{:.4},{},{arcs},{stops},{own:.6}",
            numbers[0][0],
            course.legs[0].tolerance,
            course.legs.len()
        )
        .unwrap();
        for other in others {
            write!(out, ",{:.5}", other / own).unwrap();
        }
        for time in took {
            write!(out, ",{:.1}", time * 1e6 / course.legs.len() as f64).unwrap();
        }
        writeln!(out).unwrap();
    }
}

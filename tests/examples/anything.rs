//! Tries anything that public constructors take, seed by seed, and tells which panic, break a bound or take long:
//!
//! `cargo run --release -p toolglide-tests --example anything -- FIRST COUNT [PLANNER...]`

#![allow(clippy::print_stdout, reason = "it tells what came of it")]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;
use toolglide_tests::anything::{Dice, Tally, try_all};

/// Seeds that take more processor time than this are told, with their number, and more for each second of motion.
const LONG: Duration = Duration::from_secs(5);
const PER_SECOND: f64 = 0.3;

/// Most that is granted for the motion.
const MAX_SECONDS: f64 = 100.0;

/// Processor time of this thread, as Linux tells it; none elsewhere.
fn processor_time() -> Duration {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let first = told.split_whitespace().next();
    Duration::from_nanos(first.and_then(|text| text.parse().ok()).unwrap_or(0))
}

fn main() -> std::process::ExitCode {
    let mut words = std::env::args().skip(1);
    let mut number = || words.next().and_then(|text| text.parse::<u64>().ok());
    let (Some(first), Some(count)) = (number(), number()) else {
        println!("usage: anything FIRST COUNT [PLANNER...]");
        return std::process::ExitCode::from(2);
    };
    let planners: Vec<String> = words.collect();
    let wanted = |name: &str| planners.is_empty() || planners.iter().any(|one| one == name);
    let mut all = Tally::default();
    let (mut failed, mut long) = (0, 0);
    let mut longest = (Duration::ZERO, first);
    for seed in first..first.saturating_add(count) {
        let begin = processor_time();
        let tried = catch_unwind(AssertUnwindSafe(|| {
            try_all(&mut Dice::of_seed(seed), &wanted)
        }));
        let mut allowed = LONG;
        let lasted = processor_time().saturating_sub(begin);
        match tried {
            Ok(tally) => {
                all.judged += tally.judged;
                all.refused += tally.refused;
                let lasting = (PER_SECOND * tally.lasting).min(MAX_SECONDS);
                allowed += Duration::from_secs_f64(lasting.max(0.0));
            }
            Err(_) => {
                failed += 1;
                println!("seed {seed} failed");
            }
        }
        if lasted > allowed {
            long += 1;
            println!("seed {seed} took {:.1} s", lasted.as_secs_f64());
        }
        if lasted > longest.0 {
            longest = (lasted, seed);
        }
    }
    println!(
        "{count} seeds: {} plans judged, {} refusals, {failed} failed, {long} above {} s and what motion earns, the longest {:.2} s (seed {})",
        all.judged,
        all.refused,
        LONG.as_secs(),
        longest.0.as_secs_f64(),
        longest.1
    );
    if failed + long == 0 {
        std::process::ExitCode::SUCCESS
    } else {
        std::process::ExitCode::FAILURE
    }
}

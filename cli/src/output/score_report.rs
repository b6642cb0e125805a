//! Prints how methods stand against the time-optimal motion.
//!
//! Source: sums over what was scored. Not here: scoring.

use crate::input::setup::Setup;
use crate::output::report::Shown;
use serde::Serialize;
use std::fmt::Write;
use toolglide_reference::{corner_penalty_ratio, score};

/// Moves whose losses are told.
const LOSSES: usize = 10;

/// Losses below this are none, s: the grid of the optimum is no finer.
const NO_LOSS: f64 = 1e-5;

/// Motion this much faster than its bound would be a mistake, dimensionless: far above the rounding of
/// both.
const BEYOND: f64 = 1e-7;

/// The standing of methods on one program, as JSON names it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Standing {
    program: String,
    machine: String,
    class: &'static str,
    /// How the program was sampled.
    pub(crate) sample: Sample,
    optimum_s: f64,
    lower_bound_s: f64,
    /// Of which motions the lower bound is a bound.
    lower_bound_over: &'static str,
    straight_s: f64,
    methods: Vec<MethodStanding>,
    losses: Vec<Loss>,
}

/// What was scored of a program.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Sample {
    /// Whether it was all of it.
    pub(crate) whole: bool,
    /// Windows that were scored.
    pub(crate) windows: usize,
    /// Windows that were too large or too hard.
    pub(crate) skipped: usize,
    /// Straight legs in the windows scored.
    pub(crate) legs: usize,
    /// Straight legs of the program.
    pub(crate) legs_of_program: u64,
}

/// One method.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct MethodStanding {
    /// Name on the command line.
    pub(crate) name: String,
    /// How long it takes.
    pub(crate) cycle_time_s: f64,
    score: f64,
    corner_penalty_ratio: Option<f64>,
    /// No motion with its shares of time takes less.
    pub(crate) lower_bound_s: Option<f64>,
    /// How often it broke a limit or the tolerance.
    pub(crate) violations: u64,
}

/// Time lost on a move.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Loss {
    /// Who lost it.
    pub(crate) method: String,
    /// Line of the program; 0 for none.
    pub(crate) line: u32,
    /// How much.
    pub(crate) loss_s: f64,
    /// How long the method takes for the move.
    pub(crate) time_s: f64,
    /// How long the optimum takes.
    pub(crate) optimum_s: f64,
}

/// Sums over all that was scored.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sums {
    /// Of the optimum, of its bound, and of straight motion, s.
    pub(crate) optimum: f64,
    /// As above.
    pub(crate) lower_bound: f64,
    /// As above.
    pub(crate) straight: f64,
    /// Whether every bound holds for all shares of time.
    pub(crate) certified: bool,
    /// The methods.
    pub(crate) methods: Vec<MethodStanding>,
    /// Time lost by the first method on each move.
    pub(crate) losses: Vec<Loss>,
}

impl Standing {
    /// The standing that some sums give.
    pub(crate) fn new(program: &str, setup: &Setup, sample: Sample, sums: Sums) -> Self {
        let mut losses = sums.losses;
        losses.retain(|loss| loss.loss_s >= NO_LOSS);
        losses.sort_by(|one, other| other.loss_s.total_cmp(&one.loss_s));
        losses.truncate(LOSSES);
        let methods = sums.methods.into_iter().map(|method| MethodStanding {
            score: score(sums.optimum, method.cycle_time_s),
            corner_penalty_ratio: corner_penalty_ratio(
                sums.optimum,
                method.cycle_time_s,
                sums.straight,
            ),
            ..method
        });
        Self {
            program: program.to_owned(),
            machine: setup.machine.clone(),
            class: "two-sided",
            sample,
            optimum_s: sums.optimum,
            lower_bound_s: sums.lower_bound,
            lower_bound_over: if sums.certified {
                "all motions"
            } else {
                "motions with the optimum's shares of time on the moves"
            },
            straight_s: sums.straight,
            methods: methods.collect(),
            losses,
        }
    }
}

impl Shown for Standing {
    /// Whether no method broke anything, and none beat its bound.
    fn passes(&self) -> bool {
        let sound = |method: &MethodStanding| method.violations == 0 && !method.beats_its_bound();
        self.methods.iter().all(sound)
    }

    fn text(&self) -> String {
        let Sample {
            whole,
            windows,
            skipped,
            legs,
            legs_of_program,
        } = self.sample;
        let mut text = if whole {
            format!("{}: {legs} straight legs", self.program)
        } else {
            format!(
                "{}: {windows} evenly spread windows, each from rest to rest, with {legs} of \
                 {legs_of_program} straight legs",
                self.program
            )
        };
        if skipped > 0 {
            let _ = write!(text, "; {skipped} windows could not be scored");
        }
        let _ = writeln!(text, ", planned for {}", self.machine);
        let _ = writeln!(
            text,
            "optimum {:.5} s; {} take at least {:.5} s\n",
            self.optimum_s, self.lower_bound_over, self.lower_bound_s
        );
        let _ = writeln!(
            text,
            "{:<18} {:>14} {:>9} {:>9} {:>16} {:>11}",
            "method", "cycle time, s", "score", "corners", "own bound, s", "violations"
        );
        let or_none = |value: Option<f64>, decimals: usize| {
            value.map_or("-".to_owned(), |value| format!("{value:.decimals$}"))
        };
        for method in &self.methods {
            let _ = writeln!(
                text,
                "{:<18} {:>14.5} {:>9.4} {:>9} {:>16} {:>11}",
                method.name,
                method.cycle_time_s,
                method.score,
                or_none(method.corner_penalty_ratio, 3),
                or_none(method.lower_bound_s, 5),
                method.violations
            );
        }
        if let Some(first) = self.losses.first() {
            let _ = writeln!(text, "\nwhere {} loses most", first.method);
            let _ = writeln!(
                text,
                "{:>8} {:>10} {:>10} {:>13}",
                "line", "loss, ms", "takes, ms", "optimum, ms"
            );
            for loss in &self.losses {
                let _ = writeln!(
                    text,
                    "{:>8} {:>10.3} {:>10.3} {:>13.3}",
                    loss.line,
                    1e3 * loss.loss_s,
                    1e3 * loss.time_s,
                    1e3 * loss.optimum_s
                );
            }
        }
        text
    }

    fn complaint(&self) -> String {
        let mut text = String::new();
        for method in &self.methods {
            if method.violations > 0 {
                let _ = writeln!(
                    text,
                    "{}: {}: limits or tolerance are broken {} times, so its score means nothing",
                    self.program, method.name, method.violations
                );
            }
            if method.beats_its_bound() {
                let _ = writeln!(
                    text,
                    "{}: {}: it takes less time than its bound, so one of them is wrong",
                    self.program, method.name
                );
            }
        }
        text
    }
}

impl MethodStanding {
    /// Nothing done yet.
    pub(crate) fn of(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            lower_bound_s: Some(0.0),
            ..Self::default()
        }
    }

    fn beats_its_bound(&self) -> bool {
        self.lower_bound_s
            .is_some_and(|bound| self.cycle_time_s < bound * (1.0 - BEYOND))
    }
}

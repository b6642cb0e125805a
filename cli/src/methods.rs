//! Lists the methods by name, the only file that knows the planners.
//!
//! Everything else speaks to [`MotionPlanner`].

use crate::error::CliError;
use crate::input::args::{KeptSide, TuningArgs};
use crate::input::filters::{asked, chain};
use crate::input::setup::Setup;
use crate::input::silence::{all_modes, silent_modes};
use toolglide_baselines::{BezierSmoothing, LocalOverlap};
use toolglide_fastest::Fastest;
use toolglide_fir::{FilterChain, FirInterpolation};
use toolglide_kinematics::{AxisModes, Limits, MotionPlanner, PathSide, Reserve, Vector};
use toolglide_optimal::{Effort, Smoothing, TimeOptimal};
use toolglide_reference::ReferencePlanner;
use toolglide_smoothing::{KinematicSmoothing, Method, Settings};
use toolglide_verify::Judge;

/// A method of planning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MethodName {
    /// Name on the command line.
    pub name: &'static str,
    /// What it does at corners.
    pub summary: &'static str,
}

impl MethodName {
    /// Whether its motion keeps every limit; the baselines of the text do not.
    #[must_use]
    pub fn keeps_limits(&self) -> bool {
        !is_baseline(self.name)
    }

    /// Whether it runs only where it is named: it is too slow, or keeps no limits.
    #[must_use]
    pub fn must_be_named(&self) -> bool {
        self.name == REFERENCE || !self.keeps_limits()
    }
}

/// All methods, the default first.
pub const METHODS: &[MethodName] = &[
    MethodName {
        name: "kcs",
        summary: "the fastest it finds of everything: corners turned, stopped at, many fine ones superposed, pulses filtered",
    },
    MethodName {
        name: OPTIMAL,
        summary: "the fastest motion inside tolerance and limits, planned in windows; kcs where that is faster",
    },
    MethodName {
        name: "kcs-uninterrupted",
        summary: "acceleration is carried through every corner",
    },
    MethodName {
        name: "kcs-interrupted",
        summary: "acceleration is zero where a corner begins and ends",
    },
    MethodName {
        name: "kcs-local",
        summary: "the dissertation's local corners: uninterrupted acceleration, each move as programmed",
    },
    MethodName {
        name: "kcs-global",
        summary: "the dissertation's global corners: as local, overlapping where moves are short",
    },
    MethodName {
        name: BEZIER,
        summary: "spline corners for comparison: curvature-optimal quintics at constant speed",
    },
    MethodName {
        name: "fir",
        summary: "feed pulses through moving averages, overlapping as far as the tolerance allows",
    },
    MethodName {
        name: "fir-p2p",
        summary: "feed pulses through moving averages, a full stop at the end of every move",
    },
    MethodName {
        name: BEZIER_FREE,
        summary: "the dissertation's spline corners, which break the jerk limit; for comparison alone",
    },
    MethodName {
        name: FIR_LOCAL,
        summary: "the dissertation's overlap of one corner alone, which breaks the tolerance; for comparison alone",
    },
    MethodName {
        name: REFERENCE,
        summary: "the time-optimal reference, for short programs: minutes for a hundred moves",
    },
    MethodName {
        name: EXACT_STOP,
        summary: "a full stop at the end of every move",
    },
];

/// Time-optimal motion.
const OPTIMAL: &str = "optimal";

/// The baseline of spline corners.
const BEZIER: &str = "bezier";

/// The baseline of spline corners without a jerk limit.
const BEZIER_FREE: &str = "bezier-free";

/// The baseline of filtered pulses by the rule of one corner.
const FIR_LOCAL: &str = "fir-local";

/// Filters of that baseline where nobody names any, s: those of section 4.3.
const LOCAL_FILTERS: [f64; 2] = [0.05, 0.03];

/// Whether a method is a baseline that breaks limits by what it is, so that it must be asked for.
pub(crate) fn is_baseline(method: &str) -> bool {
    method == BEZIER_FREE || method == FIR_LOCAL
}

/// The time-optimal reference: so slow that it must be asked for.
pub(crate) const REFERENCE: &str = "reference";

/// The method that all others are measured by.
pub(crate) const EXACT_STOP: &str = "exact-stop";

/// What some methods can be told.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tuning {
    /// The filters of the methods fir and fir-p2p; `None` where the planner chooses.
    pub(crate) filters: Option<FilterChain>,
    /// Who asked for them.
    pub(crate) filters_asked: String,
    /// How much planning the method optimal may do.
    pub(crate) effort: Effort,
    /// What is left of the limits to the execution.
    pub(crate) reserve: Option<Reserve>,
    /// How much slower than the fastest motion of the method optimal a smoother one may be.
    pub(crate) smoothing: Smoothing,
    /// Modes that the method optimal leaves at rest, and who named them.
    pub(crate) modes: AxisModes,
    pub(crate) modes_asked: String,
    /// All modes of the machine, which the judge follows.
    pub(crate) all_modes: AxisModes,
    /// Frequency above which acceleration is measured, Hz; 0 for the usual one.
    pub(crate) high_pass: f64,
    /// On which side of straight lines the method optimal stays, and how far it may go on the other, mm.
    pub(crate) side: PathSide,
    pub(crate) overshoot: f64,
}

impl Tuning {
    /// What the command line and the machine say.
    pub(crate) fn of(args: &TuningArgs, setup: &Setup) -> Result<Self, CliError> {
        Ok(Self {
            filters: chain(args, setup)?,
            filters_asked: asked(args, setup),
            effort: Effort::new(args.effort).unwrap_or_default(),
            reserve: args.reserve,
            smoothing: Smoothing::new(args.smooth / 100.0).unwrap_or_default(),
            modes: silent_modes(args, setup)?,
            modes_asked: setup.modes_asked.clone(),
            all_modes: all_modes(setup)?,
            high_pass: args.above,
            side: args.side.map_or(PathSide::Both, kept_side),
            overshoot: args.overshoot,
        })
    }
}

fn kept_side(side: KeptSide) -> PathSide {
    match side {
        KeptSide::Inside => PathSide::Inside,
        KeptSide::Left => PathSide::Left,
        KeptSide::Right => PathSide::Right,
    }
}

impl Tuning {
    /// The judge of a method: it follows the modes of the machine, and holds the method to what it promises of them.
    pub(crate) fn judge<const N: usize>(
        &self,
        method: &str,
        start: Vector<N>,
        limits: Limits<N>,
    ) -> Judge<N> {
        let silent = method == OPTIMAL && !self.modes.is_empty();
        Judge::new(start, limits)
            .with_high_pass(self.high_pass)
            .with_modes(&self.all_modes, silent)
            .with_side(
                if method == OPTIMAL {
                    self.side
                } else {
                    PathSide::Both
                },
                self.overshoot,
            )
    }
}

/// The planner of a method, at rest at `start`.
pub(crate) fn planner<const N: usize>(
    method: &str,
    start: Vector<N>,
    limits: Limits<N>,
    tuning: &Tuning,
) -> Result<Box<dyn MotionPlanner<N>>, CliError> {
    let limits = limits
        .reserved(tuning.reserve.unwrap_or(Reserve::NONE))
        .map_err(|reason| CliError::Option {
            option: "--reserve",
            value: "a limit of an axis less the reserve".to_owned(),
            bound: reason.to_string(),
        })?;
    if method == Method::Kcs.name() {
        return Ok(Box::new(Fastest::new(start, limits)));
    }
    if let Some(method) = Method::find(method) {
        let settings = Settings::new(limits).with_method(method);
        return Ok(Box::new(KinematicSmoothing::new(start, &settings)));
    }
    if let Some(method) = toolglide_fir::Method::find(method) {
        let mut settings = toolglide_fir::Settings::new(limits).with_method(method);
        if let Some(chain) = &tuning.filters {
            settings = settings
                .with_chain(chain)
                .map_err(CliError::filters(&tuning.filters_asked))?;
        }
        return Ok(Box::new(FirInterpolation::new(start, &settings)));
    }
    if method == OPTIMAL {
        let settings = toolglide_optimal::Settings::new(limits)
            .with_effort(tuning.effort)
            .with_smoothing(tuning.smoothing)
            .with_side(tuning.side, tuning.overshoot)
            .with_modes(tuning.modes)
            .map_err(CliError::mode(&tuning.modes_asked))?;
        return Ok(Box::new(TimeOptimal::new(start, &settings)));
    }
    if method == BEZIER {
        return Ok(Box::new(BezierSmoothing::new(start, limits)));
    }
    if method == BEZIER_FREE {
        let planner = BezierSmoothing::without_corner_jerk(start, limits);
        return Ok(Box::new(planner.map_err(|reason| CliError::Option {
            option: "--method",
            value: BEZIER_FREE.to_owned(),
            bound: reason.to_string(),
        })?));
    }
    if method == FIR_LOCAL {
        let chain = match &tuning.filters {
            Some(chain) => chain.clone(),
            None => FilterChain::with_time_constants(&LOCAL_FILTERS)
                .map_err(CliError::filters(FIR_LOCAL))?,
        };
        return Ok(Box::new(LocalOverlap::new(start, limits, chain)));
    }
    if method == REFERENCE {
        return Ok(Box::new(ReferencePlanner::new(start, limits)));
    }
    let names: Vec<_> = METHODS.iter().map(|method| method.name).collect();
    Err(CliError::Option {
        option: "--method",
        value: format!("\"{method}\""),
        bound: format!("there are {}", names.join(", ")),
    })
}

/// The methods asked for, each once; where none was, all but those that must be asked for.
pub(crate) fn chosen(asked: &[String]) -> Vec<String> {
    if asked.is_empty() {
        return METHODS
            .iter()
            .filter(|method| !method.must_be_named())
            .map(|method| method.name.to_owned())
            .collect();
    }
    let mut chosen = Vec::<String>::new();
    for method in asked {
        if !chosen.contains(method) {
            chosen.push(method.clone());
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_has_a_planner() {
        let limits = Limits::<2>::uniform(1.0, 1.0, 1.0).unwrap();
        for method in METHODS {
            assert!(
                planner(method.name, Vector::zeros(), limits, &Tuning::default()).is_ok(),
                "{}",
                method.name
            );
        }
        assert!(
            planner("spline", Vector::zeros(), limits, &Tuning::default()).is_err(),
            "unknown"
        );
    }

    #[test]
    fn a_method_named_twice_is_planned_once() {
        let asked = ["kcs", "exact-stop", "kcs"].map(str::to_owned);
        assert_eq!(chosen(&asked), ["kcs", "exact-stop"]);
    }

    #[test]
    fn the_reference_must_be_asked_for() {
        let all = chosen(&[]);
        assert_eq!(all.len(), METHODS.len() - 3);
        assert!(!all.iter().any(|method| is_baseline(method)), "{all:?}");
        assert!(!all.contains(&REFERENCE.to_owned()), "{all:?}");
        assert_eq!(chosen(&[REFERENCE.to_owned()]), [REFERENCE]);
    }
}

//! Reads the inputs of a run on tool poses: machine, start, filters, legs.
//!
//! Not here: options of straight axes.

use crate::error::CliError;
use crate::input::args::{JobArgs, TuningArgs};
use crate::input::filters;
use crate::input::setup::{Setup, is_straight, machine};
use crate::input::source::{Source, language, poses_with_parameters, subroutines};
use crate::input::values::PerAxis;
use std::collections::VecDeque;
use std::io::BufRead;
use toolglide_machines::is_plain;

use toolglide_fir::FilterChain;
use toolglide_fiveaxis::{FiveAxisError, Resolver, start_of};
use toolglide_kinematics::{
    AxisKind, AxisVector, KinematicsError, MachineKinematics, OrientationTolerance, PoseEnd,
    PoseLeg, PoseMove, Vector,
};
use toolglide_program::{Language, Poses, Settings};

/// Decimals of a degree that are shown.
const DECIMALS: f64 = 1e6;

/// The first filter is longer than the second by this factor where nobody says otherwise.
const FIRST_TO_SECOND: f64 = 2.0;

/// Moves that are looked at to choose on which branch and turn a machine starts.
const MOVES_AHEAD: usize = 1 << 14;

/// Whether a run is one of tool poses: the machine has other axes than straight X, Y and Z, or the
/// program is a file of tool poses.
pub(crate) fn concerns(job: &JobArgs) -> Result<bool, CliError> {
    let (config, machine) = machine(&job.machine)?;
    let language = language(&job.program, job.dialect.as_deref())?;
    let by_axes = is_straight(&config, machine.as_ref()) || is_plain(&config);
    Ok(!by_axes || language == Language::CutterLocations)
}

/// Machine and limits of a run.
pub(crate) struct Inputs {
    pub(crate) setup: Setup,
    pub(crate) machine: Box<dyn MachineKinematics>,
    pub(crate) orientation_tolerance: OrientationTolerance,
    /// Axis to turn about between opposite orientations.
    turn_about: Option<Vector<3>>,
    /// Whether the command line says where the motion starts.
    started: bool,
}

impl Inputs {
    pub(crate) fn new(
        job: &JobArgs,
        tip_tolerance: Option<f64>,
        orientation_tolerance: f64,
        turn_about: Option<&PerAxis>,
        period: Option<f64>,
    ) -> Result<Self, CliError> {
        let (config, machine) = machine(&job.machine)?;
        let mut setup = Setup::of(config, machine.as_ref(), job, period)?;
        if let Some(length) = tip_tolerance {
            setup.tolerance = toolglide_kinematics::Tolerance::new(length).map_err(|reason| {
                CliError::Option {
                    option: "--tip-tolerance",
                    value: length.to_string(),
                    bound: reason.to_string(),
                }
            })?;
            setup.override_tolerance = true;
        }
        let orientation_tolerance =
            OrientationTolerance::new(orientation_tolerance).map_err(|reason| {
                CliError::Option {
                    option: "--orientation-tolerance",
                    value: orientation_tolerance.to_string(),
                    bound: reason.to_string(),
                }
            })?;
        let turn_about = turn_about
            .map(|PerAxis(values)| {
                <[f64; 3]>::try_from(values.as_slice())
                    .map(Vector::<3>::from)
                    .map_err(|_| CliError::Option {
                        option: "--turn-about",
                        value: format!("{} numbers", values.len()),
                        bound: "an axis is I,J,K".to_owned(),
                    })
            })
            .transpose()?;
        Ok(Self {
            setup,
            machine,
            orientation_tolerance,
            turn_about,
            started: job.start.is_some(),
        })
    }

    /// The filters of the run, or those to begin with where nobody asks for any.
    pub(crate) fn chain(&self, args: &TuningArgs) -> Result<(FilterChain, bool), CliError> {
        if let Some(chain) = filters::chain(args, &self.setup)? {
            return Ok((chain, true));
        }
        // Time to reach the largest acceleration of the axis that takes longest.
        let second = self
            .setup
            .axes
            .iter()
            .map(|axis| axis.limits.acceleration() / axis.limits.jerk())
            .fold(0.0, f64::max);
        FilterChain::with_time_constants(&[FIRST_TO_SECOND * second, second])
            .and_then(|chain| chain.rounded_to(self.setup.period))
            .map(|chain| (chain, false))
            .map_err(CliError::filters(&self.setup.asked))
    }

    /// Opens the program; its first pose is where the motion starts, unless that is known.
    pub(crate) fn open(&self, job: &JobArgs) -> Result<Legs<'_>, CliError> {
        let Source {
            reader,
            name,
            language,
        } = Source::open(&job.program, job.dialect.as_deref())?;
        let start = AxisVector::from_slice(self.setup.start_positions())
            .map_err(|reason| refused(&name, 0, FiveAxisError::Machine { index: 0, reason }))?;
        let pose = self
            .machine
            .forward(&start)
            .map_err(|reason| refused(&name, 0, FiveAxisError::Machine { index: 0, reason }))?;
        let settings = Settings {
            override_tolerance: self.setup.override_tolerance,
            start: pose.tip(),
            lenient: job.lenient,
            ..Settings::new(self.setup.tolerance)
        };
        let boxed: Box<dyn BufRead> = Box::new(reader);
        let program = Poses::new(boxed, &name, settings, language)
            .with_tools(self.setup.tools.clone())
            .with_reference_points(&self.setup.reference_points)
            .with_subroutines(subroutines(&job.program))
            .for_machine(&self.setup.machine);
        let mut legs = Legs {
            program: poses_with_parameters(program, &job.parameters)?,
            resolver: None,
            machine: self.machine.as_ref(),
            orientation_tolerance: self.orientation_tolerance,
            turn_about: self.turn_about,
            name,
            start,
            ahead: VecDeque::new(),
        };
        if !self.started {
            legs.start_at_first_pose()?;
        }
        Ok(legs)
    }
}

/// The legs of a program.
pub(crate) struct Legs<'m> {
    pub(crate) program: Poses<Box<dyn BufRead>>,
    pub(crate) name: String,
    /// Where the axes are before the first leg.
    pub(crate) start: AxisVector,
    resolver: Option<Resolver<'m>>,
    machine: &'m dyn MachineKinematics,
    orientation_tolerance: OrientationTolerance,
    turn_about: Option<Vector<3>>,
    ahead: VecDeque<PoseMove>,
}

impl Legs<'_> {
    /// A file of tool poses does not say how the tool gets to the first.
    fn start_at_first_pose(&mut self) -> Result<(), CliError> {
        while self.ahead.len() < MOVES_AHEAD {
            let Some(next) = self.read()? else { break };
            let pose = matches!(next.end(), PoseEnd::Pose(_));
            self.ahead.push_back(next);
            if !pose && self.ahead.len() == 1 {
                return Ok(());
            }
        }
        let Some(first) = self.ahead.front() else {
            return Ok(());
        };
        let line = first.line();
        self.start = start_of(
            self.machine,
            self.ahead.make_contiguous(),
            &self.start,
            self.orientation_tolerance,
        )
        .map_err(|reason| {
            let reason = FiveAxisError::Machine { index: 0, reason };
            refused(&self.name, line, reason)
        })?;
        Ok(())
    }

    fn read(&mut self) -> Result<Option<PoseMove>, CliError> {
        self.program
            .next()
            .transpose()
            .map_err(|refused| CliError::Program(Box::new(refused)))
    }

    /// The next leg; `None` at the end of the program.
    pub(crate) fn next(&mut self) -> Result<Option<PoseLeg>, CliError> {
        let next = match self.ahead.pop_front() {
            Some(next) => Some(next),
            None => self.read()?,
        };
        let Some(next) = next else {
            return Ok(None);
        };
        if self.resolver.is_none() {
            let resolver = Resolver::new(self.machine, self.start, self.orientation_tolerance)
                .map_err(|reason| refused(&self.name, next.line(), reason))?;
            self.resolver = Some(match self.turn_about {
                Some(axis) => resolver.turning_about(axis),
                None => resolver,
            });
        }
        let leg = match &mut self.resolver {
            Some(resolver) => resolver.leg(&next),
            None => return Ok(None),
        };
        leg.map(Some)
            .map_err(|reason| refused(&self.name, next.line(), reason))
    }

    /// Tells what the reader of the program wants known.
    pub(crate) fn warn(&self, err: &mut dyn std::io::Write) {
        for warning in self.program.warnings() {
            let _ = writeln!(err, "warning: {warning}");
        }
        if self.program.more_warnings() > 0 {
            let _ = writeln!(err, "and {} more warnings", self.program.more_warnings());
        }
    }
}

/// A refused pose with its place; ends of rotary axes in degrees.
pub(crate) fn refused(program: &str, line: u32, reason: FiveAxisError) -> CliError {
    let reason = match reason {
        FiveAxisError::Machine {
            index,
            reason:
                KinematicsError::Travel {
                    axis,
                    kind: AxisKind::Rotary,
                    position,
                    low,
                    high,
                },
        } => {
            let [position, low, high] = [position, low, high].map(degrees);
            let beyond = degrees((low - position).max(position - high).to_radians());
            format!(
                "move {index}: axis {axis}: position {position} is outside the travel {low} to {high} deg by {beyond}"
            )
        }
        FiveAxisError::Pole {
            index,
            axis,
            from,
            to,
            tip,
            tool,
        } => {
            let [from, to] = [from, to].map(degrees);
            let away = degrees((to - from).abs().to_radians());
            format!(
                "move {index}: at its start the tool points along axis {axis}, which stands at {from} deg and must be at {to} deg for the tool to go on, {away} deg away; tip {tip:.6?} mm, orientation {tool:.6?}"
            )
        }
        other => other.to_string(),
    };
    CliError::Line {
        program: program.to_owned(),
        line,
        reason,
    }
}

/// An angle in degrees, without what rounding added to it.
fn degrees(angle: f64) -> f64 {
    (angle.to_degrees() * DECIMALS).round() / DECIMALS
}

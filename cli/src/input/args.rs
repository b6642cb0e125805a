//! Defines the options of the command line.
//!
//! Not here: how values are read, and what a machine or a program makes of them.

use crate::input::values::{
    PerAxis, Sweep, coordinates, mode, parameter, per_axis, positive, reserve, sweep,
};
use crate::methods::METHODS;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;
use toolglide_kinematics::Reserve;
use toolglide_machines::ModeConfig;
use toolglide_optimal::{Effort, Smoothing};
use toolglide_verify::USUAL_FREQUENCY;

/// Names of the languages of programs.
const DIALECTS: [&str; 5] = ["ngc", "fanuc", "840d", "cl", "printer"];

/// Plans smooth motion for machine tools and judges it.
#[derive(Debug, Parser)]
#[command(name = "toolglide", version, about, max_term_width = 100)]
pub(crate) struct CommandLine {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Plan a part program: set-points, summary, plot.
    Plan(PlanArgs),
    /// Judge set-points, whoever made them, against a program and the limits of a machine.
    Verify(VerifyArgs),
    /// Plan a part program by every method and show them side by side.
    Compare(CompareArgs),
    /// Execute a part program under an operator's commands: hold, override, resume, reverse, abort.
    Run(RunArgs),
    /// Hold every method against the time-optimal motion within the same limits and tolerance.
    Score(ScoreArgs),
    /// Read a part program only: what it holds, and all that is wrong with it.
    Check(CheckArgs),
    /// Plan the examples of the dissertation and compare with what it prints.
    Reproduce(ReproduceArgs),
    /// Show what the motion of several methods does to the modes of vibration of the machine.
    Spectrum(SpectrumArgs),
    /// Simulate drives, friction and flexible modes behind a motion: what arrives on the part.
    Simulate(SimulateArgs),
    /// Fit the drives of a machine to a recorded run.
    Identify(IdentifyArgs),
    /// List the machines there are, or describe one.
    Machines(MachinesArgs),
    /// Print completions for a shell.
    Completions {
        /// Which shell.
        shell: clap_complete::Shell,
    },
}

/// The program, and the limits that its motion must keep.
#[derive(Clone, Debug, Args)]
pub(crate) struct JobArgs {
    /// Part program (RS274/NGC; for plan and verify also tool poses in .apt, .cls or .ncl); - reads standard input.
    #[arg(value_name = "PROGRAM")]
    pub(crate) program: PathBuf,
    /// Registered machine, or machine file.
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "gantry")]
    pub(crate) machine: String,
    /// Language of the program [default: by its name and its first lines].
    #[arg(long, value_parser = DIALECTS)]
    pub(crate) dialect: Option<String>,
    /// Corner tolerance, mm; overrides the machine and the P of G64 in the program.
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) tolerance: Option<f64>,
    /// Largest velocity, mm/s: one number, or one per axis as in 500,500,250.
    #[arg(long, value_name = "V", value_parser = per_axis, allow_hyphen_values = true)]
    pub(crate) max_velocity: Option<PerAxis>,
    /// Largest acceleration, mm/s², as above.
    #[arg(long, value_name = "A", value_parser = per_axis, allow_hyphen_values = true)]
    pub(crate) max_acceleration: Option<PerAxis>,
    /// Largest jerk, mm/s³, as above.
    #[arg(long, value_name = "J", value_parser = per_axis, allow_hyphen_values = true)]
    pub(crate) max_jerk: Option<PerAxis>,
    /// Where the motion starts in the coordinates of the program, mm.
    #[arg(long, value_name = "X,Y,Z", value_parser = coordinates, allow_hyphen_values = true)]
    pub(crate) start: Option<PerAxis>,
    /// Skip what the program may ask for but a planner need not know, with warnings.
    #[arg(long)]
    pub(crate) lenient: bool,
    /// Tools of the machine: a tool table as LinuxCNC writes it, in mm.
    #[arg(long, value_name = "FILE.tbl")]
    pub(crate) tool_table: Option<PathBuf>,
    /// Value of a parameter that only the machine or the operator knows, as in _hal[cut.feed]=1200 or 31=5. May be
    /// given several times.
    #[arg(long = "parameter", value_name = "NAME=VALUE", value_parser = parameter)]
    pub(crate) parameters: Vec<(String, f64)>,
    /// Print one JSON object instead of the summary.
    #[arg(long)]
    pub(crate) json: bool,
}

impl JobArgs {
    /// A machine alone, without a program.
    pub(crate) fn for_machine(machine: &str, json: bool) -> Self {
        Self {
            program: PathBuf::new(),
            machine: machine.to_owned(),
            dialect: None,
            tolerance: None,
            max_velocity: None,
            max_acceleration: None,
            max_jerk: None,
            start: None,
            lenient: false,
            tool_table: None,
            parameters: Vec::new(),
            json,
        }
    }
}

/// What some methods can be told.
#[derive(Clone, Debug, Args)]
pub(crate) struct TuningArgs {
    /// Time constants of the filters of the methods fir and fir-p2p, s, as in 0.05,0.03 [default:
    /// those of the machine file, or notches on its modes, or as the limits and feedrates ask].
    #[arg(long, value_name = "T,T,...", value_parser = per_axis, allow_hyphen_values = true)]
    pub(crate) fir: Option<PerAxis>,
    /// How much planning the method optimal may do: from 1, quick, to 9, hardly anything left to gain.
    #[arg(long, value_name = "1-9", default_value_t = Effort::DEFAULT.level(),
        value_parser = clap::value_parser!(u8).range(1..=9))]
    pub(crate) effort: u8,
    /// Share of the limits that the plan leaves to holds and overrides while it is executed, 0 to 0.5 [default: 0; for
    /// run 0.01].
    #[arg(long, value_name = "SHARE", value_parser = reserve, allow_hyphen_values = true)]
    pub(crate) reserve: Option<Reserve>,
    /// How much slower than the fastest motion the method optimal may be to be smoother, percent of the time; 0 for
    /// the fastest.
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0 * Smoothing::DEFAULT.share(),
        value_parser = smoothing, allow_hyphen_values = true)]
    pub(crate) smooth: f64,
    /// Acceleration above this frequency is measured, Hz.
    #[arg(long, value_name = "HZ", default_value_t = USUAL_FREQUENCY, value_parser = positive,
        allow_hyphen_values = true)]
    pub(crate) above: f64,
    /// On which side of straight lines the method optimal stays: at corners on the inner one, or left or right of the
    /// line in the sense of the motion.
    #[arg(long, value_name = "SIDE")]
    pub(crate) side: Option<KeptSide>,
    /// How far it may go on the other side, mm.
    #[arg(long, value_name = "MM", default_value_t = 0.0, value_parser = overshoot, allow_hyphen_values = true,
        requires = "side")]
    pub(crate) overshoot: f64,
    /// Whether the method optimal leaves the modes of vibration of the machine at rest wherever it rests [default: on
    /// where the machine file has modes].
    #[arg(long, value_name = "on|off", num_args = 0..=1, default_missing_value = "on")]
    pub(crate) silent: Option<Silent>,
}

/// Whether modes of vibration must rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Silent {
    /// Wherever the motion rests.
    On,
    /// They may swing.
    Off,
}

/// Sides of lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum KeptSide {
    /// The inner side of every corner.
    Inside,
    /// Left of every line.
    Left,
    /// Right of every line.
    Right,
}

/// An overshoot in mm.
fn overshoot(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|length| (0.0..=LONGEST_OVERSHOOT).contains(length))
        .ok_or_else(|| format!("it must be a length from 0 to {LONGEST_OVERSHOOT} mm"))
}

/// Longest overshoot that is taken, mm.
const LONGEST_OVERSHOOT: f64 = 100.0;

/// A share of smoothing in percent.
fn smoothing(text: &str) -> Result<f64, String> {
    let most = 100.0 * Smoothing::MAX;
    text.parse::<f64>()
        .ok()
        .filter(|percent| Smoothing::new(percent / 100.0).is_some())
        .ok_or_else(|| format!("it must be a number from 0 to {most} percent"))
}

/// What tool poses need beside a program of straight axes.
#[derive(Debug, Args)]
pub(crate) struct PoseArgs {
    /// Tolerance of the tool tip, mm: another name of --tolerance.
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true, conflicts_with = "tolerance")]
    pub(crate) tip_tolerance: Option<f64>,
    /// How far the tool may turn away from its path, rad.
    #[arg(long, value_name = "RAD", value_parser = positive, allow_hyphen_values = true, default_value_t = 0.001)]
    pub(crate) orientation_tolerance: f64,
    /// Largest rate at which the tool turns, rad/s [default: what the axes allow].
    #[arg(long, value_name = "RAD/S", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) turn_rate: Option<f64>,
    /// Axis to turn about between tool orientations that point opposite ways, in workpiece coordinates.
    #[arg(long, value_name = "I,J,K", value_parser = coordinates, allow_hyphen_values = true)]
    pub(crate) turn_about: Option<PerAxis>,
    /// Poses that ns-jcb puts between those of the program, on every move.
    #[arg(long, value_name = "COUNT", default_value_t = 0)]
    pub(crate) way_points: u32,
}

/// What to plan.
#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    /// The program and the limits.
    #[command(flatten)]
    pub(crate) job: JobArgs,
    /// How corners are taken [default: kcs, and ns-dcb for tool poses].
    #[arg(long, value_parser = all_methods())]
    pub(crate) method: Option<String>,
    /// How tool poses are planned.
    #[command(flatten)]
    pub(crate) poses: PoseArgs,
    /// What the method is told.
    #[command(flatten)]
    pub(crate) tuning: TuningArgs,
    /// Time between two set-points, s [default: that of the machine].
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) period: Option<f64>,
    /// Stretch the motion between rests to whole periods, so that the last row is on the grid; for straight axes.
    #[arg(long)]
    pub(crate) round_to_period: bool,
    /// Write the set-points as CSV to a file; - is standard output.
    #[arg(short, long, value_name = "FILE.csv")]
    pub(crate) output: Option<PathBuf>,
    /// Write the tool pose behind the axes of every set-point; for machines with rotary axes.
    #[arg(long)]
    pub(crate) pose: bool,
    /// Draw the motion; the ending decides between .svg and .png.
    #[arg(long, value_name = "FILE.svg|.png")]
    pub(crate) plot: Option<PathBuf>,
    /// Write a page about the motion that opens from disk: path in 3-D, charts, program, where the time goes.
    #[arg(long, value_name = "FILE.html")]
    pub(crate) report: Option<PathBuf>,
}

/// What to execute.
#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// The program and the limits.
    #[command(flatten)]
    pub(crate) job: JobArgs,
    /// How corners are taken [default: kcs].
    #[arg(long, value_parser = methods())]
    pub(crate) method: Option<String>,
    /// What the method is told.
    #[command(flatten)]
    pub(crate) tuning: TuningArgs,
    /// Commands of the operator: a CSV file with the columns t_s, command, value; or random:SEED.
    #[arg(long, value_name = "FILE.csv|random:SEED")]
    pub(crate) events: Option<String>,
    /// Greatest feed override, for which the motion is planned.
    #[arg(long, value_name = "FACTOR", value_parser = positive, default_value_t = 2.0, allow_hyphen_values = true)]
    pub(crate) max_override: f64,
    /// Let the feed override slow down everything alike instead of capping the feedrate.
    #[arg(long)]
    pub(crate) uniform: bool,
    /// Time between two ticks, s [default: that of the machine].
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) period: Option<f64>,
    /// Write the executed set-points as CSV to a file; - is standard output.
    #[arg(short, long, value_name = "FILE.csv")]
    pub(crate) output: Option<PathBuf>,
    /// Write the rate of planned time and the state of the executor behind the axes of every set-point.
    #[arg(long)]
    pub(crate) rate: bool,
    /// Draw the executed motion with the commands; the ending decides between .svg and .png.
    #[arg(long, value_name = "FILE.svg|.png")]
    pub(crate) plot: Option<PathBuf>,
}

/// What to compare.
#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// The program and the limits.
    #[command(flatten)]
    pub(crate) job: JobArgs,
    /// Which methods, as in kcs,exact-stop [default: all but the reference].
    #[arg(long, value_name = "A,B,...", value_delimiter = ',', value_parser = methods())]
    pub(crate) methods: Vec<String>,
    /// What the method is told.
    #[command(flatten)]
    pub(crate) tuning: TuningArgs,
    /// Draw the feedrates of the methods; the ending decides between .svg and .png.
    #[arg(long, value_name = "FILE.svg|.png")]
    pub(crate) plot: Option<PathBuf>,
    /// Write a page about the motions that opens from disk: path in 3-D, charts, program, where the time goes.
    #[arg(long, value_name = "FILE.html")]
    pub(crate) report: Option<PathBuf>,
}

/// What to score.
#[derive(Debug, Args)]
pub(crate) struct ScoreArgs {
    /// The program and the limits.
    #[command(flatten)]
    pub(crate) job: JobArgs,
    /// Which methods, as in kcs,exact-stop [default: all but the reference itself].
    #[arg(long, value_name = "A,B,...", value_delimiter = ',', value_parser = methods())]
    pub(crate) methods: Vec<String>,
    /// What the method is told.
    #[command(flatten)]
    pub(crate) tuning: TuningArgs,
    /// Intervals of time of the optimum, at least; more are finer and slower.
    #[arg(long, value_name = "COUNT", default_value_t = 240,
        value_parser = clap::value_parser!(u16).range(8..=2000))]
    pub(crate) intervals: u16,
    /// Prove that no motion around a single corner is faster, however it shares its time; slow.
    #[arg(long)]
    pub(crate) certify: bool,
    /// Draw optimum and first method; the ending decides between .svg and .png.
    #[arg(long, value_name = "FILE.svg|.png")]
    pub(crate) plot: Option<PathBuf>,
}

/// What to check.
#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Part program; - reads standard input.
    #[arg(value_name = "PROGRAM")]
    pub(crate) program: PathBuf,
    /// Language of the program [default: by its name and its first lines].
    #[arg(long, value_parser = DIALECTS)]
    pub(crate) dialect: Option<String>,
    /// Tolerance where the program asks for none, mm: splines become chords within it.
    #[arg(long, value_name = "MM", value_parser = positive, default_value = "0.01", allow_hyphen_values = true)]
    pub(crate) tolerance: f64,
    /// Tools of the machine: a tool table as LinuxCNC writes it, in mm.
    #[arg(long, value_name = "FILE.tbl")]
    pub(crate) tool_table: Option<PathBuf>,
    /// Skip what the program may ask for but a planner need not know, with warnings.
    #[arg(long)]
    pub(crate) lenient: bool,
    /// Value of a parameter that only the machine or the operator knows, as in _hal[cut.feed]=1200 or 31=5. May be
    /// given several times.
    #[arg(long = "parameter", value_name = "NAME=VALUE", value_parser = parameter)]
    pub(crate) parameters: Vec<(String, f64)>,
    /// Print one JSON object instead of the text.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Whose spectra to show.
#[derive(Debug, Args)]
pub(crate) struct SpectrumArgs {
    /// The program and the limits.
    #[command(flatten)]
    pub(crate) job: JobArgs,
    /// Which methods.
    #[arg(long, value_name = "A,B,...", value_delimiter = ',', value_parser = methods(), default_value = "fir,kcs")]
    pub(crate) methods: Vec<String>,
    /// What some methods can be told.
    #[command(flatten)]
    pub(crate) tuning: TuningArgs,
    /// A mode of vibration, as in X,7.4 or X,7.4,0.01: axis, frequency in Hz, damping ratio; instead
    /// of those of the machine file. May be given several times.
    #[arg(long = "mode", value_name = "AXIS,HZ[,DAMPING]", value_parser = mode)]
    pub(crate) modes: Vec<ModeConfig>,
    /// Lowest and highest frequency of the spectra, Hz [default: a quarter of the lowest mode to twice the highest].
    #[arg(long, value_name = "HZ,HZ", value_parser = per_axis, allow_hyphen_values = true)]
    pub(crate) range: Option<PerAxis>,
    /// Draw the spectra; the ending decides between .svg and .png.
    #[arg(long, value_name = "FILE.svg|.png")]
    pub(crate) plot: Option<PathBuf>,
}

/// What to simulate.
#[derive(Debug, Args)]
pub(crate) struct SimulateArgs {
    /// The program and the limits.
    #[command(flatten)]
    pub(crate) job: JobArgs,
    /// Which methods, as in kcs,fir: one row each.
    #[arg(long = "method", alias = "methods", value_name = "A,B,...", value_delimiter = ',', value_parser = methods(),
        default_value = "kcs")]
    pub(crate) methods: Vec<String>,
    /// What some methods can be told.
    #[command(flatten)]
    pub(crate) tuning: TuningArgs,
    /// Time between two set-points, s [default: that of the machine].
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) period: Option<f64>,
    /// Simulate these set-points instead of a planned motion: CSV with the columns t_s, x_mm, y_mm, z_mm.
    #[arg(long, value_name = "ROWS.csv")]
    pub(crate) set_points: Option<PathBuf>,
    /// Drives to take where the machine file has none.
    #[arg(long, value_name = "NAME", value_parser = ["textbook"])]
    pub(crate) drive: Option<String>,
    /// Bandwidth of the position loop of all axes, Hz, instead of what the machine file says.
    #[arg(long, value_name = "HZ", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) bandwidth: Option<f64>,
    /// Feedforward of all axes: none, or some of velocity, acceleration, friction, zero-phase.
    #[arg(long, value_name = "A,B,...", value_delimiter = ',')]
    pub(crate) feedforward: Option<Vec<String>>,
    /// Leave the flexible modes out.
    #[arg(long)]
    pub(crate) rigid: bool,
    /// Leave friction out.
    #[arg(long)]
    pub(crate) no_friction: bool,
    /// How near to its end an axis counts as settled, µm or µrad.
    #[arg(long, value_name = "UM", value_parser = positive, allow_hyphen_values = true, default_value_t = 2.0)]
    pub(crate) window_um: f64,
    /// Fail where the part error exceeds this, mm.
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) require: Option<f64>,
    /// Vary one quantity, one row a value: jerk, acceleration, tolerance, bandwidth, or fir with time constants between
    /// colons, as in jerk=2e4,5e4 or fir=0.05:0.03,0.1:0.06.
    #[arg(long, value_name = "NAME=A,B,...", value_parser = sweep)]
    pub(crate) sweep: Option<Sweep>,
    /// Write every servo period as CSV to a file; - is standard output.
    #[arg(short, long, value_name = "FILE.csv")]
    pub(crate) output: Option<PathBuf>,
    /// Draw the errors; the ending decides between .svg and .png.
    #[arg(long, value_name = "FILE.svg|.png")]
    pub(crate) plot: Option<PathBuf>,
    /// Draw the frequency responses of the drives; the ending decides between .svg and .png.
    #[arg(long, value_name = "FILE.svg|.png")]
    pub(crate) response: Option<PathBuf>,
}

/// What to identify.
#[derive(Debug, Args)]
pub(crate) struct IdentifyArgs {
    /// Recorded run: CSV with the column t_s and, for each axis, planned_x, actual_x and where known force_x (per mass)
    /// and accel_x of what swings; mm and rad. What simulate writes with -o is one.
    #[arg(value_name = "MEASURED.csv")]
    pub(crate) recording: PathBuf,
    /// Registered machine, or machine file, whose drives are where the fit begins.
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub(crate) machine: String,
    /// Drives to begin with where the machine file has none.
    #[arg(long, value_name = "NAME", value_parser = ["textbook"])]
    pub(crate) drive: Option<String>,
    /// Bandwidth to begin with, Hz.
    #[arg(long, value_name = "HZ", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) bandwidth: Option<f64>,
    /// Print one JSON object instead of the text.
    #[arg(long)]
    pub(crate) json: bool,
}

/// What to reproduce.
#[derive(Debug, Args)]
pub(crate) struct ReproduceArgs {
    /// One section, figure or table [default: all].
    pub(crate) name: Option<String>,
    /// Print a JSON array instead of the table.
    #[arg(long)]
    pub(crate) json: bool,
}

/// What to judge.
#[derive(Debug, Args)]
pub(crate) struct VerifyArgs {
    /// The program and the limits.
    #[command(flatten)]
    pub(crate) job: JobArgs,
    /// How far the tool may turn away from its path, rad; for machines with rotary axes.
    #[arg(long, value_name = "RAD", value_parser = positive, allow_hyphen_values = true, default_value_t = 0.001)]
    pub(crate) orientation_tolerance: f64,
    /// Axis to turn about between tool orientations that point opposite ways, in workpiece coordinates.
    #[arg(long, value_name = "I,J,K", value_parser = coordinates, allow_hyphen_values = true)]
    pub(crate) turn_about: Option<PerAxis>,
    /// Set-points to judge: CSV with the columns t_s, x_mm, y_mm, z_mm.
    #[arg(value_name = "SETPOINTS.csv")]
    pub(crate) set_points: PathBuf,
}

/// Which machine to describe.
#[derive(Debug, Args)]
pub(crate) struct MachinesArgs {
    /// Registered machine, or machine file.
    pub(crate) name: Option<String>,
    /// Print the JSON Schema of machine files.
    #[arg(long, conflicts_with = "name")]
    pub(crate) schema: bool,
}

fn methods() -> PossibleValuesParser {
    PossibleValuesParser::new(
        METHODS
            .iter()
            .map(|method| PossibleValue::new(method.name).help(method.summary)),
    )
}

fn all_methods() -> PossibleValuesParser {
    PossibleValuesParser::new(
        METHODS
            .iter()
            .chain(crate::commands::poses::METHODS)
            .map(|method| PossibleValue::new(method.name).help(method.summary)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_sound() {
        CommandLine::command().debug_assert();
    }
}

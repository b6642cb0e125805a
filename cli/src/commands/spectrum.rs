//! Shows the effect of several methods on the modes of vibration of a machine.
//!
//! Source: section 4.2.2. Every piece of a motion passes through an oscillator for each mode, and through
//! one without damping for each frequency of the spectrum, so nothing is held but their states. Not
//! here: the oscillators.

use crate::commands::plan::{moves, title, warn};
use crate::error::CliError;
use crate::input::args::SpectrumArgs;
use crate::input::drives::{DriveChanges, Drives};
use crate::input::setup::Setup;
use crate::input::source::Source;
use crate::input::travel::{OnAxes, by_axes};
use crate::input::values::PerAxis;
use crate::methods::{Tuning, chosen, planner};
use crate::output::output_files::Drawing;
use crate::output::report::{Shown, quoted, show};
use crate::output::summary::worst_first;
use crate::pipeline::Lane;
use crate::plot::{Caption, Spectra, Spectrum};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::Write;
use toolglide_kinematics::{Mode, Move, Piece, Resonator, Vector};
use toolglide_simulation::{ModeOutcome, SimulationError, SimulationSettings, Simulator};
use toolglide_verify::Judge;

/// Frequencies of a spectrum.
const FREQUENCIES: u32 = 400;

/// The spectrum begins at this share of the lowest mode and ends at this multiple of the highest.
const FROM: f64 = 0.25;
/// As above.
const TO: f64 = 2.0;

/// Runs the command.
pub(crate) fn spectrum(
    args: &SpectrumArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let mut setup = Setup::new(&args.job, None)?;
    if !args.modes.is_empty() {
        setup.modes.clone_from(&args.modes);
        setup.modes_asked = "--mode".to_owned();
    }
    by_axes!(setup.axes.len(), run(args, &setup, out, err))
}

/// A mode and the axis that excites it.
#[derive(Clone, Copy, Debug)]
struct Excited {
    axis: usize,
    mode: Mode,
}

/// The oscillators under one motion.
#[derive(Clone, Debug)]
struct Oscillators {
    modes: Vec<(usize, Resonator)>,
    /// For each axis with modes, one for each frequency.
    spectra: Vec<(usize, Vec<Resonator>)>,
}

impl Oscillators {
    fn new(modes: &[Excited], axes: &[usize], frequencies: &[f64]) -> Result<Self, CliError> {
        let spectrum = frequencies
            .iter()
            .map(|&frequency| {
                Resonator::at_frequency(frequency).map_err(CliError::mode("spectrum"))
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self {
            modes: modes
                .iter()
                .map(|excited| (excited.axis, Resonator::new(&excited.mode)))
                .collect(),
            spectra: axes.iter().map(|&axis| (axis, spectrum.clone())).collect(),
        })
    }

    fn pass<const N: usize>(&mut self, piece: &Piece<N>) {
        let start = piece.at(0.0);
        let duration = piece.duration();
        for (axis, resonator) in &mut self.modes {
            resonator.pass(start.acceleration[*axis], start.jerk[*axis], duration);
        }
        for (axis, resonators) in &mut self.spectra {
            let (acceleration, jerk) = (start.acceleration[*axis], start.jerk[*axis]);
            for resonator in resonators {
                resonator.pass(acceleration, jerk, duration);
            }
        }
    }
}

/// All that is shown.
#[derive(Clone, Debug, Serialize)]
struct Found {
    program: String,
    machine: String,
    time_constants_s: Option<Vec<f64>>,
    methods: Vec<Row>,
    frequencies_hz: Vec<f64>,
}

/// What one method does.
#[derive(Clone, Debug, Serialize)]
struct Row {
    method: String,
    cycle_time_s: f64,
    violations: u64,
    modes: Vec<Left>,
    /// Spectra of the accelerations, mm/s, by axis.
    spectra: Vec<Magnitudes>,
    #[serde(skip)]
    worst: Vec<String>,
}

/// What is left of a mode at the end of the motion.
#[derive(Clone, Debug, Serialize)]
struct Left {
    axis: char,
    frequency_hz: f64,
    damping: f64,
    left_um: f64,
    left_mm_s2: f64,
    /// What is left behind the drives, where the machine file describes them.
    #[serde(skip_serializing_if = "Option::is_none")]
    left_at_the_machine_um: Option<f64>,
}

/// The spectrum of the acceleration of an axis.
#[derive(Clone, Debug, Serialize)]
struct Magnitudes {
    axis: char,
    magnitudes_mm_s: Vec<f64>,
}

fn run<const N: usize>(
    args: &SpectrumArgs,
    setup: &Setup,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError>
where
    Move<N>: OnAxes,
{
    let modes = excited(setup)?;
    let tuning = Tuning::of(&args.tuning, setup)?;
    let drawing = Drawing::begin(args.plot.as_deref(), &args.job)?;
    let source = Source::open(&args.job.program, args.job.dialect.as_deref())?;
    let name = source.name.clone();
    let frequencies = frequencies(&modes, args.range.as_ref(), setup)?;
    let mut axes: Vec<usize> = modes.iter().map(|excited| excited.axis).collect();
    axes.sort_unstable();
    axes.dedup();
    let names = chosen(&args.methods);
    let (start, limits) = (setup.start::<N>(), setup.limits::<N>());
    let mut lanes = names
        .iter()
        .map(|method| {
            let planner = planner(method, start, limits, &tuning)?;
            let oscillators = Oscillators::new(&modes, &axes, &frequencies)?;
            let simulator = simulator(setup, start)?;
            let lane = Lane::new(planner, Judge::new(start, limits));
            Ok((lane, oscillators, simulator))
        })
        .collect::<Result<Vec<_>, CliError>>()?;
    let mut moves = moves::<N>(&args.job, setup, source)?;
    let mut batch = Vec::new();
    loop {
        let more = moves.fill(&mut batch)?;
        for (lane, oscillators, simulator) in &mut lanes {
            lane.run(&batch, !more, &name, |piece, _| {
                oscillators.pass(piece);
                match simulator {
                    Some(simulator) => simulator.observe(piece).map_err(refused(&name)),
                    None => Ok(()),
                }
            })?;
        }
        if !more {
            break;
        }
    }
    warn(moves.program.program(), err);
    let methods = names
        .iter()
        .zip(lanes)
        .map(|(method, (lane, oscillators, simulator))| {
            let (report, _) = lane.finish();
            let behind = match simulator {
                Some(simulator) => simulator.finish().map_err(refused(&name))?.modes,
                None => Vec::new(),
            };
            Ok(Row {
                method: method.clone(),
                cycle_time_s: report.cycle_time,
                violations: report.violations,
                modes: left(setup, &modes, &oscillators, &behind),
                spectra: magnitudes(setup, &oscillators),
                worst: worst_first(&report.examples),
            })
        })
        .collect::<Result<Vec<_>, CliError>>()?;
    let spectra = Found {
        program: name,
        machine: setup.machine.clone(),
        time_constants_s: tuning.filters.map(|chain| chain.time_constants().to_vec()),
        methods,
        frequencies_hz: frequencies,
    };
    if let Some(mut drawing) = drawing {
        drawing.write(&spectra.draw(setup, &modes))?;
        drawing.commit()?;
    }
    show(&spectra, args.job.json, out, err)
}

/// The modes of the run, each of an axis that there is.
fn excited(setup: &Setup) -> Result<Vec<Excited>, CliError> {
    let refused = |value: String, bound: String| CliError::Option {
        option: "--mode",
        value,
        bound,
    };
    if setup.modes.is_empty() {
        return Err(refused(
            "none".to_owned(),
            "a spectrum needs a mode, here or in the machine file".to_owned(),
        ));
    }
    setup
        .modes
        .iter()
        .map(|mode| {
            let axis = setup.axes.iter().position(|axis| axis.name == mode.axis);
            let axis = axis.ok_or_else(|| {
                let letters: String = setup.letters().into_iter().collect();
                refused(
                    format!("axis {}", mode.axis),
                    format!("the machine has axes {letters}"),
                )
            })?;
            let mode = Mode::new(mode.frequency_hz, mode.damping).map_err(|reason| {
                refused(
                    format!("{},{},{}", mode.axis, mode.frequency_hz, mode.damping),
                    reason.to_string(),
                )
            })?;
            let nyquist = 0.5 / setup.period.seconds();
            if mode.frequency() >= nyquist {
                return Err(refused(
                    format!("{} Hz", mode.frequency()),
                    format!("half the frequency of the set-points is {nyquist} Hz"),
                ));
            }
            Ok(Excited { axis, mode })
        })
        .collect()
}

fn frequencies(
    modes: &[Excited],
    range: Option<&PerAxis>,
    setup: &Setup,
) -> Result<Vec<f64>, CliError> {
    let of = |excited: &Excited| excited.mode.frequency();
    let (lowest, highest) = match range {
        None => (
            FROM * modes.iter().map(of).fold(f64::INFINITY, f64::min),
            TO * modes.iter().map(of).fold(0.0, f64::max),
        ),
        Some(range) => {
            let nyquist = 0.5 / setup.period.seconds();
            match range.0[..] {
                [lowest, highest] if lowest < highest && highest < nyquist => (lowest, highest),
                _ => {
                    return Err(CliError::Option {
                        option: "--range",
                        value: format!("{:?}", range.0),
                        bound: format!(
                            "it must be two frequencies, the lower first, below half the frequency of the set-points, {nyquist} Hz"
                        ),
                    });
                }
            }
        }
    };
    Ok((0..FREQUENCIES)
        .map(|index| f64::from(index) / f64::from(FREQUENCIES - 1))
        .map(|share| lowest + share * (highest - lowest))
        .collect())
}

/// The drives of the machine, where its file describes them.
fn simulator<const N: usize>(
    setup: &Setup,
    start: Vector<N>,
) -> Result<Option<Simulator<N>>, CliError> {
    if setup.drives.is_none() {
        return Ok(None);
    }
    let drives = Drives::of(setup, &DriveChanges::default())?;
    let settings = SimulationSettings {
        period: setup.period.seconds(),
        interpolation: drives.interpolation,
        window: 0.002,
    };
    Simulator::new(&drives.axes, start, settings)
        .map(Some)
        .map_err(refused(&setup.asked))
}

fn refused(program: &str) -> impl Fn(SimulationError) -> CliError {
    move |reason| CliError::Simulation {
        program: program.to_owned(),
        reason,
    }
}

fn left(
    setup: &Setup,
    modes: &[Excited],
    oscillators: &Oscillators,
    behind: &[ModeOutcome],
) -> Vec<Left> {
    modes
        .iter()
        .zip(&oscillators.modes)
        .map(|(excited, (axis, resonator))| Left {
            axis: setup.axes[*axis].name,
            frequency_hz: excited.mode.frequency(),
            damping: excited.mode.damping(),
            left_um: 1e3 * resonator.displacement(),
            left_mm_s2: resonator.acceleration(),
            left_at_the_machine_um: behind
                .iter()
                .find(|mode| {
                    mode.axis == setup.axes[*axis].name
                        && (mode.frequency - excited.mode.frequency()).abs() < 1e-9
                })
                .map(|mode| 1e3 * mode.left),
        })
        .collect()
}

fn magnitudes(setup: &Setup, oscillators: &Oscillators) -> Vec<Magnitudes> {
    oscillators
        .spectra
        .iter()
        .map(|(axis, resonators)| Magnitudes {
            axis: setup.axes[*axis].name,
            magnitudes_mm_s: resonators.iter().map(Resonator::spectrum).collect(),
        })
        .collect()
}

impl Shown for Found {
    fn text(&self) -> String {
        let mut text = format!("{}: modes of {}", self.program, self.machine);
        if let Some(time_constants) = &self.time_constants_s {
            let list: Vec<_> = time_constants
                .iter()
                .map(|length| format!("{:.1}", 1e3 * length))
                .collect();
            let _ = write!(text, ", filters of {} ms", list.join(" and "));
        }
        let _ = write!(
            text,
            "\n\n{:<18} {:>14} {:>5} {:>9} {:>9} {:>10} {:>12} {:>14}{}\n",
            "method",
            "cycle time, s",
            "axis",
            "mode, Hz",
            "damping",
            "left, µm",
            "left, mm/s²",
            "spectrum, mm/s",
            if self.has_drives() {
                " at the machine, µm"
            } else {
                ""
            }
        );
        for row in &self.methods {
            for left in &row.modes {
                let spectrum = row
                    .spectra
                    .iter()
                    .find(|spectrum| spectrum.axis == left.axis)
                    .map_or(0.0, |spectrum| self.near(spectrum, left.frequency_hz));
                let _ = writeln!(
                    text,
                    "{:<18} {:>14.4} {:>5} {:>9.2} {:>9.4} {:>10.3} {:>12.2} {:>14.3}{}",
                    row.method,
                    row.cycle_time_s,
                    left.axis,
                    left.frequency_hz,
                    left.damping,
                    left.left_um,
                    left.left_mm_s2,
                    spectrum,
                    left.left_at_the_machine_um
                        .map_or_else(String::new, |left| format!(" {left:>19.3}"))
                );
            }
        }
        text
    }

    fn complaint(&self) -> String {
        self.methods
            .iter()
            .map(|row| {
                let whose = format!("{}: {}", self.program, row.method);
                quoted(&whose, &row.worst, row.violations)
            })
            .collect()
    }

    fn passes(&self) -> bool {
        self.methods.iter().all(|row| row.violations == 0)
    }
}

impl Found {
    /// Whether anything is known of what is left at the machine.
    fn has_drives(&self) -> bool {
        let mut modes = self.methods.iter().flat_map(|row| &row.modes);
        modes.any(|left| left.left_at_the_machine_um.is_some())
    }

    /// The magnitude at the frequency of the spectrum that is nearest.
    fn near(&self, spectrum: &Magnitudes, frequency: f64) -> f64 {
        let after = self
            .frequencies_hz
            .partition_point(|&other| other < frequency);
        spectrum.magnitudes_mm_s.get(after).copied().unwrap_or(0.0)
    }

    fn draw(&self, setup: &Setup, modes: &[Excited]) -> String {
        let names: Vec<String> = self.methods.iter().map(|row| row.method.clone()).collect();
        let Some(first) = self.methods.first() else {
            return String::new();
        };
        let axes: Vec<Spectra> = first
            .spectra
            .iter()
            .enumerate()
            .map(|(index, spectrum)| Spectra {
                axis: spectrum.axis,
                modes: modes
                    .iter()
                    .filter(|excited| setup.axes[excited.axis].name == spectrum.axis)
                    .map(|excited| excited.mode.frequency())
                    .collect(),
                of: self
                    .methods
                    .iter()
                    .filter_map(|row| row.spectra.get(index))
                    .map(|spectrum| Spectrum {
                        magnitudes: spectrum.magnitudes_mm_s.clone(),
                    })
                    .collect(),
            })
            .collect();
        let caption = Caption {
            title: title(&self.program),
            subtitle: format!("spectra of {} motions on {}", names.len(), self.machine),
        };
        Spectra::draw(&axes, &self.frequencies_hz, &names, &caption)
    }
}

//! Turns the drives of a machine file into drives that can be simulated.
//!
//! Source: forces in N divided by the mass give mm/s² times 1000; rotary axes are in rad. Not here: the drive itself.

use crate::error::CliError;
use crate::input::setup::Setup;
use toolglide_kinematics::AxisKind;
use toolglide_machines::{
    DriveConfig, FeedforwardConfig, FrictionConfig, InterpolationConfig, MeasuresConfig,
};
use toolglide_simulation::{
    DriveError, DriveModel, DriveSettings, DrivenAxis, Feedforward, FlexibleMode, GainSettings,
    Gains, Interpolation,
};

/// Bandwidth of the textbook drive where nobody says another, Hz.
const TEXTBOOK_BANDWIDTH: f64 = 35.0;

/// An arc second, rad.
const ARC_SECOND: f64 = std::f64::consts::PI / 648_000.0;

/// What to add to a machine file that has no drives.
const LINES: &str = "\n    [drive]\n    bandwidth_hz = 35\n    friction = { coulomb_mm_s2 = 400, static_mm_s2 = 520, stribeck_mm_s = 5, presliding_um = 20 }";

/// What the command line changes about drives.
#[derive(Clone, Debug, Default)]
pub(crate) struct DriveChanges {
    /// Take the textbook drive where the machine file has none.
    pub(crate) textbook: bool,
    /// Another bandwidth, Hz.
    pub(crate) bandwidth: Option<f64>,
    /// Another feedforward: names.
    pub(crate) feedforward: Option<Vec<String>>,
    /// No flexible modes.
    pub(crate) rigid: bool,
    /// No friction.
    pub(crate) no_friction: bool,
}

/// The drives of a machine.
#[derive(Clone, Debug)]
pub(crate) struct Drives {
    /// One for each axis.
    pub(crate) axes: Vec<DrivenAxis>,
    /// How set-points are refined.
    pub(crate) interpolation: Interpolation,
    /// Whether they are the textbook drives.
    pub(crate) textbook: bool,
}

impl Drives {
    /// The drives of a run.
    pub(crate) fn of(setup: &Setup, changes: &DriveChanges) -> Result<Self, CliError> {
        let textbook = setup.drives.is_none();
        let configs = match &setup.drives {
            Some(configs) => configs.clone(),
            None if changes.textbook => vec![DriveConfig::default(); setup.axes.len()],
            None => {
                return Err(CliError::Option {
                    option: "--machine",
                    value: format!("{} without [drive]", setup.asked),
                    bound: format!(
                        "its drives must be known: take --drive textbook, or add to the machine file lines such as{LINES}"
                    ),
                });
            }
        };
        let interpolation = match configs.first().and_then(|config| config.interpolation) {
            Some(InterpolationConfig::Linear) => Interpolation::Linear,
            _ => Interpolation::Cubic,
        };
        let axes = (0..setup.axes.len())
            .map(|index| {
                let axis = &setup.axes[index];
                let refuse = |reason: DriveError| CliError::Drive {
                    asked: setup.asked.clone(),
                    axis: axis.name,
                    reason,
                };
                let mut config = configs[index];
                if let Some(bandwidth) = changes.bandwidth {
                    config = DriveConfig {
                        bandwidth_hz: Some(bandwidth),
                        ..DriveConfig::default()
                    }
                    .over(config);
                }
                let settings = settings(setup, index, &config, changes).map_err(refuse)?;
                let model = DriveModel::new(&settings).map_err(refuse)?;
                Ok(DrivenAxis {
                    name: axis.name,
                    model,
                    coordinate: "XYZ".find(axis.name),
                })
            })
            .collect::<Result<Vec<_>, CliError>>()?;
        Ok(Self {
            axes,
            interpolation,
            textbook,
        })
    }
}

/// The drive of one axis in mm or rad; degrees where the run counts an axis in degrees.
fn settings(
    setup: &Setup,
    index: usize,
    config: &DriveConfig,
    changes: &DriveChanges,
) -> Result<DriveSettings, DriveError> {
    let axis = &setup.axes[index];
    let rotary = axis.kind == AxisKind::Rotary;
    let period = setup.period.seconds();
    let usual = if rotary {
        DriveSettings::textbook_rotary(TEXTBOOK_BANDWIDTH)
    } else {
        DriveSettings::textbook(TEXTBOOK_BANDWIDTH)
    };
    let mass = mass(config, rotary)?;
    let feedforward = feedforward(usual.feedforward, config.feedforward, changes)?;
    let servo_period = config
        .servo_period_s
        .unwrap_or_else(|| usual_period(period));
    let mut settings = DriveSettings {
        servo_period,
        gains: gains(config, usual.gains)?,
        feedforward,
        current_loop: config.current_loop_hz.unwrap_or(usual.current_loop),
        dead_time: config.dead_time_s.unwrap_or(servo_period),
        velocity_filter: config.velocity_filter_hz.or(usual.velocity_filter),
        encoder_step: length(
            ("encoder_um", config.encoder_um),
            ("encoder_arcsec", config.encoder_arcsec),
            rotary,
        )?
        .unwrap_or(usual.encoder_step),
        force_limit: force_limit(config, rotary, mass)?.unwrap_or(usual.force_limit),
        backlash: length(
            ("backlash_um", config.backlash_um),
            ("backlash_arcsec", config.backlash_arcsec),
            rotary,
        )?
        .unwrap_or(0.0),
        measures_motor: config.measures == Some(MeasuresConfig::Motor),
        modes: modes(setup, axis.name),
        ..usual
    };
    if let Some(given) = config.friction {
        friction(&mut settings, &given, rotary, mass)?;
    }
    if settings.measures_motor
        && let Some(mode) = settings.modes.iter().find(|mode| mode.at_encoder > 0.0)
    {
        return Err(DriveError::new(
            "mode: encoder",
            mode.at_encoder,
            "0 where the encoder measures the motor",
        ));
    }
    if changes.no_friction {
        settings = settings.without_friction();
    }
    if changes.rigid {
        settings = settings.rigid();
    }
    // Machines that carry out the words of a program as they are count rotary axes in degrees.
    if rotary && setup.counts_degrees {
        scale(&mut settings, 1.0_f64.to_degrees());
    }
    Ok(settings)
}

/// A servo period that divides that of the set-points: 0.1 ms where it does.
fn usual_period(period: f64) -> f64 {
    let parts = (period / 1e-4).round().max(1.0);
    period / parts
}

fn both(one: &str, other: &str) -> DriveError {
    DriveError::new(one, format!("given beside {other}"), "given alone")
}

/// Mass in kg or inertia in kg m².
fn mass(config: &DriveConfig, rotary: bool) -> Result<Option<f64>, DriveError> {
    let (field, value) = if rotary {
        ("inertia_kg_m2", config.inertia_kg_m2)
    } else {
        ("mass_kg", config.mass_kg)
    };
    match value {
        Some(value) if !(value > 0.0 && value.is_finite()) => {
            Err(DriveError::new(field, value, "positive and finite"))
        }
        other => Ok(other),
    }
}

/// A length in µm of a linear axis or in arc seconds of a rotary one, as mm or rad. What `[drive]` says of the other kind
/// concerns other axes.
fn length(
    linear: (&str, Option<f64>),
    turn: (&str, Option<f64>),
    rotary: bool,
) -> Result<Option<f64>, DriveError> {
    let ((field, value), unit) = if rotary {
        (turn, ARC_SECOND)
    } else {
        (linear, 1e-3)
    };
    match value {
        Some(value) if !(value >= 0.0 && value.is_finite()) => {
            Err(DriveError::new(field, value, "finite and not negative"))
        }
        other => Ok(other.map(|value| value * unit)),
    }
}

/// A specific force from a force, which needs the mass, or from itself.
fn specific(
    force: (&'static str, Option<f64>),
    direct: (&'static str, Option<f64>),
    rotary: bool,
    mass: Option<f64>,
) -> Result<Option<f64>, DriveError> {
    let unit = if rotary { 1.0 } else { 1e3 };
    match (force, direct) {
        ((one, Some(_)), (other, Some(_))) => Err(both(one, other)),
        ((field, Some(value)), _) => match mass {
            Some(mass) if value >= 0.0 && value.is_finite() => Ok(Some(unit * value / mass)),
            Some(_) => Err(DriveError::new(field, value, "finite and not negative")),
            None => Err(DriveError::new(
                field,
                value,
                if rotary {
                    "given beside inertia_kg_m2"
                } else {
                    "given beside mass_kg"
                },
            )),
        },
        (_, (field, Some(value))) if !(value >= 0.0 && value.is_finite()) => {
            Err(DriveError::new(field, value, "finite and not negative"))
        }
        (_, (_, direct)) => Ok(direct),
    }
}

fn force_limit(
    config: &DriveConfig,
    rotary: bool,
    mass: Option<f64>,
) -> Result<Option<f64>, DriveError> {
    if rotary {
        specific(
            ("torque_limit_nm", config.torque_limit_nm),
            ("torque_limit_rad_s2", config.torque_limit_rad_s2),
            rotary,
            mass,
        )
    } else {
        specific(
            ("force_limit_n", config.force_limit_n),
            ("force_limit_mm_s2", config.force_limit_mm_s2),
            rotary,
            mass,
        )
    }
}

fn friction(
    settings: &mut DriveSettings,
    given: &FrictionConfig,
    rotary: bool,
    mass: Option<f64>,
) -> Result<(), DriveError> {
    let forces = |field: [&'static str; 4], n, s, nm, rs| {
        let (force, direct) = if rotary {
            ((field[2], nm), (field[3], rs))
        } else {
            ((field[0], n), (field[1], s))
        };
        specific(force, direct, rotary, mass)
    };
    let coulomb = forces(
        [
            "friction: coulomb_n",
            "friction: coulomb_mm_s2",
            "friction: coulomb_nm",
            "friction: coulomb_rad_s2",
        ],
        given.coulomb_n,
        given.coulomb_mm_s2,
        given.coulomb_nm,
        given.coulomb_rad_s2,
    )?;
    let resting = forces(
        [
            "friction: static_n",
            "friction: static_mm_s2",
            "friction: static_nm",
            "friction: static_rad_s2",
        ],
        given.static_n,
        given.static_mm_s2,
        given.static_nm,
        given.static_rad_s2,
    )?;
    let law = &mut settings.friction;
    match (coulomb, resting) {
        (Some(coulomb), Some(resting)) => (law.coulomb, law.static_force) = (coulomb, resting),
        // Without a word on static friction there is none beyond Coulomb friction.
        (Some(coulomb), None) => (law.coulomb, law.static_force) = (coulomb, coulomb),
        (None, Some(resting)) => law.static_force = resting,
        (None, None) => {}
    }
    let stribeck = if rotary {
        given.stribeck_deg_s.map(f64::to_radians)
    } else {
        given.stribeck_mm_s
    };
    law.stribeck = stribeck.unwrap_or(law.stribeck);
    let presliding = length(
        ("friction: presliding_um", given.presliding_um),
        ("friction: presliding_arcsec", given.presliding_arcsec),
        rotary,
    )?;
    law.presliding = presliding.unwrap_or(law.presliding);
    let (field, force) = if rotary {
        ("friction: viscous_nm_s_rad", given.viscous_nm_s_rad)
    } else {
        ("friction: viscous_n_s_m", given.viscous_n_s_m)
    };
    match (force, given.viscous_per_s) {
        (Some(_), Some(_)) => return Err(both(field, "friction: viscous_per_s")),
        (Some(force), None) => {
            let bound = if rotary {
                "given beside inertia_kg_m2"
            } else {
                "given beside mass_kg"
            };
            let mass = mass.ok_or_else(|| DriveError::new(field, force, bound))?;
            settings.viscous = force / mass;
        }
        (None, Some(rate)) => settings.viscous = rate,
        (None, None) => {}
    }
    Ok(())
}

fn gains(config: &DriveConfig, usual: GainSettings) -> Result<GainSettings, DriveError> {
    if let Some(bandwidth) = config.bandwidth_hz
        && config.has_gains()
    {
        return Err(DriveError::new(
            "bandwidth_hz",
            format!("{bandwidth} beside gains"),
            "given alone, or gains without it",
        ));
    }
    let missing = |field: &str, beside: &str| {
        DriveError::new(field, "missing", format!("given beside {beside}"))
    };
    if !config.has_gains() {
        let GainSettings::Bandwidth {
            frequency,
            velocity_ratio,
            velocity_damping,
        } = usual
        else {
            return Ok(usual);
        };
        return Ok(GainSettings::Bandwidth {
            frequency: config.bandwidth_hz.unwrap_or(frequency),
            velocity_ratio: config.velocity_ratio.unwrap_or(velocity_ratio),
            velocity_damping: config.velocity_damping.unwrap_or(velocity_damping),
        });
    }
    let position = config
        .position_gain
        .ok_or_else(|| missing("position_gain", "the gains of the velocity loop"))?;
    match (config.velocity_gain, config.velocity_loop_hz) {
        (Some(_), Some(_)) => Err(both("velocity_gain", "velocity_loop_hz")),
        (Some(velocity), None) => match (config.integral_gain, config.integral_time_s) {
            (Some(_), Some(_)) => Err(both("integral_gain", "integral_time_s")),
            (integral, None) => Ok(GainSettings::Direct(Gains {
                position,
                velocity,
                integral: integral.unwrap_or(0.0),
            })),
            (None, Some(time)) => Ok(GainSettings::Controls {
                position_gain: position,
                velocity_loop: velocity / std::f64::consts::TAU,
                integral_time: time,
            }),
        },
        (None, Some(velocity_loop)) => match config.integral_gain {
            Some(_) => Err(both("integral_gain", "velocity_loop_hz")),
            None => Ok(GainSettings::Controls {
                position_gain: position,
                velocity_loop,
                integral_time: config.integral_time_s.unwrap_or(0.0),
            }),
        },
        (None, None) => Err(missing("velocity_gain", "position_gain")),
    }
}

fn feedforward(
    usual: Feedforward,
    given: Option<FeedforwardConfig>,
    changes: &DriveChanges,
) -> Result<Feedforward, DriveError> {
    let given = given.unwrap_or_default();
    let mut forward = Feedforward {
        velocity: given.velocity.unwrap_or(usual.velocity),
        acceleration: given.acceleration.unwrap_or(usual.acceleration),
        friction: given.friction.unwrap_or(usual.friction),
        zero_phase: given.zero_phase.unwrap_or(usual.zero_phase),
        ..usual
    };
    let Some(names) = &changes.feedforward else {
        return Ok(forward);
    };
    forward = Feedforward {
        velocity: 0.0,
        acceleration: 0.0,
        friction: false,
        zero_phase: false,
        ..usual
    };
    for name in names {
        match name.as_str() {
            "velocity" => forward.velocity = 1.0,
            "acceleration" => forward.acceleration = 1.0,
            "friction" => forward.friction = true,
            "zero-phase" => forward.zero_phase = true,
            "none" => {}
            other => {
                return Err(DriveError::new(
                    "--feedforward",
                    format!("\"{other}\""),
                    "none, or some of velocity, acceleration, friction and zero-phase",
                ));
            }
        }
    }
    Ok(forward)
}

fn modes(setup: &Setup, axis: char) -> Vec<FlexibleMode> {
    setup
        .modes
        .iter()
        .filter(|mode| mode.axis == axis)
        .map(|mode| FlexibleMode {
            frequency: mode.frequency_hz,
            damping: mode.damping,
            mass_share: mode.mass_share,
            at_encoder: mode.encoder,
            at_tool: mode.tool,
        })
        .collect()
}

/// The same drive with lengths in another unit.
fn scale(settings: &mut DriveSettings, unit: f64) {
    settings.encoder_step *= unit;
    settings.force_limit *= unit;
    settings.backlash *= unit;
    settings.friction.coulomb *= unit;
    settings.friction.static_force *= unit;
    settings.friction.stribeck *= unit;
    settings.friction.presliding *= unit;
    settings.feedforward.friction_velocity *= unit;
}

//! Plans tables 5.1 and 5.2: tool poses without a machine, as the dissertation does.
//!
//! Tolerances are as printed: 800 µm and 0.02 rad for table 5.1, 200 µm and 1 mrad for table 5.2. The feedrate of
//! table 5.2 is not printed; ours is the best match of what is said about it. Not here: machines with limits.

use crate::error::CliError;
use toolglide_fir::FilterChain;
use toolglide_fiveaxis::{PoseMethod, PosePlanner, PoseSampler, PoseSettings};
use toolglide_kinematics::{
    AxisKind, AxisVector, Feedrate, MachineKinematics, OrientationTolerance, PoseFeed, PoseLeg,
    PosePiece, SamplePeriod, Tolerance, ToolPose, Vector,
};
use toolglide_machines::find;
use toolglide_simulation::{
    DriveModel, DriveSettings, DrivenAxis, Feedforward, Friction, Interpolation, PoseOutcome,
    PoseSetPoint, PoseSimulator, SimulationSettings,
};

/// Time constants of chapter 5, s.
const TIME_CONSTANTS: [f64; 2] = [0.1, 0.06];

/// Servo period of the mill of section 5.4, s.
const SERVO_PERIOD: f64 = 1e-3;

/// A drive of the mill of section 5.4: about 20 Hz without feedforward at a servo period of 1 ms, as printed; friction is ours.
fn mill_drive(kind: AxisKind) -> DriveSettings {
    let (coulomb, stribeck, presliding, encoder_step) = match kind {
        AxisKind::Linear => (300.0, 2.0, 0.01, 1e-4),
        AxisKind::Rotary => (5.0, 0.02, 2e-4, 5e-6),
    };
    DriveSettings {
        servo_period: SERVO_PERIOD,
        dead_time: SERVO_PERIOD,
        current_loop: 1000.0,
        velocity_filter: Some(1000.0),
        feedforward: Feedforward::NONE,
        encoder_step,
        viscous: 5.0,
        friction: Friction {
            coulomb,
            static_force: 1.3 * coulomb,
            stribeck,
            presliding,
        },
        ..DriveSettings::textbook(20.0)
    }
}

/// A path of poses and how it is followed.
#[derive(Debug)]
pub(super) struct PosePath {
    pub(super) name: &'static str,
    pub(super) rows: &'static [[f64; 6]],
    /// mm/s
    pub(super) speed: f64,
    /// Tolerances of tip and orientation, mm and rad.
    pub(super) tolerances: [f64; 2],
}

const ROWS_5_1: [[f64; 6]; 3] = [
    [0.0, 0.0, 0.0, -0.1302, -0.3906, 0.9113],
    [17.6090, 8.8045, 3.5218, 0.4262, 0.0947, 0.8997],
    [1.8059, 13.1032, 15.0015, -0.1255, 0.3137, 0.9412],
];

const ROWS_5_2: [[f64; 6]; 16] = [
    [0.0, 0.0, 0.0, 0.5025, 0.5025, 0.7035],
    [100.0, 0.0, 0.0, -0.5025, 0.5025, 0.7035],
    [100.0, 100.0, 0.0, -0.5025, -0.5025, 0.7035],
    [50.0, 100.0, 10.0, 0.0, -0.3511, 0.9363],
    [40.0, 70.0, 20.0, 0.1562, -0.3123, 0.9370],
    [10.0, 70.0, 10.0, 0.2357, -0.2357, 0.9428],
    [30.0, 45.0, 20.0, 0.3162, 0.0, 0.9487],
    [20.0, 10.0, 10.0, 0.2357, 0.2357, 0.9428],
    [50.0, 30.0, 20.0, 0.0, 0.3162, 0.9487],
    [80.0, 10.0, 10.0, -0.2357, 0.2357, 0.9428],
    [70.0, 45.0, 20.0, -0.3162, 0.0, 0.9487],
    [90.0, 70.0, 10.0, -0.2357, -0.2357, 0.9428],
    [60.0, 70.0, 20.0, -0.1562, -0.3123, 0.9370],
    [50.0, 100.0, 10.0, 0.0, -0.3511, 0.9363],
    [0.0, 100.0, 0.0, 0.5025, -0.5025, 0.7035],
    [0.0, 0.0, 0.0, 0.5025, 0.5025, 0.7035],
];

/// Two moves, with the printed tolerances.
pub(super) static TABLE_5_1: PosePath = PosePath {
    name: "three poses",
    rows: &ROWS_5_1,
    speed: 100.0,
    tolerances: [0.8, 0.02],
};

/// The star at the feedrate at which a corner falls where the text says.
pub(super) static STAR_50: PosePath = PosePath {
    name: "star at 50 mm/s",
    rows: &ROWS_5_2,
    speed: 50.0,
    tolerances: [0.2, 0.001],
};

/// The star at twice that feedrate.
pub(super) static STAR_100: PosePath = PosePath {
    name: "star at 100 mm/s",
    rows: &ROWS_5_2,
    speed: 100.0,
    tolerances: [0.2, 0.001],
};

fn refuse(name: &str, reason: impl std::fmt::Display) -> CliError {
    CliError::Line {
        program: name.to_owned(),
        line: 0,
        reason: reason.to_string(),
    }
}

impl PosePath {
    fn legs(&self) -> Result<Vec<PoseLeg>, CliError> {
        let refuse = |reason| refuse(self.name, reason);
        let pose = |row: &[f64; 6]| {
            let [x, y, z, i, j, k] = *row;
            ToolPose::new(Vector::<3>::new(x, y, z), Vector::<3>::new(i, j, k))
        };
        let leg = |pair: &[[f64; 6]]| {
            PoseLeg::between(
                &pose(&pair[0])?,
                &pose(&pair[1])?,
                PoseFeed::Speed(Feedrate::new(self.speed)?),
                Tolerance::new(self.tolerances[0])?,
                OrientationTolerance::new(self.tolerances[1])?,
            )
        };
        self.rows
            .windows(2)
            .map(|pair| leg(pair).map_err(refuse))
            .collect()
    }

    fn chain(&self) -> Result<FilterChain, CliError> {
        FilterChain::with_time_constants(&TIME_CONSTANTS)
            .map_err(|reason| refuse(self.name, reason))
    }

    /// The motion along the path.
    fn planned(&self, method: PoseMethod) -> Result<Vec<PosePiece>, CliError> {
        let machine = table(self.name)?;
        let legs = self.legs()?;
        let start = self.start(machine.as_ref(), &legs)?;
        let settings = PoseSettings::new(self.chain()?, method)
            .map_err(|reason| refuse(self.name, reason))?
            .without_axis_limits();
        let axes = machine.axes().to_vec();
        let mut planner = PosePlanner::new(machine.as_ref(), axes, start, settings)
            .map_err(|reason| refuse(self.name, reason))?;
        for leg in legs {
            planner
                .push(leg)
                .map_err(|reason| refuse(self.name, reason))?;
        }
        planner
            .finish()
            .map_err(|reason| refuse(self.name, reason))?;
        Ok(std::iter::from_fn(|| planner.pull()).collect())
    }

    /// How long the path takes, s.
    pub(super) fn time(&self, method: PoseMethod) -> Result<f64, CliError> {
        let pieces = self.planned(method)?;
        Ok(pieces.iter().map(PosePiece::duration).sum())
    }

    fn start(
        &self,
        machine: &dyn MachineKinematics,
        legs: &[PoseLeg],
    ) -> Result<AxisVector, CliError> {
        let near = AxisVector::zeros(machine.axes().len());
        let Some(toolglide_kinematics::PosePath::Tool { tip, turn }) =
            legs.first().map(|leg| &leg.path)
        else {
            return Ok(near);
        };
        let pose =
            ToolPose::new(tip[0], turn.start()).map_err(|reason| refuse(self.name, reason))?;
        machine
            .inverse(&pose, &near)
            .map_err(|reason| refuse(self.name, reason))
    }

    /// Largest acceleration of the tool tip, mm/s².
    pub(super) fn acceleration(&self, method: PoseMethod) -> Result<f64, CliError> {
        let pieces = self.planned(method)?;
        let largest = pieces.iter().filter_map(|piece| match piece {
            PosePiece::Tool(piece) => {
                let end = piece.tip.acceleration + piece.tip.jerk * piece.duration;
                Some(piece.tip.acceleration.norm().max(end.norm()))
            }
            _ => None,
        });
        Ok(largest.fold(0.0, f64::max))
    }

    /// Errors behind the drives of section 5.4: to the planned motion and to the program, of the tool tip, mm.
    pub(super) fn simulated(&self, method: PoseMethod) -> Result<PoseOutcome, CliError> {
        let refuse = |reason: String| refuse(self.name, reason);
        let machine = table(self.name)?;
        let legs = self.legs()?;
        let start = self.start(machine.as_ref(), &legs)?;
        let period =
            SamplePeriod::new(SERVO_PERIOD).map_err(|reason| refuse(reason.to_string()))?;
        let drives = machine
            .axes()
            .iter()
            .map(|axis| {
                let model = DriveModel::new(&mill_drive(axis.kind))
                    .map_err(|reason| refuse(reason.to_string()))?;
                Ok(DrivenAxis {
                    name: axis.name,
                    model,
                    coordinate: None,
                })
            })
            .collect::<Result<Vec<_>, CliError>>()?;
        let settings = SimulationSettings {
            period: SERVO_PERIOD,
            interpolation: Interpolation::Cubic,
            window: 0.002,
        };
        let mut simulator = PoseSimulator::new(machine.as_ref(), &drives, &start, settings)
            .map_err(|reason| refuse(reason.to_string()))?;
        legs.into_iter().for_each(|leg| simulator.expect(leg));
        let mut sampler = PoseSampler::new(machine.as_ref(), period, start);
        for piece in self.planned(method)? {
            let serves = piece.serves();
            sampler.feed(piece);
            while let Some(tick) = sampler.next_tick() {
                let tick = tick.map_err(|reason| refuse(reason.to_string()))?;
                let point = PoseSetPoint {
                    axes: tick.axes,
                    pose: tick.pose,
                    serves,
                };
                simulator
                    .observe(&point, &mut |_| {})
                    .map_err(|reason| refuse(reason.to_string()))?;
            }
        }
        simulator
            .finish(sampler.end_time(), &mut |_| {})
            .map_err(|reason| refuse(reason.to_string()))
    }

    /// How long two moves are under way at the same time, s.
    pub(super) fn overlap(&self, method: PoseMethod) -> Result<f64, CliError> {
        let pieces = self.planned(method)?;
        let both = |piece: &&PosePiece| piece.serves().first < piece.serves().last;
        Ok(pieces.iter().filter(both).map(PosePiece::duration).sum())
    }
}

/// A tilting rotary table whose axes meet in the origin and have no ends.
fn table(name: &str) -> Result<Box<dyn MachineKinematics>, CliError> {
    let model = find("table-ac")?;
    let mut config = (model.preset)();
    for axis in &mut config.axis {
        axis.travel = None;
    }
    for distance in config.geometry.values_mut() {
        *distance = 0.0;
    }
    (model.build)(&config).map_err(|reason| refuse(name, reason))
}

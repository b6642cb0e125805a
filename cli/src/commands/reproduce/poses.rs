//! Plans tables 5.1 and 5.2: tool poses without a machine, as the dissertation does.
//!
//! Neither tolerances of table 5.1 nor feedrate and tolerances of table 5.2 are printed: those of 5.1
//! follow from the blend times, those of 5.2 are the best match of what is said about it. Not here:
//! machines with limits.

use crate::error::CliError;
use toolglide_fir::FilterChain;
use toolglide_fiveaxis::{PoseMethod, PosePlanner, PoseSettings};
use toolglide_kinematics::{
    AxisVector, Feedrate, MachineKinematics, OrientationTolerance, PoseFeed, PoseLeg, PosePiece,
    Tolerance, ToolPose, Vector,
};
use toolglide_machines::find;

/// Time constants of chapter 5, s.
const TIME_CONSTANTS: [f64; 2] = [0.1, 0.06];

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

/// Two moves; the tolerances follow from the printed blend times of tip and orientation.
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

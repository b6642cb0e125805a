//! Words of axes, inverse time, and input that must be refused.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{judge, plan, settings, table_ac};
use toolglide_fir::FilterChain;
use toolglide_fiveaxis::{FiveAxisError, PoseMethod, PoseSettings, Resolver};
use toolglide_kinematics::{
    AxisVector, Feedrate, OrientationTolerance, PoseEnd, PoseFeed, PoseLeg, PoseMove, PosePath,
    Tolerance, ToolPose, ToolpathError, Vector,
};

fn words(linear: [f64; 3], rotary: [f64; 3], tip: bool, feed: PoseFeed) -> PoseMove {
    let end = PoseEnd::Axes {
        linear: Vector::<3>::from(linear),
        rotary: rotary.map(f64::to_radians),
        tip,
        great_circle: false,
    };
    PoseMove::new(end, feed, Tolerance::new(0.05).unwrap()).unwrap()
}

fn orientation_tolerance() -> OrientationTolerance {
    OrientationTolerance::new(0.002).unwrap()
}

#[test]
fn a_rapid_in_tip_mode_goes_to_the_turns_that_it_says_and_a_cut_takes_its_time() {
    let (machine, axes) = table_ac();
    let start = AxisVector::zeros(5);
    let mut resolver = Resolver::new(machine.as_ref(), start, orientation_tolerance()).unwrap();
    let moves = [
        words(
            [10.0, 5.0, 20.0],
            [-60.0, 0.0, -399.0],
            true,
            PoseFeed::Rapid,
        ),
        words(
            [12.0, 5.0, 19.0],
            [-58.0, 0.0, -397.0],
            true,
            PoseFeed::Duration(0.4),
        ),
        words(
            [13.0, 6.0, 18.0],
            [-57.0, 0.0, -392.0],
            true,
            PoseFeed::Duration(0.3),
        ),
    ];
    let legs: Vec<PoseLeg> = moves
        .iter()
        .map(|next| resolver.leg(next).unwrap())
        .collect();
    assert!(matches!(legs[0].path, PosePath::Axes { .. }), "straight");
    assert!(matches!(legs[1].path, PosePath::Rotary { .. }), "rotary");
    let settings = settings([0.05, 0.025], PoseMethod::DwellControlled);
    let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
    let report = judge(machine.as_ref(), &axes, &legs, &planned);
    assert!(report.passes(), "{:#?}", report.examples);
    let (low, high) = (report.axes[4].lowest, report.axes[4].highest);
    assert!((low + 399.0_f64.to_radians()).abs() < 1e-9, "{low}");
    assert!(high.abs() < 1e-9, "{high}");
}

#[test]
fn an_axis_that_the_machine_lacks_is_named() {
    let (machine, _) = table_ac();
    let start = AxisVector::zeros(5);
    let mut resolver = Resolver::new(machine.as_ref(), start, orientation_tolerance()).unwrap();
    let refused = resolver
        .leg(&words([0.0; 3], [0.0, 30.0, 0.0], true, PoseFeed::Rapid))
        .unwrap_err();
    assert_eq!(
        refused.to_string(),
        "move 0: axis B is programmed, but the machine has XYZAC"
    );
}

#[test]
fn opposite_neighbours_and_other_chains_are_refused() {
    let up = ToolPose::upright(Vector::zeros()).unwrap();
    let down = ToolPose::new(Vector::zeros(), -Vector::<3>::z()).unwrap();
    let feed = PoseFeed::Speed(Feedrate::new(10.0).unwrap());
    let tolerance = Tolerance::new(0.01).unwrap();
    let refused = PoseLeg::between(&up, &down, feed, tolerance, orientation_tolerance());
    assert!(
        matches!(refused, Err(ToolpathError::Opposite { .. })),
        "{refused:?}"
    );
    let bent = ToolPose::new(Vector::zeros(), Vector::<3>::new(0.0, 0.0, 1.01));
    assert!(
        matches!(bent, Err(ToolpathError::NotUnit { .. })),
        "{bent:?}"
    );
    let chain = FilterChain::with_time_constants(&[0.1]).unwrap();
    assert_eq!(
        PoseSettings::new(chain, PoseMethod::PointToPoint),
        Err(FiveAxisError::FilterCount { given: 1 })
    );
}

//! The machine is found by its name and planned on, inside both tolerances and all of its limits.

use nutating_table as _; // without this line the machine is not linked, and not there
use toolglide_fir::FilterChain;
use toolglide_fiveaxis::{PoseMethod, PosePlanner, PoseSettings};
use toolglide_kinematics::{
    AxisVector, Feedrate, OrientationTolerance, PoseFeed, PoseLeg, Tolerance, ToolPose, Vector,
};
use toolglide_verify::PoseJudge;

#[test]
fn a_rim_is_planned_on_the_machine_by_name() {
    let model = toolglide_machines::find("nutating-table").unwrap();
    let machine = (model.build)(&(model.preset)()).unwrap();
    let rim: Vec<ToolPose> = (0..=12)
        .map(|step| {
            let (sin, cos) = f64::from(30 * step).to_radians().sin_cos();
            let orientation = Vector::<3>::new(0.35 * cos, 0.35 * sin, 1.0).normalize();
            ToolPose::new(Vector::<3>::new(30.0 * cos, 30.0 * sin, 20.0), orientation).unwrap()
        })
        .collect();
    let feed = PoseFeed::Speed(Feedrate::new(50.0).unwrap());
    let tolerance = Tolerance::new(0.02).unwrap();
    let lean = OrientationTolerance::new(0.002).unwrap();
    let chain = FilterChain::with_time_constants(&[0.08, 0.04]).unwrap();
    let settings = PoseSettings::new(chain, PoseMethod::DwellControlled).unwrap();
    let axes = machine.axes().to_vec();
    let start = machine.inverse(&rim[0], &AxisVector::zeros(5)).unwrap();
    let mut planner = PosePlanner::new(machine.as_ref(), axes.clone(), start, settings).unwrap();
    let mut judge = PoseJudge::new(machine.as_ref(), axes, &start);
    for ends in rim.windows(2) {
        let leg = PoseLeg::between(&ends[0], &ends[1], feed, tolerance, lean).unwrap();
        judge.expect(&leg);
        planner.push(leg).unwrap();
    }
    planner.finish().unwrap();
    while let Some(piece) = planner.pull() {
        judge.observe(&piece);
    }
    let report = judge.finish();
    assert!(report.passes(), "{:#?}", report.examples);
    assert!(report.cycle_time < 8.0, "{} s", report.cycle_time);
}

//! Whole programs through windows, judged, with a general conic solver in the place of the own one.

#![allow(
    clippy::unwrap_used,
    clippy::cast_precision_loss,
    reason = "a failed unwrap is a failed test; counts are small"
)]

mod clarabel;

use clarabel::Conic;
use toolglide_kinematics::{
    Feedrate, Limits, Plan, Tolerance, Toolpath, Trajectory, Vector, verify,
};
use toolglide_optimal::{Settings, plan_with};

fn judged<const N: usize>(points: &[Vector<N>], tolerance: f64, limits: Limits<N>) -> Plan<N> {
    let path = Toolpath::from_points(
        points,
        Feedrate::new(100.0).unwrap(),
        Tolerance::new(tolerance).unwrap(),
    )
    .unwrap();
    let plan = plan_with(Conic::default(), &path, &Settings::new(limits)).unwrap();
    let report = verify(&plan, &path, &limits);
    assert!(report.passes(), "{:#?}", report.examples);
    plan
}

#[test]
fn a_corner_takes_the_time_of_the_optimum() {
    let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
    let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
    for (tolerance, optimum) in [(0.01, 0.28712), (0.1, 0.27146)] {
        let began = std::time::Instant::now();
        let duration = judged(&points, tolerance, limits).duration();
        eprintln!("{tolerance}: {duration} {:?}", began.elapsed());
        assert!(duration < optimum * 1.003, "{tolerance}: {duration}");
    }
}

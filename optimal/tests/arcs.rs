//! Arcs that the feedrate allows are followed on their radius.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{Arc, Feedrate, Limits, Move, Tolerance, Toolpath, Vector};
use toolglide_optimal::{Settings, plan};
use toolglide_verify::verify;

/// A line to a circle about zero, the circle, and a line away.
fn circle(radius: f64, feedrate: f64, tolerance: f64) -> Toolpath<2> {
    let (feedrate, tolerance) = (
        Feedrate::new(feedrate).unwrap(),
        Tolerance::new(tolerance).unwrap(),
    );
    let at = Vector::<2>::new(radius, 0.0);
    let arc = Arc::about(at, at, Vector::<2>::zeros(), [0, 1], true, 0).unwrap();
    let mut path = Toolpath::starting_at(Vector::<2>::new(radius + 5.0, 0.0)).unwrap();
    path.push(Move::line_to(at, feedrate, tolerance).unwrap())
        .unwrap();
    path.push(Move::arc(arc, feedrate, tolerance)).unwrap();
    path.push(Move::line_to(path.start(), feedrate, tolerance).unwrap())
        .unwrap();
    path
}

#[test]
fn the_radius_is_kept_within_a_micrometre_or_a_fiftieth_of_the_tolerance_beyond_thirty_degrees() {
    let limits = Limits::<2>::uniform(500.0, 2500.0, 2e5).unwrap();
    for (radius, feedrate, tolerance) in [(10.0, 10.0, 0.05), (3.0, 40.0, 0.1), (40.0, 100.0, 0.02)]
    {
        let path = circle(radius, feedrate, tolerance);
        let motion = plan(&path, &Settings::new(limits)).unwrap();
        let report = verify(&motion, &path, &limits);
        assert!(report.passes(), "{:#?}", report.examples);
        let mut most = 0.0_f64;
        for piece in motion.pieces() {
            for share in [0.0, 0.5] {
                let point = piece.position_at(share * piece.duration());
                let angle = point[1].atan2(point[0]).to_degrees().rem_euclid(360.0);
                if (30.0..330.0).contains(&angle) {
                    most = most.max((point.norm() - radius).abs());
                }
            }
        }
        let allowed = (0.02 * tolerance).max(0.001);
        assert!(most <= allowed, "radius {radius}: {} µm", 1e3 * most);
    }
}

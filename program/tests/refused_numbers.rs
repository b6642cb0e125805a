//! Refusals of numbers: feedrates, bounds, and arcs that cannot be.

#[macro_use]
mod common;

use common::refusal;
use toolglide_kinematics::ToolpathError;
use toolglide_program::{FARTHEST, Reason};

#[test]
fn feed_moves_need_a_feedrate() {
    refuses!("G1 X1", 1, 1, "G1", Reason::NoFeedrate);
    refuses!("G1\nX1", 2, 1, "X1", Reason::NoFeedrate);
    refuses!("G2 I1", 1, 1, "G2", Reason::NoFeedrate);
    refuses!(
        "G1 F0 X1",
        1,
        4,
        "F0",
        Reason::NotPositive {
            quantity: "feedrate",
            ..
        }
    );
    refuses!("F0\nG1 X1", 2, 1, "G1", Reason::NotPositive { .. });
    refuses!(
        "G1 X1 F-5",
        1,
        7,
        "F-5",
        Reason::Negative {
            quantity: "feedrate",
            ..
        }
    );
    refuses!("G93 G1 X1 F60\nX2", 2, 1, "X2", Reason::NoInverseTime);
    refuses!("F60 G93 G1 X1\nG94 X2", 2, 5, "X2", Reason::NoFeedrate);
    refuses!("F60\nG93\nG1 X2", 3, 1, "G1", Reason::NoInverseTime);
    refuses!("G93 G1 X1 F0", 1, 11, "F0", Reason::NotPositive { .. });
    let tiny = format!("G1 X1 F.{}1", "0".repeat(322));
    let (_, column, _, reason) = refusal(&tiny);
    assert_eq!(column, 7, "tiny");
    assert!(matches!(reason, Reason::NotPositive { .. }), "{reason:?}");
    let vast = format!("G20\nG1 X1 F1{}", "0".repeat(308));
    let (_, column, _, reason) = refusal(&vast);
    assert_eq!(column, 7, "vast");
    assert!(matches!(reason, Reason::Feedrate { .. }), "{reason:?}");
    let none = format!("G1 X1 F0.{}1", "0".repeat(299));
    let (_, column, _, reason) = refusal(&none);
    assert_eq!(column, 7, "next to nothing");
    assert!(matches!(reason, Reason::Feedrate { .. }), "{reason:?}");
}

#[test]
fn numbers_out_of_their_bounds_are_refused() {
    refuses!(
        "G4 P-1",
        1,
        4,
        "P-1",
        Reason::Negative {
            quantity: "dwell",
            ..
        }
    );
    refuses!("G4 P1000001", 1, 4, "P1000001", Reason::DwellTooLong { .. });
    refuses!(
        "S-5",
        1,
        1,
        "S-5",
        Reason::Negative {
            quantity: "spindle speed",
            ..
        }
    );
    refuses!(
        "T1.5",
        1,
        1,
        "T1.5",
        Reason::NotWhole {
            quantity: "tool number",
            ..
        }
    );
    refuses!("T-1", 1, 1, "T-1", Reason::NotWhole { .. });
    refuses!("N-1", 1, 1, "N-1", Reason::Negative { .. });
    refuses!("G64 P-1", 1, 5, "P-1", Reason::Negative { .. });
    refuses!("G64 Q-1", 1, 5, "Q-1", Reason::Negative { .. });
    refuses!(
        "G0 X1000000000.5",
        1,
        4,
        "X1000000000.5",
        Reason::TooFar {
            bound: FARTHEST,
            ..
        }
    );
    refuses!(
        "G20 G0 X-40000000",
        1,
        8,
        "X-40000000",
        Reason::TooFar { letter: 'X', .. }
    );
    refuses!("G91 G0 X6h8", 1, 10, "h8", Reason::NotSupported { .. });
    refuses!(
        "G91 G0 X6000000\nX6000000",
        2,
        1,
        "X6000000",
        Reason::TooFar { .. }
    );
    refuses!(
        "F9 G2 X1 R2000000000",
        1,
        10,
        "R2000000000",
        Reason::TooFar { letter: 'R', .. }
    );
    refuses!(
        "F9 G2 X1 J2000000000",
        1,
        10,
        "J2000000000",
        Reason::TooFar { letter: 'J', .. }
    );
}

#[test]
fn impossible_arcs_are_refused() {
    refuses!(
        "F9\nG2 X1",
        2,
        1,
        "G2",
        Reason::ArcCenterMissing { offsets: "I or J" }
    );
    refuses!(
        "F9 G18\nG3 X1 Z1",
        2,
        1,
        "G3",
        Reason::ArcCenterMissing { offsets: "I or K" }
    );
    refuses!("F9 G2 I1\nY5", 2, 1, "Y5", Reason::ArcCenterMissing { .. });
    refuses!("F9 G2", 1, 4, "G2", Reason::ArcCenterMissing { .. });
    refuses!(
        "F9 G2 X1 I1 R1",
        1,
        10,
        "I1",
        Reason::ArcCenterAndRadius { letter: 'I' }
    );
    refuses!(
        "F9 G2 X1 I1 K1",
        1,
        13,
        "K1",
        Reason::OffsetOutsidePlane { letter: 'K', .. }
    );
    refuses!(
        "F9 G18 G2 X1 J1",
        1,
        14,
        "J1",
        Reason::OffsetOutsidePlane { letter: 'J', .. }
    );
    refuses!(
        "F9 G19 G2 Y1 I1",
        1,
        14,
        "I1",
        Reason::OffsetOutsidePlane { letter: 'I', .. }
    );
    refuses!(
        "F9 G90.1 G2 X1 I1",
        1,
        16,
        "I1",
        Reason::ArcCenterIncomplete { .. }
    );
    refuses!(
        "F9 G2 X10 R4.99",
        1,
        11,
        "R4.99",
        Reason::ArcRadiusTooShort { .. }
    );
    refuses!(
        "F9 G2 X.001 R0",
        1,
        13,
        "R0",
        Reason::ArcRadiusTooShort { .. }
    );
    refuses!("F9 G2 X0 R5", 1, 10, "R5", Reason::ArcRadiusClosed { .. });
    refuses!("F9 G2 R5", 1, 7, "R5", Reason::ArcRadiusClosed { .. });
    refuses!(
        "F9 G2 I1 P0",
        1,
        10,
        "P0",
        Reason::NotWhole {
            quantity: "number of turns",
            ..
        }
    );
    refuses!("F9 G2 I1 P1.5", 1, 10, "P1.5", Reason::NotWhole { .. });
    refuses!(
        "F9 G2 I1 P1000001",
        1,
        10,
        "P1000001",
        Reason::NotWhole {
            most: 1_000_000,
            ..
        }
    );
    let mismatch = "F9 G2 X10 Y0 I4 J0";
    refuses!(
        mismatch,
        1,
        14,
        "I4",
        Reason::Path(ToolpathError::ArcMismatch { .. })
    );
    refuses!(
        "F9 G2 X1 J0",
        1,
        10,
        "J0",
        Reason::Path(ToolpathError::ArcRadius { .. })
    );
}

//! Random chains of poses with short moves: both tolerances, every limit, unit length.

mod common;

use common::{judge, legs, plan, settings, start_of, table_ac};
use proptest::prelude::*;
use toolglide_fiveaxis::PoseMethod;

/// What rounding adds to a share of a tolerance.
const ROUNDING: f64 = 1e-9;

/// A chain of poses whose steps are from a hundredth to some tens of millimetres, and whose tool turns
/// by up to some tenths of a radian at a step; some steps move the tip alone or the tool alone.
fn chain() -> impl Strategy<Value = Vec<[f64; 6]>> {
    let step = (
        prop_oneof![Just(0.0), 0.01..0.5_f64, 0.5..30.0_f64],
        0.0..std::f64::consts::TAU,
        -1.0..1.0_f64,
        prop_oneof![Just(0.0), 0.0005..0.02_f64, 0.02..0.4_f64],
        0.0..std::f64::consts::TAU,
    );
    (
        0.2..1.0_f64,
        0.0..std::f64::consts::TAU,
        prop::collection::vec(step, 3..24),
    )
        .prop_map(|(tilt, spin, steps)| {
            let (mut tip, mut tilt, mut spin) = ([0.0; 3], tilt, spin);
            let row = |tip: [f64; 3], tilt: f64, spin: f64| {
                [
                    tip[0],
                    tip[1],
                    tip[2],
                    tilt.sin() * spin.cos(),
                    tilt.sin() * spin.sin(),
                    tilt.cos(),
                ]
            };
            let mut rows = vec![row(tip, tilt, spin)];
            for (length, heading, rise, turn, towards) in steps {
                tip[0] += length * heading.cos();
                tip[1] += length * heading.sin();
                tip[2] += 0.3 * length * rise;
                // Away from the pole, where the machine has no speed.
                tilt = (tilt + turn * towards.cos()).clamp(0.15, 1.3);
                spin += turn * towards.sin();
                rows.push(row(tip, tilt, spin));
            }
            rows
        })
}

/// Whether two rows are one pose.
fn differs(pair: &[[f64; 6]]) -> bool {
    pair[0]
        .iter()
        .zip(&pair[1])
        .any(|(one, two)| (one - two).abs() > 1e-6)
}

fn keeps_everything(
    rows: &[[f64; 6]],
    speed: f64,
    tolerances: [f64; 2],
    method: PoseMethod,
) -> Result<(), TestCaseError> {
    let mut kept = vec![rows[0]];
    for pair in rows.windows(2) {
        if differs(pair) {
            kept.push(pair[1]);
        }
    }
    if kept.len() < 2 {
        return Ok(());
    }
    let (machine, axes) = table_ac();
    let start = start_of(machine.as_ref(), &kept[0]);
    let legs = legs(&kept, speed, tolerances[0], tolerances[1]);
    let settings = settings([0.05, 0.025], method);
    let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
    let report = judge(machine.as_ref(), &axes, &legs, &planned);
    prop_assert!(report.passes(), "{method:?}: {:#?}", report.examples);
    prop_assert!(report.unit_error <= 1e-14, "{}", report.unit_error);
    for ratio in [
        report.tip_ratio,
        report.tip_corner_ratio,
        report.orientation_ratio,
        report.orientation_corner_ratio,
    ] {
        prop_assert!(ratio.value < 1.0 + ROUNDING, "{method:?}: {ratio:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn no_chain_of_poses_breaks_anything(
        rows in chain(),
        speed in 5.0..200.0_f64,
        tip in 0.005..0.2_f64,
        orientation in 0.0005..0.02_f64,
    ) {
        for method in [
            PoseMethod::DwellControlled,
            PoseMethod::VelocityControlled,
            PoseMethod::PointToPoint,
        ] {
            keeps_everything(&rows, speed, [tip, orientation], method)?;
        }
    }
}

//! No method is slower than a rest at every pose, or breaks a limit, however nasty the poses are beside the pole of the
//! machine.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{judge, plan, pose};
use proptest::prelude::*;
use toolglide_fir::FilterChain;
use toolglide_fiveaxis::{PoseMethod, PoseSettings, Resolver, start_of};
use toolglide_kinematics::{
    AxisVector, Feedrate, OrientationTolerance, PoseEnd, PoseFeed, PoseLeg, PoseMove, SamplePeriod,
    Tolerance,
};
use toolglide_machines::find;

const MACHINES: [&str; 4] = ["table-ac", "table-bc", "head-bc", "head-table-bc"];

const METHODS: [PoseMethod; 3] = [
    PoseMethod::PointToPoint,
    PoseMethod::DwellControlled,
    PoseMethod::VelocityControlled,
];

/// Poses: tip, and the angle by which the tool leans, and where to.
#[derive(Clone, Debug)]
struct Nasty {
    rows: Vec<[f64; 5]>,
    feeds: Vec<f64>,
    tolerances: [f64; 2],
    chosen: bool,
}

/// A number between two, as often in each power of ten.
fn spread(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

fn nasty() -> impl Strategy<Value = Nasty> {
    let lean = prop_oneof![
        1 => Just(0.0),
        3 => spread(1e-9, 1e-3),
        3 => spread(1e-3, 0.4),
    ];
    let step = (
        prop_oneof![1 => Just(0.0), 2 => spread(1e-3, 1.0), 3 => spread(1.0, 40.0)],
        0.0..std::f64::consts::TAU,
        lean,
        0.0..std::f64::consts::TAU,
        spread(1.0, 200.0),
    );
    (
        prop::collection::vec(step, 3..7),
        spread(0.001, 0.1),
        spread(5e-5, 0.01),
        any::<bool>(),
    )
        .prop_map(|(steps, tip, orientation, chosen)| {
            let mut at = [0.0; 3];
            let mut rows = Vec::new();
            let mut feeds = Vec::new();
            for (length, heading, lean, towards, feed) in steps {
                at[0] += length * heading.cos();
                at[1] += length * heading.sin();
                at[2] += 0.2 * length * (3.0 * heading).sin();
                rows.push([at[0], at[1], at[2], lean, towards]);
                feeds.push(feed);
            }
            let tolerances = [tip, orientation];
            Nasty {
                rows,
                feeds,
                tolerances,
                chosen,
            }
        })
}

/// How long a method takes, and what the judge finds; `None` where the machine cannot follow the poses.
fn planned(name: &str, nasty: &Nasty, method: PoseMethod) -> Option<(f64, Vec<String>)> {
    let model = find(name).unwrap();
    let machine = (model.build)(&(model.preset)()).unwrap();
    let [tip, orientation] = nasty.tolerances;
    let within = OrientationTolerance::new(orientation).unwrap();
    let moves: Vec<_> = nasty
        .rows
        .iter()
        .zip(&nasty.feeds)
        .map(|(&[x, y, z, lean, towards], &feed)| {
            let (i, j) = (lean.sin() * towards.cos(), lean.sin() * towards.sin());
            let end = PoseEnd::Pose(pose(&[x, y, z, i, j, lean.cos()]));
            let feed = PoseFeed::Speed(Feedrate::new(feed).unwrap());
            PoseMove::new(end, feed, Tolerance::new(tip).unwrap()).unwrap()
        })
        .collect();
    let axes = machine.axes().to_vec();
    let start = start_of(machine.as_ref(), &moves, &AxisVector::zeros(5), within).ok()?;
    let mut resolver = Resolver::new(machine.as_ref(), start, within).unwrap();
    let legs: Option<Vec<PoseLeg>> = moves.iter().map(|next| resolver.leg(next).ok()).collect();
    let legs = legs?;
    let chain = FilterChain::with_time_constants(&[0.05, 0.025]).unwrap();
    let mut settings = PoseSettings::new(chain, method)
        .unwrap()
        .with_turn_rate(2.0);
    if nasty.chosen {
        settings = settings.choosing_filters(SamplePeriod::new(0.001).unwrap());
    }
    let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
    let report = judge(machine.as_ref(), &axes, &legs, &planned);
    let found = report.examples.iter().map(ToString::to_string).collect();
    Some((report.cycle_time, found))
}

fn is_legal_and_no_slower(nasty: &Nasty, machine: &str) -> Result<(), TestCaseError> {
    let mut resting = f64::INFINITY;
    for method in METHODS {
        let Some((time, found)) = planned(machine, nasty, method) else {
            return Ok(());
        };
        prop_assert!(found.is_empty(), "{machine} {method:?}: {found:#?}");
        if method == PoseMethod::PointToPoint {
            resting = time;
        }
        prop_assert!(
            time <= resting * (1.0 + 1e-9),
            "{machine} {method:?}: {time} s, but {resting} s from rest to rest"
        );
    }
    Ok(())
}

#[test]
fn three_poses_beside_the_pole_take_no_longer_than_from_rest_to_rest() {
    let leaning =
        |tip: [f64; 3], i: f64, j: f64| [tip[0], tip[1], tip[2], i.hypot(j).asin(), j.atan2(i)];
    let nasty = |chosen| Nasty {
        rows: vec![
            leaning(
                [18.148949, -20.058409, 27.187179],
                0.001613659,
                -0.005979203,
            ),
            leaning([18.151371, -20.059041, 27.189232], 0.000005306, 0.000026073),
            leaning(
                [18.761237, -21.293907, 25.131575],
                -0.00000001,
                -0.000000011,
            ),
        ],
        feeds: vec![127.888865; 3],
        tolerances: [0.00298, 0.00102],
        chosen,
    };
    for (chosen, most) in [(false, 1.7), (true, 1.2)] {
        for method in METHODS {
            let (time, found) = planned("table-bc", &nasty(chosen), method).unwrap();
            assert!(found.is_empty(), "{method:?}: {found:#?}");
            assert!(time < most, "{method:?}: {time} s");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn nasty_poses_beside_the_pole_are_legal_and_never_slower_than_from_rest_to_rest(
        nasty in nasty(),
        machine in prop::sample::select(&MACHINES[..]),
    ) {
        is_legal_and_no_slower(&nasty, machine)?;
    }
}

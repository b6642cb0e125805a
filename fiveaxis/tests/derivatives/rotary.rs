//! The same for moves whose words say how far the rotary axes turn: tip and rotary axes are polynomials, and the linear
//! axes follow from them by series.

use crate::common::{judge, plan, settings};
use crate::follower::Peaks;
use crate::jet::{Jet, JetVector};
use crate::machines::{Case, cases, limits};
use crate::{Found, METHODS, Numbers, motions};
use toolglide_fiveaxis::{PoseMethod, Resolver};
use toolglide_kinematics::{
    Axis, AxisLimits, AxisVector, Feedrate, OrientationTolerance, PoseEnd, PoseFeed, PoseMove,
    PosePiece, RotaryPiece, Tolerance, Vector,
};

/// Instants of a piece that are looked at.
const INSTANTS: u32 = 400;

/// Words X Y Z, of the tilting axis, and of C, rad.
type Words = [f64; 5];

/// A program of words, and how it is moved along.
#[derive(Debug)]
struct Program {
    words: Vec<Words>,
    speed: f64,
    tolerances: [f64; 2],
    method: PoseMethod,
    haste: f64,
}

fn peaks(case: &Case, piece: &RotaryPiece, peaks: &mut Peaks) {
    let rotary = |axis: usize| piece.rotary[axis].unwrap();
    for instant in 0..=INSTANTS {
        let time = piece.duration * f64::from(instant) / f64::from(INSTANTS);
        let start = &piece.tip;
        let tip = std::array::from_fn(|k| {
            let cubic = [
                start.position[k],
                start.velocity[k],
                0.5 * start.acceleration[k],
                start.jerk[k] / 6.0,
            ];
            Jet::cubic(cubic, time)
        });
        let [tilt, spin] = [3, 4].map(|axis| Jet::cubic(rotary(axis), time));
        let found = case.axes_of_rotary(JetVector(tip), tilt, spin);
        for (axis, found) in found.into_iter().map(Jet::derivatives).enumerate() {
            let limits = limits(&case.axes[axis]);
            for order in 0..3 {
                let share = found[order + 1].abs() / limits[order];
                peaks[axis][order] = peaks[axis][order].max(share);
            }
        }
    }
}

fn both(case: &Case, program: &Program) -> (Peaks, Peaks, bool) {
    let machine = case.machine.as_ref();
    let [tip, orientation] = program.tolerances;
    let within = OrientationTolerance::new(orientation).unwrap();
    let tilting = if case.axes[3].name == 'A' { 0 } else { 1 };
    let start = AxisVector::zeros(5);
    let mut resolver = Resolver::new(machine, start, within).unwrap();
    let legs: Vec<_> = program
        .words
        .iter()
        .map(|&[x, y, z, tilt, spin]| {
            let mut rotary = [0.0, 0.0, spin];
            rotary[tilting] = tilt;
            let end = PoseEnd::Axes {
                linear: Vector::<3>::new(x, y, z),
                rotary,
                tip: true,
                great_circle: false,
            };
            let feed = PoseFeed::Speed(Feedrate::new(program.speed).unwrap());
            let next = PoseMove::new(end, feed, Tolerance::new(tip).unwrap()).unwrap();
            resolver.leg(&next).unwrap()
        })
        .collect();
    let hasty: Vec<Axis> = case
        .axes
        .iter()
        .map(|axis| {
            let [velocity, acceleration, jerk] = limits(axis).map(|limit| limit * program.haste);
            Axis {
                limits: AxisLimits::new(velocity, acceleration, jerk).unwrap(),
                ..axis.clone()
            }
        })
        .collect();
    let settings = settings([0.1, 0.05], program.method);
    let planned = plan(machine, &hasty, start, &legs, &settings);
    let report = judge(machine, &case.axes, &legs, &planned);
    let mut found: Peaks = [[0.0; 3]; 5];
    for piece in &planned.pieces {
        let PosePiece::Rotary(piece) = piece else {
            panic!("motion of the tip with the rotary axes");
        };
        peaks(case, piece, &mut found);
    }
    let judged = std::array::from_fn(|axis| {
        let (found, limits) = (&report.axes[axis], limits(&case.axes[axis]));
        [
            found.velocity.value / limits[0],
            found.acceleration.value / limits[1],
            found.jerk.value / limits[2],
        ]
    });
    (found, judged, report.passes())
}

fn looked_at(seed: u64, most_haste: f64) -> Found {
    let mut numbers = Numbers(seed);
    let mut found = Found::default();
    let cases = cases();
    for number in 0..motions(8) {
        for case in &cases {
            let mut words = Vec::new();
            let mut at = [0.0, 0.0, 60.0, 0.0, 0.0];
            for _ in 0..number % 5 + 2 {
                let far = numbers.of(20.0, 1.0, 0.5);
                let turn = numbers.of(0.5, 0.02, 0.6);
                for (index, at) in at.iter_mut().enumerate() {
                    let most = if index < 3 { far } else { turn };
                    *at += numbers.within(-most, most);
                }
                words.push(at);
            }
            let program = Program {
                words,
                speed: numbers.within(10.0, 200.0),
                tolerances: [numbers.within(0.005, 0.1), numbers.within(0.0005, 0.01)],
                method: METHODS[number % METHODS.len()],
                haste: most_haste.powf(numbers.next()),
            };
            found.take(case, &program, program.haste, both(case, &program));
        }
    }
    found
}

#[test]
fn rotary_words_keep_every_limit_by_both_derivations() {
    let found = looked_at(11, 1.0);
    assert!(found.most > 0.99, "nothing comes near a limit: {found:?}");
    assert!(
        found.above < crate::AGREES,
        "the judge sees noise: {found:?}"
    );
}

#[test]
fn rotary_words_too_fast_for_a_limit_do_not_pass_by_either_derivation() {
    let found = looked_at(12, 4.0);
    assert!(found.most > 2.0, "nothing exceeds a limit: {found:?}");
    assert!(
        found.above < crate::AGREES,
        "the judge sees noise: {found:?}"
    );
}

//! Measures how long a block takes to plan, and a tick to filter and follow.

#![allow(missing_docs, reason = "criterion makes an undocumented function")]
#![allow(
    clippy::unwrap_used,
    reason = "a bench that cannot build its case has failed"
)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use toolglide_fir::FilterChain;
use toolglide_fiveaxis::{PoseMethod, PosePlanner, PoseSampler, PoseSettings};
use toolglide_kinematics::{
    AxisVector, Feedrate, MachineKinematics, OrientationTolerance, PoseFeed, PoseLeg, PosePiece,
    SamplePeriod, Tolerance, ToolPose, Vector,
};
use toolglide_machines::find;

/// Moves of the path.
const MOVES: u32 = 1000;

/// A point of a wavy path whose tool nods and turns.
fn pose(index: u32) -> ToolPose {
    let t = f64::from(index);
    let (tilt, spin) = (0.5 + 0.2 * (0.7 * t).sin(), 0.05 * t);
    ToolPose::new(
        Vector::<3>::new(
            10.0 * (0.9 * t).sin(),
            10.0 * (0.05 * t).cos(),
            2.0 * t.cos(),
        ),
        Vector::<3>::new(tilt.sin() * spin.cos(), tilt.sin() * spin.sin(), tilt.cos()),
    )
    .unwrap()
}

fn legs() -> Vec<PoseLeg> {
    (0..MOVES)
        .map(|index| {
            PoseLeg::between(
                &pose(index),
                &pose(index + 1),
                PoseFeed::Speed(Feedrate::new(30.0).unwrap()),
                Tolerance::new(0.05).unwrap(),
                OrientationTolerance::new(0.002).unwrap(),
            )
            .unwrap()
        })
        .collect()
}

fn machine() -> Box<dyn MachineKinematics> {
    let model = find("table-ac").unwrap();
    (model.build)(&(model.preset)()).unwrap()
}

fn settings() -> PoseSettings {
    let chain = FilterChain::with_time_constants(&[0.05, 0.025]).unwrap();
    PoseSettings::new(chain, PoseMethod::DwellControlled).unwrap()
}

fn pieces(
    machine: &dyn MachineKinematics,
    legs: &[PoseLeg],
    settings: &PoseSettings,
) -> (AxisVector, Vec<PosePiece>) {
    let start = machine.inverse(&pose(0), &AxisVector::zeros(5)).unwrap();
    let axes = machine.axes().to_vec();
    let mut planner = PosePlanner::new(machine, axes, start, settings.clone()).unwrap();
    for leg in legs {
        planner.push(leg.clone()).unwrap();
    }
    planner.finish().unwrap();
    (start, std::iter::from_fn(|| planner.pull()).collect())
}

fn planning(criterion: &mut Criterion) {
    let (legs, machine) = (legs(), machine());
    let mut group = criterion.benchmark_group("planning");
    group.sample_size(10);
    group.throughput(Throughput::Elements(u64::from(MOVES)));
    for (name, settings) in [
        ("blocks by feedrate", settings().without_axis_limits()),
        ("blocks within axis limits", settings()),
    ] {
        group.bench_function(name, |bench| {
            bench.iter(|| black_box(pieces(machine.as_ref(), &legs, &settings)));
        });
    }
    group.finish();
}

fn ticks(criterion: &mut Criterion) {
    let (legs, machine) = (legs(), machine());
    let (start, pieces) = pieces(machine.as_ref(), &legs, &settings());
    let period = SamplePeriod::new(1e-3).unwrap();
    let run = || {
        let mut sampler = PoseSampler::new(machine.as_ref(), period, start);
        let mut count = 0_u64;
        for piece in &pieces {
            sampler.feed(piece.clone());
            while let Some(tick) = sampler.next_tick() {
                black_box(tick.unwrap());
                count += 1;
            }
        }
        count
    };
    let mut group = criterion.benchmark_group("ticks");
    group.sample_size(10);
    group.throughput(Throughput::Elements(run()));
    group.bench_function("filtering and inverse kinematics", |bench| {
        bench.iter(|| black_box(run()));
    });
    group.finish();
}

criterion_group!(benches, planning, ticks);
criterion_main!(benches);

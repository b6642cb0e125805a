//! Inverse and forward kinematics, one pose at a time as a controller asks for them.

#![allow(clippy::expect_used, reason = "a failed measurement is a failed bench")]

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use toolglide_kinematics::{AxisKind, AxisVector, ToolPose};
use toolglide_machines::models;

/// Poses that are gone through again and again.
const POSES: u32 = 1024;

fn inverse(criterion: &mut Criterion) {
    for model in models() {
        let mut config = (model.preset)();
        for axis in &mut config.axis {
            axis.travel = None;
        }
        let machine = (model.build)(&config).expect("a preset is legal");
        // A slow wave on every axis, from a position that every machine can take.
        let poses: Vec<ToolPose> = (0..POSES)
            .map(|tick| {
                let mut axes = AxisVector::zeros(machine.axes().len());
                for (index, axis) in machine.axes().iter().enumerate() {
                    let wave = (f64::from(tick) * std::f64::consts::TAU / f64::from(POSES)
                        + 0.7 * f64::from(u8::try_from(index).expect("few axes")))
                    .sin();
                    axes[index] = match axis.kind {
                        AxisKind::Linear => 200.0 + 20.0 * wave,
                        AxisKind::Rotary => 0.6 + 0.3 * wave,
                    };
                }
                machine.forward(&axes).expect("in reach")
            })
            .collect();
        let mut axes = AxisVector::zeros(machine.axes().len());
        let mut tick = 0;
        criterion.bench_function(&format!("inverse {}", model.name), |bencher| {
            bencher.iter(|| {
                tick = (tick + 1) % poses.len();
                axes = machine
                    .inverse(black_box(&poses[tick]), &axes)
                    .expect("in reach");
                axes
            });
        });
        criterion.bench_function(&format!("follow {}", model.name), |bencher| {
            bencher.iter(|| {
                tick = (tick + 1) % poses.len();
                axes = machine
                    .follow(black_box(&poses[tick]), &axes)
                    .expect("in reach");
                axes
            });
        });
        criterion.bench_function(&format!("forward {}", model.name), |bencher| {
            bencher.iter(|| machine.forward(black_box(&axes)).expect("in reach"));
        });
    }
}

criterion_group!(benches, inverse);
criterion_main!(benches);

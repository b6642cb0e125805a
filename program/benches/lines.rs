//! Lines of a program read per second.

#![allow(clippy::expect_used, reason = "a failed measurement is a failed bench")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::fmt::Write;
use std::hint::black_box;
use toolglide_kinematics::Tolerance;
use toolglide_program::{Program, Settings};

/// Lines of each program that is measured.
const LINES: u32 = 100_000;

fn program(line: impl Fn(u32) -> String) -> String {
    let mut text = String::from("G17 G21 G90 G64 P0.01\nF3000\nG0 X0 Y0 Z0\n");
    for number in 0..LINES {
        let _ = writeln!(text, "{}", line(number));
    }
    text
}

fn wave(number: u32) -> f64 {
    f64::from(number % 997) * 0.013 - 5.0
}

fn lines(criterion: &mut Criterion) {
    let programs = [
        (
            "simple",
            program(|n| format!("X{:.4} Y{:.4}", wave(n), wave(7 * n))),
        ),
        (
            "numbered",
            program(|n| {
                let (x, y, z) = (wave(n), wave(3 * n), wave(5 * n));
                format!("N{n} G1 X{x:.4} Y{y:.4} Z{z:.4} F{}", 1000 + n % 7)
            }),
        ),
        (
            "many digits",
            program(|n| format!("G1 X{:.16}\tY{:.16}", wave(n), wave(7 * n))),
        ),
        (
            "arcs",
            program(|n| format!("G{} X{} Y0 R20", 2 + n % 2, 10 + n % 2)),
        ),
    ];
    let settings = Settings::new(Tolerance::new(0.01).expect("positive"));
    let mut group = criterion.benchmark_group("lines");
    group.throughput(Throughput::Elements(u64::from(LINES)));
    group.sample_size(20);
    for (name, text) in &programs {
        group.bench_function(*name, |bencher| {
            bencher.iter(|| {
                let program = Program::new(black_box(text.as_bytes()), name, settings);
                program
                    .map(|step| step.expect("legal").line())
                    .fold(0, u32::max)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, lines);
criterion_main!(benches);

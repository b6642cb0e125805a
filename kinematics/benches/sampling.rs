//! Set-points of three axes a second, from pieces of motion into a buffer.
#![allow(clippy::unwrap_used, reason = "a bench that cannot start may panic")]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use toolglide_kinematics::{MoveRange, Piece, Sample, SamplePeriod, Sampler, Vector};

/// Pieces of one motion.
const PIECES: u32 = 2_000;

/// Time between two set-points, s.
const PERIOD: f64 = 1e-3;

/// A motion of pieces of constant jerk, each of which lasts about as many periods as told.
fn motion(periods: f64) -> Vec<Piece<3>> {
    let mut state = Sample::at_rest(Vector::<3>::zeros());
    let mut pieces = Vec::new();
    for number in 0..PIECES {
        // Up, hold, down, hold and so forth, differently on each axis.
        state.jerk = Vector::<3>::from_fn(|axis, _| match (number as usize + axis) % 4 {
            0 => 5e3,
            2 => -5e3,
            _ => 0.0,
        });
        let duration = PERIOD * periods * (1.0 + 0.3 * f64::from(number % 7) / 7.0);
        let piece = Piece::new(&state, duration, Vector::zeros(), MoveRange::one(number));
        // The end is where the polynomial leads.
        let almost = piece.at(duration * (1.0 - f64::EPSILON));
        pieces.push(Piece::new(
            &state,
            duration,
            almost.position,
            piece.serves(),
        ));
        state = almost;
    }
    pieces
}

fn ticks(pieces: &[Piece<3>], buffer: &mut [[f64; 3]]) -> usize {
    let mut sampler = Sampler::new(SamplePeriod::new(PERIOD).unwrap());
    let mut filled = 0;
    for piece in pieces {
        sampler.feed(piece);
        while let Some((_, position)) = sampler.next_tick() {
            buffer[filled] = position.into();
            filled += 1;
        }
    }
    filled
}

fn sampling(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("set-points of three axes");
    group.measurement_time(std::time::Duration::from_secs(1));
    group.warm_up_time(std::time::Duration::from_millis(300));
    group.sample_size(20);
    for periods in [2.0, 10.0, 100.0] {
        let pieces = motion(periods);
        let total: f64 = pieces.iter().map(Piece::duration).sum();
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some hundred thousand ticks"
        )]
        let mut buffer = vec![[0.0; 3]; (total / PERIOD) as usize + 2];
        let count = ticks(&pieces, &mut buffer);
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(format!("{periods} to a piece"), |bencher| {
            bencher.iter(|| ticks(black_box(&pieces), black_box(&mut buffer)));
        });
        group.bench_function(
            format!("{periods} to a piece, with all states"),
            |bencher| {
                bencher.iter(|| {
                    let mut sampler = Sampler::new(SamplePeriod::new(PERIOD).unwrap());
                    let mut filled = 0;
                    for piece in black_box(&pieces) {
                        sampler.feed(piece);
                        while let Some((_, sample)) = sampler.next_sample() {
                            black_box(sample);
                            filled += 1;
                        }
                    }
                    filled
                });
            },
        );
    }
    group.finish();
}

criterion_group!(benches, sampling);
criterion_main!(benches);

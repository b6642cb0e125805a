//! Measures a tick of three axes, decision included, under a busy operator, and the longest push of the planner beside it.
//!
//! The same run is repeated, and the least time of each tick counts, so that what else the machine does stays out.

use std::io::Write;
use std::time::Instant;
use toolglide_kinematics::{
    Feedrate, Limits, MotionPlanner, Move, Piece, Reserve, SamplePeriod, Tolerance, Vector,
};
use toolglide_realtime::{Executor, OverrideKind, Settings, Terms};
use toolglide_smoothing::KinematicSmoothing;

/// How often the run is repeated.
const REPEATS: usize = 15;

/// Ticks of a run.
const TICKS: usize = 20_000;

fn nanoseconds(begin: Instant) -> u32 {
    u32::try_from(begin.elapsed().as_nanos()).unwrap_or(u32::MAX)
}

/// Pieces of a path of corners and of a curve of fine chords, and the longest push, ns.
fn planned(factor: f64) -> Result<(Vec<Piece<3>>, u32), Box<dyn std::error::Error>> {
    let limits = Limits::uniform(500.0, 2000.0, 5e4)?.reserved(Reserve::default())?;
    let mut planner =
        KinematicSmoothing::new(Vector::zeros(), &toolglide_smoothing::Settings::new(limits));
    let (feedrate, tolerance) = (Feedrate::new(100.0 * factor)?, Tolerance::new(0.01)?);
    let mut pieces = Vec::new();
    let mut longest = 0;
    for step in 1..=4000_u32 {
        let angle = std::f64::consts::TAU * f64::from(step % 1000) / 1000.0;
        let end = if (step / 1000) % 2 == 0 {
            Vector::from([
                60.0 * (2.0 * angle).sin(),
                40.0 * (3.0 * angle).sin(),
                5.0 * angle.sin(),
            ])
        } else {
            let side = f64::from(step % 2);
            Vector::from([0.5 * f64::from(step % 1000), 4.0 * side, 0.3 * side])
        };
        let next = Move::line_to(end, feedrate, tolerance)?;
        let begin = Instant::now();
        planner.push(&next)?;
        longest = longest.max(nanoseconds(begin));
        pieces.extend(std::iter::from_fn(|| planner.pull()));
    }
    planner.finish()?;
    pieces.extend(std::iter::from_fn(|| planner.pull()));
    Ok((pieces, longest))
}

/// Time of each tick of one run, ns; the least of those before counts.
fn run(
    proto: &Executor<3>,
    pieces: &[Piece<3>],
    busy: bool,
    least: &mut [u32],
) -> Result<(), Box<dyn std::error::Error>> {
    let mut executor = proto.clone();
    let mut seed = 1_u64;
    let mut share = move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        f64::from(u32::try_from(seed >> 40).unwrap_or(0)) / f64::from(1_u32 << 24)
    };
    let mut next = 0;
    for spent in least {
        while next < pieces.len() && executor.room() > 0 {
            executor.feed(&pieces[next], Terms::feed(100.0))?;
            next += 1;
        }
        if busy && share() < 0.02 {
            let command = executor.command();
            match share() {
                x if x < 0.25 => command.hold(),
                x if x < 0.4 => command.reverse(),
                x if x < 0.6 => command.forward(),
                _ => {
                    command.resume();
                    command.feed(share())?;
                }
            }
        }
        let begin = Instant::now();
        executor.tick();
        *spent = nanoseconds(begin).min(*spent);
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = std::io::stdout().lock();
    writeln!(
        out,
        "a tick of three axes at 1 ms, us      median    99 %   99.9 %  99.99 %    worst"
    )?;
    let limits = Limits::uniform(500.0, 2000.0, 5e4)?;
    let period = SamplePeriod::new(0.001)?;
    for (name, factor, kind, busy) in [
        ("without commands", 1.0, OverrideKind::Uniform, false),
        ("busy operator", 1.0, OverrideKind::Uniform, true),
        (
            "busy operator, capped at 200 %",
            2.0,
            OverrideKind::Capped,
            true,
        ),
    ] {
        let (pieces, longest) = planned(factor)?;
        let settings = Settings::new(limits, period)
            .with_fastest(100.0 * factor)?
            .with_greatest_override(factor, kind)?;
        let proto = Executor::new(Vector::zeros(), &settings);
        let mut least = vec![u32::MAX; TICKS];
        for _ in 0..REPEATS {
            run(&proto, &pieces, busy, &mut least)?;
        }
        least.sort_unstable();
        let at = |share: f64| {
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "an index of a short list"
            )]
            let index = ((TICKS - 1) as f64 * share) as usize;
            f64::from(least[index]) * 1e-3
        };
        writeln!(
            out,
            "{name:<36} {:7.2} {:7.2}  {:7.2}  {:7.2}  {:7.2}   longest push of kcs {:.0} us",
            at(0.5),
            at(0.99),
            at(0.999),
            at(0.9999),
            at(1.0),
            f64::from(longest) * 1e-3
        )?;
    }
    Ok(())
}

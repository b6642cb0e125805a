//! A controller in small: moves arrive over a slow line, a servo loop takes a set-point every millisecond, and the
//! operator holds, turns the override wheel and loses the power in the middle.
//!
//! Time is counted in ticks here, so that every run prints the same. `docs/embedding.md` explains it step by step.
//!
//! Run it with `cargo run --release -p toolglide-realtime --example controller`.

use std::collections::VecDeque;
use std::io::Write;
use toolglide_kinematics::{
    Feedrate, Limits, MotionPlanner, Move, Piece, Reserve, SamplePeriod, Tolerance, Vector,
};
use toolglide_realtime::{Activity, Executor, Settings, Terms};
use toolglide_smoothing::KinematicSmoothing;

/// Moves that the line brings in one tick.
const MOVES_PER_TICK: usize = 3;

/// Ticks during which the line is silent: somebody pulled the plug, and put it in again.
const SILENCE: std::ops::Range<u64> = 800..4000;

/// The operator: at which tick, and what.
const HOLD: u64 = 4500;
const RESUME: u64 = 5200;
const WHEEL: u64 = 6000;
const POWER_FAILS: u64 = 9000;

/// A curve of fine chords that crosses itself.
fn program() -> impl Iterator<Item = Vector<2>> {
    (1..=4000_u32).map(|step| {
        let angle = std::f64::consts::TAU * f64::from(step) / 4000.0;
        Vector::from([60.0 * (2.0 * angle).sin(), 40.0 * (3.0 * angle).sin()])
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let limits = Limits::uniform(500.0, 2000.0, 5e4)?;
    let (feedrate, tolerance) = (Feedrate::new(100.0)?, Tolerance::new(0.01)?);
    // The planner keeps the limits less the reserve; the executor has all of them.
    let plan_limits = limits.reserved(Reserve::default())?;
    let mut planner = KinematicSmoothing::new(
        Vector::zeros(),
        &toolglide_smoothing::Settings::new(plan_limits),
    );
    let settings = Settings::new(limits, SamplePeriod::new(0.001)?).with_fastest(100.0)?;
    let mut executor = Executor::new(Vector::zeros(), &settings);
    let mut ready = VecDeque::<Piece<2>>::new();
    let mut line = program();
    let mut arrived = VecDeque::new();
    let mut out = std::io::stdout().lock();
    writeln!(
        out,
        "needs        {:.3} s of plan in hand",
        executor.needs_in_hand()
    )?;
    let (mut last, mut fastest, mut over) = (Activity::Idle, 0.0_f64, false);
    for tick in 0_u64.. {
        // What the line brings.
        if !SILENCE.contains(&tick) {
            let before = arrived.len();
            arrived.extend(line.by_ref().take(MOVES_PER_TICK));
            over |= arrived.len() == before;
        }
        // The planning task: as far ahead as the executor needs, and as the longest push takes.
        while tick < POWER_FAILS && executor.in_hand() < executor.needs_in_hand() + 0.1 {
            if let Some(piece) = ready.pop_front() {
                executor.feed(&piece, Terms::feed(100.0))?;
                continue;
            }
            match arrived.pop_front() {
                Some(end) => planner.push(&Move::line_to(end, feedrate, tolerance)?)?,
                None if over && planner.finish().is_ok() => {}
                None => break,
            }
            ready.extend(std::iter::from_fn(|| planner.pull()));
            if over && ready.is_empty() && arrived.is_empty() {
                break;
            }
        }
        // The operator.
        match tick {
            HOLD => executor.command().hold(),
            RESUME => executor.command().resume(),
            WHEEL => drop(executor.command().feed(0.3)?),
            // The supply lasts for stops_within: the machine stops on its path.
            POWER_FAILS => executor.command().abort(),
            _ => {}
        }
        if matches!(tick, HOLD | POWER_FAILS) {
            writeln!(
                out,
                "tick {tick:5}   stops within {:.3} s",
                executor.stops_within()
            )?;
        }
        // The servo task: one set-point.
        let at = executor.tick();
        fastest = fastest.max(at.sample.velocity.norm());
        if at.activity != last {
            writeln!(
                out,
                "tick {tick:5}   {:?} at rate {:.3}",
                at.activity, at.rate
            )?;
            last = at.activity;
        }
        if matches!(at.activity, Activity::Aborted) || tick > 60_000 {
            let [x, y] = at.sample.position.into();
            writeln!(
                out,
                "stands       at X{x:.3} Y{y:.3}, in move {}",
                at.serves.last
            )?;
            break;
        }
    }
    writeln!(out, "speed        {fastest:.1} mm/s at most")?;
    writeln!(out, "infeasible   {} steps", executor.infeasible_steps())?;
    Ok(())
}

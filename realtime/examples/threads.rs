//! A planner thread and a servo thread at 1 kHz with a lock-free queue of pieces between them; prints the worst tick.
//!
//! The servo thread waits for its tick by sleeping, allocates nothing and never blocks on the planner. On a system without
//! real-time scheduling the tick may come late; how long the work in it took is what this example measures.
//!
//! Run it with `cargo run --release -p toolglide-realtime --example threads`.

use std::io::Write;
use std::thread;
use std::time::{Duration, Instant};
use toolglide_kinematics::{
    Feedrate, Limits, MotionPlanner, Move, Piece, Reserve, SamplePeriod, Tolerance, Vector,
};
use toolglide_realtime::{Activity, Executor, Settings, Terms};
use toolglide_smoothing::KinematicSmoothing;

/// Pieces between the threads.
const QUEUE: usize = 1024;

/// The period of the servo thread.
const PERIOD: Duration = Duration::from_millis(1);

type Fault = Box<dyn std::error::Error + Send + Sync>;

/// Plans the program and hands its pieces over, as fast as the queue takes them.
fn plan(limits: Limits<3>, mut queue: rtrb::Producer<Piece<3>>) -> Result<(), Fault> {
    let settings = toolglide_smoothing::Settings::new(limits);
    let mut planner = KinematicSmoothing::new(Vector::zeros(), &settings);
    let (feedrate, tolerance) = (Feedrate::new(100.0)?, Tolerance::new(0.01)?);
    let mut hand_over = |planner: &mut KinematicSmoothing<3>| {
        while let Some(piece) = planner.pull() {
            let mut waiting = piece;
            while let Err(rtrb::PushError::Full(back)) = queue.push(waiting) {
                waiting = back;
                thread::sleep(PERIOD);
            }
        }
    };
    for step in 1..=400_u32 {
        let angle = std::f64::consts::TAU * f64::from(step) / 400.0;
        let end = Vector::from([
            40.0 * angle.sin(),
            30.0 * (2.0 * angle).sin(),
            f64::from(step % 2),
        ]);
        planner.push(&Move::line_to(end, feedrate, tolerance)?)?;
        hand_over(&mut planner);
    }
    planner.finish()?;
    hand_over(&mut planner);
    Ok(())
}

/// Executes what arrives, holds once in the middle, and gives ticks, worst work of a tick and the end.
fn servo(
    mut executor: Executor<3>,
    mut queue: rtrb::Consumer<Piece<3>>,
) -> Result<(u64, Duration, Vector<3>), Fault> {
    let mut worst = Duration::ZERO;
    let mut next = Instant::now();
    for tick in 0_u64.. {
        next += PERIOD;
        thread::sleep(next.saturating_duration_since(Instant::now()));
        let begin = Instant::now();
        // A few pieces a tick bound the work of it.
        for _ in 0..16 {
            if executor.room() == 0 {
                break;
            }
            match queue.pop() {
                Ok(piece) => executor.feed(&piece, Terms::feed(100.0))?,
                Err(_) => break,
            }
        }
        match tick {
            1500 => executor.command().hold(),
            1800 => executor.command().resume(),
            _ => {}
        }
        let at = executor.tick();
        worst = worst.max(begin.elapsed());
        let over = queue.is_abandoned() && queue.is_empty() && executor.in_hand() <= 0.0;
        if over && at.activity == Activity::Idle {
            return Ok((tick, worst, at.sample.position));
        }
    }
    Err("the ticks of 64 bits are used up".into())
}

fn main() -> Result<(), Fault> {
    let limits = Limits::uniform(500.0, 2000.0, 5e4)?;
    let settings =
        Settings::new(limits, SamplePeriod::new(PERIOD.as_secs_f64())?).with_fastest(100.0)?;
    let executor = Executor::new(Vector::zeros(), &settings);
    let plan_limits = limits.reserved(Reserve::default())?;
    let (producer, consumer) = rtrb::RingBuffer::new(QUEUE);
    let planner = thread::spawn(move || plan(plan_limits, producer));
    let servo = thread::spawn(move || servo(executor, consumer));
    planner
        .join()
        .map_err(|_| "the planner thread panicked")??;
    let (ticks, worst, end) = servo.join().map_err(|_| "the servo thread panicked")??;
    let mut out = std::io::stdout().lock();
    writeln!(
        out,
        "{ticks} ticks, at most {:.1} us of work in one",
        1e6 * worst.as_secs_f64()
    )?;
    writeln!(out, "ended at X{:.3} Y{:.3} Z{:.3}", end[0], end[1], end[2])?;
    Ok(())
}

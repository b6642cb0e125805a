//! A controller in small: moves arrive over a slow line, a servo loop takes a set-point every
//! millisecond, and the planner in between never lets the loop go hungry while the machine moves.
//!
//! Three rules make it safe. Motion is planned ahead to a reserve, not to the end of the program.
//! When nothing arrives and the reserve runs low, a pause of no length is pushed: the motion comes to
//! rest at the last point that is known, and goes on when more arrives. The loop itself only
//! evaluates polynomials. Time is counted in ticks here, so that every run prints the same.
//!
//! Run it with `cargo run --release -p toolglide-smoothing --example controller`.

use std::collections::VecDeque;
use std::io::Write;
use toolglide_kinematics::{
    Feedrate, Limits, MotionPlanner, Move, Piece, SamplePeriod, Sampler, Tolerance, Vector,
};
use toolglide_smoothing::{KinematicSmoothing, Settings};

/// Motion that should be in hand, s: planned, but not yet handed to the servo loop.
const RESERVE: f64 = 0.25;

/// With less than this in hand and nothing more to plan, the motion is brought to rest, s. It must be
/// longer than the longest time that one push may take.
const LOW: f64 = 0.05;

/// After this many ticks in which nothing arrived, what is pending is travelled anyway.
const PATIENCE: u64 = 100;

/// Moves that the line brings in one tick.
const MOVES_PER_TICK: usize = 3;

/// Ticks during which the line is silent: somebody pulled the plug, and put it in again.
const SILENCE: std::ops::Range<u64> = 800..4000;

/// A curve of fine chords that crosses itself.
fn program() -> impl Iterator<Item = Vector<2>> {
    (1..=4000_u32).map(|step| {
        let angle = std::f64::consts::TAU * f64::from(step) / 4000.0;
        Vector::from([60.0 * (2.0 * angle).sin(), 40.0 * (3.0 * angle).sin()])
    })
}

/// What is planned and not yet travelled.
#[derive(Default)]
struct Reserve {
    pieces: VecDeque<Piece<2>>,
    duration: f64,
}

impl Reserve {
    fn fill(&mut self, planner: &mut KinematicSmoothing<2>) {
        while let Some(piece) = planner.pull() {
            self.duration += piece.duration();
            self.pieces.push_back(piece);
        }
    }

    fn take(&mut self) -> Option<Piece<2>> {
        let piece = self.pieces.pop_front()?;
        self.duration -= piece.duration();
        Some(piece)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let settings = Settings::new(Limits::uniform(500.0, 2000.0, 5e4)?);
    let (feedrate, tolerance) = (Feedrate::new(100.0)?, Tolerance::new(0.01)?);
    let period = SamplePeriod::new(0.001)?;
    let mut planner = KinematicSmoothing::new(Vector::zeros(), &settings);
    let mut reserve = Reserve::default();
    let mut sampler = Sampler::new(period);

    let mut line = program();
    let mut arrived = VecDeque::new();
    let (mut over, mut finished, mut resting) = (false, false, true);
    let mut silent = 0_u64;
    let (mut stops, mut hungry, mut fastest) = (0_u32, 0_u32, 0.0_f64);
    let mut speed = 0.0_f64;
    let mut tick = 0_u64;
    loop {
        // What the line brings.
        silent += 1;
        if !SILENCE.contains(&tick) {
            let before = arrived.len();
            arrived.extend(line.by_ref().take(MOVES_PER_TICK));
            over |= arrived.len() == before;
            silent = 0;
        }

        let moving = speed > 0.5;
        // The planning task: as far ahead as the reserve asks.
        while reserve.duration < RESERVE && !finished {
            if let Some(end) = arrived.pop_front() {
                planner.push(&Move::line_to(end, feedrate, tolerance)?)?;
                resting = false;
            } else if over {
                planner.finish()?;
                finished = true;
            } else if !resting
                && silent > 0
                && (moving && reserve.duration < LOW || silent > PATIENCE)
            {
                planner.push(&Move::dwell(0.0, tolerance)?)?;
                resting = true;
                stops += 1;
            } else {
                break;
            }
            reserve.fill(&mut planner);
        }

        // The servo task: one set-point.
        let sample = loop {
            match sampler.next_sample() {
                Some((_, sample)) => break Some(sample),
                None => match reserve.take() {
                    Some(piece) => sampler.feed(&piece),
                    None => break None,
                },
            }
        };
        match sample {
            Some(sample) => {
                speed = sample.velocity.norm();
                fastest = fastest.max(speed);
            }
            None if finished => break,
            // Without motion the machine must be standing still.
            None => hungry += u32::from(moving),
        }
        tick += 1;
    }
    let mut out = std::io::stdout().lock();
    writeln!(out, "motion       {:.3} s", sampler.end_time())?;
    writeln!(out, "with pauses  {:.3} s", 0.001 * tick as f64)?;
    writeln!(out, "speed        {fastest:.1} mm/s at most")?;
    writeln!(out, "stops        {stops} because nothing arrived")?;
    writeln!(
        out,
        "hungry       {hungry} ticks in motion without a set-point"
    )?;
    Ok(())
}

//! A hold comes to rest as soon as its path allows, and never later than promised.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{Limits, MotionPlanner, Move, Piece, Reserve, SamplePeriod, Vector};
use toolglide_optimal::TimeOptimal;
use toolglide_realtime::{Executor, Settings, Terms};
use toolglide_smoothing::KinematicSmoothing;
use toolglide_tests::corpus::{moves, text};
use toolglide_verify::{EXECUTED_SLACK, ExecutedJudge};

const PLACES: u32 = 60;

fn planned(moves: &[Move<3>], method: &str, limits: Limits<3>) -> Vec<Piece<3>> {
    let start = Vector::zeros();
    let mut planner: Box<dyn MotionPlanner<3>> = match method {
        "kcs" => Box::new(KinematicSmoothing::new(
            start,
            &toolglide_smoothing::Settings::new(limits),
        )),
        _ => Box::new(TimeOptimal::new(
            start,
            &toolglide_optimal::Settings::new(limits),
        )),
    };
    let mut pieces = Vec::new();
    for step in moves {
        planner.push(step).unwrap();
        pieces.extend(std::iter::from_fn(|| planner.pull()));
    }
    planner.finish().unwrap();
    pieces.extend(std::iter::from_fn(|| planner.pull()));
    pieces
}

/// Time to rest of holds at places spread over a motion, sorted, s; each judged and within its promise.
fn holds(pieces: &[Piece<3>], limits: Limits<3>, feedrate: f64) -> Vec<f64> {
    let settings = Settings::new(limits, SamplePeriod::new(1e-3).unwrap())
        .with_fastest(feedrate)
        .unwrap()
        .with_room(1 << 17, 64);
    let mut proto = Executor::new(pieces[0].start(), &settings);
    let mut expected = ExecutedJudge::new(limits);
    for piece in pieces {
        proto.feed(piece, Terms::default()).unwrap();
        expected.expect(piece);
    }
    let duration: f64 = pieces.iter().map(Piece::duration).sum();
    let mut times = Vec::new();
    let mut ticks = 0_u32;
    for place in 0..PLACES {
        let at = duration * (f64::from(place) + 0.5) / f64::from(PLACES);
        while f64::from(ticks) * 1e-3 < at {
            proto.tick();
            ticks += 1;
        }
        let mut executor = proto.clone();
        let promised = executor.stops_within();
        executor.command().hold();
        let mut judge = expected.clone();
        judge.begin_at(f64::from(ticks) * 1e-3);
        let mut count = 0_u32;
        executor.tick();
        while executor.in_hand() > 0.0 {
            for law in executor.time_laws() {
                judge.observe(&law);
            }
            count += 1;
            if executor.tick().rate.abs() <= 0.0 {
                break;
            }
        }
        if executor.in_hand() <= 0.0 {
            continue; // the end came first
        }
        let time = f64::from(count) * 1e-3;
        assert!(
            time <= promised,
            "hold at {at} s: {time} s, promised {promised} s"
        );
        assert!(
            judge
                .worst
                .iter()
                .all(|&worst| worst <= 1.0 + EXECUTED_SLACK),
            "hold at {at} s: {:?}",
            judge.worst
        );
        assert_eq!(executor.infeasible_steps(), 0, "at {at} s");
        times.push(time);
    }
    times.sort_by(f64::total_cmp);
    times
}

#[test]
fn holds_come_to_rest_as_fast_as_the_path_allows() {
    for (name, method, take, median, worst) in [
        ("corner90", "kcs", usize::MAX, 0.054, 0.08),
        ("spiral1mm", "kcs", usize::MAX, 0.09, 0.125),
        ("zig2000", "kcs", 200, 0.075, 0.18),
        ("zig2000", "optimal", 200, 0.135, 0.19),
        ("liss20k", "kcs", 3000, 0.08, 0.15),
        ("liss20k", "optimal", 3000, 0.08, 0.15),
    ] {
        let Some(program) = text(&format!("bench/{name}.ngc")) else {
            continue;
        };
        let mut moves = moves(&program, name, 0.01).unwrap();
        moves.truncate(take);
        let limits = if name == "corner90" {
            Limits::uniform(500.0, 2500.0, 2e5)
        } else {
            Limits::uniform(500.0, 2000.0, 5e4)
        }
        .unwrap();
        let plan_limits = limits.reserved(Reserve::default()).unwrap();
        let pieces = planned(&moves, method, plan_limits);
        let times = holds(&pieces, limits, 100.0);
        let (middle, last) = (times[times.len() / 2], times[times.len() - 1]);
        eprintln!(
            "{name} {method}: {} holds, median {middle:.3}, worst {last:.3}",
            times.len()
        );
        assert!(middle <= median + 5e-4, "{name} {method}: median {middle}");
        assert!(last <= worst + 5e-4, "{name} {method}: worst {last}");
    }
}

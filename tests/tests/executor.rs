//! Executed motion keeps every limit between its ticks, stays on the plan, stops as promised and ends where it should,
//! whatever the operator does.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use toolglide_kinematics::{Limits, Piece, Reserve, SamplePeriod, Sampler, Vector};
use toolglide_realtime::{
    Activity, CommandError, Event, Executor, FeedError, OverrideKind, Settings, Taken, Terms, Tick,
};
use toolglide_tests::pieces::{Motion, Random};
use toolglide_verify::{EXECUTED_SLACK, ExecutedJudge};

const H: f64 = 1e-3;

fn period() -> SamplePeriod {
    SamplePeriod::new(H).unwrap()
}

fn limits<const N: usize>() -> Limits<N> {
    Limits::uniform(100.0, 2000.0, 5e4).unwrap()
}

/// Wandering motion with dwells, which ends at rest.
fn wandering<const N: usize>(random: &mut Random, plan: Limits<N>, rounds: u32) -> Vec<Piece<N>> {
    let mut motion = Motion::new(plan);
    for round in 0..rounds {
        motion.wander(random, 40);
        motion.stop();
        motion.next_block();
        if round % 2 == 0 {
            motion.dwell(0.0004 + 0.1 * random.share());
            motion.next_block();
        }
    }
    motion.pieces
}

/// An executor with its judge.
struct Run<const N: usize> {
    executor: Executor<N>,
    judge: ExecutedJudge<N>,
    /// Largest distance from the plan, mm.
    off: f64,
    last: Option<Tick<N>>,
}

impl<const N: usize> Run<N> {
    fn new(settings: &Settings<N>, limits: Limits<N>) -> Self {
        Self {
            executor: Executor::new(Vector::zeros(), settings),
            judge: ExecutedJudge::new(limits),
            off: 0.0,
            last: None,
        }
    }

    fn feed(&mut self, piece: &Piece<N>) {
        self.executor.feed(piece, Terms::default()).unwrap();
        self.judge.expect(piece);
    }

    fn tick(&mut self) -> Tick<N> {
        let planned = self.judge.planned();
        let tick = self.executor.tick();
        if let Some(place) = self.judge.place(planned) {
            self.off = self.off.max((place - tick.sample.position).amax());
        }
        for law in self.executor.time_laws() {
            self.judge.observe(&law);
        }
        self.last = Some(tick);
        tick
    }

    fn check(&self) -> Result<(), TestCaseError> {
        let worst = self.judge.worst;
        prop_assert!(
            worst.iter().all(|&share| share <= 1.0 + EXECUTED_SLACK),
            "velocity, acceleration, jerk: {worst:?} of the limits"
        );
        prop_assert!(
            self.judge.gap < 1e-9,
            "planned time jumps by {} s",
            self.judge.gap
        );
        prop_assert!(self.off < 1e-9, "{} mm off the plan", self.off);
        prop_assert_eq!(self.executor.infeasible_steps(), 0, "steps without a rate");
        Ok(())
    }
}

/// A random operator on random motion, until everything is let go and the motion ends.
fn operate<const N: usize>(seed: u64, kind: OverrideKind) -> Result<(), TestCaseError> {
    let mut random = Random::new(seed);
    let rho = [0.05, 0.02, 0.01, 0.005, 0.001][random.below(5) as usize];
    let reserve = Reserve::new(rho).unwrap();
    let plan = limits().reserved(reserve).unwrap();
    let pieces = wandering(&mut random, plan, 6);
    let greatest = 1.0 + random.share();
    let settings = Settings::new(limits::<N>(), period())
        .with_reserve(reserve)
        .with_greatest_override(greatest, kind)
        .unwrap()
        .with_room(512, 64);
    let mut run = Run::new(&settings, limits());
    let terms = |index: usize| match index % 97 {
        0..20 => Terms::rapid(),
        _ => Terms::feed(100.0 / greatest),
    };
    let (mut next, mut silent, mut wheel) = (0, 0_u32, false);
    let mut hold: Option<(u32, f64)> = None;
    for tick in 0..40_000_u32 {
        let over = tick >= 2500;
        silent = silent.saturating_sub(1);
        while silent == 0
            && next < pieces.len()
            && run.executor.room() > 0
            && (over || run.executor.in_hand() < run.executor.needs_in_hand() + 0.1)
        {
            run.executor.feed(&pieces[next], terms(next)).unwrap();
            run.judge.expect(&pieces[next]);
            next += 1;
        }
        let promise = run.executor.stops_within();
        let command = run.executor.command();
        if over {
            command.resume();
            command.forward();
            command.feed(greatest).unwrap();
            command.rapid(1.0).unwrap();
            hold = None;
        } else if random.below(40) == 0 {
            wheel = false;
            match random.below(9) {
                0 => {
                    command.hold();
                    hold = hold.or(Some((tick, promise)));
                }
                1 => command.reverse(),
                2 => command.forward(),
                3 => wheel = true,
                4 => drop(command.rapid(random.share()).unwrap()),
                5 => silent = random.below(900),
                6 => command.stop_at_block_end(),
                _ => {
                    command.resume();
                    hold = None;
                    command.feed(greatest * random.share()).unwrap();
                }
            }
        } else if wheel {
            command.feed(greatest * random.share()).unwrap();
        }
        let at = run.tick();
        prop_assert!(at.rate.abs() <= 1.0 + 1e-12, "rate {}", at.rate);
        if let Some((since, promised)) = hold {
            if at.rate.abs() <= 0.0 {
                hold = None;
            } else {
                let waited = H * f64::from(tick - since);
                prop_assert!(
                    waited <= promised + 1e-9,
                    "a hold lasts {waited} s, promised {promised} s"
                );
            }
        }
        if over
            && next == pieces.len()
            && run.executor.in_hand() <= 0.0
            && at.activity == Activity::Idle
        {
            let end = pieces.last().unwrap().end();
            prop_assert_eq!(at.sample.position, end, "it ends where the plan ends");
            return run.check();
        }
    }
    run.check()?;
    Err(TestCaseError::fail("the motion never ends"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases.min(12)))]

    #[test]
    fn an_operator_never_breaks_a_limit_of_one_axis(seed in any::<u64>()) {
        operate::<1>(seed, OverrideKind::Uniform)?;
    }

    #[test]
    fn an_operator_never_breaks_a_limit_of_three_axes(seed in any::<u64>()) {
        operate::<3>(seed, OverrideKind::Uniform)?;
    }

    #[test]
    fn an_operator_never_breaks_a_limit_of_six_axes(seed in any::<u64>()) {
        operate::<6>(seed, OverrideKind::Uniform)?;
    }

    #[test]
    fn an_operator_never_breaks_a_limit_under_capped_feed(seed in any::<u64>()) {
        operate::<2>(seed, OverrideKind::Capped)?;
    }

    #[test]
    fn without_commands_the_ticks_are_those_of_the_sampler(seed in any::<u64>()) {
        without_commands(seed)?;
    }
}

fn without_commands(seed: u64) -> Result<(), TestCaseError> {
    let mut random = Random::new(seed);
    let pieces = wandering(
        &mut random,
        limits::<3>().reserved(Reserve::default()).unwrap(),
        3,
    );
    let settings = Settings::new(limits(), period()).with_room(4096, 4);
    let mut run = Run::new(&settings, limits());
    let mut sampler = Sampler::new(period());
    for piece in &pieces {
        run.feed(piece);
    }
    for piece in &pieces {
        sampler.feed(piece);
        while let Some((time, position)) = sampler.next_tick() {
            let tick = run.tick();
            prop_assert_eq!(tick.sample.position, position, "at {} s", time);
        }
    }
    run.tick();
    let last = run.tick();
    prop_assert_eq!(
        last.sample.position,
        pieces.last().unwrap().end(),
        "the end"
    );
    run.check()
}

/// A motion in which one axis brakes and another accelerates at their jerk limits.
fn locked(reserve: Reserve) -> Vec<Piece<2>> {
    let plan = limits_of_locked().reserved(reserve).unwrap();
    let (a, j) = (plan.acceleration()[0], plan.jerk()[0]);
    let t = a / j;
    let mut motion = Motion::new(plan);
    let lead = [(t, j), (0.02, 0.0), (t, -j)];
    let part = |sign: f64| {
        lead.into_iter()
            .chain([
                (t, -sign * j),
                (2.0 * t, sign * j),
                (2.0 * t, -sign * j),
                (t, sign * j),
            ])
            .collect::<Vec<_>>()
    };
    motion.push_all(&[part(1.0), part(-1.0)]);
    motion.stop();
    motion.pieces
}

#[test]
fn the_seeds_that_once_failed() {
    without_commands(7_982_555_312_887_591_375).unwrap();
    operate::<1>(115_266_441_762_623_357, OverrideKind::Uniform).unwrap();
    operate::<6>(3_249_910_694_583_042_938, OverrideKind::Uniform).unwrap();
    operate::<3>(10_275_785_855_688_519_271, OverrideKind::Uniform).unwrap();
    operate::<2>(5_624_807_737_808_150_784, OverrideKind::Capped).unwrap();
}

#[test]
fn a_start_between_two_steps_keeps_every_limit_when_slower_blocks_follow() {
    let reserve = Reserve::new(0.01).unwrap();
    let plan = limits::<3>().reserved(reserve).unwrap();
    for round in 1..100_u32 {
        let mut motion = Motion::new(plan);
        motion.dwell(0.01 + 1e-5 * f64::from(round));
        motion.next_block();
        motion.wander(&mut Random::new(u64::from(round)), 60);
        motion.stop();
        let settings = Settings::new(limits(), period())
            .with_reserve(reserve)
            .with_greatest_override(1.0, OverrideKind::Uniform)
            .unwrap()
            .with_room(512, 64);
        let mut run = Run::new(&settings, limits());
        run.executor.command().feed(0.3).unwrap();
        for (index, piece) in motion.pieces.iter().enumerate() {
            let terms = if index < 2 {
                Terms::rapid()
            } else {
                Terms::feed(100.0)
            };
            run.executor.feed(piece, terms).unwrap();
            run.judge.expect(piece);
        }
        for _ in 0..1000 {
            run.tick();
        }
        run.check().unwrap();
    }
}

fn limits_of_locked() -> Limits<2> {
    Limits::uniform(500.0, 2000.0, 5e4).unwrap()
}

#[test]
fn a_hold_in_a_locked_plan_is_over_within_its_promise() {
    for tick in 0..300 {
        let settings = Settings::new(limits_of_locked(), period()).with_room(64, 4);
        let mut run = Run::new(&settings, limits_of_locked());
        for piece in &locked(Reserve::default()) {
            run.feed(piece);
        }
        for _ in 0..tick {
            run.tick();
        }
        let promised = run.executor.stops_within();
        run.executor.command().hold();
        let mut waited = 0_u32;
        while run.tick().rate.abs() > 0.0 && run.executor.in_hand() > 0.0 {
            waited += 1;
        }
        assert!(
            H * f64::from(waited) <= promised,
            "{waited} ms, promised {promised} s"
        );
        run.check().unwrap();
    }
}

#[test]
fn a_hold_in_a_locked_plan_without_a_reserve_waits_for_the_rest_of_the_plan() {
    let settings = Settings::new(limits_of_locked(), period())
        .with_reserve(Reserve::NONE)
        .with_room(64, 4);
    let mut run = Run::new(&settings, limits_of_locked());
    let pieces = locked(Reserve::NONE);
    for piece in &pieces {
        run.feed(piece);
    }
    for _ in 0..150 {
        run.tick();
    }
    assert!(
        run.executor.stops_within().is_infinite(),
        "nothing is promised"
    );
    run.executor.command().hold();
    for _ in 0..2000 {
        run.tick();
    }
    run.check().unwrap();
    assert!(run.last.unwrap().rate.abs() <= 0.0, "it rests at last");
}

#[test]
fn a_planner_that_falls_silent_at_any_tick_leads_to_rest_before_the_end_of_what_is_known() {
    let mut random = Random::new(3);
    let mut motion = Motion::new(limits::<2>().reserved(Reserve::default()).unwrap());
    motion.wander(&mut random, 150);
    let pieces = motion.pieces;
    let settings = Settings::new(limits(), period()).with_room(4096, 4);
    for silent in (0..900).step_by(7) {
        let mut run = Run::new(&settings, limits());
        let mut fed = 0;
        for tick in 0..3000 {
            while tick < silent
                && fed < pieces.len()
                && run.executor.in_hand() < run.executor.needs_in_hand() + 0.05
            {
                run.feed(&pieces[fed]);
                fed += 1;
            }
            run.tick();
        }
        let last = run.last.unwrap();
        assert!(
            last.rate.abs() <= 0.0,
            "silent at {silent}: it moves at {}",
            last.rate
        );
        run.check().unwrap();
    }
}

fn running(ticks: u32) -> Run<2> {
    let mut random = Random::new(11);
    let pieces = wandering(
        &mut random,
        limits().reserved(Reserve::default()).unwrap(),
        3,
    );
    let settings = Settings::new(limits(), period()).with_room(4096, 4096);
    let mut run = Run::new(&settings, limits());
    for piece in &pieces {
        run.feed(piece);
    }
    for _ in 0..ticks {
        run.tick();
    }
    run
}

#[test]
fn commands_without_sense_change_nothing() {
    let mut run = running(50);
    let before = run.executor.clone();
    let command = run.executor.command();
    command.resume();
    command.forward();
    for value in [-0.1, f64::NAN, f64::INFINITY] {
        let refused = command.feed(value);
        assert!(
            matches!(refused, Err(CommandError::Override { which: "feed", .. })),
            "{refused:?}"
        );
        assert!(command.rapid(value).is_err(), "rapid {value}");
    }
    assert_eq!(
        command.feed(3.0),
        Ok(Taken::Clamped),
        "more than the greatest"
    );
    let mut same = before;
    for _ in 0..100 {
        assert_eq!(
            run.executor.tick(),
            same.tick(),
            "as if nothing had been said"
        );
    }
}

#[test]
fn reverse_at_the_start_stays_there_and_forward_goes_on() {
    let mut run = running(0);
    run.executor.command().reverse();
    for _ in 0..20 {
        let tick = run.tick();
        assert_eq!(tick.sample.position, Vector::<2>::zeros(), "it stays");
    }
    run.executor.command().forward();
    for _ in 0..50 {
        run.tick();
    }
    assert!(run.last.unwrap().rate > 0.0, "it goes");
    run.check().unwrap();
}

#[test]
fn reverse_comes_back_to_the_start_exactly() {
    let mut run = running(700);
    run.executor.command().reverse();
    for _ in 0..3000 {
        run.tick();
    }
    assert_eq!(
        run.last.unwrap().sample.position,
        Vector::<2>::zeros(),
        "back at the start"
    );
    run.check().unwrap();
}

#[test]
fn an_abort_drops_what_is_in_hand_and_motion_goes_on_from_there() {
    let mut run = running(200);
    run.executor.command().abort();
    run.executor.command().abort();
    for _ in 0..600 {
        run.tick();
    }
    let place = run.last.unwrap();
    assert_eq!(place.activity, Activity::Aborted, "dropped");
    let events: Vec<_> = std::iter::from_fn(|| run.executor.event()).collect();
    assert!(
        events
            .iter()
            .any(|event| matches!(event, Event::Aborted { .. })),
        "{events:?}"
    );
    assert!(
        run.judge
            .worst
            .iter()
            .all(|&share| share <= 1.0 + EXECUTED_SLACK),
        "{:?}",
        run.judge.worst
    );
    let mut motion = Motion::new(limits::<2>().reserved(Reserve::default()).unwrap());
    motion.wander(&mut Random::new(5), 30);
    motion.stop();
    let moved = |piece: &Piece<2>| {
        let mut start = piece.at(0.0);
        start.position += place.sample.position;
        Piece::new(
            &start,
            piece.duration(),
            piece.end() + place.sample.position,
            piece.serves(),
        )
    };
    let first = moved(&motion.pieces[0]);
    assert_eq!(
        run.executor.feed(&first, Terms::default()),
        Err(FeedError::Aborted),
        "not yet"
    );
    run.executor.command().resume();
    for piece in &motion.pieces {
        run.executor.feed(&moved(piece), Terms::default()).unwrap();
    }
    let mut end = place.sample.position;
    for _ in 0..4000 {
        end = run.executor.tick().sample.position;
    }
    assert_eq!(end, moved(motion.pieces.last().unwrap()).end(), "it ends");
}

#[test]
fn a_stop_at_the_end_of_a_block_is_exact() {
    let mut run = running(100);
    run.executor.command().stop_at_block_end();
    let mut stopped = None;
    for _ in 0..8000 {
        let tick = run.tick();
        if tick.activity == Activity::AtBlockEnd {
            stopped = Some(tick);
            break;
        }
    }
    let stopped = stopped.expect("it stops");
    let mut ends = Vec::new();
    let mut random = Random::new(11);
    let pieces = wandering(
        &mut random,
        limits::<2>().reserved(Reserve::default()).unwrap(),
        3,
    );
    for pair in pieces.windows(2) {
        if pair[0].serves() != pair[1].serves() {
            ends.push(pair[0].end());
        }
    }
    let nearest = ends
        .iter()
        .map(|end| (end - stopped.sample.position).norm())
        .fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-9, "{nearest} mm from the end of a block");
    run.executor.command().resume();
    for _ in 0..4000 {
        run.tick();
    }
    assert_eq!(run.last.unwrap().activity, Activity::Idle, "it ends");
    run.check().unwrap();
}

#[test]
fn pieces_that_do_not_follow_or_break_the_plan_are_refused() {
    let plan = limits::<2>().reserved(Reserve::default()).unwrap();
    let mut run = Run::new(&Settings::new(limits(), period()), limits());
    let mut motion = Motion::new(plan);
    motion.push(0.01, Vector::from([plan.jerk()[0] * 1.01, 0.0]));
    let refused = run.executor.feed(&motion.pieces[0], Terms::default());
    assert!(
        matches!(
            refused,
            Err(FeedError::Limit {
                quantity: "jerk",
                axis: 0,
                ..
            })
        ),
        "{refused:?}"
    );
    let mut motion = Motion::new(plan);
    motion.push(0.01, Vector::from([1e4, 0.0]));
    motion.push(0.01, Vector::from([-1e4, 0.0]));
    let refused = run.executor.feed(&motion.pieces[1], Terms::default());
    assert!(
        matches!(refused, Err(FeedError::Gap { .. } | FeedError::Jump { .. })),
        "{refused:?}"
    );
    assert!(
        run.executor
            .feed(&motion.pieces[0], Terms::default())
            .is_ok(),
        "the first follows"
    );
}

#[test]
fn blocks_are_entered_and_left_in_order() {
    let mut run = running(0);
    let mut entered = Vec::new();
    let mut left = Vec::new();
    for _ in 0..6000 {
        run.tick();
        while let Some(event) = run.executor.event() {
            match event {
                Event::Entered { block, .. } => entered.push(block),
                Event::Left { block, .. } => left.push(block),
                _ => {}
            }
        }
    }
    let (first, last) = (entered[0], entered[entered.len() - 1]);
    assert_eq!(
        entered,
        (first..=last).collect::<Vec<_>>(),
        "each once, in order"
    );
    assert_eq!(left, (first..last).collect::<Vec<_>>(), "all but the last");
}

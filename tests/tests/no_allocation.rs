//! Sampling never allocates, nor does planning after it was constructed.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use allocation_counter::measure;
use std::hint::black_box;
use toolglide_kinematics::{
    AxisKind, AxisVector, Limits, MotionPlanner, Move, Path, SamplePeriod, Sampler, Toolpath,
    Vector,
};
use toolglide_machines::models;
use toolglide_smoothing::{KinematicSmoothing, Method, Settings, plan};
use toolglide_tests::course::{Course, Lead, arc, go, stop};

/// Lines, arcs, helices, dwells, stops, repeats and rapids, again and again.
fn mixed(rounds: u32) -> Toolpath<3> {
    let mut legs = Vec::new();
    let mut x = 0.0;
    for round in 0..rounds {
        let tolerance = if round % 3 == 0 { 0.01 } else { 0.1 };
        let mut line = |dx: f64, y: f64, z: f64| {
            x += dx;
            Lead::Line([x, y, z])
        };
        legs.push(go(line(5.0, 0.0, 0.0), 100.0, tolerance));
        legs.push(go(line(0.0, 5.0, 1.0), 100.0, tolerance));
        legs.push(go(line(1e-6, 5.0, 1.0), 100.0, tolerance));
        for step in 0..40 {
            let y = 5.0 - 0.1 * f64::from(step % 2);
            legs.push(go(line(0.05, y, 1.0), 50.0, tolerance));
        }
        let end = line(2.0, 5.0, 1.0);
        legs.push(go(end, f64::INFINITY, tolerance));
        legs.push(go(
            arc([x, 3.0, 0.0], [x, 1.0, 1.0], [0, 1], false, 0),
            100.0,
            tolerance,
        ));
        legs.push(go(
            arc([x, 2.0, 0.0], [x, 1.0, 4.0], [0, 1], true, 2),
            100.0,
            tolerance,
        ));
        legs.push(go(Lead::Dwell(0.05), 100.0, tolerance));
        let mut line = |dx: f64, y: f64, z: f64| {
            x += dx;
            Lead::Line([x, y, z])
        };
        legs.push(stop(line(0.0, 0.0, 0.0), 100.0, tolerance));
        legs.push(go(line(0.0, 0.0, 0.0), 100.0, tolerance));
    }
    let start = [0.0; 3];
    Course { start, legs }.toolpath()
}

fn limits() -> Limits<3> {
    Limits::uniform(500.0, 2_000.0, 5e4).unwrap()
}

#[test]
fn the_counter_counts() {
    let counted = measure(|| drop(black_box(vec![1_u8; 100])));
    assert_eq!(counted.count_total, 1, "{counted:?}");
}

#[test]
fn sampling_never_allocates() {
    let path = mixed(5);
    let motion = plan(&path, &Settings::new(limits())).unwrap();
    let mut sum = Vector::<3>::zeros();
    let mut ticks = 0_u32;
    let counted = measure(|| {
        let mut sampler = Sampler::<3>::new(SamplePeriod::new(1e-3).unwrap());
        for piece in motion.pieces() {
            sampler.feed(piece);
            while let Some((_, position)) = sampler.next_tick() {
                sum += position;
                ticks += 1;
            }
        }
        let mut sampler = Sampler::<3>::new(SamplePeriod::new(1e-3).unwrap());
        for piece in motion.pieces() {
            sampler.feed(piece);
            while let Some((_, sample)) = sampler.next_sample() {
                sum += sample.velocity;
                ticks += 1;
            }
        }
    });
    assert!(ticks > 1_000, "{ticks} ticks, {sum}");
    assert_eq!(counted.count_total, 0, "{counted:?}");
}

/// Pushes a whole path, pulls after each push, and counts the pieces.
fn count_pieces<const N: usize>(planner: &mut impl MotionPlanner<N>, path: &Toolpath<N>) -> u64 {
    let mut pieces = 0;
    for step in path.moves().iter().map(Some).chain([None]) {
        match step {
            Some(step) => planner.push(step).unwrap(),
            None => planner.finish().unwrap(),
        }
        while let Some(piece) = planner.pull() {
            black_box(piece);
            pieces += 1;
        }
    }
    pieces
}

/// Allocations of pushing and pulling a path after construction.
fn allocations(path: &Toolpath<3>, settings: &Settings<3>) -> u64 {
    let mut planner = KinematicSmoothing::new(path.start(), settings);
    let mut pieces = 0_u64;
    let counted = measure(|| pieces = count_pieces(&mut planner, path));
    assert!(pieces > 0, "nothing was planned");
    counted.count_total
}

fn planning_allocates_nothing(path: &Toolpath<3>) {
    for method in Method::ALL {
        for window in [2, 5, 64, 512] {
            let settings = Settings::new(limits())
                .with_method(method)
                .with_window(window);
            let counted = allocations(path, &settings);
            assert_eq!(counted, 0, "{} in a window of {window}", method.name());
        }
    }
}

#[test]
fn planning_lines_allocates_nothing() {
    let path = mixed(20);
    let lines: Vec<Move<3>> = path
        .moves()
        .iter()
        .filter(|step| matches!(step.path(), Path::Line { .. }))
        .copied()
        .collect();
    let mut path = Toolpath::starting_at(path.start()).unwrap();
    for line in lines {
        path.push(line).unwrap();
    }
    planning_allocates_nothing(&path);
}

#[test]
fn planning_arcs_and_dwells_allocates_nothing() {
    planning_allocates_nothing(&mixed(20));
}

#[test]
fn planning_a_long_zigzag_allocates_nothing() {
    let ends: Vec<_> = (1..3_000)
        .map(|k| [f64::from(k), f64::from(k % 2), 0.0])
        .collect();
    planning_allocates_nothing(&Course::of_lines([0.0; 3], &ends, 100.0, 0.01).toolpath());
}

#[test]
fn no_machine_allocates_to_find_its_axes() {
    for model in models() {
        let machine = (model.build)(&(model.preset)()).unwrap();
        let mut axes = AxisVector::zeros(machine.axes().len());
        for (position, axis) in axes.iter_mut().zip(machine.axes()) {
            let (low, high) = axis.travel.unwrap_or((-1.0, 1.0));
            *position = match axis.kind {
                AxisKind::Linear => low + 0.5 * (high - low),
                AxisKind::Rotary => 0.3,
            };
        }
        let mut solutions = 0;
        let counted = measure(|| {
            for _ in 0..100 {
                let pose = machine.forward(&axes).unwrap();
                axes = machine.inverse(&pose, &axes).unwrap();
                solutions += machine.solutions(&pose, &axes).unwrap().len();
            }
        });
        assert!(solutions >= 100, "{}: {solutions}", model.name);
        assert_eq!(counted.count_total, 0, "{}: {counted:?}", model.name);
    }
}

#[test]
fn comparing_planners_allocates_nothing() {
    let path = mixed(20);
    let mut planner = toolglide_fastest::Fastest::new(path.start(), limits());
    let mut pieces = 0_u64;
    let counted = measure(|| pieces = count_pieces(&mut planner, &path));
    assert!(pieces > 1_000, "{pieces} pieces");
    assert_eq!(counted.count_total, 0, "{counted:?}");
}

#[test]
fn planning_filtered_pulses_and_filtering_ticks_allocates_nothing() {
    let path = mixed(20);
    let chain = toolglide_fir::FilterChain::with_time_constants(&[0.05, 0.03]).unwrap();
    for method in toolglide_fir::Method::ALL {
        let settings = toolglide_fir::Settings::new(limits())
            .with_method(method)
            .with_chain(&chain)
            .unwrap();
        let mut planner = toolglide_fir::FirInterpolation::new(path.start(), &settings);
        let mut pieces = 0_u64;
        let counted = measure(|| pieces = count_pieces(&mut planner, &path));
        assert!(pieces > 1_000, "{pieces} pieces");
        assert_eq!(counted.count_total, 0, "{}: {counted:?}", method.name());
    }
    let period = SamplePeriod::new(1e-3).unwrap();
    let mut filter = toolglide_fir::TickFilter::new(&chain, period, [0_i64; 3]).unwrap();
    let counted = measure(|| {
        for tick in 0..10_000 {
            black_box(filter.tick([tick, -tick, 7]));
        }
    });
    assert_eq!(counted.count_total, 0, "ticks: {counted:?}");
}

/// Allocations of time-optimal planning while a path is pushed and pulled.
fn optimal_allocations<const N: usize>(path: &Toolpath<N>, limits: Limits<N>, effort: u8) -> u64 {
    let settings = toolglide_optimal::Settings::new(limits)
        .with_effort(toolglide_optimal::Effort::new(effort).unwrap());
    let mut planner = toolglide_optimal::TimeOptimal::<N>::new(path.start(), &settings);
    let mut pieces = 0_u64;
    let counted = measure(|| pieces = count_pieces(&mut planner, path));
    let tally = planner.windows().unwrap();
    assert!(tally.windows > 10 && pieces > 1_000, "{tally:?}");
    counted.count_total
}

#[test]
fn time_optimal_planning_allocates_nothing() {
    for effort in [1, 5] {
        let counted = optimal_allocations(&mixed(6), limits(), effort);
        assert_eq!(counted, 0, "lines, arcs, dwells and stops, effort {effort}");
    }
    let ends: Vec<_> = (1..400)
        .map(|k| [f64::from(k) * 0.3, f64::from(k % 7) * 0.1, 0.0])
        .collect();
    let short = Course::of_lines([0.0; 3], &ends, 100.0, 0.01).toolpath();
    assert_eq!(optimal_allocations(&short, limits(), 3), 0, "short moves");
    let ends: Vec<_> = (1..40)
        .map(|k| [f64::from(k) * 30.0, f64::from(k % 2) * 30.0, 0.0])
        .collect();
    let long = Course::of_lines([0.0; 3], &ends, 100.0, 0.01).toolpath();
    assert_eq!(optimal_allocations(&long, limits(), 5), 0, "long moves");
    // Limits that let windows fail, and the plan before go on.
    let uneven = course_limits();
    assert_eq!(
        optimal_allocations(&mixed(4), uneven, 2),
        0,
        "uneven limits"
    );
}

fn course_limits() -> Limits<3> {
    toolglide_tests::course::limits(&[
        [500.0, 5_000.0, 4e5],
        [300.0, 600.0, 8e3],
        [100.0, 500.0, 1e4],
    ])
}

//! Motion leaves every mode of vibration at rest wherever it rests, whatever becomes of its windows.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{
    AxisMode, AxisModes, Feedrate, Limits, Mode, MotionPlanner, Move, Plan, Resonator, Tolerance,
    Toolpath, Trajectory, Vector,
};
use toolglide_optimal::{
    Budget, ScpSolver, Settings, Solved, TimeOptimal, Unsolved, Window, WindowMotion, WindowSolver,
};
use toolglide_verify::verify;

/// A solver that finds nothing every few windows.
#[derive(Clone, Debug)]
struct Refusing<const N: usize> {
    solver: ScpSolver<N>,
    windows: u32,
    every: u32,
}

impl<const N: usize> WindowSolver<N> for Refusing<N> {
    fn solve(
        &mut self,
        window: &Window<'_, N>,
        motion: &mut WindowMotion<N>,
        budget: &mut Budget,
    ) -> Result<Solved, Unsolved> {
        self.windows += 1;
        if self.windows.is_multiple_of(self.every) {
            return Err(Unsolved::Numerical { solves: 0 });
        }
        self.solver.solve(window, motion, budget)
    }
}

fn soft() -> Limits<2> {
    Limits::uniform(500.0, 2000.0, 5e4).unwrap()
}

fn stiff() -> Limits<2> {
    Limits::uniform(500.0, 2500.0, 2e5).unwrap()
}

fn modes(list: &[(usize, f64, f64)]) -> AxisModes {
    let modes: Vec<_> = list
        .iter()
        .map(|&(axis, frequency, damping)| AxisMode {
            axis,
            mode: Mode::new(frequency, damping).unwrap(),
        })
        .collect();
    AxisModes::new(&modes).unwrap()
}

fn path(points: &[[f64; 2]], tolerance: f64) -> Toolpath<2> {
    let points: Vec<_> = points
        .iter()
        .map(|&point| Vector::<2>::from(point))
        .collect();
    let feedrate = Feedrate::new(100.0).unwrap();
    Toolpath::from_points(&points, feedrate, Tolerance::new(tolerance).unwrap()).unwrap()
}

fn corner() -> Toolpath<2> {
    path(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]], 0.03)
}

fn planned(path: &Toolpath<2>, limits: Limits<2>, modes: AxisModes, every: u32) -> Plan<2> {
    let settings = Settings::new(limits).with_modes(modes).unwrap();
    let solver = Refusing {
        solver: ScpSolver::new().with_smoothing(settings.smoothing),
        windows: 0,
        every,
    };
    let mut planner = TimeOptimal::with_solver(solver, path.start(), &settings);
    let mut plan = Plan::starting_at(path.start());
    for step in path.moves() {
        planner.push(step).unwrap();
        plan.extend(std::iter::from_fn(|| planner.pull()));
    }
    planner.finish().unwrap();
    plan.extend(std::iter::from_fn(|| planner.pull()));
    let report = verify(&plan, path, &limits);
    assert!(report.passes(), "{:#?}", report.examples);
    plan
}

/// The largest amplitude of any mode wherever the motion rests, µm, with frequencies off by a share.
fn left(plan: &Plan<2>, modes: &AxisModes, off: f64) -> f64 {
    let mut most = 0.0_f64;
    for mode in modes.iter() {
        let mut resonator = Resonator::new(&mode.mode.detuned(1.0 + off).unwrap());
        for piece in plan.pieces() {
            let start = piece.at(0.0);
            if start.velocity.norm() < 1e-7 && start.acceleration.norm() < 1e-5 {
                most = most.max(resonator.displacement());
            }
            resonator.pass(
                start.acceleration[mode.axis],
                start.jerk[mode.axis],
                piece.duration(),
            );
        }
        most = most.max(resonator.displacement());
    }
    1e3 * most
}

#[test]
fn a_corner_leaves_a_mode_at_rest_in_hardly_more_time() {
    let modes = modes(&[(0, 25.0, 0.0), (1, 25.0, 0.0)]);
    for (limits, duration, off) in [(soft(), 0.3388, 4.0), (stiff(), 0.2815, 18.0)] {
        let plan = planned(&corner(), limits, modes, u32::MAX);
        assert!(plan.duration() <= duration, "{} s", plan.duration());
        let exact = left(&plan, &modes, 0.0);
        assert!(exact < 0.5, "{exact} µm");
        for share in [-0.02, 0.02] {
            let robust = left(&plan, &modes, share);
            assert!(robust < off, "{share}: {robust} µm");
        }
    }
}

#[test]
fn a_zigzag_in_several_windows_leaves_unequal_modes_at_rest() {
    let points: Vec<_> = (0..40_u32)
        .map(|k| {
            let k = f64::from(k);
            [2.0 * k, 1.7 * (2.9 * k).sin()]
        })
        .collect();
    let modes = modes(&[(0, 18.0, 0.02), (1, 27.0, 0.02), (1, 60.0, 0.01)]);
    let path = path(&points, 0.05);
    let silent = planned(&path, soft(), modes, u32::MAX);
    let free = planned(&path, soft(), AxisModes::default(), u32::MAX);
    let most = left(&silent, &modes, 0.0);
    assert!(most < 0.5, "{most} µm");
    assert!(
        left(&free, &modes, 0.0) > 5.0,
        "there is something to silence"
    );
    let share = silent.duration() / free.duration();
    assert!(share < 1.03, "{share}");
}

#[test]
fn windows_that_are_refused_leave_the_modes_at_rest_at_every_stop() {
    let mut points = vec![[0.0, 0.0]];
    for k in 0..30_u32 {
        let k = f64::from(k);
        points.push([3.0 * k + 3.0, 2.0 * (2.3 * k).cos()]);
    }
    // One long enough for a middle that no window plans.
    points.push([190.0, 40.0]);
    let modes = modes(&[(0, 18.0, 0.02), (1, 27.0, 0.0)]);
    for every in [1, 2, 4] {
        let plan = planned(&path(&points, 0.03), stiff(), modes, every);
        let most = left(&plan, &modes, 0.0);
        assert!(most < 1.0, "every {every}: {most} µm");
    }
}

#[test]
fn exact_stops_and_short_moves_leave_the_modes_at_rest() {
    let mut path = Toolpath::starting_at(Vector::<2>::zeros()).unwrap();
    for (index, x) in [0.02, 0.05, 1.0, 1.5, 30.0, 30.1].into_iter().enumerate() {
        let y = if index % 2 == 0 { 0.0 } else { 0.3 };
        let (feedrate, tolerance) = (Feedrate::new(80.0).unwrap(), Tolerance::new(0.01).unwrap());
        let step = Move::line_to(Vector::<2>::new(x, y), feedrate, tolerance).unwrap();
        path.push(if index % 3 == 0 {
            step.with_exact_stop()
        } else {
            step
        })
        .unwrap();
    }
    let modes = modes(&[(0, 18.0, 0.0), (1, 27.0, 0.02)]);
    let plan = planned(&path, stiff(), modes, u32::MAX);
    let most = left(&plan, &modes, 0.0);
    assert!(most < 0.5, "{most} µm");
}

#[test]
fn a_mode_slower_than_a_window_can_hold_is_refused_by_its_frequency() {
    let refused = Settings::new(stiff())
        .with_modes(modes(&[(1, 0.5, 0.0)]))
        .unwrap_err();
    assert!((refused.frequency - 0.5).abs() < 1e-12, "{refused}");
    assert!(refused.slowest > 0.5 && refused.slowest < 10.0, "{refused}");
}

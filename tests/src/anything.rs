//! Anything that public constructors take, planned by every planner, and each plan judged.
//!
//! Numbers come from a text of bytes, as a fuzzer makes it, or from a seed when that is over: usual ones, and those
//! on which float arithmetic ends. A constructor may refuse what it is given, and a planner what it is handed; what
//! they take must be planned without a panic, in bounded work, so that the judge finds nothing. Not here: paths as
//! programs have them, see `strategies`.

use std::f64::consts::TAU;
use std::fmt::Debug;
use toolglide_baselines::BezierSmoothing;
use toolglide_fir::{FilterChain, FirInterpolation};
use toolglide_kinematics::{
    Arc, AxisLimits, Feedrate, Limits, MotionPlanner, Move, PlanError, Tolerance, Toolpath, Vector,
};
use toolglide_optimal::TimeOptimal;
use toolglide_smoothing::{KinematicSmoothing, Method, Settings};
use toolglide_verify::{Judge, Report};

/// Most pieces of the motion of one move, so that no planner goes on for ever.
const MAX_PIECES: u64 = 20_000_000;

/// Most chords of an arc at its tolerance.
const MAX_CHORDS: f64 = 10_000.0;

/// Numbers on which float arithmetic ends, or a bound of a constructor lies.
const EDGES: [f64; 26] = [
    0.0,
    -0.0,
    5e-324,
    f64::MIN_POSITIVE,
    1e-300,
    1e-150,
    1e-12,
    1e-10,
    1e-9,
    1e-6,
    1e-3,
    0.1,
    1.0,
    1e3,
    1e6,
    9.999e6,
    1e7,
    1e9,
    1e12,
    1e15,
    1e16,
    1e150,
    1e300,
    f64::MAX,
    f64::INFINITY,
    f64::NAN,
];

/// Numbers out of bytes, and out of a seed when there are no more.
#[derive(Clone, Debug)]
pub struct Dice<'a> {
    bytes: &'a [u8],
    state: u64,
}

impl<'a> Dice<'a> {
    /// Numbers out of a text, and when that is over out of its sum.
    #[must_use]
    pub fn of_bytes(bytes: &'a [u8]) -> Self {
        let state = bytes.iter().fold(0, |sum: u64, &byte| {
            sum.wrapping_mul(257).wrapping_add(byte.into())
        });
        Self { bytes, state }
    }

    /// Numbers out of a seed.
    #[must_use]
    pub fn of_seed(seed: u64) -> Self {
        Self {
            bytes: &[],
            state: seed.wrapping_mul(0x2545_f491_4f6c_dd1d),
        }
    }

    fn bits(&mut self) -> u64 {
        if let Some((first, rest)) = self.bytes.split_first_chunk::<8>() {
            self.bytes = rest;
            return u64::from_le_bytes(*first);
        }
        // SplitMix64.
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    #[allow(clippy::cast_precision_loss, reason = "53 bits fit")]
    fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.bits() >> 8).unwrap_or(0) % count
    }

    fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        (least.ln() + self.share() * (most / least).ln()).exp()
    }

    /// A positive number about the usual ones, or an edge once in so many times.
    fn size(&mut self, least: f64, most: f64, edges: usize) -> f64 {
        if self.one_in(edges) {
            EDGES[self.below(EDGES.len())]
        } else {
            self.between(least, most)
        }
    }

    fn signed(&mut self, least: f64, most: f64, edges: usize) -> f64 {
        let size = self.size(least, most, edges);
        if self.one_in(2) { size } else { -size }
    }
}

/// What came of one draw.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Plans that were judged.
    pub judged: u64,
    /// What constructors and planners refused.
    pub refused: u64,
    /// How long the motions last together that were judged, s.
    pub lasting: f64,
}

/// Longest path at its feedrates that `optimal` plans, s.
const LONGEST: f64 = 60.0;

/// How long a path takes at its feedrates, s.
fn at_feedrate<const N: usize>(path: &Toolpath<N>) -> f64 {
    let mut at = path.start();
    path.moves().iter().fold(0.0, |time, step| {
        let length = step.length(at);
        at = step.end(at);
        time + length / step.feedrate().speed()
    })
}

/// Draws limits and a path in one to three axes, plans them by every planner whose name is wanted, and has each
/// plan judged.
///
/// # Panics
/// When a planner panics or does not end, or the judge finds something.
#[must_use]
pub fn try_all(dice: &mut Dice<'_>, wanted: &dyn Fn(&str) -> bool) -> Tally {
    match dice.below(6) {
        0 => try_axes::<1>(dice, wanted),
        1..=3 => try_axes::<2>(dice, wanted),
        _ => try_axes::<3>(dice, wanted),
    }
}

fn try_axes<const N: usize>(dice: &mut Dice<'_>, wanted: &dyn Fn(&str) -> bool) -> Tally {
    let mut tally = Tally::default();
    // Half of all draws have edges in every kind of number, the others in one or none.
    let edges = if dice.one_in(2) { 12 } else { 400 };
    let Some(limits) = limits::<N>(dice, edges, &mut tally) else {
        return tally;
    };
    let Some(path) = path::<N>(dice, edges, &mut tally) else {
        return tally;
    };
    let mut planned = |name: &str, planner: &mut dyn MotionPlanner<N>| {
        if !wanted(name) {
            return;
        }
        let outcome = judged(&path, &limits, planner);
        match outcome {
            Ok(report) => {
                tally.judged += 1;
                tally.lasting += report.cycle_time;
                assert!(
                    report.passes(),
                    "{name}: {} violations, {:#?}\n{limits:?}\n{path:?}",
                    report.violations,
                    report.examples
                );
            }
            Err(_) => tally.refused += 1,
        }
    };
    let window = [1, 2, 5, 512][dice.below(4)];
    for method in Method::ALL {
        let settings = Settings::new(limits)
            .with_method(method)
            .with_window(window);
        let mut planner = KinematicSmoothing::new(path.start(), &settings);
        planned(method.name(), &mut planner);
    }
    planned("bezier", &mut BezierSmoothing::new(path.start(), limits));
    let lengths: Vec<f64> = (0..=dice.below(3))
        .map(|_| dice.size(1e-4, 0.2, edges))
        .collect();
    let chain = FilterChain::with_time_constants(&lengths);
    for method in toolglide_fir::Method::ALL {
        let settings = toolglide_fir::Settings::new(limits).with_method(method);
        let mut planner = FirInterpolation::new(path.start(), &settings);
        planned(method.name(), &mut planner);
        if let Ok(settings) = chain.clone().and_then(|chain| settings.with_chain(&chain)) {
            let mut planner = FirInterpolation::new(path.start(), &settings);
            planned(method.name(), &mut planner);
        }
    }
    // What `optimal` may spend grows with the motion: hours of it would take an hour.
    if dice.one_in(4) && at_feedrate(&path) <= LONGEST {
        let settings = toolglide_optimal::Settings::new(limits);
        planned("optimal", &mut TimeOptimal::new(path.start(), &settings));
    }
    tally
}

/// The motion of a path by a planner, judged piece by piece.
fn judged<const N: usize>(
    path: &Toolpath<N>,
    limits: &Limits<N>,
    planner: &mut dyn MotionPlanner<N>,
) -> Result<Report<N>, PlanError> {
    let mut judge = Judge::new(path.start(), *limits);
    let mut pieces = 0;
    for step in path.moves() {
        judge.expect(step).unwrap();
    }
    let mut pull = |planner: &mut dyn MotionPlanner<N>| {
        while let Some(piece) = planner.pull() {
            judge.observe(&piece);
            pieces += 1;
            assert!(
                pieces < MAX_PIECES,
                "{pieces} pieces, and no end\n{limits:?}\n{path:?}"
            );
        }
    };
    for step in path.moves() {
        planner.push(step)?;
        pull(planner);
    }
    planner.finish()?;
    pull(planner);
    Ok(judge.finish())
}

/// What a constructor gives, or one refusal more.
fn taken<T, E: Debug>(made: Result<T, E>, tally: &mut Tally) -> Option<T> {
    match made {
        Ok(made) => Some(made),
        Err(_) => {
            tally.refused += 1;
            None
        }
    }
}

fn limits<const N: usize>(
    dice: &mut Dice<'_>,
    edges: usize,
    tally: &mut Tally,
) -> Option<Limits<N>> {
    let mut axes = [None; N];
    for axis in &mut axes {
        let wide = dice.one_in(4);
        let (least, most) = if wide { (1e-3, 1e4) } else { (0.5, 20.0) };
        let velocity = 100.0 * dice.size(least, most, edges);
        let acceleration = 1e3 * dice.size(least, most, edges);
        let jerk = 1e5 * dice.size(least, most, edges);
        *axis = taken(AxisLimits::new(velocity, acceleration, jerk), tally);
    }
    let mut all = axes.into_iter().flatten();
    let first = all.next()?;
    // Where one was refused, its neighbour stands in for it.
    let mut last = first;
    let mut all = std::iter::once(first).chain(all);
    Some(Limits::new(std::array::from_fn(|_| {
        last = all.next().unwrap_or(last);
        last
    })))
}

fn path<const N: usize>(
    dice: &mut Dice<'_>,
    edges: usize,
    tally: &mut Tally,
) -> Option<Toolpath<N>> {
    let far = if dice.one_in(2) { 1.0 } else { 1e6 };
    let start = Vector::<N>::from_fn(|_, _| far * dice.signed(1e-2, 1.0, edges));
    let mut path = taken(Toolpath::starting_at(start), tally)?;
    let reach = dice.between(1e-3, 1e2);
    let most = if dice.one_in(8) { 40 } else { 10 };
    let count = 1 + dice.below(most);
    for line in 1..=count {
        let tolerance = taken(Tolerance::new(dice.size(1e-4, 0.5, edges)), tally);
        let tolerance = tolerance.unwrap_or(Tolerance::new(0.01).unwrap());
        let feedrate = if dice.one_in(8) {
            Feedrate::RAPID
        } else {
            let feedrate = Feedrate::new(dice.size(0.1, 1e3, edges));
            taken(feedrate, tally).unwrap_or(Feedrate::RAPID)
        };
        let Some(step) = taken(
            step(dice, path.end(), reach, edges, feedrate, tolerance),
            tally,
        ) else {
            continue;
        };
        let step = if dice.one_in(8) {
            step.with_exact_stop()
        } else {
            step
        };
        let _ = taken(
            path.push(step.from_line(u32::try_from(line).unwrap_or(0))),
            tally,
        );
    }
    Some(path)
}

fn step<const N: usize>(
    dice: &mut Dice<'_>,
    at: Vector<N>,
    reach: f64,
    edges: usize,
    feedrate: Feedrate,
    tolerance: Tolerance,
) -> Result<Move<N>, toolglide_kinematics::ToolpathError> {
    let near = |dice: &mut Dice<'_>| {
        let reach = if dice.one_in(6) { 1e-4 * reach } else { reach };
        at + Vector::from_fn(|_, _| dice.signed(0.1 * reach, reach, edges))
    };
    match dice.below(10) {
        0 => Move::dwell(dice.size(1e-3, 0.2, edges.min(40)), tolerance),
        // To where it is, or to one edge of what there is.
        1 => {
            let mut end = at;
            if dice.one_in(2) {
                end[dice.below(N)] = dice.signed(1e-12, 1e-6, 2);
            }
            Move::line_to(end, feedrate, tolerance)
        }
        2 => {
            let axis = dice.below(N);
            let mut end = at;
            end[axis] += dice.signed(1e-12, reach, edges);
            Move::line_to(end, feedrate, tolerance)
        }
        3..=5 if N > 1 => {
            let first = dice.below(N);
            let plane = [first, (first + 1 + dice.below(N - 1)) % N];
            let radius = dice.size(0.05 * reach, reach, edges);
            let (from, sweep) = (TAU * dice.share(), dice.between(1e-3, 1.0));
            let whole = dice.one_in(4);
            let outward = |angle: f64| {
                let mut way = Vector::<N>::zeros();
                way[plane[0]] = radius * angle.cos();
                way[plane[1]] = radius * angle.sin();
                way
            };
            let center = at - outward(from);
            let turned = dice.one_in(2);
            let mut end = at;
            if !whole {
                let angle = if turned { TAU * sweep } else { -TAU * sweep };
                end = center + outward(from + angle);
            }
            if let Some(axis) = (0..N).find(|axis| !plane.contains(axis))
                && dice.one_in(3)
            {
                end[axis] += dice.signed(0.01 * reach, reach, edges);
            }
            let turns = [0, 0, 0, 1, 5][dice.below(5)];
            let arc = Arc::about(at, end, center, plane, turned, turns)?;
            // Work goes with the chords, and so would the time of a draw.
            let chords = arc.sweep().abs() * (arc.bending() / (8.0 * tolerance.length())).sqrt();
            let tolerance = if chords > MAX_CHORDS {
                Tolerance::new(1e-6 * arc.bending().max(1.0))?
            } else {
                tolerance
            };
            Ok(Move::arc(arc, feedrate, tolerance))
        }
        _ => Move::line_to(near(dice), feedrate, tolerance),
    }
}

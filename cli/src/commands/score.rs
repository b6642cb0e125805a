//! Scores methods against the time-optimal motion.
//!
//! The program is read once and sampled; every window is planned by every method and judged, and
//! each section of it between stops has its optimum. Not here: what the optimum is.

use crate::commands::plan::{moves, title, warn};
use crate::error::CliError;
use crate::input::args::ScoreArgs;
use crate::input::setup::Setup;
use crate::input::source::Source;
use crate::input::travel::{OnAxes, by_axes};
use crate::methods::{Tuning, chosen, planner};
use crate::output::output_files::Drawing;
use crate::output::progress::Steps;
use crate::output::report::show;
use crate::output::score_report::{Loss, MethodStanding, Sample, Standing, Sums};
use crate::plot::{Caption, Contrast};
use std::io::Write;
use toolglide_kinematics::{Limits, Move, Plan, Toolpath, Trajectory};
use toolglide_reference::{Course, Section, Settings, Window, Windows, certify, hold, part};
use toolglide_reference::{Score, Sections};
use toolglide_verify::verify;

/// Programs that a certificate may take: it closes the gap of most corners to a thousandth.
const CERTIFICATE: usize = 200;

/// Legs of a section beyond which its optimum takes too long.
const MAX_LEGS: usize = 600;

/// Runs the command.
pub(crate) fn score(
    args: &ScoreArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let setup = Setup::new(&args.job, None)?;
    by_axes!(setup.axes.len(), run(args, &setup, out, err))
}

fn run<const N: usize>(
    args: &ScoreArgs,
    setup: &Setup,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError>
where
    Move<N>: OnAxes,
{
    let drawing = Drawing::begin(args.plot.as_deref(), &args.job)?;
    let source = Source::open(&args.job.program, args.job.dialect.as_deref())?;
    let name = source.name.clone();
    let limits = setup.limits::<N>();
    let mut windows = Windows::new(setup.start::<N>(), limits);
    let mut moves = moves::<N>(&args.job, setup, source)?;
    while let Some(next) = moves.next()? {
        windows.push(&next).map_err(|reason| CliError::Plan {
            program: name.clone(),
            line: next.line(),
            reason,
        })?;
    }
    warn(moves.program.program(), err);
    drop(moves);
    let sampled = windows.finish();
    let methods = chosen(&args.methods);
    let tuning = Tuning::of(&args.tuning, setup)?;
    let job = Scorer {
        tuning: &tuning,
        program: &name,
        limits,
        methods: &methods,
        settings: Settings::default().with_intervals(usize::from(args.intervals)),
        certify: args.certify,
    };
    let mut sums = job.nothing();
    let mut sample = Sample {
        whole: sampled.whole,
        legs_of_program: sampled.legs,
        ..Sample::default()
    };
    let mut contrast: Option<Contrast<N>> = None;
    let bar = Steps::new(sampled.windows.len() * (1 + 2 * methods.len()));
    for window in &sampled.windows {
        let Some((scored, seen)) = job.window(window, &setup.letters(), &bar)? else {
            sample.skipped += 1;
            continue;
        };
        sample.windows += 1;
        sample.legs += window.legs;
        add(&mut sums, scored);
        if contrast
            .as_ref()
            .is_none_or(|known| seen.sharpness() > known.sharpness())
        {
            contrast = Some(seen);
        }
    }
    drop(bar);
    let standing = Standing::new(&name, setup, sample, sums);
    if let (Some(mut drawing), Some(contrast)) = (drawing, contrast) {
        let caption = Caption {
            title: title(&name),
            subtitle: format!("the optimum beside {} on {}", methods[0], setup.machine),
        };
        drawing.write(&contrast.draw(&caption))?;
        drawing.commit()?;
    }
    show(&standing, args.job.json, out, err)
}

/// Adds what a window gave.
fn add(sums: &mut Sums, window: Sums) {
    sums.optimum += window.optimum;
    sums.lower_bound += window.lower_bound;
    sums.straight += window.straight;
    sums.certified &= window.certified;
    sums.losses.extend(window.losses);
    for (method, more) in sums.methods.iter_mut().zip(window.methods) {
        method.cycle_time_s += more.cycle_time_s;
        method.violations += more.violations;
        method.lower_bound_s = method
            .lower_bound_s
            .zip(more.lower_bound_s)
            .map(|(one, other)| one + other);
    }
}

/// What is scored, and how.
struct Scorer<'a, const N: usize> {
    program: &'a str,
    limits: Limits<N>,
    methods: &'a [String],
    tuning: &'a Tuning,
    settings: Settings,
    certify: bool,
}

impl<const N: usize> Scorer<'_, N> {
    fn nothing(&self) -> Sums {
        Sums {
            certified: self.certify,
            methods: self
                .methods
                .iter()
                .map(|name| MethodStanding::of(name))
                .collect(),
            ..Sums::default()
        }
    }

    /// Scores a window; `None` when it is too large, or its optimum was not found.
    fn window(
        &self,
        window: &Window<N>,
        letters: &[char],
        bar: &Steps,
    ) -> Result<Option<(Sums, Contrast<N>)>, CliError> {
        let sections = self.sections(window)?;
        let too_large = |section: &Section<N>| matches!(section, Section::Course(course) if course.legs() > MAX_LEGS);
        if sections.iter().any(too_large) {
            return Ok(None);
        }
        let path = self.path(window)?;
        let mut sums = self.nothing();
        let (mut plans, mut legal) = (Vec::new(), Vec::new());
        for (method, standing) in self.methods.iter().zip(&mut sums.methods) {
            let plan = self.plan(method, window)?;
            standing.cycle_time_s = plan.duration();
            standing.violations = verify(&plan, &path, &self.limits).violations;
            legal.push(standing.violations == 0);
            plans.push(plan);
            bar.step();
        }
        let names = ["optimum".to_owned(), self.methods[0].clone()];
        let mut contrast = Contrast::new(window.start, names, letters.to_vec());
        window.moves.iter().for_each(|next| contrast.expect(next));
        for section in &sections {
            match section {
                Section::Rest { duration, .. } => {
                    sums.optimum += duration;
                    sums.lower_bound += duration;
                    sums.straight += duration;
                    for method in &mut sums.methods {
                        method.lower_bound_s = method.lower_bound_s.map(|bound| bound + duration);
                    }
                }
                Section::Course(course) => {
                    let parts: Vec<_> = plans.iter().map(|plan| part(plan, course)).collect();
                    let watch = sections.len() == 1;
                    let mut step = || {
                        if watch {
                            bar.step();
                        }
                    };
                    let Ok(score) = hold(course, &parts, &legal, &self.settings, &mut step) else {
                        return Ok(None);
                    };
                    for piece in score.optimum.plan().pieces() {
                        contrast.observe(0, piece);
                    }
                    self.add_course(&mut sums, window, course, &score);
                }
            }
        }
        // A motion that does two things at once, as pausing for two moves, is in the parts of both.
        for (method, legal) in sums.methods.iter().zip(&legal) {
            if *legal {
                sums.optimum = sums.optimum.min(method.cycle_time_s);
            }
        }
        sums.lower_bound = sums.lower_bound.min(sums.optimum);
        for piece in plans[0].pieces() {
            contrast.observe(1, piece);
        }
        Ok(Some((sums, contrast)))
    }

    fn add_course(
        &self,
        sums: &mut Sums,
        window: &Window<N>,
        course: &Course<N>,
        score: &Score<N>,
    ) {
        let optimum = &score.optimum;
        let mut bound = optimum.lower_bound();
        if self.certify {
            // One leg has no shares of time; more than two have no certificate.
            match certify(course, optimum.duration(), CERTIFICATE) {
                Ok(proved) => bound = proved.lower_bound,
                Err(_) => sums.certified &= course.legs() == 1,
            }
        }
        sums.optimum += optimum.duration();
        sums.lower_bound += bound;
        sums.straight += score.straight_time;
        for (method, held) in sums.methods.iter_mut().zip(&score.motions) {
            method.lower_bound_s = method
                .lower_bound_s
                .zip(held.lower_bound)
                .map(|(one, other)| one + other);
        }
        let Some(first) = score.motions.first() else {
            return;
        };
        let mut last = None;
        for leg in 0..course.legs() {
            let served = course.move_of(leg);
            let (time, best) = (first.leg_times[leg], optimum.leg_times()[leg]);
            if last != Some(served) {
                sums.losses.push(Loss {
                    method: self.methods[0].clone(),
                    line: window.moves.get(served as usize).map_or(0, Move::line),
                    loss_s: 0.0,
                    time_s: 0.0,
                    optimum_s: 0.0,
                });
            }
            last = Some(served);
            if let Some(loss) = sums.losses.last_mut() {
                loss.time_s += time;
                loss.optimum_s += best;
                loss.loss_s = loss.time_s - loss.optimum_s;
            }
        }
    }

    fn refuse(&self, next: &Move<N>, reason: toolglide_kinematics::PlanError) -> CliError {
        CliError::Plan {
            program: self.program.to_owned(),
            line: next.line(),
            reason,
        }
    }

    fn sections(&self, window: &Window<N>) -> Result<Vec<Section<N>>, CliError> {
        let mut sections = Sections::new(window.start, self.limits);
        let mut found = Vec::new();
        for next in &window.moves {
            let done = sections
                .push(next)
                .map_err(|reason| self.refuse(next, reason))?;
            found.extend(done.into_iter().flatten());
        }
        found.extend(sections.cut());
        Ok(found)
    }

    fn path(&self, window: &Window<N>) -> Result<Toolpath<N>, CliError> {
        let refuse = |line, reason: toolglide_kinematics::ToolpathError| CliError::Line {
            program: self.program.to_owned(),
            line,
            reason: reason.to_string(),
        };
        let mut path = Toolpath::starting_at(window.start).map_err(|reason| refuse(0, reason))?;
        for next in &window.moves {
            path.push(*next)
                .map_err(|reason| refuse(next.line(), reason))?;
        }
        Ok(path)
    }

    fn plan(&self, method: &str, window: &Window<N>) -> Result<Plan<N>, CliError> {
        let mut planner = planner(method, window.start, self.limits, self.tuning)?;
        let mut plan = Plan::starting_at(window.start);
        for next in &window.moves {
            planner
                .push(next)
                .map_err(|reason| self.refuse(next, reason))?;
            plan.extend(std::iter::from_fn(|| planner.pull()));
        }
        planner.finish().map_err(|reason| CliError::Plan {
            program: self.program.to_owned(),
            line: window.moves.last().map_or(0, Move::line),
            reason,
        })?;
        plan.extend(std::iter::from_fn(|| planner.pull()));
        Ok(plan)
    }
}

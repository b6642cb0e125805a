//! Simulates planner, executor and operator tick by tick.

use super::events::{Command, Event};
use super::responses::{Response, Responses};
use super::rows::Rows;
use crate::error::CliError;
use crate::input::travel::OnAxes;
use crate::pipeline::{Lane, Moves};
use crate::plot::ExecutedPlot;
use std::collections::VecDeque;
use std::io::BufRead;
use std::time::Duration;
use toolglide_kinematics::{Feedrate, Move, Piece, Vector};
use toolglide_program::AxisMoves;
use toolglide_realtime::{Activity, Executor, Terms, Tick};
use toolglide_verify::{ExecutedJudge, Report};

/// Planned time that the planner stays ahead of what the executor needs, s.
const AHEAD: f64 = 0.5;

/// Moves that are planned at once at most.
const BATCH: usize = 16;

/// A motion that stands for so long with nothing to come has ended, s.
const ENDED: f64 = 0.5;

/// Lines of moves that are remembered.
const LINES: usize = 1 << 16;

/// Planned time of the past that can be gone back to, and is remembered for the judge, s.
const PAST: f64 = 100.0;

/// Everything that takes part.
pub(crate) struct Simulation<'a, R, const N: usize> {
    moves: Moves<R, N>,
    lane: Lane<N>,
    executor: Executor<N>,
    judge: ExecutedJudge<N>,
    rows: Rows<'a>,
    plot: Option<ExecutedPlot<N>>,
    events: VecDeque<Event>,
    greatest: f64,
    period: f64,
    ready: VecDeque<Piece<N>>,
    /// Feedrate and line of each move, and the number of the first.
    known: VecDeque<(f64, u32)>,
    first: u32,
    read: u64,
    over: bool,
    aborted: bool,
}

/// What came out.
pub(crate) struct Outcome<R, const N: usize> {
    pub(crate) program: AxisMoves<R>,
    pub(crate) report: Report<N>,
    pub(crate) planning_time: Duration,
    pub(crate) plot: Option<ExecutedPlot<N>>,
    pub(crate) responses: Vec<Response>,
    pub(crate) rows: u64,
    pub(crate) peaks: [f64; 3],
    pub(crate) off_path: f64,
    pub(crate) infeasible: u64,
    pub(crate) duration: f64,
    pub(crate) first_piece: u64,
    pub(crate) first_motion: u64,
    pub(crate) needs: f64,
    pub(crate) stops_within: f64,
    pub(crate) end: Vector<N>,
    pub(crate) end_line: u32,
    pub(crate) state: Activity,
    pub(crate) cut_short: bool,
}

impl<'a, R: BufRead, const N: usize> Simulation<'a, R, N>
where
    Move<N>: OnAxes,
{
    #[allow(clippy::too_many_arguments, reason = "each takes part once")]
    pub(crate) fn new(
        moves: Moves<R, N>,
        lane: Lane<N>,
        executor: Executor<N>,
        judge: ExecutedJudge<N>,
        rows: Rows<'a>,
        plot: Option<ExecutedPlot<N>>,
        events: Vec<Event>,
        greatest: f64,
        period: f64,
    ) -> Self {
        Self {
            moves,
            lane,
            executor,
            judge,
            rows,
            plot,
            events: events.into(),
            greatest,
            period,
            ready: VecDeque::new(),
            known: VecDeque::new(),
            first: 0,
            read: 0,
            over: false,
            aborted: false,
        }
    }

    /// Runs the program until the motion has ended.
    #[allow(clippy::cast_precision_loss, reason = "ticks stay below 2^53")]
    pub(crate) fn run(mut self) -> Result<Outcome<R, N>, CliError> {
        let mut responses = Responses::default();
        let (mut tick, mut silent_until, mut standing) = (0_u64, 0.0_f64, 0.0_f64);
        let (mut first_piece, mut first_motion) = (0, 0);
        let mut off_path = 0.0_f64;
        let mut last: Option<Tick<N>> = None;
        let stops_within = self.executor.law_stops_within();
        let mut cut_short = false;
        loop {
            let time = tick as f64 * self.period;
            if time >= silent_until && !cut_short && !self.aborted {
                self.plan_ahead()?;
            }
            if first_piece == 0 && self.executor.in_hand() > 0.0 {
                first_piece = self.read;
            }
            while let Some(event) = self.events.front().copied()
                && event.time <= time + 1e-9
            {
                self.events.pop_front();
                let speed = last.map_or(0.0, |tick| tick.sample.velocity.norm());
                let line = last.map_or(0, |tick| self.line(tick.serves.last));
                responses.begin(&event, speed, self.executor.stops_within(), line);
                if let Some(plot) = &mut self.plot {
                    plot.mark(time, &event.command.text());
                }
                self.apply(event.command, &mut silent_until, time);
            }
            let planned = self.judge.planned();
            let at = self.executor.tick();
            let way = last.map_or(0.0, |last| {
                (at.sample.position - last.sample.position).norm()
            });
            if last.is_some() {
                responses.observe(&at, self.executor.time_laws(), self.period, way);
            }
            if !cut_short && let Some(place) = self.judge.place(planned) {
                off_path = off_path.max((place - at.sample.position).amax());
            }
            for law in self.executor.time_laws() {
                self.judge.observe(&law);
            }
            self.judge.forget(self.judge.planned() - PAST);
            self.rows.observe(tick, &at)?;
            let commanded = self.commanded(&at);
            if let Some(plot) = &mut self.plot {
                plot.observe(time, self.period, &at, commanded);
            }
            if first_motion == 0 && at.rate.abs() > 0.0 {
                first_motion = self.read;
            }
            cut_short |= at.activity == Activity::Aborted;
            let stands = at.rate.abs() <= 0.0;
            standing = if stands { standing + self.period } else { 0.0 };
            last = Some(at);
            let all = self.over && self.ready.is_empty();
            if self.events.is_empty() && stands {
                let ended = at.activity == Activity::Idle && all;
                let waits = time >= silent_until && standing > ENDED;
                if ended || cut_short || waits {
                    break;
                }
            }
            tick += 1;
        }
        let at = last.unwrap_or_else(|| self.executor.tick());
        let end_line = self.line(at.serves.last);
        let all = self.over && self.ready.is_empty() && self.executor.in_hand() <= 0.0;
        let (report, planning_time) = self.lane.finish();
        Ok(Outcome {
            program: self.moves.program,
            report,
            planning_time,
            plot: self.plot,
            responses: responses.finish(),
            rows: self.rows.finish()?,
            peaks: self.judge.worst,
            off_path,
            infeasible: self.executor.infeasible_steps(),
            duration: tick as f64 * self.period,
            first_piece,
            first_motion,
            needs: self.executor.needs_in_hand(),
            stops_within,
            end: at.sample.position,
            end_line,
            state: at.activity,
            cut_short: !all,
        })
    }

    /// Gives the planner time until enough is in hand.
    fn plan_ahead(&mut self) -> Result<(), CliError> {
        let wanted = self.executor.needs_in_hand() + AHEAD;
        loop {
            while self.executor.room() > 0
                && self.executor.in_hand() < wanted
                && let Some(piece) = self.ready.pop_front()
            {
                let terms = self.terms(&piece);
                self.judge.expect(&piece);
                self.executor
                    .feed(&piece, terms)
                    .map_err(|reason| CliError::Line {
                        program: self.moves.name.clone(),
                        line: self.line(piece.serves().last),
                        reason: reason.to_string(),
                    })?;
            }
            if self.over || !self.ready.is_empty() || self.executor.in_hand() >= wanted {
                return Ok(());
            }
            self.read_on()?;
        }
    }

    /// Plans the next few moves.
    fn read_on(&mut self) -> Result<(), CliError> {
        let mut batch = Vec::with_capacity(BATCH);
        while batch.len() < BATCH && !self.over {
            let Some(next) = self.moves.next()? else {
                self.over = true;
                break;
            };
            self.read += 1;
            let feedrate = next.feedrate();
            self.known.push_back((feedrate.speed(), next.line()));
            if self.known.len() > LINES {
                self.known.pop_front();
                self.first += 1;
            }
            let faster = Feedrate::new(feedrate.speed() * self.greatest);
            batch.push(match faster {
                Ok(faster) if !feedrate.is_rapid() => next.at_feedrate(faster),
                _ => next,
            });
        }
        let ready = &mut self.ready;
        self.lane
            .run(&batch, self.over, &self.moves.name, |piece, _| {
                ready.push_back(*piece);
                Ok(())
            })
    }

    /// Feedrate and class of a piece: of the fastest move that it serves.
    fn terms(&self, piece: &Piece<N>) -> Terms {
        let serves = piece.serves();
        let feedrate = (serves.first..=serves.last)
            .filter_map(|block| self.known(block))
            .fold(0.0, |most: f64, known| most.max(known.0));
        if feedrate.is_infinite() || feedrate <= 0.0 {
            Terms::rapid()
        } else {
            Terms::feed(feedrate)
        }
    }

    fn known(&self, block: u32) -> Option<(f64, u32)> {
        let place = block.checked_sub(self.first)?;
        self.known.get(usize::try_from(place).ok()?).copied()
    }

    fn line(&self, block: u32) -> u32 {
        self.known(block).map_or(0, |known| known.1)
    }

    /// The feedrate that the program and the override ask for, mm/s; `None` for rapids.
    fn commanded(&self, at: &Tick<N>) -> Option<f64> {
        let feedrate = self.known(at.serves.last)?.0;
        let share = self.executor.feed_override();
        feedrate.is_finite().then_some(feedrate * share)
    }

    fn apply(&mut self, command: Command, silent_until: &mut f64, time: f64) {
        let commands = self.executor.command();
        match command {
            Command::Hold => commands.hold(),
            Command::Resume => commands.resume(),
            Command::Reverse => commands.reverse(),
            Command::Forward => commands.forward(),
            Command::StopAtBlockEnd => commands.stop_at_block_end(),
            Command::Abort => {
                commands.abort();
                self.aborted = true;
            }
            // Negative and infinite values were refused where they were read.
            Command::Feed(value) => drop(commands.feed(value)),
            Command::Rapid(value) => drop(commands.rapid(value)),
            Command::Silence(seconds) => *silent_until = silent_until.max(time + seconds),
        }
    }
}

//! Executes planned pieces tick by tick under the operator's commands, inside every limit.
//!
//! Source: ours. The geometry is the planned one: only the rate changes at which planned time passes. Not here: the laws
//! that choose it, in `decide`.

use crate::commands::Commands;
use crate::decide::Driver;
use crate::event::{Event, Events};
use crate::feeding::{FeedError, Feeding};
use crate::law::{Law, Rate};
use crate::motion::{MAX_STRETCHES, Stretch, executed, resting};
use crate::settings::{OverrideKind, Settings};
use crate::step::{Bounds, State};
use crate::terms::{Caps, Terms};
use crate::track::Track;
use toolglide_kinematics::{MoveRange, Piece, Sample, TimeLaw, Vector};

/// Steps of planned time that are kept in hand beyond the braking distance.
const SPARE_STEPS: f64 = 4.0;

/// What the executor does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// It rests where the known motion ends.
    Idle,
    /// It follows the plan at the override in force, or on the way to it.
    Running,
    /// It comes to rest after a hold or an abort.
    Holding,
    /// It rests after a hold.
    Held,
    /// It comes to rest, or rests, because the known motion ends at speed.
    Starved,
    /// It rests at the end of a block.
    AtBlockEnd,
    /// It rests after an abort; nothing is in hand.
    Aborted,
}

/// One tick of executed motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick<const N: usize> {
    /// Executed position, velocity, acceleration and jerk, mm and s.
    pub sample: Sample<N>,
    /// Planned time by time: 1 as planned, 0 at rest, negative backwards.
    pub rate: f64,
    /// The moves that are followed.
    pub serves: MoveRange,
    /// What the executor does.
    pub activity: Activity,
}

/// Executes planned pieces under commands.
///
/// [`Executor::feed`] takes pieces in order, [`Executor::tick`] gives the set-point of each tick, and
/// [`Executor::command`] takes what the operator wants, at any tick. Nothing is allocated after construction.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Limits, SamplePeriod, Vector};
/// use toolglide_realtime::{Activity, Executor, Settings};
/// let limits = Limits::<2>::uniform(500.0, 2_000.0, 5e4)?;
/// let settings = Settings::new(limits, SamplePeriod::new(0.001)?).with_fastest(100.0)?;
/// let mut executor = Executor::new(Vector::zeros(), &settings);
/// assert_eq!(executor.tick().activity, Activity::Idle, "nothing was fed yet");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Executor<const N: usize> {
    pub(crate) driver: Driver<N>,
    pub(crate) commands: Commands,
    pub(crate) feeding: Feeding<N>,
    pub(crate) events: Events,
    pub(crate) state: State,
    /// Whether the motion stands at a rest of the plan, where any rate may follow.
    pub(crate) free: bool,
    /// Where it stands while it is free.
    pub(crate) place: Vector<N>,
    pub(crate) activity: Activity,
    pub(crate) serves: MoveRange,
    /// Whether the moves served were told.
    pub(crate) noted: bool,
    pub(crate) starved: bool,
    /// The rate that is constant since the anchor.
    pub(crate) steady: Option<f64>,
    stretches: [Stretch; MAX_STRETCHES],
    count: usize,
    /// Ticks of a step, and those of the present one that are done.
    ticks: u32,
    done: u32,
    period: f64,
    /// Ticks in all, and where the present constant rate began: tick, planned time.
    now: u64,
    anchor: (u64, f64),
    /// Planned time at which the motion is to stop at the end of a block.
    pub(crate) goal: Option<f64>,
    /// The last piece that was looked at for it.
    pub(crate) looked: u64,
    /// Whether the stored way leads to it, and how many ways were tried.
    pub(crate) approaching: bool,
    pub(crate) tried: u32,
}

impl<const N: usize> Executor<N> {
    /// An executor at rest at a point. This is the only place that allocates.
    #[must_use]
    pub fn new(at: Vector<N>, settings: &Settings<N>) -> Self {
        let (a, j) = (settings.limits.acceleration(), settings.limits.jerk());
        let bounds = Bounds {
            acceleration: (*a).into(),
            jerk: (*j).into(),
            step: settings.step(),
        };
        let law = Law::new(settings.ratios(), settings.reserve.rho(), settings.step());
        let still = (settings.fastest.into(), bounds.acceleration);
        let track = Track::new(at, settings.ahead, settings.behind, still);
        let caps = Caps {
            feed: 1.0,
            rapid: 1.0,
            top: settings.greatest,
            uniform: settings.kind == OverrideKind::Uniform,
        };
        let state = State {
            at: 0,
            tau: 0.0,
            rate: Rate { r: 0.0, s: 0.0 },
        };
        let stretch = Stretch {
            begin: 0.0,
            state,
            u: 0.0,
        };
        Self {
            driver: Driver::new(track, bounds, law, caps, settings.patience),
            commands: Commands::new(caps),
            feeding: Feeding::new(at, settings),
            events: Events::new(),
            state,
            free: true,
            place: at,
            activity: Activity::Idle,
            serves: MoveRange::one(0),
            noted: false,
            starved: false,
            steady: None,
            stretches: [stretch; MAX_STRETCHES],
            count: 0,
            ticks: settings.ticks,
            done: settings.ticks,
            period: settings.period.seconds(),
            now: 0,
            anchor: (0, 0.0),
            goal: None,
            looked: 0,
            approaching: false,
            tried: 0,
        }
    }

    /// Takes the piece that follows.
    ///
    /// # Errors
    /// [`FeedError`] for one that does not follow, breaks the limits of the plan, or finds no room; nothing has
    /// changed then.
    pub fn feed(&mut self, piece: &Piece<N>, terms: Terms) -> Result<(), FeedError> {
        if self.commands.is_aborted() {
            return Err(FeedError::Aborted);
        }
        if self.room() == 0 {
            return Err(FeedError::Full);
        }
        self.feeding.check(piece)?;
        self.driver.track.push(piece, terms);
        Ok(())
    }

    /// How many pieces may be fed now.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "at most the length of the ring"
    )]
    pub fn room(&self) -> usize {
        self.driver.track.room(self.state.at) as usize
    }

    /// Planned time ahead of the motion, s.
    #[must_use]
    pub fn in_hand(&self) -> f64 {
        (self.driver.track.end() - self.state.tau).max(0.0)
    }

    /// Planned time that must be in hand for full rate, s, unless it ends at rest: the motion stops in time when no
    /// more comes.
    #[must_use]
    pub fn needs_in_hand(&self) -> f64 {
        self.driver.law.uses_from(1.0) + SPARE_STEPS * self.driver.bounds.step
    }

    /// Longest time in which a hold that is commanded now is over, s; infinite without a reserve.
    #[must_use]
    pub fn stops_within(&self) -> f64 {
        self.driver.promise() * self.driver.bounds.step
    }

    /// Longest time in which any hold is over, s, but for the time to settle, which is about the largest acceleration
    /// by jerk.
    #[must_use]
    pub fn law_stops_within(&self) -> f64 {
        self.driver.law.steps_from(1.0) * self.driver.bounds.step
    }

    /// The feed override in force.
    #[must_use]
    pub fn feed_override(&self) -> f64 {
        self.commands.caps().feed
    }

    /// What the operator wants.
    pub fn command(&mut self) -> &mut Commands {
        &mut self.commands
    }

    /// The oldest event that was not asked for yet; the last 256 are kept.
    pub fn event(&mut self) -> Option<Event> {
        self.events.pop()
    }

    /// How planned time passes from the tick given last to the end of the present step.
    pub fn time_laws(&self) -> impl Iterator<Item = TimeLaw> + '_ {
        let step = self.driver.bounds.step;
        (0..self.count).map(move |index| {
            let end = if index + 1 < self.count {
                self.stretches[index + 1].begin
            } else {
                step
            };
            self.stretches[index].law(end)
        })
    }

    /// Steps in which no change of rate kept the limits: 0, unless a piece broke the limits of the plan.
    #[must_use]
    pub fn infeasible_steps(&self) -> u64 {
        self.driver.infeasible
    }

    /// The set-point of the next tick. It never blocks and never allocates.
    pub fn tick(&mut self) -> Tick<N> {
        let out = self.sample();
        if self.done >= self.ticks {
            self.plan_step();
            self.done = 0;
        }
        self.done += 1;
        self.now += 1;
        out
    }

    /// The motion at the present tick.
    fn sample(&self) -> Tick<N> {
        let (sample, rate) = if self.done >= self.ticks {
            self.at_end_of_step()
        } else {
            self.within_step()
        };
        Tick {
            sample,
            rate,
            serves: self.serves,
            activity: self.activity,
        }
    }

    fn at_end_of_step(&self) -> (Sample<N>, f64) {
        let rate = self.state.rate;
        if self.free && rate.r.abs() <= 0.0 {
            return (resting(self.place), 0.0);
        }
        let track = &self.driver.track;
        (
            executed(track, self.state.at, self.state.tau, rate, 0.0),
            rate.r,
        )
    }

    fn within_step(&self) -> (Sample<N>, f64) {
        let t = f64::from(self.done) * self.period;
        let reached = |stretch: &&Stretch| stretch.begin <= t;
        let Some(stretch) = self.stretches[..self.count].iter().rfind(reached) else {
            return (resting(self.place), 0.0);
        };
        let mut at = stretch.at(t);
        if stretch.begin <= 0.0 && stretch.u.abs() <= 0.0 && stretch.state.rate.s.abs() <= 0.0 {
            at.tau = self.anchored(self.now, stretch.state.rate.r);
        }
        if at.rate.r.abs() <= 0.0 && self.free {
            return (resting(self.place), 0.0);
        }
        (
            executed(&self.driver.track, at.at, at.tau, at.rate, stretch.u),
            at.rate.r,
        )
    }

    /// Planned time at a tick since the rate is constant.
    #[allow(clippy::cast_precision_loss, reason = "ticks stay below 2^53")]
    fn anchored(&self, tick: u64, rate: f64) -> f64 {
        let (begin, tau) = self.anchor;
        tau + rate * ((tick - begin) as f64 * self.period)
    }

    /// Decides the motion up to the next step.
    fn plan_step(&mut self) {
        let step = self.driver.bounds.step;
        self.count = 0;
        let mut begin = 0.0;
        let before = self.state;
        while begin < step && self.count + 1 < MAX_STRETCHES {
            begin += if self.stands() {
                self.pass_rest(begin)
            } else if begin > 0.0 {
                self.leave_rest(begin)
            } else {
                self.decide()
            };
        }
        if begin < step {
            // More rests than stretches: it waits at the last one.
            self.stand(begin, step - begin);
        }
        self.note_blocks(before);
        self.finish_step();
    }

    /// Whether the motion is at a rest of the plan that lasts, or at the end of what is known.
    fn stands(&self) -> bool {
        let track = &self.driver.track;
        if self.free || track.is_empty() {
            return true;
        }
        if !track.get(self.state.at).rests || !self.in_dwell() {
            return false;
        }
        // At full rate nothing changes at either end of a dwell.
        let full = self.state.rate.s.abs() <= 0.0 && (self.state.rate.r.abs() - 1.0).abs() <= 0.0;
        !(full && self.goes_on_at_full_rate())
    }

    /// Whether the commands ask for the planned motion in the present direction.
    fn goes_on_at_full_rate(&self) -> bool {
        let commands = &self.commands;
        !commands.is_held()
            && commands.caps().open()
            && commands.direction() * self.state.rate.r > 0.0
            && !commands.stops_at_block_end()
    }

    fn in_dwell(&self) -> bool {
        let entry = self.driver.track.get(self.state.at);
        (entry.begin..=entry.end).contains(&self.state.tau)
    }

    pub(crate) fn put(&mut self, begin: f64, u: f64) {
        self.stretches[self.count] = Stretch {
            begin,
            state: self.state,
            u,
        };
        self.count += 1;
    }

    /// Decides one step of motion; gives the time until the next rest or the end of the step.
    pub(crate) fn decide(&mut self) -> f64 {
        let mut aim = self.aim();
        self.approach_goal(&mut aim);
        let x = self.state;
        let (u, reached) = self.driver.step(x, &aim);
        let constant = u.abs() <= 0.0 && x.rate.s.abs() <= 0.0;
        if !constant {
            self.steady = None;
        } else if self
            .steady
            .is_none_or(|rate| rate.to_bits() != x.rate.r.to_bits())
        {
            self.steady = Some(x.rate.r);
            self.anchor = (self.now, x.tau);
        }
        self.put(0.0, u);
        self.state = reached.state;
        if reached.rest {
            self.come_to_rest();
        } else if constant {
            self.state.tau = self.anchored(self.now + u64::from(self.ticks), x.rate.r);
            self.state.at = self.driver.track.seek(self.state.at, self.state.tau);
        }
        reached.took
    }
}

//! Passes the rests of the plan: dwells, starts, ends, and places where nothing more is known.
//!
//! Source: ours. Where the plan rests the rate is free and may jump. In a dwell planned time passes as time does, whatever
//! the override; a hold stops it, too. What a command asks for becomes the aim of a step here.

use crate::decide::Aim;
use crate::event::Event;
use crate::executor::{Activity, Executor};
use crate::law::Rate;
use crate::micro_move::micro_move;
use crate::step::State;
use toolglide_kinematics::Vector;

/// Steps of planned time within which a hold before the end of what is known begins.
const EARLY_STEPS: f64 = 3.0;

impl<const N: usize> Executor<N> {
    /// The aim of the next step.
    pub(crate) fn aim(&mut self) -> Aim {
        let caps = self.commands.caps();
        let direction = self.commands.direction();
        let terms = self.driver.track.get(self.state.at).terms;
        let (cap, top) = caps.of(&terms);
        let zero = top <= 0.0 || cap <= 0.0;
        self.look_for_block_end();
        let held = self.commands.is_held() || zero;
        self.starved = !held && self.starves(direction);
        let stop = held || self.starved;
        Aim {
            c: if stop { 0.0 } else { direction * top },
            promised: stop,
            caps: if zero { self.driver.proven } else { caps },
            follow: false,
        }
    }

    /// Whether the known motion is too short to go on.
    fn starves(&self, direction: f64) -> bool {
        let (track, law) = (&self.driver.track, &self.driver.law);
        let r = self.state.rate.r;
        let left = if direction > 0.0 {
            track.open_end() - self.state.tau
        } else {
            self.state.tau - track.open_begin()
        };
        if left.is_infinite() {
            return false;
        }
        let standing = self.starved || r.abs() <= 0.0;
        let need = if standing {
            self.needs_in_hand()
        } else {
            law.uses_from(r) + EARLY_STEPS * self.driver.bounds.step
        };
        left < need
    }

    /// Finds the place where a stop at the end of a block is possible: the end of the last piece that serves the block
    /// alone, as soon as it is known and far enough.
    fn look_for_block_end(&mut self) {
        if !self.commands.stops_at_block_end() || self.commands.direction() < 0.0 {
            self.goal = None;
            self.driver.track.limit(None);
            self.looked = self.state.at;
            return;
        }
        if self.goal.is_some() {
            return;
        }
        let x = self.state;
        self.looked = self.looked.max(x.at);
        let track = &self.driver.track;
        let (law, backup) = (&self.driver.law, &self.driver.backup);
        let spare = EARLY_STEPS * self.driver.bounds.step;
        // Where the law would stop from here, and from the end of the stored way.
        let least = (x.tau + law.uses_from(x.rate.r.abs().max(0.1)))
            .max(backup.tau + law.uses_from(backup.rate))
            + spare;
        while self.looked + 1 < track.next() {
            let (entry, after) = (track.get(self.looked), track.get(self.looked + 1));
            let serves = entry.piece.serves();
            let alone = serves.first == serves.last;
            if alone && after.piece.serves() != serves && entry.end >= least {
                self.goal = Some(entry.end);
                break;
            }
            self.looked += 1;
        }
        self.driver.track.limit(self.goal);
    }

    /// Goes the rest of the way to the end of a block from where the motion came to rest before it.
    pub(crate) fn approach_goal(&mut self, aim: &mut Aim) {
        let Some(goal) = self.goal else {
            return;
        };
        if self.commands.is_held() {
            return;
        }
        let x = self.state;
        if self.driver.backup.next().is_some() && self.approaching {
            aim.follow = true;
            return;
        }
        self.approaching = false;
        if x.rate.r.abs() > 0.0 || x.rate.s.abs() > 0.0 {
            return;
        }
        let left = goal - x.tau;
        if left < -1e-9 {
            self.goal = None;
            return;
        }
        if left <= 1e-9 {
            self.state.tau = goal;
            return;
        }
        let (bounds, track) = (&self.driver.bounds, &self.driver.track);
        if micro_move(bounds, track, &x, left, self.tried, &mut self.driver.backup) {
            self.approaching = true;
            self.tried = 0;
            aim.follow = true;
        } else {
            self.tried += 1;
        }
    }

    /// Whether the motion rests at the end of a block, as commanded.
    pub(crate) fn is_at_goal(&self) -> bool {
        self.goal.is_some_and(|goal| {
            (goal - self.state.tau).abs() <= 1e-9 && self.state.rate.r.abs() <= 0.0
        })
    }

    /// The way through a rest from a time of the step on; gives the time it takes.
    pub(crate) fn pass_rest(&mut self, begin: f64) -> f64 {
        let left = self.driver.bounds.step - begin;
        let aim = self.aim();
        self.steady = None;
        if self.driver.track.is_empty() || aim.c.abs() <= 0.0 {
            return self.stand(begin, left);
        }
        let forward = aim.c > 0.0;
        let track = &self.driver.track;
        // From the end of a piece on to the next one.
        if forward && self.state.tau >= track.get(self.state.at).end {
            if self.state.at + 1 >= track.next() {
                return self.stand(begin, left);
            }
            self.state.at += 1;
        } else if !forward && self.state.tau <= track.get(self.state.at).begin {
            if self.state.at <= track.first() {
                return self.stand(begin, left);
            }
            self.state.at -= 1;
        }
        if !self.driver.track.get(self.state.at).rests {
            return self.leave_rest(begin);
        }
        let full = (aim.c.abs() - 1.0).abs() <= 0.0;
        let x = State {
            rate: Rate { r: 0.0, s: 0.0 },
            ..self.state
        };
        if begin <= 0.0 && full && self.driver.start_rate(&x, &aim, 0.0) == Some(aim.c) {
            // At full rate nothing changes at either end of a dwell.
            self.free = false;
            self.state.rate = Rate { r: aim.c, s: 0.0 };
            return self.decide();
        }
        // A dwell, or what is left of one.
        let entry = self.driver.track.get(self.state.at);
        let way = if forward {
            entry.end - self.state.tau
        } else {
            self.state.tau - entry.begin
        };
        let (knot, place) = if forward {
            (entry.end, entry.piece.end())
        } else {
            (entry.begin, entry.piece.start())
        };
        self.free = false;
        self.state.rate = Rate {
            r: if forward { 1.0 } else { -1.0 },
            s: 0.0,
        };
        self.put(begin, 0.0);
        if way > left {
            self.state.tau += self.state.rate.r * left;
            self.driver.backup.settle_at(self.state.rate.r);
            return left;
        }
        self.state.tau = knot;
        self.rest_at(place);
        way
    }

    /// Leaves a rest at the rate that is wanted, at once; gives the time until the next rest or the end of the step.
    pub(crate) fn leave_rest(&mut self, begin: f64) -> f64 {
        let left = self.driver.bounds.step - begin;
        let aim = self.aim();
        let x = State {
            rate: Rate { r: 0.0, s: 0.0 },
            ..self.state
        };
        // A step that begins here is decided; what is left of one keeps the rate.
        let drift = if begin > 0.0 { left } else { 0.0 };
        let Some(rate) = self.driver.start_rate(&x, &aim, drift) else {
            return self.stand(begin, left);
        };
        self.free = false;
        self.state.rate = Rate { r: rate, s: 0.0 };
        if begin <= 0.0 {
            return self.decide();
        }
        self.put(begin, 0.0);
        let x = self.state;
        match self
            .driver
            .bounds
            .drift_for(&self.driver.track, &x, 0.0, left)
        {
            Some(reached) => {
                self.state = reached.state;
                if reached.rest {
                    self.come_to_rest();
                }
                reached.took
            }
            None => left,
        }
    }

    /// Stands still for the rest of the step.
    pub(crate) fn stand(&mut self, begin: f64, left: f64) -> f64 {
        if !self.free {
            let entry = self.driver.track.get(self.state.at);
            self.rest_at(entry.piece.position_at(self.state.tau - entry.begin));
        }
        self.state.rate = Rate { r: 0.0, s: 0.0 };
        self.driver.left = f64::INFINITY;
        self.driver.lawful = false;
        self.put(begin, 0.0);
        left
    }

    /// Rests at the rest of the plan that a step came to.
    pub(crate) fn come_to_rest(&mut self) {
        let entry = self.driver.track.get(self.state.at);
        let at_end = self.state.tau >= entry.end;
        let place = if at_end {
            entry.piece.end()
        } else {
            entry.piece.start()
        };
        self.rest_at(place);
    }

    fn rest_at(&mut self, place: Vector<N>) {
        self.free = true;
        self.place = place;
        self.state.rate = Rate { r: 0.0, s: 0.0 };
        self.driver.backup.settle_at(0.0);
        self.driver.lawful = false;
        self.approaching = false;
        self.steady = None;
    }

    /// Tells what the executor does now, with the events that belong to it.
    pub(crate) fn finish_step(&mut self) {
        let rate = self.state.rate;
        let standing = rate.r.abs() <= 0.0 && rate.s.abs() <= 0.0;
        let held = self.commands.is_held();
        let activity = if standing && self.commands.is_aborted() {
            Activity::Aborted
        } else if held {
            if standing {
                Activity::Held
            } else {
                Activity::Holding
            }
        } else if self.is_at_goal() {
            Activity::AtBlockEnd
        } else if self.is_over() {
            Activity::Idle
        } else if self.starved && self.goal.is_none() {
            Activity::Starved
        } else {
            Activity::Running
        };
        if activity == self.activity {
            return;
        }
        let block = self.serves.last;
        let before = core::mem::replace(&mut self.activity, activity);
        match activity {
            Activity::Held => self.events.push(Event::Held),
            Activity::Starved => self.events.push(Event::Starved),
            Activity::AtBlockEnd => self.events.push(Event::AtBlockEnd { block }),
            Activity::Aborted => {
                self.drop_all();
                self.events.push(Event::Aborted { block });
            }
            Activity::Running if before != Activity::Idle => self.events.push(Event::Resumed),
            _ => {}
        }
    }

    /// Whether the motion rests where everything known is executed.
    fn is_over(&self) -> bool {
        let track = &self.driver.track;
        track.is_empty()
            || (self.free
                && self.state.at + 1 >= track.next()
                && self.state.tau >= track.get(self.state.at).end)
    }

    /// Forgets every piece after an abort.
    fn drop_all(&mut self) {
        let track = &mut self.driver.track;
        if !self.free && !track.is_empty() {
            let entry = track.get(self.state.at);
            self.place = entry.piece.position_at(self.state.tau - entry.begin);
        }
        track.limit(None);
        track.clear();
        self.goal = None;
        self.state.at = track.next();
        self.state.tau = track.end();
        let place = self.place;
        self.rest_at(place);
        self.feeding.begin_at(place);
    }

    /// Tells which moves were entered and left between two places.
    pub(crate) fn note_blocks(&mut self, before: State) {
        if self.driver.track.is_empty() {
            return;
        }
        let reverse = self.state.at < before.at;
        let mut at = before.at;
        loop {
            self.note(self.driver.track.get(at).piece.serves(), reverse);
            if at == self.state.at {
                break;
            }
            at = if reverse { at - 1 } else { at + 1 };
        }
    }

    fn note(&mut self, serves: toolglide_kinematics::MoveRange, reverse: bool) {
        let before = self.serves;
        if before == serves && self.noted {
            return;
        }
        if self.noted {
            for block in before.first..=before.last {
                if block < serves.first || block > serves.last {
                    self.events.push(Event::Left { block, reverse });
                }
            }
        }
        for block in serves.first..=serves.last {
            if !self.noted || block < before.first || block > before.last {
                self.events.push(Event::Entered { block, reverse });
            }
        }
        self.noted = true;
        self.serves = serves;
    }
}

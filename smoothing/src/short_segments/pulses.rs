//! Plans legs as pulses behind two means: each is commanded in steps of speed, after a pause no longer than limits
//! and tolerance ask for.
//!
//! Source: section 4.2, in equal time steps. A pulse through two moving averages has a bound on acceleration and
//! jerk, and pulses may overlap as far as what comes of it is legal, which the judge of splines says of every leg
//! as soon as it is commanded. With the pause of a full stop it always is, so that the search ends. Not here: which
//! speed pulses are designed for.

use crate::segment::Segment;
use crate::short_segments::curve::{Control, Curve};
use crate::short_segments::feed_profile::Filter;
use crate::short_segments::spline::mean;
use crate::short_segments::{MAX_STEPS, ShortSegmentSmoother};
use toolglide_kinematics::{MoveRange, PathLimits, Vector};

/// Steps in the longer mean.
const TAPS: u8 = 8;

/// Control points that are a rest when they are equal.
const REST: usize = 3;

/// Share of a limit that is left for rounding.
const ROUNDING: f64 = 1.0 - 1e-6;

/// Times that a leg is slowed, and by what, where its pulse exceeds a limit by itself.
const SLOWINGS: usize = 8;
const SLOWER: f64 = 0.8;

/// Sine of half the turn up to which a lower speed is tried before a pause, and what is tried.
const SMOOTH: f64 = 0.216;
const SHARES: [f64; 5] = [0.9, 0.75, 0.6, 0.4, 0.2];

/// Commands, their first mean, and the filter.
#[derive(Clone, Debug)]
pub(super) struct Commands<const N: usize> {
    raw: Vec<Control<N>>,
    mid: Vec<(Vector<N>, f64)>,
    filter: Filter,
}

/// Where commands have come to: how many there are, and the time since the last of them.
#[derive(Clone, Copy, Debug)]
struct Mark {
    count: usize,
    since: f64,
}

/// How a leg is commanded.
#[derive(Clone, Copy, Debug)]
struct Pulse {
    index: usize,
    /// Speed at its ends, and the largest between.
    speed: f64,
    top: f64,
    /// Steps of rest before it.
    pause: usize,
}

impl<const N: usize> Commands<N> {
    pub(super) fn new() -> Self {
        Self {
            raw: Vec::with_capacity(MAX_STEPS + 8),
            mid: Vec::with_capacity(MAX_STEPS + 8),
            filter: Filter::sharp(0.0, 0.0),
        }
    }

    /// Begins at rest, with means through which steps of a speed are legal, when so many meet in one of them.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the count is bounded before it is cast"
    )]
    fn begin(&mut self, start: Control<N>, weakest: &PathLimits, speed: f64, changes: f64) {
        let product = changes * speed / weakest.jerk;
        let long = (speed / weakest.acceleration).max(product.sqrt());
        let step = long / f64::from(TAPS);
        let short = (product / long / step).ceil().clamp(1.0, f64::from(TAPS)) as usize;
        self.filter = Filter {
            taps: [usize::from(TAPS), short],
            ..Filter::sharp(step, 0.0)
        };
        self.mid.clear();
        self.raw.clear();
        self.raw.extend([start; REST]);
    }

    /// Largest speed of which a step is legal along a leg.
    #[allow(clippy::cast_precision_loss, reason = "counts are small")]
    fn largest_step(&self, leg: &Segment<N>, changes: f64) -> f64 {
        let Filter { step, taps, .. } = self.filter;
        let [long, short] = taps.map(|taps| taps as f64 * step);
        let limits = &leg.limits;
        limits
            .velocity
            .min(limits.acceleration * long)
            .min(limits.jerk * long * short / changes)
            * ROUNDING
    }

    /// Commands a leg after what has been commanded, and a rest behind it; where its commands end.
    fn command(&mut self, pulse: Pulse, mark: Mark, curve: &Curve<N>) -> Option<Mark> {
        let index = pulse.index;
        let step = self.filter.step;
        let leg = &curve.legs()[index];
        let (begin, end) = (curve.mark(index), curve.mark(index + 1));
        let course = Course::new(&pulse, leg.length, self.filter.long());
        let raw = &mut self.raw;
        raw.truncate(mark.count);
        let mut time = step;
        if pulse.pause == 0 {
            time -= mark.since;
        } else {
            // The leg before it ends with a whole step.
            let start = curve.control_at(begin, index);
            raw.extend(std::iter::repeat_n(start, pulse.pause));
        }
        while time < course.duration {
            if raw.len() >= MAX_STEPS {
                return None;
            }
            raw.push(curve.control_at(begin + course.along(time), index));
            time += step;
        }
        let next = Mark {
            count: raw.len(),
            since: (step - (time - course.duration)).clamp(0.0, step),
        };
        let rest = Control {
            leg: index,
            distance: end,
            point: leg.end,
            serves: leg.serves,
        };
        raw.extend(std::iter::repeat_n(rest, self.filter.settling() + REST));
        (raw.len() < MAX_STEPS).then_some(next)
    }
}

/// The distance along a leg against time: a step of speed, kept for the longer mean, a rise by such a step in such
/// a time, and the same backwards.
#[derive(Clone, Copy, Debug)]
struct Course {
    length: f64,
    duration: f64,
    speed: f64,
    hold: f64,
    rate: f64,
    rise: f64,
}

impl Course {
    fn new(pulse: &Pulse, length: f64, hold: f64) -> Self {
        let &Pulse { speed, top, .. } = pulse;
        let rate = speed / hold;
        let inner = length - 2.0 * speed * hold;
        if inner <= 0.0 || top <= speed {
            return Self {
                length,
                duration: length / speed,
                speed,
                hold: length / speed,
                rate,
                rise: 0.0,
            };
        }
        let peak = (speed * speed + rate * inner).sqrt().min(top);
        let rise = (peak - speed) / rate;
        let cruising = (inner - (peak + speed) * rise).max(0.0) / peak;
        Self {
            length,
            duration: 2.0 * (hold + rise) + cruising,
            speed,
            hold,
            rate,
            rise,
        }
    }

    fn along(&self, time: f64) -> f64 {
        if time > 0.5 * self.duration {
            return self.length - self.first_half(self.duration - time);
        }
        self.first_half(time)
    }

    fn first_half(&self, time: f64) -> f64 {
        let rising = (time - self.hold).clamp(0.0, self.rise);
        let cruising = (time - self.hold - self.rise).max(0.0);
        let peak = self.speed + self.rate * self.rise;
        self.speed * (time - cruising) + 0.5 * self.rate * rising * rising + peak * cruising
    }
}

impl<const N: usize> ShortSegmentSmoother<N> {
    /// Plans the legs of the curve as pulses that are designed for a speed, in less than `most` seconds; whether
    /// that can be done.
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    pub(super) fn pulse(
        &mut self,
        legs: &[Segment<N>],
        speed: f64,
        changes: f64,
        most: f64,
    ) -> bool {
        let weakest = legs
            .iter()
            .map(|leg| leg.limits)
            .reduce(|one, other| PathLimits {
                velocity: one.velocity.min(other.velocity),
                acceleration: one.acceleration.min(other.acceleration),
                jerk: one.jerk.min(other.jerk),
            });
        let Some(weakest) = weakest else {
            return false;
        };
        let start = self.curve.control_at(0.0, 0);
        self.commands.begin(start, &weakest, speed, changes);
        let filter = self.commands.filter;
        self.spline.clear(&filter);
        let mut mark = Mark {
            count: REST,
            since: 0.0,
        };
        let mut ahead: f64 = legs
            .iter()
            .map(|leg| leg.length / leg.limits.velocity)
            .sum();
        for (index, leg) in legs.iter().enumerate() {
            let smooth =
                index > 0 && 0.5 * (leg.direction - legs[index - 1].direction).norm() < SMOOTH;
            let largest = self.commands.largest_step(leg, changes);
            let Some(next) = self.overlap(leg, index, largest, smooth, mark) else {
                return false;
            };
            mark = next;
            ahead -= leg.length / leg.limits.velocity;
            if mark.count as f64 * filter.step + ahead >= most {
                return false;
            }
        }
        // From the last command on there are as many as the means take, and a rest.
        let count = mark.count + filter.settling() + REST;
        let spline = &mut self.spline;
        spline.controls.truncate(count);
        spline.progress.truncate(count);
        let count = spline.controls.len();
        spline.controls[count - REST..].fill(self.curve.end());
        spline.duration() < most && self.is_legal() && self.spline.passes_in_order(&self.curve)
    }

    /// Commands a leg as soon as it may be, or slower where the path goes on smoothly.
    #[allow(clippy::cast_precision_loss, reason = "counts are small")]
    fn overlap(
        &mut self,
        leg: &Segment<N>,
        index: usize,
        largest: f64,
        smooth: bool,
        mark: Mark,
    ) -> Option<Mark> {
        let mut pulse = Pulse {
            index,
            speed: largest,
            top: leg.limits.velocity * ROUNDING,
            pause: 0,
        };
        let found = self.try_pulse(pulse, mark);
        if found.is_some() {
            return found;
        }
        let full = self.commands.filter.settling() + REST;
        if smooth {
            let stop = full as f64 * self.commands.filter.step;
            for speed in SHARES.map(|share| share * largest) {
                if leg.length / speed - leg.length / largest > stop {
                    break;
                }
                let slower = Pulse {
                    speed,
                    top: speed,
                    ..pulse
                };
                let found = self.try_pulse(slower, mark);
                if found.is_some() {
                    return found;
                }
            }
        }
        pulse.pause = full;
        let mut slowings = 0;
        while self.try_pulse(pulse, mark).is_none() {
            pulse.speed *= SLOWER;
            slowings += 1;
            if slowings > SLOWINGS {
                return None;
            }
        }
        let (mut fails, mut fits) = (0, full);
        while fits - fails > 1 {
            let pause = usize::midpoint(fails, fits);
            if self.try_pulse(Pulse { pause, ..pulse }, mark).is_some() {
                fits = pause;
            } else {
                fails = pause;
            }
        }
        self.try_pulse(
            Pulse {
                pause: fits,
                ..pulse
            },
            mark,
        )
    }

    /// Commands a leg and a full stop behind it; where commands have come to at its end, when all that has changed
    /// is legal.
    fn try_pulse(&mut self, pulse: Pulse, mark: Mark) -> Option<Mark> {
        let next = self.commands.command(pulse, mark, &self.curve)?;
        let Self {
            curve,
            spline,
            commands,
            ..
        } = self;
        let Commands { raw, mid, filter } = commands;
        // Everything from the first new command on has changed.
        mid.truncate(mark.count);
        spline.controls.truncate(mark.count);
        spline.progress.truncate(mark.count);
        let [long, short] = filter.taps;
        let length = curve.mark(pulse.index + 1);
        for index in mid.len()..raw.len() {
            mid.push(mean(long, index, |at| (raw[at].point, raw[at].distance)));
        }
        for index in spline.controls.len()..raw.len() {
            let (point, along) = mean(short, index, |at| mid[at]);
            let distance = along.min(length);
            let oldest = index.saturating_sub(filter.settling());
            let control = Control {
                point,
                distance,
                leg: curve.leg_at(distance, raw[index].leg),
                serves: MoveRange {
                    first: raw[oldest].serves.first,
                    last: raw[index].serves.last,
                },
            };
            spline.push(control, distance);
        }
        // On the middle of a leg, its commands are legal whatever is beside it.
        let beside = 2 * (REST + filter.settling());
        let begin = mark.count.saturating_sub(REST + 1 + long)..mark.count + pulse.pause + beside;
        let end = next.count.saturating_sub(beside)..spline.pieces();
        for piece in begin.start..end.end {
            if !(begin.contains(&piece) || end.contains(&piece)) {
                continue;
            }
            self.effort = self.effort.checked_sub(1)?;
            self.proposed += 1;
            if spline.excess(piece, curve, &self.limits).is_some() {
                return None;
            }
        }
        Some(next)
    }

    /// Whether all pieces are legal.
    fn is_legal(&mut self) -> bool {
        (0..self.spline.pieces()).all(|piece| {
            self.spline
                .excess(piece, &self.curve, &self.limits)
                .is_none()
        })
    }
}

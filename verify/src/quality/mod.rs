//! Measures how smooth a motion is: jerk, acceleration above a frequency, modes of vibration, ripple, offset.
//!
//! Source: ours; the glossary has the definition of each measure. Integrals of jerk are exact, since it is constant
//! over a piece. What is a mean along the path is taken at the three points of Gauss of every piece. Not here: bounds,
//! but for modes that were promised to rest.

mod high_pass;
mod overshoot;
mod ripple;
mod swing;

use crate::path::route::Route;
use crate::pieces::dynamics::Stretch;
use high_pass::HighPass;
use overshoot::{beyond, overshoot};
pub use ripple::FeedRipple;
use ripple::Ripple;
pub use swing::ModeSwing;
use swing::Swing;
use toolglide_kinematics::{AxisModes, Limits, PathSide, Sample, Vector};

/// Frequency above which acceleration is measured where nothing else is asked for, Hz.
pub const USUAL_FREQUENCY: f64 = 50.0;

/// Time between the samples of acceleration that the high-pass filter sees, s.
const SAMPLE: f64 = 1e-3;

/// Samples at rest behind the motion, over which the filter rings out.
const RINGING: u32 = 200;

/// Jerk this near to its limit is at its limit, as a share.
const AT_LIMIT: f64 = 0.99;

/// Points and weights of Gauss on a piece.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// How smooth a motion is. Time at rest does not count.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothness<const N: usize> {
    /// How long it moves, s.
    pub moving_time: f64,
    /// Root of the mean square of jerk of each axis, mm/s³.
    pub rms_jerk_by_axis: [f64; N],
    /// The same of all axes together.
    pub rms_jerk: f64,
    /// Integral of the square of jerk over time, mm²/s⁵.
    pub jerk_energy: f64,
    /// Share of time in which the jerk of some axis is within a hundredth of its limit.
    pub jerk_at_limit: f64,
    /// The frequency of the next two, Hz.
    pub high_pass: f64,
    /// Root of the mean square of what of the acceleration of each axis lies above that frequency, mm/s².
    pub acceleration_above_by_axis: [f64; N],
    /// The same of all axes together.
    pub acceleration_above: f64,
    /// How much speed varies where the feedrate does not.
    pub feed_ripple: FeedRipple,
    /// Root of the mean square of the distance from the path over time, mm.
    pub rms_offset: f64,
    /// The same in shares of the tolerance.
    pub rms_offset_share: f64,
    /// Largest distance beyond a straight line on the outer side of the corner next to it, mm.
    pub outside: f64,
    /// How the modes of vibration swing.
    pub modes: Vec<ModeSwing>,
}

/// Measures a motion piece by piece.
#[derive(Clone, Debug)]
pub(crate) struct Quality<const N: usize> {
    jerk_limit: Vector<N>,
    time: f64,
    energy: Vector<N>,
    at_limit: f64,
    frequency: f64,
    filters: [HighPass; N],
    /// Time of the next sample, from the end of the piece before.
    until_sample: f64,
    ripple: Ripple,
    offset: f64,
    offset_share: f64,
    outside: f64,
    /// The side that was promised to be kept, and how far the motion went beyond it.
    side: PathSide,
    beyond: f64,
    swings: Vec<Swing>,
}

impl<const N: usize> Quality<N> {
    pub(crate) fn new(limits: &Limits<N>) -> Self {
        let mut quality = Self {
            jerk_limit: *limits.jerk(),
            time: 0.0,
            energy: Vector::zeros(),
            at_limit: 0.0,
            frequency: USUAL_FREQUENCY,
            filters: std::array::from_fn(|_| HighPass::default()),
            until_sample: SAMPLE,
            ripple: Ripple::default(),
            offset: 0.0,
            offset_share: 0.0,
            outside: 0.0,
            side: PathSide::Both,
            beyond: 0.0,
            swings: Vec::new(),
        };
        quality.set_frequency(USUAL_FREQUENCY);
        quality
    }

    /// Measures acceleration above another frequency, Hz.
    pub(crate) fn set_frequency(&mut self, frequency: f64) {
        let frequency = if frequency > 0.0 {
            frequency
        } else {
            USUAL_FREQUENCY
        };
        self.frequency = frequency;
        self.filters = std::array::from_fn(|_| HighPass::new(frequency, SAMPLE));
    }

    pub(crate) fn set_modes(&mut self, modes: &AxisModes, limits: &Limits<N>) {
        let modes = modes.iter().filter(|mode| mode.axis < N);
        self.swings = modes
            .map(|mode| Swing::new(&mode, limits.acceleration()[mode.axis]))
            .collect();
    }

    /// Measures how far the motion goes beyond a side of straight lines.
    pub(crate) fn set_side(&mut self, side: PathSide) {
        self.side = side;
    }

    /// How far it went beyond, mm.
    pub(crate) fn beyond(&self) -> f64 {
        self.beyond
    }

    /// Takes a piece that serves some moves, at a feedrate; `rests` says whether it stands still.
    pub(crate) fn observe(
        &mut self,
        route: &Route<N>,
        stretch: &Stretch<N>,
        (first, last): (u32, u32),
        rests: bool,
    ) {
        self.filter(&stretch.start, stretch.duration);
        for swing in &mut self.swings {
            swing.pass(&stretch.start, stretch.duration);
        }
        if rests {
            self.ripple.interrupt();
            return;
        }
        let duration = stretch.duration;
        let jerk = &stretch.start.jerk;
        self.time += duration;
        self.energy += jerk.component_mul(jerk) * duration;
        if (0..N).any(|axis| jerk[axis].abs() >= AT_LIMIT * self.jerk_limit[axis]) {
            self.at_limit += duration;
        }
        self.follow_path(route, stretch, (first, last));
        let mut feedrates = route.range(first, last).map(|leg| leg.feedrate);
        let feedrate = feedrates.next().unwrap_or(0.0);
        let same = feedrates.all(|other| other.to_bits() == feedrate.to_bits());
        if same && feedrate > 0.0 {
            for share in [0.0, 0.5, 1.0] {
                let speed = at(&stretch.start, share * duration).velocity.norm();
                self.ripple.see(speed, feedrate);
            }
        } else {
            self.ripple.interrupt();
        }
    }

    fn follow_path(&mut self, route: &Route<N>, stretch: &Stretch<N>, (first, last): (u32, u32)) {
        for (share, weight) in GAUSS {
            let point = at(&stretch.start, share * stretch.duration).position;
            let mut nearest: Option<(f64, f64, u32)> = None;
            for (mv, leg) in (first..=last).zip(route.range(first, last)) {
                let distance = leg.distance(&point);
                if nearest.is_none_or(|(least, ..)| distance < least) {
                    nearest = Some((distance, leg.tolerance, mv));
                }
            }
            let Some((distance, tolerance, mv)) = nearest else {
                continue;
            };
            let square = distance * distance * weight * stretch.duration;
            self.offset += square;
            self.offset_share += square / (tolerance * tolerance);
            self.outside = self.outside.max(overshoot(route, mv, &point));
            if self.side != PathSide::Both {
                self.beyond = self.beyond.max(beyond(route, mv, &point, self.side));
            }
        }
    }

    /// Samples the acceleration of a piece.
    fn filter(&mut self, start: &Sample<N>, duration: f64) {
        // A rest longer than the filter rings needs no more samples than that.
        let longest = f64::from(RINGING) * SAMPLE;
        let still = start.acceleration.norm_squared() + start.jerk.norm_squared() <= 0.0;
        let duration = if still {
            duration.min(longest)
        } else {
            duration
        };
        let mut time = self.until_sample;
        while time <= duration {
            for axis in 0..N {
                self.filters[axis].take(start.acceleration[axis] + start.jerk[axis] * time);
            }
            time += SAMPLE;
        }
        self.until_sample = time - duration;
    }

    /// Notes that the motion has come to rest.
    pub(crate) fn rest(&mut self) {
        for swing in &mut self.swings {
            swing.rest();
        }
    }

    pub(crate) fn finish(mut self) -> Smoothness<N> {
        for _ in 0..RINGING {
            for filter in &mut self.filters {
                filter.take(0.0);
            }
        }
        for swing in &mut self.swings {
            swing.rest();
        }
        let by_time = if self.time > 0.0 {
            1.0 / self.time
        } else {
            0.0
        };
        let above: [f64; N] =
            std::array::from_fn(|axis| self.filters[axis].energy() * SAMPLE * by_time);
        Smoothness {
            moving_time: self.time,
            rms_jerk_by_axis: std::array::from_fn(|axis| (self.energy[axis] * by_time).sqrt()),
            rms_jerk: (self.energy.sum() * by_time).sqrt(),
            jerk_energy: self.energy.sum(),
            jerk_at_limit: self.at_limit * by_time,
            high_pass: self.frequency,
            acceleration_above_by_axis: above.map(f64::sqrt),
            acceleration_above: above.iter().sum::<f64>().sqrt(),
            feed_ripple: self.ripple.finish(),
            rms_offset: (self.offset * by_time).sqrt(),
            rms_offset_share: (self.offset_share * by_time).sqrt(),
            outside: self.outside,
            modes: self
                .swings
                .iter()
                .map(|swing| swing.found(by_time))
                .collect(),
        }
    }
}

/// The state of a piece a time after its start.
fn at<const N: usize>(start: &Sample<N>, time: f64) -> Sample<N> {
    let Sample {
        position,
        velocity,
        acceleration,
        jerk,
    } = start;
    Sample {
        position: position + (velocity + (acceleration * 0.5 + jerk * (time / 6.0)) * time) * time,
        velocity: velocity + (acceleration + jerk * (0.5 * time)) * time,
        acceleration: acceleration + jerk * time,
        jerk: *jerk,
    }
}

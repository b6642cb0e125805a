//! Estimates the speed at each place of a window and the duration of each span.
//!
//! Source: ours. A corner is passed as on the circle that fits its tube, forward and backward passes
//! limit how speed changes between corners, and a span takes as long as a trapezoid of speed. It is a
//! guess to start from: much too fast is bad, everything else leads to the same motion. Not here: what
//! really fits.

use crate::path::spans::Span;

/// Turns above this have no circle within the tube, rad.
const SHARP: f64 = 2.9;

/// Turns above this have no circle between the moves either, rad.
const REVERSAL: f64 = 3.1;

/// Turns below this are none, rad.
const STRAIGHT: f64 = 1e-9;

/// Largest radius that matters, mm.
const WIDE: f64 = 1e9;

/// Least speed of a guess as a share of the feedrate, so that a start from rest takes a finite time.
const MIN_SPEED: f64 = 1e-3;

/// Speed at which the mean acceleration of a change of speed is taken, as a share of the feedrate
/// above the lower speed: a change by jerk alone takes longer than the acceleration alone would say.
const RISE_SPEED: f64 = 0.1;

/// How much faster than the feedrate a joint could be passed where passing it asks for little.
const EASE: f64 = 2.0;

/// Share of the feedrate above which speed counts as constant.
const STEADY: f64 = 0.999;

/// Speed at which the circle that fits a joint could be passed, mm/s, by the weakest axis; infinite
/// where the path goes straight on.
fn circle_speed<const N: usize>(
    span: &Span<N>,
    next: &Span<N>,
    (acceleration, jerk): (f64, f64),
) -> f64 {
    if span.goes_on {
        return f64::INFINITY;
    }
    let cosine = span.direction.dot(&next.direction).clamp(-1.0, 1.0);
    let turn = cosine.acos();
    if turn < STRAIGHT {
        return f64::INFINITY;
    }
    let half = 0.5 * turn;
    let between = if turn < REVERSAL {
        (0.5 * span.length.min(next.length) / half.tan()).min(WIDE)
    } else {
        0.0
    };
    let tube = span.tube.min(next.tube);
    let inside = (tube * half.cos() / (1.0 - half.cos()).max(1e-12)).min(WIDE);
    let radius = if turn < SHARP {
        between.max(inside)
    } else {
        between.min(inside)
    };
    (acceleration * radius)
        .sqrt()
        .min((jerk * radius * radius).cbrt())
}

/// A window as the guess sees it; the vectors are reused.
#[derive(Clone, Debug, Default)]
pub(crate) struct Guess {
    /// Speed at the start, at every joint, and at the end.
    speeds: Vec<f64>,
    /// Duration of each span, s.
    pub(crate) times: Vec<f64>,
    /// Whether each span is travelled at the feedrate and its joints ask for little.
    pub(crate) steady: Vec<bool>,
}

impl Guess {
    /// A guess for windows of up to `most` spans.
    pub(crate) fn with_capacity(most: usize) -> Self {
        Self {
            speeds: Vec::with_capacity(most + 1),
            times: Vec::with_capacity(most),
            steady: Vec::with_capacity(most),
        }
    }

    /// Fills in the times of `spans`, entered at `speed` and left at rest, or at any speed where they are
    /// `open`.
    pub(crate) fn fill<'a, const N: usize>(
        &mut self,
        spans: impl DoubleEndedIterator<Item = &'a Span<N>> + ExactSizeIterator + Clone,
        speed: f64,
        open: bool,
        weakest: (f64, f64),
    ) {
        let (acceleration, jerk) = weakest;
        let mean = |speed: f64, span: &Span<N>| {
            let at =
                (speed + RISE_SPEED * span.limits.velocity).max(MIN_SPEED * span.limits.velocity);
            acceleration / (1.0 + acceleration * acceleration / (jerk * at))
        };
        self.speeds.clear();
        self.times.clear();
        self.steady.clear();
        self.speeds.push(speed);
        let mut before: Option<&Span<N>> = None;
        let mut easy = true;
        for span in spans.clone() {
            if let Some(before) = before {
                let most = before.limits.velocity.min(span.limits.velocity);
                let circle = circle_speed(before, span, weakest);
                let fair = circle > EASE * most;
                self.steady.push(easy && fair);
                self.speeds.push(most.min(circle));
                easy = fair;
            }
            before = Some(span);
        }
        let Some(last) = before else { return };
        // What comes after it is not known.
        self.steady.push(false);
        let leave = if open { 1.0 } else { MIN_SPEED };
        self.speeds.push(leave * last.limits.velocity);
        for (index, span) in spans.clone().enumerate() {
            let from = self.speeds[index];
            let reach = (from * from + 2.0 * mean(from, span) * span.length).sqrt();
            self.speeds[index + 1] = self.speeds[index + 1].min(reach);
        }
        for (index, span) in spans.clone().enumerate().skip(1).rev() {
            let to = self.speeds[index + 1];
            let reach = (to * to + 2.0 * mean(to, span) * span.length).sqrt();
            self.speeds[index] = self.speeds[index].min(reach);
        }
        for ((span, pair), steady) in spans.zip(self.speeds.windows(2)).zip(&mut self.steady) {
            self.times.push(trapezoid(span, pair[0], pair[1], &mean));
            *steady &= pair[0].min(pair[1]) >= STEADY * span.limits.velocity;
        }
    }
}

/// Duration of a span between two speeds.
fn trapezoid<const N: usize>(
    span: &Span<N>,
    from: f64,
    to: f64,
    mean: &impl Fn(f64, &Span<N>) -> f64,
) -> f64 {
    let feedrate = span.limits.velocity;
    let acceleration = mean(from.max(to), span);
    let highest = from.max(to);
    let peak = (0.5 * (from * from + to * to) + acceleration * span.length)
        .sqrt()
        .max(highest)
        .min(feedrate.max(highest));
    let changing = (2.0 * peak * peak - from * from - to * to) / (2.0 * acceleration);
    let time = (2.0 * peak - from - to) / acceleration + (span.length - changing).max(0.0) / peak;
    time.max(span.length / feedrate)
}

//! Slows blocks down and eases corners until every axis keeps its limits.
//!
//! Source: ours. Each block alone is bounded by how the axes move along it; then the motion of the
//! whole stretch is laid out, measured, and where a limit is exceeded the blocks are slowed down or
//! the corners between them eased, whichever costs less, until nothing is.
//! What has not changed is not measured again. Not here: the measures, see `screen` and `follow`.

use crate::axis_limits::axis_bounds::Worst;
use crate::axis_limits::remeasure::{differs, next_window};
use crate::error::FiveAxisError;
use crate::timing::commanded_progress::Steps;
use toolglide_fir::FilterChain;
use toolglide_kinematics::Axis;

/// Share of a limit that planning aims at: the rest is room for rounding, and for what a series
/// leaves out.
pub(crate) const AIM: f64 = 0.998;

/// Rounds of slowing down.
const ROUNDS: u32 = 200;

/// A block that would have to be slowed down by more than this passes a pole of the machine, where no
/// speed is slow enough.
const HOPELESS: f64 = 1e6;

/// Largest factor by which a block is slowed down in one round.
const STRONGEST: f64 = 16.0;

/// Least such factor, so that rounds come to an end.
const WEAKEST: f64 = 1.000_5;

/// A little more than what is needed, so that a round is not wasted on a thousandth.
const SURPLUS: f64 = 1.000_5;

/// Rounds after which what still exceeds a limit is slowed down as a whole, instead of what costs least:
/// slow enough, every block keeps every limit.
const PATIENCE: u32 = 100;

/// Least factor by which blocks are slowed down from then on.
const FIRM: f64 = 1.05;

/// Blocks that are slower than this share of the fastest one under way are not slowed down further.
const SLOW: f64 = 0.5;

/// A limit exceeded more than this is approached by what is surely needed, and no more.
const FAR: f64 = 1.3;

/// Blocks of a stretch, in time and on axes.
pub(crate) trait Stretch {
    /// Steps of all blocks, from time 0 on, after the blocks or corners so marked have changed.
    fn steps(&mut self, changed: &[bool]) -> Vec<Steps>;
    /// The limit that an interval comes nearest to.
    fn worst(
        &self,
        steps: &[Steps],
        interval: [f64; 2],
        blocks: [usize; 2],
    ) -> Result<Worst, FiveAxisError>;
    /// How fast a block is, in any measure.
    fn pace(&self, block: usize) -> f64;
    /// How long the command of a block lasts.
    fn duration(&mut self, block: usize) -> &mut f64;
    /// How much longer the motion becomes when the corner after a block is taken so much more gently
    /// that the given limit is kept; infinite where it cannot be.
    fn cost_of_easing(&self, block: usize, worst: &Worst) -> f64;
    /// Takes the corner after a block more gently.
    fn ease(&mut self, block: usize, worst: &Worst);
    /// Number of the leg of a block.
    fn leg(&self, block: usize) -> u32;
}

/// What a round found for each block.
struct Round {
    /// By how much it is slowed down.
    factors: Vec<f64>,
    /// Why the corner after it is eased.
    easing: Vec<Worst>,
    /// Whether a limit is exceeded while it is under way.
    violating: Vec<bool>,
    worst: Option<(usize, Worst)>,
}

impl Round {
    fn new(count: usize) -> Self {
        Self {
            factors: vec![1.0; count],
            easing: vec![Worst::NONE; count],
            violating: vec![false; count],
            worst: None,
        }
    }
}

/// How a block answered to being slowed down.
#[derive(Clone, Copy)]
struct Answer {
    worst: Worst,
    factor: f64,
}

/// Slows blocks down until every axis keeps its limits, and says which limit each block met.
pub(crate) fn relax(
    stretch: &mut dyn Stretch,
    chain: &FilterChain,
    axes: &[Axis],
    met: &mut [Option<Worst>],
) -> Result<Vec<Steps>, FiveAxisError> {
    let count = met.len();
    let mut fresh = vec![true; count];
    let mut still = vec![false; count];
    let mut slowed = vec![1.0_f64; count];
    let mut answers: Vec<Option<Answer>> = vec![None; count];
    let mut steps = stretch.steps(&fresh);
    for number in 0..ROUNDS {
        let mut round = Round::new(count);
        let mut first = 0;
        while let Some(window) = next_window(&fresh, &still, first, &steps, chain) {
            first = window.last + 1;
            window.measure(&steps, chain, |interval, range| {
                let [oldest, newest] = range;
                let unchanged = !fresh[oldest..=newest].iter().any(|fresh| *fresh);
                if unchanged && !still[oldest..=newest].iter().any(|still| *still) {
                    return Ok(());
                }
                let worst = stretch.worst(&steps, interval, range)?;
                if worst.share > 1.0 {
                    let firmly = number >= PATIENCE;
                    judge(
                        stretch, &mut round, &answers, range, worst, unchanged, firmly, met,
                    );
                }
                Ok(())
            })?;
        }
        let Some((block, worst)) = round.worst else {
            return Ok(steps);
        };
        let hopeless = slowed.iter().any(|factor| *factor > HOPELESS);
        if hopeless || number + 1 == ROUNDS {
            return Err(FiveAxisError::AxisLimit {
                index: stretch.leg(block),
                axis: axes.get(worst.axis).map_or('?', |axis| axis.name),
                quantity: worst.quantity(),
                factor: worst.share,
            });
        }
        let mut changed = vec![false; count];
        for block in 0..count {
            let factor = round.factors[block];
            answers[block] = None;
            if factor > 1.0 {
                *stretch.duration(block) *= factor;
                slowed[block] *= factor;
                changed[block] = true;
                answers[block] = met[block].map(|worst| Answer { worst, factor });
            }
            if round.easing[block].share > 1.0 {
                stretch.ease(block, &round.easing[block]);
                changed[block] = true;
            }
        }
        let before = std::mem::replace(&mut steps, stretch.steps(&changed));
        for (block, fresh) in fresh.iter_mut().enumerate() {
            *fresh = differs(&before, &steps, block);
        }
        still = round.violating;
    }
    Ok(steps)
}

/// Chooses what is done about a limit that is exceeded while the blocks of a range are under way.
#[allow(
    clippy::too_many_arguments,
    reason = "the state of one round, which nothing else shares"
)]
fn judge(
    stretch: &mut dyn Stretch,
    round: &mut Round,
    answers: &[Option<Answer>],
    [oldest, newest]: [usize; 2],
    worst: Worst,
    unchanged: bool,
    firmly: bool,
    met: &mut [Option<Worst>],
) {
    round.violating[oldest..=newest].fill(true);
    if round
        .worst
        .is_none_or(|(_, other)| worst.share > other.share)
    {
        round.worst = Some((oldest, worst));
    }
    let weakest = if firmly { FIRM } else { WEAKEST };
    let fastest = (oldest..=newest)
        .map(|block| stretch.pace(block))
        .fold(0.0, f64::max);
    let fast =
        |stretch: &dyn Stretch, block: usize| firmly || stretch.pace(block) >= SLOW * fastest;
    let factor = |block: usize| factor(worst, answers[block]).clamp(weakest, STRONGEST);
    let mut slowing = 0.0;
    for block in oldest..=newest {
        if fast(stretch, block) {
            slowing += (factor(block) - 1.0) * *stretch.duration(block);
        }
    }
    let eased: f64 = (oldest..newest)
        .map(|block| stretch.cost_of_easing(block, &worst))
        .sum();
    // Easing is no help where it has just changed nothing.
    if oldest < newest && eased < slowing && !unchanged && !firmly {
        for ease in &mut round.easing[oldest..newest] {
            if worst.share > ease.share {
                *ease = worst;
            }
        }
        return;
    }
    for (block, met) in met.iter_mut().enumerate().take(newest + 1).skip(oldest) {
        if fast(stretch, block) && factor(block) > round.factors[block] {
            round.factors[block] = factor(block);
            *met = Some(worst);
        }
    }
}

/// How much slower a block must be so that a limit is kept.
///
/// Velocity, acceleration and jerk go with the first to the third power where the way bends, and with
/// the first where the rate changes: far from the limit what bends surely asks for is taken, near to it
/// something between, or what the block answered the last time.
fn factor(worst: Worst, answer: Option<Answer>) -> f64 {
    let order = worst.order.min(2);
    let share = worst.share * SURPLUS;
    if let Some(answer) = answer
        && (answer.worst.axis, answer.worst.order) == (worst.axis, worst.order)
        && answer.worst.share > worst.share
    {
        let power = (answer.worst.share / worst.share).ln() / answer.factor.ln();
        return share.powf(1.0 / power.clamp(0.7, 3.0));
    }
    let power = if worst.share > FAR {
        [1.0, 0.5, 1.0 / 3.0][order]
    } else {
        [1.0, 0.75, 0.6][order]
    };
    share.powf(power).max(1.0)
}

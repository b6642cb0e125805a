//! Blocks are slowed down, and corners taken more gently, until every axis keeps its limits.
//!
//! Source: ours. Each block alone is bounded by how the axes move along it; then the motion of the
//! whole stretch is laid out, measured, and where a limit is exceeded the blocks are slowed down or
//! the corners between them eased, whichever costs less, until nothing is.
//! What has not changed is not measured again. Not here: the measure, see `follow`.

use crate::error::FiveAxisError;
use crate::follow::Worst;
use crate::lay::{intervals, knots};
use crate::steps::Steps;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{Axis, AxisVector};

/// Share of a limit that planning aims at: what lies between the instants looked at stays below the
/// rest.
pub(crate) const AIM: f64 = 0.995;

/// Rounds of slowing down.
const ROUNDS: u32 = 200;

/// A block that would have to be slowed down by more than this passes a pole of the machine, where no
/// speed is slow enough.
const HOPELESS: f64 = 1e3;

/// Largest factor by which a block is slowed down in one round.
const STRONGEST: f64 = 1.5;

/// Least such factor, so that rounds come to an end.
const WEAKEST: f64 = 1.002;

/// Rounds after which what still exceeds a limit is slowed down as a whole, instead of what costs least:
/// slow enough, every block keeps every limit.
const PATIENCE: u32 = 100;

/// Least factor by which blocks are slowed down from then on.
const FIRM: f64 = 1.05;

/// Blocks that are slower than this share of the fastest one under way are not slowed down further.
const SLOW: f64 = 0.5;

/// Blocks of a stretch, in time and on axes.
pub(crate) trait Stretch {
    /// Steps of all blocks, from time 0 on.
    fn steps(&mut self) -> Vec<Steps>;
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

/// Slows blocks down until every axis keeps its limits, and says which limit each block met.
pub(crate) fn relax(
    stretch: &mut dyn Stretch,
    chain: &FilterChain,
    axes: &[Axis],
    met: &mut [Option<Worst>],
) -> Result<Vec<Steps>, FiveAxisError> {
    let mut before: Vec<Steps> = Vec::new();
    let mut slowed = vec![1.0_f64; met.len()];
    let mut violating = vec![false; met.len()];
    for round in 0..ROUNDS {
        let steps = stretch.steps();
        let knots = knots(&steps, chain);
        let same: Vec<bool> = steps
            .iter()
            .enumerate()
            .map(|(index, now)| {
                before.get(index).is_some_and(|then| {
                    shape(then, before.get(index + 1)) == shape(now, steps.get(index + 1))
                })
            })
            .collect();
        let mut factors = vec![1.0_f64; steps.len()];
        let mut easing = vec![Worst::NONE; steps.len()];
        let still = std::mem::replace(&mut violating, vec![false; steps.len()]);
        let mut worst_of_all: Option<(usize, Worst)> = None;
        for (interval, range) in intervals(&steps, &knots, chain) {
            let [oldest, newest] = range;
            let unchanged = same[oldest..=newest].iter().all(|same| *same);
            if unchanged && !still[oldest..=newest].iter().any(|still| *still) {
                continue;
            }
            let worst = stretch.worst(&steps, interval, range)?;
            if worst.share <= 1.0 {
                continue;
            }
            violating[oldest..=newest].fill(true);
            if worst_of_all.is_none_or(|(_, other)| worst.share > other.share) {
                worst_of_all = Some((oldest, worst));
            }
            // Velocity, acceleration and jerk go with the first to the third power where the way
            // bends, and with the first where the speed changes.
            let power = [1.0, 0.75, 0.6][worst.order.min(2)];
            let firmly = round >= PATIENCE;
            let weakest = if firmly { FIRM } else { WEAKEST };
            let factor = worst.share.powf(power).clamp(weakest, STRONGEST);
            let fastest = (oldest..=newest)
                .map(|block| stretch.pace(block))
                .fold(0.0, f64::max);
            let fast: Vec<usize> = (oldest..=newest)
                .filter(|&block| firmly || stretch.pace(block) >= SLOW * fastest)
                .collect();
            let slowing: f64 = fast
                .iter()
                .map(|&block| (factor - 1.0) * *stretch.duration(block))
                .sum();
            let eased: f64 = (oldest..newest)
                .map(|block| stretch.cost_of_easing(block, &worst))
                .sum();
            // Easing is no help where it has just changed nothing.
            if oldest < newest && eased < slowing && !unchanged && !firmly {
                for ease in &mut easing[oldest..newest] {
                    if worst.share > ease.share {
                        *ease = worst;
                    }
                }
                continue;
            }
            for block in fast {
                if factor > factors[block] {
                    factors[block] = factor;
                    met[block] = Some(worst);
                }
            }
        }
        let Some((block, worst)) = worst_of_all else {
            return Ok(steps);
        };
        let hopeless = slowed.iter().any(|factor| *factor > HOPELESS);
        if hopeless || round + 1 == ROUNDS {
            return Err(FiveAxisError::AxisLimit {
                index: stretch.leg(block),
                axis: axes.get(worst.axis).map_or('?', |axis| axis.name),
                quantity: worst.quantity(),
                factor: worst.share,
            });
        }
        for (block, factor) in factors.iter().enumerate() {
            if *factor > 1.0 {
                *stretch.duration(block) *= factor;
                slowed[block] *= factor;
            }
        }
        for (block, worst) in easing.iter().enumerate() {
            if worst.share > 1.0 {
                stretch.ease(block, worst);
            }
        }
        before = steps;
    }
    Ok(before)
}

/// Everything about a block in time but when it begins, and the way to the next, to the bit.
fn shape(steps: &Steps, next: Option<&Steps>) -> (Vec<u64>, Option<u64>) {
    let begin = steps.begin();
    // A picosecond of rounding in absolute times must not look like a change.
    let bits = |time: f64| (time * 1e12).round().to_bits();
    (
        steps.times().map(|time| bits(time - begin)).collect(),
        next.map(|next| bits(next.begin() - begin)),
    )
}

/// The least duration of a block along which the axes take these positions at equal shares.
///
/// Velocity bounds every share; the steps of velocity at both ends bound by acceleration and jerk of
/// the chain; bends of the way by their second and third differences.
pub(crate) fn least_duration(
    positions: &[AxisVector],
    axes: &[Axis],
    chain: &FilterChain,
) -> (f64, Worst) {
    let [long, short] = *chain.time_constants() else {
        return (0.0, Worst::NONE);
    };
    let shares = count(positions.len().saturating_sub(1));
    let mut least = (0.0, Worst::NONE);
    for (axis, limits) in axes.iter().enumerate() {
        let at = |index: usize| positions[index][axis];
        let velocity = AIM * limits.limits.velocity();
        let acceleration = AIM * limits.limits.acceleration();
        let jerk = AIM * limits.limits.jerk();
        let mut raise = |duration: f64, order: usize| {
            if duration > least.0 {
                let share = 1.0;
                least = (duration, Worst { share, axis, order });
            }
        };
        let steps: Vec<f64> = (1..positions.len())
            .map(|index| at(index) - at(index - 1))
            .collect();
        for step in &steps {
            raise(shares * step.abs() / velocity, 0);
        }
        for end in [steps.first(), steps.last()].into_iter().flatten() {
            let speed = shares * end.abs();
            raise(speed / (acceleration * long), 1);
            raise(speed / (jerk * long * short), 2);
        }
        let bends: Vec<f64> = steps.windows(2).map(|pair| pair[1] - pair[0]).collect();
        for bend in &bends {
            raise(shares * (bend.abs() / acceleration).sqrt(), 1);
        }
        for pair in bends.windows(2) {
            raise(shares * ((pair[1] - pair[0]).abs() / jerk).cbrt(), 2);
        }
    }
    least
}

#[allow(
    clippy::cast_precision_loss,
    reason = "a block has at most some dozen shares"
)]
fn count(shares: usize) -> f64 {
    shares as f64
}

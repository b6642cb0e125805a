//! Follows pieces of tool motion by series, and finds the largest derivatives of every axis.
//!
//! Source: nothing but the meaning of a piece. Not here: which motion.

use crate::NOTABLE;
use crate::jet::{Jet, JetVector};
use crate::machines::{Case, limits};
use std::f64::consts::{PI, TAU};
use toolglide_kinematics::{AxisVector, ToolPiece};

/// Instants of a piece that are looked at, and more of them where the tool is nearest to the pole.
const INSTANTS: u32 = 200;
const REFINED: u32 = 40;

/// Rounding of an orientation is let into a derivative up to this share of its limit.
const SEEN: f64 = 1e-4;

/// Nearer to the pole, rad, rounding tells where C is, and positions are not compared.
const AT_POLE: f64 = 1e-6;

/// A tool that leans and turns by less, rad, stays at the pole.
const STILL: f64 = 1e-14;

/// Rounding of positions of both derivations, mm and rad.
const SAME_POSITION: f64 = 1e-9;

/// Tip and orientation around a time of a piece.
fn pose_at(piece: &ToolPiece, time: f64) -> (JetVector, JetVector) {
    let start = &piece.tip;
    let tip = std::array::from_fn(|k| {
        let cubic = [
            start.position[k],
            start.velocity[k],
            0.5 * start.acceleration[k],
            start.jerk[k] / 6.0,
        ];
        Jet::cubic(cubic, time)
    });
    let mut tool = JetVector::constant(piece.base.into());
    for turn in &piece.turns {
        tool = tool.turned(turn.axis.into(), Jet::cubic(turn.angle, time));
    }
    (JetVector(tip), tool)
}

/// Largest derivatives of every axis, as shares of their limits.
pub(crate) type Peaks = [[f64; 3]; 5];

/// Follows tool motion by jets.
pub(crate) struct Follower<'c> {
    pub(crate) case: &'c Case,
    pub(crate) near: AxisVector,
    pub(crate) peaks: Peaks,
}

/// The largest value so far, its time, and the side of the tilting axis there.
type Best = (f64, f64, f64);

impl Follower<'_> {
    /// Derivatives of every axis as shares of their limits; none where the rounding of the
    /// orientation beside the pole would be seen in them.
    fn shares(&self, piece: &ToolPiece, time: f64, side: f64) -> Peaks {
        let (tip, tool) = pose_at(piece, time);
        let [i, j, _] = tool.0;
        let across = i.0[0].hypot(j.0[0]);
        let still = i.0.iter().chain(&j.0).all(|part| part.abs() < STILL);
        if still {
            let found = self.case.axes_at_pole(tip, self.near[4]);
            let found = found.map(Jet::derivatives);
            return std::array::from_fn(|axis| {
                let limits = limits(&self.case.axes[axis]);
                std::array::from_fn(|order| found[axis][order + 1].abs() / limits[order])
            });
        }
        let [_, first, second, third] =
            std::array::from_fn(|order| i.0[order].hypot(j.0[order]) / across);
        let rate = first.max(second.sqrt()).max(third.cbrt());
        let found = self.case.axes_at(tip, tool, side).map(Jet::derivatives);
        let spin = limits(&self.case.axes[4]);
        std::array::from_fn(|axis| {
            let limits = limits(&self.case.axes[axis]);
            let mut power = 1.0;
            std::array::from_fn(|order| {
                power *= rate;
                let noise = f64::EPSILON / across * power;
                if noise < SEEN * spin[order] {
                    found[axis][order + 1].abs() / limits[order]
                } else {
                    0.0
                }
            })
        })
    }

    /// Both derivations of the positions agree; on which side the tilting axis is.
    fn same_positions(&mut self, piece: &ToolPiece, time: f64) -> f64 {
        let pose = piece.at(time);
        self.near = self.case.machine.follow(&pose, &self.near).unwrap();
        let side = 1.0_f64.copysign(self.near[3]);
        let (tip, tool) = pose_at(piece, time);
        let beside = self.near[3].abs().min(1.0);
        if beside < AT_POLE {
            return side;
        }
        let found = self.case.axes_at(tip, tool, side);
        for (axis, (found, known)) in found.iter().zip(self.near.iter()).enumerate() {
            let mut miss = found.0[0] - known;
            if axis == 4 {
                miss = (miss + PI).rem_euclid(TAU) - PI;
            }
            assert!(
                miss.abs() < SAME_POSITION.max(1e-14 / beside),
                "{}: axis {axis} by {miss:e} at {time} s, {beside:e} rad beside the pole",
                self.case.name
            );
        }
        side
    }

    pub(crate) fn piece(&mut self, piece: &ToolPiece) {
        let duration = piece.duration;
        let step = duration / f64::from(INSTANTS);
        let mut times: Vec<f64> = (0..=INSTANTS)
            .map(|instant| (step * f64::from(instant)).min(duration))
            .collect();
        let beside = |time: f64| {
            let [i, j, _] = pose_at(piece, time).1.0;
            i.0[0].hypot(j.0[0])
        };
        let nearest = times
            .iter()
            .copied()
            .min_by(|one, other| beside(*one).total_cmp(&beside(*other)))
            .unwrap();
        let nearest = largest(&|time| -beside(time), nearest, step, duration).0;
        for instant in 0..REFINED {
            let away = step * 0.6_f64.powf(f64::from(instant / 2));
            let away = if instant % 2 == 0 { away } else { -away };
            times.push((nearest + away).clamp(0.0, duration));
        }
        times.push(nearest);
        times.sort_by(f64::total_cmp);
        let mut best: [[Best; 3]; 5] = [[(0.0, 0.0, 1.0); 3]; 5];
        for time in times {
            let side = self.same_positions(piece, time);
            let shares = self.shares(piece, time, side);
            for (best, share) in best.iter_mut().flatten().zip(shares.as_flattened()) {
                if *share > best.0 {
                    *best = (*share, time, side);
                }
            }
        }
        for (axis, best) in best.into_iter().enumerate() {
            for (order, (mut share, time, side)) in best.into_iter().enumerate() {
                if share > 0.9 * NOTABLE.max(self.peaks[axis][order]) {
                    let of = |time| self.shares(piece, time, side)[axis][order];
                    share = share.max(largest(&of, time, step, duration).1);
                }
                let peak = &mut self.peaks[axis][order];
                *peak = peak.max(share);
            }
        }
    }
}

/// Where a function is largest about a time, by the golden section, and how large.
fn largest(of: &dyn Fn(f64) -> f64, time: f64, step: f64, duration: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let (mut low, mut high) = ((time - step).max(0.0), (time + step).min(duration));
    for _ in 0..25 {
        let width = GOLDEN * (high - low);
        if of(high - width) > of(low + width) {
            high = low + width;
        } else {
            low = high - width;
        }
    }
    let time = 0.5 * (low + high);
    (time, of(time))
}

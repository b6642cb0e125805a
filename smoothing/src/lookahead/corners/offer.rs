//! Offers the candidates of each corner to the candidate graph once all windows have scaled them.
//!
//! Source: ours. Not here: how the candidates are made, and the choice among them.

use crate::lookahead::candidate_graph::MAX_CANDIDATES;
use crate::lookahead::corners::{Corners, corner_tolerance, goes_round, link_of};
use crate::lookahead::overlap::OverlappedPair;
use crate::lookahead::unroll::corner_between;
use crate::method::Method;
use toolglide_profiles::BlendShape;

/// Scales of the uninterrupted corner that are tried overlapping, as shares of the scale at which it
/// reaches over the whole of the shorter move beside it.
pub(super) fn overlapping_of(method: Method) -> &'static [f64] {
    match method {
        Method::Kcs | Method::ExactStop => &[1.3, 1.1, 0.9],
        Method::KcsGlobal => &[1.2, 1.1, 1.0, 0.9, 0.8, 0.7, 0.6],
        _ => &[],
    }
}

impl<const N: usize> Corners<N> {
    /// Hands corners to the lattice that all windows have scaled.
    pub(super) fn offer(&mut self) {
        for (window, scaled) in self.windows.iter_mut().zip(&mut self.scaled) {
            while let Some(shape) = window.pull() {
                scaled.push_back(shape);
            }
        }
        while self.offered < self.legs.len() && self.scaled.iter().all(|queue| !queue.is_empty()) {
            let mut candidates = [BlendShape::STOP; MAX_CANDIDATES];
            let mut count = 0;
            let leg = &self.legs[self.offered];
            for queue in &mut self.scaled {
                if let Some(shape) = queue.pop_front() {
                    candidates[count] = shape;
                    count += 1;
                }
            }
            let next = self.legs.get(self.offered + 1).or(self.pending.as_ref());
            let within_arc = self.stops_allowed && next.is_some_and(|next| goes_round(leg, next));
            let fixed = leg.stop || leg.cruises || within_arc;
            if leg.stop {
                count = 0;
            }
            if (self.stops_allowed && !leg.cruises) || leg.stop {
                candidates[count] = BlendShape::STOP;
                count += 1;
            }
            let safe = count;
            if let (Some(selection), Some(next)) = (self.selections.first(), next)
                && !(fixed || self.overlapping.is_empty())
            {
                let corner = corner_between(leg, next, corner_tolerance(leg, next));
                if let Some(shape) = selection.unscaled(&corner) {
                    let reach = shape.entry.distance.max(shape.exit.distance);
                    let filling = (leg.length.min(next.length) / reach).cbrt();
                    for share in self.overlapping {
                        candidates[count] = shape.scaled((share * filling).min(1.0));
                        count += 1;
                    }
                }
            }
            let link = link_of(leg);
            let last = self.last_offered.as_ref();
            self.lattice.push(
                &link,
                &candidates[..safe],
                &candidates[safe..count],
                |from, to, most| {
                    let between = OverlappedPair {
                        before: last?,
                        leg,
                        after: next?,
                    };
                    between.duration(from, to, &self.limits, most)
                },
            );
            self.last_offered = Some(*leg);
            self.offered += 1;
        }
    }
}

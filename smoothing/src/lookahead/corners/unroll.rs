//! Emits the chosen motions as pieces, segment by segment.
//!
//! Source: section 3.3. Not here: the choice.

use crate::lookahead::candidate_graph::Choice;
use crate::lookahead::corners::{Corners, corner_tolerance};
use crate::lookahead::overlap::OverlappedPair;
use crate::lookahead::unroll::{corner_between, unroll_corner, unroll_leg};
use toolglide_profiles::Part;

impl<const N: usize> Corners<N> {
    /// Unrolls what is left of the corner before the next leg, and the leg.
    pub(super) fn unroll(&mut self, to: &Choice) {
        let Some(leg) = self.legs.pop_front() else {
            return;
        };
        self.offered -= 1;
        let pieces = &mut self.pieces;
        let from = self.from;
        let part = match (from.overlap, to.overlap) {
            (None, None) => Some(Part::Whole),
            (None, Some(_)) => Some(Part::FirstHalf),
            (Some(_), None) => Some(Part::SecondHalf),
            (Some(_), Some(_)) => None,
        };
        if let (Some(last), Some(part)) = (&self.last, part) {
            let corner = corner_between(last, &leg, corner_tolerance(last, &leg));
            unroll_corner(&from.shape, part, corner, last, &leg, |piece| {
                pieces.push_back(piece);
            });
        }
        let next = self.legs.front().or(self.pending.as_ref());
        match (to.overlap, &self.last, next) {
            (Some(duration), Some(before), Some(after)) => {
                let between = OverlappedPair {
                    before,
                    leg: &leg,
                    after,
                };
                between.pieces(&from.shape, &to.shape, duration, |piece| {
                    pieces.push_back(piece);
                });
            }
            _ => unroll_leg(&leg, &from.shape, &to.shape, |piece| {
                pieces.push_back(piece);
            }),
        }
        if let Some(pause) = leg.dwell {
            pieces.push_back(pause.piece(leg.end));
        }
        self.last = Some(leg);
        self.from = *to;
    }
}

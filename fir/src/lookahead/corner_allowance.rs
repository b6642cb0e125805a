//! Computes how far the deviation bound may go at a corner of lines and arcs.
//!
//! Source: ours. The bound holds for the polygon of lines and chords. The vertices of chords lie outside
//! their arc and the middles of chords inside. Between two vertices the bound is convex, and below the
//! mean of theirs the more the path turns in the window: where it turns as the arc does, by as much as
//! the arc bends away from its chord, so that there the motion is as far inside of the arc everywhere.
//! Not here: the bound.

use crate::chords::Shape;
use crate::lookahead::LookAhead;
use crate::lookahead::arc_feed::STEADY_EXCESS;
use crate::pulse::Pulse;

/// Share of the sagitta of chords that a corner beside them leaves unused before anything is known of its
/// window: where half of it is on the arc, a sixth is wanted, and more with a dwell.
const UNUSED: f64 = 1.0 / 3.0;

/// Least share of the tolerance that is allowed: chords of an arc may lie further inside than a move allows that is
/// served together with them, and then a full stop beside them is all that can be done.
const LEAST_ALLOWED: f64 = 0.01;

/// Share of the tolerance that is expected to be left unused on an arc near its ends: what two arcs that
/// meet without a corner leave there, a little more.
const LESS_BESIDE: f64 = 0.018;

impl<const N: usize> LookAhead<N> {
    fn tolerance(&self, corner: usize) -> f64 {
        let (before, after) = (&self.pulses[corner], &self.pulses[corner + 1]);
        before.tolerance.min(after.tolerance)
    }

    fn shape(&self, pulse: &Pulse<N>) -> Shape {
        let arc = pulse.arc;
        arc.map_or_else(Shape::default, |arc| self.arcs.shape_of(arc))
    }

    /// What may be expected to be allowed at a corner, where another arc may be in its window.
    pub(super) fn allowed(&self, corner: usize, meets_arc: bool) -> f64 {
        let (before, after) = (&self.pulses[corner], &self.pulses[corner + 1]);
        let tolerance = self.tolerance(corner);
        if before.smooth {
            let less = if meets_arc { LESS_BESIDE } else { 0.0 };
            (STEADY_EXCESS - less) * tolerance + self.shape(before).outward
        } else {
            // What is unused is a matter of the chord, which may have more than its neighbour.
            let left = |chord: &Pulse<N>| chord.tolerance - UNUSED * self.shape(chord).sagitta;
            let allowed = left(before).min(left(after)).min(tolerance);
            allowed.max(LEAST_ALLOWED * tolerance)
        }
    }

    /// What is allowed at the corner whose bound was asked for last, and whether that depends on what else is
    /// in its window.
    pub(super) fn room(&self, corner: usize, bound: f64) -> (f64, bool) {
        let (before, after) = (&self.pulses[corner], &self.pulses[corner + 1]);
        let tolerance = self.tolerance(corner);
        let outward = self.shape(before).outward;
        let sagitta = self.shape(before).sagitta.max(self.shape(after).sagitta);
        if sagitta <= 0.0 || bound <= tolerance - sagitta {
            return (tolerance, false);
        }
        let beside = || self.room_beside(corner).min(self.room_beside(corner + 1));
        match before.arc {
            // On one arc, which is no faster than its own tolerance allows, the mean of points no further
            // apart is no further inside.
            Some(arc) if before.smooth && self.schedule.lies_on(&self.pulses, arc) => {
                (f64::INFINITY, false)
            }
            Some(arc) if before.smooth => {
                // Turns of the arc itself lead inside, where the vertex counts against them.
                let inside = self.schedule.contribution_of(&self.pulses, arc);
                let at_vertex = outward.min(2.0 * inside - outward);
                (STEADY_EXCESS * tolerance + at_vertex.min(beside()), true)
            }
            _ => {
                let middle = |index: usize| self.pulses[index].tolerance + self.room_beside(index);
                let allowed = middle(corner).min(middle(corner + 1)).min(tolerance);
                (allowed.max(LEAST_ALLOWED * tolerance), true)
            }
        }
    }

    /// By how much the bound at both ends of a chord may exceed the tolerance for the sake of its middle.
    fn room_beside(&self, index: usize) -> f64 {
        let chord = &self.pulses[index];
        let shape = self.shape(chord);
        if shape.sagitta <= 0.0 {
            return f64::INFINITY;
        }
        let begins_outside = index
            .checked_sub(1)
            .is_some_and(|before| self.pulses[before].smooth);
        let ends = f64::from(u8::from(begins_outside)) + f64::from(u8::from(chord.smooth));
        let inside = shape.sagitta - 0.5 * ends * shape.outward;
        let turn = shape.curvature * chord.length;
        let turning = self.schedule.turning(&self.pulses, turn) / shape.curvature;
        // While the mean goes along the chord, what is on the arc goes less far beside a faster pulse.
        let along = (chord.feed / self.schedule.rate()).min(1.0);
        shape.sagitta * turning.min(1.0) * along * along - inside
    }
}

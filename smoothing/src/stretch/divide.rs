//! Divides the plan on a long leg before anything is known of what follows.
//!
//! Source: ours. On a leg that is long enough every motion, that with full stops too, passes one place at the velocity
//! of the leg. What is before it is decided at once, corner by corner, and what is left of the leg begins the next
//! stretch: so a path of long legs is handed out leg by leg. Not here: how long that is.

use super::Stretches;
use super::choose::{MIN_LEGS, Material, has_arc};
use super::travel::way_in;
use crate::lookahead::corners::room_beside;
use crate::segment::Segment;
use crate::segment_merger::{STRAIGHT_SHARE, Vertex, vertex_of};

/// Shortest first part of a leg, mm: coordinates of the largest machine still tell its ends apart.
const MIN_PART: f64 = 1e-3;

impl<const N: usize> Stretches<N> {
    /// Divides the plan on a leg where it is long enough, and the few legs before it are turned corner by corner for
    /// certain; what is left of it to be planned.
    pub(super) fn divide(&mut self, leg: Segment<N>) -> Segment<N> {
        let certain = self.planned == 0
            && !self.watched
            && self.legs.len() + 1 < MIN_LEGS
            && leg.deviation <= STRAIGHT_SHARE * leg.tolerance.length()
            && leg.bend.is_none()
            && !has_arc(&self.legs);
        if !certain {
            return leg;
        }
        let room = room_beside(&leg, &self.limits).max(MIN_PART);
        if leg.length <= room + room.max(way_in(&leg)) {
            return leg;
        }
        let (first, second) = leg.divided(room);
        let mut legs = std::mem::take(&mut self.legs);
        self.turn(&legs, Material::Vertices);
        legs.clear();
        self.legs = legs;
        self.ahead = 0.0;
        // Nothing bends it.
        self.corners.push_cruising(&first);
        let after = leg.vertices[1];
        let last = after.saturating_sub(1);
        // One vertex stands for all that the leg serves.
        let end = vertex_of(&second);
        self.vertices.replace(last, Vertex { bulge: 0.0, ..end });
        Segment {
            vertices: [last, after],
            ..second
        }
    }
}

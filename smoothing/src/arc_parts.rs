//! Divides arcs into parts that are followed as they are, and parts into chords where corners are turned.
//!
//! Source: ours. A part is a leg of the path like a line, so that what an arc costs does not depend on the tolerance. Not
//! here: what a part is.

use crate::bend::Bend;
use crate::segment_merger::{MERGE_SHARE, Vertex};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use toolglide_kinematics::{Arc, Vector};

/// Most chords of one part of an arc.
pub(crate) const MAX_CHORDS: usize = 256;

/// Shares of a part at which it is compared with the arc, and what the difference may be larger elsewhere.
const COMPARED: [f64; 3] = [0.25, 0.5, 0.75];
const ELSEWHERE: f64 = 1.2;

/// The parts of an arc, in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Parts<const N: usize> {
    arc: Arc<N>,
    count: f64,
    next: f64,
    chords: f64,
}

/// The end of a part of an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part<const N: usize> {
    pub(crate) end: Vector<N>,
    pub(crate) bend: Option<Bend<N>>,
    /// How far the arc lies from it at the most: no more than rounding where its radii are equal.
    pub(crate) off: f64,
}

impl<const N: usize> Parts<N> {
    /// Parts of an eighth of a turn at the most, and of no more chords than they may have within a tolerance.
    #[allow(clippy::cast_precision_loss, reason = "the constant is small")]
    pub(crate) fn new(arc: Arc<N>, tolerance: f64) -> Self {
        let sweep = arc.sweep().abs();
        let chords = sweep / largest_angle(arc.bending(), tolerance);
        let count = (sweep / FRAC_PI_4).max(chords / MAX_CHORDS as f64);
        Self {
            arc,
            count: count.ceil().max(1.0),
            next: 1.0,
            chords: chords.ceil(),
        }
    }

    /// How many chords the whole arc has where it is turned corner by corner.
    pub(crate) fn chords(&self) -> f64 {
        self.chords
    }

    /// The next part.
    pub(crate) fn next(&mut self) -> Option<Part<N>> {
        if self.next > self.count {
            return None;
        }
        let [begin, end] = [self.next - 1.0, self.next].map(|part| part / self.count);
        self.next += 1.0;
        let bend = Bend::of(&self.arc, begin, end);
        let off = match &bend {
            Some(bend) => COMPARED.iter().fold(0.0_f64, |most, share| {
                let point = self.arc.point(begin + share * (end - begin));
                most.max(ELSEWHERE * (bend.point(*share) - point).norm())
            }),
            None => 0.125 * self.arc.bending() * ((end - begin) * self.arc.sweep()).powi(2),
        };
        Some(Part {
            end: self.arc.point(end),
            bend,
            off,
        })
    }
}

/// Largest angle of a chord of an arc that lies off it by the share of a tolerance that merging may use.
fn largest_angle(bending: f64, tolerance: f64) -> f64 {
    (8.0 * MERGE_SHARE * tolerance / bending)
        .sqrt()
        .min(FRAC_PI_2)
}

/// How many chords a part of an arc has within its tolerance; 1 where a vertex ends no such part.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "the count is bounded before it is cast"
)]
pub(crate) fn chords_of<const N: usize>(vertex: &Vertex<N>) -> usize {
    vertex.bend.map_or(1, |bend| {
        let angle = largest_angle(bend.radius(), vertex.tolerance.length());
        // Rounding may ask for one more.
        let most = MAX_CHORDS as f64 + 1.0;
        (bend.angle() / angle).ceil().clamp(1.0, most) as usize
    })
}

/// The vertices at the ends of the chords of a part of an arc; the vertex itself where it ends no such part.
#[allow(clippy::cast_precision_loss, reason = "counts are small")]
pub(crate) fn without_bends<const N: usize>(vertex: Vertex<N>) -> impl Iterator<Item = Vertex<N>> {
    let count = chords_of(&vertex);
    (1..=count).map(move |number| match vertex.bend {
        None => vertex,
        Some(bend) => {
            let angle = bend.angle() / count as f64;
            let point = if number == count {
                vertex.point
            } else {
                bend.point(number as f64 / count as f64)
            };
            Vertex {
                point,
                bulge: vertex.bulge + 0.125 * angle * angle * bend.radius(),
                bend: None,
                ..vertex
            }
        }
    })
}

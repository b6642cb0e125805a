//! Finds the fastest of other ways to travel a section from rest to rest than stretch by stretch.
//!
//! Source: ours. They are one kind of corner throughout, and all legs superposed in many ways, as they are and
//! merged with more of the tolerance. How much is tried depends on how many vertices came since, so that the work
//! for a vertex has a bound on average, and so has that for a section. Not here: when a section ends.

use crate::lookahead::corners::Corners;
use crate::method::{Method, Settings};
use crate::segment::Segment;
use crate::segment_merger::{SegmentMerger, Vertex, vertex_of};
use crate::short_segments::Effort;
use crate::stretch::{Stretches, is_tiny};
use toolglide_kinematics::{Piece, Vector};

/// Kinds of corners that are tried throughout, each for sections of so many vertices at the most: those that
/// overlap cost the most.
const KINDS: [(Method, usize); 3] = [
    (Method::KcsInterrupted, 512),
    (Method::KcsUninterrupted, 128),
    (Method::KcsGlobal, 32),
];

/// Share of the tolerance with which legs are merged further.
const COARSE_SHARE: f64 = 0.3;

/// Pieces of superposed motion that may be judged for a section at the most, and how many more for each vertex.
const MAX_EFFORT: usize = 12_000;
const EFFORT: usize = 16;

/// Share of the tolerance within which corners are passed in their turn.
const ORDER_SHARE: f64 = 0.999;

/// Fewest legs worth superposing.
const MIN_LEGS: usize = 2;

/// What other ways are planned with.
#[derive(Clone, Debug)]
pub(super) struct Ways<const N: usize> {
    kinds: [Corners<N>; KINDS.len()],
    merger: SegmentMerger<N>,
    coarse: Vec<Segment<N>>,
    effort: usize,
    /// The kind that was found the fastest; `None` for superposed motion.
    fastest: Option<usize>,
}

impl<const N: usize> Ways<N> {
    pub(super) fn new(start: Vector<N>, settings: &Settings<N>) -> Self {
        Self {
            kinds: KINDS.map(|(method, most)| {
                let settings = settings.with_method(method);
                Corners::new(start, &settings, None, most + 2)
            }),
            merger: SegmentMerger::new(start, settings.limits, COARSE_SHARE),
            coarse: Vec::with_capacity(super::MAX_HELD + 2),
            effort: MAX_EFFORT,
            fastest: None,
        }
    }

    /// Finds the fastest way for a section from a start in less than `most` seconds; whether there is one, which is
    /// pulled next.
    pub(super) fn find(
        &mut self,
        stretches: &mut Stretches<N>,
        start: Vector<N>,
        legs: &[Segment<N>],
        vertices: &[Vertex<N>],
        most: f64,
    ) -> bool {
        self.effort = MAX_EFFORT.min(self.effort + EFFORT * vertices.len());
        // Arcs are followed as they are, unless they are tiny.
        let round = legs.iter().any(|leg| leg.bend.is_some() && !is_tiny(leg));
        if legs.len() < MIN_LEGS || round {
            return false;
        }
        let mut least = most;
        self.fastest = None;
        for (index, ((_, most), corners)) in KINDS.iter().zip(&mut self.kinds).enumerate() {
            if vertices.len() > *most {
                continue;
            }
            corners.restart(start);
            for vertex in vertices {
                corners.push(*vertex);
            }
            corners.close();
            if corners.duration() < least {
                (self.fastest, least) = (Some(index), corners.duration());
            }
        }
        let by_kind = least < most;
        self.coarsen(start, legs);
        let all = self.effort;
        let ways = all / 4;
        // Pulses are for few legs.
        let pulses = if self.coarse.is_empty() {
            all - ways
        } else {
            0
        };
        let (fine, left) = stretches.superpose_whole(legs, least, Effort { ways, pulses });
        self.effort = all - ways - pulses + left;
        let least = fine.unwrap_or(least);
        let mut coarse = None;
        if !self.coarse.is_empty() {
            let effort = Effort {
                ways,
                pulses: self.effort - ways,
            };
            (coarse, self.effort) = stretches.superpose_whole(&self.coarse, least, effort);
        }
        // Corners that were merged must be passed in their turn, too.
        let corners = vertices.windows(2).map(|pair| {
            let tolerance = pair[0].tolerance.min(pair[1].tolerance);
            (
                pair[0].point,
                ORDER_SHARE * tolerance.length(),
                pair[0].serves.last,
            )
        });
        let superposed = (coarse.is_some() || fine.is_some()) && stretches.whole_passes(corners);
        if superposed {
            self.fastest = None;
            stretches.travel_whole();
        }
        superposed || by_kind
    }

    /// Merges legs with more of the tolerance; none where that merges nothing.
    fn coarsen(&mut self, start: Vector<N>, legs: &[Segment<N>]) {
        let Self { merger, coarse, .. } = self;
        coarse.clear();
        merger.restart(start);
        for leg in legs {
            coarse.extend(merger.push(vertex_of(leg)));
        }
        coarse.extend(merger.flush());
        if merger.take_carried().is_some() || coarse.len() == legs.len() {
            coarse.clear();
        }
    }

    /// Legs that have been joined in corners.
    pub(super) fn joined(&self) -> u64 {
        self.kinds.iter().map(Corners::joined).sum()
    }

    /// The next piece of what was found.
    pub(super) fn pull(&mut self, stretches: &mut Stretches<N>) -> Option<Piece<N>> {
        match self.fastest {
            Some(index) => self.kinds[index].pull(),
            None => stretches.pull(),
        }
    }
}

//! Stores the vertices of segments that may still be planned corner by corner.
//!
//! Source: ours. Corners have more of the tolerance to merge with than fine stretches have, and merge
//! best what has not been merged before. Arcs are chords to them. Not here: either merging.

use crate::arc_parts::{chords_of, without_bends};
use crate::segment::Segment;
use crate::segment_merger::Vertex;
use std::collections::VecDeque;
use std::collections::vec_deque::Iter;
use std::iter::Copied;

/// The latest vertices of the path, found by their numbers.
#[derive(Clone, Debug)]
pub(super) struct Vertices<const N: usize> {
    queue: VecDeque<Vertex<N>>,
    /// Number of the first that is kept.
    first: u64,
}

impl<const N: usize> Vertices<N> {
    pub(super) fn with_capacity(count: usize) -> Self {
        Self {
            queue: VecDeque::with_capacity(count),
            first: 0,
        }
    }

    /// Takes the next vertex; the number of the one after it.
    pub(super) fn push(&mut self, vertex: Vertex<N>) -> u64 {
        self.queue.push_back(vertex);
        self.first + self.queue.len() as u64
    }

    /// Puts a vertex in the place of the one of a number.
    pub(super) fn replace(&mut self, number: u64, vertex: Vertex<N>) {
        let place = self.place(number);
        if let Some(kept) = self.queue.get_mut(place) {
            *kept = vertex;
        }
    }

    /// The vertices of consecutive legs, those of chords where arcs bend.
    pub(super) fn of(&self, legs: &[Segment<N>]) -> impl Iterator<Item = Vertex<N>> + '_ {
        self.kept(legs).flat_map(without_bends)
    }

    /// How many these are.
    pub(super) fn count(&self, legs: &[Segment<N>]) -> usize {
        self.kept(legs).map(|vertex| chords_of(&vertex)).sum()
    }

    /// How many of these are chords of arcs.
    pub(super) fn chords(&self, legs: &[Segment<N>]) -> usize {
        let vertices = self.kept(legs).filter(|vertex| vertex.bend.is_some());
        vertices.map(|vertex| chords_of(&vertex)).sum()
    }

    fn kept(&self, legs: &[Segment<N>]) -> Copied<Iter<'_, Vertex<N>>> {
        let range = match legs {
            [first, .., last] => self.place(first.vertices[0])..self.place(last.vertices[1]),
            [only] => self.place(only.vertices[0])..self.place(only.vertices[1]),
            [] => 0..0,
        };
        self.queue.range(range).copied()
    }

    /// Forgets the vertices before a number.
    pub(super) fn forget_before(&mut self, number: u64) {
        let count = self.place(number);
        if count > 0 {
            self.queue.drain(..count);
            self.first = number;
        }
    }

    fn place(&self, number: u64) -> usize {
        usize::try_from(number.saturating_sub(self.first))
            .map_or(self.queue.len(), |place| place.min(self.queue.len()))
    }
}

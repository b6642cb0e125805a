//! Keeps the arcs that pulses belong to, each with its largest feedrate.
//!
//! Source: none; many pulses share one arc. Not here: how that is found, see the bend.

use crate::chords::Shape;
use crate::filter::cubic::CubicChain;
use crate::lookahead::arc_feed::ArcFeed;
use alloc::collections::VecDeque;
use toolglide_kinematics::Vector;

#[derive(Clone, Copy, Debug)]
struct Entry<const N: usize> {
    bend: ArcFeed<N>,
    shape: Shape,
    feedrate: f64,
    /// Largest feedrate behind the chain in use.
    pace: f64,
}

/// Arcs by number.
#[derive(Clone, Debug)]
pub(crate) struct Arcs<const N: usize> {
    /// Number of the first one that is kept.
    first: u32,
    entries: VecDeque<Entry<N>>,
}

impl<const N: usize> Arcs<N> {
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        Self {
            first: 0,
            entries: VecDeque::with_capacity(capacity),
        }
    }

    /// Keeps an arc and gives its number.
    pub(crate) fn push(
        &mut self,
        (bend, shape): (ArcFeed<N>, Shape),
        feedrate: f64,
        chain: &CubicChain,
        change: &Vector<N>,
    ) -> u32 {
        if self.entries.len() == self.entries.capacity() {
            // Only the latest arcs are still in a window.
            self.entries.pop_front();
            self.first += 1;
        }
        let pace = bend.pace(feedrate, chain, change);
        self.entries.push_back(Entry {
            bend,
            shape,
            feedrate,
            pace,
        });
        self.first
            .wrapping_add(u32::try_from(self.entries.len() - 1).unwrap_or(0))
    }

    /// Drops the arcs before a number.
    pub(crate) fn forget_before(&mut self, number: u32) {
        while self.first < number && self.entries.pop_front().is_some() {
            self.first += 1;
        }
    }

    /// Other filters are in use.
    pub(crate) fn pace(&mut self, chain: &CubicChain, change: &Vector<N>) {
        for entry in &mut self.entries {
            entry.pace = entry.bend.pace(entry.feedrate, chain, change);
        }
    }

    /// How fast an arc may be followed.
    pub(crate) fn pace_of(&self, number: u32) -> f64 {
        self.entry(number).pace
    }

    /// Largest turn between chords of an arc but the first and the last.
    pub(crate) fn turn_of(&self, number: u32) -> f64 {
        self.entry(number).bend.turn()
    }

    /// How the chords of an arc lie beside it.
    pub(crate) fn shape_of(&self, number: u32) -> Shape {
        self.entry(number).shape
    }

    fn entry(&self, number: u32) -> &Entry<N> {
        &self.entries[usize::try_from(number - self.first).unwrap_or(0)]
    }
}

//! Keeps the moves that the judge still needs, in order.
//!
//! Source: moves are forgotten once the motion has gone past them. Not here: when that is.

use std::collections::VecDeque;

use crate::path::leg::Leg;
use toolglide_kinematics::ToolpathError;
use toolglide_kinematics::Vector;
use toolglide_kinematics::vector::is_finite;
use toolglide_kinematics::{Move, check_contact};

/// A window of legs, counted from the start of the path.
#[derive(Clone, Debug)]
pub(crate) struct Route<const N: usize> {
    legs: VecDeque<Leg<N>>,
    base: u32,
    end: Vector<N>,
    pub(crate) length: f64,
}

impl<const N: usize> Route<N> {
    pub(crate) fn new(start: Vector<N>) -> Self {
        Self {
            legs: VecDeque::new(),
            base: 0,
            end: start,
            length: 0.0,
        }
    }

    /// Appends a move.
    pub(crate) fn expect(&mut self, next: &Move<N>) -> Result<(), ToolpathError> {
        check_contact(next, self.end)?;
        let leg = Leg::new(next, self.end, self.len());
        if !is_finite(&leg.end) || !leg.length.is_finite() {
            return Err(ToolpathError::NotFinite);
        }
        if let Some(before) = self.legs.back_mut() {
            before.meets(&leg);
        }
        self.end = leg.end;
        self.length += leg.length;
        self.legs.push_back(leg);
        Ok(())
    }

    /// Number of the first move that is still known.
    pub(crate) fn base(&self) -> u32 {
        self.base
    }

    /// How many moves the path has so far, the forgotten ones included.
    pub(crate) fn len(&self) -> u32 {
        let kept = u32::try_from(self.legs.len()).unwrap_or(u32::MAX);
        self.base.saturating_add(kept)
    }

    /// Where the path ends so far.
    pub(crate) fn end(&self) -> Vector<N> {
        self.end
    }

    fn index(&self, mv: u32) -> Option<usize> {
        usize::try_from(mv.checked_sub(self.base)?).ok()
    }

    pub(crate) fn get(&self, mv: u32) -> Option<&Leg<N>> {
        self.legs.get(self.index(mv)?)
    }

    pub(crate) fn get_mut(&mut self, mv: u32) -> Option<&mut Leg<N>> {
        let index = self.index(mv)?;
        self.legs.get_mut(index)
    }

    /// The legs of a range of moves, ends included, with their numbers.
    pub(crate) fn range(&self, first: u32, last: u32) -> impl Iterator<Item = &Leg<N>> {
        let from = self.index(first).unwrap_or(0).min(self.legs.len());
        let to = self
            .index(last)
            .map_or(0, |index| index.saturating_add(1))
            .clamp(from, self.legs.len());
        self.legs.range(from..to)
    }

    /// Forgets the first move.
    pub(crate) fn forget_first(&mut self) -> Option<Leg<N>> {
        let leg = self.legs.pop_front()?;
        self.base = self.base.saturating_add(1);
        Some(leg)
    }
}

//! Samples a long program: windows of moves, evenly spread, in bounded memory.
//!
//! Source: the optimum of a whole program is out of reach, so some windows of it are scored, each as
//! a program of its own, from rest to rest. A program that is short enough is one window. Not here:
//! scores.

use crate::sections::{Section, Sections};
use toolglide_kinematics::{Limits, Move, PlanError, Vector};

/// Legs of a program up to which it is one window.
pub const WHOLE: usize = 256;

/// Legs of a window of a longer program, at least.
pub const WINDOW: usize = 48;

/// Windows that are kept at least, once there were more of them.
const FEWEST: usize = 6;

/// Consecutive moves of a program.
#[derive(Clone, Debug, PartialEq)]
pub struct Window<const N: usize> {
    /// Where they start.
    pub start: Vector<N>,
    /// The moves.
    pub moves: Vec<Move<N>>,
    /// How many legs they have.
    pub legs: usize,
}

/// Takes a program move by move and keeps a sample of its windows.
#[derive(Clone, Debug)]
pub struct Windows<const N: usize> {
    sections: Sections<N>,
    position: Vector<N>,
    open: Window<N>,
    kept: Vec<Window<N>>,
    /// Legs seen.
    legs: u64,
    /// Windows closed.
    closed: u64,
    /// Every so many windows one is kept.
    stride: u64,
}

/// What was kept of a program.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled<const N: usize> {
    /// The windows, in order.
    pub windows: Vec<Window<N>>,
    /// Legs of the whole program.
    pub legs: u64,
    /// Whether the windows are the whole program.
    pub whole: bool,
}

impl<const N: usize> Windows<N> {
    /// No moves yet, at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, limits: Limits<N>) -> Self {
        Self {
            sections: Sections::new(start, limits),
            position: start,
            open: Self::window(start),
            kept: Vec::new(),
            legs: 0,
            closed: 0,
            stride: 1,
        }
    }

    fn window(start: Vector<N>) -> Window<N> {
        Window {
            start,
            moves: Vec::new(),
            legs: 0,
        }
    }

    /// Takes the next move.
    ///
    /// # Errors
    /// As [`Sections::push`].
    pub fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let done = self.sections.push(next)?;
        // Cut after every move, the sections count the legs of this one.
        let legs = done
            .iter()
            .flatten()
            .chain(self.sections.cut().as_ref())
            .map(|section| match section {
                Section::Course(course) => course.legs(),
                Section::Rest { .. } => 0,
            })
            .sum::<usize>();
        self.position = next.end(self.position);
        self.open.moves.push(*next);
        self.open.legs += legs;
        self.legs += legs as u64;
        if self.open.legs >= WINDOW {
            self.close();
        }
        Ok(())
    }

    fn close(&mut self) {
        let next = Self::window(self.position);
        let window = std::mem::replace(&mut self.open, next);
        if self.closed.is_multiple_of(self.stride) {
            self.kept.push(window);
        }
        self.closed += 1;
        if self.legs > WHOLE as u64 && self.kept.len() >= 2 * FEWEST {
            let mut keep = false;
            self.kept.retain(|_| {
                keep = !keep;
                keep
            });
            self.stride *= 2;
        }
    }

    /// The sample; no move follows.
    #[must_use]
    pub fn finish(mut self) -> Sampled<N> {
        let whole = self.legs <= WHOLE as u64;
        if whole {
            let start = self
                .kept
                .first()
                .map_or(self.open.start, |first| first.start);
            let mut all = Self::window(start);
            self.kept.push(self.open);
            for window in self.kept {
                all.moves.extend(window.moves);
                all.legs += window.legs;
            }
            self.kept = vec![all];
        }
        Sampled {
            windows: self.kept,
            legs: self.legs,
            whole,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{Feedrate, Tolerance};

    fn sampled(count: u32) -> Sampled<1> {
        let limits = Limits::uniform(1.0, 1.0, 1.0).unwrap();
        let mut windows = Windows::new(Vector::<1>::zeros(), limits);
        for index in 1..=count {
            let end = Vector::<1>::new(f64::from(index));
            let next = Move::line_to(end, Feedrate::RAPID, Tolerance::new(0.1).unwrap()).unwrap();
            windows.push(&next.from_line(index)).unwrap();
        }
        windows.finish()
    }

    #[test]
    fn a_short_program_is_one_window() {
        let sampled = sampled(200);
        assert!(sampled.whole, "200 legs");
        assert_eq!(sampled.windows.len(), 1);
        assert_eq!(sampled.windows[0].moves.len(), 200);
    }

    #[test]
    fn a_long_program_is_sampled_evenly_whatever_its_length() {
        for count in [300, 5_000, 100_000] {
            let sampled = sampled(count);
            assert!(!sampled.whole, "{count}");
            assert!(sampled.windows.len() <= 2 * FEWEST, "{count}");
            let starts: Vec<u32> = sampled
                .windows
                .iter()
                .map(|window| window.moves[0].line())
                .collect();
            let steps: Vec<u32> = starts.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert!(
                steps.iter().all(|&step| step == steps[0]),
                "{count}: {starts:?}"
            );
            for window in &sampled.windows {
                assert_eq!(window.legs, WINDOW);
                let before = f64::from(window.moves[0].line() - 1);
                assert!((window.start.x - before).abs() < 1e-12, "{count}");
            }
        }
    }
}

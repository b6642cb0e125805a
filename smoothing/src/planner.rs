//! Moves in, motion out: the stages of kinematic corner smoothing in a row.
//!
//! Source: chapter 3. Moves become straight vertices, vertices merge into legs, legs meet in corners,
//! windows scale a motion for each corner, the lattice chooses among them, and the chosen ones are
//! unrolled into pieces when they are asked for. Not here: any formula.

use crate::chords::Chords;
use crate::lattice::{Lattice, MOST_CANDIDATES};
use crate::leg::{Dwell, Leg};
use crate::merge::{Merger, Vertex};
use crate::method::{Method, Settings};
use crate::pieces::{MOST_PIECES, corner_between, rest_at, unroll_corner, unroll_leg};
use crate::select::Selection;
use crate::turn::TurnShape;
use crate::window::{Link, Window};
use std::collections::VecDeque;
use toolglide_kinematics::{
    MotionPlanner, Move, Path, Piece, Plan, PlanError, Serves, Tolerance, Toolpath, Vector,
    check_contact,
};

/// Plans kinematic corner smoothing while the path is being read.
///
/// After construction nothing is allocated as long as the pieces are pulled after each push.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Feedrate, Limits, Tolerance, Toolpath, Trajectory, Vector};
/// use toolglide_smoothing::{Settings, plan};
/// let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
/// let path = Toolpath::from_points(&corner, Feedrate::new(100.0)?, Tolerance::new(0.1)?)?;
/// let motion = plan(&path, &Settings::new(Limits::uniform(500.0, 2500.0, 2e5)?))?;
/// // Stopping at the corner would take 0.305 s.
/// assert!((motion.duration() - 0.290).abs() < 1e-4);
/// assert_eq!(motion.end(), path.end());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct KinematicSmoothing<const N: usize> {
    position: Vector<N>,
    index: u32,
    finished: bool,
    arc: Option<(Chords<N>, Move<N>, u32)>,
    merger: Merger<N>,
    /// The last leg, whose end is still open.
    pending: Option<Leg<N>>,
    selections: Vec<Selection<N>>,
    windows: Vec<Window>,
    scaled: Vec<VecDeque<TurnShape>>,
    stops_allowed: bool,
    lattice: Lattice,
    /// Legs that have not been unrolled; the first `offered` of them are in the lattice.
    legs: VecDeque<Leg<N>>,
    offered: usize,
    /// How the next leg to be unrolled begins.
    from: TurnShape,
    pieces: VecDeque<Piece<N>>,
}

impl<const N: usize> KinematicSmoothing<N> {
    /// A planner whose motion begins at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, settings: &Settings<N>) -> Self {
        let size = settings.window.max(1);
        let selections = Selection::of(settings);
        let windows: Vec<_> = selections
            .iter()
            .map(|selection| Window::new(size, selection.is_balanced()))
            .collect();
        Self {
            position: start,
            index: 0,
            finished: false,
            arc: None,
            merger: Merger::new(start, settings.limits),
            pending: None,
            scaled: windows
                .iter()
                .map(|_| VecDeque::with_capacity(2 * size + 4))
                .collect(),
            windows,
            selections,
            stops_allowed: matches!(settings.method, Method::Kcs | Method::ExactStop),
            lattice: Lattice::new(size),
            legs: VecDeque::with_capacity(3 * size + 8),
            offered: 0,
            from: TurnShape::STOP,
            pieces: VecDeque::with_capacity(MOST_PIECES + 1),
        }
    }

    /// Takes the next chord of the arc under way; `false` when there is none.
    fn advance_arc(&mut self) -> bool {
        let Some((chords, step, index)) = &mut self.arc else {
            return false;
        };
        let (step, index, bulge) = (*step, *index, chords.bulge());
        match chords.next() {
            Some(point) => self.take_point(&step, index, point, bulge),
            None => {
                self.arc = None;
                if step.stops() {
                    self.rest();
                }
                if self.finished {
                    self.close();
                }
            }
        }
        true
    }

    fn take_point(&mut self, step: &Move<N>, index: u32, point: Vector<N>, bulge: f64) {
        let leg = self.merger.push(Vertex {
            point,
            bulge,
            feedrate: step.feedrate().speed(),
            tolerance: step.tolerance(),
            serves: Serves {
                first: index,
                last: index,
            },
        });
        if let Some(leg) = leg {
            self.take_leg(leg);
        }
    }

    /// The motion must rest where the path has come to.
    fn rest(&mut self) {
        if let Some(leg) = self.merger.flush() {
            self.take_leg(leg);
        }
        if let Some(last) = &mut self.pending {
            last.stop = true;
        }
    }

    fn dwell(&mut self, duration: f64, index: u32) {
        self.rest();
        let pause = Dwell {
            duration,
            serves: Serves {
                first: index,
                last: index,
            },
            end: self.position,
        };
        let pause = match self.merger.take_carried() {
            Some(carried) => carried.then(pause),
            None => pause,
        };
        self.pause(pause);
    }

    fn pause(&mut self, pause: Dwell<N>) {
        match &mut self.pending {
            Some(last) => {
                last.dwell = Some(match last.dwell {
                    Some(before) => before.then(pause),
                    None => pause,
                });
            }
            None => self.pieces.push_back(pause.piece(self.merger.anchor())),
        }
    }

    /// Takes a leg, which completes the corner at its start.
    fn take_leg(&mut self, leg: Leg<N>) {
        let link = link_of(&leg);
        match self.pending.replace(leg) {
            None => {
                for window in &mut self.windows {
                    window.begin(link);
                }
            }
            Some(last) => {
                let corner = corner_between(&last, &leg, corner_tolerance(&last, &leg));
                for (selection, window) in self.selections.iter().zip(&mut self.windows) {
                    let shape = if last.stop {
                        TurnShape::STOP
                    } else {
                        selection.shape(&corner, last.length, leg.length)
                    };
                    window.push(shape, link);
                }
                self.legs.push_back(last);
                self.offer();
            }
        }
    }

    /// Hands corners to the lattice that all windows have scaled.
    fn offer(&mut self) {
        for (window, scaled) in self.windows.iter_mut().zip(&mut self.scaled) {
            while let Some(shape) = window.pull() {
                scaled.push_back(shape);
            }
        }
        while self.offered < self.legs.len() && self.scaled.iter().all(|queue| !queue.is_empty()) {
            let mut candidates = [TurnShape::STOP; MOST_CANDIDATES];
            let mut count = 0;
            let leg = &self.legs[self.offered];
            for queue in &mut self.scaled {
                if let Some(shape) = queue.pop_front() {
                    candidates[count] = shape;
                    count += 1;
                }
            }
            if leg.stop {
                count = 0;
            }
            if self.stops_allowed || leg.stop {
                candidates[count] = TurnShape::STOP;
                count += 1;
            }
            let link = link_of(leg);
            self.lattice.push(&link, &candidates[..count]);
            self.offered += 1;
        }
    }

    /// Brings the motion to rest at the end of the last leg.
    fn close(&mut self) {
        self.rest();
        if let Some(carried) = self.merger.take_carried() {
            self.pause(carried);
        }
        for window in &mut self.windows {
            window.finish();
        }
        self.offer();
        if let Some(last) = self.pending.take() {
            let link = link_of(&last);
            self.legs.push_back(last);
            self.lattice.push(&link, &[TurnShape::STOP]);
            self.offered += 1;
            self.lattice.finish();
        }
    }

    /// Unrolls the next leg and the corner at its end.
    fn unroll(&mut self, to: &TurnShape) {
        let Some(leg) = self.legs.pop_front() else {
            return;
        };
        self.offered -= 1;
        let pieces = &mut self.pieces;
        unroll_leg(&leg, &self.from, to, |piece| pieces.push_back(piece));
        if let Some(pause) = leg.dwell {
            pieces.push_back(pause.piece(rest_at(&leg)));
        }
        if let Some(next) = self.legs.front().or(self.pending.as_ref()) {
            let corner = corner_between(&leg, next, corner_tolerance(&leg, next));
            unroll_corner(to, corner, &leg, next, |piece| pieces.push_back(piece));
        }
        self.from = *to;
    }
}

impl<const N: usize> MotionPlanner<N> for KinematicSmoothing<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let index = self.index;
        if self.finished {
            return Err(PlanError::Finished { index });
        }
        check_contact(next, self.position).map_err(|reason| PlanError::Path { index, reason })?;
        self.index = index.checked_add(1).ok_or(PlanError::TooMany { index })?;
        while self.advance_arc() {}
        self.position = next.end(self.position);
        match next.path() {
            Path::Line { end } => {
                self.take_point(next, index, *end, 0.0);
                if next.stops() {
                    self.rest();
                }
            }
            Path::Arc(arc) => {
                let chords = Chords::new(*arc, next.tolerance().length());
                self.arc = Some((chords, *next, index));
            }
            Path::Dwell { duration } => self.dwell(*duration, index),
            _ => {}
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        if !self.finished {
            self.finished = true;
            if self.arc.is_none() {
                self.close();
            }
        }
        Ok(())
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            if let Some(piece) = self.pieces.pop_front() {
                return Some(piece);
            }
            if let Some(shape) = self.lattice.pull() {
                self.unroll(&shape);
            } else if !self.advance_arc() {
                return None;
            }
        }
    }
}

/// Plans a whole toolpath: a loop over the streaming planner.
///
/// # Errors
/// As [`MotionPlanner::push`].
pub fn plan<const N: usize>(
    path: &Toolpath<N>,
    settings: &Settings<N>,
) -> Result<Plan<N>, PlanError> {
    let mut planner = KinematicSmoothing::new(path.start(), settings);
    let mut plan = Plan::starting_at(path.start());
    for step in path.moves() {
        planner.push(step)?;
        while let Some(piece) = planner.pull() {
            plan.push(piece);
        }
    }
    planner.finish()?;
    while let Some(piece) = planner.pull() {
        plan.push(piece);
    }
    Ok(plan)
}

fn link_of<const N: usize>(leg: &Leg<N>) -> Link {
    Link {
        length: leg.length,
        limits: leg.limits,
    }
}

/// The tolerance of the corner between two legs: what merging has left of both.
fn corner_tolerance<const N: usize>(leg: &Leg<N>, next: &Leg<N>) -> Tolerance {
    leg.tolerance.min(next.tolerance)
}

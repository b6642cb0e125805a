//! Runs the stages of kinematic corner smoothing, from moves to pieces.
//!
//! Source: chapter 3. Moves become straight vertices; stretches of fine moves may be travelled with
//! superposed corners, everything else corner by corner. Not here: any formula.

use crate::chords::Chords;
use crate::lookahead::corners::Corners;
use crate::method::{Method, Settings};
use crate::section::Sections;
use crate::segment_merger::Vertex;
use crate::stretch::{LONGEST_ARC, Stretches};
use toolglide_kinematics::{
    Arc, MotionPlanner, Move, MoveRange, Path, PathCursor, Pause, Piece, Plan, PlanError, Toolpath,
    Vector,
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
/// assert!((motion.duration() - 0.2793).abs() < 1e-4);
/// assert_eq!(motion.end(), path.end());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct KinematicSmoothing<const N: usize> {
    intake: PathCursor<N>,
    stops: bool,
    arc: Option<(Chords<N>, Move<N>, u32)>,
    route: Route<N>,
}

/// How vertices become motion.
#[derive(Clone, Debug)]
enum Route<const N: usize> {
    Corners(Box<Corners<N>>),
    Stretches(Box<Stretches<N>>),
    Sections(Box<Sections<N>>),
}

impl<const N: usize> KinematicSmoothing<N> {
    /// A planner whose motion begins at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, settings: &Settings<N>) -> Self {
        Self {
            intake: PathCursor::new(start),
            stops: settings.method == Method::ExactStop,
            arc: None,
            route: match settings.method {
                Method::Kcs => Route::Sections(Box::new(Sections::new(start, settings))),
                Method::ExactStop => Route::Stretches(Box::new(Stretches::new(start, settings))),
                _ => Route::Corners(Box::new(Corners::new(start, settings, 1))),
            },
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
                let alone = self.route.takes_alone(chords);
                self.arc = None;
                self.route.end_arc();
                if alone || self.stops || step.stops() {
                    self.route.rest();
                }
                if self.intake.is_closed() {
                    self.route.close();
                }
            }
        }
        true
    }

    fn take_point(&mut self, step: &Move<N>, index: u32, point: Vector<N>, bulge: f64) {
        self.route.push(vertex_of(step, index, point, bulge));
    }
}

fn vertex_of<const N: usize>(
    step: &Move<N>,
    index: u32,
    point: Vector<N>,
    bulge: f64,
) -> Vertex<N> {
    Vertex {
        point,
        bulge,
        feedrate: step.feedrate().speed(),
        tolerance: step.tolerance(),
        serves: MoveRange::one(index),
        next: 0,
    }
}

impl<const N: usize> Route<N> {
    fn push(&mut self, vertex: Vertex<N>) {
        match self {
            Self::Corners(corners) => corners.push(vertex),
            Self::Stretches(stretches) => stretches.push(vertex),
            Self::Sections(sections) => sections.push(vertex),
        }
    }

    fn rest(&mut self) {
        match self {
            Self::Corners(corners) => corners.rest(),
            Self::Stretches(stretches) => stretches.rest(),
            Self::Sections(sections) => sections.rest(),
        }
    }

    /// Whether an arc is so long that it is taken from rest to rest.
    fn takes_alone(&self, chords: &Chords<N>) -> bool {
        match self {
            Self::Corners(_) => false,
            _ => chords.count() > LONGEST_ARC as f64,
        }
    }

    /// An arc begins, and may be taken with what is beside it.
    fn begin_arc(&mut self, arc: &Arc<N>, step: &Move<N>, index: u32) {
        let tolerance = step.tolerance();
        let mut chords = Chords::new(
            *arc,
            crate::segment_merger::MERGE_SHARE * tolerance.length(),
        );
        let bulge = chords.bulge();
        let points = std::iter::from_fn(|| chords.next());
        let vertices = points.map(|point| vertex_of(step, index, point, bulge));
        match self {
            Self::Corners(_) => {}
            Self::Stretches(stretches) => stretches.begin_arc(tolerance, vertices),
            Self::Sections(sections) => sections.begin_arc(tolerance, vertices),
        }
    }

    /// The arc has ended.
    fn end_arc(&mut self) {
        match self {
            Self::Corners(_) => {}
            Self::Stretches(stretches) => stretches.end_arc(),
            Self::Sections(sections) => sections.end_arc(),
        }
    }

    fn dwell(&mut self, pause: Pause<N>) {
        match self {
            Self::Corners(corners) => corners.dwell(pause),
            Self::Stretches(stretches) => stretches.dwell(pause),
            Self::Sections(sections) => sections.dwell(pause),
        }
    }

    fn close(&mut self) {
        match self {
            Self::Corners(corners) => corners.close(),
            Self::Stretches(stretches) => stretches.close(),
            Self::Sections(sections) => sections.close(),
        }
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        match self {
            Self::Corners(corners) => corners.pull(),
            Self::Stretches(stretches) => stretches.pull(),
            Self::Sections(sections) => sections.pull(),
        }
    }

    /// The chords of an arc.
    fn chords_of(&self, arc: &Arc<N>, tolerance: f64) -> Chords<N> {
        match self {
            Self::Corners(_) => Chords::new(*arc, crate::segment_merger::MERGE_SHARE * tolerance),
            _ => Chords::fine(*arc, crate::stretch::FINE_SHARE * tolerance),
        }
    }
}

impl<const N: usize> MotionPlanner<N> for KinematicSmoothing<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let index = self.intake.take(next)?;
        while self.advance_arc() {}
        match next.path() {
            Path::Line { end } => {
                self.take_point(next, index, *end, 0.0);
                if self.stops || next.stops() {
                    self.route.rest();
                }
            }
            Path::Arc(arc) => {
                let chords = self.route.chords_of(arc, next.tolerance().length());
                if self.route.takes_alone(&chords) {
                    self.route.rest();
                } else {
                    self.route.begin_arc(arc, next, index);
                }
                self.arc = Some((chords, *next, index));
            }
            Path::Dwell { duration } => {
                self.route.dwell(Pause {
                    duration: *duration,
                    serves: MoveRange::one(index),
                    end: self.intake.end(),
                });
            }
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        if self.intake.close() && self.arc.is_none() {
            self.route.close();
        }
        Ok(())
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            if let Some(piece) = self.route.pull() {
                return Some(piece);
            }
            if !self.advance_arc() {
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
    Plan::of(path, &mut KinematicSmoothing::new(path.start(), settings))
}

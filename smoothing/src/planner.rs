//! Runs the stages of kinematic corner smoothing, from moves to pieces.
//!
//! Source: chapter 3. Moves become straight vertices; stretches of fine moves may be travelled with
//! superposed corners, as are arcs, everything else corner by corner. Not here: any formula.

use crate::arc_parts::{Part, Parts, without_bends};
use crate::corner::candidates::Blenders;
use crate::lookahead::corners::Corners;
use crate::method::{Method, Settings};
use crate::section::Sections;
use crate::segment_merger::Vertex;
use crate::stretch::{LONGEST_ARC, Stretches};
use crate::work::Work;
use std::sync::Arc;
use toolglide_kinematics::{
    MotionPlanner, Move, MoveRange, Path, PathCursor, Pause, Piece, Plan, PlanError, Tolerance,
    Toolpath, Vector,
};
use toolglide_profiles::Blender;

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
    arc: Option<(Parts<N>, Move<N>, u32)>,
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
        Self::planning(start, settings, None)
    }

    /// A planner that takes the fastest motion of these blenders at every corner, in place of those of
    /// its method ([`Settings::blenders`]); it stops where none of them has one.
    ///
    /// [`Method::Kcs`] still compares that with corners of one kind throughout and with short-segment
    /// smoothing. A method that forces one kind, as [`Method::KcsInterrupted`], has no other corners
    /// than those of `blenders`.
    ///
    /// # Examples
    /// ```
    /// use std::sync::Arc;
    /// use toolglide_kinematics::{Feedrate, Limits, Plan, Tolerance, Toolpath, Trajectory, Vector};
    /// use toolglide_smoothing::{KinematicSmoothing, Method, Settings, StopStart};
    /// let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
    /// let path = Toolpath::from_points(&corner, Feedrate::new(100.0)?, Tolerance::new(0.1)?)?;
    /// let limits = Limits::uniform(500.0, 2500.0, 2e5)?;
    /// let settings = Settings::new(limits).with_method(Method::KcsInterrupted);
    /// let interrupted = Plan::of(&path, &mut KinematicSmoothing::new(path.start(), &settings))?;
    /// let mut blenders = settings.blenders();
    /// blenders.push(Arc::new(StopStart::new(limits)));
    /// let mut planner = KinematicSmoothing::with_blenders(path.start(), &settings, blenders);
    /// assert!(Plan::of(&path, &mut planner)?.duration() < interrupted.duration());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_blenders(
        start: Vector<N>,
        settings: &Settings<N>,
        blenders: Vec<Arc<dyn Blender<N>>>,
    ) -> Self {
        Self::planning(start, settings, Some(&blenders.into()))
    }

    fn planning(start: Vector<N>, settings: &Settings<N>, blenders: Option<&Blenders<N>>) -> Self {
        Self {
            intake: PathCursor::new(start),
            stops: settings.method == Method::ExactStop,
            arc: None,
            route: match settings.method {
                Method::Kcs => Route::Sections(Box::new(Sections::new(start, settings, blenders))),
                Method::KcsLocal => {
                    Route::Corners(Box::new(Corners::new(start, settings, blenders, 1)))
                }
                _ => Route::Stretches(Box::new(Stretches::new(start, settings, blenders))),
            },
        }
    }

    /// What has been planned since the planner was made, trials included.
    #[must_use]
    pub fn work(&self) -> Work {
        match &self.route {
            Route::Corners(corners) => Work {
                pieces: 0,
                corners: corners.joined(),
            },
            Route::Stretches(stretches) => stretches.work_done(),
            Route::Sections(sections) => sections.work_done(),
        }
    }

    /// Takes the next part of the arc under way; `false` when there is none.
    fn advance_arc(&mut self) -> bool {
        let Some((parts, step, index)) = &mut self.arc else {
            return false;
        };
        let (step, index) = (*step, *index);
        match parts.next() {
            Some(part) => self.route.push(vertex_of(&step, index, &part)),
            None => {
                let alone = self.route.takes_alone(parts);
                self.arc = None;
                self.route.part();
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
}

fn vertex_of<const N: usize>(step: &Move<N>, index: u32, part: &Part<N>) -> Vertex<N> {
    Vertex {
        point: part.end,
        bulge: part.off,
        bend: part.bend,
        feedrate: step.feedrate().speed(),
        tolerance: step.tolerance(),
        serves: MoveRange::one(index),
        next: 0,
    }
}

impl<const N: usize> Route<N> {
    fn push(&mut self, vertex: Vertex<N>) {
        match self {
            Self::Corners(corners) => {
                without_bends(vertex).for_each(|vertex| corners.push(vertex));
            }
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
    fn takes_alone(&self, parts: &Parts<N>) -> bool {
        match self {
            Self::Corners(_) => false,
            _ => parts.chords() > LONGEST_ARC as f64,
        }
    }

    /// An arc of some tolerance begins.
    fn begin_arc(&mut self, tolerance: Tolerance) {
        match self {
            Self::Corners(_) => {}
            Self::Stretches(stretches) => stretches.begin_arc(tolerance),
            Self::Sections(sections) => sections.begin_arc(tolerance),
        }
    }

    /// The leg under way ends where the path has come to.
    fn part(&mut self) {
        match self {
            Self::Corners(_) => {}
            Self::Stretches(stretches) => stretches.part(),
            Self::Sections(sections) => sections.part(),
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
}

impl<const N: usize> MotionPlanner<N> for KinematicSmoothing<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let index = self.intake.take(next)?;
        while self.advance_arc() {}
        match next.path() {
            Path::Line { end } => {
                let line = Part {
                    end: *end,
                    bend: None,
                    off: 0.0,
                };
                self.route.push(vertex_of(next, index, &line));
                if self.stops || next.stops() {
                    self.route.rest();
                }
            }
            Path::Arc(arc) => {
                let parts = Parts::new(*arc, next.tolerance().length());
                if self.route.takes_alone(&parts) {
                    self.route.rest();
                } else {
                    self.route.begin_arc(next.tolerance());
                }
                self.arc = Some((parts, *next, index));
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

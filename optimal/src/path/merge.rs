//! Merges short moves into segments, each with a tube of its own, as they stream in.
//!
//! Source: ours. A run is a straight line between two vertices of the path. Every vertex that it leaves
//! out lies within `deviation` of it, and none lies behind another by more than is counted into
//! `deviation`. A motion inside the tube of radius `tolerance - deviation` then stays within the
//! tolerance of the path, and where it crosses the place of a vertex it is within the tolerance of
//! that vertex. Between two runs it passes through a ball; a vertex that lies nearer to the end than
//! the ball is wide need not be crossed, so that such a ball gets half of the radius: then even its
//! far side is near enough. Not here: motion.

use crate::window::Follow;
use toolglide_kinematics::numeric::{LENGTH_SLACK, MIN_SHARE, SHORTEST_LENGTH};
use toolglide_kinematics::{MoveRange, Pause, Vector};

/// Share of the tolerance that joining may use: the motion keeps three quarters of it for itself, and
/// fine chords of a curve still become runs of some thirty.
const RUN_SHARE: f64 = 0.25;

/// Sine of a turn below which two moves are one line to the judge of sides, with a little room.
const STRAIGHT: f64 = 5e-7;

/// Most vertices of a run: bounds memory and the work a vertex.
const MAX_JOINED: usize = 160;

/// The end of a straight stretch of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Vertex<const N: usize> {
    pub(crate) point: Vector<N>,
    /// How far the programmed path may lie from the straight stretch that ends here, mm.
    pub(crate) bulge: f64,
    pub(crate) feedrate: f64,
    pub(crate) tolerance: f64,
    /// The arc over that stretch, where the motion shall follow it.
    pub(crate) follow: Option<Follow<N>>,
    pub(crate) index: u32,
}

/// A straight line that serves one or several moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment<const N: usize> {
    pub(crate) start: Vector<N>,
    pub(crate) end: Vector<N>,
    pub(crate) direction: Vector<N>,
    pub(crate) length: f64,
    pub(crate) feedrate: f64,
    /// Radius of the tube, mm.
    pub(crate) tube: f64,
    /// Largest radius of the balls at its start and at its end, mm.
    pub(crate) balls: [f64; 2],
    pub(crate) follow: Option<Follow<N>>,
    /// Whether it has chords of arcs.
    pub(crate) curved: bool,
    pub(crate) serves: MoveRange,
}

/// Moves that led nowhere and wait for a run to serve them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Carried<const N: usize> {
    serves: MoveRange,
    /// How far they strayed.
    deviation: f64,
    tolerance: f64,
    /// Where they ended: the anchor, but for rounding.
    end: Vector<N>,
}

/// Joins vertices into runs.
#[derive(Clone, Debug)]
pub(crate) struct SegmentMerger<const N: usize> {
    anchor: Vector<N>,
    members: Vec<Vertex<N>>,
    deviation: f64,
    carried: Option<Carried<N>>,
    /// Whether straight moves become one only where they go on along the same line.
    collinear: bool,
}

impl<const N: usize> SegmentMerger<N> {
    /// A joiner of a path that begins at `start`.
    pub(crate) fn new(start: Vector<N>) -> Self {
        Self {
            anchor: start,
            members: Vec::with_capacity(MAX_JOINED + 1),
            deviation: 0.0,
            carried: None,
            collinear: false,
        }
    }

    /// The same, where `collinear` straight moves become one only if they go on along the same line: a side of each of
    /// them is kept.
    pub(crate) fn joining_only_collinear(mut self, collinear: bool) -> Self {
        self.collinear = collinear;
        self
    }

    /// Takes the next vertex; gives the run that it completes.
    pub(crate) fn push(&mut self, vertex: Vertex<N>) -> Option<Segment<N>> {
        let mut run = None;
        if !self.members.is_empty() {
            if let Some(deviation) = self.deviation_with(&vertex) {
                self.deviation = deviation;
                self.members.push(vertex);
                return None;
            }
            run = self.flush();
        }
        if (vertex.point - self.anchor).norm() <= SHORTEST_LENGTH {
            let serves = MoveRange {
                first: vertex.index,
                last: vertex.index,
            };
            self.carry(&vertex, serves, vertex.bulge);
        } else {
            self.deviation = vertex.bulge;
            self.members.push(vertex);
        }
        run
    }

    /// Completes the run under way, if there is one.
    pub(crate) fn flush(&mut self) -> Option<Segment<N>> {
        let (first, last) = (*self.members.first()?, *self.members.last()?);
        let span = last.point - self.anchor;
        let length = span.norm();
        let mut serves = MoveRange {
            first: first.index,
            last: last.index,
        };
        let mut tolerance = self
            .members
            .iter()
            .fold(first.tolerance, |least, member| least.min(member.tolerance));
        let mut deviation = self.deviation;
        let mut near_start = false;
        if let Some(carried) = self.carried.take() {
            serves.first = carried.serves.first;
            near_start = carried.deviation > 0.0;
            deviation = deviation.max(carried.deviation);
            tolerance = tolerance.min(carried.tolerance);
        }
        let tube = (tolerance - deviation).max(tolerance * MIN_SHARE);
        let mut near_end = false;
        let skipped = self.members.len() - 1;
        for member in &self.members[..skipped] {
            near_start |= (member.point - self.anchor).norm() <= tube + deviation;
            near_end |= (member.point - last.point).norm() <= tube + deviation;
        }
        let curved = self.members.iter().any(|member| member.bulge > 0.0);
        self.members.clear();
        self.deviation = 0.0;
        if length <= SHORTEST_LENGTH {
            self.carry(&Vertex { tolerance, ..last }, serves, deviation);
            return None;
        }
        let ball = |near: bool| if near { 0.5 * tube } else { tube };
        let run = Segment {
            start: self.anchor,
            end: last.point,
            direction: span / length,
            length,
            feedrate: last.feedrate,
            tube,
            balls: [ball(near_start), ball(near_end)],
            curved,
            follow: if skipped == 0 { last.follow } else { None },
            serves,
        };
        self.anchor = last.point;
        Some(run)
    }

    /// Moves that led nowhere and that no run has served.
    pub(crate) fn take_carried(&mut self) -> Option<Pause<N>> {
        let carried = self.carried.take()?;
        Some(Pause {
            duration: 0.0,
            serves: carried.serves,
            end: carried.end,
        })
    }

    /// Where the last run ended.
    pub(crate) fn anchor(&self) -> Vector<N> {
        self.anchor
    }

    fn carry(&mut self, last: &Vertex<N>, serves: MoveRange, deviation: f64) {
        let mut carried = Carried {
            serves,
            deviation,
            tolerance: last.tolerance,
            end: last.point,
        };
        if let Some(before) = self.carried {
            carried.serves.first = before.serves.first;
            carried.deviation = deviation.max(before.deviation);
            carried.tolerance = carried.tolerance.min(before.tolerance);
        }
        self.carried = Some(carried);
    }

    /// Whether the move to `vertex` goes on along the line of the last member.
    fn goes_straight_on(&self, vertex: &Vertex<N>) -> bool {
        let Some((last, earlier)) = self.members.split_last() else {
            return true;
        };
        let from = earlier.last().map_or(self.anchor, |member| member.point);
        let (line, next) = (last.point - from, vertex.point - last.point);
        let along = line.dot(&next) / line.norm_squared();
        along > 0.0 && (next - line * along).norm() <= STRAIGHT * next.norm()
    }

    /// Largest distance of the path from a line to `vertex`, with the largest way back along it, or
    /// `None` when it cannot be joined.
    fn deviation_with(&self, vertex: &Vertex<N>) -> Option<f64> {
        let last = self.members.last()?;
        let same_feedrate = last.feedrate.to_bits() == vertex.feedrate.to_bits();
        let follows = last.follow.is_some() || vertex.follow.is_some();
        if self.members.len() >= MAX_JOINED || !same_feedrate || follows {
            return None;
        }
        let (mut tolerance, mut bulge) = (vertex.tolerance, vertex.bulge);
        for member in &self.members {
            tolerance = tolerance.min(member.tolerance);
            bulge = bulge.max(member.bulge);
        }
        let mut budget = RUN_SHARE * tolerance - bulge;
        if self.collinear && (last.bulge <= 0.0 || vertex.bulge <= 0.0) {
            if !self.goes_straight_on(vertex) {
                return None;
            }
            budget = budget.min(LENGTH_SLACK - bulge);
        }
        if budget <= 0.0 {
            return None;
        }
        let span = vertex.point - self.anchor;
        let length = span.norm();
        if !length.is_finite() {
            return None;
        }
        let direction = if length > 0.0 { span / length } else { span };
        let (mut furthest, mut back, mut reached) = (0.0_f64, 0.0_f64, 0.0_f64);
        for member in &self.members {
            let offset = member.point - self.anchor;
            let along = offset.dot(&direction).clamp(0.0, length);
            reached = reached.max(along);
            back = back.max(reached - along);
            furthest = furthest.max((offset - direction * along).norm_squared());
            if furthest > budget * budget || back > budget {
                return None;
            }
        }
        let deviation = furthest.sqrt() + back;
        (deviation <= budget).then_some(deviation + bulge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(x: f64, y: f64, index: u32) -> Vertex<2> {
        Vertex {
            point: Vector::<2>::new(x, y),
            bulge: 0.0,
            feedrate: 100.0,
            tolerance: 0.01,
            follow: None,
            index,
        }
    }

    #[test]
    fn chords_of_a_gentle_curve_become_runs_that_use_a_quarter_of_the_tolerance() {
        let mut joiner = SegmentMerger::new(Vector::<2>::new(50.0, 0.0));
        let mut runs = Vec::new();
        for index in 0..400_u32 {
            let angle = f64::from(index + 1) * 36e-6 * 20.0;
            runs.extend(joiner.push(vertex(50.0 * angle.cos(), 50.0 * angle.sin(), index)));
        }
        runs.extend(joiner.flush());
        assert!(runs.len() > 5 && runs.len() < 30, "{}", runs.len());
        for run in &runs {
            assert!(run.tube >= 0.0075 - 1e-12, "{run:?}");
        }
        for pair in runs.windows(2) {
            assert_eq!(pair[0].end, pair[1].start, "runs meet");
            assert_eq!(
                pair[0].serves.last + 1,
                pair[1].serves.first,
                "no move is left out"
            );
        }
    }

    #[test]
    fn where_a_side_is_kept_only_collinear_moves_become_one() {
        let mut joiner = SegmentMerger::new(Vector::<2>::zeros()).joining_only_collinear(true);
        assert_eq!(joiner.push(vertex(1.0, 0.0, 0)), None);
        assert_eq!(joiner.push(vertex(3.0, 0.0, 1)), None);
        let turned = joiner.push(vertex(3.1, 1e-6, 2));
        assert_eq!(turned.map(|run| run.serves.last), Some(1));
        assert!(joiner.push(vertex(3.2, 0.0, 3)).is_some());
    }

    #[test]
    fn a_turn_a_change_of_feedrate_and_a_way_back_end_a_run() {
        let mut joiner = SegmentMerger::new(Vector::<2>::zeros());
        assert_eq!(joiner.push(vertex(1.0, 0.0, 0)), None);
        assert_eq!(joiner.push(vertex(2.0, 0.0, 1)), None);
        let turned = joiner.push(vertex(2.0, 1.0, 2));
        assert_eq!(turned.map(|run| run.serves.last), Some(1));
        let back = joiner.push(vertex(2.0, 0.5, 3));
        assert_eq!(back.map(|run| run.serves.first), Some(2));
        let slow = Vertex {
            feedrate: 10.0,
            ..vertex(2.0, 0.0, 4)
        };
        assert!(joiner.push(slow).is_some(), "another feedrate");
    }

    #[test]
    fn vertices_near_the_end_of_a_run_halve_its_ball() {
        let mut joiner = SegmentMerger::new(Vector::<2>::zeros());
        for (index, x) in [0.002, 1.0].into_iter().enumerate() {
            joiner.push(vertex(x, 0.0, u32::try_from(index).unwrap()));
        }
        let run = joiner.flush().unwrap();
        assert!((run.balls[0] - 0.005).abs() < 1e-12, "{run:?}");
        assert!((run.balls[1] - 0.01).abs() < 1e-12, "{run:?}");
    }

    #[test]
    fn moves_to_where_the_path_is_are_served_by_the_next_run() {
        let mut joiner = SegmentMerger::new(Vector::<2>::zeros());
        assert_eq!(joiner.push(vertex(0.0, 0.0, 0)), None);
        assert_eq!(joiner.push(vertex(1.0, 0.0, 1)), None);
        let run = joiner.flush().unwrap();
        assert_eq!((run.serves.first, run.serves.last), (0, 1));
        assert_eq!(joiner.push(vertex(1.0, 0.0, 2)), None);
        assert_eq!(joiner.flush(), None);
        assert_eq!(
            joiner.take_carried().map(|pause| pause.serves.first),
            Some(2)
        );
    }
}

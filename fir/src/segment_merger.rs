//! Merges short moves into longer straight segments inside the tolerance, before they become
//! pulses.
//!
//! Source: ours; section 4.3 takes moves as they come, and looking ahead over hundreds of them in one
//! window costs as much as it gains. Every corner that a straight leg leaves out lies within a share of
//! the tolerance of it, so by continuity leg and moves are never further apart; the filters get what is
//! left of the tolerance. Not here: pulses.

#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{MoveRange, Vector};

/// Share of the tolerance that merging may use. Feedrate on a curve goes with the root of what is left,
/// the time to plan with the square of how many legs are in the window.
pub(crate) const MERGE_SHARE: f64 = 0.3;

/// Most moves merged into one: bounds memory and the work a move.
const MAX_MERGED: usize = 128;

/// Length of moves that may be slowed to the feedrate of those they are merged with, as a share of the
/// tolerance: less than a micrometre where parts are machined.
const NEGLIGIBLE: f64 = 0.01;

/// The end of a straight stretch of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Vertex<const N: usize> {
    pub(crate) point: Vector<N>,
    /// How far the path may lie from the straight stretch that ends here.
    pub(crate) bulge: f64,
    pub(crate) feedrate: f64,
    pub(crate) tolerance: f64,
    pub(crate) serves: MoveRange,
}

/// A straight stretch that stands for a run of moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment<const N: usize> {
    pub(crate) end: Vector<N>,
    pub(crate) feedrate: f64,
    /// What is left of the tolerance.
    pub(crate) room: f64,
    pub(crate) serves: MoveRange,
}

/// Merges vertices into legs.
#[derive(Clone, Debug)]
pub(crate) struct SegmentMerger<const N: usize> {
    anchor: Vector<N>,
    run: Vec<Vertex<N>>,
    /// Of the run: least tolerance, lowest and highest feedrate, largest bulge, largest distance from
    /// its line.
    tolerance: f64,
    slowest: f64,
    fastest: f64,
    bulge: f64,
    deviation: f64,
    /// Moves that led nowhere and wait for a leg to serve them; their stray and tolerance.
    carried: Option<(MoveRange, f64, f64)>,
}

impl<const N: usize> SegmentMerger<N> {
    pub(crate) fn new(start: Vector<N>) -> Self {
        let mut merger = Self {
            anchor: start,
            run: Vec::with_capacity(MAX_MERGED),
            tolerance: f64::INFINITY,
            slowest: f64::INFINITY,
            fastest: 0.0,
            bulge: 0.0,
            deviation: 0.0,
            carried: None,
        };
        merger.clear();
        merger
    }

    /// Where the legs have come to.
    pub(crate) fn anchor(&self) -> Vector<N> {
        self.anchor
    }

    /// Takes the next vertex; gives the leg that it completes.
    pub(crate) fn push(&mut self, mut vertex: Vertex<N>) -> Option<Segment<N>> {
        if let Some(last) = self.run.last()
            && vertex.point == last.point
        {
            // A feedrate over no length slows nothing.
            vertex.feedrate = last.feedrate;
        }
        let mut leg = None;
        match self.deviation_with(&vertex) {
            Some(deviation) => self.deviation = deviation,
            None => leg = self.flush(),
        }
        if self.run.is_empty() && (vertex.point - self.anchor).norm() <= SHORTEST_LENGTH {
            self.carry(vertex.serves, vertex.bulge, vertex.tolerance);
            return leg;
        }
        self.tolerance = self.tolerance.min(vertex.tolerance);
        self.slowest = self.slowest.min(vertex.feedrate);
        self.fastest = self.fastest.max(vertex.feedrate);
        self.bulge = self.bulge.max(vertex.bulge);
        self.run.push(vertex);
        leg
    }

    /// Completes the leg under way, if there is one.
    pub(crate) fn flush(&mut self) -> Option<Segment<N>> {
        let (first, last) = (*self.run.first()?, *self.run.last()?);
        let serves = MoveRange {
            first: first.serves.first,
            last: last.serves.last,
        };
        let (stray, tolerance, feedrate) =
            (self.deviation + self.bulge, self.tolerance, self.slowest);
        self.clear();
        if (last.point - self.anchor).norm() <= SHORTEST_LENGTH {
            self.carry(serves, stray, tolerance);
            return None;
        }
        self.anchor = last.point;
        let (serves, stray, tolerance) = self.with_carried(serves, stray, tolerance);
        self.carried = None;
        Some(Segment {
            end: last.point,
            feedrate,
            room: tolerance - stray,
            serves,
        })
    }

    /// Goes on from elsewhere, which a pulse that is no leg leads to.
    pub(crate) fn go_to(&mut self, end: Vector<N>) {
        self.anchor = end;
    }

    /// Moves that such a pulse serves, those that were carried among them, and what the carried ones leave
    /// of their tolerance.
    pub(crate) fn serve(&mut self, serves: MoveRange) -> (MoveRange, f64) {
        let (serves, stray, tolerance) = self.with_carried(serves, 0.0, f64::INFINITY);
        self.carried = None;
        (serves, tolerance - stray)
    }

    /// Moves that led nowhere and that no leg has served.
    pub(crate) fn take_carried(&mut self) -> Option<MoveRange> {
        self.carried.take().map(|(serves, ..)| serves)
    }

    /// Keeps moves that end where they began.
    pub(crate) fn carry(&mut self, serves: MoveRange, stray: f64, tolerance: f64) {
        self.carried = Some(self.with_carried(serves, stray, tolerance));
    }

    fn with_carried(&self, serves: MoveRange, stray: f64, tolerance: f64) -> (MoveRange, f64, f64) {
        match self.carried {
            None => (serves, stray, tolerance),
            Some((before, its_stray, its_tolerance)) => (
                MoveRange {
                    first: before.first,
                    last: serves.last,
                },
                stray.max(its_stray),
                tolerance.min(its_tolerance),
            ),
        }
    }

    fn clear(&mut self) {
        self.run.clear();
        self.tolerance = f64::INFINITY;
        self.slowest = f64::INFINITY;
        self.fastest = 0.0;
        self.bulge = 0.0;
        self.deviation = 0.0;
    }

    /// Length of the moves that would be slowed to the feedrate of another if `vertex` were merged.
    fn hurried_with(&self, vertex: &Vertex<N>) -> f64 {
        let slowest = self.slowest.min(vertex.feedrate);
        if slowest >= vertex.feedrate && slowest >= self.fastest {
            return 0.0;
        }
        let mut hurried = 0.0;
        let mut from = self.anchor;
        for member in self.run.iter().chain([vertex]) {
            if member.feedrate > slowest {
                hurried += (member.point - from).norm();
            }
            from = member.point;
        }
        hurried
    }

    /// Largest distance of the run from a line to `vertex`, or `None` when it cannot be merged.
    fn deviation_with(&self, vertex: &Vertex<N>) -> Option<f64> {
        if self.run.is_empty() {
            return Some(0.0);
        }
        if self.run.len() >= MAX_MERGED {
            return None;
        }
        let tolerance = self.tolerance.min(vertex.tolerance);
        if self.hurried_with(vertex) > NEGLIGIBLE * tolerance {
            return None;
        }
        let budget = (MERGE_SHARE * tolerance - self.bulge.max(vertex.bulge)).max(0.0);
        let span = vertex.point - self.anchor;
        let square = span.norm_squared();
        let mut furthest = 0.0_f64;
        // The latest corners are those that a line leaves first.
        for member in self.run.iter().rev() {
            let offset = member.point - self.anchor;
            let share = if square > 0.0 {
                (offset.dot(&span) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            furthest = furthest.max((offset - span * share).norm_squared());
            if furthest > budget * budget {
                return None;
            }
        }
        Some(furthest.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(point: [f64; 2], index: u32) -> Vertex<2> {
        Vertex {
            point: point.into(),
            bulge: 0.0,
            feedrate: 10.0,
            tolerance: 0.1,
            serves: MoveRange::one(index),
        }
    }

    #[test]
    fn corners_near_a_line_are_left_out_and_use_up_tolerance() {
        let mut merger = SegmentMerger::new(Vector::<2>::zeros());
        for (index, point) in [[1.0, 0.005], [2.0, 0.0], [3.0, -0.01]]
            .into_iter()
            .enumerate()
        {
            let vertex = vertex(point, u32::try_from(index).unwrap());
            assert_eq!(merger.push(vertex), None, "vertex {index}");
        }
        let leg = merger.push(vertex([3.0, 1.0], 3)).unwrap();
        assert_eq!(leg.end, Vector::<2>::new(3.0, -0.01), "end");
        assert_eq!(leg.serves, MoveRange { first: 0, last: 2 }, "moves");
        let off = 0.1 - leg.room;
        assert!((off - 0.0083333).abs() < 1e-6, "{off} mm is used up");
        let last = merger.flush().unwrap();
        assert!((last.room - 0.1).abs() < 1e-15, "one move uses up nothing");
    }

    #[test]
    fn a_way_there_and_back_is_served_by_what_follows() {
        let mut merger = SegmentMerger::new(Vector::<2>::zeros());
        assert_eq!(merger.push(vertex([0.01, 0.0], 0)), None, "there");
        assert_eq!(merger.push(vertex([0.0, 0.0], 1)), None, "back");
        assert_eq!(merger.flush(), None, "it leads nowhere");
        assert_eq!(merger.push(vertex([5.0, 0.0], 2)), None, "on");
        let leg = merger.flush().unwrap();
        assert_eq!(leg.serves, MoveRange { first: 0, last: 2 }, "moves");
        assert!((leg.room - 0.09).abs() < 1e-15, "{} mm are left", leg.room);
    }

    #[test]
    fn a_pulse_that_is_no_leg_keeps_the_tolerance_of_what_it_serves() {
        let mut merger = SegmentMerger::new(Vector::<2>::zeros());
        merger.push(vertex([0.01, 0.0], 0));
        merger.push(vertex([0.0, 0.0], 1));
        merger.flush();
        let own = MoveRange { first: 2, last: 2 };
        let (serves, room) = merger.serve(own);
        assert_eq!(serves, MoveRange { first: 0, last: 2 }, "moves");
        assert!((room - 0.09).abs() < 1e-15, "{room} mm are left");
        assert_eq!(merger.serve(own), (own, f64::INFINITY), "served once");
    }

    #[test]
    fn moves_of_different_feedrates_stay_apart_unless_they_are_nothing() {
        for (length, merged) in [(1.0, false), (1e-4, true)] {
            let mut merger = SegmentMerger::new(Vector::<2>::zeros());
            merger.push(vertex([length, 0.0], 0));
            let slower = Vertex {
                feedrate: 5.0,
                ..vertex([2.0, 0.0], 1)
            };
            assert_eq!(merger.push(slower).is_none(), merged, "{length} mm");
        }
    }
}

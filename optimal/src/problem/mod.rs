//! States a window as constraints of the interior-point method.
//!
//! An interval of constant jerk has the Bezier points `v + h a / 2` of velocity (between the
//! velocities of its nodes) and `p + h v / 3`, `p⁺ - h v⁺ / 3` of position. Node velocities lie
//! between Bezier points of their neighbours, node positions likewise, so these points bound the
//! motion at every instant; where the feedrate changes, the lower one holds on both sides. Near the ends of a segment the tube is a capsule, elsewhere a cylinder.
//!
//! Source: sections 2.2 and 2.3 for the limits; the linearisation in the durations is our own. Not
//! here: how it is solved, see [`interior`](crate::solver::interior).

pub(crate) mod b_spline;
pub(crate) mod constraints;
pub(crate) mod modes;
mod track;

use self::track::Track;
use crate::solver::riccati::{Chain, Interval};
use crate::window::{EndState, Window, WindowDefect};
use b_spline::{Basis, State};
use constraints::{Bounds, InBox, InDisc, InTube, Rows};
use modes::Conditions;
use toolglide_kinematics::Vector;

/// All rows of one node and of the interval after it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NodeRows<const N: usize> {
    pub(crate) jerk: InBox<N>,
    acceleration: InBox<N>,
    velocity: InBox<N>,
    feed: InDisc<N>,
    after: InTube<N>,
    before: InTube<N>,
    corner: InDisc<N>,
}

/// Does something with the rows of a node, one point after the other.
pub(crate) trait Visit<const N: usize> {
    fn rows<R: Rows<N>>(&mut self, rows: &mut R, bound: &R::Bound, chain: &Chain<N>);
}

/// A window, ready to be linearised and solved.
#[derive(Clone, Debug)]
pub(crate) struct Problem<const N: usize> {
    tracks: Vec<Track<N>>,
    /// The segment of each interval, and once more the last.
    segment_of: Vec<usize>,
    bases: Vec<Basis>,
    origin: Vector<N>,
    start: State<N>,
    end: State<N>,
    by_velocity: Bounds<N>,
    by_acceleration: Bounds<N>,
    by_jerk: Bounds<N>,
    /// Free share of feedrate and tolerance at the fixed ends: at least what they use.
    start_room: [f64; 2],
    end_room: f64,
    /// Where it is linearised; stretches count only with a base.
    base: Vec<State<N>>,
    base_jerks: Vec<Vector<N>>,
    stretching: bool,
    conditions: Conditions,
    /// Heights of arcs over their chords at the Bezier points of each node, in sagittas.
    heights: Vec<[f64; 2]>,
}

impl<const N: usize> Default for Problem<N> {
    fn default() -> Self {
        let nothing = Vector::zeros();
        Self {
            tracks: Vec::new(),
            segment_of: Vec::new(),
            bases: Vec::new(),
            origin: nothing,
            start: [nothing; 3],
            end: [nothing; 3],
            by_velocity: nothing,
            by_acceleration: nothing,
            by_jerk: nothing,
            start_room: [1.0; 2],
            end_room: 1.0,
            base: Vec::new(),
            base_jerks: Vec::new(),
            stretching: false,
            conditions: Conditions::default(),
            heights: Vec::new(),
        }
    }
}

impl<const N: usize> Problem<N> {
    /// Makes room for windows of so many segments and intervals.
    pub(crate) fn reserve(&mut self, segments: usize, steps: usize) {
        self.tracks.reserve(segments);
        self.segment_of.reserve(steps + 1);
        self.bases.reserve(steps + 1);
        self.base.reserve(steps + 1);
        self.base_jerks.reserve(steps);
        self.heights.reserve(steps + 1);
    }

    /// Makes room for the conditions of so many modes.
    pub(crate) fn reserve_modes(&mut self, modes: usize, segments: usize, steps: usize) {
        self.conditions.reserve(modes, segments, steps);
    }

    /// What the end must be beside where it is.
    pub(crate) fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// Takes a window.
    pub(crate) fn load(&mut self, window: &Window<'_, N>) -> Result<(), WindowDefect> {
        let first = window.segments.first().ok_or(WindowDefect::Empty)?;
        self.origin = first.start;
        self.by_velocity = window.limits.velocity().map(f64::recip);
        self.by_acceleration = window.limits.acceleration().map(f64::recip);
        self.by_jerk = window.limits.jerk().map(f64::recip);
        self.tracks.clear();
        self.segment_of.clear();
        for (index, segment) in window.segments.iter().enumerate() {
            let others = [index.wrapping_sub(1), index + 1].map(|other| window.segments.get(other));
            let track = self.track(index, segment, others)?;
            self.tracks.push(track);
            self.segment_of
                .extend(std::iter::repeat_n(index, segment.steps));
        }
        self.segment_of.push(window.segments.len() - 1);
        self.heights.clear();
        self.heights.resize(self.segment_of.len(), [0.0; 2]);
        self.start = self.relative(&window.start);
        self.end = self.relative(&window.end);
        self.start_room = [1.0; 2];
        self.end_room = 1.0;
        if let (Some(head), Some(tail)) = (self.tracks.first(), self.tracks.last()) {
            let speed = self.start[1].norm() * head.feed.by_radius;
            self.start_room = [speed.max(1.0), head.used(&self.start[0]).max(1.0)];
            self.end_room = tail.used(&self.end[0]).max(1.0);
        }
        Ok(())
    }

    pub(crate) fn relative(&self, state: &EndState<N>) -> State<N> {
        [
            state.position - self.origin,
            state.velocity,
            state.acceleration,
        ]
    }

    pub(crate) fn absolute(&self, state: &State<N>) -> EndState<N> {
        EndState {
            position: state[0] + self.origin,
            velocity: state[1],
            acceleration: state[2],
        }
    }

    /// Durations of the segments, s.
    pub(crate) fn set_durations(&mut self, durations: &[f64]) {
        for (track, duration) in self.tracks.iter_mut().zip(durations) {
            track.duration = duration / count(track.steps);
        }
        let steps = self.steps();
        self.bases.clear();
        for node in 0..=steps {
            let near = |offset: usize| self.duration((node + offset).clamp(2, steps + 1) - 2);
            self.bases
                .push(Basis::new([near(0), near(1), near(2), near(3)], near(4)));
        }
    }

    /// Bends the tubes of arcs that are followed to where the motion is, and finds the halves of lines there.
    pub(crate) fn set_places(&mut self, states: &[State<N>]) {
        for track in &mut self.tracks {
            track.find_half(states);
        }
        for (node, (heights, state)) in self.heights.iter_mut().zip(states).enumerate() {
            let height = |interval: usize, sign: f64| {
                let track = &self.tracks[self.segment_of[interval]];
                track.height(state, sign * track.duration / 3.0)
            };
            *heights = [height(node, 1.0), height(node.saturating_sub(1), -1.0)];
        }
    }

    /// Counts intervals by their duration in means over time, and pulls positions to the middle of their
    /// tubes with this weight; without, all intervals count alike and nothing is pulled.
    pub(crate) fn set_centring(&mut self, weight: Option<f64>) {
        let whole: f64 = self.tracks.iter().map(Track::whole).sum();
        let mean = whole / count(self.steps());
        for track in &mut self.tracks {
            track.time_weight = weight.map_or(1.0, |_| track.duration / mean);
            track.tube.centring = weight.map_or(0.0, |weight| weight * track.time_weight);
        }
    }

    /// Sets where the next problem is linearised in the durations; without, they are fixed.
    pub(crate) fn set_base(&mut self, base: Option<(&[State<N>], &[Vector<N>])>) {
        self.stretching = base.is_some();
        if let Some((states, jerks)) = base {
            self.base.clear();
            self.base.extend_from_slice(states);
            self.base_jerks.clear();
            self.base_jerks.extend_from_slice(jerks);
        }
    }

    /// Fixes the durations for a while; gives whether they were free.
    pub(crate) fn hold_durations(&mut self) -> bool {
        std::mem::replace(&mut self.stretching, false)
    }

    pub(crate) fn free_durations(&mut self, free: bool) {
        self.stretching = free;
    }

    pub(crate) fn stretching(&self) -> bool {
        self.stretching
    }

    pub(crate) fn segments(&self) -> usize {
        self.tracks.len()
    }

    pub(crate) fn steps(&self) -> usize {
        self.segment_of.len() - 1
    }

    pub(crate) fn segment_of(&self, interval: usize) -> usize {
        self.segment_of[interval]
    }

    /// Whether a node is the first of its segment.
    pub(crate) fn starts_segment(&self, node: usize) -> bool {
        self.tracks[self.segment_of[node]].first == node
    }

    pub(crate) fn start(&self) -> &State<N> {
        &self.start
    }

    pub(crate) fn end(&self) -> &State<N> {
        &self.end
    }

    pub(crate) fn by_jerk(&self) -> &Bounds<N> {
        &self.by_jerk
    }

    /// Share of the whole duration that each segment takes.
    pub(crate) fn share(&self, segment: usize) -> f64 {
        let whole: f64 = self.tracks.iter().map(Track::whole).sum();
        self.tracks[segment].whole() / whole
    }

    /// Number of inequalities, a cone counting as one.
    pub(crate) fn degree(&self) -> f64 {
        let mut degree = self.tracks.len() * 2 + 1;
        for track in &self.tracks {
            let boxes = if track.slow_axis { 3 } else { 2 };
            degree += track.steps * (boxes * 2 * N + 1 + 6);
            degree += usize::from(track.corner.is_some());
            degree += track.walls.iter().flatten().count() * track.steps;
        }
        // The ends have no bound of acceleration but one.
        count(degree - 2 * N)
    }

    #[inline(always)]
    pub(crate) fn duration(&self, interval: usize) -> f64 {
        self.tracks[self.segment_of[interval]].duration
    }

    /// What an interval counts in means over time.
    #[inline(always)]
    pub(crate) fn time_weight(&self, interval: usize) -> f64 {
        self.tracks[self.segment_of[interval]].time_weight
    }

    #[inline(always)]
    pub(crate) fn basis(&self, node: usize) -> &Basis {
        &self.bases[node]
    }

    /// How the state at the end of an interval changes with the stretch of its duration.
    #[inline(always)]
    fn by_stretch(&self, interval: usize) -> State<N> {
        if self.stretching {
            let h = self.duration(interval);
            let [_, velocity, acceleration] = &self.base[interval];
            let jerk = &self.base_jerks[interval];
            [
                (velocity + (acceleration + jerk * (0.5 * h)) * h) * h,
                (acceleration + jerk * h) * h,
                jerk * h,
            ]
        } else {
            [Vector::zeros(); 3]
        }
    }

    /// The state at the end of an interval.
    #[inline(always)]
    pub(crate) fn after(
        &self,
        interval: usize,
        state: &State<N>,
        jerk: &Vector<N>,
        stretch: f64,
    ) -> State<N> {
        let h = self.duration(interval);
        let [position, velocity, acceleration] = state;
        let by_stretch = self.by_stretch(interval);
        [
            position
                + (velocity + (acceleration + jerk * (h / 3.0)) * (0.5 * h)) * h
                + by_stretch[0] * stretch,
            velocity + (acceleration + jerk * (0.5 * h)) * h + by_stretch[1] * stretch,
            acceleration + jerk * h + by_stretch[2] * stretch,
        ]
    }

    #[inline(always)]
    pub(crate) fn interval(&self, index: usize) -> Interval<N> {
        let by_stretch = if self.stretching {
            self.bases[index + 1].coefficients(&self.by_stretch(index))
        } else {
            [Vector::zeros(); 3]
        };
        Interval {
            jerk: self.bases[index].jerk,
            by_stretch,
        }
    }

    #[inline(always)]
    fn base(&self, node: usize, order: usize) -> Vector<N> {
        if self.stretching {
            self.base[node][order]
        } else {
            Vector::zeros()
        }
    }

    /// Visits the rows that stretch with the segment after a node.
    #[inline(always)]
    pub(crate) fn visit_ahead<V: Visit<N>>(
        &self,
        node: usize,
        rows: &mut NodeRows<N>,
        visit: &mut V,
    ) {
        let track = &self.tracks[self.segment_of[node]];
        let basis = &self.bases[node];
        let h = track.duration;
        let velocity = Chain {
            order: 1,
            ahead: 0.5 * h,
            base: self.base(node, 2),
            weights: basis.speed,
        };
        let mut feed = track.feed(node - track.first);
        let mut tube = track.tube;
        tube.capsule = track.is_round(node - track.first);
        if node == 0 {
            [feed.room, tube.room] = self.start_room;
        }
        tube.start += track.sagitta * self.heights[node][0];
        if node > 0 {
            tube.wall = track.wall(node - track.first);
        }
        visit.rows(&mut rows.feed, &feed, &velocity);
        if track.slow_axis {
            visit.rows(&mut rows.velocity, &self.by_velocity, &velocity);
        }
        let position = Chain {
            order: 0,
            ahead: h / 3.0,
            base: self.base(node, 1),
            weights: basis.after,
        };
        visit.rows(&mut rows.after, &tube, &position);
    }

    /// Visits the rows that stretch with the segment before a node, or not at all.
    #[inline(always)]
    pub(crate) fn visit_behind<V: Visit<N>>(
        &self,
        node: usize,
        rows: &mut NodeRows<N>,
        visit: &mut V,
    ) {
        let track = &self.tracks[self.segment_of[node - 1]];
        let basis = &self.bases[node];
        let mut tube = track.tube;
        tube.capsule = track.is_round(node - 1 - track.first);
        tube.start += track.sagitta * self.heights[node][1];
        if node == self.steps() {
            tube.room = self.end_room;
        } else {
            tube.wall = track.wall(node - 1 - track.first);
            let still = Chain {
                order: 2,
                ahead: 0.0,
                base: Vector::zeros(),
                weights: basis.acceleration,
            };
            visit.rows(&mut rows.acceleration, &self.by_acceleration, &still);
            if let Some(corner) = &track.corner
                && node == track.first + track.steps
            {
                let position = Chain {
                    order: 0,
                    weights: basis.position,
                    ..still
                };
                visit.rows(&mut rows.corner, corner, &position);
            }
        }
        let position = Chain {
            order: 0,
            ahead: -track.duration / 3.0,
            base: self.base(node, 1),
            weights: basis.before,
        };
        visit.rows(&mut rows.before, &tube, &position);
    }
}

/// A number of things as a factor.
#[allow(
    clippy::cast_precision_loss,
    reason = "a window has some hundred intervals"
)]
pub(crate) fn count(things: usize) -> f64 {
    things as f64
}

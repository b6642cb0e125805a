//! Keeps a point within a distance of a straight segment: the tube.
//!
//! Source: as [`rows`](super). In a capsule the nearest point of the segment is one more unknown, which
//! its own rows eliminate. Not here: boxes and discs.

#[cfg(test)]
use crate::problem::constraints::Constraint;
use crate::problem::constraints::Rows;
use crate::solver::cone::{Centre, Cone, ConeWeight, MIN_SLACK, Pair, Reach, Side, Sums};
use crate::solver::riccati::{Local, Slope};
use crate::solver::small_blocks::{outer, times};
use toolglide_kinematics::Vector;

/// Within a distance of a straight segment.
///
/// In a capsule the nearest point of the segment is free to move (`progress`, in shares of its
/// length); in a cylinder it is the projection, which must lie on the segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InTube<const N: usize> {
    cone: Cone<N>,
    low: Side,
    high: Side,
    wall: Side,
    progress: f64,
    progress_change: f64,
    /// How the progress of a capsule follows point and excess: curvature, its reciprocal, slope.
    by_point: Vector<N>,
    by_excess: f64,
    by_curvature: f64,
    slope: f64,
    /// Slope of the square of the distance from the middle.
    pull: Vector<N>,
}

/// A tube around a segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tube<const N: usize> {
    pub(crate) start: Vector<N>,
    pub(crate) direction: Vector<N>,
    pub(crate) length: f64,
    /// Reciprocal of the tolerance.
    pub(crate) by_radius: f64,
    /// As of [`Disc`].
    pub(crate) room: f64,
    /// Whether its ends are round.
    pub(crate) capsule: bool,
    /// Weight of half the square of the distance from its line, in shares of the radius.
    pub(crate) centring: f64,
    /// The side that is kept: a vector across the line whose product with an offset is what the offset uses of a unit
    /// of excess there, and how much is free.
    pub(crate) wall: Option<(Vector<N>, f64)>,
}

impl<const N: usize> Tube<N> {
    #[inline(always)]
    fn across(&self, of: &Vector<N>) -> Vector<N> {
        if self.capsule {
            of * self.by_radius
        } else {
            (of - self.direction * self.direction.dot(of)) * self.by_radius
        }
    }

    #[inline(always)]
    fn scaled_length(&self) -> f64 {
        self.length * self.by_radius
    }

    #[inline(always)]
    fn value(&self, point: &Vector<N>, excess: f64, progress: f64) -> Pair<N> {
        let tail = self.across(&(point - self.start));
        Pair {
            head: self.room + excess,
            tail: if self.capsule {
                tail - self.direction * (progress * self.scaled_length())
            } else {
                tail
            },
        }
    }

    #[inline(always)]
    fn change(&self, change: &Vector<N>, excess: f64, progress: f64) -> Pair<N> {
        let tail = self.across(change);
        Pair {
            head: excess,
            tail: if self.capsule {
                tail - self.direction * (progress * self.scaled_length())
            } else {
                tail
            },
        }
    }

    /// Offset of a point from the line, mm.
    #[inline(always)]
    pub(crate) fn offset(&self, point: &Vector<N>) -> Vector<N> {
        let from_start = point - self.start;
        from_start - self.direction * self.direction.dot(&from_start)
    }

    /// What is left of the room on the side that is kept; `None` where none is.
    #[inline(always)]
    fn wall_value(&self, point: &Vector<N>, excess: f64) -> Option<f64> {
        self.wall
            .as_ref()
            .map(|(across, room)| room + excess - across.dot(&(point - self.start)))
    }

    #[inline(always)]
    fn along(&self, of: &Vector<N>) -> f64 {
        self.direction.dot(of) / self.length
    }
}

impl<const N: usize> Default for InTube<N> {
    fn default() -> Self {
        Self {
            cone: Cone::default(),
            low: Side::default(),
            high: Side::default(),
            wall: Side::default(),
            progress: 0.5,
            progress_change: 0.0,
            by_point: Vector::zeros(),
            by_excess: 0.0,
            by_curvature: 0.0,
            slope: 0.0,
            pull: Vector::zeros(),
        }
    }
}

impl<const N: usize> InTube<N> {
    /// Slope of point and excess from those of the rows, with the progress of a capsule eliminated.
    #[inline(always)]
    fn gather(&mut self, bound: &Tube<N>, cone: &Pair<N>, low: f64, high: f64) -> Slope<N> {
        let mut slope = Slope {
            point: bound.across(&cone.tail),
            excess: cone.head,
        };
        if bound.capsule {
            self.slope = low - high - bound.scaled_length() * bound.direction.dot(&cone.tail);
            let share = self.slope * self.by_curvature;
            slope.point -= self.by_point * share;
            slope.excess -= self.by_excess * share;
        } else {
            slope.point += bound.direction * ((low - high) / bound.length);
            slope.excess += low + high;
        }
        slope
    }

    /// Adds the pull to the middle of the tube.
    #[inline(always)]
    fn centre(&mut self, bound: &Tube<N>, point: &Vector<N>, local: &mut Local<N>) {
        let weight = bound.centring * bound.by_radius * bound.by_radius;
        self.pull = bound.offset(point) * weight;
        local.slope.point += self.pull;
        for axis in 0..N {
            local.point[(axis, axis)] += weight;
        }
        local.point -= outer(&bound.direction, &(bound.direction * weight));
    }

    /// Change of the progress of a capsule that goes with the changes of point and excess.
    #[inline(always)]
    fn follow(&mut self, change: &Vector<N>, excess: f64) {
        self.progress_change =
            -(self.slope + self.by_point.dot(change) + self.by_excess * excess) * self.by_curvature;
    }

    #[inline(always)]
    fn ends(&self, bound: &Tube<N>, point: &Vector<N>, excess: f64) -> (f64, f64) {
        if bound.capsule {
            (self.progress, 1.0 - self.progress)
        } else {
            let progress = bound.along(&(point - bound.start));
            (progress + excess, 1.0 - progress + excess)
        }
    }

    #[inline(always)]
    fn changes(&self, bound: &Tube<N>, change: &Vector<N>, excess: f64) -> (f64, f64) {
        if bound.capsule {
            (self.progress_change, -self.progress_change)
        } else {
            let progress = bound.along(change);
            (progress + excess, excess - progress)
        }
    }
}

impl<const N: usize> Rows<N> for InTube<N> {
    type Bound = Tube<N>;

    #[cfg(test)]
    fn kept(bound: &Tube<N>) -> Constraint<N> {
        Constraint::Tube(*bound)
    }

    fn reset(&mut self, bound: &Tube<N>, point: &Vector<N>, excess: f64) -> f64 {
        // The excess is of no use to the progress of a capsule, which starts a tolerance from either end.
        let least = if bound.capsule {
            MIN_SLACK.min(1.0 / bound.scaled_length())
        } else {
            MIN_SLACK
        };
        self.progress = bound
            .along(&(point - bound.start))
            .clamp(least, 1.0 - least);
        let (low, high) = self.ends(bound, point, excess);
        let low = self.low.reset_inside(low, least);
        let beyond = low.max(self.high.reset_inside(high, least));
        let outside = self.cone.reset(&bound.value(point, excess, self.progress));
        let outside = match bound.wall_value(point, excess) {
            Some(value) => outside.max(self.wall.reset(value)),
            None => outside,
        };
        outside.max(if bound.capsule { 0.0 } else { beyond })
    }

    #[inline(always)]
    fn weigh(
        &mut self,
        bound: &Tube<N>,
        point: &Vector<N>,
        excess: f64,
        sums: &mut Sums,
    ) -> Local<N> {
        let value = bound.value(point, excess, self.progress);
        let (weight, residual) = self.cone.weigh(&value, sums);
        let ends = self.ends(bound, point, excess);
        let low = self.low.weigh(ends.0, sums);
        let high = self.high.weigh(ends.1, sums);
        let ConeWeight { head, mixed, tail } = weight;
        let mut local = Local::default();
        if bound.capsule {
            let by_radius = bound.by_radius;
            let across = times(&tail, &bound.direction);
            let length = bound.scaled_length();
            self.by_point = across * (-length * by_radius);
            self.by_excess = -length * mixed.dot(&bound.direction);
            self.by_curvature =
                1.0 / (length * length * across.dot(&bound.direction) + low.0 + high.0);
            local.point = tail * (by_radius * by_radius)
                - outer(&self.by_point, &(self.by_point * self.by_curvature));
            local.mixed = mixed * by_radius - self.by_point * (self.by_excess * self.by_curvature);
            local.excess = head - self.by_excess * self.by_excess * self.by_curvature;
        } else {
            let by_length = 1.0 / bound.length;
            let by_square = bound.by_radius * bound.by_radius;
            let direction = &bound.direction;
            let along = direction * by_length;
            // Slack and multiplier have no part along the tube, so that the weight goes straight on there.
            let straight_on = direction.dot(&times(&tail, direction)) * by_square;
            let kept = (low.0 + high.0) * by_length * by_length - straight_on;
            local.point = tail * by_square + outer(direction, &(direction * kept));
            local.mixed = bound.across(&mixed) + along * (low.0 - high.0);
            local.excess = head + low.0 + high.0;
        }
        local.slope = self.gather(bound, &residual, low.1, high.1);
        if bound.centring > 0.0 {
            self.centre(bound, point, &mut local);
        }
        if let (Some((across, _)), Some(value)) = (&bound.wall, bound.wall_value(point, excess)) {
            let (weight, residual) = self.wall.weigh(value, sums);
            local.point += outer(across, &(across * weight));
            local.mixed -= across * weight;
            local.excess += weight;
            local.slope.point -= across * residual;
            local.slope.excess += residual;
        }
        local
    }

    #[inline(always)]
    fn predict(&mut self, bound: &Tube<N>, change: &Vector<N>, excess: f64, reach: &mut Reach) {
        self.follow(change, excess);
        let ends = self.changes(bound, change, excess);
        self.low.predict(ends.0, reach);
        self.high.predict(ends.1, reach);
        if let Some((across, _)) = &bound.wall {
            self.wall.predict(excess - across.dot(change), reach);
        }
        self.cone
            .predict(&bound.change(change, excess, self.progress_change), reach);
    }

    #[inline(always)]
    fn correct(&mut self, bound: &Tube<N>, centre: Centre) -> Slope<N> {
        let low = self.low.correct(centre);
        let high = self.high.correct(centre);
        let cone = self.cone.correct(centre);
        let mut slope = self.gather(bound, &cone, low, high);
        if bound.centring > 0.0 {
            slope.point += self.pull;
        }
        if let Some((across, _)) = &bound.wall {
            let wall = self.wall.correct(centre);
            slope.point -= across * wall;
            slope.excess += wall;
        }
        slope
    }

    #[inline(always)]
    fn aim(&mut self, bound: &Tube<N>, change: &Vector<N>, excess: f64, reach: &mut Reach) {
        self.follow(change, excess);
        let ends = self.changes(bound, change, excess);
        self.low.aim(ends.0, reach);
        self.high.aim(ends.1, reach);
        if let Some((across, _)) = &bound.wall {
            self.wall.aim(excess - across.dot(change), reach);
        }
        self.cone
            .aim(&bound.change(change, excess, self.progress_change), reach);
    }

    #[inline(always)]
    fn advance(&mut self, primal: f64, dual: f64) {
        self.progress += primal * self.progress_change;
        self.low.advance(primal, dual);
        self.high.advance(primal, dual);
        self.wall.advance(primal, dual);
        self.cone.advance(primal, dual);
    }
}

//! Evaluates the part of an arc beside one of its chords.
//!
//! Source: ours. Chords are compared with the motion, but the motion itself is made of points of the arc, so that it
//! turns as steadily as the arc does. Both ends are those of the chord, whatever rounding did to the radii. Not
//! here: how many chords an arc has.

use toolglide_kinematics::{Arc, Vector};

/// Half angle below which a chord is as good as its arc, rad.
const FLAT: f64 = 1e-6;

/// A turn of at most a half circle over a chord, while the axes outside its plane advance with the angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend<const N: usize> {
    /// Middle of the chord.
    middle: Vector<N>,
    /// Radius in the direction of the chord, and away from the centre.
    along: Vector<N>,
    outward: Vector<N>,
    /// Half of the advance outside the plane.
    lift: Vector<N>,
    /// Half of the angle, rad, its cosine, and the radius.
    half: f64,
    cosine: f64,
    radius: f64,
}

/// A point in the plane of a turn, along the chord and away from the centre, and its height over the middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AroundAxis<const N: usize> {
    pub(crate) planar: [f64; 2],
    pub(crate) height: Vector<N>,
}

impl<const N: usize> Bend<N> {
    /// The part of an arc between two shares of its sweep, no more than a half circle; `None` where that is flat.
    pub(crate) fn of(arc: &Arc<N>, begin: f64, end: f64) -> Option<Self> {
        let half = 0.5 * arc.sweep().abs() * (end - begin);
        let (from, to) = (arc.point(begin), arc.point(end));
        let lift = arc.lift() * (0.5 * (end - begin));
        let along = (to - from) * 0.5 - lift;
        let (sine, cosine) = half.sin_cos();
        let square = along.norm_squared();
        if half.is_nan() || half <= FLAT || square <= 0.0 {
            return None;
        }
        let (radial, lateral) = arc.frame();
        let offset = arc.point(0.5 * (begin + end)) - arc.center();
        let planar = radial * radial.dot(&offset) + lateral * lateral.dot(&offset);
        let outward = planar - along * (planar.dot(&along) / square);
        let radius = square.sqrt() / sine;
        let away = outward.norm();
        (away > 0.0).then(|| Self {
            middle: (from + to) * 0.5,
            along: along / sine,
            outward: outward * (radius / away),
            lift,
            half,
            cosine,
            radius,
        })
    }

    /// Length of the arc, mm.
    pub(crate) fn length(&self) -> f64 {
        2.0 * (self.radius * self.half).hypot(self.lift.norm())
    }

    /// Point at a share of the angle; 0 and 1 are the ends of the chord.
    #[inline]
    pub(crate) fn point(&self, share: f64) -> Vector<N> {
        let side = 2.0 * share - 1.0;
        let (sine, cosine) = (side * self.half).sin_cos();
        self.middle + self.along * sine + self.outward * (cosine - self.cosine) + self.lift * side
    }

    /// Unit tangent at a share of the angle.
    #[inline]
    pub(crate) fn tangent(&self, share: f64) -> Vector<N> {
        let (sine, cosine) = ((2.0 * share - 1.0) * self.half).sin_cos();
        let tangent = self.along * cosine - self.outward * sine + self.lift / self.half;
        tangent / tangent.norm()
    }

    /// Angle of the turn, rad.
    pub(crate) fn angle(&self) -> f64 {
        2.0 * self.half
    }

    /// A point as seen from the axis of the turn.
    pub(crate) fn around_axis(&self, point: &Vector<N>) -> AroundAxis<N> {
        let offset = point - self.center();
        let [along, outward] = [self.along, self.outward].map(|side| side / self.radius);
        let planar = [offset.dot(&along), offset.dot(&outward)];
        AroundAxis {
            planar,
            height: offset - along * planar[0] - outward * planar[1],
        }
    }

    /// The centre, at the height of the middle.
    fn center(&self) -> Vector<N> {
        self.middle - self.outward * self.cosine
    }

    /// Advance outside the plane for each rad; `None` where there is none.
    pub(crate) fn slope(&self) -> Option<Vector<N>> {
        (self.lift.norm_squared() > 0.0).then(|| self.lift / self.half)
    }

    /// How far the circle of another part of the same arc lies from that of this one.
    pub(crate) fn unlike(&self, other: &Self) -> f64 {
        let apart = other.around_axis(&self.center()).planar;
        apart[0].hypot(apart[1]) + (self.radius - other.radius).abs()
    }

    /// Radius of curvature, mm: that of the turn, or more where it climbs.
    pub(crate) fn bending(&self) -> f64 {
        let slope = self.lift.norm() / (self.radius * self.half);
        self.radius * (1.0 + slope * slope)
    }

    /// Radius of the turn in its plane, mm.
    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bend_is_the_arc_beside_its_chord() {
        let helix = Arc::about(
            Vector::<3>::new(3.0, 1.0, 0.0),
            Vector::<3>::new(1.0, 3.0, 2.0),
            Vector::<3>::new(1.0, 1.0, 9.0),
            [0, 1],
            false,
            1,
        )
        .unwrap();
        let (begin, end) = (0.25, 0.375);
        let bend = Bend::of(&helix, begin, end).unwrap();
        for step in 0..=8 {
            let share = f64::from(step) / 8.0;
            let along = begin + share * (end - begin);
            let off = (bend.point(share) - helix.point(along)).norm();
            assert!(off < 1e-12, "{off} mm at {share}");
            let turned = (bend.tangent(share) - helix.tangent(along)).norm();
            assert!(turned < 1e-12, "{turned} at {share}");
        }
        let length = helix.length() * (end - begin);
        assert!((bend.length() - length).abs() < 1e-12, "{}", bend.length());
        assert!((bend.radius() - 2.0).abs() < 1e-12, "{}", bend.radius());
    }
}

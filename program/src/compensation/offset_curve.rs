//! Offsets lines and arcs in a plane, and intersects them.
//!
//! Source: plane geometry. Not here: what happens at a corner, see `compensation`.

use toolglide_kinematics::numeric::SHORTEST_LENGTH;

/// How far beyond its end a meeting point may lie, mm: the rounding of programs that say three
/// decimals.
const MEETING_SLACK: f64 = 1e-3;

/// A point or a direction in the plane.
pub(crate) type Flat = [f64; 2];

/// A line or an arc in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Curve {
    Line {
        from: Flat,
        to: Flat,
    },
    Arc {
        center: Flat,
        from: Flat,
        to: Flat,
        counter_clockwise: bool,
        extra_turns: u32,
    },
}

impl Curve {
    pub(crate) fn start(&self) -> Flat {
        match self {
            Self::Line { from, .. } | Self::Arc { from, .. } => *from,
        }
    }

    pub(crate) fn end(&self) -> Flat {
        match self {
            Self::Line { to, .. } | Self::Arc { to, .. } => *to,
        }
    }

    pub(crate) fn set_start(&mut self, point: Flat) {
        match self {
            Self::Line { from, .. } | Self::Arc { from, .. } => *from = point,
        }
    }

    pub(crate) fn set_end(&mut self, point: Flat) {
        match self {
            Self::Line { to, .. } | Self::Arc { to, .. } => *to = point,
        }
    }

    /// Unit tangents at both ends; none for a curve without length.
    pub(crate) fn tangents(&self) -> Option<[Flat; 2]> {
        match self {
            Self::Line { from, to } => {
                let along = minus(*to, *from);
                let length = norm(along);
                (length > SHORTEST_LENGTH).then(|| [scaled(along, 1.0 / length); 2])
            }
            Self::Arc {
                center,
                from,
                to,
                counter_clockwise,
                ..
            } => {
                let sign = if *counter_clockwise { 1.0 } else { -1.0 };
                let tangent = |point: Flat| {
                    let out = minus(point, *center);
                    let length = norm(out);
                    (length > SHORTEST_LENGTH).then(|| scaled([-out[1], out[0]], sign / length))
                };
                Some([tangent(*from)?, tangent(*to)?])
            }
        }
    }

    /// The curve at `distance` to its left; an arc that would shrink to nothing gives its radius.
    pub(crate) fn offset(&self, distance: f64) -> Result<Self, f64> {
        match *self {
            Self::Line { from, to } => {
                let along = minus(to, from);
                let length = norm(along);
                if length <= SHORTEST_LENGTH {
                    return Ok(*self);
                }
                let aside = scaled([-along[1], along[0]], distance / length);
                Ok(Self::Line {
                    from: plus(from, aside),
                    to: plus(to, aside),
                })
            }
            Self::Arc {
                center,
                from,
                to,
                counter_clockwise,
                extra_turns,
            } => {
                // The left of a counter-clockwise arc is its inside.
                let growth = if counter_clockwise {
                    -distance
                } else {
                    distance
                };
                let moved = |point: Flat| {
                    let out = minus(point, center);
                    let radius = norm(out);
                    if radius + growth <= SHORTEST_LENGTH {
                        return Err(radius);
                    }
                    Ok(plus(center, scaled(out, (radius + growth) / radius)))
                };
                Ok(Self::Arc {
                    center,
                    from: moved(from)?,
                    to: moved(to)?,
                    counter_clockwise,
                    extra_turns,
                })
            }
        }
    }

    /// Where this curve and the next meet, nearest to `corner`.
    pub(crate) fn meets(&self, next: &Self, corner: Flat) -> Option<Flat> {
        let mut candidates = [None; 2];
        match (self, next) {
            (Self::Line { from, to }, Self::Line { from: a, to: b }) => {
                candidates[0] = lines(*from, minus(*to, *from), *a, minus(*b, *a));
            }
            (Self::Line { from, to }, Self::Arc { center, .. }) => {
                candidates = line_and_circle(*from, minus(*to, *from), *center, next.radius());
            }
            (Self::Arc { center, .. }, Self::Line { from, to }) => {
                candidates = line_and_circle(*from, minus(*to, *from), *center, self.radius());
            }
            (Self::Arc { center, .. }, Self::Arc { center: other, .. }) => {
                candidates = circles(*center, self.radius(), *other, next.radius());
            }
        }
        candidates
            .into_iter()
            .flatten()
            .filter(|&point| self.holds(point) && next.holds(point))
            .min_by(|&one, &other| norm(minus(one, corner)).total_cmp(&norm(minus(other, corner))))
    }

    fn radius(&self) -> f64 {
        match self {
            Self::Line { .. } => 0.0,
            // The mean of two radii that differ by rounding.
            Self::Arc {
                center, from, to, ..
            } => 0.5 * (norm(minus(*from, *center)) + norm(minus(*to, *center))),
        }
    }

    /// Whether a point of the endless curve lies between its ends.
    fn holds(&self, point: Flat) -> bool {
        match *self {
            Self::Line { from, to } => {
                let along = minus(to, from);
                let length = norm(along);
                let place = dot(minus(point, from), along) / length;
                length > 0.0 && (-MEETING_SLACK..=length + MEETING_SLACK).contains(&place)
            }
            Self::Arc {
                center,
                from,
                to,
                counter_clockwise,
                extra_turns,
            } => {
                if extra_turns > 0 {
                    return true;
                }
                let (first, last) = if counter_clockwise {
                    (from, to)
                } else {
                    (to, from)
                };
                let slack = MEETING_SLACK / self.radius();
                let angle = |end: Flat| turn(minus(first, center), minus(end, center));
                let near = |end: Flat| norm(minus(point, end)) <= MEETING_SLACK;
                let whole = norm(minus(first, last)) <= SHORTEST_LENGTH;
                whole || near(from) || near(to) || angle(point) <= angle(last) + slack
            }
        }
    }
}

fn lines(a: Flat, along: Flat, b: Flat, other: Flat) -> Option<Flat> {
    let cross = cross(along, other);
    if cross == 0.0 {
        return None;
    }
    let share = crate::compensation::offset_curve::cross(minus(b, a), other) / cross;
    let point = plus(a, scaled(along, share));
    (point[0].is_finite() && point[1].is_finite()).then_some(point)
}

fn line_and_circle(from: Flat, along: Flat, center: Flat, radius: f64) -> [Option<Flat>; 2] {
    let length = norm(along);
    if length <= SHORTEST_LENGTH {
        return [None; 2];
    }
    let unit = scaled(along, 1.0 / length);
    let middle = dot(minus(center, from), unit);
    let foot = plus(from, scaled(unit, middle));
    half_chord(radius, norm(minus(center, foot))).map_or([None; 2], |half| {
        [half, -half].map(|share| Some(plus(foot, scaled(unit, share))))
    })
}

fn circles(one: Flat, radius: f64, other: Flat, other_radius: f64) -> [Option<Flat>; 2] {
    let between = minus(other, one);
    let distance = norm(between);
    if distance <= SHORTEST_LENGTH {
        return [None; 2];
    }
    let unit = scaled(between, 1.0 / distance);
    let along = 0.5 * (distance + (radius - other_radius) * (radius + other_radius) / distance);
    let foot = plus(one, scaled(unit, along));
    half_chord(radius, along.abs()).map_or([None; 2], |half| {
        [half, -half].map(|share| Some(plus(foot, scaled([-unit[1], unit[0]], share))))
    })
}

/// Half the chord of a circle at a distance from its centre; one that touches has none.
fn half_chord(radius: f64, distance: f64) -> Option<f64> {
    let square = (radius - distance) * (radius + distance);
    if radius + MEETING_SLACK < distance {
        return None;
    }
    Some(square.max(0.0).sqrt())
}

/// Angle from one direction to another, counter-clockwise, from 0 to a full turn, rad.
fn turn(from: Flat, to: Flat) -> f64 {
    cross(from, to)
        .atan2(dot(from, to))
        .rem_euclid(std::f64::consts::TAU)
}

pub(crate) fn plus(a: Flat, b: Flat) -> Flat {
    [a[0] + b[0], a[1] + b[1]]
}

pub(crate) fn minus(a: Flat, b: Flat) -> Flat {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn scaled(a: Flat, factor: f64) -> Flat {
    [a[0] * factor, a[1] * factor]
}

pub(crate) fn norm(a: Flat) -> f64 {
    a[0].hypot(a[1])
}

pub(crate) fn dot(a: Flat, b: Flat) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn cross(a: Flat, b: Flat) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

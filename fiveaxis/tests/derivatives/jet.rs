//! Functions of time as the first four coefficients of their Taylor series.
//!
//! Source: the recurrences of automatic differentiation: a product is a convolution, and sine, cosine
//! and the inverse tangent follow from the differential equations that they satisfy.

use std::array::from_fn;
use std::ops::{Add, Mul, Neg, Sub};

/// Coefficients of increasing powers of the time since an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet(pub(crate) [f64; 4]);

/// Number of an order.
const ORDERS: [f64; 4] = [0.0, 1.0, 2.0, 3.0];

impl Jet {
    pub(crate) const fn constant(value: f64) -> Self {
        Self([value, 0.0, 0.0, 0.0])
    }

    /// A polynomial of the third degree around a time.
    pub(crate) fn cubic([a, b, c, d]: [f64; 4], t: f64) -> Self {
        Self([
            a + (b + (c + d * t) * t) * t,
            b + (2.0 * c + 3.0 * d * t) * t,
            c + 3.0 * d * t,
            d,
        ])
    }

    /// The value and its first three derivatives.
    pub(crate) fn derivatives(self) -> [f64; 4] {
        let [a, b, c, d] = self.0;
        [a, b, 2.0 * c, 6.0 * d]
    }

    pub(crate) fn times(self, factor: f64) -> Self {
        Self(self.0.map(|coefficient| factor * coefficient))
    }

    /// s' = u'·c and c' = -u'·s.
    pub(crate) fn sin_cos(self) -> (Self, Self) {
        let u = self.0;
        let (sine, cosine) = u[0].sin_cos();
        let (mut s, mut c) = ([sine, 0.0, 0.0, 0.0], [cosine, 0.0, 0.0, 0.0]);
        for k in 1..4 {
            for j in 1..=k {
                s[k] += ORDERS[j] * u[j] * c[k - j] / ORDERS[k];
                c[k] -= ORDERS[j] * u[j] * s[k - j] / ORDERS[k];
            }
        }
        (Self(s), Self(c))
    }

    /// q·v = u.
    pub(crate) fn over(self, v: Self) -> Self {
        let mut q = [0.0; 4];
        for k in 0..4 {
            let known: f64 = (0..k).map(|j| q[j] * v.0[k - j]).sum();
            q[k] = (self.0[k] - known) / v.0[0];
        }
        Self(q)
    }

    /// r·r = u.
    pub(crate) fn root(self) -> Self {
        let mut r = [self.0[0].sqrt(), 0.0, 0.0, 0.0];
        for k in 1..4 {
            let known: f64 = (1..k).map(|j| r[j] * r[k - j]).sum();
            r[k] = (self.0[k] - known) / (2.0 * r[0]);
        }
        Self(r)
    }

    /// The angle of a point in the plane: its derivative is (x·y' - y·x') / (x² + y²).
    pub(crate) fn angle(y: Self, x: Self) -> Self {
        let rate = (x * y.slope() - y * x.slope()).over(x * x + y * y);
        Self([
            y.0[0].atan2(x.0[0]),
            rate.0[0],
            rate.0[1] / 2.0,
            rate.0[2] / 3.0,
        ])
    }

    /// The derivative, whose last coefficient is not known.
    fn slope(self) -> Self {
        let [_, b, c, d] = self.0;
        Self([b, 2.0 * c, 3.0 * d, 0.0])
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self.times(-1.0)
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(from_fn(|k| {
            (0..=k).map(|j| self.0[j] * other.0[k - j]).sum()
        }))
    }
}

/// A vector that depends on time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JetVector(pub(crate) [Jet; 3]);

impl JetVector {
    pub(crate) fn constant(vector: [f64; 3]) -> Self {
        Self(vector.map(Jet::constant))
    }

    pub(crate) fn dot(self, other: Self) -> Jet {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        a * d + b * e + c * f
    }

    pub(crate) fn cross(self, other: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        Self([b * f - c * e, c * d - a * f, a * e - b * d])
    }

    pub(crate) fn scaled(self, factor: Jet) -> Self {
        Self(self.0.map(|part| part * factor))
    }

    /// This vector turned about a unit axis: what is along the axis stays, and the rest turns in the
    /// plane across it.
    pub(crate) fn turned(self, axis: [f64; 3], angle: Jet) -> Self {
        let axis = Self::constant(axis);
        let along = axis.scaled(axis.dot(self));
        let across = self - along;
        let (sine, cosine) = angle.sin_cos();
        along + across.scaled(cosine) + axis.cross(self).scaled(sine)
    }
}

impl Add for JetVector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl Sub for JetVector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(from_fn(|k| self.0[k] - other.0[k]))
    }
}

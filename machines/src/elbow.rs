//! Solves two links and the elbow between them in a plane, both ways.
//!
//! Source: the law of cosines, with the half-angle tangent in place of arccos, which loses half of
//! its digits where the links are nearly straight or folded. Not here: which joints these are.

use toolglide_kinematics::KinematicsError;

/// A hand nearer to the shoulder than this share of both links has no direction, dimensionless:
/// some hundred roundings of their length.
const NO_DIRECTION: f64 = 1e-14;

/// A hand may be out of reach by this share of both links, dimensionless: the rounding of a stretched
/// arm, which is then taken as straight.
const STRETCH: f64 = 1e-14;

/// Two links, each longer than 0, mm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Links {
    pub(crate) upper: f64,
    pub(crate) fore: f64,
}

impl Links {
    /// Where the hand is: the upper link stands at `shoulder` from the first coordinate, the forelink
    /// at `elbow` from the upper link.
    pub(crate) fn hand(&self, shoulder: f64, elbow: f64) -> [f64; 2] {
        let (upper_sin, upper_cos) = shoulder.sin_cos();
        let (fore_sin, fore_cos) = (shoulder + elbow).sin_cos();
        [
            self.upper * upper_cos + self.fore * fore_cos,
            self.upper * upper_sin + self.fore * fore_sin,
        ]
    }

    /// Shoulder and elbow of both branches, the one with a positive elbow first. A hand on the
    /// shoulder leaves the shoulder at `near`.
    pub(crate) fn reaching(
        &self,
        hand: [f64; 2],
        near: f64,
        part: &'static str,
    ) -> Result<[[f64; 2]; 2], KinematicsError> {
        let (upper, fore) = (self.upper, self.fore);
        let distance = hand[0].hypot(hand[1]);
        let (low, high) = ((upper - fore).abs(), upper + fore);
        let slack = STRETCH * high;
        if !(low - slack..=high + slack).contains(&distance) {
            return Err(KinematicsError::Reach {
                part,
                distance,
                low,
                high,
            });
        }
        let to_straight = (high - distance).max(0.0) * (high + distance);
        let to_folded = (distance - low).max(0.0) * (distance + low);
        let elbow = 2.0 * to_straight.sqrt().atan2(to_folded.sqrt());
        let direction = if distance > NO_DIRECTION * high {
            hand[1].atan2(hand[0])
        } else {
            near + self.inner(elbow)
        };
        Ok([elbow, -elbow].map(|elbow| [direction - self.inner(elbow), elbow]))
    }

    /// Angle from the upper link to the line from shoulder to hand.
    fn inner(&self, elbow: f64) -> f64 {
        let (sin, cos) = elbow.sin_cos();
        (self.fore * sin).atan2(self.upper + self.fore * cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINKS: Links = Links {
        upper: 300.0,
        fore: 250.0,
    };

    #[test]
    fn both_branches_reach_the_hand() {
        for step in 0..=400 {
            let elbow = std::f64::consts::PI * (f64::from(step) / 200.0 - 1.0);
            for shoulder in [-2.0, 0.0, 0.5] {
                let hand = LINKS.hand(shoulder, elbow);
                for [shoulder, elbow] in LINKS.reaching(hand, 0.0, "the arm").unwrap() {
                    let again = LINKS.hand(shoulder, elbow);
                    let miss = (again[0] - hand[0]).hypot(again[1] - hand[1]);
                    assert!(miss < 5e-13, "{shoulder} {elbow}: {miss:e}");
                }
            }
        }
    }

    #[test]
    fn a_hand_too_far_or_too_near_is_refused_by_how_much() {
        let refused = LINKS.reaching([0.0, 560.0], 0.0, "the arm").unwrap_err();
        assert_eq!(
            refused.to_string(),
            "out of reach: the arm would span 560 mm, but can span 50 to 550 mm; 10 mm too far"
        );
        let refused = LINKS.reaching([30.0, 0.0], 0.0, "the arm").unwrap_err();
        assert!(refused.to_string().contains("20 mm too near"), "{refused}");
    }

    #[test]
    fn a_hand_on_the_shoulder_leaves_the_shoulder_where_it_is() {
        let equal = Links {
            upper: 200.0,
            fore: 200.0,
        };
        let [[shoulder, elbow], _] = equal.reaching([0.0, 0.0], 0.7, "the arm").unwrap();
        assert!((shoulder - 0.7).abs() < 1e-15, "{shoulder}");
        assert!((elbow - std::f64::consts::PI).abs() < 1e-15, "{elbow}");
    }
}

//! Judges limits and travel of the axes at the last rows.
//!
//! Source: divided differences, less what rounding may add to them. Not here: the tool.

use crate::poses::FOUND_SLACK;
use crate::poses::report::{AxisQuantity, PoseViolation};
use crate::poses::set_points::{PoseSetPointJudge, Sighting};
use crate::report::Place;
use toolglide_kinematics::{AxisKind, KinematicsError};

impl PoseSetPointJudge<'_> {
    pub(super) fn judge_axes(&mut self, place: Place) {
        let rows = &self.rows;
        let newest = rows.len() - 1;
        let Sighting { time, axes: at, .. } = rows[newest];
        for (index, axis) in self.axes.iter().enumerate() {
            let rounding = self.rounding[index];
            if let Some((low, high)) = axis.travel
                && !(low - rounding..=high + rounding).contains(&at[index])
            {
                let reason = KinematicsError::Travel {
                    axis: axis.name,
                    kind: axis.kind,
                    position: at[index],
                    low,
                    high,
                };
                self.report.add(PoseViolation::Unreachable {
                    reason: reason.to_string(),
                    time,
                    place,
                });
            }
            let peaks = &mut self.report.axes[index];
            peaks.lowest = peaks.lowest.min(at[index]);
            peaks.highest = peaks.highest.max(at[index]);
            let limits = [
                axis.limits.velocity(),
                axis.limits.acceleration(),
                axis.limits.jerk(),
            ];
            let quantities = [
                AxisQuantity::Velocity,
                AxisQuantity::Acceleration,
                AxisQuantity::Jerk,
            ];
            let mut factorial = 1.0;
            let mut order = 0;
            for ((limit, quantity), peak) in limits.into_iter().zip(quantities).zip([
                &mut peaks.velocity,
                &mut peaks.acceleration,
                &mut peaks.jerk,
            ]) {
                order += 1;
                factorial *= f64::from(order);
                let count = usize::try_from(order).unwrap_or(0) + 1;
                if rows.len() < count {
                    break;
                }
                let recent = rows.range(rows.len() - count..);
                let (mut sum, mut noise) = (0.0, 0.0);
                for (one, row) in recent.clone().enumerate() {
                    let mut product = 1.0;
                    for (other, another) in recent.clone().enumerate() {
                        if other != one {
                            product *= row.time - another.time;
                        }
                    }
                    // Differences from the newest row keep the digits of large positions.
                    sum += (row.axes[index] - at[index]) / product;
                    let wobble = match axis.kind {
                        AxisKind::Rotary => row.wobble,
                        AxisKind::Linear => row.wobble * row.lever,
                    };
                    noise += (rounding + wobble) / product.abs();
                }
                let certain = factorial * (sum.abs() - noise).max(0.0);
                peak.raise(certain, time, place);
                if certain > limit * (1.0 + FOUND_SLACK) {
                    self.report.violations += 1;
                    if self.report.examples.len() < 10 {
                        self.report.examples.push(PoseViolation::Axis {
                            axis: axis.name,
                            kind: axis.kind,
                            quantity,
                            value: certain,
                            limit,
                            time,
                            place,
                        });
                    }
                }
            }
        }
    }
}

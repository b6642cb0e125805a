//! Judges whether rows of axes are near enough to each other to show what they are judged by.
//!
//! Source: each axis leaves the chord of a time by at most an eighth of its square times how hard it accelerates,
//! which the rows and the limit of its jerk show; forward kinematics says what that is at the tool, axis by axis.
//! Not here: what is shown of limits, see `verify::coarse`.

use crate::poses::set_points::{PoseSetPointJudge, Sighting};
use crate::set_points::spacing::{Unseen, bend_distance, is_fine, unseen_limits};
use toolglide_kinematics::AxisVector;
use toolglide_kinematics::angle_between;
use toolglide_kinematics::numeric::LIMIT_SLACK;

/// The time between two rows, and how far tip (mm) and tool (rad) may be between them from where the axes are
/// straight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spacing {
    begin: f64,
    duration: f64,
    /// As the rows and the limits of jerk show.
    pub(super) shown: [f64; 2],
    /// With every axis at its limit of acceleration.
    most: [f64; 2],
}

impl PoseSetPointJudge<'_> {
    /// The time between the row of a time and the one before; `None` where nothing lies between.
    pub(super) fn spacing(&self, time: f64) -> Option<Spacing> {
        let newest = self.rows.iter().rposition(|row| row.time <= time)?;
        let begin = self.rows.get(newest.checked_sub(1)?)?.time;
        let duration = self.rows.get(newest)?.time - begin;
        (!is_fine(duration)).then(|| self.hidden(newest, begin, duration))
    }

    /// Judges a time between rows, along which tip and tool have these tolerances at least.
    pub(super) fn judge_spacing(&mut self, spacing: &Spacing, [tip, tool]: [f64; 2]) {
        let Spacing {
            begin,
            duration,
            shown,
            most,
        } = *spacing;
        let leaves = |hidden: f64, most: f64, tolerance: f64, unseen: Unseen| {
            let needed = duration * (tolerance / most).sqrt();
            (hidden > tolerance * (1.0 + LIMIT_SLACK)).then_some((unseen, needed))
        };
        let off_path = Unseen::Path {
            hidden: shown[0],
            tolerance: tip,
        };
        let turned = Unseen::Orientation {
            hidden: shown[1],
            tolerance: tool,
        };
        let unseen: Vec<_> = self
            .axes
            .iter()
            .flat_map(|axis| unseen_limits(axis.name, axis.limits, duration))
            .chain(leaves(shown[0], most[0], tip, off_path))
            .chain(leaves(shown[1], most[1], tool, turned))
            .collect();
        let place = self.place();
        self.report
            .gaps
            .add(begin - self.start, duration, place, unseen);
    }

    fn hidden(&self, newest: usize, begin: f64, duration: f64) -> Spacing {
        let (one, two) = (&self.rows[newest - 1], &self.rows[newest]);
        let oldest = newest.checked_sub(2).and_then(|index| self.rows.get(index));
        let mut sums = Spacing {
            begin,
            duration,
            shown: [0.0; 2],
            most: [0.0; 2],
        };
        let Ok(there) = self.machine.forward(&two.axes) else {
            return sums;
        };
        for (index, axis) in self.axes.iter().enumerate() {
            let (seen, distance) = oldest.map_or((0.0, duration), |oldest| {
                let span = one.time - oldest.time;
                (bend(oldest, one, two, index), bend_distance(span, duration))
            });
            let most = axis.limits.acceleration();
            let hard = (seen + axis.limits.jerk() * distance).min(most);
            let mut moved: AxisVector = two.axes;
            moved[index] += hard * duration * duration / 8.0;
            let Ok(pose) = self.machine.forward(&moved) else {
                continue;
            };
            let tip = (pose.tip() - there.tip()).norm();
            let tool = angle_between(&pose.orientation(), &there.orientation());
            for (which, away) in [tip, tool].into_iter().enumerate() {
                sums.shown[which] += away;
                sums.most[which] += away * most / hard;
            }
        }
        sums
    }
}

/// Second difference of an axis over three rows.
fn bend(oldest: &Sighting, one: &Sighting, two: &Sighting, axis: usize) -> f64 {
    let (before, after) = (one.time - oldest.time, two.time - one.time);
    let arrives = (one.axes[axis] - oldest.axes[axis]) / before;
    let leaves = (two.axes[axis] - one.axes[axis]) / after;
    (2.0 * (leaves - arrives) / (before + after)).abs()
}

//! Stops at every corner where that takes less time than going on.
//!
//! Source: ours. Not here: how what goes on is planned.

use super::LookAhead;
use super::feedrates::Corners;
use crate::pulse::Pulse;

impl<const N: usize> LookAhead<N> {
    /// Stops at every corner where that takes less time and keeps in step; whether it does. Longer dwells
    /// are always safe.
    pub(super) fn stop_where_faster(&mut self) -> bool {
        let total = self.chain.total();
        let first = self.fixed.saturating_sub(1);
        let end = if self.fixed > 0 {
            self.schedule.end(first)
        } else {
            0.0
        };
        let Some(last) = self.pulses.len().checked_sub(1) else {
            return false;
        };
        let planned = self.schedule.end(last) - end;
        let moving = self.least_time();
        let stops = self.pulses[first..last]
            .iter()
            .filter(|pulse| is_corner(pulse));
        let mut dwelling = 0.0;
        stops.for_each(|_| dwelling += total);
        if dwelling <= 0.0 || planned <= moving + dwelling {
            return false;
        }
        self.kept.clear();
        self.kept.extend_from_slice(&self.pulses);
        let capped = core::mem::replace(&mut self.capped, false);
        // Behind the first stop nothing is left of the plan, before it as little as may be.
        let stop = (first..last).find(|&index| is_corner(&self.pulses[index]));
        for from in [self.fixed, stop.map_or(last, |corner| corner + 1)] {
            self.pulses.clear();
            self.pulses.extend_from_slice(&self.kept);
            let rests = from
                .checked_sub(1)
                .is_none_or(|corner| is_corner(&self.pulses[corner]));
            self.stop_from(from);
            let last = self.pulses.len() - 1;
            if self.schedule.end(last) - end > planned {
                break;
            }
            if self.in_step() && (rests || self.holds()) {
                return true;
            }
        }
        core::mem::swap(&mut self.pulses, &mut self.kept);
        self.capped = capped;
        self.time();
        false
    }

    /// Stops at every corner from the beginning of a pulse on.
    fn stop_from(&mut self, from: usize) {
        self.join(from);
        if let Some(before) = from.checked_sub(1)
            && is_corner(&self.pulses[before])
        {
            let corner = &mut self.pulses[before];
            corner.pass = false;
            corner.overlap = 0.0;
        }
        for pulse in &mut self.pulses[from..] {
            pulse.feed = pulse.limit;
            let stops = is_corner(pulse);
            pulse.pass = !stops;
            pulse.overlap = if stops { 0.0 } else { self.chain.total() };
        }
        self.ramp();
        // What was handed out is slow enough, or a stop away.
        if self
            .keep_feedrates(Corners::All)
            .is_some_and(|kept| kept.slower)
        {
            self.ramp();
        }
        self.time();
    }

    /// Less time than what waits takes with a full stop at every corner, but for the dwells.
    fn least_time(&self) -> f64 {
        let (mut time, mut length) = (0.0, 0.0);
        for pulse in &self.pulses[self.fixed..] {
            time += pulse.length / pulse.limit;
            length += pulse.length;
            if pulse.part {
                continue;
            }
            let acceleration = pulse.step / self.chain.long();
            if pulse.arc.is_none() && length * acceleration > pulse.limit * pulse.limit {
                let missing = (pulse.limit - pulse.step).max(0.0);
                time += missing * missing / (acceleration * pulse.limit);
            }
            length = 0.0;
        }
        time
    }
}

/// Whether the path turns at the end of a pulse otherwise than along an arc.
fn is_corner<const N: usize>(pulse: &Pulse<N>) -> bool {
    !pulse.smooth && pulse.turn > 0.0
}

//! Remembers which moves the plan served at which set-points within a window.
//!
//! Not here: where the moves are.

use std::collections::VecDeque;
use toolglide_kinematics::MoveRange;

/// The moves that the plan follows from a set-point on.
#[derive(Clone, Copy, Debug)]
struct Served {
    from: u64,
    serves: MoveRange,
}

/// Which moves were served when.
#[derive(Clone, Debug)]
pub(crate) struct Serving {
    entries: VecDeque<Served>,
    lag: u64,
}

impl Serving {
    /// A window of `lag` set-points behind now; `kept` are all that may be known.
    pub(crate) fn new(lag: u64, kept: usize) -> Self {
        Self {
            entries: VecDeque::with_capacity(kept + 4),
            lag,
        }
    }

    /// From set-point `from` on the plan follows these moves; of pieces between two set-points all are served.
    #[inline]
    pub(crate) fn serve(&mut self, from: u64, serves: MoveRange) {
        if let Some(last) = self.entries.back_mut() {
            if last.serves.first <= serves.first && serves.last <= last.serves.last {
                if last.serves == serves {
                    return;
                }
            } else if last.from == from {
                last.serves.first = last.serves.first.min(serves.first);
                last.serves.last = last.serves.last.max(serves.last);
                return;
            }
            if last.from == from {
                return;
            }
        }
        self.entries.push_back(Served { from, serves });
    }

    /// The moves that are served from `lag` set-points before `now` until `ahead` after it.
    #[inline]
    pub(crate) fn around(&mut self, now: u64, ahead: u64) -> MoveRange {
        let oldest = now.saturating_sub(self.lag);
        while self.entries.get(1).is_some_and(|next| next.from <= oldest) {
            self.entries.pop_front();
        }
        let Some(front) = self.entries.front() else {
            return MoveRange { first: 0, last: 0 };
        };
        let first = front.serves.first;
        let last = self
            .entries
            .iter()
            .rev()
            .find(|entry| entry.from <= now + ahead)
            .map_or(front.serves.last, |entry| entry.serves.last);
        MoveRange { first, last }
    }
}

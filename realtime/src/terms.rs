//! Describes a piece beside its motion: its feedrate, and the override that concerns it.

/// The override that concerns a piece.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Class {
    /// Cutting: the feed override.
    #[default]
    Feed,
    /// A rapid move: the rapid override.
    Rapid,
}

/// Knowledge about a piece beside its motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Programmed feedrate, mm/s: without any override. Infinite for none.
    pub feedrate: f64,
    /// The override that concerns it.
    pub class: Class,
}

impl Default for Terms {
    /// A cut without a feedrate: the override scales the rate of time.
    fn default() -> Self {
        Self {
            feedrate: f64::INFINITY,
            class: Class::Feed,
        }
    }
}

impl Terms {
    /// A cut at a programmed feedrate, mm/s.
    #[must_use]
    pub fn feed(feedrate: f64) -> Self {
        Self {
            feedrate,
            class: Class::Feed,
        }
    }

    /// A rapid move.
    #[must_use]
    pub fn rapid() -> Self {
        Self {
            feedrate: f64::INFINITY,
            class: Class::Rapid,
        }
    }
}

/// The overrides in force, and how they bound the rate on a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Caps {
    /// Feed override, 1 for the programmed feedrate.
    pub(crate) feed: f64,
    /// Rapid override, at most 1.
    pub(crate) rapid: f64,
    /// Feed override for which the motion was planned.
    pub(crate) top: f64,
    /// Whether an override scales the rate of time instead of capping the speed.
    pub(crate) uniform: bool,
}

impl Caps {
    /// Whether nothing is bounded.
    pub(crate) fn open(&self) -> bool {
        self.feed >= self.top && self.rapid >= 1.0
    }

    /// Largest speed along the path, infinite for none, and largest rate.
    #[inline]
    pub(crate) fn of(&self, terms: &Terms) -> (f64, f64) {
        match terms.class {
            Class::Rapid => (f64::INFINITY, self.rapid),
            Class::Feed if self.uniform || terms.feedrate.is_infinite() => {
                (f64::INFINITY, self.feed / self.top)
            }
            Class::Feed if self.feed >= self.top => (f64::INFINITY, 1.0),
            Class::Feed => (self.feed * terms.feedrate, 1.0),
        }
    }

    /// A rate that keeps the caps anywhere on a piece whose speed is at most `speed`.
    #[inline]
    pub(crate) fn rate(&self, terms: &Terms, speed: f64) -> f64 {
        let (cap, rate) = self.of(terms);
        if speed > cap {
            rate.min(cap / speed)
        } else {
            rate
        }
    }
}

//! Filters commanded positions tick by tick in integers.

pub(crate) mod tick_clock;
pub(crate) mod tick_filter;
pub(crate) mod tick_pulse;

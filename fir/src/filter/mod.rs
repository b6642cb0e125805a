//! Evaluates chains of moving averages: kernels, exact motion behind them, modes of vibration.

pub(crate) mod chain;
pub(crate) mod cubic;
pub(crate) mod kernel;
pub(crate) mod notch;
pub(crate) mod taps;
pub(crate) mod train;

//! Writes one HTML page that shows a motion: the path in 3-D, charts with their limits, the program, and where
//! the time goes.
//!
//! The page opens from disk and asks no network. It holds the pieces of the motion, not set-points, so that every
//! zoom is exact. [`PathRecorder`] gathers the moves, [`MotionRecorder`] the motion of one method while it streams
//! past, and [`Page`] writes the file. Not here: planning, judging, files.

mod columns;
mod envelope;
mod motion;
mod page;
mod path;
mod time_spent;

pub use motion::{MAX_PIECES, Motion, MotionRecorder};
pub use page::{AxisInfo, Page, PageError};
pub use path::PathRecorder;
pub use time_spent::Cause;

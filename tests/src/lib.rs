//! What every planner must keep, whichever crate it lives in: random paths and limits to try it on,
//! part programs to feed it, and the bounds that the tests assert.
//!
//! The tests themselves stand in `tests/tests`, one property a file. Nothing depends on this crate.

#![allow(
    clippy::unwrap_used,
    reason = "only tests use this crate: a failed unwrap is a failed test"
)]

pub mod anything;
pub mod bounds;
pub mod corpus;
pub mod course;
pub mod feeds;
pub mod filtered;
pub mod judged;
pub mod run;
pub mod strategies;
pub mod stream;

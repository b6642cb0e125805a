//! Provides random paths and limits, part programs and bounds for the properties that every planner
//! must keep.
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
pub mod pieces;
pub mod run;
pub mod spectrum;
pub mod strategies;
pub mod stream;

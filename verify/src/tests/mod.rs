//! Hand-made motions, each with one known defect or none.

mod awkward;
mod build;
mod coarse;
mod course;
mod defects;
mod limits;
mod order;
mod points;
mod search;
mod smoothness;

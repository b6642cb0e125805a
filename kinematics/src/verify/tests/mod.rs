//! Hand-made motions, each with one known defect or none.

mod awkward;
mod build;
mod defects;
mod order;
mod points;
mod search;

//! Writes what a command found: set-points, summaries, tables.

pub(crate) mod comparison;
pub(crate) mod csv_writer;
pub(crate) mod decimals;
pub(crate) mod files;
pub(crate) mod output_files;
pub(crate) mod page;
pub(crate) mod part;
pub(crate) mod program_report;
pub(crate) mod progress;
pub(crate) mod report;
pub(crate) mod score_report;
pub(crate) mod smoothness;
pub(crate) mod summary;

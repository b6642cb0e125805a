//! Machines as plugins: what a machine file may say, and which machines can be built from it.
//!
//! A machine is one file that ends with its registration; nothing else in the workspace names it.
//! Programs list the machines with [`models`] and build them by name with [`find`]; a controller
//! that is linked where [`inventory`] cannot work lists its models itself in a [`Registry`].

mod config;
mod error;
mod file;
mod gantry;
mod geometry;
mod registry;
mod structure;
mod swivel;
mod table_ac;
mod table_bc;

pub use config::{AxisConfig, MachineConfig, ModeConfig};
pub use error::MachineError;
pub use file::{from_toml, load, schema};
pub use gantry::GANTRY;
pub use geometry::{Distance, WORKPIECE};
pub use inventory;
pub use registry::{MachineModel, Registry, find, models};
pub use structure::{Assembly, Branches, Structure, upright};
pub use table_ac::TABLE_AC;
pub use table_bc::TABLE_BC;

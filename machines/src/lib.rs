//! Registers machines as plugins and builds them from machine files.
//!
//! A machine is one file that ends with its registration; nothing else in the workspace names it.
//! Programs list the machines with [`models`] and build them by name with [`find`]; a controller
//! that is linked where [`inventory`] cannot work lists its models itself in a [`Registry`].

mod arm_6r;
mod config;
mod corexy;
mod delta;
mod drive;
mod elbow;
mod error;
mod file;
mod gantry;
mod geometry;
mod head_bc;
mod head_table_bc;
mod plain;
mod registry;
mod scara;
mod structure;
mod swivel;
mod table_ac;
mod table_bc;
mod tilting_table;

pub use arm_6r::ARM_6R;
pub use config::{AxisConfig, MachineConfig, ModeConfig};
pub use corexy::COREXY;
pub use delta::DELTA;
pub use drive::{
    DriveConfig, FeedforwardConfig, FrictionConfig, InterpolationConfig, MeasuresConfig,
};
pub use error::MachineError;
pub use file::{from_toml, load, schema};
pub use gantry::GANTRY;
pub use geometry::{Distance, WORKPIECE, WORKPIECE_ON_TABLE};
pub use head_bc::HEAD_BC;
pub use head_table_bc::HEAD_TABLE_BC;
pub use inventory;
pub use plain::{GANTRY_A, GANTRY_ABC, GANTRY_B, GANTRY_C, GANTRY_UVW, HOT_WIRE, is_plain};
pub use registry::{MachineModel, Registry, find, models};
pub use scara::SCARA;
pub use structure::{Assembly, Branches, Structure, upright};
pub use table_ac::TABLE_AC;
pub use table_bc::TABLE_BC;

//! Brings what the standard library has in its prelude, and the functions of real numbers, to builds without it.

pub use alloc::boxed::Box;
pub use alloc::string::{String, ToString};
pub use alloc::vec::Vec;
pub use alloc::{borrow::ToOwned, format, vec};
pub use nalgebra::{ComplexField, RealField};

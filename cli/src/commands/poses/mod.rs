//! Plans, judges, writes and draws programs of tool poses.
//!
//! Not here: reading programs, planning, and machines.

mod check;
mod corner;
mod inputs;
mod plot;
mod rows;
mod run;
mod summary;
mod zoom;

pub(crate) use check::verify;
pub(crate) use inputs::concerns;
pub(crate) use run::plan;

use crate::methods::MethodName;

/// All methods for tool poses, the default first.
pub(crate) const METHODS: &[MethodName] = &[
    MethodName {
        name: "ns-dcb",
        summary: "tool poses: the dwell at each corner as short as both tolerances allow",
    },
    MethodName {
        name: "ns-vcb",
        summary: "tool poses: no dwell, slow pulses at each corner",
    },
    MethodName {
        name: "ns-jcb",
        summary: "tool poses: axes go straight between the poses whatever the tolerances, to compare with",
    },
    MethodName {
        name: "p2p",
        summary: "tool poses: a full stop at every pose",
    },
];

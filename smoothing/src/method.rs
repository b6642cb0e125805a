//! Selects the corner motions that a plan may use, and holds the settings of the planner.
//!
//! Source: the comparison of section 2.4. Not here: the planning.

use crate::corner::candidates::blenders_of;
use std::sync::Arc;
use toolglide_kinematics::Limits;
use toolglide_profiles::Blender;

/// Which corner motions a plan may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// The fastest motion at every corner, stopping included: never slower than [`Method::ExactStop`].
    /// No other method promises that, because each forces one kind of corner.
    Kcs,
    /// Uninterrupted acceleration at every corner.
    KcsUninterrupted,
    /// Interrupted acceleration at every corner.
    KcsInterrupted,
    /// The dissertation's local corners: uninterrupted acceleration, each corner by itself, every move
    /// as programmed.
    KcsLocal,
    /// The dissertation's global corners: as local, with corners overlapping where moves are short.
    KcsGlobal,
    /// A full stop at the end of every move; arcs are smooth in between.
    ExactStop,
}

impl Method {
    /// All methods, the default first.
    pub const ALL: [Self; 6] = [
        Self::Kcs,
        Self::KcsUninterrupted,
        Self::KcsInterrupted,
        Self::KcsLocal,
        Self::KcsGlobal,
        Self::ExactStop,
    ];

    /// The name as commands and reports write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Kcs => "kcs",
            Self::KcsUninterrupted => "kcs-uninterrupted",
            Self::KcsInterrupted => "kcs-interrupted",
            Self::KcsLocal => "kcs-local",
            Self::KcsGlobal => "kcs-global",
            Self::ExactStop => "exact-stop",
        }
    }

    /// The method of a name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }
}

/// What a plan must keep and may use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<const N: usize> {
    /// Limits of the axes.
    pub limits: Limits<N>,
    /// Which corner motions may be used.
    pub method: Method,
    /// Corners that the look-ahead window holds, at least 2. A window shorter than the way to a
    /// stop costs time, never safety.
    pub window: usize,
}

impl<const N: usize> Settings<N> {
    /// The default method in a window of 512 corners.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self {
            limits,
            method: Method::Kcs,
            window: 512,
        }
    }

    /// The blenders among which the method takes the fastest at every corner.
    ///
    /// A method that forces uninterrupted corners turns by interrupted ones where the path goes straight
    /// on.
    #[must_use]
    pub fn blenders(&self) -> Vec<Arc<dyn Blender<N>>> {
        blenders_of(self)
    }

    /// The same with another method.
    #[must_use]
    pub fn with_method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// The same with another window.
    #[must_use]
    pub fn with_window(mut self, window: usize) -> Self {
        self.window = window;
        self
    }
}

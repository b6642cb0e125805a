//! Turns written curves into arcs and chords: circles, splines, arcs in tilted planes.

pub(crate) mod arcs;
pub(crate) mod bezier;
pub(crate) mod chords;
pub(crate) mod corner_breaks;
pub(crate) mod knot_spline;
pub(crate) mod splines;
pub(crate) mod turned_arcs;

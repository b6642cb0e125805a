//! Motions of poses that must pass, and motions that must not.

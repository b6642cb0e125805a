//! Splits the text of a program into lines, words and numbers, each with its place.

pub(crate) mod language;
pub(crate) mod lexer;
pub(crate) mod lines;
pub(crate) mod number;
pub(crate) mod place;
pub(crate) mod recognise;

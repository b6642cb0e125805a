//! Reads programs of FANUC and Haas mills into the blocks and moves of RS274/NGC.
//!
//! Source: the operator's manuals of FANUC 0i and 30i and of Haas mills; `docs/programs.md` of the project lists
//! every word. The modal state and the moves are those of [`Interpreter`](crate::interpreter::Lowering). Not here:
//! lathes.

mod actions;
mod arguments;
mod block;
mod calls;
mod codes;
mod course;
mod data;
mod finding;
mod functions;
mod homes;
mod labels;
mod lines;
mod memory;
mod modal_words;
mod modes;
mod pocket;
mod polar;
mod signs;
mod statements;
mod taking;
mod transforms;
mod value;
mod words;

use crate::block::codes::Motion;
use crate::fanuc::arguments::ModalMacro;
use crate::fanuc::course::Course;
use crate::fanuc::memory::{Locals, Memory};
use crate::fanuc::polar::Polar;
use crate::fanuc::transforms::Transforms;
use crate::fanuc::words::Word;
use std::collections::{BTreeMap, BTreeSet};
use toolglide_kinematics::Vector;

pub(crate) use crate::fanuc::signs::{explained, looks_like};

/// What a program has said that blocks of RS274/NGC cannot hold.
#[derive(Debug)]
pub(crate) struct Fanuc {
    course: Course,
    memory: Memory,
    transforms: Transforms,
    /// Polar coordinates by `G16`.
    polar: Option<Polar>,
    /// The macro of `G66`.
    modal_macro: Option<ModalMacro>,
    /// Arguments of the macros that run.
    arguments: Vec<Locals>,
    /// Wear of tools, by their numbers: length and radius, mm.
    wear: BTreeMap<u32, [f64; 2]>,
    /// The motion that `G80` goes back to.
    straight: Motion,
    /// The point by way of which an axis went to its reference point, in the program, mm.
    via: Option<Vector<3>>,
    /// Code of the tool length in force, in tenths.
    length: Option<u16>,
    /// What was noted already.
    noted: BTreeSet<Box<str>>,
    /// Whether a leader was looked for.
    started: bool,
    /// Whether the `%` that opens the program was met.
    opened: bool,
    /// Whether a line of the program was met.
    begun: bool,
    /// The line being run, and its words.
    text: Vec<u8>,
    words: Vec<Word>,
}

impl Fanuc {
    pub(crate) fn new() -> Self {
        Self {
            course: Course::new(),
            memory: Memory::new(),
            transforms: Transforms::default(),
            polar: None,
            modal_macro: None,
            arguments: Vec::new(),
            wear: BTreeMap::new(),
            straight: Motion::Rapid,
            via: None,
            length: None,
            noted: BTreeSet::new(),
            started: false,
            opened: false,
            begun: false,
            text: Vec::new(),
            words: Vec::new(),
        }
    }
}

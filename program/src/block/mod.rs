//! Turns one line of words into a block, with no two codes that exclude each other.
//!
//! Source: the modal groups of RS274/NGC. Not here: the modal state, and which words a code needs.

pub(crate) mod code;
pub(crate) mod code_table;
pub(crate) mod codes;
pub(crate) mod modal_groups;
pub(crate) mod word_usage;

use crate::curves::corner_breaks::CornerKind;
use crate::error::reason::Reason;
use crate::error::{Fault, Notice, Remark};
use crate::expression::parameters::Values;
use crate::interpreter::units::Units;
use crate::poses::axis_moves::AXES_BESIDE;
use crate::settings::Settings;
use crate::text::lexer::{Assignment, Lexer, Word};
use crate::text::place::Span;
use code::Code;
use codes::{
    Distance, FeedMode, Group, Motion, Once, PathControl, Plane, Saving, Side, Stop, Subprogram,
    ToolLength, Way,
};
use std::sync::Arc;

/// Letters of the axes, in the order of coordinates.
pub(crate) const AXES: [u8; 3] = *b"XYZ";

/// Letters of the offsets of a centre, in the order of coordinates.
pub(crate) const OFFSETS: [u8; 3] = *b"IJK";

/// Letters that move something or name a point: those of the axes, and distance and angle.
pub(crate) const POINT: [u8; 11] = *b"XYZ@^ABCUVW";

/// Letters, `@`, `^` and `$`.
const LETTERS: usize = 29;

/// Groups that need nothing beyond the modal state and a motion.
const PLAIN: u32 = 1 << Group::Motion as u32
    | 1 << Group::Distance as u32
    | 1 << Group::ArcDistance as u32
    | 1 << Group::FeedMode as u32
    | 1 << Group::PathControl as u32
    | 1 << Group::Units as u32;

/// Parts of the language that are no code, one bit each.
pub(crate) const PARAMETERS: u8 = 1;
pub(crate) const POLAR: u8 = 2;
pub(crate) const ROTARY: u8 = 4;
pub(crate) const EXTRUDER: u8 = 8;
pub(crate) const O_WORDS: u8 = 16;
pub(crate) const SECONDARY: u8 = 32;

/// Names of these parts.
pub(crate) const FEATURES: [(u8, &str); 6] = [
    (PARAMETERS, "parameters and expressions"),
    (O_WORDS, "O words"),
    (POLAR, "polar coordinates"),
    (ROTARY, "rotary axes"),
    (SECONDARY, "secondary axes U V W"),
    (EXTRUDER, "extruder"),
];

/// The words of one line.
///
/// One block is reused for all lines, so that reading allocates nothing.
#[derive(Debug)]
pub(crate) struct Block {
    present: u32,
    values: [f64; LETTERS],
    spans: [Span; LETTERS],
    /// Words that say themselves whether they are places or steps.
    ways: [Option<Way>; LETTERS],
    pub(crate) taken: u32,
    pub(crate) takers: [(Code, Span); Group::COUNT],
    /// Code that strict reading refuses, with its reason; lenient reading skips it.
    pub(crate) foreign: Option<(Code, Fault)>,
    words: u32,
    /// Parameters that the line sets once it is read.
    pub(crate) assignments: Vec<Assignment>,
    /// Whether the machine has rotary axes.
    pub(crate) rotary: bool,
    /// Whether it has secondary axes U, V and W.
    pub(crate) secondary: bool,
    /// Axes A, B, C, U, V and W that it has beside X, Y and Z, with no tool pose behind them.
    pub(crate) beside: [bool; 6],
    /// Its name; empty where nobody gave one.
    pub(crate) machine: Arc<str>,
    /// Whether a word said that an axis which is not there is at 0, and of which that was told.
    pub(crate) absent: bool,
    absent_noted: u32,
    /// Whether the program is one of a printer, whose E is its extruder.
    pub(crate) printer: bool,
    /// What was met beside codes.
    pub(crate) features: u8,
    /// How often each code was met, for `G` and `M` by ten times its number, as far as one was met.
    pub(crate) counts: [Vec<u64>; 2],
    pub(crate) motion: Option<Motion>,
    pub(crate) end_of_nurbs: bool,
    pub(crate) once: Option<Once>,
    pub(crate) side: Option<Side>,
    pub(crate) tool_length: Option<ToolLength>,
    pub(crate) coordinates: Option<u8>,
    pub(crate) return_to_start: Option<bool>,
    pub(crate) tool_change: bool,
    pub(crate) tool_tip: Option<bool>,
    pub(crate) saving: Option<Saving>,
    pub(crate) outside: bool,
    pub(crate) plane: Option<Plane>,
    pub(crate) units: Option<Units>,
    pub(crate) distance: Option<Distance>,
    pub(crate) arc_distance: Option<Distance>,
    pub(crate) feed_mode: Option<FeedMode>,
    pub(crate) path_control: Option<PathControl>,
    pub(crate) stop: Option<Stop>,
    pub(crate) subprogram: Option<Subprogram>,
    /// How the corner at the end of the block is broken, as written.
    pub(crate) corner: Option<(CornerKind, f64, Span)>,
}

impl Block {
    pub(crate) fn new() -> Self {
        Self {
            present: 0,
            values: [0.0; LETTERS],
            spans: [Span::default(); LETTERS],
            ways: [None; LETTERS],
            taken: 0,
            takers: [(Code::new(b'G', 0), Span::default()); Group::COUNT],
            foreign: None,
            words: 0,
            assignments: Vec::new(),
            rotary: false,
            secondary: false,
            beside: [false; 6],
            machine: Arc::from(""),
            absent: false,
            absent_noted: 0,
            printer: false,
            features: 0,
            counts: [Vec::new(), Vec::new()],
            motion: None,
            end_of_nurbs: false,
            once: None,
            side: None,
            tool_length: None,
            coordinates: None,
            return_to_start: None,
            tool_change: false,
            tool_tip: None,
            saving: None,
            outside: false,
            plane: None,
            units: None,
            distance: None,
            arc_distance: None,
            feed_mode: None,
            path_control: None,
            stop: None,
            subprogram: None,
            corner: None,
        }
    }

    fn clear(&mut self) {
        self.present = 0;
        self.ways = [None; LETTERS];
        self.taken = 0;
        self.foreign = None;
        self.absent = false;
        self.words = 0;
        self.assignments.clear();
        self.motion = None;
        self.end_of_nurbs = false;
        self.once = None;
        self.side = None;
        self.tool_length = None;
        self.coordinates = None;
        self.return_to_start = None;
        self.tool_change = false;
        self.tool_tip = None;
        self.saving = None;
        self.outside = false;
        self.plane = None;
        self.units = None;
        self.distance = None;
        self.arc_distance = None;
        self.feed_mode = None;
        self.path_control = None;
        self.stop = None;
        self.subprogram = None;
        self.corner = None;
    }

    /// Replaces the block by the words of `line`.
    pub(crate) fn read(
        &mut self,
        line: &[u8],
        values: &dyn Values,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        self.clear();
        let mut assignments = std::mem::take(&mut self.assignments);
        let outcome = self.words_of(line, values, settings, remarks, &mut assignments);
        self.assignments = assignments;
        outcome?;
        self.refuse_motion_beside_foreign()
    }

    fn words_of(
        &mut self,
        line: &[u8],
        values: &dyn Values,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
        assignments: &mut Vec<Assignment>,
    ) -> Result<(), Fault> {
        let mut lexer = Lexer::new(line, values, assignments);
        lexer.extrudes = self.printer;
        while let Some(word) = lexer.word()? {
            self.add(word, settings, remarks)?;
        }
        let computed = lexer.computed || !assignments.is_empty();
        self.features |= u8::from(computed) * PARAMETERS;
        Ok(())
    }

    /// Empties the block.
    pub(crate) fn begin(&mut self) {
        self.clear();
    }

    /// Takes one more word.
    pub(crate) fn add(
        &mut self,
        word: Word,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        self.words += 1;
        match word.letter {
            b'G' => self.preparatory(word, settings, remarks),
            b'M' => self.miscellaneous(word, settings, remarks),
            _ => self.value(word, settings, remarks),
        }
    }

    /// Counts a word that was not added.
    pub(crate) fn note_word(&mut self) {
        self.words += 1;
    }

    /// Codes of the block, with the number of their group on controls of FANUC where it has one.
    pub(crate) fn codes_taken(&self) -> impl Iterator<Item = (Code, Option<usize>)> + '_ {
        [
            (Group::Motion, 1),
            (Group::Plane, 2),
            (Group::Distance, 3),
            (Group::FeedMode, 5),
            (Group::Units, 6),
            (Group::CutterCompensation, 7),
            (Group::ToolLength, 8),
            (Group::Return, 10),
            (Group::SpindleMode, 13),
            (Group::Coordinates, 14),
            (Group::PathControl, 15),
        ]
        .into_iter()
        .filter_map(|(group, number)| {
            let (code, _) = self.taker(group)?;
            let cycle = group == Group::Motion && self.motion.is_some_and(Motion::is_cycle);
            Some((code, Some(if cycle { 9 } else { number })))
        })
    }

    /// Whether the line says nothing.
    pub(crate) fn is_empty(&self) -> bool {
        self.words == 0 && self.assignments.is_empty()
    }

    /// Whether the block sets nothing up but what the modal state takes.
    pub(crate) fn is_plain(&self) -> bool {
        self.taken & !PLAIN == 0 && !self.end_of_nurbs
    }

    /// Whether a word with `letter` stands in the block.
    pub(crate) fn has(&self, letter: u8) -> bool {
        self.present & bit(letter) != 0
    }

    /// The first of `letters` that stands in the block.
    pub(crate) fn first_of(&self, letters: &[u8]) -> Option<u8> {
        letters.iter().copied().find(|&letter| self.has(letter))
    }

    /// The number after `letter`, as written.
    pub(crate) fn get(&self, letter: u8) -> Option<f64> {
        self.has(letter).then(|| self.values[index(letter)])
    }

    /// Where the word with `letter` stands, if it does.
    pub(crate) fn span(&self, letter: u8) -> Span {
        self.spans[index(letter)]
    }

    /// Makes a word say whether its number is a place or a step.
    pub(crate) fn set_way(&mut self, letter: u8, way: Way) {
        self.ways[index(letter)] = Some(way);
    }

    /// What a word says about its number, if it does.
    pub(crate) fn way(&self, letter: u8) -> Option<Way> {
        self.ways[index(letter)]
    }

    /// Whether the number of a word is a place or a step, in a distance mode.
    pub(crate) fn distance_of(&self, letter: u8, mode: Distance) -> Distance {
        match self.way(letter) {
            None => mode,
            Some(Way::Incremental) => Distance::Incremental,
            Some(_) => Distance::Absolute,
        }
    }

    /// The code of a group in this block, and where it stands.
    pub(crate) fn taker(&self, group: Group) -> Option<(Code, Span)> {
        (self.taken & 1 << group as u32 != 0).then(|| self.takers[group as usize])
    }

    /// Whether the machine has this axis beside X, Y and Z.
    pub(crate) fn has_beside(&self, letter: u8) -> bool {
        let index = AXES_BESIDE
            .iter()
            .position(|axis| *axis == char::from(letter));
        index.is_some_and(|index| self.beside[index])
    }

    /// A refusal of an axis that the machine has not.
    pub(crate) fn no_axis(&self, letter: char) -> Reason {
        let machine = Arc::clone(&self.machine);
        Reason::NoSuchAxis { letter, machine }
    }

    /// A code skipped by lenient reading.
    pub(crate) fn foreign(&self) -> Option<Code> {
        self.foreign.as_ref().map(|(code, _)| *code)
    }

    fn value(
        &mut self,
        word: Word,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        let letter = char::from(word.letter);
        if self.has(word.letter) {
            return Err(Fault::new(word.span, Reason::Repeated { letter }));
        }
        let moves = match word.letter {
            b'X'..=b'Z' => settings.axes[usize::from(word.letter - b'X')],
            b'A'..=b'C' => self.rotary || self.has_beside(word.letter),
            b'U'..=b'W' => self.secondary || self.has_beside(word.letter),
            _ => true,
        };
        if !moves && word.value.abs() <= 0.0 {
            // Where the axis is not, it is at 0.
            self.absent = true;
            if self.absent_noted & bit(word.letter) == 0 {
                self.absent_noted |= bit(word.letter);
                remarks.push((word.span, Notice::AbsentAxis { letter }));
            }
            return Ok(());
        }
        if !moves {
            return Err(Fault::new(word.span, self.no_axis(letter)));
        }
        if word.letter == b'N' && word.value < 0.0 {
            let quantity = "line number";
            let value = word.value;
            return Err(Fault::new(word.span, Reason::Negative { quantity, value }));
        }
        self.present |= bit(word.letter);
        self.features |= match word.letter {
            b'@' | b'^' => POLAR,
            b'A'..=b'C' => ROTARY,
            b'U'..=b'W' => SECONDARY,
            b'E' => EXTRUDER,
            _ => 0,
        };
        self.values[index(word.letter)] = word.value;
        self.spans[index(word.letter)] = word.span;
        Ok(())
    }
}

/// Letters come from the lexer in upper case.
fn index(letter: u8) -> usize {
    match letter {
        b'@' => LETTERS - 3,
        b'^' => LETTERS - 2,
        b'$' => LETTERS - 1,
        _ => usize::from(letter.wrapping_sub(b'A')).min(LETTERS - 1),
    }
}

fn bit(letter: u8) -> u32 {
    1 << index(letter)
}

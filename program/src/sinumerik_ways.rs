//! Takes words of Sinumerik that say which way their number is meant into the block.
//!
//! Source: `AC( )` `IC( )` `DC( )` `ACP( )` `ACN( )` of the programming manual of Sinumerik 840D sl. Not here: how they
//! are written, see `sinumerik_reader`, and where they lead, see `point` and `others`.

use crate::block::codes::Way;
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::sinumerik::Line;
use crate::text::place::Span;

/// Largest place of a rotary axis that goes there a certain way, degrees.
const WHOLE_TURN: f64 = 360.0;

impl Line<'_> {
    /// A word that may say which way its number is meant.
    pub(crate) fn add_by_way(
        &mut self,
        letter: u8,
        value: f64,
        way: Option<Way>,
        span: Span,
    ) -> Result<(), Fault> {
        let Some(way) = way else {
            return self.add(letter, value, span);
        };
        let takes = match way {
            Way::Absolute | Way::Incremental => b"XYZABCIJK@^".contains(&letter),
            Way::Shortest | Way::Positive | Way::Negative => b"ABC".contains(&letter),
        };
        let name = match letter {
            b'@' => "RP".to_owned(),
            b'^' => "AP".to_owned(),
            _ => char::from(letter).to_string(),
        };
        if !takes || self.frame.is_some() {
            return Err(no_way(&name, span));
        }
        let turns = !matches!(way, Way::Absolute | Way::Incremental);
        if turns && !(0.0..=WHOLE_TURN).contains(&value) {
            let reason = MachiningError::OutsideTurn { value };
            return Err(Fault::new(span, reason.into()));
        }
        self.block.set_way(letter, way);
        self.add(letter, value, span)
    }
}

/// A refusal of `AC( )` and its like on a word that does not take it.
pub(crate) fn no_way(word: &str, span: Span) -> Fault {
    let word = word.into();
    let what = "AC( ) and IC( ) are for X Y Z A B C I J K RP AP, DC( ) ACP( ) ACN( ) for A B C";
    Fault::new(span, Reason::WordNotSupported { word, what })
}

/// A refusal of an address with a number of its own, as in `A2=`.
pub(crate) fn extended_address(word: &str, span: Span) -> Fault {
    let what = match word {
        "A2=" | "B2=" | "C2=" | "A4=" | "B4=" | "C4=" | "A5=" | "B5=" | "C5=" => {
            "orientations by angles and by vectors of surfaces"
        }
        "I1=" | "J1=" | "K1=" => "arcs by a point on them",
        _ => "addresses of several channels, axes and spindles",
    };
    let word = word.into();
    Fault::new(span, Reason::WordNotSupported { word, what })
}

//! Writes SVG text, piece by piece.
//!
//! Not here: what is drawn. Coordinates are rounded to a hundredth of a pixel.

use std::fmt::{Display, Write};

/// Families to look for: the one that PNG files are drawn with, and what comes near.
const FONTS: &str = "'Noto Sans','DejaVu Sans','Segoe UI',Helvetica,Arial,sans-serif";

/// Where a text stands relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// The text begins there.
    Start,
    /// The text is centred there.
    Middle,
    /// The text ends there.
    End,
}

/// A drawing that grows.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    text: String,
    clips: usize,
}

impl Canvas {
    /// An empty white sheet.
    pub(crate) fn new(width: f64, height: f64) -> Self {
        let mut canvas = Self {
            text: String::new(),
            clips: 0,
        };
        canvas.put(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        ));
        canvas
    }

    /// The whole drawing.
    pub(crate) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    /// A rectangle with the given attributes.
    pub(crate) fn rectangle(&mut self, x: f64, y: f64, width: f64, height: f64, style: &str) {
        self.put(format_args!(
            "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" {style}/>\n"
        ));
    }

    /// A straight line with the given attributes.
    pub(crate) fn line(&mut self, from: (f64, f64), to: (f64, f64), style: &str) {
        self.put(format_args!(
            "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" {style}/>\n",
            from.0, from.1, to.0, to.1
        ));
    }

    /// A circle with the given attributes.
    pub(crate) fn circle(&mut self, center: (f64, f64), radius: f64, style: &str) {
        self.put(format_args!(
            "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius:.2}\" {style}/>\n",
            center.0, center.1
        ));
    }

    /// A path from its outline, with the given attributes.
    pub(crate) fn path(&mut self, outline: &Outline, style: &str) {
        if !outline.text.is_empty() {
            self.put(format_args!("<path d=\"{}\" {style}/>\n", outline.text));
        }
    }

    /// A text with the given attributes.
    pub(crate) fn text(
        &mut self,
        at: (f64, f64),
        anchor: Anchor,
        size: f64,
        style: &str,
        text: &str,
    ) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        self.put(format_args!(
            "<text x=\"{:.2}\" y=\"{:.2}\" font-size=\"{size}\" text-anchor=\"{anchor}\" {style}>",
            at.0, at.1
        ));
        for letter in text.chars() {
            match letter {
                '<' => self.text.push_str("&lt;"),
                '>' => self.text.push_str("&gt;"),
                '&' => self.text.push_str("&amp;"),
                other if other.is_control() => self.text.push(' '),
                other => self.text.push(other),
            }
        }
        self.text.push_str("</text>\n");
    }

    /// Draws only inside a rectangle until [`Canvas::unclip`].
    pub(crate) fn clip(&mut self, x: f64, y: f64, width: f64, height: f64) {
        self.clips += 1;
        let name = self.clips;
        self.put(format_args!(
            "<clipPath id=\"clip{name}\"><rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" \
             height=\"{height:.2}\"/></clipPath>\n<g clip-path=\"url(#clip{name})\">\n"
        ));
    }

    /// Ends [`Canvas::clip`].
    pub(crate) fn unclip(&mut self) {
        self.text.push_str("</g>\n");
    }

    fn put(&mut self, what: impl Display) {
        // Writing to a string cannot fail.
        let _ = write!(self.text, "{what}");
    }
}

/// The outline of a path.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outline {
    text: String,
}

impl Outline {
    /// Goes to a point without drawing.
    pub(crate) fn move_to(&mut self, point: (f64, f64)) {
        self.add('M', point);
    }

    /// Draws to a point.
    pub(crate) fn line_to(&mut self, point: (f64, f64)) {
        let command = if self.text.is_empty() { 'M' } else { 'L' };
        self.add(command, point);
    }

    /// Draws through points, beginning anew.
    pub(crate) fn stretch(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        for (index, point) in points.into_iter().enumerate() {
            self.add(if index == 0 { 'M' } else { 'L' }, point);
        }
    }

    /// Draws back to where the last stretch began.
    pub(crate) fn close(&mut self) {
        self.text.push('Z');
    }

    fn add(&mut self, command: char, (x, y): (f64, f64)) {
        // Writing to a string cannot fail.
        let _ = write!(self.text, "{command}{x:.2} {y:.2}");
    }
}

/// The outline through points.
pub(crate) fn through(points: impl IntoIterator<Item = (f64, f64)>) -> Outline {
    let mut outline = Outline::default();
    for point in points {
        outline.line_to(point);
    }
    outline
}

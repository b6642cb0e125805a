//! Writes the page: facts, packed columns, the program, styles and scripts in one HTML file.
//!
//! The page may load nothing: its content security policy forbids every request. Not here: what the scripts do,
//! which is in `assets/`.

use crate::columns::{Column, Packer};
use crate::motion::{Facts, Motion};
use crate::path::PathRecorder;
use serde::Serialize;
use std::io::{self, Write};
use toolglide_kinematics::{Limits, Vector};

/// Why a page cannot be written.
pub type PageError = io::Error;

/// Most bytes of a program that the page shows.
const MAX_TEXT: usize = 64 << 20;

/// Scripts of the page, in the order in which they need each other.
const SCRIPTS: [&str; 9] = [
    include_str!("../assets/uPlot.iife.min.js"),
    include_str!("../assets/data.js"),
    include_str!("../assets/mesh.js"),
    include_str!("../assets/canvas.js"),
    include_str!("../assets/view.js"),
    include_str!("../assets/charts.js"),
    include_str!("../assets/program.js"),
    include_str!("../assets/losses.js"),
    include_str!("../assets/main.js"),
];

const STYLES: [&str; 2] = [
    include_str!("../assets/uPlot.min.css"),
    include_str!("../assets/style.css"),
];

const PAGE: &str = include_str!("../assets/page.html");

/// An axis as the page names it.
#[derive(Clone, Debug, Serialize)]
pub struct AxisInfo {
    /// Its letter.
    pub name: char,
    /// Unit of its position, as in mm or deg.
    pub unit: &'static str,
}

/// A page about one program, and the motions of one or more methods.
#[derive(Debug)]
pub struct Page<'a, const N: usize> {
    /// Title: the name of the program.
    pub title: &'a str,
    /// Name of the machine.
    pub machine: &'a str,
    /// Its axes.
    pub axes: &'a [AxisInfo],
    /// Their limits.
    pub limits: Limits<N>,
    /// The path.
    pub path: &'a PathRecorder<N>,
    /// The motions, the one to look at first in front.
    pub motions: &'a [Motion<N>],
    /// The text of the program as it stands in its file; empty where it is not known.
    pub program: &'a [u8],
}

#[derive(Serialize)]
struct Meta<'a> {
    title: &'a str,
    machine: &'a str,
    axes: &'a [AxisInfo],
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    jerk: Vec<f64>,
    motions: Vec<&'a Facts>,
    columns: Vec<Column>,
    text: usize,
}

impl<const N: usize> Page<'_, N> {
    /// Writes the page.
    ///
    /// # Errors
    /// [`PageError`] when the sink fails.
    pub fn write(&self, out: &mut impl Write) -> Result<(), PageError> {
        let mut packer = Packer::new();
        self.path.pack(&mut packer)?;
        for (index, motion) in self.motions.iter().enumerate() {
            motion.pack(&format!("m{index}"), &mut packer)?;
        }
        let text = &self.program[..self.program.len().min(MAX_TEXT)];
        packer.text(text)?;
        let (columns, data) = packer.finish()?;
        let values = |all: &Vector<N>| all.iter().copied().collect();
        let meta = Meta {
            title: self.title,
            machine: self.machine,
            axes: self.axes,
            velocity: values(self.limits.velocity()),
            acceleration: values(self.limits.acceleration()),
            jerk: values(self.limits.jerk()),
            motions: self.motions.iter().map(|motion| &motion.facts).collect(),
            columns,
            text: text.len(),
        };
        let meta = serde_json::to_string(&meta)?.replace('<', "\\u003c");
        let mut rest = PAGE;
        for (mark, parts) in [
            ("@@TITLE@@", [escaped(self.title)].as_slice()),
            ("@@STYLES@@", &STYLES.map(str::to_owned)),
            ("@@META@@", &[meta]),
            ("@@DATA@@", &[data]),
            ("@@SCRIPTS@@", &SCRIPTS.map(str::to_owned)),
        ] {
            let Some((before, after)) = rest.split_once(mark) else {
                continue;
            };
            out.write_all(before.as_bytes())?;
            for part in parts {
                out.write_all(part.as_bytes())?;
                out.write_all(b"\n")?;
            }
            rest = after;
        }
        out.write_all(rest.as_bytes())
    }
}

/// Text as HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

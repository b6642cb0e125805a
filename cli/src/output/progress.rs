//! Shows the progress of reading a program on a terminal.
//!
//! The share is that of the bytes read. Nothing is shown where standard error is no terminal.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, Read};

/// A reader that shows how far it has come, and takes the display away when it is dropped.
#[derive(Debug)]
pub(crate) struct Watched<R> {
    reader: R,
    bar: ProgressBar,
}

impl<R> Watched<R> {
    /// Watches a reader of `length` bytes, where that is known.
    pub(crate) fn new(reader: R, length: Option<u64>) -> Self {
        let bar = match length {
            Some(length) => ProgressBar::new(length),
            None => ProgressBar::new_spinner(),
        };
        let style = ProgressStyle::with_template(
            "{bar:40} {percent:>3} %  {binary_bytes_per_sec}  {elapsed} of about {duration}",
        );
        if let Ok(style) = style {
            bar.set_style(style);
        }
        Self { reader, bar }
    }
}

impl<R: Read> Read for Watched<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.reader.read(buffer)?;
        self.bar.inc(count as u64);
        Ok(count)
    }
}

impl<R> Drop for Watched<R> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A display of how many of some steps are done, which goes when it is dropped.
#[derive(Debug)]
pub(crate) struct Steps {
    bar: ProgressBar,
}

impl Steps {
    /// None of `count` steps is done.
    pub(crate) fn new(count: usize) -> Self {
        let bar = ProgressBar::new(count as u64);
        let style =
            ProgressStyle::with_template("{bar:40} {percent:>3} %  {elapsed} of about {duration}");
        if let Ok(style) = style {
            bar.set_style(style);
        }
        bar.tick();
        Self { bar }
    }

    /// One more is done.
    pub(crate) fn step(&self) {
        self.bar.inc(1);
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

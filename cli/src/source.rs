//! Where a program is read from.

use crate::error::CliError;
use crate::progress::Watched;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;

/// An opened program.
pub(crate) struct Source {
    /// Its text.
    pub(crate) reader: BufReader<Box<dyn Read>>,
    /// Its name in messages.
    pub(crate) name: String,
}

impl Source {
    /// Opens a program, or standard input for `-`.
    pub(crate) fn open(path: &Path) -> Result<Self, CliError> {
        if path == Path::new("-") {
            let watched = Watched::new(std::io::stdin(), None);
            return Ok(Self {
                reader: BufReader::with_capacity(CHUNK, Box::new(watched)),
                name: "standard input".to_owned(),
            });
        }
        let (file, length) = open_file(path)?;
        Ok(Self {
            reader: BufReader::with_capacity(CHUNK, Box::new(Watched::new(file, length))),
            name: path.display().to_string(),
        })
    }
}

/// Opens a file that is no folder, with its length where it has one.
pub(crate) fn open_file(path: &Path) -> Result<(File, Option<u64>), CliError> {
    let refuse = |reason| CliError::Read {
        file: path.to_owned(),
        reason,
    };
    let found = std::fs::metadata(path).map_err(refuse)?;
    if found.is_dir() {
        return Err(refuse(std::io::Error::other("it is a folder")));
    }
    let file = File::open(path).map_err(refuse)?;
    Ok((file, found.is_file().then_some(found.len())))
}

//! Where a program is read from.

use crate::error::CliError;
use crate::progress::Watched;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;
use toolglide_program::ToolTable;

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

/// Bytes of a file of subroutines or of a tool table that are read at most.
const LARGEST_FILE: u64 = 16 << 20;

/// The tools of a table, or none.
pub(crate) fn tools(path: Option<&Path>) -> Result<ToolTable, CliError> {
    let Some(path) = path else {
        return Ok(ToolTable::new());
    };
    let (file, _) = open_file(path)?;
    let mut text = String::new();
    let read = file.take(LARGEST_FILE).read_to_string(&mut text);
    read.map_err(|reason| CliError::Read {
        file: path.to_owned(),
        reason,
    })?;
    ToolTable::parse(&text).map_err(|reason| CliError::ToolTable {
        file: path.to_owned(),
        reason,
    })
}

/// Finds subroutines that stand in files of their own, beside a program.
pub(crate) fn subroutines(
    program: &Path,
) -> impl Fn(&str) -> std::io::Result<Option<Vec<u8>>> + Send + 'static {
    let folder = program.parent().map(Path::to_owned).unwrap_or_default();
    move |name| {
        // A name is no way out of the folder.
        if name.contains(['/', '\\']) || name.starts_with('.') {
            return Ok(None);
        }
        let path = folder.join(format!("{name}.ngc"));
        match File::open(&path) {
            Ok(file) => {
                let mut text = Vec::new();
                file.take(LARGEST_FILE).read_to_end(&mut text)?;
                Ok(Some(text))
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }
}

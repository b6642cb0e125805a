//! Opens the program of a run: a file or standard input.

use crate::error::CliError;
use crate::output::progress::Watched;
use std::fs::{File, Metadata};
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use toolglide_program::{ArithmeticError, Language, Poses, Program, ToolTable};

/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;

/// An opened program.
pub(crate) struct Source {
    /// Its text.
    pub(crate) reader: BufReader<Box<dyn Read>>,
    /// Its name in messages.
    pub(crate) name: String,
    /// Its language.
    pub(crate) language: Language,
}

impl Source {
    /// Opens a program, or standard input for `-`; its language is the dialect that the command line
    /// names, or what the program looks like.
    pub(crate) fn open(path: &Path, dialect: Option<&str>) -> Result<Self, CliError> {
        let (text, name): (Box<dyn Read>, _) = if path == Path::new("-") {
            let watched = Watched::new(std::io::stdin(), None);
            (Box::new(watched), "standard input".to_owned())
        } else {
            let (file, length) = open_file(path)?;
            (
                Box::new(Watched::new(file, length)),
                path.display().to_string(),
            )
        };
        let mut reader = BufReader::with_capacity(CHUNK, text);
        let language = match dialect.and_then(Language::named) {
            Some(language) => language,
            None => {
                let beginning = reader.fill_buf().map_err(|reason| CliError::Read {
                    file: path.to_owned(),
                    reason,
                })?;
                Language::of(path, beginning)
            }
        };
        Ok(Self {
            reader,
            name,
            language,
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
        return Err(refuse(std::io::Error::other(kind_of(&found))));
    }
    let file = File::open(path).map_err(refuse)?;
    Ok((file, found.is_file().then_some(found.len())))
}

/// Says of a file that is no regular one what it is.
pub(crate) fn kind_of(found: &Metadata) -> &'static str {
    if found.is_dir() {
        "it is a folder"
    } else {
        "it is no regular file, but a pipe or a device"
    }
}

/// The language of a program, by the first bytes of its file; standard input, which can be read only
/// once, tells nothing yet.
pub(crate) fn language(path: &Path, dialect: Option<&str>) -> Result<Language, CliError> {
    if let Some(language) = dialect.and_then(Language::named) {
        return Ok(language);
    }
    let refused = |reason| CliError::Read {
        file: path.to_owned(),
        reason,
    };
    let mut beginning = Vec::new();
    if std::fs::metadata(path).is_ok_and(|found| found.is_file()) {
        let (file, _) = open_file(path)?;
        let first = file.take(CHUNK as u64).read_to_end(&mut beginning);
        first.map_err(refused)?;
    }
    Ok(Language::of(path, &beginning))
}

/// Bytes of a file of subroutines or of a tool table that are read at most.
const LARGEST_FILE: u64 = 16 << 20;

/// The tools of a table, or none.
pub(crate) fn tools(path: Option<&Path>) -> Result<ToolTable, CliError> {
    let Some(path) = path else {
        return Ok(ToolTable::new());
    };
    let refuse = |reason| CliError::Read {
        file: path.to_owned(),
        reason,
    };
    // A pipe would be waited for, and a device may have no end.
    let found = std::fs::metadata(path).map_err(refuse)?;
    if !found.is_file() {
        return Err(refuse(std::io::Error::other(kind_of(&found))));
    }
    if found.len() > LARGEST_FILE {
        let large = format!(
            "it has {} bytes, but at most {LARGEST_FILE} are read",
            found.len()
        );
        return Err(refuse(std::io::Error::other(large)));
    }
    let (file, _) = open_file(path)?;
    let mut text = String::new();
    let read = file.take(LARGEST_FILE).read_to_string(&mut text);
    read.map_err(refuse)?;
    ToolTable::parse(&text).map_err(|reason| CliError::ToolTable {
        file: path.to_owned(),
        reason,
    })
}

/// A refusal of a parameter that the command line gives.
pub(crate) fn refused_parameter(name: &str, reason: &ArithmeticError) -> CliError {
    CliError::Option {
        option: "--parameter",
        value: name.to_owned(),
        bound: reason.to_string(),
    }
}

/// Gives a program the parameters of the command line.
pub(crate) fn with_parameters<R: BufRead>(
    program: Program<R>,
    parameters: &[(String, f64)],
) -> Result<Program<R>, CliError> {
    parameters
        .iter()
        .try_fold(program, |program, (name, value)| {
            program
                .with_parameter(name, *value)
                .map_err(|reason| refused_parameter(name, &reason))
        })
}

/// Gives a program of tool poses the parameters of the command line.
pub(crate) fn poses_with_parameters<R: BufRead>(
    poses: Poses<R>,
    parameters: &[(String, f64)],
) -> Result<Poses<R>, CliError> {
    parameters.iter().try_fold(poses, |poses, (name, value)| {
        poses
            .with_parameter(name, *value)
            .map_err(|reason| refused_parameter(name, &reason))
    })
}

/// Endings of files of subroutines; controls of FANUC write none.
const ENDINGS: [&str; 5] = [".ngc", ".nc", ".cnc", ".tap", ""];

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
        for ending in ENDINGS {
            let path = folder.join(format!("{name}{ending}"));
            let opened = std::fs::metadata(&path).and_then(|found| {
                // Opening a pipe would wait for whoever writes it.
                if found.is_file() {
                    File::open(&path)
                } else if found.is_dir() && ending.is_empty() {
                    Err(std::io::ErrorKind::NotFound.into())
                } else {
                    Err(std::io::Error::other(
                        "it is no file of text, but a folder, a pipe or a device",
                    ))
                }
            });
            match opened {
                Ok(file) => {
                    let mut text = Vec::new();
                    file.take(LARGEST_FILE).read_to_end(&mut text)?;
                    return Ok(Some(text));
                }
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
        Ok(None)
    }
}

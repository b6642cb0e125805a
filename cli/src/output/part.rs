//! Writes files under a temporary name beside their place until they are complete.
//!
//! The name says for which file a part is, so that the next run for that file takes over what a killed run
//! left behind. A lock tells the two cases apart: it goes with the process that holds it. Not here: which
//! files are written so.

use std::fs::{File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Letters of the name of a file that the name of its part repeats, so that it is not too long.
const LETTERS: usize = 60;

/// How often a part that another run has just finished is begun anew.
const ATTEMPTS: u32 = 10;

/// Parts of this process.
static PARTS: Mutex<Parts> = Mutex::new(Parts {
    begun: Vec::new(),
    written: Written::Nothing,
});

/// The parts that there are, and what has become of others.
#[derive(Debug)]
pub(crate) struct Parts {
    begun: Vec<PathBuf>,
    written: Written,
}

/// How far a process has come in naming its files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Written {
    /// No file has got its name.
    Nothing,
    /// All files of the run have their names.
    All,
}

/// A file that is not complete; it goes when it is dropped.
#[derive(Debug)]
pub(crate) struct Part {
    file: File,
    path: PathBuf,
    place: PathBuf,
}

impl Part {
    /// Begins a part of the file at `place`.
    pub(crate) fn begin(place: PathBuf) -> io::Result<Self> {
        let folder = match place.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if !folder.is_dir() {
            let reason = format!("there is no folder {}", folder.display());
            return Err(io::Error::new(io::ErrorKind::NotFound, reason));
        }
        let name = place.file_name().unwrap_or_default().to_string_lossy();
        let short: String = name.chars().take(LETTERS).collect();
        let path = folder.join(format!(".{short}.part"));
        let mut parts = parts();
        let file = locked(&path)?;
        file.set_len(0)?;
        if let Ok(before) = std::fs::metadata(&place) {
            // The file that it replaces keeps who may read it; where that cannot be, so be it.
            let _ = file.set_permissions(before.permissions());
        }
        parts.begun.push(path.clone());
        Ok(Self { file, path, place })
    }
}

impl Write for Part {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        let mut parts = parts();
        if let Some(index) = parts.begun.iter().position(|path| *path == self.path) {
            parts.begun.swap_remove(index);
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

/// Gives all these files their names, with no signal between them; a refusal names the file.
pub(crate) fn name_all(finished: Vec<Part>) -> Result<(), (PathBuf, io::Error)> {
    let mut parts = parts();
    for part in &finished {
        std::fs::rename(&part.path, &part.place).map_err(|reason| (part.place.clone(), reason))?;
        parts.begun.retain(|path| *path != part.path);
        parts.written = Written::All;
    }
    // Only now may their locks go, and without the parts, because dropping one asks for them.
    drop(parts);
    drop(finished);
    Ok(())
}

/// Takes away what is not complete, for the end of the process. As long as the guard lives, no part is
/// begun or gets its name.
pub(crate) fn take_away() -> (MutexGuard<'static, Parts>, Written) {
    let mut parts = parts();
    for path in parts.begun.drain(..) {
        let _ = std::fs::remove_file(path);
    }
    let written = parts.written;
    (parts, written)
}

fn parts() -> MutexGuard<'static, Parts> {
    PARTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Opens a part that no other process writes.
fn locked(path: &Path) -> io::Result<File> {
    for _ in 0..ATTEMPTS {
        let in_the_way = std::fs::symlink_metadata(path).is_ok_and(|found| !found.is_file());
        if in_the_way {
            let reason = format!("{} is in the way, which is no file", path.display());
            return Err(io::Error::other(reason));
        }
        let file = File::options()
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(|reason| {
                io::Error::new(reason.kind(), format!("{}: {reason}", path.display()))
            })?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                return Err(io::Error::other("another run is writing it"));
            }
            // Some file systems know no locks.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        if is_still(&file, path) {
            return Ok(file);
        }
    }
    Err(io::Error::other("other runs are writing it"))
}

/// Whether the file has this name still: the run that held the lock before may have renamed it.
#[cfg(unix)]
fn is_still(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let id = |found: std::fs::Metadata| (found.dev(), found.ino());
    match (file.metadata(), std::fs::symlink_metadata(path)) {
        (Ok(one), Ok(other)) => id(one) == id(other),
        _ => false,
    }
}

#[cfg(not(unix))]
fn is_still(_: &File, path: &Path) -> bool {
    path.exists()
}

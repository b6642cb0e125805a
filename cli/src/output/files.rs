//! Writes files that appear under their names only when they are complete.
//!
//! A regular file is written beside its place and renamed when all is done, so that an error leaves
//! nothing half-written and an older file untouched. Devices and pipes are written directly.

use crate::error::CliError;
use crate::output::part::{Part, name_all};
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file being written.
#[derive(Debug)]
pub(crate) struct OutputFile {
    path: PathBuf,
    target: Target,
}

#[derive(Debug)]
enum Target {
    Beside(Part),
    Direct(File),
}

impl OutputFile {
    /// Begins a file, which appears under its name on [`OutputFile::commit`].
    ///
    /// `inputs` are files that the run reads, which must not be written over.
    pub(crate) fn begin(path: &Path, inputs: &[&Path]) -> Result<Self, CliError> {
        let refuse = |reason: io::Error| CliError::write(path, reason);
        if path.is_dir() {
            return Err(refuse(io::Error::other("it is a folder")));
        }
        if inputs.iter().any(|input| same_file(path, input)) {
            return Err(refuse(io::Error::other("it is the input of this run")));
        }
        let target = match std::fs::metadata(path) {
            Ok(found) if !found.is_file() => {
                let file = File::options().write(true).open(path).map_err(refuse)?;
                Target::Direct(file)
            }
            Ok(found) if found.permissions().readonly() => {
                return Err(refuse(io::Error::other("it is write-protected")));
            }
            // A link stays a link: what it points at is replaced.
            Ok(_) => {
                let place = std::fs::canonicalize(path).map_err(refuse)?;
                Target::Beside(Part::begin(place).map_err(refuse)?)
            }
            Err(_) => Target::Beside(Part::begin(path.to_owned()).map_err(refuse)?),
        };
        Ok(Self {
            path: path.to_owned(),
            target,
        })
    }

    /// The file as the user named it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the complete files their names, all or none where a signal comes between.
    pub(crate) fn commit(files: impl IntoIterator<Item = Self>) -> Result<(), CliError> {
        let mut finished = Vec::new();
        for file in files {
            match file.target {
                Target::Direct(mut device) => {
                    let flushed = device.flush();
                    flushed.map_err(|reason| CliError::write(file.path, reason))?;
                }
                Target::Beside(part) => finished.push(part),
            }
        }
        name_all(finished).map_err(|(place, reason)| CliError::write(place, reason))
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.target {
            Target::Beside(part) => part.write(bytes),
            Target::Direct(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.target {
            Target::Beside(part) => part.flush(),
            Target::Direct(file) => file.flush(),
        }
    }
}

/// Whether two paths lead to one file; a file that does not exist yet is compared by its place.
pub(crate) fn same_file(one: &Path, other: &Path) -> bool {
    match (resolved(one), resolved(other)) {
        (Some(one), Some(other)) => one == other,
        _ => one == other,
    }
}

fn resolved(path: &Path) -> Option<PathBuf> {
    if let Ok(found) = std::fs::canonicalize(path) {
        return Some(found);
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    Some(std::fs::canonicalize(folder).ok()?.join(path.file_name()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_appears_only_when_it_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("motion.csv");
        let mut abandoned = OutputFile::begin(&path, &[]).unwrap();
        abandoned.write_all(b"half").unwrap();
        drop(abandoned);
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().count(),
            0,
            "nothing is left"
        );
        let mut complete = OutputFile::begin(&path, &[]).unwrap();
        complete.write_all(b"whole").unwrap();
        assert!(!path.exists(), "not yet");
        OutputFile::commit([complete]).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"whole");
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().count(),
            1,
            "one file"
        );
    }

    #[test]
    fn an_older_file_outlives_a_run_that_fails() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("motion.csv");
        std::fs::write(&path, "old").unwrap();
        let mut abandoned = OutputFile::begin(&path, &[]).unwrap();
        abandoned.write_all(b"new").unwrap();
        drop(abandoned);
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
    }

    #[test]
    fn what_a_killed_run_left_behind_is_taken_over() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("motion.csv");
        let left = folder.path().join(".motion.csv.part");
        std::fs::write(&left, "much more than this run has to write").unwrap();
        let mut file = OutputFile::begin(&path, &[]).unwrap();
        file.write_all(b"whole").unwrap();
        let refused = OutputFile::begin(&path, &[]).unwrap_err().to_string();
        assert!(refused.ends_with("another run is writing it"), "{refused}");
        OutputFile::commit([file]).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"whole");
        assert!(!left.exists(), "taken over");
    }

    #[test]
    fn a_folder_in_the_way_and_a_missing_folder_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("motion.csv");
        std::fs::create_dir(folder.path().join(".motion.csv.part")).unwrap();
        let refused = OutputFile::begin(&path, &[]).unwrap_err().to_string();
        assert!(
            refused.contains(".motion.csv.part is in the way"),
            "{refused}"
        );
        let path = folder.path().join("none").join("motion.csv");
        let refused = OutputFile::begin(&path, &[]).unwrap_err().to_string();
        assert!(refused.contains("there is no folder"), "{refused}");
    }

    #[cfg(unix)]
    #[test]
    fn a_file_that_is_replaced_keeps_its_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("motion.csv");
        std::fs::write(&path, "old").unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o640)).unwrap();
        OutputFile::commit([OutputFile::begin(&path, &[]).unwrap()]).unwrap();
        let mode = std::fs::metadata(&path).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o640, "mode");
    }

    #[test]
    fn the_input_is_never_written_over_whatever_it_is_called() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("part.ngc");
        std::fs::write(&program, "G0 X1\n").unwrap();
        let around = folder.path().join(".").join("part.ngc");
        assert!(
            OutputFile::begin(&around, &[&program]).is_err(),
            "same place"
        );
        #[cfg(unix)]
        {
            let link = folder.path().join("link.csv");
            std::os::unix::fs::symlink(&program, &link).unwrap();
            assert!(
                OutputFile::begin(&link, &[&program]).is_err(),
                "a link to it"
            );
        }
        assert_eq!(std::fs::read(&program).unwrap(), b"G0 X1\n");
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_directly_and_stays_a_device() {
        let path = Path::new("/dev/null");
        let mut device = OutputFile::begin(path, &[]).unwrap();
        device.write_all(b"gone").unwrap();
        OutputFile::commit([device]).unwrap();
        assert!(
            !std::fs::metadata(path).unwrap().is_file(),
            "still a device"
        );
    }
}

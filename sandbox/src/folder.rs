//! A folder that takes files whole or not at all.

use crate::SandboxError;
use std::path::{Path, PathBuf};

/// A folder that was found writable.
#[derive(Debug, Clone)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes the folder if need be, and tries a file in it, before any work is done.
    ///
    /// # Errors
    ///
    /// When it cannot be made or takes no file.
    pub fn open(path: &Path) -> Result<Self, SandboxError> {
        let refuse = |reason| SandboxError::Folder {
            path: path.to_owned(),
            reason,
        };
        std::fs::create_dir_all(path).map_err(refuse)?;
        let probe = path.join(format!(".probe-{}", std::process::id()));
        std::fs::write(&probe, b"").map_err(refuse)?;
        std::fs::remove_file(&probe).map_err(refuse)?;
        Ok(Self {
            path: path.to_owned(),
        })
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file beside its place and renames it: a reader sees the old one or the new one.
    ///
    /// # Errors
    ///
    /// When the file cannot be written; then the old one is still there and nothing else.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), SandboxError> {
        let path = self.path.join(name);
        let beside = self.path.join(format!(".{name}.{}", std::process::id()));
        let done = std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, &path));
        done.map_err(|reason| {
            // whatever is left of it is of no use; the first error is the one to tell
            let _ = std::fs::remove_file(&beside);
            SandboxError::File { path, reason }
        })
    }

    /// Removes a file.
    ///
    /// # Errors
    ///
    /// When it cannot be removed.
    pub fn remove(&self, name: &str) -> Result<(), SandboxError> {
        let path = self.path.join(name);
        std::fs::remove_file(&path).map_err(|reason| SandboxError::File { path, reason })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_a_file_is_refused_in_one_line() {
        let parent = tempfile::tempdir().unwrap();
        let taken = parent.path().join("taken");
        std::fs::write(&taken, b"here first").unwrap();
        for path in [taken.clone(), taken.join("below")] {
            let message = Folder::open(&path).unwrap_err().to_string();
            assert!(message.starts_with("cannot write into"), "{message}");
            assert_eq!(message.lines().count(), 1);
        }
        assert_eq!(std::fs::read(&taken).unwrap(), b"here first");
    }

    #[test]
    fn a_written_file_leaves_nothing_beside_it() {
        let parent = tempfile::tempdir().unwrap();
        let folder = Folder::open(&parent.path().join("a/b")).unwrap();
        folder.write("f.csv", b"1").unwrap();
        folder.write("f.csv", b"2").unwrap();
        let names: Vec<_> = std::fs::read_dir(folder.path())
            .unwrap()
            .flatten()
            .collect();
        assert_eq!(names.len(), 1);
        assert_eq!(std::fs::read(folder.path().join("f.csv")).unwrap(), b"2");
    }
}

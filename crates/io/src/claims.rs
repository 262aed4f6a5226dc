//! Which file a path leads to, so that no result takes the place of what is read or of another result.

use std::path::{Path, PathBuf};

use crate::IoError;
use crate::write::{followed, is_stream, ready_file};

/// What a command reads and what it is to write, each file by its identity and not by its spelling: device and inode
/// of one that is there (so hard links count), folder and name, links followed, of one that is not.
///
/// ```
/// use std::path::Path;
///
/// let mut claims = io::Claims::default();
/// claims.reads(Path::new("photo.png"));
/// let error = claims.writes("the overlay", Path::new("./photo.png")).unwrap_err();
/// assert!(error.to_string().starts_with("the overlay: ./photo.png"));
/// ```
#[derive(Debug, Default)]
pub struct Claims {
    read: Vec<Place>,
    written: Vec<(String, Place)>,
}

/// Where something is read from or written to.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Place {
    /// Standard output, whatever it is.
    Standard,
    /// A file or a pipe that is there.
    #[cfg(unix)]
    There(u64, u64),
    /// A file that is not there yet, or one on a system without inodes.
    Named(PathBuf),
}

impl Claims {
    /// Note that a file is read, or standard input for `-`.
    pub fn reads(&mut self, path: &Path) {
        let standard = path.as_os_str() == "-";
        let path = if standard {
            Path::new("/dev/stdin")
        } else {
            path
        };
        self.read.extend(place(path, standard));
    }

    /// Note that a file is to be written, or standard output for `-`, and make sure that it can be.
    ///
    /// # Errors
    ///
    /// A file that is also read, or that another result is written to, by the name of the `result`;
    /// whatever [`ready_file`] refuses.
    pub fn writes(&mut self, result: &str, path: &Path) -> Result<(), IoError> {
        let standard = is_standard(path);
        let real = if standard {
            Path::new("/dev/stdout")
        } else {
            path
        };
        let found = place(real, standard);
        if let Some(found) = &found
            && self.read.contains(found)
        {
            return Err(IoError::IsRead {
                result: result.to_owned(),
                path: path.to_owned(),
            });
        }
        let same = |known: &Place| {
            let twice = standard && *known == Place::Standard;
            twice || found.as_ref() == Some(known)
        };
        if let Some((other, _)) = self.written.iter().find(|(_, known)| same(known)) {
            return Err(IoError::Taken {
                result: result.to_owned(),
                path: path.to_owned(),
                other: other.clone(),
            });
        }
        self.written
            .extend(found.map(|found| (result.to_owned(), found)));
        if standard {
            self.written.push((result.to_owned(), Place::Standard));
            return Ok(());
        }
        ready_file(path)
    }
}

/// Whether a name stands for standard output.
#[must_use]
pub fn is_standard(path: &Path) -> bool {
    let names = ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];
    names.iter().any(|name| path.as_os_str() == *name)
}

/// Where a path leads; None for what can be read and written at once, such as a terminal or `/dev/null`, and for what
/// will be refused anyhow. Of standard input and output only files count.
fn place(path: &Path, standard: bool) -> Option<Place> {
    #[cfg(unix)]
    if let Ok(data) = std::fs::metadata(path) {
        use std::os::unix::fs::{FileTypeExt as _, MetadataExt as _};
        let kind = data.file_type();
        let counts = kind.is_file() || (kind.is_fifo() && !standard);
        return counts.then(|| Place::There(data.dev(), data.ino()));
    }
    if standard || is_stream(path) {
        return None;
    }
    let path = followed(path).ok()?;
    if let Ok(there) = std::fs::canonicalize(&path) {
        return Some(Place::Named(there));
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let folder = std::fs::canonicalize(folder).ok()?;
    Some(Place::Named(folder.join(path.file_name()?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_known_by_any_spelling() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("a"), "x").unwrap();
        std::fs::create_dir(at("d")).unwrap();
        let mut names = vec![at("a"), at("d/../a"), at("./a")];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("a", at("soft")).unwrap();
            std::os::unix::fs::symlink("d", at("e")).unwrap();
            std::os::unix::fs::symlink("../soft", at("d/softer")).unwrap();
            std::os::unix::fs::symlink("new", at("to-new")).unwrap();
            names.extend([at("soft"), at("e/../a"), at("e/softer")]);
        }
        std::fs::hard_link(at("a"), at("hard")).unwrap();
        names.push(at("hard"));
        for read in &names {
            for written in &names {
                let mut claims = Claims::default();
                claims.reads(read);
                let refused = claims.writes("--out", written).unwrap_err().to_string();
                assert!(refused.starts_with("--out") && refused.contains("is read"));
                let mut claims = Claims::default();
                claims.writes("--record", read).unwrap();
                let refused = claims.writes("--out", written).unwrap_err().to_string();
                assert!(refused.contains("taken by --record"), "{refused}");
            }
        }
        for (one, other) in [("new", "./new"), ("new", "d/../new"), ("new", "to-new")] {
            if !cfg!(unix) && other == "to-new" {
                continue;
            }
            let mut claims = Claims::default();
            claims.writes("--record", &at(one)).unwrap();
            assert!(claims.writes("--out", &at(other)).is_err(), "{other}");
        }
        assert_eq!(std::fs::read(at("a")).unwrap(), b"x");
        assert!(!at("new").exists());
    }

    #[cfg(unix)]
    #[test]
    fn devices_take_any_number_of_results() {
        let mut claims = Claims::default();
        claims.reads(Path::new("/dev/null"));
        for flag in ["--record", "--out"] {
            claims.writes(flag, Path::new("/dev/null")).unwrap();
        }
        claims.writes("--record", Path::new("-")).unwrap();
        for again in ["-", "/dev/stdout"] {
            assert!(claims.writes("--out", Path::new(again)).is_err());
        }
    }
}

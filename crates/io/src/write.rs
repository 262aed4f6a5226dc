//! Files written whole or not at all: beside, then renamed.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::IoError;

/// The folder a file lives in.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Links from one to the next that are followed, as many as Linux does.
const MOST_LINKS: usize = 40;

/// Where a path leads: links are followed, so that what they point to is written and no link is replaced; the last
/// may point to a file that is not there yet.
pub(crate) fn followed(path: &Path) -> std::io::Result<PathBuf> {
    let mut at = path.to_owned();
    for _ in 0..MOST_LINKS {
        match std::fs::read_link(&at) {
            Ok(next) => at = folder(&at).join(next),
            Err(_) => return Ok(at),
        }
    }
    Err(std::io::Error::other("too many links"))
}

/// Whether something is there that is no file and must not be replaced by one: a device, a pipe, or what a process
/// has open (`/dev/stdout`, `/dev/fd/3`), which may be a file that others write to as well.
pub(crate) fn is_stream(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|data| !data.is_file() && !data.is_dir())
        || is_descriptor(path)
}

/// Whether a path leads through the open files of a process.
fn is_descriptor(path: &Path) -> bool {
    let mut at = path.to_owned();
    for _ in 0..MOST_LINKS {
        let place = std::fs::canonicalize(folder(&at)).unwrap_or_default();
        if place.starts_with("/proc") && place.ends_with("fd") {
            return true;
        }
        match std::fs::read_link(&at) {
            Ok(next) => at = folder(&at).join(next),
            Err(_) => return false,
        }
    }
    false
}

pub(crate) fn unwritable(path: &Path, error: impl std::fmt::Display) -> IoError {
    IoError::file(
        path,
        format!("cannot be written: {error}; another file is needed"),
    )
}

/// A new file in the folder of `path`, for everybody that the process's mask lets.
fn beside(path: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".being-written-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    // the name of a file that was not made helps nobody
    let plain = |error: std::io::Error| match error.to_string().split_once(" at path ") {
        Some((message, _)) => std::io::Error::new(error.kind(), message),
        None => error,
    };
    builder.tempfile_in(folder(path)).map_err(plain)
}

/// What is known of a file that is there and is to be replaced; a file that may not be written is an error, though
/// its folder would let it be replaced.
fn replaced(target: &Path) -> std::io::Result<Option<std::fs::Metadata>> {
    match std::fs::OpenOptions::new().write(true).open(target) {
        Ok(file) => {
            let data = file.metadata()?;
            // the superuser can open a read-only file too
            if data.permissions().readonly() {
                return Err(std::io::Error::other("it is read-only"));
            }
            Ok(Some(data))
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// Write `bytes` to `path`: first into a file of another name in the same folder, then renamed, so
/// that nobody ever sees half of it and an old file stays until the new one is complete.
///
/// A file that is there keeps its permissions; a new one has those that the process's mask leaves. Links are followed;
/// a device or a pipe is written to as it is.
///
/// # Errors
///
/// A folder that is not there or cannot be written, a file that is read-only, or a full disk; by the path.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    write_by(path, &mut |file| file.write_all(bytes))
}

/// [`write_whole`] of what is not in memory at once: `write` is given the file.
///
/// # Errors
///
/// As [`write_whole`], and what `write` reports.
pub(crate) fn write_by(
    path: &Path,
    write: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), IoError> {
    let mut whole = Whole::begin(path)?;
    write(&mut whole).map_err(|error| unwritable(path, error))?;
    whole.end()
}

/// A file that is written piece by piece and has its name when it is whole; dropped before, it leaves nothing.
#[derive(Debug)]
pub(crate) struct Whole {
    path: PathBuf,
    place: Place,
}

/// Where the pieces go.
#[derive(Debug)]
enum Place {
    /// To a device, a pipe or a descriptor, as they come.
    Stream(std::fs::File),
    /// To standard output.
    Standard(std::io::Stdout),
    /// To a file beside the one that it will be, of which this is known.
    Beside(
        tempfile::NamedTempFile,
        PathBuf,
        Option<Box<std::fs::Metadata>>,
    ),
}

impl Whole {
    /// Begin a file.
    ///
    /// # Errors
    ///
    /// As [`write_whole`].
    pub(crate) fn begin(path: &Path) -> Result<Self, IoError> {
        let refuse = |error: std::io::Error| unwritable(path, error);
        let place = if path.as_os_str() == "-" {
            Place::Standard(std::io::stdout())
        } else if is_stream(path) {
            // what is a file behind a descriptor grows, as by any other output there
            let stream = std::fs::OpenOptions::new().append(true).open(path);
            Place::Stream(stream.map_err(refuse)?)
        } else {
            let target = followed(path).map_err(refuse)?;
            let before = replaced(&target).map_err(refuse)?;
            Place::Beside(
                beside(&target).map_err(refuse)?,
                target,
                before.map(Box::new),
            )
        };
        Ok(Self {
            path: path.to_owned(),
            place,
        })
    }

    /// The file that is written to until the end, if there is one.
    pub(crate) const fn file(&mut self) -> Option<&mut tempfile::NamedTempFile> {
        match &mut self.place {
            Place::Beside(beside, ..) => Some(beside),
            _ => None,
        }
    }

    /// Give the file its name.
    ///
    /// # Errors
    ///
    /// As [`write_whole`].
    pub(crate) fn end(self) -> Result<(), IoError> {
        let refuse = |error: std::io::Error| unwritable(&self.path, error);
        match self.place {
            Place::Stream(mut stream) => stream.flush().map_err(refuse),
            Place::Standard(mut out) => out.flush().map_err(refuse),
            Place::Beside(beside, target, before) => {
                if let Some(before) = before {
                    keep_owner(beside.as_file(), &before);
                    beside
                        .as_file()
                        .set_permissions(before.permissions())
                        .map_err(refuse)?;
                }
                beside
                    .persist(&target)
                    .map_err(|error| refuse(error.error))?;
                Ok(())
            }
        }
    }
}

impl Write for Whole {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match &mut self.place {
            Place::Stream(stream) => stream.write(bytes),
            Place::Standard(out) => out.write(bytes),
            Place::Beside(beside, ..) => beside.write(bytes),
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match &mut self.place {
            Place::Stream(stream) => stream.flush(),
            Place::Standard(out) => out.flush(),
            Place::Beside(beside, ..) => beside.flush(),
        }
    }
}

/// Give a file the owner and the group of the one it replaces, where that is allowed.
#[cfg(unix)]
fn keep_owner(file: &std::fs::File, before: &std::fs::Metadata) {
    use std::os::unix::fs::{MetadataExt as _, fchown};
    // where the owner cannot be kept, the file belongs to the user who writes it, as any new file does
    let _ = fchown(file, Some(before.uid()), Some(before.gid()));
}

#[cfg(not(unix))]
fn keep_owner(_: &std::fs::File, _: &std::fs::Metadata) {}

/// Make sure that [`write_whole`] will be able to write `path`, before any work is done for it.
///
/// # Errors
///
/// A path that is a folder, a file that is read-only, or one in a folder that is not there or cannot be written.
pub fn ready_file(path: &Path) -> Result<(), IoError> {
    let refuse = |error: std::io::Error| unwritable(path, error);
    if path.is_dir() || path.file_name().is_none() {
        return Err(unwritable(path, "it is a folder"));
    }
    if !is_stream(path) {
        let target = followed(path).map_err(refuse)?;
        replaced(&target).map_err(refuse)?;
        beside(&target).map_err(refuse)?;
    }
    Ok(())
}

/// Make a folder, and make sure that a file can be written there, before any work is done for it.
///
/// # Errors
///
/// A path that is a file, or a folder that cannot be made or written.
pub fn ready_folder(path: &Path) -> Result<(), IoError> {
    let refuse = |error: std::io::Error| {
        let message = format!("cannot be used as a folder for results: {error}; another is needed");
        IoError::file(path, message)
    };
    std::fs::create_dir_all(path).map_err(refuse)?;
    beside(&path.join("result")).map_err(refuse)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_old_file_is_replaced_whole_and_nothing_stays_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.csv");
        write_whole(&file, b"one").unwrap();
        write_whole(&file, b"two").unwrap();
        assert_eq!(std::fs::read(&file).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_device_a_device() {
        use std::os::unix::fs::FileTypeExt as _;
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("a"), folder.path().join("b"));
        write_whole(&file, b"one").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_whole(&link, b"two").unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&file).unwrap(), b"two");
        let null = Path::new("/dev/null");
        ready_file(null).unwrap();
        write_whole(null, b"gone").unwrap();
        assert!(
            std::fs::metadata(null)
                .unwrap()
                .file_type()
                .is_char_device()
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_file_keeps_its_mode_and_one_that_is_read_only_is_not_replaced() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.csv");
        let mode = |file: &Path| std::fs::metadata(file).unwrap().permissions().mode() & 0o777;
        write_whole(&file, b"one").unwrap();
        // as any other new file, whatever the mask
        std::fs::write(folder.path().join("b"), b"one").unwrap();
        assert_eq!(mode(&file), mode(&folder.path().join("b")));
        for bits in [0o600, 0o660, 0o640] {
            std::fs::set_permissions(&file, std::fs::Permissions::from_mode(bits)).unwrap();
            write_whole(&file, b"two").unwrap();
            assert_eq!(mode(&file), bits);
        }
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o444)).unwrap();
        assert!(ready_file(&file).is_err() && write_whole(&file, b"three").is_err());
        assert_eq!(std::fs::read(&file).unwrap(), b"two");
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_nowhere_stay_links() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        symlink("b", at("a")).unwrap();
        symlink("c", at("b")).unwrap();
        ready_file(&at("a")).unwrap();
        assert!(!at("c").exists());
        write_whole(&at("a"), b"one").unwrap();
        assert!(at("a").is_symlink() && at("b").is_symlink());
        assert_eq!(std::fs::read(at("c")).unwrap(), b"one");
        symlink("loop", at("loop")).unwrap();
        assert!(ready_file(&at("loop")).is_err() && write_whole(&at("loop"), b"one").is_err());
        symlink("no/such", at("far")).unwrap();
        assert!(ready_file(&at("far")).is_err() && at("far").is_symlink());
    }

    #[test]
    fn what_cannot_be_written_is_found_out_before() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        write_whole(&file, b"x").unwrap();
        for bad in [
            file.join("below"),
            folder.path().join("no/such"),
            folder.path().to_owned(),
        ] {
            let error = ready_file(&bad).unwrap_err().to_string();
            assert!(error.starts_with(&bad.display().to_string()), "{error}");
            assert!(!error.contains("being-written"), "{error}");
            assert!(write_whole(&bad, b"x").is_err());
        }
        assert!(ready_folder(&file).is_err());
        assert!(ready_folder(&file.join("below")).is_err());
    }
}

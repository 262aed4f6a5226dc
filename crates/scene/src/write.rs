//! Files written whole or not at all: beside, then renamed.

use std::borrow::Cow;
use std::io::Write as _;
use std::path::Path;

use crate::SceneError;

/// The folder a file lives in.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Where a path leads: a link is followed, so that what it points to is replaced and not the link.
fn followed(path: &Path) -> Cow<'_, Path> {
    if path.is_symlink() {
        std::fs::canonicalize(path).map_or(Cow::Borrowed(path), Cow::Owned)
    } else {
        Cow::Borrowed(path)
    }
}

/// Whether something is there that is no file and must not be replaced by one: a device, a pipe.
fn is_stream(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|data| !data.is_file() && !data.is_dir())
}

fn unwritable(path: &Path, error: impl std::fmt::Display) -> SceneError {
    SceneError::file(
        path,
        format!("cannot be written: {error}; another file would do"),
    )
}

fn beside(path: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    tempfile::Builder::new()
        .prefix(".being-written-")
        .tempfile_in(folder(path))
}

/// Write `bytes` to `path`: first into a file of another name in the same folder, then renamed, so
/// that nobody ever sees half of it and an old file stays until the new one is complete.
///
/// A link is followed; a device or a pipe is written to as it is.
///
/// # Errors
///
/// A folder that is not there or cannot be written, or a full disk; by the path.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), SceneError> {
    let refuse = |error: std::io::Error| unwritable(path, error);
    if is_stream(path) {
        let mut stream = std::fs::OpenOptions::new()
            .write(true)
            .open(path)
            .map_err(refuse)?;
        return stream.write_all(bytes).map_err(refuse);
    }
    let target = followed(path);
    let mut beside = beside(&target).map_err(refuse)?;
    beside.write_all(bytes).map_err(refuse)?;
    #[cfg(unix)]
    {
        // a temporary file is private; the result is as public as any other file
        use std::os::unix::fs::PermissionsExt as _;
        let public = std::fs::Permissions::from_mode(0o644);
        beside.as_file().set_permissions(public).map_err(refuse)?;
    }
    beside
        .persist(&target)
        .map_err(|error| refuse(error.error))?;
    Ok(())
}

/// Make sure that [`write_whole`] will be able to write `path`, before any work is done for it.
///
/// # Errors
///
/// A path that is a folder, or a file in a folder that is not there or cannot be written.
pub fn ready_file(path: &Path) -> Result<(), SceneError> {
    if path.is_dir() || path.file_name().is_none() {
        return Err(unwritable(path, "it is a folder"));
    }
    if !is_stream(path) {
        beside(&followed(path)).map_err(|error| unwritable(path, error))?;
    }
    Ok(())
}

/// Make a folder, and make sure that a file can be written there, before any work is done for it.
///
/// # Errors
///
/// A path that is a file, or a folder that cannot be made or written.
pub fn ready_folder(path: &Path) -> Result<(), SceneError> {
    let refuse = |error: std::io::Error| {
        let message = format!("cannot be used as a folder for results: {error}; another would do");
        SceneError::file(path, message)
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
            assert!(write_whole(&bad, b"x").is_err());
        }
        assert!(ready_folder(&file).is_err());
        assert!(ready_folder(&file.join("below")).is_err());
    }
}

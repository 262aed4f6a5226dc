//! Files written whole or not at all: beside, then renamed.

use std::io::Write as _;
use std::path::Path;

use crate::SceneError;

/// Write `bytes` to `path`: first into a file of another name in the same folder, then renamed, so
/// that nobody ever sees half of it and an old file stays until the new one is complete.
///
/// # Errors
///
/// A folder that is not there or cannot be written, or a full disk; by the path.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), SceneError> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let refuse =
        |error: std::io::Error| SceneError::file(path, format!("cannot be written: {error}"));
    let mut beside = tempfile::Builder::new()
        .prefix(".being-written-")
        .tempfile_in(folder)
        .map_err(refuse)?;
    beside.write_all(bytes).map_err(refuse)?;
    #[cfg(unix)]
    {
        // a temporary file is private; the result is as public as any other file
        use std::os::unix::fs::PermissionsExt as _;
        let public = std::fs::Permissions::from_mode(0o644);
        beside.as_file().set_permissions(public).map_err(refuse)?;
    }
    beside.persist(path).map_err(|error| refuse(error.error))?;
    Ok(())
}

/// Make a folder, and make sure that a file can be written there, before any work is done for it.
///
/// # Errors
///
/// A path that is a file, or a folder that cannot be made or written.
pub fn ready_folder(path: &Path) -> Result<(), SceneError> {
    let refuse = |error: std::io::Error| {
        SceneError::file(
            path,
            format!("cannot be used as a folder for results: {error}"),
        )
    };
    std::fs::create_dir_all(path).map_err(refuse)?;
    tempfile::Builder::new()
        .prefix(".being-written-")
        .tempfile_in(path)
        .map_err(refuse)?;
    Ok(())
}

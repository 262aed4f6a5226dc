//! What was not saved, kept in a file that takes the place of no other.

use std::path::{Path, PathBuf};

use live::Engine;
use scene::SceneError;

use crate::commands::key;

/// Names that are tried.
const MOST: u32 = 1000;

/// Write the session of an engine beside where the command was given; the name of the file.
pub(super) fn session(engine: &Engine, name: &Path) -> Result<PathBuf, SceneError> {
    let stem = name.to_string_lossy();
    let stem = stem.trim_end_matches(".snakes");
    for number in 0..MOST {
        let file = match number {
            0 => PathBuf::from(format!("{stem}.snakes.json")),
            _ => PathBuf::from(format!("{stem}-{number}.snakes.json")),
        };
        if file.symlink_metadata().is_err() {
            io::write_whole(&file, engine.session().text().as_bytes())?;
            return Ok(file);
        }
    }
    let message = format!("{MOST} sessions of {stem} are here already; needed: another folder");
    Err(key("session", message))
}

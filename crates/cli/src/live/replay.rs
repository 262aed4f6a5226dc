//! `snake run SESSION`: a session of the window, replayed without one.

use std::path::Path;
use std::process::ExitCode;

use io::Claims;
use io::shapes::{self, Format};
use live::Engine;
use serde_json::json;

use super::session;
use crate::args::{Run, Words};
use crate::commands::{Answer, code, key};
use crate::output::put_bytes;
use crate::stop::{STOPPED, Stop};

/// Whether a file is a session, by its name.
pub(crate) fn is_session(path: &Path) -> bool {
    path.to_string_lossy()
        .to_lowercase()
        .ends_with(".snakes.json")
}

/// Replay a session, and write the curves that it ends with.
pub(crate) fn replay(args: &Run, words: Words) -> Answer {
    let changed = !args.changes.set.is_empty()
        || args.scheme.is_some()
        || args.dt.is_some()
        || args.tolerance.is_some()
        || args.steps.is_some();
    if changed {
        let message = "is replayed as it was; needed: a scene, whose values can be changed";
        return Err(key(&args.scene.display().to_string(), message));
    }
    for (flag, given) in [
        ("--record", args.record.is_some()),
        ("--overlay", args.overlay.is_some()),
    ] {
        if given {
            return Err(key(
                flag,
                "is for scenes; a session gives its curves, by --out",
            ));
        }
    }
    let mut claims = Claims::default();
    claims.reads(&args.scene);
    if let Some(out) = &args.out {
        claims.writes("--out", out)?;
    }
    let session = session(&args.scene)?;
    let stop = Stop::listen();
    let mut engine = Engine::new();
    let replayed = engine.replay(&session, &mut || !stop.asked());
    replayed.map_err(|error| key(&args.scene.display().to_string(), error))?;
    let curves = engine.shapes();
    if let Some(out) = &args.out {
        let format = Format::by_ending(out).unwrap_or(Format::Csv);
        let bytes = shapes::write(&curves, format, &engine.context())?;
        if io::is_standard(out) {
            put_bytes(&bytes)?;
        } else {
            io::write_whole(out, &bytes)?;
        }
    }
    let stopped = stop.asked();
    words.say(&format!(
        "replayed {} steps; {} curves at the end",
        engine.steps(),
        curves.len()
    ));
    if stopped {
        words.say(STOPPED);
    }
    words.end(&json!({"steps": engine.steps(), "curves": curves.len(), "good": !stopped}))?;
    Ok(if stopped {
        code(false)
    } else {
        ExitCode::SUCCESS
    })
}

//! `snake live`: a window in the browser, served by this program on this machine alone.

mod hub;
mod keep;
mod replay;
mod server;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args as ClapArgs;
use io::PictureReading;
use io::frames::{Frame, Frames};
use live::{Action, Engine, LiveError, Session};
use scene::{SceneError, SceneText};

use crate::args::Words;
use crate::commands::{Answer, key};
use crate::output::put;
use crate::stop::Stop;
use hub::Hub;
pub(crate) use replay::{is_session, replay};

/// How it is used.
pub(crate) const EXAMPLES: &str = "Examples:
  snake live                      scenes of the report, from a menu
  snake live soft-ball            one of them
  snake live photo.jpg            find, mend and save outlines in a picture
  snake live frames/*.png         follow outlines through a sequence: files, a TIFF of pages, a video
  snake live session.snakes.json  go on from a session that was saved

Keys: Space runs, ? shows all others. Ctrl-C here ends it; what was not saved is written beside the input.";

/// Bytes of a file at most, as the engine takes them.
const MOST_BYTES: u64 = 1 << 29;

/// Frames that are opened at most.
const MOST_FILES: usize = 20_000;

#[derive(Debug, Clone, ClapArgs)]
pub(crate) struct Flags {
    /// A picture; files, a folder, a TIFF of several pages or a video (by ffmpeg) as a sequence; a shipped scene's
    /// name, a scene file, or a session; nothing for a menu.
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Do not open the browser; the address is printed all the same.
    #[arg(long)]
    pub no_open: bool,
    /// The port to be reached at; a free one if not given.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub port: u16,
}

pub(crate) fn live(flags: &Flags, words: Words) -> Answer {
    let (engine, name) = opened(&flags.files)?;
    let hub = Hub::start(engine);
    let stop = Stop::listen();
    let served = server::serve(flags.port, &hub, &stop, |address| {
        put(&format!("{address}\n"))?;
        words.say("Ctrl-C ends it");
        if !flags.no_open && !browse(address) {
            words.say("no browser could be opened; open the address above in one");
        }
        Ok(())
    });
    let engine = hub.end();
    if let Some(engine) = engine.filter(Engine::is_unsaved) {
        let file = keep::session(&engine, &name)?;
        let shown = file.display();
        words.say(&format!(
            "what was not saved is in {shown}; `snake live {shown}` goes on from there"
        ));
    }
    served?;
    Ok(ExitCode::SUCCESS)
}

/// An engine with what was named, and the name of a session of it.
fn opened(files: &[PathBuf]) -> Result<(Engine, PathBuf), SceneError> {
    let mut engine = Engine::new();
    let Some(first) = files.first() else {
        return Ok((engine, PathBuf::from("live")));
    };
    let frames = frames(files)?;
    let stem = PathBuf::from(first.file_stem().unwrap_or_default());
    let refused = |path: &Path, error: LiveError| key(&path.display().to_string(), error);
    if let [path] = &frames[..] {
        let name = path.to_string_lossy();
        let shipped = scene::SCENES.iter().any(|(known, _)| *known == name);
        if shipped && !path.exists() {
            let scene = Action::shipped(&name);
            engine.perform(&scene, &[]).map_err(|e| refused(path, e))?;
            return Ok((engine, stem));
        }
        let ending = |wanted: &str| {
            let ending = path.extension().unwrap_or_default();
            ending.eq_ignore_ascii_case(wanted)
        };
        if ending("toml") {
            let text = SceneText::load(path)?;
            let (files, bytes) = beside(path, &text)?;
            let scene = Action::Scene {
                name: stem.to_string_lossy().into_owned(),
                text: Some(text.source().to_owned()),
                files,
            };
            engine
                .perform(&scene, &bytes)
                .map_err(|e| refused(path, e))?;
            return Ok((engine, stem));
        }
        if ending("json") {
            let session = session(path)?;
            engine.open_session(session);
            return Ok((engine, stem));
        }
        if !path.exists() && path.extension().is_none() {
            // with the nearest name
            SceneText::named(&name)?;
        }
    }
    if let [path] = &frames[..]
        && io::frames::is_video(path)
    {
        film(&mut engine, path)?;
        engine.saved();
        return Ok((engine, stem));
    }
    for (index, path) in frames.iter().enumerate() {
        let bytes = io::read_file(path, "a picture", MOST_BYTES)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let picture = Action::Picture {
            name: name.into_owned(),
            frame: index > 0,
        };
        engine
            .perform(&picture, &bytes)
            .map_err(|e| refused(path, e))?;
    }
    engine.saved();
    Ok((engine, stem))
}

/// The frames of a video, each as a picture of its own.
fn film(engine: &mut Engine, path: &Path) -> Result<(), SceneError> {
    for numbered in Frames::open(&[path.to_owned()], &PictureReading::default())? {
        let Frame::Picture(picture) = numbered.frame else {
            continue;
        };
        let index = numbered.index;
        if index >= MOST_FILES {
            return Err(key(
                "FILE",
                format!(
                    "must be at most {MOST_FILES} frames; {} has more",
                    path.display()
                ),
            ));
        }
        let bytes = io::paint::png(picture.display())?;
        let action = Action::Picture {
            name: format!("{}.png", numbered.name),
            frame: index > 0,
        };
        engine
            .perform(&action, &bytes)
            .map_err(|error| key(&path.display().to_string(), error))?;
    }
    Ok(())
}

/// Names and lengths of files, and their bytes.
type Beside = (Vec<(String, usize)>, Vec<u8>);

/// The files that a scene names: names and lengths, and their bytes one behind the other, so that a session of it
/// replays anywhere.
fn beside(path: &Path, text: &SceneText) -> Result<Beside, SceneError> {
    let folder = path.parent().unwrap_or_else(|| Path::new("."));
    let (mut files, mut all) = (Vec::new(), Vec::new());
    for name in text.files() {
        let bytes = io::read_file(&folder.join(&name), "a file that a scene names", MOST_BYTES)?;
        files.push((name, bytes.len()));
        all.extend(bytes);
    }
    Ok((files, all))
}

/// A session from a file.
pub(crate) fn session(path: &Path) -> Result<Session, SceneError> {
    let text = io::read_text(path, "a session", 1 << 30)?;
    Session::parse(&text).map_err(|error| key(&path.display().to_string(), error))
}

/// The files, those of folders in their order.
fn frames(files: &[PathBuf]) -> Result<Vec<PathBuf>, SceneError> {
    let listed = match files {
        [one] if !one.is_dir() => files.to_vec(),
        _ => Frames::open(files, &PictureReading::default())?
            .files()
            .to_vec(),
    };
    let got = listed.len();
    if got > MOST_FILES {
        return Err(key(
            "FILE",
            format!("must be at most {MOST_FILES} frames, got {got}"),
        ));
    }
    Ok(listed)
}

/// Open the address in the user's browser.
fn browse(address: &str) -> bool {
    open::that_detached(address).is_ok()
}

//! Where results go: files, made sure of before the work and written after it; standard output.

use std::io::{ErrorKind, Write as _};
use std::path::PathBuf;

use io::shapes::Shape;
use io::{Claims, Picture, is_standard, paint, shapes};
use scene::snake::Outcome;
use scene::{Record, Scene, SceneError};

use crate::args::Words;
use crate::commands::key;

/// Colours of the start and of the result over a picture.
const START: [u8; 3] = [86, 180, 233];
const FOUND: [u8; 3] = [230, 97, 1];

/// Write to standard output; a reader that has gone away (`| head`) is no error.
pub(crate) fn put(text: &str) -> Result<(), SceneError> {
    put_bytes(text.as_bytes())
}

/// [`put`] for what may be no text.
pub(crate) fn put_bytes(bytes: &[u8]) -> Result<(), SceneError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(key(
            "standard output",
            format!("cannot be written: {error}; a file or another reader is needed"),
        )),
        _ => Ok(()),
    }
}

/// An error for people, to standard error, which may be closed.
pub(crate) fn complain(text: &str) {
    // titles and names come from files: whatever they hold stays on one line
    let _ = writeln!(std::io::stderr(), "{}", io::text::plain(text));
}

impl Words {
    /// A line for people, to standard error, unless they asked for quiet.
    pub(crate) fn say(self, text: &str) {
        if !self.quiet {
            complain(text);
        }
    }

    /// The same for those who want to know more.
    pub(crate) fn detail(self, text: &str) {
        if self.verbose {
            complain(text);
        }
    }

    /// How it ended, as one line of JSON on standard output, if that was asked for.
    pub(crate) fn end(self, end: &serde_json::Value) -> Result<(), SceneError> {
        if self.json {
            return put(&format!("{end}\n"));
        }
        Ok(())
    }
}

/// Whether standard output is the null device, which also stands in for one that was closed.
pub(crate) fn goes_nowhere() -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{FileTypeExt as _, MetadataExt as _};
        let device = |path: &str| {
            let data = std::fs::metadata(path).ok();
            data.filter(|data| data.file_type().is_char_device())
                .map(|data| data.rdev())
        };
        let null = device("/dev/null");
        null.is_some() && device("/dev/stdout") == null
    }
    #[cfg(not(unix))]
    false
}

/// What a run is to leave behind.
#[derive(Debug)]
pub(crate) struct Output {
    pub record: Option<PathBuf>,
    pub contour: Option<PathBuf>,
    pub overlay: Option<PathBuf>,
}

impl Output {
    fn all(&self) -> [(&'static str, Option<&PathBuf>); 3] {
        [
            ("--record", self.record.as_ref()),
            ("--out", self.contour.as_ref()),
            ("--overlay", self.overlay.as_ref()),
        ]
    }

    /// Find out before the run whether everything can be written after it, and takes the place of nothing that is
    /// read.
    pub(crate) fn check(
        &self,
        picture: Option<&Picture>,
        inputs: &[PathBuf],
        words: Words,
    ) -> Result<(), SceneError> {
        let mut all = self.all().into_iter();
        if words.json
            && let Some((flag, _)) =
                all.find(|(_, path)| path.is_some_and(|path| is_standard(path)))
        {
            let message =
                format!("writes to standard output, and so does {flag}; give {flag} a file");
            return Err(key("--json", message));
        }
        if let Some(path) = &self.overlay {
            if picture.is_none() {
                return Err(key("--overlay", "this scene has no picture to draw on"));
            }
            let png = path
                .extension()
                .is_some_and(|e| e.eq_ignore_ascii_case("png"));
            if !png {
                let message = format!(
                    "writes PNG; the name must end in .png, got {}",
                    path.display()
                );
                return Err(key("--overlay", message));
            }
        }
        let mut claims = Claims::default();
        for path in inputs {
            claims.reads(path);
        }
        for (flag, path) in self.all() {
            if let Some(path) = path {
                claims.writes(flag, path)?;
            }
        }
        Ok(())
    }

    /// Write what was asked for. A run that blew up has no contour to show, only a record.
    pub(crate) fn write(
        &self,
        scene: &Scene,
        record: &Record,
        words: Words,
    ) -> Result<(), SceneError> {
        let (Some(first), Some(last)) = (record.frames.first(), record.last()) else {
            return Err(key("run", "nothing was kept"));
        };
        let mut printed = String::new();
        match &self.record {
            Some(path) if is_standard(path) => printed.push_str(&record.written().to_json_lines()?),
            Some(path) => record.written().save(path)?,
            None => {}
        }
        if !matches!(record.outcome, Outcome::Diverged { .. }) {
            let (start, found) = (first.shapes(), last.shapes());
            printed.push_str(&self.curves(scene.picture.as_deref(), &start, &found, words)?);
        }
        put(&printed)
    }

    /// Write the curves found, and the picture with them and those of the start over it; what goes to standard
    /// output is given back.
    pub(crate) fn curves(
        &self,
        picture: Option<&Picture>,
        start: &[Shape],
        found: &[Shape],
        words: Words,
    ) -> Result<String, SceneError> {
        let mut printed = String::new();
        match &self.contour {
            Some(_) if found.is_empty() => words.say("no curve is left: no contour is written"),
            Some(path) if is_standard(path) => {
                if goes_nowhere() {
                    words.say(
                        "note: standard output is closed or /dev/null: the contour is kept nowhere",
                    );
                }
                printed.push_str(&shapes::to_text(found));
            }
            Some(path) => shapes::save(found, path)?,
            None => {}
        }
        if let (Some(path), Some(picture)) = (&self.overlay, picture) {
            let start = start.iter().map(|curve| (curve, START));
            let found = found.iter().map(|curve| (curve, FOUND));
            let drawn = start.chain(found);
            let curves: Vec<_> = drawn
                .map(|(curve, color)| (curve.first(), curve.closed == Some(true), color))
                .collect();
            paint::save_png(&paint::overlay(picture, &curves), path)?;
        }
        Ok(printed)
    }
}

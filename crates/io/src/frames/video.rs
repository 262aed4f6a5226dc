//! Frames of a video through the program ffmpeg, and of a stream of pictures.

use std::ffi::OsString;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use crate::IoError;
use crate::ffmpeg::{self, Process};
use crate::picture::{Picture, PictureReading, decode_next};

/// Endings of the names of videos.
const ENDINGS: [&str; 20] = [
    "3gp", "apng", "asf", "avi", "flv", "gif", "m2ts", "m4v", "mjpeg", "mkv", "mov", "mp4", "mpeg",
    "mpg", "mxf", "ogv", "ts", "webm", "wmv", "y4m",
];

/// Whether a file is a video by the ending of its name.
#[must_use]
pub fn is_video(path: &Path) -> bool {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()))
}

/// Pictures one behind the other, as PGM or PPM.
pub(super) struct Stream {
    path: PathBuf,
    input: Box<dyn BufRead + Send>,
    /// The program that writes them.
    process: Option<Process>,
    /// What the program has to say at the end.
    note: Option<String>,
    over: bool,
}

impl std::fmt::Debug for Stream {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stream")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

impl Stream {
    /// Standard input.
    pub(super) fn standard() -> Self {
        Self {
            path: PathBuf::from("-"),
            input: Box::new(BufReader::new(std::io::stdin())),
            process: None,
            note: None,
            over: false,
        }
    }

    /// The frames of a video; that there is one at least is found out at once.
    pub(super) fn video(path: &Path) -> Result<Self, IoError> {
        Self::video_by(ffmpeg::PROGRAM, path)
    }

    fn video_by(program: &str, path: &Path) -> Result<Self, IoError> {
        let refuse = |message: String| IoError::file(path, message);
        let unread =
            |error: std::io::Error| refuse(format!("cannot be read: {error}; a video is needed"));
        std::fs::File::open(path).map_err(unread)?;
        // each frame once, whatever the times say; the second way is that of versions before 5.1
        let mut last = None;
        for each in ["-fps_mode", "-vsync"] {
            let mut process =
                Process::start(program, &arguments(path, each), [true, false]).map_err(refuse)?;
            let output = process
                .output()
                .ok_or_else(|| refuse("cannot be read from its program".to_owned()))?;
            let mut input = BufReader::with_capacity(1 << 16, output);
            if !input.fill_buf().map_err(unread)?.is_empty() {
                return Ok(Self {
                    path: path.to_owned(),
                    input: Box::new(input),
                    process: Some(process),
                    note: None,
                    over: false,
                });
            }
            last = process.end().map_err(unread)?.1;
            if !last
                .as_ref()
                .is_some_and(|said| said.contains("ptions") || said.contains("option"))
            {
                break;
            }
        }
        let said = last.map_or_else(String::new, |said| format!(": {said}"));
        Err(refuse(format!(
            "holds no frame that {program} can read{said}; a whole video is needed"
        )))
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// What people should know of how it ended.
    pub(super) const fn take_note(&mut self) -> Option<String> {
        self.note.take()
    }

    /// The next frame; None behind the last.
    pub(super) fn next(&mut self, rule: &PictureReading) -> Option<Result<Picture, String>> {
        if self.over {
            return None;
        }
        let found = decode_next(&mut self.input, rule).transpose();
        if !matches!(found, Some(Ok(_))) {
            // behind what cannot be read nobody knows where the next frame begins
            self.over = true;
            if let Some(mut process) = self.process.take()
                && found.is_none()
                && let Ok((status, said)) = process.end()
                && (!status.success() || said.is_some())
            {
                let said = said.unwrap_or_else(|| status.to_string());
                self.note = Some(format!(
                    "{}: said by {}: {said}",
                    self.path.display(),
                    ffmpeg::PROGRAM
                ));
            }
        }
        found
    }
}

/// What the program is asked for: the first picture stream, upright, as PPM.
fn arguments(path: &Path, each: &str) -> Vec<OsString> {
    let before = [
        "-nostdin",
        "-hide_banner",
        "-loglevel",
        "error",
        "-protocol_whitelist",
        "file",
        "-i",
    ];
    let behind = [
        "-map",
        "0:v:0",
        each,
        "passthrough",
        "-f",
        "image2pipe",
        "-c:v",
        "ppm",
        "-pix_fmt",
        "rgb24",
        "pipe:1",
    ];
    let mut list: Vec<OsString> = before.iter().map(OsString::from).collect();
    list.push(ffmpeg::file(path));
    list.extend(behind.iter().map(OsString::from));
    list
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
mod tests {
    use super::*;

    #[test]
    fn without_the_program_a_video_is_refused_by_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mp4");
        std::fs::write(&path, b"x").unwrap();
        let error = Stream::video_by("no-such-ffmpeg", &path)
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with(&path.display().to_string()) && error.contains("install it"),
            "{error}"
        );
        let error = Stream::video_by("no-such-ffmpeg", &folder.path().join("b.mp4")).unwrap_err();
        assert!(error.to_string().contains("cannot be read"), "{error}");
    }
}

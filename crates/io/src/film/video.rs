//! A film as a video, by the program ffmpeg.

use std::ffi::OsString;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::process::ChildStdin;

use image::RgbImage;

use crate::IoError;
use crate::ffmpeg::{self, Process};
use crate::write::{Whole, unwritable};

#[derive(Debug)]
pub(super) struct Video {
    path: PathBuf,
    file: Whole,
    process: Process,
    input: Option<BufWriter<ChildStdin>>,
    frames: usize,
}

/// Names of formats by the endings of files.
const FORMATS: [(&str, &str); 5] = [
    ("mp4", "mp4"),
    ("m4v", "mp4"),
    ("mov", "mov"),
    ("mkv", "matroska"),
    ("webm", "webm"),
];

impl Video {
    pub(super) fn begin(
        path: &Path,
        (width, height): (u32, u32),
        hold: u16,
    ) -> Result<Self, IoError> {
        let mut file = Whole::begin(path)?;
        let Some(beside) = file.file() else {
            return Err(IoError::file(
                path,
                "a video is written in any order; the name of a file is needed",
            ));
        };
        let ending = path.extension().map_or(String::new(), |ending| {
            ending.to_string_lossy().to_lowercase()
        });
        let format = FORMATS
            .iter()
            .find(|(known, _)| *known == ending)
            .map_or("mp4", |(_, format)| format);
        let (size, rate) = (format!("{width}x{height}"), format!("100/{hold}"));
        let before = [
            "-nostdin",
            "-hide_banner",
            "-loglevel",
            "error",
            "-y",
            "-f",
            "rawvideo",
            "-pix_fmt",
            "rgb24",
            "-s",
            size.as_str(),
            "-r",
            rate.as_str(),
            "-i",
            "pipe:0",
            "-an",
            "-vf",
            // sides must be even for players everywhere
            "pad=ceil(iw/2)*2:ceil(ih/2)*2",
            "-pix_fmt",
            "yuv420p",
            "-f",
            format,
        ];
        let mut arguments: Vec<OsString> = before.iter().map(OsString::from).collect();
        arguments.push(ffmpeg::file(beside.path()));
        let process = Process::start(ffmpeg::PROGRAM, &arguments, [false, true]);
        let mut process = process.map_err(|message| IoError::file(path, message))?;
        let input = process.input().map(BufWriter::new);
        Ok(Self {
            path: path.to_owned(),
            file,
            process,
            input,
            frames: 0,
        })
    }

    pub(super) fn show(&mut self, frame: &RgbImage) -> Result<(), IoError> {
        self.frames += 1;
        let written = self
            .input
            .as_mut()
            .map(|input| input.write_all(frame.as_raw()));
        match written {
            Some(Ok(())) => Ok(()),
            Some(Err(error)) => Err(self.said(&error.to_string())),
            None => Err(self.said("it has ended")),
        }
    }

    /// What the program says of its end, or else `otherwise`.
    fn said(&mut self, otherwise: &str) -> IoError {
        self.input = None;
        let said = self.process.end().ok().and_then(|(_, said)| said);
        let said = said.unwrap_or_else(|| otherwise.to_owned());
        unwritable(&self.path, format!("{} says: {said}", ffmpeg::PROGRAM))
    }

    pub(super) fn end(mut self) -> Result<(), IoError> {
        if self.frames == 0 {
            return Err(unwritable(&self.path, "a film has no frame"));
        }
        if let Some(mut input) = self.input.take()
            && let Err(error) = input.flush()
        {
            return Err(self.said(&error.to_string()));
        }
        let (status, said) = self
            .process
            .end()
            .map_err(|error| unwritable(&self.path, error))?;
        if !status.success() {
            let said = said.unwrap_or_else(|| status.to_string());
            return Err(unwritable(
                &self.path,
                format!("{} says: {said}", ffmpeg::PROGRAM),
            ));
        }
        self.file.end()
    }
}

//! The program ffmpeg, where it is installed: videos as frames, frames as videos. Never through a shell.

use std::ffi::OsString;
use std::io::Read;
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::thread::JoinHandle;

use crate::text::clip_to;

/// The program's name.
pub(crate) const PROGRAM: &str = "ffmpeg";

/// Bytes that are kept of what it says.
const MOST_SAID: usize = 1 << 16;

/// A program that runs beside; it is ended when this is dropped.
#[derive(Debug)]
pub(crate) struct Process {
    child: Child,
    said: Option<JoinHandle<Vec<u8>>>,
}

impl Process {
    /// Start it; `reads` and `writes` say which of its standard streams are pipes.
    ///
    /// # Errors
    ///
    /// That it is not there, and how to get it.
    pub(crate) fn start(
        program: &str,
        arguments: &[OsString],
        [reads, writes]: [bool; 2],
    ) -> Result<Self, String> {
        let pipe = |piped: bool| if piped { Stdio::piped() } else { Stdio::null() };
        let child = Command::new(program)
            .args(arguments)
            .stdin(pipe(writes))
            .stdout(pipe(reads))
            .stderr(Stdio::piped())
            .spawn();
        let mut child = child.map_err(|error| {
            if error.kind() == std::io::ErrorKind::NotFound {
                return format!(
                    "videos are read and written by the program {program}, which is not there; needed: install it \
                     (packages of most systems have it; https://ffmpeg.org), or the frames as pictures or as a TIFF \
                     of several pages"
                );
            }
            format!("the program {program} cannot be started: {error}")
        })?;
        let said = child.stderr.take().map(|mut stream| {
            std::thread::spawn(move || {
                let mut kept = Vec::new();
                // what is beyond is read too, so that the program is not held up
                let _ = stream
                    .by_ref()
                    .take(MOST_SAID as u64)
                    .read_to_end(&mut kept);
                let _ = std::io::copy(&mut stream, &mut std::io::sink());
                kept
            })
        });
        Ok(Self { child, said })
    }

    /// What it writes.
    pub(crate) const fn output(&mut self) -> Option<ChildStdout> {
        self.child.stdout.take()
    }

    /// What it reads.
    pub(crate) const fn input(&mut self) -> Option<ChildStdin> {
        self.child.stdin.take()
    }

    /// Wait for its end: how it ended, and the last line that it said.
    pub(crate) fn end(&mut self) -> std::io::Result<(ExitStatus, Option<String>)> {
        let status = self.child.wait()?;
        let said = self.said.take().and_then(|thread| thread.join().ok());
        let said = said.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        let last = said.and_then(|text| {
            let line = text
                .lines()
                .rev()
                .map(str::trim)
                .find(|line| !line.is_empty())?;
            Some(clip_to(line, 200))
        });
        Ok((status, last))
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // one that has ended is not there to be ended
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A file as its argument: by its path and never as an option, a list of files or a place elsewhere.
pub(crate) fn file(path: &Path) -> OsString {
    let mut argument = OsString::from("file:");
    argument.push(path);
    argument
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_is_not_there_is_refused_with_how_to_get_it() {
        let error = Process::start("no-such-ffmpeg", &[], [true, false]).unwrap_err();
        assert!(
            error.contains("no-such-ffmpeg") && error.contains("needed: install it"),
            "{error}"
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_program_ends_with_its_reader() {
        let mut process = Process::start("sleep", &["1000".into()], [true, false]).unwrap();
        let mut output = process.output().unwrap();
        let before = std::time::Instant::now();
        drop(process);
        let mut rest = Vec::new();
        output.read_to_end(&mut rest).unwrap();
        assert!(rest.is_empty() && before.elapsed().as_secs() < 100);
    }
}

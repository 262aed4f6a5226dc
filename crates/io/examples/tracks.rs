//! Tracks from a table to another format, and labels of the Cell Tracking Challenge to a table:
//! `tracks IN.csv OUT FORMAT WIDTH HEIGHT` or `tracks FOLDER OUT.csv`.

#![allow(clippy::print_stderr, reason = "a program may talk to the terminal")]

use std::path::Path;
use std::process::ExitCode;

use io::tracks::{CtcFolder, TableFrames, TrackContext, TrackFormat, TrackWriter};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match run(&words) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(words: &[String]) -> Result<(), String> {
    let said = |error: io::IoError| error.to_string();
    let number = |text: &String| {
        text.parse::<usize>()
            .map_err(|error| format!("{text}: {error}"))
    };
    match words {
        [from, into] => {
            let folder = CtcFolder::open(Path::new(from)).map_err(said)?;
            let context = TrackContext::default();
            let mut writer =
                TrackWriter::begin(Path::new(into), TrackFormat::Csv, &context).map_err(said)?;
            for frame in folder.frames() {
                let outlines = folder.outlines(frame).map_err(said)?;
                writer.frame(frame, "", &outlines).map_err(said)?;
            }
            writer.end().map_err(said).map(|_| ())
        }
        [from, into, format, width, height] => {
            let size = (number(width)?, number(height)?);
            let format = TrackFormat::named(format).ok_or("the name of a format is needed")?;
            let context = TrackContext {
                size,
                name: "sequence".to_owned(),
                ..TrackContext::default()
            };
            let mut writer = TrackWriter::begin(Path::new(into), format, &context).map_err(said)?;
            for rows in TableFrames::open(Path::new(from)).map_err(said)? {
                let (frame, mut outlines) = rows.map_err(said)?;
                // object 9 has come from object 1
                outlines
                    .iter_mut()
                    .filter(|one| one.id == 9)
                    .for_each(|one| one.parent = Some(1));
                writer
                    .frame(frame, &format!("f{frame}.png"), &outlines)
                    .map_err(said)?;
            }
            writer.end().map_err(said).map(|_| ())
        }
        _ => Err("tracks IN.csv OUT FORMAT WIDTH HEIGHT, or tracks FOLDER OUT.csv".to_owned()),
    }
}

//! Outlines from one format to another: `convert IN OUT [--width W --height H] [--from F] [--to F] [--picture NAME]`.

#![allow(clippy::print_stderr, reason = "a program may talk to the terminal")]

use std::path::PathBuf;
use std::process::ExitCode;

use io::shapes::{self, Context, Format, Reading};

fn main() -> ExitCode {
    match run(std::env::args().skip(1)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(mut words: impl Iterator<Item = String>) -> Result<(), String> {
    let mut paths: Vec<PathBuf> = Vec::new();
    let (mut reading, mut context, mut to) = (Reading::default(), Context::default(), None);
    while let Some(word) = words.next() {
        let mut value = || {
            words
                .next()
                .ok_or_else(|| format!("{word}: a value is needed"))
        };
        let number = |given: String| {
            let number = given.parse::<usize>();
            number.map_err(|error| format!("{word}: {error}; a whole number is needed"))
        };
        let format = |given: String| {
            Format::named(&given).ok_or_else(|| format!("{word}: a name of a format is needed"))
        };
        match word.as_str() {
            "--width" => context.width = number(value()?)?,
            "--height" => context.height = number(value()?)?,
            "--picture" => {
                let name = value()?;
                reading.picture = Some(name.clone());
                context.picture = Some(name);
            }
            "--from" => reading.format = Some(format(value()?)?),
            "--to" => to = Some(format(value()?)?),
            _ => paths.push(PathBuf::from(word)),
        }
    }
    let [from, into] = &paths[..] else {
        return Err(
            "convert IN OUT [--width W --height H] [--from F] [--to F] [--picture NAME]".to_owned(),
        );
    };
    let format = to.or_else(|| Format::by_ending(into));
    let format = format.ok_or_else(|| {
        format!(
            "{}: the ending names no format; --to is needed",
            into.display()
        )
    })?;
    let found = shapes::load_with(from, &reading).map_err(|error| error.to_string())?;
    shapes::save_as(&found, into, format, &context).map_err(|error| error.to_string())
}

//! The work on one picture of many.

use std::sync::Arc;

use scene::SceneError;
use scene::fit::Options;
use store::Results;

use super::flags::Flags;
use super::former::{Former, unsure};
use super::inputs::Input;
use super::measures::{called, rows};
use super::one::{all, picture};
use super::results::{Wanted, write};
use super::sheet::{Place, Sheet};
use super::table;
use crate::args::Words;
use crate::stop::Stop;

/// What became of a picture.
#[derive(Debug)]
pub(super) enum Done {
    /// So many outlines, so many of them not sure, its rows of the table, its place on the page.
    Found {
        outlines: usize,
        unsure: usize,
        rows: String,
        place: Option<Place>,
        notes: Vec<String>,
    },
    /// Its results were there: so many of them marked unsure, its rows of the table.
    There { unsure: usize, rows: String },
    /// Refused, and why.
    Refused(String),
    /// Not begun, since the user asked for an end.
    Stopped,
}

/// A picture, and what is to be made of it.
#[derive(Debug)]
pub(super) struct Job {
    pub(super) input: Input,
    pub(super) wanted: Vec<Wanted>,
}

/// What is asked of every picture.
pub(super) struct Asked<'a> {
    pub(super) options: &'a Options,
    pub(super) sheet: Option<&'a Sheet>,
    pub(super) former: &'a Former,
    pub(super) table: Option<&'a Results>,
}

impl Asked<'_> {
    /// Whether a result is there; rows of a table may be in a file that was joined.
    fn is_there(&self, wanted: &Wanted, image: &str) -> bool {
        let joined = |table: &Results| table.is_finished(image);
        match wanted {
            Wanted::Table(_) => self.table.is_some_and(joined),
            other => other.path().exists(),
        }
    }

    /// How many outlines of a result that is there are marked unsure.
    fn doubted(&self, wanted: &Wanted, image: &str) -> Result<usize, SceneError> {
        match (wanted, self.table) {
            (Wanted::Table(_), Some(table)) => {
                let doubtful = table.doubtful(image).map_err(|e| table::refused(&e))?;
                Ok(doubtful.unwrap_or(0))
            }
            (other, _) => Ok(unsure(other)),
        }
    }
}

/// The work on one picture.
pub(super) fn done(job: &Job, flags: &Flags, asked: &Asked<'_>, stop: &Stop) -> Done {
    let image = store::name_of(&job.input.name);
    if flags.resume
        && job
            .wanted
            .iter()
            .all(|wanted| asked.is_there(wanted, &image))
    {
        let rows = asked.former.rows(&called(&job.input.name));
        // without its rows the table would lack it
        if rows.is_some() || flags.measure.is_none() {
            let (rows, mut most) = rows.unwrap_or_default();
            for wanted in &job.wanted {
                match asked.doubted(wanted, &image) {
                    Ok(doubted) => most = most.max(doubted),
                    Err(error) => return Done::Refused(error.to_string()),
                }
            }
            return Done::There {
                unsure: most,
                rows: rows.to_owned(),
            };
        }
    }
    if stop.asked() {
        return Done::Stopped;
    }
    match attempt(job, flags, asked) {
        Ok(done) => done,
        Err(error) => {
            // the name of the picture is said before it
            let (name, message) = (job.input.image.display().to_string(), error.to_string());
            let rest = message
                .strip_prefix(&name)
                .and_then(|rest| rest.strip_prefix(": "));
            Done::Refused(rest.map_or(message.clone(), str::to_owned))
        }
    }
}

fn attempt(job: &Job, flags: &Flags, asked: &Asked<'_>) -> Result<Done, SceneError> {
    let quiet = Words {
        quiet: true,
        verbose: false,
        json: false,
    };
    let mut notes = Vec::new();
    let mut looked = || -> Result<_, SceneError> {
        let picture = Arc::new(picture(&job.input.image, job.input.page, flags)?);
        let flags = flags.about(&picture, &job.input.name);
        // a picture that is begun is finished: there is no half of a result
        let found = all(
            &picture,
            &job.input.name,
            asked.options,
            &flags,
            &Stop::default(),
            quiet,
            &mut |note| notes.push(note.to_owned()),
        )?;
        Ok((picture, flags, found))
    };
    let (picture, flags, found) = match looked() {
        Ok(found) => found,
        Err(error) => {
            // a row of the table says so, and it is not tried again
            if let Some(table) = asked.table {
                let image = store::name_of(&job.input.name);
                let why = error.to_string();
                table.refuse(&image, &why).map_err(|e| table::refused(&e))?;
            }
            return Err(error);
        }
    };
    let flags = &flags;
    for wanted in &job.wanted {
        write(wanted, &picture, &job.input.name, &found, flags)?;
    }
    let rows = if flags.measure.is_some() {
        rows(&picture, &job.input.name, &found)
    } else {
        String::new()
    };
    let place = match asked.sheet {
        Some(sheet) => Some(sheet.keep(&picture, &job.input.name, &found)?),
        None => None,
    };
    let unsure = found.iter().filter(|found| found.unsure.is_some()).count();
    Ok(Done::Found {
        outlines: found.len(),
        unsure,
        rows,
        place,
        notes,
    })
}

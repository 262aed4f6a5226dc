//! The outlines of many pictures: on all cores, results as they come, a bad file reported and left out.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use indicatif::{ProgressBar, ProgressStyle};
use io::Claims;
use scene::SceneError;
use scene::fit::{Options, in_order};
use serde_json::json;

use super::flags::Flags;
use super::inputs;
use super::measures::{HEADINGS, rows};
use super::one::{all, beside, picture};
use super::options::options;
use super::results::{Wanted, of_folder, write};
use super::sheet::{Place, Rest, Sheet};
use super::start::stem;
use crate::args::Words;
use crate::commands::{Answer, code, key};
use crate::stop::{STOPPED, Stop};

/// What became of a picture.
#[derive(Debug)]
enum Done {
    /// So many outlines, so many of them not sure, its rows of the table, its place on the page.
    Found {
        outlines: usize,
        unsure: usize,
        rows: String,
        place: Option<Place>,
    },
    /// Its results were there.
    There,
    /// Refused, and why.
    Refused(String),
    /// Not begun, since the user asked for an end.
    Stopped,
}

/// What became of all pictures so far.
#[derive(Debug, Default)]
struct Tally {
    outlines: usize,
    unsure: usize,
    rows: String,
    places: Vec<Place>,
    rest: Rest,
}

impl Tally {
    /// Count a picture; what there is to say of it.
    fn count(&mut self, image: &Path, done: Done) -> Option<String> {
        let name = image.display().to_string();
        match done {
            Done::Found {
                outlines,
                unsure,
                rows,
                place,
            } => {
                self.outlines += outlines;
                self.unsure += unsure;
                self.rows.push_str(&rows);
                self.places.extend(place);
                return (unsure > 0)
                    .then(|| format!("{name}: {unsure} of {outlines} outlines unsure"));
            }
            Done::There => self.rest.there.push(name),
            Done::Refused(why) => {
                let text = format!("{name}: {why}");
                self.rest.refused.push((name, why));
                return Some(text);
            }
            Done::Stopped => self.rest.left.push(name),
        }
        None
    }

    fn is_good(&self) -> bool {
        self.rest.refused.is_empty() && self.unsure == 0 && self.rest.left.is_empty()
    }
}

/// Find the outlines of all pictures.
pub(super) fn many(flags: &Flags, images: &[PathBuf], words: Words) -> Answer {
    let Some(folder) = &flags.out_dir else {
        let message = "is needed for several pictures or a folder of them";
        return Err(key("--out-dir", message));
    };
    let options = options(flags)?;
    let pictures = inputs::files(images)?;
    let sheet = Sheet::of(flags.sheet.as_ref())?;
    io::ready_folder(folder)?;
    let jobs = plan(flags, folder, &pictures)?;
    let stop = Stop::listen();
    let threads = flags
        .jobs
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get));
    let bar = bar(jobs.len(), words);
    let mut tally = Tally::default();
    in_order(
        &jobs,
        threads,
        |job| done(job, flags, &options, sheet.as_ref(), &stop),
        |index, done| {
            bar.inc(1);
            if let Some(text) = tally.count(&jobs[index].image, done) {
                bar.suspend(|| words.say(&text));
            }
        },
    );
    bar.finish_and_clear();
    if let Some(path) = &flags.measure {
        io::write_whole(path, format!("{HEADINGS}\n{}", tally.rows).as_bytes())?;
    }
    if let Some(sheet) = sheet {
        sheet.write(&tally.places, &tally.rest)?;
    }
    said(&tally, jobs.len(), words)?;
    let refused = tally.rest.refused.len();
    if jobs.len() == refused && !jobs.is_empty() {
        return Ok(ExitCode::from(2));
    }
    Ok(code(tally.is_good()))
}

/// Say what became of all pictures.
fn said(tally: &Tally, pictures: usize, words: Words) -> Result<(), SceneError> {
    let Tally {
        outlines,
        unsure,
        rest,
        ..
    } = tally;
    let [refused, there, left] = [rest.refused.len(), rest.there.len(), rest.left.len()];
    words.say(&format!(
        "{pictures} pictures: {outlines} outlines, {unsure} of them unsure; {refused} pictures refused, {there} there already",
    ));
    if left > 0 {
        words.say(&format!(
            "{STOPPED}; {left} pictures are left: --resume goes on with them"
        ));
    }
    words.end(&json!({
        "pictures": pictures,
        "outlines": outlines,
        "unsure": unsure,
        "refused": refused,
        "there": there,
        "left": left,
        "good": tally.is_good(),
    }))
}

/// A picture, and what is to be made of it.
#[derive(Debug)]
struct Job {
    image: PathBuf,
    wanted: Vec<Wanted>,
}

/// What is made of each picture: no result takes the place of another, or of what is read.
fn plan(flags: &Flags, folder: &Path, pictures: &[PathBuf]) -> Result<Vec<Job>, SceneError> {
    let mut claims = Claims::default();
    for image in pictures {
        claims.reads(image);
        if let Some(file) = beside(flags, &stem(image)) {
            claims.reads(&file);
        }
    }
    let mut jobs = Vec::new();
    for image in pictures {
        let wanted = of_folder(flags, folder, &stem(image))?;
        for one in &wanted {
            if flags.no_clobber && !flags.resume && one.path().exists() {
                let message = format!(
                    "{} is there already; needed: another folder, or --resume",
                    one.path().display()
                );
                return Err(key("--out-dir", message));
            }
            claims.writes(&format!("--out-dir for {}", image.display()), one.path())?;
        }
        jobs.push(Job {
            image: image.clone(),
            wanted,
        });
    }
    for (flag, path) in [("--measure", &flags.measure), ("--sheet", &flags.sheet)] {
        if let Some(path) = path {
            if flags.no_clobber && !flags.resume && path.exists() {
                let message = format!("{} is there already; needed: another name", path.display());
                return Err(key(flag, message));
            }
            claims.writes(flag, path)?;
        }
    }
    Ok(jobs)
}

/// The work on one picture.
fn done(job: &Job, flags: &Flags, options: &Options, sheet: Option<&Sheet>, stop: &Stop) -> Done {
    if stop.asked() {
        return Done::Stopped;
    }
    if flags.resume && job.wanted.iter().all(|wanted| wanted.path().exists()) {
        return Done::There;
    }
    match attempt(job, flags, options, sheet) {
        Ok(done) => done,
        Err(error) => {
            // the name of the picture is said before it
            let (name, message) = (job.image.display().to_string(), error.to_string());
            let rest = message
                .strip_prefix(&name)
                .and_then(|rest| rest.strip_prefix(": "));
            Done::Refused(rest.map_or(message.clone(), str::to_owned))
        }
    }
}

fn attempt(
    job: &Job,
    flags: &Flags,
    options: &Options,
    sheet: Option<&Sheet>,
) -> Result<Done, SceneError> {
    let quiet = Words {
        quiet: true,
        verbose: false,
        json: false,
    };
    let picture = Arc::new(picture(&job.image, flags)?);
    // a picture that is begun is finished: there is no half of a result
    let found = all(
        &picture,
        &stem(&job.image),
        options,
        flags,
        &Stop::default(),
        quiet,
    )?;
    for wanted in &job.wanted {
        write(wanted, &picture, &job.image, &found, flags)?;
    }
    let rows = if flags.measure.is_some() {
        rows(&picture, &job.image, &found)
    } else {
        String::new()
    };
    let place = match sheet {
        Some(sheet) => Some(sheet.keep(&picture, &job.image, &found)?),
        None => None,
    };
    let unsure = found.iter().filter(|found| found.unsure.is_some()).count();
    Ok(Done::Found {
        outlines: found.len(),
        unsure,
        rows,
        place,
    })
}

/// A bar on standard error with the time that is left.
fn bar(count: usize, words: Words) -> ProgressBar {
    if words.quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(count as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} pictures, {eta} left") {
        bar.set_style(style);
    }
    bar
}

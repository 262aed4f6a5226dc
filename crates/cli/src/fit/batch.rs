//! The outlines of many pictures: on all cores, results as they come, a bad file reported and left out.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use indicatif::{ProgressBar, ProgressStyle};
use io::Claims;
use scene::SceneError;
use scene::fit::in_order;
use serde_json::json;

use super::flags::Flags;
use super::former::Former;
use super::inputs::{self, Input};
use super::job::{Asked, Done, Job, done};
use super::measures::{called, headings};
use super::one::beside;
use super::options::options;
use super::results::{Wanted, of_folder};
use super::said::counted;
use super::sheet::{Place, Rest, Sheet};
use super::start::stem;
use super::table;
use crate::args::Words;
use crate::commands::{Answer, code, key};
use crate::output::put_bytes;
use crate::stop::{STOPPED, Stop};

/// What became of all pictures so far.
#[derive(Debug, Default)]
struct Tally {
    outlines: usize,
    unsure: usize,
    rows: String,
    places: Vec<Place>,
    /// Outlines marked unsure among the results that were there.
    doubted: usize,
    rest: Rest,
}

impl Tally {
    /// Count a picture; what there is to say of it.
    fn count(&mut self, image: &Path, done: Done) -> Vec<String> {
        let name = image.display().to_string();
        match done {
            Done::Found {
                outlines,
                unsure,
                rows,
                place,
                notes,
            } => {
                self.outlines += outlines;
                self.unsure += unsure;
                self.rows.push_str(&rows);
                self.places.extend(place);
                let notes = notes.into_iter().map(|note| format!("note: {note}"));
                let doubt = (unsure > 0).then(|| {
                    let outlines = counted(outlines, "outline");
                    format!("{name}: {unsure} of {outlines} unsure")
                });
                return notes.chain(doubt).collect();
            }
            Done::There { unsure, rows } => {
                self.doubted += unsure;
                self.rows.push_str(&rows);
                let text = (unsure > 0).then(|| {
                    format!(
                        "{name}: there already, {} unsure",
                        counted(unsure, "outline")
                    )
                });
                self.rest.there.push(name);
                return text.into_iter().collect();
            }
            Done::Refused(why) => {
                let text = format!("{name}: {why}");
                self.rest.refused.push((name, why));
                return vec![text];
            }
            Done::Stopped => self.rest.left.push(name),
        }
        Vec::new()
    }

    fn is_good(&self) -> bool {
        let unsure = self.unsure + self.doubted;
        self.rest.refused.is_empty() && unsure == 0 && self.rest.left.is_empty()
    }
}

/// Find the outlines of all pictures.
pub(super) fn many(flags: &Flags, images: &[PathBuf], words: Words) -> Answer {
    let Some(folder) = &flags.out_dir else {
        let message = "is needed for several pictures or a folder of them";
        return Err(key("--out-dir", message));
    };
    let options = options(flags)?;
    let pictures = inputs::pictures(images, flags)?;
    let sheet = Sheet::of(flags.sheet.as_ref())?;
    if io::is_standard(folder) {
        return Err(key("--out-dir", "must be a folder, got standard output"));
    }
    let former = Former::of(flags)?;
    io::ready_folder(folder)?;
    let table = table::of(flags, folder)?;
    apart(flags, folder, &pictures)?;
    let jobs = plan(flags, folder, &pictures)?;
    if let Some(path) = flags.measure.as_ref().filter(|_| words.json)
        && io::is_standard(path)
    {
        let message = "writes to standard output, and so does --measure; give --measure a file";
        return Err(key("--json", message));
    }
    let stop = Stop::listen();
    let threads = flags
        .jobs
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get));
    let bar = bar(jobs.len(), words);
    let asked = Asked {
        options: &options,
        sheet: sheet.as_ref(),
        former: &former,
        table: table.as_ref(),
    };
    let mut tally = Tally::default();
    in_order(
        &jobs,
        threads,
        |job| done(job, flags, &asked, &stop),
        |index, done| {
            bar.inc(1);
            for text in tally.count(&jobs[index].input.name, done) {
                bar.suspend(|| words.say(&text));
            }
        },
    );
    bar.finish_and_clear();
    if let Some(path) = &flags.measure {
        let own: Vec<String> = jobs.iter().map(|job| called(&job.input.name)).collect();
        let others = former.others(own.iter().map(String::as_str));
        let table = format!("{}\n{others}{}", headings(), tally.rows);
        if io::is_standard(path) {
            put_bytes(table.as_bytes())?;
        } else {
            io::write_whole(path, table.as_bytes())?;
        }
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
        doubted,
        rest,
        ..
    } = tally;
    let [refused, there, left] = [rest.refused.len(), rest.there.len(), rest.left.len()];
    words.say(&format!(
        "{}: {}, {unsure} of them unsure; {} refused, {there} there already",
        counted(pictures, "picture"),
        counted(*outlines, "outline"),
        counted(refused, "picture"),
    ));
    if *doubted > 0 {
        words.say(&format!(
            "of what was there already, {} marked unsure",
            counted(*doubted, "outline")
        ));
    }
    if left > 0 {
        words.say(&format!(
            "{STOPPED}; left: {}; --resume goes on with that",
            counted(left, "picture")
        ));
    }
    words.end(&json!({
        "pictures": pictures,
        "outlines": outlines,
        "unsure": unsure,
        "refused": refused,
        "there": there,
        "there_unsure": doubted,
        "left": left,
        "good": tally.is_good(),
    }))
}

/// Refuse to write pictures where pictures are looked for: the next run would take them for its own.
fn apart(flags: &Flags, folder: &Path, pictures: &[Input]) -> Result<(), SceneError> {
    if !of_folder(flags, folder, "picture".as_ref())?
        .iter()
        .any(Wanted::is_picture)
    {
        return Ok(());
    }
    let same = |path: &Path| {
        let path = if path.as_os_str().is_empty() {
            Path::new(".")
        } else {
            path
        };
        let real = std::fs::canonicalize(path).ok();
        real.is_some() && real == std::fs::canonicalize(folder).ok()
    };
    // those that are named themselves are told from results by that
    let mut looked = pictures
        .iter()
        .filter(|input| !flags.images.contains(&input.image));
    if looked.any(|input| input.image.parent().is_some_and(same)) {
        let message = format!(
            "{} is where the pictures are looked for, and among the results are pictures, which the next run would take \
             for more of them; needed: another folder",
            folder.display()
        );
        return Err(key("--out-dir", message));
    }
    Ok(())
}

/// What is made of each picture: no result takes the place of another, or of what is read.
fn plan(flags: &Flags, folder: &Path, pictures: &[Input]) -> Result<Vec<Job>, SceneError> {
    let mut claims = Claims::default();
    for Input { image, name, .. } in pictures {
        claims.reads(image);
        if let Some(file) = beside(flags, &stem(name)) {
            claims.reads(&file);
        }
    }
    let mut jobs = Vec::new();
    for input in pictures {
        let wanted = of_folder(flags, folder, &input.name)?;
        for one in &wanted {
            if flags.no_clobber && !flags.resume && one.path().exists() {
                let message = format!(
                    "{} is there already; needed: another folder, or --resume",
                    one.path().display()
                );
                return Err(key("--out-dir", message));
            }
            let result = format!("--out-dir for {}", input.name.display());
            claims.writes(&result, one.path())?;
        }
        jobs.push(Job {
            input: input.clone(),
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

//! The outlines of many pictures: on all cores, results as they come, a bad file reported and left out.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, mpsc};

use indicatif::{ProgressBar, ProgressStyle};
use io::Claims;
use scene::SceneError;
use scene::fit::Options;
use serde_json::json;

use super::flags::Flags;
use super::one::{all, beside, picture};
use super::options::options;
use super::results::{HEADINGS, Wanted, of_folder, rows, write};
use super::start::stem;
use crate::args::Words;
use crate::commands::{Answer, code, key};
use crate::stop::{STOPPED, Stop};

/// Endings of the names of pictures in a folder.
const ENDINGS: [&str; 12] = [
    "png", "jpg", "jpeg", "tif", "tiff", "pgm", "ppm", "pnm", "pbm", "pfm", "webp", "btf",
];

/// What became of a picture.
#[derive(Debug)]
enum Done {
    /// So many outlines, so many of them not sure, and its rows of the table.
    Found {
        outlines: usize,
        unsure: usize,
        rows: String,
    },
    /// Its results were there.
    There,
    /// Refused, and why.
    Refused(String),
    /// Not begun, since the user asked for an end.
    Stopped,
}

/// Find the outlines of all pictures.
pub(super) fn many(flags: &Flags, words: Words) -> Answer {
    let Some(folder) = &flags.out_dir else {
        let message = "is needed for several pictures or a folder of them";
        return Err(key("--out-dir", message));
    };
    let options = options(flags)?;
    let pictures = pictures(&flags.images)?;
    io::ready_folder(folder)?;
    let jobs = plan(flags, folder, &pictures)?;
    let stop = Stop::listen();
    let threads = flags
        .jobs
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get));
    let bar = bar(jobs.len(), words);
    let mut table = format!("{HEADINGS}\n");
    let (mut found, mut unsure, mut there, mut refused, mut left) = (0, 0, 0, 0, 0);
    in_order(
        &jobs,
        threads.clamp(1, jobs.len().max(1)),
        |job| done(job, flags, &options, &stop),
        |job, one| {
            bar.inc(1);
            match one {
                Done::Found {
                    outlines,
                    unsure: doubtful,
                    rows,
                } => {
                    found += outlines;
                    unsure += doubtful;
                    table.push_str(&rows);
                    if doubtful > 0 {
                        let which = job.image.display();
                        let text = format!("{which}: {doubtful} of {outlines} outlines unsure");
                        bar.suspend(|| words.say(&text));
                    }
                }
                Done::There => there += 1,
                Done::Refused(why) => {
                    refused += 1;
                    bar.suspend(|| words.say(&why));
                }
                Done::Stopped => left += 1,
            }
        },
    );
    bar.finish_and_clear();
    if let Some(path) = &flags.measure {
        io::write_whole(path, table.as_bytes())?;
    }
    words.say(&format!(
        "{} pictures: {found} outlines, {unsure} of them unsure; {refused} pictures refused, {there} there already",
        jobs.len()
    ));
    if left > 0 {
        words.say(&format!(
            "{STOPPED}; {left} pictures are left: --resume goes on with them"
        ));
    }
    let good = refused == 0 && unsure == 0 && left == 0;
    words.end(&json!({
        "pictures": jobs.len(),
        "outlines": found,
        "unsure": unsure,
        "refused": refused,
        "there": there,
        "left": left,
        "good": good,
    }))?;
    if jobs.len() == refused && !jobs.is_empty() {
        return Ok(ExitCode::from(2));
    }
    Ok(code(good))
}

/// A picture, and what is to be made of it.
#[derive(Debug)]
struct Job {
    image: PathBuf,
    wanted: Vec<Wanted>,
}

/// The files of all pictures named, those of folders by name.
fn pictures(images: &[PathBuf]) -> Result<Vec<PathBuf>, SceneError> {
    let mut list = Vec::new();
    for image in images {
        if !image.is_dir() {
            list.push(image.clone());
            continue;
        }
        let refuse =
            |error: std::io::Error| key("picture", format!("{}: {error}", image.display()));
        let mut inside = Vec::new();
        for entry in std::fs::read_dir(image).map_err(refuse)? {
            let path = entry.map_err(refuse)?.path();
            let ending = path
                .extension()
                .map(|ending| ending.to_string_lossy().to_lowercase());
            if path.is_file() && ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str())) {
                inside.push(path);
            }
        }
        if inside.is_empty() {
            let message = format!(
                "{} holds no picture ({})",
                image.display(),
                ENDINGS.join(", ")
            );
            return Err(key("picture", message));
        }
        inside.sort();
        list.append(&mut inside);
    }
    Ok(list)
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
    if let Some(path) = &flags.measure {
        claims.writes("--measure", path)?;
    }
    Ok(jobs)
}

/// The work on one picture.
fn done(job: &Job, flags: &Flags, options: &Options, stop: &Stop) -> Done {
    if stop.asked() {
        return Done::Stopped;
    }
    if flags.resume && job.wanted.iter().all(|wanted| wanted.path().exists()) {
        return Done::There;
    }
    match attempt(job, flags, options) {
        Ok(done) => done,
        Err(error) => {
            let name = job.image.display().to_string();
            let message = error.to_string();
            Done::Refused(if message.starts_with(&name) {
                message
            } else {
                format!("{name}: {message}")
            })
        }
    }
}

fn attempt(job: &Job, flags: &Flags, options: &Options) -> Result<Done, SceneError> {
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
        write(wanted, &picture, &job.image, &found)?;
    }
    let rows = if flags.measure.is_some() {
        rows(&picture, &job.image, &found)
    } else {
        String::new()
    };
    let unsure = found.iter().filter(|found| found.unsure.is_some()).count();
    Ok(Done::Found {
        outlines: found.len(),
        unsure,
        rows,
    })
}

/// Work on so many threads; results are handed over in the order of the jobs, as soon as they are there.
fn in_order(
    jobs: &[Job],
    threads: usize,
    work: impl Fn(&Job) -> Done + Sync,
    mut each: impl FnMut(&Job, Done),
) {
    let next = &AtomicUsize::new(0);
    let work = &work;
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let send = send.clone();
            scope.spawn(move || {
                while let Some((index, job)) = {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    jobs.get(index).map(|job| (index, job))
                } {
                    if send.send((index, work(job))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(send);
        let mut waiting = std::collections::BTreeMap::new();
        let mut due = 0;
        for (index, done) in receive {
            waiting.insert(index, done);
            while let Some(done) = waiting.remove(&due) {
                each(&jobs[due], done);
                due += 1;
            }
        }
    });
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

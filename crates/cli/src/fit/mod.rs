//! `snake fit`: the outlines of one picture or of many.

mod batch;
mod flags;
mod one;
mod options;
mod results;
mod seeds;
mod start;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use io::is_standard;
use scene::snake::Outcome;
use serde_json::json;

pub(crate) use self::flags::{EXAMPLES, Flags};
use self::one::{Found, all, beside, picture};
pub(crate) use self::options::rules as search_rules;
use self::results::{HEADINGS, rows, write};
use self::start::stem;
use crate::args::Words;
use crate::commands::{Answer, code, key, objects, two_inputs};
use crate::output::{goes_nowhere, put_bytes};
use crate::stop::{STOPPED, Stop};

/// What a fit is called in what is said.
const TITLE: &str = "a contour fitted to a picture";

/// Find the outlines of a picture, or of many.
pub(crate) fn fit(flags: &Flags, words: Words) -> Answer {
    match &flags.images[..] {
        [image] if flags.out_dir.is_none() && !image.is_dir() => single(flags, image, words),
        _ => batch::many(flags, words),
    }
}

/// The outlines of one picture into the files that are named.
fn single(flags: &Flags, image: &Path, words: Words) -> Answer {
    let words = Words {
        verbose: words.verbose || flags.explain,
        ..words
    };
    let options = options::options(flags)?;
    let file = beside(flags, &stem(image));
    two_inputs(image, file.as_deref())?;
    let wanted = results::of_files(flags)?;
    if words.json
        && let Some((flag, _)) = wanted.iter().find(|(_, wanted)| is_standard(wanted.path()))
    {
        let message = format!("writes to standard output, and so does {flag}; give {flag} a file");
        return Err(key("--json", message));
    }
    let picture = Arc::new(picture(image, flags)?);
    let inputs: Vec<PathBuf> = [Some(image.to_owned()), file]
        .into_iter()
        .flatten()
        .collect();
    results::check(flags, &wanted, &inputs)?;
    let stop = Stop::listen();
    let found = all(&picture, &stem(image), &options, flags, &stop, words)?;
    if found.is_empty() && flags.seeds.is_some() {
        words.say("no object here");
    }
    let blown_up = |found: &Found| {
        let outcome = found.fit.as_ref().map(|fit| fit.outcome);
        outcome.filter(|outcome| matches!(outcome, Outcome::Diverged { .. }))
    };
    if let Some(outcome) = found.first().and_then(blown_up)
        && found.iter().all(|found| found.shape.is_none())
    {
        words.say(&format!("{TITLE}: {outcome}; no contour to write"));
        return Ok(ExitCode::from(1));
    }
    for (_, one) in &wanted {
        if is_standard(one.path()) && goes_nowhere() {
            words.say("note: standard output is closed or /dev/null: the contour is kept nowhere");
        }
        if let Some(bytes) = write(one, &picture, image, &found)? {
            put_bytes(&bytes)?;
        }
    }
    if let Some(path) = &flags.measure {
        let table = format!("{HEADINGS}\n{}", rows(&picture, image, &found));
        if is_standard(path) {
            put_bytes(table.as_bytes())?;
        } else {
            io::write_whole(path, table.as_bytes())?;
        }
    }
    let stopped = stop.asked();
    let some = flags.seeds.is_none() || !found.is_empty();
    let good = said(&found, words) && some && !stopped;
    if stopped {
        words.say(STOPPED);
    }
    words.end(&summary(&found, good))?;
    Ok(code(good))
}

/// Say how each outline ended; whether all are good.
fn said(found: &[Found], words: Words) -> bool {
    let mut good = true;
    for (index, one) in found.iter().enumerate() {
        let title = match found.len() {
            1 => TITLE.to_owned(),
            count => format!("outline {} of {count}", index + 1),
        };
        let Some(fit) = &one.fit else {
            if let Some(why) = &one.unsure {
                words.say(&format!("{title}: {why}"));
            }
            good &= one.unsure.is_none();
            continue;
        };
        for line in fit.chosen.to_string().lines() {
            words.detail(&if found.len() > 1 {
                format!("{title}: {line}")
            } else {
                line.to_owned()
            });
        }
        words.say(&format!("{title}: {}", fit.outcome));
        if matches!(fit.outcome, Outcome::Finished { .. }) {
            words.say("it was to come to rest and has not: allow more steps");
        }
        if let Some(quality) = &fit.quality {
            objects(&title, quality, words);
        }
        good &= one.unsure.is_none();
    }
    if found.iter().any(|one| one.fit.is_none()) {
        words.say(&format!("{} objects found", found.len()));
    }
    good
}

/// How it ended, as JSON: of one outline its own words, of several a list.
fn summary(found: &[Found], good: bool) -> serde_json::Value {
    if let [one] = found
        && let Some(fit) = &one.fit
    {
        let mut value = one::json(one);
        value["title"] = json!(TITLE);
        value["good"] = json!(good);
        value["curves"] = fit
            .quality
            .as_ref()
            .map(crate::commands::told)
            .into_iter()
            .collect();
        return value;
    }
    let outlines: Vec<serde_json::Value> = found.iter().map(one::json).collect();
    json!({ "title": TITLE, "good": good, "outlines": outlines })
}

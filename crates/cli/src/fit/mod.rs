//! `snake fit`: the outlines of one picture or of many.

mod batch;
mod beside;
mod film;
mod flags;
mod former;
mod inputs;
mod job;
mod measures;
mod one;
mod options;
mod overlay;
mod results;
mod said;
mod seeds;
mod sheet;
mod start;
mod table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use io::is_standard;
use scene::SceneError;
use scene::fit::Method;
use scene::snake::Outcome;

pub(crate) use self::flags::Origin;
use self::flags::Pages;
pub(crate) use self::flags::{EXAMPLES, Flags};
pub(crate) use self::inputs::matched;
use self::measures::{headings, rows};
use self::one::{Found, all, beside, picture};
pub(crate) use self::options::rules as search_rules;
use self::results::write;
pub(crate) use self::said::counted;
use self::said::{said, summary};
pub(crate) use self::seeds::Where;
use self::sheet::{Rest, Sheet};
pub(crate) use self::start::{Start, stem, typed};
use crate::args::Words;
use crate::commands::{Answer, code, key, two_inputs};
use crate::output::{goes_nowhere, put_bytes};
use crate::stop::{STOPPED, Stop};
pub(crate) use score::table::{plain, quoted};

/// What a fit is called in what is said.
const TITLE: &str = "a contour fitted to a picture";

/// Find the outlines of a picture, or of many.
pub(crate) fn fit(flags: &Flags, words: Words) -> Answer {
    let images = matched(&flags.images)?;
    match &images[..] {
        [image] if flags.out_dir.is_none() && !image.is_dir() => single(flags, image, words),
        _ => batch::many(flags, &images, words),
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
    if flags.record.is_some() && options.method == Method::Search {
        let message = "a search has no motion to record; needed: --method motion, or --animation, which shows its stages";
        return Err(key("--record", message));
    }
    let sheet = Sheet::of(flags.sheet.as_ref())?;
    let more = [("--record", &flags.record), ("--measure", &flags.measure)];
    let more = more
        .iter()
        .filter_map(|(flag, path)| Some((*flag, path.as_deref()?)));
    let mut outputs = wanted
        .iter()
        .map(|(flag, wanted)| (*flag, wanted.path()))
        .chain(more);
    if words.json
        && let Some((flag, _)) = outputs.find(|(_, path)| is_standard(path))
    {
        let message = format!("writes to standard output, and so does {flag}; give {flag} a file");
        return Err(key("--json", message));
    }
    let page = match flags.page {
        None => None,
        Some(Pages::One(page)) => Some(page),
        Some(Pages::All) => {
            let message =
                "all makes outlines of each page; needed: --out-dir, or the number of a page";
            return Err(key("--page", message));
        }
    };
    let picture = Arc::new(picture(image, page, flags)?);
    let inputs: Vec<PathBuf> = [Some(image.to_owned()), file]
        .into_iter()
        .flatten()
        .collect();
    results::check(flags, &wanted, &inputs)?;
    let stop = Stop::listen();
    let flags = &flags.about(&picture, image);
    let mut say = |note: &str| words.say(&format!("note: {note}"));
    let found = all(&picture, image, &options, flags, &stop, words, &mut say)?;
    results::check_count(flags, found.len())?;
    if let Some(path) = &flags.record {
        recorded(path, image, &found)?;
    }
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
        if let Some(bytes) = write(one, &picture, image, &found, flags)? {
            put_bytes(&bytes)?;
        }
    }
    if let Some(path) = &flags.measure {
        let table = format!("{}\n{}", headings(), rows(&picture, image, &found));
        if is_standard(path) {
            put_bytes(table.as_bytes())?;
        } else {
            io::write_whole(path, table.as_bytes())?;
        }
    }
    if let Some(sheet) = sheet {
        let place = sheet.keep(&picture, image, &found)?;
        sheet.write(&[place], &Rest::default())?;
    }
    let stopped = stop.asked();
    let some = flags.seeds.is_none() || !found.is_empty();
    let good = said(&found, words) && some && !stopped;
    if stopped {
        words.say(STOPPED);
    }
    words.end(&summary(&found, good, flags.evidence))?;
    Ok(code(good))
}

/// Write how the curve moved.
fn recorded(path: &Path, image: &Path, found: &[Found]) -> Result<(), SceneError> {
    let [one] = found else {
        let message = format!("holds the motion of one curve; got {} starts", found.len());
        return Err(key("--record", message));
    };
    let Some(record) = film::record(one, &stem(image), TITLE) else {
        return Ok(());
    };
    if is_standard(path) {
        return put_bytes(record.to_json_lines()?.as_bytes());
    }
    Ok(record.save(path)?)
}

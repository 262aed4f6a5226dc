//! `snake eval`: the fit of `snake fit` against truth, as a table.

mod change;
mod clock;
mod csv;
pub(crate) mod flags;
mod follow;
mod many;
mod rows;
mod set;
mod sheet;
mod synthetic;
mod table;

use std::num::NonZero;
use std::path::{Path, PathBuf};

use io::{Claims, RgbImage, is_standard, paint, write_whole};
use scene::SceneError;
use serde_json::{Value, json};

use self::change::Change;
use self::flags::Eval;
use self::rows::{Row, Way};
use self::set::{SEED, Set};
use scene::fit::Options;

use crate::args::Words;
use crate::commands::{Answer, code, key};
use crate::fit::search_rules;
use crate::output::{complain, put};
use crate::stop::{STOPPED, Stop};

/// How many of the worst results are drawn if not told.
const WORST: usize = 12;
/// How many are drawn at most.
const MOST_WORST: usize = 360;

pub(crate) fn eval(flags: &Eval, words: Words) -> Answer {
    let change = Change::of(flags)?;
    if let Some(got) = flags.worst {
        if flags.sheet.is_none() {
            return Err(key(
                "--worst",
                "says how many a sheet shows, and needs --sheet",
            ));
        }
        if !(1..=MOST_WORST).contains(&got) {
            return Err(key(
                "--worst",
                format!("must be from 1 to {MOST_WORST}, got {got}"),
            ));
        }
    }
    let stop = Stop::listen();
    let options = Options {
        search: search_rules(&flags.rules, flags.polarity)?,
        ..Options::default()
    };
    let way = Way {
        options,
        change,
        alone: flags.jobs.get() == 1,
        stop: &stop,
    };
    if flags.set == Path::new("synthetic") && !flags.set.exists() {
        return drawn(flags, &way, words);
    }
    if let Some(answer) = follow::answer(flags, &way, words)? {
        return answer;
    }
    let mut set = Set::load(&flags.set, &flags.inits)?;
    if set.many {
        one_object_only(flags, &way, "starts of many objects in a picture")?;
        if flags.sheet.as_ref().is_some_and(|path| sheet::is_one(path)) {
            let message =
                "a folder is needed: pictures of many objects are drawn whole, a file each";
            return Err(key("--sheet", message));
        }
    } else {
        circles_only(flags)?;
    }
    let known = set.cases.iter().flat_map(|case| case.starts.iter());
    let known: Vec<&str> = known.map(|start| start.quality.as_str()).collect();
    check_qualities(&flags.quality, &known)?;
    for case in &mut set.cases {
        let wanted = &flags.quality;
        case.starts
            .retain(|start| wanted.is_empty() || wanted.contains(&start.quality));
    }
    set.cases.retain(|case| !case.starts.is_empty());
    let mut claims = Claims::default();
    for case in &set.cases {
        let files = [Some(&case.picture), Some(&case.mask), case.labels.as_ref()];
        files
            .into_iter()
            .flatten()
            .for_each(|path| claims.reads(path));
    }
    set.tables.iter().for_each(|path| claims.reads(path));
    check_outputs(flags, &mut claims, words)?;
    if set.many {
        crowds(flags, set, &way, &mut claims, words)
    } else {
        singles(flags, set, &way, &mut claims, words)
    }
}

/// Pictures of one object each, with masks.
fn singles(flags: &Eval, set: Set, way: &Way<'_>, claims: &mut Claims, words: Words) -> Answer {
    let answers = in_order(set.cases.len(), flags.jobs, |at| {
        rows::rows(&set.cases[at], way)
    });
    let mut problems = set.problems;
    let rows: Vec<Row> = sorted_out(answers, &mut problems)
        .into_iter()
        .flatten()
        .collect();
    let mut end = End::of(flags, way, words, problems);
    end.nothing(rows.is_empty())?;
    if let Some(path) = &flags.sheet {
        let order = sheet::worst(&rows, flags.worst.unwrap_or(WORST));
        let mut tiles: Vec<(usize, RgbImage)> = Vec::new();
        for index in order {
            let case = set.cases.iter().find(|case| case.stem == rows[index].stem);
            match case.map(|case| sheet::tile(&rows[index], case)) {
                Some(Ok(tile)) => tiles.push((index, tile)),
                Some(Err(problem)) => end.problems.push(format!("{problem}; it is not drawn")),
                None => {}
            }
        }
        draw(path, &tiles, &rows, claims, words)?;
    }
    let summaries = table::summaries(&rows);
    let told = summaries.iter().map(table::Summary::json).collect();
    end.tell(
        &table::text(&summaries, way.change.is_some()),
        &table::each(&rows),
        told,
    )
}

/// Write the tiles, on one sheet or as files of their own, and say which is which.
fn draw(
    path: &Path,
    tiles: &[(usize, RgbImage)],
    rows: &[Row],
    claims: &mut Claims,
    words: Words,
) -> Result<(), SceneError> {
    let columns = sheet::columns(tiles.len());
    for (place, (index, tile)) in tiles.iter().enumerate() {
        let row = &rows[*index];
        let iou = (row.iou(), row.start_iou);
        let what = format!(
            "{} {}: IoU {:.4}, start {:.4}",
            row.stem, row.quality, iou.0, iou.1
        );
        if sheet::is_one(path) {
            let (down, along) = (place / columns + 1, place % columns + 1);
            words.say(&format!("row {down}, column {along}: {what}"));
        } else {
            let file = sheet::file(path, place, row);
            claims.writes("--sheet", &file)?;
            paint::save_png(tile, &file)?;
            words.say(&format!("{}: {what}", file.display()));
        }
    }
    if sheet::is_one(path) {
        let images: Vec<RgbImage> = tiles.iter().map(|(_, tile)| tile.clone()).collect();
        paint::save_png(&sheet::sheet(&images, columns), path)?;
    }
    Ok(())
}

/// Pictures of many objects each, with labels.
fn crowds(flags: &Eval, set: Set, way: &Way<'_>, claims: &mut Claims, words: Words) -> Answer {
    let answers = in_order(set.cases.len(), flags.jobs, |at| {
        many::crowd(&set.cases[at], flags.seeds.unwrap_or_default(), way)
    });
    let mut problems = set.problems;
    let crowds = sorted_out(answers, &mut problems);
    let mut end = End::of(flags, way, words, problems);
    end.nothing(crowds.is_empty())?;
    if let Some(folder) = &flags.sheet {
        for crowd in &crowds {
            let case = set.cases.iter().find(|case| case.stem == crowd.stem);
            match case.map(|case| many::drawn(crowd, case)) {
                Some(Ok(image)) => {
                    let file = sheet::plain_file(folder, &crowd.stem);
                    claims.writes("--sheet", &file)?;
                    paint::save_png(&image, &file)?;
                    words.say(&format!("{}: {}", file.display(), crowd.stem));
                }
                Some(Err(problem)) => end.problems.push(format!("{problem}; it is not drawn")),
                None => {}
            }
        }
    }
    end.tell(
        &many::text(&crowds),
        &many::each(&crowds),
        vec![many::json(&crowds)],
    )
}

/// Drawn pictures.
fn drawn(flags: &Eval, way: &Way<'_>, words: Words) -> Answer {
    one_object_only(flags, way, "drawn pictures")?;
    circles_only(flags)?;
    if flags.sheet.is_some() {
        let message = "drawn pictures cannot have it; a folder of pictures is needed";
        return Err(key("--sheet", message));
    }
    if let Some(path) = flags.inits.first() {
        let message = format!(
            "drawn pictures have starts of their own, got {}",
            path.display()
        );
        return Err(key("--inits", message));
    }
    check_qualities(&flags.quality, &synthetic::names())?;
    check_outputs(flags, &mut Claims::default(), words)?;
    let all = synthetic::all();
    let work = |at: usize| synthetic::results(&all[at], &flags.quality, way);
    let results: Vec<_> = in_order(all.len(), flags.jobs, work)
        .into_iter()
        .flatten()
        .collect();
    let end = End::of(flags, way, words, Vec::new());
    end.tell(
        &synthetic::text(&results),
        &synthetic::each(&results),
        synthetic::json(&results),
    )
}

/// Refuse flags that are for sets of one object a picture.
fn one_object_only(flags: &Eval, way: &Way<'_>, what: &str) -> Result<(), SceneError> {
    let changed = [
        ("--invert", flags.invert),
        ("--darken", flags.darken.is_some()),
        ("--turn", flags.turn.is_some()),
        ("--double", flags.double),
    ];
    let mut changed = changed.into_iter().filter(|_| way.change.is_some());
    let given = changed.find(|(_, given)| *given);
    given.map_or(Ok(()), |(flag, _)| {
        let message =
            format!("{what} cannot have it; a folder of pictures with one object each is needed");
        Err(key(flag, message))
    })
}

/// Refuse the flag that says where many objects are looked for.
fn circles_only(flags: &Eval) -> Result<(), SceneError> {
    if flags.seeds.is_some() {
        let message =
            "is for many objects in a picture; needed: a column inner_r in the file of starts";
        return Err(key("--seeds", message));
    }
    Ok(())
}

/// Refuse a quality that no start has.
fn check_qualities(wanted: &[String], known: &[&str]) -> Result<(), SceneError> {
    let missing = wanted.iter().find(|name| !known.contains(&name.as_str()));
    missing.map_or(Ok(()), |name| {
        let mut all: Vec<&str> = Vec::new();
        for name in known.iter().filter(|name| **name != SEED) {
            if !all.contains(name) {
                all.push(name);
            }
        }
        let all = io::text::clip(&all.join(", "));
        let name = io::text::clip(name);
        Err(key(
            "--quality",
            format!("no start has the quality \"{name}\"; there are: {all}"),
        ))
    })
}

/// Find out before the work whether everything can be written after it.
fn check_outputs(flags: &Eval, claims: &mut Claims, words: Words) -> Result<(), SceneError> {
    if let Some(path) = &flags.each {
        if is_standard(path) {
            let (flag, instead) = if words.json {
                ("--json", "give --each a file")
            } else {
                ("--each", "a file is needed, as the table goes there")
            };
            return Err(key(
                flag,
                format!("--each would go to standard output; {instead}"),
            ));
        }
        claims.writes("--each", path)?;
    }
    if let Some(path) = &flags.sheet {
        if sheet::is_one(path) {
            claims.writes("--sheet", path)?;
        } else {
            io::ready_folder(path)?;
        }
    }
    Ok(())
}

/// What could be done, in order; what could not becomes a problem.
fn sorted_out<T>(answers: Vec<Result<T, String>>, problems: &mut Vec<String>) -> Vec<T> {
    let mut good = Vec::new();
    for answer in answers {
        match answer {
            Ok(one) => good.push(one),
            Err(problem) => problems.push(format!("{problem}; the picture is left out")),
        }
    }
    good
}

/// How an evaluation ends.
struct End<'a> {
    set: String,
    each: Option<&'a PathBuf>,
    stopped: bool,
    words: Words,
    problems: Vec<String>,
}

impl<'a> End<'a> {
    fn of(flags: &'a Eval, way: &Way<'_>, words: Words, problems: Vec<String>) -> Self {
        Self {
            set: flags.set.display().to_string(),
            each: flags.each.as_ref(),
            stopped: way.stop.asked(),
            words,
            problems,
        }
    }

    /// Say what was broken; refuse if that leaves nothing.
    fn nothing(&self, empty: bool) -> Result<(), SceneError> {
        if !empty || self.stopped {
            return Ok(());
        }
        self.problems.iter().for_each(|problem| complain(problem));
        let message =
            "nothing to score; needed: a picture with its truth and a start that are not broken";
        Err(key(&self.set, message))
    }

    /// Write the table and a row a fit, say what was broken, and turn that into a code.
    fn tell(&self, table: &str, each: &str, told: Vec<Value>) -> Answer {
        if let Some(path) = self.each {
            write_whole(path, each.as_bytes())?;
        }
        if !self.words.json {
            put(table)?;
        }
        self.problems.iter().for_each(|problem| complain(problem));
        if self.stopped {
            self.words.say(STOPPED);
        }
        let good = self.problems.is_empty() && !self.stopped;
        self.words.end(&json!({
            "set": self.set,
            "rows": told,
            "problems": self.problems,
            "good": good,
        }))?;
        Ok(code(good))
    }
}

/// Do so many pieces of work on so many threads; the answers are in the order of the work.
fn in_order<T: Send>(
    count: usize,
    jobs: NonZero<usize>,
    work: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    let numbers: Vec<usize> = (0..count).collect();
    let mut answers = Vec::with_capacity(count);
    scene::fit::in_order(
        &numbers,
        jobs.get(),
        |number| work(*number),
        |_, answer| answers.push(answer),
    );
    answers
}

//! The trials of schemes, and soft bodies by other methods: claims, tables, drawings, a page.
//!
//! `cargo run --release -p benches --example trials -- [--only ID] [--out DIR]` runs them, one
//! after the other so that times are not disturbed, and writes into DIR (`trials` if none is given). With
//! `--check` it writes nothing: it judges the schemes on their short form, in which forces are
//! counted, and compares numbers and drawing of the soft bodies with those committed. `--accept`
//! takes what is found of the soft bodies as committed from now on.

#![allow(clippy::print_stdout, reason = "an example tells what it found")]

use benches::{PEERS, TRIALS, TRIALS_IN_SHORT};
use sandbox::{Committed, Done, Experiment, Folder, SandboxError, accept, claims, faults, page};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What was asked for.
#[derive(Default)]
struct Asked {
    only: Vec<String>,
    out: Option<PathBuf>,
    check: bool,
    accept: bool,
}

/// The committed numbers and drawing of the soft bodies.
fn committed() -> Committed {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    Committed {
        expected: root.join("expected"),
        figures: root.join("../docs/benches"),
        gallery: PathBuf::new(),
    }
}

fn main() -> ExitCode {
    let done = asked().and_then(|asked| {
        let known = |id: &String| all().any(|one| one.id == *id);
        if let Some(id) = asked.only.iter().find(|id| !known(id)) {
            let known: Vec<&str> = all().map(|one| one.id).collect();
            return Err(format!(
                "--only must be one of {}, got {id}",
                known.join(", ")
            ));
        }
        let done = if asked.check {
            check(&asked)
        } else {
            run(&asked)
        };
        done.map_err(|error| error.to_string())
    });
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(reason) => {
            println!("error: {reason}");
            ExitCode::from(2)
        }
    }
}

/// The arguments, or what is wrong with them.
fn asked() -> Result<Asked, String> {
    let mut asked = Asked::default();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--only" => asked.only.push(value()?),
            "--out" => asked.out = Some(value()?.into()),
            "--check" => asked.check = true,
            "--accept" => asked.accept = true,
            other => return Err(format!("unknown argument {other}; see benches/trials.rs")),
        }
    }
    Ok(asked)
}

/// Every experiment there is here.
fn all() -> impl Iterator<Item = &'static Experiment> {
    TRIALS.iter().copied().chain([&PEERS])
}

/// Those that were asked for.
fn chosen<'a>(
    asked: &'a Asked,
    trials: &'static [&'static Experiment],
) -> impl Iterator<Item = &'static Experiment> + 'a {
    let one = move |id: &str| asked.only.is_empty() || asked.only.iter().any(|only| only == id);
    trials
        .iter()
        .copied()
        .chain([&PEERS])
        .filter(move |experiment| one(experiment.id))
}

fn run(asked: &Asked) -> Result<bool, SandboxError> {
    let folder = Folder::open(asked.out.as_deref().unwrap_or(Path::new("trials")))?;
    let mut done = Vec::new();
    for experiment in chosen(asked, TRIALS) {
        let one = sandbox::perform(experiment)?;
        println!("{} ({:.1} s)", experiment.title, one.took.as_secs_f64());
        println!("{}", one.told());
        for drawing in &one.drawings {
            folder.write(&drawing.file, &drawing.bytes)?;
        }
        for (name, text) in one.record.files(experiment.id) {
            folder.write(&name, text.as_bytes())?;
        }
        if asked.accept && experiment.id == PEERS.id {
            let committed = committed();
            accept(&committed.expected, experiment, &one.record)?;
            let figures = Folder::open(&committed.figures)?;
            for drawing in &one.drawings {
                figures.write(&drawing.file, &drawing.bytes)?;
            }
        }
        done.push(one);
    }
    folder.write("index.html", page(&done).as_bytes())?;
    println!("open {}", folder.path().join("index.html").display());
    Ok(done.iter().all(Done::holds))
}

fn check(asked: &Asked) -> Result<bool, SandboxError> {
    let mut wrong = Vec::new();
    for experiment in chosen(asked, TRIALS_IN_SHORT) {
        let one = sandbox::perform(experiment)?;
        if experiment.id == PEERS.id {
            wrong.extend(faults(&[one], &committed(), false));
        } else {
            wrong.extend(claims(&one));
        }
    }
    for fault in &wrong {
        println!("{fault}");
    }
    println!("{} faults", wrong.len());
    Ok(wrong.is_empty())
}

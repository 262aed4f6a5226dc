//! The command `sandbox`: what was asked, which path, which exit code.

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use sandbox::{
    ATLAS, Committed, Done, EXPERIMENTS, Experiment, Folder, SandboxError, accept, claims,
    committed_folder, expected_folder, faults, find, gallery, page, perform, perform_all,
};
use std::fmt::Arguments;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, OnceLock};

/// The first error of standard output: later ones follow from it.
static BROKEN: OnceLock<std::io::Error> = OnceLock::new();

/// Write to standard output. What cannot be written does not stop the work, and decides the exit code.
fn put(text: Arguments<'_>) {
    let mut out = std::io::stdout().lock();
    if let Err(error) = out.write_fmt(text).and_then(|()| out.flush()) {
        let _ = BROKEN.set(error);
    }
}

/// Write to standard error; nobody may be there to read it.
fn tell_error(text: Arguments<'_>) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

// as the standard ones, which panic where nobody reads
macro_rules! println {
    ($($part:tt)*) => { put(format_args!("{}\n", format_args!($($part)*))) };
}
macro_rules! print {
    ($($part:tt)*) => { put(format_args!($($part)*)) };
}
macro_rules! eprintln {
    ($($part:tt)*) => { tell_error(format_args!($($part)*)) };
}

/// The report's experiments: list them, run one, or make every figure.
///
/// Exit codes: 0 all is well; 1 a claim does not hold or a number moved; 2 refused, with the reason.
#[derive(Debug, Parser)]
#[command(name = "sandbox", version, about, max_term_width = 100)]
struct Asked {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// List the experiments: id, place in the report, title
    List,
    /// Run one experiment and tell its claims and numbers
    Run {
        /// Which, as `sandbox list` names it
        #[arg(value_parser = ids(EXPERIMENTS), hide_possible_values = true)]
        id: String,
        /// Also write its drawings and tables into this folder
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Regimes over mass, damping, stiffness and step, with a page to look through
    Atlas {
        #[command(flatten)]
        place: Place,
        /// Only this one; may be given more than once
        #[arg(long, value_name = "ID", value_parser = ids(ATLAS), hide_possible_values = true)]
        only: Vec<String>,
    },
    /// Make every figure, from nothing, with an index page to look through
    Figures(Figures),
}

#[derive(Debug, Args)]
struct Place {
    /// Where drawings, tables and index.html go
    #[arg(long, value_name = "DIR", default_value = "figures")]
    out: PathBuf,
}

#[derive(Debug, Args)]
struct Figures {
    /// Only this experiment; may be given more than once
    #[arg(long, value_name = "ID", value_parser = ids(EXPERIMENTS), hide_possible_values = true)]
    only: Vec<String>,
    /// Write nothing: run everything and fail if a claim does not hold or cannot fail, a number or
    /// its tolerance is not what sandbox/expected/ says, or a drawing or the gallery would not be
    /// what is in docs/
    #[arg(long, conflicts_with_all = ["accept", "out"])]
    check: bool,
    /// Take the numbers found as those expected from now on (also: REGENERATE=1)
    #[arg(long)]
    accept: bool,
    /// Where the drawings, tables and index.html go. With docs/figures, the committed set is
    /// rewritten: drawings only, and docs/figures.md
    #[arg(long, value_name = "DIR", default_value = "figures")]
    out: PathBuf,
}

fn ids(known: &[&'static Experiment]) -> PossibleValuesParser {
    PossibleValuesParser::new(known.iter().map(|experiment| experiment.id))
}

fn main() -> ExitCode {
    let asked = match Asked::try_parse() {
        Ok(asked) => asked,
        Err(error) if error.use_stderr() => {
            // nobody may be there to read it
            let _ = error.print();
            return ExitCode::from(2);
        }
        Err(help) => {
            print!("{}", help.render());
            return ended(ExitCode::SUCCESS);
        }
    };
    let result = match asked.what {
        What::List => {
            list();
            Ok(true)
        }
        What::Run { id, out } => run(&id, out.as_deref()),
        What::Atlas { place, only } => atlas(&place, &only),
        What::Figures(asked) => figures(&asked),
    };
    ended(match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    })
}

/// The exit code, unless what was said went nowhere: a reader that left is no error, a full device is one.
fn ended(code: ExitCode) -> ExitCode {
    match BROKEN.get() {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => {
            eprintln!("error: standard output: cannot be written: {error}");
            ExitCode::from(2)
        }
        _ => code,
    }
}

fn list() {
    for experiment in EXPERIMENTS {
        println!(
            "{:<14} {:<16} {}",
            experiment.id, experiment.place, experiment.title
        );
    }
}

fn run(id: &str, out: Option<&Path>) -> Result<bool, SandboxError> {
    let folder = out.map(Folder::open).transpose()?;
    let Some(experiment) = find(id) else {
        return Ok(false);
    }; // the parser let only ids through
    let done = perform(experiment)?;
    println!(
        "{} · {}\n{}\n",
        experiment.place, experiment.title, experiment.question
    );
    println!("{}", done.told());
    println!("\n{}", done.record.numbers_csv().trim_end());
    if let Some(folder) = folder {
        write_drawings(&folder, &done)?;
        write_tables(&folder, &done)?;
        eprintln!("written into {}", folder.path().display());
    }
    Ok(done.holds())
}

/// The atlas, one experiment after the other, with its page.
fn atlas(place: &Place, only: &[String]) -> Result<bool, SandboxError> {
    let folder = Folder::open(&place.out)?;
    let asked = |id: &str| only.is_empty() || only.iter().any(|only| only == id);
    let chosen: Vec<_> = ATLAS.iter().copied().filter(|one| asked(one.id)).collect();
    let bar = ProgressBar::new(u64::try_from(chosen.len()).unwrap_or(0));
    if let Ok(style) =
        ProgressStyle::with_template("{spinner} {bar:40} {pos}/{len} {msg} {elapsed}")
    {
        bar.set_style(style);
    }
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    let mut done = Vec::new();
    for experiment in chosen {
        bar.set_message(experiment.id);
        let one = perform(experiment)?;
        bar.suspend(|| {
            println!("{} ({:.1} s)", experiment.title, one.took.as_secs_f64());
            println!("{}", one.told());
        });
        write_drawings(&folder, &one)?;
        write_tables(&folder, &one)?;
        bar.inc(1);
        done.push(one);
    }
    bar.finish_and_clear();
    folder.write("index.html", page(&done).as_bytes())?;
    println!("open {}", folder.path().join("index.html").display());
    Ok(done.iter().all(Done::holds))
}

fn figures(asked: &Figures) -> Result<bool, SandboxError> {
    let folder = if asked.check {
        None
    } else {
        Some(Folder::open(&asked.out)?)
    };
    let chosen: Vec<&'static Experiment> = EXPERIMENTS
        .iter()
        .copied()
        .filter(|one| asked.only.is_empty() || asked.only.iter().any(|id| id == one.id))
        .collect();
    let bar = ProgressBar::new(u64::try_from(chosen.len()).unwrap_or(0));
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg} {elapsed}") {
        bar.set_style(style);
    }
    bar.tick();
    let mine = folder.as_ref().is_some_and(|folder| !is_committed(folder));
    let unwritten = Mutex::new(None);
    let done = perform_all(&chosen, &|experiment, done| {
        bar.set_message(experiment.id);
        bar.inc(1);
        // each is there to be looked at as soon as it is made
        if let (Some(folder), Ok(done)) = (&folder, done) {
            let drawn = write_drawings(folder, done);
            let all = drawn.and_then(|()| {
                if mine {
                    write_tables(folder, done)
                } else {
                    Ok(())
                }
            });
            if let (Err(error), Ok(mut unwritten)) = (all, unwritten.lock()) {
                unwritten.get_or_insert(error);
            }
        }
    })?;
    bar.finish_and_clear();
    if let Ok(Some(error)) = unwritten.into_inner() {
        return Err(error);
    }

    let whole = asked.only.is_empty();
    if asked.accept || std::env::var_os("REGENERATE").is_some_and(|value| value == "1") {
        for one in &done {
            accept(&expected_folder(), one.experiment, &one.record)?;
        }
    }
    let wrong = match folder {
        Some(folder) => {
            let faults: Vec<String> = done.iter().flat_map(claims).collect();
            faults.iter().for_each(|fault| println!("{fault}"));
            write(&folder, &done, whole)?;
            faults.len()
        }
        None => check(&done, whole),
    };
    let claims: usize = done.iter().map(|one| one.findings.len()).sum();
    let verdict = match wrong {
        0 => "all hold".to_owned(),
        many => format!("not all is well: {many} faults"),
    };
    println!("{} experiments, {claims} claims: {verdict}", done.len());
    Ok(wrong == 0)
}

/// Tells and counts what is wrong with the experiments.
fn check(done: &[Done], whole: bool) -> usize {
    let faults = faults(done, &Committed::here(), whole);
    faults.iter().for_each(|fault| println!("{fault}"));
    faults.len()
}

/// What is told of all experiments together, once their drawings are there.
fn write(folder: &Folder, done: &[Done], all: bool) -> Result<(), SandboxError> {
    if is_committed(folder) {
        if all {
            let docs = Folder::open(&committed_folder().join(".."))?;
            docs.write("figures.md", gallery(done).as_bytes())?;
        }
        return Ok(());
    }
    folder.write("index.html", page(done).as_bytes())?;
    println!("open {}", folder.path().join("index.html").display());
    Ok(())
}

/// Whether a folder is the committed one, which takes drawings only.
fn is_committed(folder: &Folder) -> bool {
    let same = |a: &Path, b: &Path| a.canonicalize().ok() == b.canonicalize().ok();
    committed_folder().exists() && same(folder.path(), &committed_folder())
}

fn write_drawings(folder: &Folder, done: &Done) -> Result<(), SandboxError> {
    done.drawings
        .iter()
        .try_for_each(|drawing| folder.write(&drawing.file, &drawing.bytes))
}

fn write_tables(folder: &Folder, done: &Done) -> Result<(), SandboxError> {
    let files = done.record.files(done.experiment.id);
    files
        .iter()
        .try_for_each(|(name, text)| folder.write(name, text.as_bytes()))
}

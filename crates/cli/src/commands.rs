//! What each command does with its flags: a scene, a run, files.

use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use indicatif::{ProgressBar, ProgressStyle};
use io::{Claims, Picture, shapes};
use scene::field::Smoothing;
use scene::integrator::Scheme;
use scene::snake::{Certificate, Outcome};
use scene::{Evidence, Fields, ForceChoice, Record, Scene, SceneError, SceneText};
use serde_json::json;

use crate::args::{self, Words};
use crate::output::{Output, put};
use crate::stop::{STOPPED, Stop};

pub(crate) type Answer = Result<ExitCode, SceneError>;

pub(crate) fn run(args: &args::Run, words: Words) -> Answer {
    if crate::live::is_session(&args.scene) {
        return crate::live::replay(args, words);
    }
    let mut scene = find(&args.scene, &args.changes)?.scene()?;
    let plan = &mut scene.plan;
    if let Some(name) = &args.scheme {
        plan.scheme = name.parse::<Scheme>().map_err(|e| key("--scheme", e))?;
    }
    if args.record.is_none() {
        for (flag, given) in [
            ("--every", args.every.is_some()),
            ("--velocities", args.velocities),
            ("--energies", args.energies),
        ] {
            if given {
                return Err(key(flag, "says what a record keeps, and needs --record"));
            }
        }
    }
    if args.every == Some(0) {
        return Err(key("--every", "must be at least 1, got 0"));
    }
    match args.dt {
        Some(args::Step::Fixed(_)) if plan.each => {
            let message = "this scene has no steps to count; needed: its time in dt and steps";
            return Err(key("--dt", message));
        }
        Some(args::Step::Fixed(dt)) => plan.set_step(dt),
        Some(args::Step::Auto) => plan.choose_steps(scene.company.is_some()),
        None => {}
    }
    plan.tolerance = args.tolerance.or(plan.tolerance);
    plan.until.steps = args.steps.unwrap_or(plan.until.steps);
    plan.force |= args.force;
    plan.recording.every = args.every.or(plan.recording.every);
    plan.recording.velocities |= args.velocities;
    plan.recording.energies |= args.energies;
    if args.record.is_none() {
        // nobody will see them
        plan.recording.every = None;
        plan.recording.steps.clear();
        plan.recording.energies = false;
    }
    let output = Output {
        record: args.record.clone(),
        contour: args.out.clone(),
        overlay: args.overlay.clone(),
    };
    let flags = [
        ("run.dt", "--dt", args.dt.is_some()),
        ("run.output", "--dt", args.dt.is_some()),
        ("run.time", "--dt", args.dt.is_some()),
        ("run.steps", "--steps", args.steps.is_some()),
        ("run.tolerance", "--tolerance", args.tolerance.is_some()),
        ("run.scheme", "--scheme", args.scheme.is_some()),
        ("record.every", "--every", args.every.is_some()),
    ];
    if args.certificate {
        scene.check().map_err(|error| by_flag(error, &flags))?;
        let certificate = Certificate::of(&scene.of_the_run(), None);
        for line in certificate.to_string().lines() {
            words.say(line);
        }
    }
    go(&scene, &output, &flags, words)
}

pub(crate) fn field(args: &args::Field, words: Words) -> Answer {
    two_inputs(&args.image, args.from.as_deref())?;
    let picture = Arc::new(Picture::load(&args.image)?);
    for note in picture.notes() {
        words.say(&format!("note: {note}"));
    }
    let smoothing = match (args.sigma, args.passes) {
        (Some(sigma), _) => Smoothing::Gaussian(sigma),
        (None, Some(passes)) => Smoothing::Binomial(passes),
        (None, None) => Smoothing::Binomial(scene::field::REPORT_PASSES),
    };
    let mut kinds = choices("--kind", &args.kind)?;
    if args.all {
        kinds = Fields::every_kind();
    }
    let mut claims = Claims::default();
    claims.reads(&args.image);
    args.from.iter().for_each(|path| claims.reads(path));
    let curve = args.from.as_deref().map(shapes::load_one).transpose()?;
    let curve = curve.map(|contour| contour.first().to_vec());
    let fields = Fields {
        stages: args.all || args.kind.is_empty(),
        smoothing,
        kinds,
        curve,
    };
    for file in fields.files(&args.out) {
        if file.symlink_metadata().is_ok() {
            claims.writes("--out", &file)?;
        }
    }
    let mut text = String::new();
    let flags = [
        ("field.sigma", "--sigma", true),
        ("field.passes", "--passes", true),
        ("field.kind", "--kind", true),
        ("field.curve", "--from", true),
    ];
    let written = fields.write(&picture, &args.out);
    for file in written.map_err(|error| by_flag(error, &flags))? {
        // writing to a String cannot fail
        let _ = writeln!(text, "{}", file.display());
    }
    put(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// Kinds of force as typed behind a flag.
pub(crate) fn choices(flag: &str, typed: &[String]) -> Result<Vec<ForceChoice>, SceneError> {
    let read = |text: &String| ForceChoice::parse(text).map_err(|message| key(flag, message));
    typed.iter().map(read).collect()
}

pub(crate) fn list(args: &args::List, words: Words) -> Answer {
    let (mut text, mut after) = (String::new(), None);
    match args.what {
        args::What::Scenes => {
            for (name, _) in scene::SCENES {
                let (title, report) = scene::headline(name)?;
                let report = report.map_or_else(String::new, |r| format!(" ({r})"));
                let _ = writeln!(text, "{name:26} {title}{report}");
            }
            after = Some("snake show NAME prints the text of one");
        }
        args::What::Schemes => {
            for scheme in Scheme::ALL {
                let _ = writeln!(text, "{:18} {}", scheme.name(), scheme.summary());
            }
        }
        args::What::Forces => {
            for kind in scene::FORCES {
                let _ = writeln!(text, "{:18} {}", kind.name, kind.summary);
                let _ = writeln!(text, "{:18} energy: {}", "", kind.energy);
            }
        }
    }
    put(&text)?;
    after.into_iter().for_each(|hint| words.say(hint));
    Ok(ExitCode::SUCCESS)
}

/// Standard input can be read but once.
pub(crate) fn two_inputs(image: &Path, from: Option<&Path>) -> Result<(), SceneError> {
    let standard = Path::new("-");
    if image == standard && from == Some(standard) {
        let message = "standard input is the picture already; the contour must be a file";
        return Err(key("--from", message));
    }
    Ok(())
}

/// The text of a shipped scene by its name, of a scene file by its path, or of standard input; with
/// these changes.
fn find(path: &Path, changes: &args::Changes) -> Result<SceneText, SceneError> {
    let name = path.to_str();
    let shipped = scene::SCENES.iter().any(|(known, _)| Some(*known) == name);
    let file = path.extension().is_some() || path.components().count() > 1 || path.exists();
    let mut text = match name {
        Some(name) if name != "-" && (shipped || !file) => SceneText::named(name),
        _ => SceneText::load(path),
    }?;
    for change in &changes.set {
        text.set(&change.key, &change.value)?;
    }
    Ok(text)
}

pub(crate) fn show(args: &args::Show) -> Answer {
    let text = find(&args.scene, &args.changes)?;
    // what nothing is changed in is shown with its comments
    match args.changes.set[..] {
        [] => put(text.source())?,
        _ => put(&text.to_string())?,
    }
    Ok(ExitCode::SUCCESS)
}

/// A key of the scene, the flag that stands for it, and whether it was given.
type Flags<'a> = [(&'a str, &'a str, bool)];

/// Check, run, write, say how it ended, and turn that into a code.
fn go(scene: &Scene, output: &Output, flags: &Flags<'_>, words: Words) -> Answer {
    scene.check().map_err(|error| by_flag(error, flags))?;
    output.check(scene.picture.as_deref(), &scene.inputs, words)?;
    for note in &scene.notes {
        words.say(&format!("note: {note}"));
    }
    let stop = Stop::listen();
    let record = watched(scene, &stop, words).map_err(|error| by_flag(error, flags))?;
    output.write(scene, &record, words)?;
    let (title, outcome) = (&scene.title, record.outcome);
    let t = record.last().map_or(0.0, |last| last.t);
    match outcome {
        Outcome::Diverged { .. } => words.say(&format!("{title}: {outcome}; no contour to write")),
        _ => words.say(&format!("{title}: {outcome}, t = {t:.6}")),
    }
    for remark in &record.remarks {
        words.say(&format!("note: {remark}"));
    }
    if let Some(pace) = &record.pace {
        words.say(pace);
    }
    let short = matches!(outcome, Outcome::Finished { .. }) && scene.plan.until.rest.is_some();
    if short {
        words.say("it was to come to rest and has not: allow more steps");
    }
    let stopped = stop.asked();
    if stopped {
        words.say(STOPPED);
    }
    let objected = judge(title, &record, words);
    let good = outcome.is_good() && !short && !objected && !stopped;
    words.end(&json!({
        "title": title,
        "outcome": outcome.name(),
        "message": outcome.to_string(),
        "steps": outcome.step(),
        "time": t,
        "good": good,
        "curves": record.evidence.iter().map(told).collect::<Vec<_>>(),
        "events": record.events,
    }))?;
    Ok(code(good))
}

/// What speaks for a curve, as JSON.
pub(crate) fn told(evidence: &Evidence) -> serde_json::Value {
    json!({
        "held": evidence.held,
        "crossings": evidence.crossings,
        "area": evidence.area.map(|(_, end)| end),
        "objection": evidence.objection(),
        "note": evidence.note(),
    })
}

/// The exit code of what went well, or did not.
pub(crate) fn code(good: bool) -> ExitCode {
    if good {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(1)
    }
}

/// Say what speaks for each curve that came to rest; whether anything speaks against one.
fn judge(title: &str, record: &Record, words: Words) -> bool {
    let many = record.evidence.len() > 1;
    let mut objected = false;
    for (index, evidence) in record.evidence.iter().enumerate() {
        let which = if many {
            format!(", curve {index}")
        } else {
            String::new()
        };
        objected |= objects(&format!("{title}{which}"), evidence, words);
    }
    objected
}

/// Say what speaks for a curve of that title; whether anything speaks against it.
pub(crate) fn objects(title: &str, evidence: &Evidence, words: Words) -> bool {
    words.say(&format!("{title}: {evidence}"));
    let objection = evidence.objection();
    if let Some(reason) = &objection {
        words.say(&format!("{title}: not an outline: {reason}"));
    } else if let Some(note) = evidence.note() {
        words.say(&format!("note: {note}"));
    }
    objection.is_some()
}

/// A bar on standard error for so many steps, unless quiet was asked for.
pub(crate) fn bar(steps: u64, words: Words) -> ProgressBar {
    if words.quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} steps {eta}") {
        bar.set_style(style);
    }
    bar
}

/// Run a scene with a progress bar on standard error, when a person is there to see it.
fn watched(scene: &Scene, stop: &Stop, words: Words) -> Result<Record, SceneError> {
    let bar = bar(scene.plan.until.steps, words);
    let record = scene.run(&mut |state| {
        if state.step % 256 == 0 {
            bar.set_position(state.step);
        }
        if stop.asked() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    record
}

/// An error under the flag that was typed instead of the key that the flag stands for.
fn by_flag(error: SceneError, flags: &Flags<'_>) -> SceneError {
    let (at, message) = match &error {
        SceneError::Step(message) => ("run.dt", message),
        SceneError::Key { key, message } => (key.as_str(), message),
        _ => return error,
    };
    // a key within the one that a flag stands for is told by the flag and what follows
    let below = |known: &str| {
        at.strip_prefix(known)
            .filter(|rest| !rest.starts_with(char::is_alphanumeric))
    };
    let found = flags.iter().filter(|(_, _, given)| *given);
    match found
        .filter_map(|(known, flag, _)| Some((flag, below(known)?)))
        .next()
    {
        Some((flag, rest)) => key(&format!("{flag}{rest}"), message),
        None => error,
    }
}

pub(crate) fn key(key: &str, message: impl ToString) -> SceneError {
    SceneError::Key {
        key: key.to_owned(),
        message: message.to_string(),
    }
}

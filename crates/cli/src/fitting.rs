//! `snake fit`: flags become the options of a fit, the fit a contour, its outcome a code.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use glam::DVec2;
use io::Picture;
use io::shapes::{self, Shape};
use scene::field::Polarity;
use scene::fit::{FitError, Image, Nodes, OptionKey, Options, Prepared, Session, Step};
use scene::snake::Outcome;
use scene::{Computing, SceneError, fit};
use serde_json::json;

use crate::args::{self, Start, Words};
use crate::commands::{Answer, bar, choices, code, key, objects, told, two_inputs};
use crate::output::{Output, put};
use crate::stop::{STOPPED, Stop};

/// What a fit is called in what is said.
const TITLE: &str = "a contour fitted to a picture";

/// Steps between two looks of the progress bar.
const STEPS_A_LOOK: u64 = 16;

pub(crate) fn fit(args: &args::Fit, words: Words) -> Answer {
    let options = options(args)?;
    let (contour, file) = match &args.from {
        Start::Circle([x, y, radius]) => {
            let circle = fit::Contour::circle(DVec2::new(*x, *y), *radius);
            (Shape::curve(circle.points, Some(true)), None)
        }
        Start::Box([left, top, width, height]) => {
            let corner = DVec2::new(*left, *top);
            let rectangle = fit::Contour::rectangle(corner, corner + DVec2::new(*width, *height));
            (Shape::curve(rectangle.points, Some(true)), None)
        }
        Start::File(path) => {
            two_inputs(&args.image, Some(path))?;
            (shapes::load_one(path)?, Some(path))
        }
    };
    let picture = Arc::new(Picture::load(&args.image)?);
    let output = Output {
        record: None,
        contour: Some(args.out.clone().unwrap_or_else(|| PathBuf::from("-"))),
        overlay: args.overlay.clone(),
    };
    let inputs: Vec<PathBuf> = [Some(&args.image), file]
        .into_iter()
        .flatten()
        .cloned()
        .collect();
    output.check(Some(&picture), &inputs, words)?;
    let closed = match (args.open, args.closed) {
        (true, _) => false,
        (_, true) => true,
        _ => contour.closed.unwrap_or(true),
    };
    let start = fit::Contour {
        points: contour.first().to_vec(),
        closed,
    };
    let image = Image::of(picture.clone());
    let prepared = Prepared::of(&image, &options).map_err(|e| by_flag(&e))?;
    let session = prepared.session(&start);
    let session = session.map_err(|e| by_flag(&e))?;
    for note in picture.notes() {
        words.say(&format!("note: {note}"));
    }
    if let Some(note) = prepared.sight().note() {
        words.say(&format!("note: {note}"));
    }
    let start = fit::Contour {
        points: session.start().to_vec(),
        closed,
    };
    let stop = Stop::listen();
    let found = watched(session, args.steps, &stop, words);
    for line in found.chosen.to_string().lines() {
        words.detail(line);
    }
    if matches!(found.outcome, Outcome::Diverged { .. }) {
        words.say(&format!("{TITLE}: {}; no contour to write", found.outcome));
        return Ok(ExitCode::from(1));
    }
    let (start, end) = ([curve(start)], [curve(found.contour)]);
    let printed = output.curves(Some(&picture), &start, &end, words)?;
    put(&printed)?;
    words.say(&format!("{TITLE}: {}", found.outcome));
    let short = matches!(found.outcome, Outcome::Finished { .. });
    if short {
        words.say("it was to come to rest and has not: allow more steps");
    }
    let stopped = stop.asked();
    if stopped {
        words.say(STOPPED);
    }
    let quality = found.quality.as_ref();
    let objected = quality.is_some_and(|quality| objects(TITLE, quality, words));
    let good = found.outcome.is_good() && !short && !objected && !stopped;
    let held = found.nodes.iter().map(|node| node.strength);
    words.end(&json!({
        "title": TITLE,
        "outcome": found.outcome.name(),
        "message": found.outcome.to_string(),
        "steps": found.steps,
        "good": good,
        "nodes": found.nodes.len(),
        "least_strength": held.fold(f64::INFINITY, f64::min),
        "curves": quality.map(told).into_iter().collect::<Vec<_>>(),
        "chosen": found.chosen.to_string().lines().collect::<Vec<_>>(),
    }))?;
    Ok(code(good))
}

/// The options that flags stand for.
fn options(args: &args::Fit) -> Result<Options, SceneError> {
    let polarity = match args.polarity {
        args::Polarity::Either => Polarity::Either,
        args::Polarity::DarkToBright => Polarity::DarkToBright,
        args::Polarity::BrightToDark => Polarity::BrightToDark,
    };
    let usual = Options::default();
    let forces = choices("--force", &args.force)?;
    let forces = forces.into_iter().map(|c| c.with_polarity(polarity));
    Ok(Options {
        nodes: args.nodes.map_or(usual.nodes, Nodes::Count),
        tether: args.tether,
        tension: args.tension,
        rigidity: args.rigidity,
        damping: args.damping,
        sigma: args.sigma.unwrap_or(usual.sigma),
        strength: args.strength,
        forces: forces.map(scene::ForceChoice::for_fit).collect(),
        polarity,
        balloon: args.balloon,
        computing: match args.computed {
            args::Computed::Auto => Computing::Auto,
            args::Computed::Lazy => Computing::Lazy,
            args::Computed::Whole => Computing::Whole,
        },
        step: args.dt.map_or(usual.step, Step::Equal),
        steps: args.steps,
    })
}

/// A contour as files have it.
fn curve(contour: fit::Contour) -> Shape {
    Shape::curve(contour.points, Some(contour.closed))
}

/// Step with a progress bar on standard error, when a person is there to see it, until it ends.
fn watched(mut session: Session, steps: u64, stop: &Stop, words: Words) -> fit::Fit {
    let bar = bar(steps, words);
    while session.step(STEPS_A_LOOK).is_none() {
        if stop.asked() {
            bar.finish_and_clear();
            return session.stop();
        }
        bar.set_position(session.steps());
    }
    bar.finish_and_clear();
    session.finish()
}

/// An error under the flag that stands for its option.
fn by_flag(error: &FitError) -> SceneError {
    let flag = match error.key {
        OptionKey::Image => "picture",
        OptionKey::Start => "--from",
        OptionKey::Nodes => "--nodes",
        OptionKey::Tether => "--tether",
        OptionKey::Tension => "--tension",
        OptionKey::Rigidity => "--rigidity",
        OptionKey::Damping => "--damping",
        OptionKey::Sigma => "--sigma",
        OptionKey::Strength => "--strength",
        OptionKey::Computing => "--computed",
        OptionKey::Balloon => "--balloon",
        OptionKey::Step => "--dt",
        OptionKey::Steps => "--steps",
        OptionKey::Force(..) => {
            // it begins with the name of the kind
            let message = error.problem.to_string();
            return match message.split_once(": ") {
                Some((kind, rest)) => key(&format!("--force {kind}"), rest),
                None => key("--force", message),
            };
        }
        _ => "fit",
    };
    key(flag, &error.problem)
}

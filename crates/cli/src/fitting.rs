//! `snake fit`: flags become the options of a fit, the fit a contour, its outcome a code.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use io::Picture;
use io::shapes::{self, Shape};
use scene::field::Polarity;
use scene::fit::{FitError, Image, Nodes, OptionKey, Options, Prepared, Session, Step};
use scene::snake::Outcome;
use scene::{Computing, SceneError};

use crate::args;
use crate::commands::{Answer, bar, choices, key, objects, two_inputs};
use crate::output::{Output, put, say};

/// What a fit is called in what is said.
const TITLE: &str = "a contour fitted to a picture";

/// Steps between two looks of the progress bar.
const STEPS_A_LOOK: u64 = 256;

pub(crate) fn fit(args: &args::Fit) -> Answer {
    let options = options(args)?;
    two_inputs(&args.image, Some(&args.from))?;
    let contour = shapes::load_one(&args.from)?;
    let picture = Arc::new(Picture::load(&args.image)?);
    let output = Output {
        record: None,
        contour: Some(args.out.clone().unwrap_or_else(|| PathBuf::from("-"))),
        overlay: args.overlay.clone(),
    };
    let inputs = [args.image.clone(), args.from.clone()];
    output.check(Some(&picture), &inputs)?;
    let closed = match (args.open, args.closed) {
        (true, _) => false,
        (_, true) => true,
        _ => contour.closed.unwrap_or(true),
    };
    let start = scene::fit::Contour {
        points: contour.first().to_vec(),
        closed,
    };
    let image = Image::of(picture.clone());
    let prepared = Prepared::of(&image, &options).map_err(|e| by_flag(&e))?;
    let session = prepared.session(&start);
    let session = session.map_err(|e| by_flag(&e))?;
    for note in picture.notes() {
        say(&format!("note: {note}"));
    }
    if let Some(note) = prepared.sight().note() {
        say(&format!("note: {note}"));
    }
    let start = scene::fit::Contour {
        points: session.start().to_vec(),
        closed,
    };
    let found = watched(session, args.steps).finish();
    if matches!(found.outcome, Outcome::Diverged { .. }) {
        say(&format!("{TITLE}: {}; no contour to write", found.outcome));
        return Ok(ExitCode::from(1));
    }
    let (start, end) = ([curve(start)], [curve(found.contour)]);
    let printed = output.curves(Some(&picture), &start, &end)?;
    put(&printed)?;
    say(&format!("{TITLE}: {}", found.outcome));
    let short = matches!(found.outcome, Outcome::Finished { .. });
    if short {
        say("it was to come to rest and has not: allow more steps");
    }
    let objected = found.quality.as_ref().is_some_and(|q| objects(TITLE, q));
    Ok(if found.outcome.is_good() && !short && !objected {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(1)
    })
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
        sigma: args.sigma,
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
fn curve(contour: scene::fit::Contour) -> Shape {
    Shape::curve(contour.points, Some(contour.closed))
}

/// Step with a progress bar on standard error, when a person is there to see it, until it ends.
fn watched(mut session: Session, steps: u64) -> Session {
    let bar = bar(steps);
    while session.step(STEPS_A_LOOK).is_none() {
        bar.set_position(session.steps());
    }
    bar.finish_and_clear();
    session
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

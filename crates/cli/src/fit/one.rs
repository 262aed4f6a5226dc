//! The outlines of one picture.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use io::shapes::{Shape, Value};
use io::{Picture, PictureReading};
use scene::SceneError;
use scene::fit::{Choices, Evidence, Fit, Image, Method, Options, Prepared, Session};
use scene::snake::Outcome;
use serde_json::json;

use super::flags::Flags;
use super::options::by_flag;
use super::start::contour;
use crate::args::Words;
use crate::commands::{bar, key};
use crate::stop::Stop;

/// Steps between two looks of the progress bar.
const STEPS_A_LOOK: u64 = 16;

/// An outline that was looked for in a picture.
#[derive(Debug)]
pub(super) struct Found {
    /// Where it began, as it was moved from.
    pub(super) start: Shape,
    /// The outline, with the name of its start and what is known of it; None if there is none to write.
    pub(super) shape: Option<Shape>,
    /// How it ended; None for one of many objects.
    pub(super) fit: Option<Fit>,
    /// Why it is not sure, if it is not.
    pub(super) unsure: Option<String>,
    pub(super) measured: Measured,
}

/// What was measured of how sure an outline is.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Measured {
    /// Share of it that the picture holds.
    pub(super) held: Option<f64>,
    /// Strength of edge that four fifths of it have; None for a motion.
    pub(super) closed: Option<f64>,
    /// Mean standard error. Pixels.
    pub(super) error: Option<f64>,
}

/// The files that are read for a picture beside it.
pub(super) fn beside(flags: &Flags, stem: &str) -> Option<PathBuf> {
    let start = flags.from.as_ref().and_then(|from| from.file(stem));
    start.or_else(|| flags.seeds.as_ref().and_then(|seeds| seeds.file(stem)))
}

/// The outlines of a picture from its starts or seeds.
pub(super) fn all(
    picture: &Arc<Picture>,
    stem: &str,
    options: &Options,
    flags: &Flags,
    stop: &Stop,
    words: Words,
) -> Result<Vec<Found>, SceneError> {
    match (&flags.seeds, &flags.from) {
        (Some(seeds), _) => seeds.outlines(picture, flags, stem),
        (None, Some(from)) => outlines(
            picture,
            &from.shapes(flags, stem)?,
            options,
            flags,
            stop,
            words,
        ),
        (None, None) => Ok(Vec::new()), // refused with the flags
    }
}

/// Read a picture as the flags say.
pub(super) fn picture(path: &Path, flags: &Flags) -> Result<Picture, SceneError> {
    let reading = PictureReading {
        page: flags.page,
        channel: flags.channel.clone(),
        as_stored: flags.as_stored,
        ..PictureReading::default()
    };
    Ok(Picture::load_as(path, &reading)?)
}

/// Find the outlines from these starts, one after the other.
fn outlines(
    picture: &Arc<Picture>,
    starts: &[Shape],
    options: &Options,
    flags: &Flags,
    stop: &Stop,
    words: Words,
) -> Result<Vec<Found>, SceneError> {
    let image = Image::of(Arc::<Picture>::clone(picture));
    let prepared = Prepared::of(&image, options).map_err(|e| by_flag(&e))?;
    for note in picture.notes() {
        words.say(&format!("note: {note}"));
    }
    if options.method == Method::Motion
        && let Some(note) = prepared.sight().map_err(|e| by_flag(&e))?.note()
    {
        words.say(&format!("note: {note}"));
    }
    let mut list = Vec::new();
    for (index, start) in starts.iter().enumerate() {
        if stop.asked() {
            break;
        }
        let curve = contour(start, flags);
        let which = |error: SceneError| {
            if starts.len() > 1 {
                key(&format!("outline {}", index + 1), error)
            } else {
                error
            }
        };
        let (begun, fit) = match options.method {
            Method::Search => {
                let found = prepared.fit(&curve).map_err(|e| which(by_flag(&e)))?;
                (curve.points.clone(), found)
            }
            Method::Motion => {
                let session = prepared.session(&curve).map_err(|e| which(by_flag(&e)))?;
                (
                    session.start().to_vec(),
                    watched(session, options.steps, stop, words),
                )
            }
        };
        let begun = Shape::curve(begun, Some(curve.closed));
        list.push(told(start, begun, fit));
    }
    Ok(list)
}

/// A fit with the name of its start and what is known of it.
fn told(start: &Shape, begun: Shape, fit: Fit) -> Found {
    let unsure = doubt(&fit);
    if matches!(fit.outcome, Outcome::Diverged { .. }) {
        return Found {
            start: begun,
            shape: None,
            fit: Some(fit),
            unsure,
            measured: Measured::default(),
        };
    }
    let mut shape = Shape::curve(fit.contour.points.clone(), Some(fit.contour.closed));
    shape.id.clone_from(&start.id);
    shape.label.clone_from(&start.label);
    shape.properties.clone_from(&start.properties);
    let ending = if unsure.is_some() { "unsure" } else { "found" };
    let measured = Measured {
        held: fit.quality.as_ref().map(|quality| quality.held),
        closed: match &fit.chosen {
            Choices::Search(search) => Some(search.support.closed),
            _ => None,
        },
        error: mean_error(&fit),
    };
    noted(&mut shape, ending, measured);
    Found {
        start: begun,
        shape: Some(shape),
        fit: Some(fit),
        unsure,
        measured,
    }
}

/// Note how an outline ended and how sure it is beside it.
pub(super) fn noted(shape: &mut Shape, ending: &str, measured: Measured) {
    let mut note = |name: &str, value| shape.properties.insert(name.to_owned(), value);
    note("outcome", Value::Text(ending.to_owned()));
    for (name, value) in [
        ("held", measured.held),
        ("closed_edge", measured.closed),
        ("standard_error", measured.error),
    ] {
        if let Some(value) = value {
            note(name, Value::Number(value));
        }
    }
}

/// Why a fit is not sure, if it is not.
fn doubt(fit: &Fit) -> Option<String> {
    match fit.outcome {
        Outcome::Finished { .. } => {
            Some("it was to come to rest and has not: allow more steps".to_owned())
        }
        _ if !fit.outcome.is_good() => Some(fit.outcome.to_string()),
        _ => fit.quality.as_ref().and_then(Evidence::objection),
    }
}

/// The mean standard error of the nodes that have one. Pixels.
fn mean_error(fit: &Fit) -> Option<f64> {
    let errors: Vec<f64> = fit.nodes.iter().filter_map(|node| node.error).collect();
    (!errors.is_empty()).then(|| errors.iter().sum::<f64>() / errors.len() as f64)
}

/// One fit as JSON.
pub(super) fn json(found: &Found) -> serde_json::Value {
    let Some(fit) = &found.fit else {
        return json!({
            "good": found.unsure.is_none(),
            "unsure": found.unsure,
            "closed_edge": found.measured.closed,
        });
    };
    let quality = fit.quality.as_ref();
    let strength = fit
        .nodes
        .iter()
        .map(|node| node.strength)
        .fold(f64::INFINITY, f64::min);
    json!({
        "outcome": fit.outcome.name(),
        "message": fit.outcome.to_string(),
        "steps": fit.steps,
        "good": found.unsure.is_none(),
        "unsure": found.unsure,
        "nodes": fit.nodes.len(),
        "least_strength": strength.is_finite().then_some(strength),
        "standard_error": mean_error(fit),
        "held": quality.map(|quality| quality.held),
        "crossings": quality.map(|quality| quality.crossings),
        "area": quality.and_then(|quality| quality.area).map(|(_, end)| end.abs()),
        "chosen": fit.chosen.to_string().lines().collect::<Vec<_>>(),
    })
}

/// Step with a progress bar on standard error, when a person is there to see it, until it ends.
fn watched(mut session: Session, steps: u64, stop: &Stop, words: Words) -> Fit {
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

//! The outlines of one picture.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use io::shapes::{Shape, Value};
use io::{Picture, PictureReading};
use scene::SceneError;
use scene::fit::{
    Choices, Contour, Evidence, Fit, Image, Method, OptionKey, Options, Pluck, Plucked, Prepared,
    Session,
};
use scene::snake::Outcome;

use super::beside::in_contact;
use super::film::Moments;
use super::flags::Flags;
use super::options::by_flag;
use super::results;
use super::start::{Start, contour, stem};
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
    /// What came back when it was plucked, if it was.
    pub(super) plucked: Option<Plucked>,
    /// How it moved, if that was watched.
    pub(super) moments: Option<Moments>,
}

impl Found {
    /// It is unsure, and why.
    pub(super) fn doubtful(&mut self, why: &str) {
        self.unsure = Some(why.to_owned());
        if let Some(shape) = &mut self.shape {
            noted(shape, "unsure", self.measured);
        }
    }
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

/// The outlines of a picture from its starts or seeds; `say` is told what people should know of the starts.
pub(super) fn all(
    picture: &Arc<Picture>,
    name: &Path,
    options: &Options,
    flags: &Flags,
    stop: &Stop,
    words: Words,
    say: &mut dyn FnMut(&str),
) -> Result<Vec<Found>, SceneError> {
    let stem = &stem(name);
    let image = Image::of(Arc::<Picture>::clone(picture));
    let ready = || Prepared::of(&image, options).map_err(|e| by_flag(&e));
    let (prepared, mut found) = match (&flags.seeds, &flags.from) {
        (Some(seeds), _) => (None, seeds.outlines(picture, flags, stem)?),
        (None, Some(from)) => {
            let (starts, notes) = from.shapes(flags, stem)?;
            let image = expected(&image, from, options.method, flags, stem, words)?;
            let prepared = Prepared::of(&image, options).map_err(|e| by_flag(&e))?;
            results::check_count(flags, starts.len())?;
            notes.iter().for_each(|note| say(note));
            for note in picture.notes() {
                words.say(&format!("note: {note}"));
            }
            let mut found = outlines(&prepared, &starts, flags, stop, words)?;
            if options.method == Method::Search && found.len() > 1 {
                in_contact(&mut found);
            }
            (Some(prepared), found)
        }
        (None, None) => (None, Vec::new()), // refused with the flags
    };
    if let Some(kick) = flags.pluck {
        let prepared = prepared.map_or_else(ready, Ok)?;
        pluck(&prepared, kick, &mut found, words)?;
    }
    Ok(found)
}

/// The image with what a network says of its pixels, where the start is its soft output.
fn expected(
    image: &Image,
    from: &Start,
    method: Method,
    flags: &Flags,
    stem: &str,
    words: Words,
) -> Result<Image, SceneError> {
    if method != Method::Search {
        return Ok(image.clone());
    }
    let Some(soft) = from.probabilities(flags, stem)? else {
        return Ok(image.clone());
    };
    words.say("note: --from: the outline is searched by these probabilities too");
    let image = image.clone().with_prior(&soft);
    image.map_err(|error| key("--from", error))
}

/// Read a picture, or that page of it, as the flags say.
pub(super) fn picture(
    path: &Path,
    page: Option<usize>,
    flags: &Flags,
) -> Result<Picture, SceneError> {
    let reading = PictureReading {
        page,
        channel: flags.channel.clone(),
        as_stored: flags.as_stored,
        ..PictureReading::default()
    };
    Ok(Picture::load_as(path, &reading)?)
}

/// Pluck the outlines that were found.
fn pluck(
    prepared: &Prepared,
    kick: f64,
    found: &mut [Found],
    words: Words,
) -> Result<(), SceneError> {
    for (index, one) in found.iter_mut().enumerate() {
        let Some(shape) = &mut one.shape else {
            continue;
        };
        let outline = Contour {
            points: shape.first().to_vec(),
            closed: shape.closed == Some(true),
        };
        match prepared.pluck(&outline, &Pluck { kick }) {
            Ok(plucked) => {
                let firm = Value::Number(plucked.firm());
                shape.properties.insert("firm".to_owned(), firm);
                one.plucked = Some(plucked);
            }
            Err(error) if error.key == OptionKey::Kick => return Err(by_flag(&error)),
            // what cannot be plucked is an outline all the same
            Err(error) => words.say(&format!("outline {} is not plucked: {error}", index + 1)),
        }
    }
    Ok(())
}

/// Find the outlines from these starts, one after the other.
fn outlines(
    prepared: &Prepared,
    starts: &[Shape],
    flags: &Flags,
    stop: &Stop,
    words: Words,
) -> Result<Vec<Found>, SceneError> {
    let options = prepared.options();
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
        let mut moments = None;
        let (begun, fit) = match options.method {
            Method::Search => {
                let found = prepared.fit_unless(&curve, &|| stop.asked());
                let Some(found) = found.map_err(|e| which(by_flag(&e)))? else {
                    break;
                };
                (curve.points.clone(), found)
            }
            Method::Motion => {
                let session = prepared.session(&curve).map_err(|e| which(by_flag(&e)))?;
                moments = flags.is_watched().then(Moments::new);
                let begun = session.start().to_vec();
                let found = watched(session, options.steps, &mut moments, stop, words);
                (begun, found)
            }
        };
        let begun = Shape::curve(begun, Some(curve.closed));
        list.push(Found {
            moments,
            ..told(start, begun, fit)
        });
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
            plucked: None,
            moments: None,
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
        plucked: None,
        moments: None,
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
pub(super) fn mean_error(fit: &Fit) -> Option<f64> {
    let errors: Vec<f64> = fit.nodes.iter().filter_map(|node| node.error).collect();
    (!errors.is_empty()).then(|| errors.iter().sum::<f64>() / errors.len() as f64)
}

/// Step with a progress bar on standard error, when a person is there to see it, until it ends.
fn watched(
    mut session: Session,
    steps: u64,
    moments: &mut Option<Moments>,
    stop: &Stop,
    words: Words,
) -> Fit {
    let bar = bar(steps, words);
    let a_look = if moments.is_some() { 1 } else { STEPS_A_LOOK };
    loop {
        if let Some(moments) = moments {
            moments.see(&session, false);
        }
        let ended = session.step(a_look).is_some();
        if ended || stop.asked() {
            break;
        }
        bar.set_position(session.steps());
    }
    if let Some(moments) = moments {
        moments.see(&session, true);
    }
    bar.finish_and_clear();
    session.stop()
}

//! From the text of a scene to the scene: what the words mean, and every refusal by its key.

mod body;
mod company;
mod drawn;
mod ends;
mod files;
pub(crate) mod force;
mod hand;
mod map;
pub(crate) mod number;
mod plan;
mod shape;
mod world;

use std::path::Path;
use std::sync::Arc;

use glam::DVec2;
use io::{Invalid, Picture};
use snake::{Snake, SnakeError, Turning};

use files::Files;
pub(crate) use files::{Held, names};
use force::Sight;

pub(crate) use hand::force_now;
pub(crate) use plan::USUAL_TOLERANCE;
pub(crate) use world::{outside, smoothing};

use crate::file::{InvalidText, PictureText, Rule, RulesText, SceneText, UpDown, ViewText};
use crate::hand::Hand;
use crate::scene::{Scene, View};
use crate::{SceneError, catalogue};

/// Whose rules each part follows, after `all` has been filled in.
#[derive(Debug, Clone, Copy)]
struct Rules {
    frame: Rule,
    ends: Rule,
    field: Rule,
    sampling: Rule,
    spline: Rule,
    spacing: Rule,
    start: Rule,
    border: Rule,
    clock: Rule,
    scheme: Rule,
}

impl Rules {
    fn of(text: &RulesText) -> Self {
        let (all, each) = match text {
            RulesText::All(rule) => (*rule, Box::default()),
            RulesText::Each(each) => (each.all.unwrap_or(Rule::Corrected), each.clone()),
        };
        Self {
            frame: each.frame.unwrap_or(all),
            ends: each.ends.unwrap_or(all),
            field: each.field.unwrap_or(all),
            sampling: each.sampling.unwrap_or(all),
            spline: each.spline.unwrap_or(all),
            spacing: each.spacing.unwrap_or(all),
            start: each.start.unwrap_or(all),
            border: each.border.unwrap_or(all),
            clock: each.clock.unwrap_or(all),
            scheme: all,
        }
    }
}

/// The version of the format that this program reads.
const VERSION: u64 = 1;

/// Build the scene of `text`; files it names are those held in memory, and others are looked for in `folder`.
///
/// Everything that costs nothing is checked before the picture is turned into a field.
pub(crate) fn build(
    name: &str,
    text: &SceneText,
    folder: &Path,
    held: &Held,
) -> Result<Scene, SceneError> {
    if text.version.is_some_and(|version| version != VERSION) {
        let message = format!(
            "this program reads {VERSION}, got {}",
            text.version.unwrap_or(0)
        );
        return Err(SceneError::key("version", message));
    }
    let rules = Rules::of(&text.rules);
    let files = &Files::of(folder, held);
    let plan = plan::plan(text, rules)?;
    let view = view(&text.view)?;
    let mut body = body::body(text, rules, files)?;
    let start = body::start(text, &body, rules, files)?;
    let picture = text
        .picture
        .as_ref()
        .map(|p| picture(p, files))
        .transpose()?
        .map(Arc::new);
    if let Some(picture) = &picture {
        world::inside(&start, picture, rules)?;
    }
    body.maps = map::maps(text, picture.as_deref(), files)?;
    let mut notes = Vec::new();
    notes.extend(picture.iter().flat_map(|p| p.notes().to_vec()));
    let sight = picture.as_ref().map(Sight::of).transpose()?;
    notes.extend(sight.as_ref().and_then(Sight::note));
    let closed = body.topology.is_closed();
    let (world, field) = world::world(text, rules, sight.as_ref(), &start.x, closed)?;
    let (mut grips, world) = hand::own(text, world, &body, &start)?;
    let mut snake = Snake::new(body, world).map_err(|e| refused("snake", &e))?;
    ends::slide(text, &mut snake, &start, picture.as_deref())?;
    body::damp(text, &mut snake, &start)?;
    let tips = ends::tips(text, &snake, picture.as_deref())?;
    let terms = body::terms(text)?;
    if terms.is_some() {
        Turning::new(&snake).map_err(|e| SceneError::key("snake.frame", e))?;
    }
    let company = company::company(text, rules, sight.as_ref(), &snake, files)?;
    let others = company.as_ref().map_or(&[][..], |company| &company.others);
    grips.extend(hand::others(text, others)?);
    drop(sight);
    Ok(Scene {
        name: name.to_owned(),
        title: text.title.clone(),
        report: text.report.clone(),
        note: text.note.clone(),
        view,
        picture,
        field,
        snake,
        terms,
        tips,
        hand: Hand::of(grips),
        company,
        start,
        plan,
        resolves: None,
        notes,
        inputs: files::named(text, folder),
    })
}

fn picture(text: &PictureText, files: &Files<'_>) -> Result<Picture, SceneError> {
    let invalid = match text.invalid {
        Some(InvalidText::Mask) => Invalid::Mask,
        Some(InvalidText::Refuse) | None => Invalid::Refuse,
    };
    let picture = match (&text.file, &text.shipped, &text.drawn) {
        (Some(file), None, None) => files.picture_with(file, invalid).map_err(|error| {
            let message = error.to_string();
            if message.ends_with("must be finite numbers") {
                let hint = "; invalid = \"mask\" leaves others out";
                return SceneError::key("picture", message + hint);
            }
            error.into()
        }),
        (None, Some(name), None) => catalogue::picture(name),
        (None, None, Some(drawn)) => drawn::picture(drawn),
        (None, None, None) => Err(SceneError::key(
            "picture",
            "is not given; needed: one of the keys file, shipped and drawn",
        )),
        _ => Err(SceneError::key(
            "picture",
            "is given more than once; needed: one of the keys file, shipped and drawn",
        )),
    }?;
    match &text.mask {
        None => Ok(picture),
        Some(file) => {
            let mask = files.picture(file)?;
            let masked = picture.with_mask(&mask);
            masked.map_err(|message| SceneError::key("picture.mask", message))
        }
    }
}

fn view(text: &ViewText) -> Result<View, SceneError> {
    let window = match text.window {
        None => None,
        Some([x0, y0, x1, y1]) => {
            let low = number::place("view.window", [x0, y0])?;
            let high = number::place("view.window", [x1, y1])?;
            if low.cmpge(high).any() {
                let message = format!(
                    "needed: [x0, y0, x1, y1] with x0 < x1 and y0 < y1, got [{x0}, {y0}, {x1}, {y1}]"
                );
                return Err(SceneError::key("view.window", message));
            }
            Some((low, high))
        }
    };
    let y_up = text.y == Some(UpDown::Up);
    Ok(View { y_up, window })
}

/// An error of the body or the world, under the key it belongs to; `otherwise` if it has none.
fn refused(otherwise: &str, error: &SnakeError) -> SceneError {
    let key = match error {
        SnakeError::NoMass => "densities.mass",
        SnakeError::NoNormal { .. } => "world.wall",
        SnakeError::Elastic(elastic::ElasticError::TooFewNodes { .. }) => "snake.nodes",
        SnakeError::Elastic(elastic::ElasticError::TooStiff { .. }) => "material",
        SnakeError::Elastic(
            elastic::ElasticError::BadOrder { .. } | elastic::ElasticError::BadPower { .. },
        ) => "material.higher",
        SnakeError::Elastic(elastic::ElasticError::BadParameter { name, .. })
        | SnakeError::Elastic(elastic::ElasticError::WrongLength { name, .. })
        | SnakeError::BadNumber { name, .. } => match *name {
            "mass" => "densities.mass",
            "damping" => "densities.damping",
            "tether" => "material.tether",
            "tension" => "material.tension",
            "rigidity" => "material.rigidity",
            name if name.starts_with("the weight of order") => "material.higher",
            "gravity" => "world.gravity",
            "weight" => "field.weight",
            _ => otherwise,
        },
        _ => otherwise,
    };
    SceneError::key(key, error)
}

fn points(list: &[[f64; 2]]) -> Vec<DVec2> {
    list.iter().map(|&p| DVec2::from_array(p)).collect()
}

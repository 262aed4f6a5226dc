//! `[[force]]`: the forces of a world by their kind, in units a person can set.
//!
//! Every kind that looks at a picture has a `strength`. Strength 1 is the pull, at its strongest, of a straight edge
//! of 120 grey levels under the report's rules; here it is that of an edge as high as the picture's own contrast, so
//! that exposure does not matter, and at any smoothing.

mod curve;
mod kind;
mod sight;

use std::collections::{BTreeMap, BTreeSet};

use elastic::Profile;
use fit::force::Sight as Seen;
use glam::DVec2;
use snake::{Acting, Energies, Gravity, Pressure, Simulation, Turned, World};

use super::body::{profile, straight};
use super::number;
use crate::SceneError;
use crate::file::{EdgeText, ForceText, KindText, PolarityText};
pub(crate) use sight::Sight;

/// Whether a kind compares what is inside with what is outside.
pub(crate) const fn is_region(kind: &KindText) -> bool {
    matches!(
        kind,
        KindText::Regions(_)
            | KindText::LocalRegions(_)
            | KindText::Likelihood(_)
            | KindText::Texture(_)
    )
}

/// The curve that a force is to act on, and what there is to see.
pub(crate) struct Around<'a> {
    key: &'a str,
    sight: Option<&'a Seen>,
    nodes: &'a [DVec2],
    closed: bool,
}

impl<'a> Around<'a> {
    /// The picture, or a refusal where there is none.
    fn seen(&self) -> Result<&'a Seen, SceneError> {
        self.sight.ok_or_else(|| {
            let message = "looks at a picture, and there is none";
            SceneError::key(&format!("{}: kind", self.key), message)
        })
    }

    /// The force of a kind: one, or one a scale of a schedule.
    fn forces(&self, kind: &KindText) -> Result<Vec<Acting>, SceneError> {
        if asks_inside(kind) {
            self.closed(kind.word())?;
        }
        Ok(vec![match kind {
            KindText::Pressure(text) => Acting::new(self.pressure(text)?),
            KindText::Gas(text) => {
                let (k, area) = self.volume(text)?;
                Acting::new(Pressure::gas(k, area))
            }
            KindText::Area(text) => {
                let (k, area) = self.volume(text)?;
                Acting::new(Pressure::area(k, area))
            }
            KindText::Spring(text) => Acting::new(self.spring(text)?),
            KindText::Repulsor(text) => Acting::new(self.repulsor(text)?),
            KindText::Freeze(text) => Acting::new(self.freeze(text)?),
            KindText::Gravity(text) => {
                let key = format!("{}: acceleration", self.key);
                Acting::new(Gravity(number::place(&key, text.acceleration)?))
            }
            _ => return sight::forces(self.seen()?, self.key, kind),
        }])
    }
}

/// Whether edges of both polarities pull: then it is a field whatever the curve.
fn either(text: &EdgeText) -> bool {
    matches!(text.polarity, None | Some(PolarityText::Either))
}

/// Whether a kind asks what is inside the curve.
const fn asks_inside(kind: &KindText) -> bool {
    matches!(
        kind,
        KindText::Regions(_)
            | KindText::LocalRegions(_)
            | KindText::Likelihood(_)
            | KindText::Texture(_)
            | KindText::Pressure(_)
            | KindText::Gas(_)
            | KindText::Area(_)
    )
}

/// The force of a `[[force]]`, or of one chosen for a fit, with its weight and schedule; one for each scale of a
/// schedule of scales.
fn acting(around: &Around<'_>, text: &ForceText) -> Result<Vec<Acting>, SceneError> {
    let (key, n) = (around.key, around.nodes.len());
    if let KindText::CoarseToFine(scales) = &text.kind
        && text.common.schedule.is_some()
    {
        let hold = scales
            .hold
            .map_or_else(String::new, |hold| format!(" ({hold} here)"));
        let message = format!("coarse-to-fine has one of its own; needed: its hold{hold}");
        return Err(SceneError::key(&format!("{key}: schedule"), message));
    }
    let mut list = around.forces(&text.kind)?;
    if let Some(rate) = text.common.spin {
        if matches!(text.kind, KindText::CoarseToFine(_)) {
            let message = "coarse-to-fine does not spin; needed: edge";
            return Err(SceneError::key(&format!("{key}: spin"), message));
        }
        let rate = number::coordinate(&format!("{key}: spin"), rate)?;
        let about = match (text.common.about, around.sight) {
            (Some(about), _) => number::place(&format!("{key}: about"), about)?,
            (None, Some(sight)) => middle(sight.image().size()),
            (None, None) => {
                let message =
                    "is missing, and there is no picture to spin about its middle; needed: a place";
                return Err(SceneError::key(&format!("{key}: about"), message));
            }
        };
        for acting in &mut list {
            *acting = Acting::new(Turned::new(acting.force().boxed(), about, rate));
        }
    } else if text.common.about.is_some() {
        let message = "is of a force that spins; needed: spin with it";
        return Err(SceneError::key(&format!("{key}: about"), message));
    }
    let weight = match &text.common.weight {
        Some(weight) => profile(&format!("{key}: weight"), weight, n)?,
        None => Profile::Uniform(1.0),
    };
    weight
        .validate("weight", n, elastic::Bound::AtLeast(0.0))
        .map_err(|e| SceneError::key(&format!("{key}: weight"), e))?;
    let schedule = match &text.common.schedule {
        Some(list) => Some(straight(
            &format!("{key}: schedule"),
            "time",
            "factor",
            list,
        )?),
        None => None,
    };
    let finish = |acting: Acting| {
        let acting = acting.weighted(weight.clone());
        match &schedule {
            Some(schedule) => acting.scheduled(schedule.clone()),
            None => acting,
        }
    };
    Ok(list.into_iter().map(finish).collect())
}

/// The middle of a picture.
fn middle((width, height): (usize, usize)) -> DVec2 {
    0.5 * DVec2::new((width - 1) as f64, (height - 1) as f64)
}

/// Whether a kind is a force field that the picture has, whatever the curve.
pub(crate) fn is_field(kind: &KindText) -> bool {
    match kind {
        KindText::Edge(text) => either(text),
        KindText::ColorEdge(_)
        | KindText::Scales(_)
        | KindText::Line(_)
        | KindText::Termination(_)
        | KindText::Distance(_)
        | KindText::Gvf(_)
        | KindText::Vfc(_) => true,
        _ => false,
    }
}

/// Whether a kind pulls by what it sees in the picture.
pub(crate) fn looks(kind: &KindText) -> bool {
    is_field(kind)
        || matches!(
            kind,
            KindText::Edge(_)
                | KindText::CoarseToFine(_)
                | KindText::Regions(_)
                | KindText::LocalRegions(_)
                | KindText::Likelihood(_)
                | KindText::Texture(_)
        )
}

/// Whether one of these forces keeps something of the curve it was made for.
pub(crate) fn remembers(list: &[ForceText]) -> bool {
    list.iter().any(|force| {
        matches!(
            force.kind,
            KindText::Gas(_) | KindText::Area(_) | KindText::Spring(_) | KindText::Freeze(_)
        )
    })
}

/// Whether one of these forces knows where the curve it was made for lies.
pub(crate) fn knows_places(list: &[ForceText]) -> bool {
    let knows = |force: &ForceText| matches!(force.kind, KindText::Spring(_) | KindText::Freeze(_));
    list.iter().any(knows)
}

/// Move the places of springs, which go with their curve. A stretch is frozen where its nodes are, and all else is a
/// part of the world.
pub(crate) fn shift(list: &mut [ForceText], by: DVec2) {
    for force in list {
        if let KindText::Spring(spring) = &mut force.kind {
            for place in [&mut spring.from, &mut spring.to].into_iter().flatten() {
                *place = [place[0] + by.x, place[1] + by.y];
            }
            for [_, x, y] in spring.path.iter_mut().flatten() {
                (*x, *y) = (*x + by.x, *y + by.y);
            }
        }
    }
}

/// Add the forces of a list to a world, each under a name of its own.
pub(crate) fn add(
    mut world: World,
    keyed: &[(String, ForceText)],
    sight: Option<&Sight<'_>>,
    nodes: &[DVec2],
    closed: bool,
) -> Result<World, SceneError> {
    if let Some(sight) = sight {
        sight.foresee(keyed)?;
    }
    let mut taken = columns();
    taken.extend(world.names().map(str::to_owned));
    for (key, text) in keyed {
        if let Some(name) = &text.common.name {
            check_name(&format!("{key}: name"), name, &taken)?;
            taken.insert(name.clone());
        }
    }
    // up to which number the names of a word are taken
    let mut last = BTreeMap::new();
    for (key, text) in keyed {
        let around = Around {
            key,
            sight: sight.map(Sight::seen),
            nodes,
            closed,
        };
        let list = acting(&around, text)?;
        for (i, acting) in list.into_iter().enumerate() {
            let name = match &text.common.name {
                Some(name) if i == 0 => name.clone(),
                Some(name) => free(name, &taken, &mut last),
                None => free(text.kind.word(), &taken, &mut last),
            };
            taken.insert(name.clone());
            world = world.with_acting(acting.named(&name));
        }
    }
    Ok(world)
}

/// The forces of one text on a curve of these nodes, for a fit of a picture seen like this.
pub(crate) fn made(
    text: &ForceText,
    seen: &Seen,
    nodes: &[DVec2],
    closed: bool,
) -> Result<Vec<Acting>, SceneError> {
    let key = text.kind.word();
    if let Some(kind) = kind::of_picture(key, &text.kind)? {
        let foreseen = seen.foresee([&kind]);
        foreseen.map_err(|(_, problem)| SceneError::key(&format!("{key}: kind"), problem))?;
    }
    let around = Around {
        key,
        sight: Some(seen),
        nodes,
        closed,
    };
    acting(&around, text)
}

/// Columns and keys of a record that no force may be called: what [`Energies`] calls its terms, of a snake or a crowd,
/// and what else stands in a line.
fn columns() -> BTreeSet<String> {
    let terms = Energies::names_with(true, Simulation::FORCES.into_iter());
    let rest = crate::record::COLUMNS.into_iter().map(str::to_owned);
    terms.into_iter().chain(rest).collect()
}

fn check_name(key: &str, name: &str, taken: &BTreeSet<String>) -> Result<(), SceneError> {
    let fine = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    if name.is_empty() || name.len() > 40 || !name.chars().all(fine) {
        let message = format!(
            "must be up to 40 letters, digits, - and _, got \"{}\"",
            crate::error::clip(name)
        );
        return Err(SceneError::key(key, message));
    }
    if taken.contains(name) {
        let message = format!("\"{name}\" is taken; another name is needed");
        return Err(SceneError::key(key, message));
    }
    Ok(())
}

/// `word`, or `word-2` and so on where that is taken; `last` is where the search for each word goes on.
fn free(word: &str, taken: &BTreeSet<String>, last: &mut BTreeMap<String, usize>) -> String {
    if !taken.contains(word) {
        return word.to_owned();
    }
    let i = last.entry(word.to_owned()).or_insert(1);
    loop {
        *i += 1;
        let name = format!("{word}-{i}");
        if !taken.contains(&name) {
            return name;
        }
    }
}

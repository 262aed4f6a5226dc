//! `[[force]]`: the forces of a world by their kind, in units a person can set.
//!
//! Every kind that looks at a picture has a `strength`. Strength 1 is the pull, at its strongest, of a straight edge
//! of 120 grey levels under the report's rules; here it is that of an edge as high as the picture's own contrast, so
//! that exposure does not matter, and at any smoothing.

mod reach;
mod strength;

use std::collections::BTreeSet;
use std::sync::Arc;

use elastic::Profile;
use field::{FieldError, ForceField, Grid, MaskedImage, Smoothing};
use snake::{Acting, Gravity, ImageForce, Sampling, World};

use super::body::{profile, straight};
use super::{number, smoothing};
use crate::file::{ForceText, KindText};
use crate::{Picture, SceneError};

/// Force of strength 1: a gain of 6 on 120 levels, smoothed with σ² = 10, at its strongest, one σ from the
/// edge, where the normal density is 0.242. M L T⁻².
pub(crate) const PULL: f64 = 6.0 * 120.0 / 10.0 * NORMAL_AT_1;

/// e^(−½)/√(2π) and 1/√(2π): the normal density at one σ and at none.
const NORMAL_AT_1: f64 = 0.241_970_724_519_143_37;
const NORMAL_AT_0: f64 = 0.398_942_280_401_432_7;

/// A force field with what it is the gradient of.
pub(crate) struct Made {
    pub field: ForceField,
    /// The energy of a point of the curve, per unit of its length, at pixel centers; None if there is none.
    pub energy: Option<Grid>,
}

/// A picture as the kinds of force look at it.
pub(crate) struct Sight<'a> {
    pub picture: &'a Picture,
    grey: MaskedImage,
    contrast: f64,
}

impl<'a> Sight<'a> {
    pub(crate) fn of(picture: &'a Picture) -> Result<Self, SceneError> {
        let refuse = |e: FieldError| SceneError::key("picture", e);
        Ok(Self {
            picture,
            grey: picture.masked(&picture.levels).map_err(refuse)?,
            contrast: picture.contrast(&picture.levels),
        })
    }

    /// Spread of the levels that count, for a gain: a constant exerts no force whatever its gain.
    pub(crate) fn contrast(&self) -> f64 {
        above_nothing(self.contrast)
    }

    /// What to say of a picture without any contrast.
    pub(crate) fn note(&self) -> Option<String> {
        let picture = self.picture;
        if self.contrast > 0.0 {
            None
        } else if picture.channels().iter().any(|c| picture.contrast(c) > 0.0) {
            Some(
                "the picture has one grey everywhere: only forces in color see anything".to_owned(),
            )
        } else {
            Some("the picture is the same everywhere: it exerts no force".to_owned())
        }
    }

    /// The field of a kind; None for a kind that is none: it asks for the curve, or for no picture.
    pub(crate) fn field(&self, key: &str, kind: &KindText) -> Result<Option<Made>, SceneError> {
        let at = At { key, sight: self };
        let made = match kind {
            KindText::Edge(text) => at.edge(text),
            KindText::ColorEdge(text) => at.color_edge(text),
            KindText::Scales(text) => at.scales(text),
            KindText::Line(text) => at.line(text),
            KindText::Termination(text) => at.termination(text),
            KindText::Distance(text) => at.distance(text),
            KindText::Gvf(text) => at.gvf(text),
            KindText::Vfc(text) => at.vfc(text),
            KindText::Gravity(_) => return Ok(None),
        };
        made.map(Some)
    }
}

fn above_nothing(contrast: f64) -> f64 {
    if contrast > 0.0 { contrast } else { 1.0 }
}

/// A picture, and the key under which a force that looks at it was asked for.
struct At<'a> {
    key: &'a str,
    sight: &'a Sight<'a>,
}

impl At<'_> {
    fn key(&self, name: &str) -> String {
        format!("{}: {name}", self.key)
    }

    fn refuse(&self) -> impl Fn(FieldError) -> SceneError {
        let key = self.key.to_owned();
        move |error| SceneError::key(&key, error)
    }

    fn above_zero(&self, name: &str, given: Option<f64>, usual: f64) -> Result<f64, SceneError> {
        number::above_zero(&self.key(name), given.unwrap_or(usual))
    }

    /// Force at the strongest.
    fn pull(&self, strength: Option<f64>) -> Result<f64, SceneError> {
        Ok(PULL * self.above_zero("strength", strength, 1.0)?)
    }

    /// σ, checked against the size of the picture.
    fn sigma(&self, given: Option<f64>, usual: f64) -> Result<f64, SceneError> {
        let sigma = given.unwrap_or(usual);
        smoothing(
            &self.key("sigma"),
            Smoothing::Gaussian(sigma),
            self.sight.picture,
        )?;
        Ok(sigma)
    }

    /// The grey picture smoothed, over what counts.
    fn smoothed(&self, sigma: f64) -> Result<Grid, SceneError> {
        let grey = &self.sight.grey;
        grey.smoothed(Smoothing::Gaussian(sigma))
            .map_err(self.refuse())
    }

    /// `gain · ∇P` where pixels count, and its energy `−gain · P`.
    fn climbing(&self, strength: &Grid, gain: f64) -> Result<Made, SceneError> {
        let field = self.sight.grey.force(strength, gain);
        Ok(Made {
            field: field.map_err(self.refuse())?,
            energy: Some(strength.mapv(|p| -gain * p)),
        })
    }
}

/// The forces of a `[[force]]`, or of a `--force`: named, with their weight and schedule.
pub(crate) fn acting(
    key: &str,
    text: &ForceText,
    sight: Option<&Sight<'_>>,
    n: usize,
) -> Result<Vec<Acting>, SceneError> {
    let sees = || {
        sight.ok_or_else(|| {
            let message = format!("{} looks at a picture, and there is none", text.kind.word());
            SceneError::key(&format!("{key}: kind"), message)
        })
    };
    let forces = match &text.kind {
        KindText::Gravity(g) => {
            let key = format!("{key}: acceleration");
            vec![Acting::new(Gravity(number::place(&key, g.acceleration)?))]
        }
        kind => {
            let made = sees()?.field(key, kind)?;
            let field = made.map(|made| ImageForce::new(Arc::new(made.field), Sampling::Bilinear));
            field.into_iter().map(Acting::new).collect()
        }
    };
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
    let dressed = |mut acting: Acting| {
        acting = acting.weighted(weight.clone());
        match &schedule {
            Some(schedule) => acting.scheduled(schedule.clone()),
            None => acting,
        }
    };
    Ok(forces.into_iter().map(dressed).collect())
}

/// Whether a kind is a force field that the picture has, whatever the curve.
pub(crate) const fn is_field(kind: &KindText) -> bool {
    !matches!(kind, KindText::Gravity(_))
}

/// Whether a kind looks at the picture.
pub(crate) const fn looks(kind: &KindText) -> bool {
    !matches!(kind, KindText::Gravity(_))
}

/// Add the forces of a list to a world, each under a name of its own.
pub(crate) fn add(
    mut world: World,
    keyed: &[(String, ForceText)],
    sight: Option<&Sight<'_>>,
    n: usize,
) -> Result<World, SceneError> {
    let mut taken: BTreeSet<String> = TAKEN.into_iter().map(str::to_owned).collect();
    taken.extend(world.names().map(str::to_owned));
    for (key, text) in keyed {
        if let Some(name) = &text.common.name {
            check_name(&format!("{key}: name"), name, &taken)?;
            taken.insert(name.clone());
        }
    }
    for (key, text) in keyed {
        for (i, acting) in acting(key, text, sight, n)?.into_iter().enumerate() {
            let name = match &text.common.name {
                Some(name) if i == 0 => name.clone(),
                Some(name) => free(name, &taken),
                None => free(text.kind.word(), &taken),
            };
            taken.insert(name.clone());
            world = world.with_acting(acting.named(&name));
        }
    }
    Ok(world)
}

/// Columns of a record that no force may be called.
const TAKEN: [&str; 20] = [
    "kinetic",
    "tether",
    "tension",
    "rigidity",
    "wall",
    "damping",
    "contact",
    "parameters",
    "total",
    "step",
    "t",
    "node",
    "x",
    "y",
    "vx",
    "vy",
    "image",
    "energy",
    "v",
    "outcome",
];

fn check_name(key: &str, name: &str, taken: &BTreeSet<String>) -> Result<(), SceneError> {
    let fine = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    if name.is_empty() || name.len() > 40 || !name.chars().all(fine) {
        let message = format!(
            "up to 40 letters, digits, - and _ would do, got \"{}\"",
            crate::error::clip(name)
        );
        return Err(SceneError::key(key, message));
    }
    if taken.contains(name) {
        let message = format!("\"{name}\" is taken; another would do");
        return Err(SceneError::key(key, message));
    }
    Ok(())
}

/// `word`, or `word-2` and so on where that is taken.
fn free(word: &str, taken: &BTreeSet<String>) -> String {
    let mut name = word.to_owned();
    let mut i = 2;
    while taken.contains(&name) {
        name = format!("{word}-{i}");
        i += 1;
    }
    name
}

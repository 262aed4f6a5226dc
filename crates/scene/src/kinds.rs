//! The kinds of force by name: what `snake list forces` shows, and one picked on a command line.

use std::sync::Arc;

use field::Polarity;
use fit::force::Sight;
use fit::{FitForce, MakeForce};
use glam::DVec2;
use snake::Acting;

use crate::SceneError;
use crate::error::{clip, meant};
use crate::file::{ForceText, KindText, PolarityText, WORDS};
use crate::meaning::force;

/// A kind of force that a scene can name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ForceKind {
    /// The word for it: `kind` of a `[[force]]`.
    pub name: &'static str,
    /// One line for people.
    pub summary: &'static str,
    /// What it is minus the gradient of, per unit of length of the curve; "none" where there is no energy.
    pub energy: &'static str,
}

macro_rules! forces {
    ($($name:literal, $summary:literal, $energy:literal;)*) => {
        /// Every kind of force, in the order of `docs/formats.md`.
        pub const FORCES: &[ForceKind] =
            &[$(ForceKind { name: $name, summary: $summary, energy: $energy }),*];
    };
}

forces![
    "edge", "edges of the grey picture, of both polarities or one", "-|grad(G*I)|; none for one polarity";
    "color-edge", "edges in color, those between colors of equal grey too", "-sqrt(l1-l2) of the structure tensor";
    "scales", "edges at several scales at once", "-max over the scales of sqrt(s)|grad(G_s*I)|";
    "coarse-to-fine", "edges at one scale after another: from afar at first, exactly in the end", "-|grad(G_s*I)| of the scale at the time";
    "line", "bright or dark lines", "-(G*I), or that itself";
    "termination", "ends of lines, and corners", "-|curvature of the level lines|";
    "distance", "the nearest edge, with constant pull", "distance to the nearest edge";
    "gvf", "gradient vector flow: edges from as far as the picture is wide", "none";
    "vfc", "vector field convolution: all edges at once, by distance", "none";
    "regions", "what is like the inside into the curve: one mean inside, one outside", "none where nodes are asked";
    "local-regions", "the same with means near each node: uneven light", "none";
    "likelihood", "the same by histograms, Gaussians or mixtures of grey or color", "none where nodes are asked";
    "texture", "the same by the energies of stripes of every direction and width", "none where nodes are asked";
    "pressure", "a balloon: the same pressure always", "-pressure * area enclosed";
    "gas", "a gas: pressure times area stays", "-pressure * area * ln(area enclosed)";
    "area", "a spring towards an area", "pressure / 2 * (area enclosed - area)^2 / area";
    "spring", "a spring from the curve to a place that stays or moves", "stiffness / 2 * length^2, undamped and at rest";
    "repulsor", "a push away from a place, of finite reach", "a hill of that height";
    "freeze", "nodes held by a spring each where they were", "stiffness / 2 * distance^2, undamped";
    "gravity", "a uniform acceleration", "-mass * acceleration . x";
];

/// A kind of force as picked on a command line: a [`ForceKind`]'s name, `name:weight`, or the inside of a
/// `[[force]]` as a TOML table.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceChoice(pub(crate) ForceText);

impl ForceChoice {
    /// Read one: `gvf`, `gvf:0.5`, `{ kind = "edge", sigma = 2.0 }`.
    ///
    /// ```
    /// let error = scene::ForceChoice::parse("gvff:0.5").unwrap_err();
    /// assert!(error.contains("did you mean \"gvf\"?"));
    /// ```
    ///
    /// # Errors
    ///
    /// A name that none has, with the nearest one; a weight that is no number; keys that a `[[force]]` of this
    /// kind does not have, or lacks. As a message without the flag.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let table = if text.starts_with('{') {
            format!("force = {text}")
        } else {
            let (name, weight) = match text.split_once(':') {
                Some((name, weight)) => (name.trim(), Some(weight.trim())),
                None => (text, None),
            };
            if !WORDS.contains(&name) {
                let (name, meant) = (clip(name), meant(name, WORDS.iter().copied()));
                let known = WORDS.join(", ");
                return Err(format!(
                    "no kind of force is called \"{name}\"{meant} (known: {known})"
                ));
            }
            let weight = match weight.map(str::parse::<f64>) {
                None => String::new(),
                Some(Ok(weight)) if weight.is_finite() && weight >= 0.0 => {
                    format!(", weight = {weight:?}")
                }
                Some(_) => {
                    let message = "the weight behind the colon must be finite and at least 0";
                    return Err(format!("{message}, got {}", clip(text)));
                }
            };
            format!("force = {{ kind = \"{name}\"{weight} }}")
        };
        crate::toml_error::read::<One>(&table)
            .map(|one| Self(one.force))
            .map_err(|error| match error {
                SceneError::Text { message, .. } => message,
                other => other.to_string(),
            })
    }

    /// The same with that polarity, if it is an edge force and does not say.
    #[must_use]
    pub fn with_polarity(mut self, polarity: Polarity) -> Self {
        if let KindText::Edge(edge) = &mut self.0.kind {
            edge.polarity.get_or_insert(match polarity {
                Polarity::DarkToBright => PolarityText::DarkToBright,
                Polarity::BrightToDark => PolarityText::BrightToDark,
                Polarity::Either => PolarityText::Either,
            });
        }
        self
    }

    /// Whether it is a field of the picture alone: one that asks for no curve.
    #[must_use]
    pub fn is_field(&self) -> bool {
        force::is_field(&self.0.kind)
    }

    /// Whether it compares what a curve encloses with the rest: given a curve, it is a push at every pixel.
    #[must_use]
    pub const fn is_region(&self) -> bool {
        force::is_region(&self.0.kind)
    }

    /// This force for a fit: made once the curve is known.
    #[must_use]
    pub fn for_fit(self) -> FitForce {
        FitForce::Made(Arc::new(self))
    }

    /// The name of its kind.
    #[must_use]
    pub const fn kind(&self) -> &'static str {
        self.0.kind.word()
    }
}

impl MakeForce for ForceChoice {
    /// Errors begin with the name of the kind and the key of the value.
    fn make(&self, sight: &Sight, nodes: &[DVec2], closed: bool) -> Result<Vec<Acting>, String> {
        force::made(&self.0, sight, nodes, closed).map_err(|error| error.to_string())
    }
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct One {
    force: ForceText,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_listed_and_every_listed_kind_is_one() {
        let names: Vec<&str> = FORCES.iter().map(|kind| kind.name).collect();
        assert_eq!(names, WORDS);
    }

    #[test]
    fn a_choice_is_a_name_a_name_with_a_weight_or_a_table() {
        assert_eq!(ForceChoice::parse("gvf").unwrap().kind(), "gvf");
        let half = ForceChoice::parse(" vfc : 0.5").unwrap();
        assert_eq!(
            half.0.common.weight,
            Some(crate::file::ProfileText::Uniform(0.5))
        );
        let fine = ForceChoice::parse("{ kind = \"edge\", sigma = 2.0, name = \"fine\" }").unwrap();
        assert_eq!(fine.0.common.name.as_deref(), Some("fine"));
        for (bad, says) in [
            ("gvff", "did you mean \"gvf\""),
            ("gvf:-1", "at least 0"),
            ("gvf:much", "at least 0"),
            ("{ kind = \"edge\", sgma = 2.0 }", "did you mean \"sigma\""),
            ("{ kind = \"egde\" }", "did you mean \"edge\""),
            ("{ sigma = 2.0 }", "kind"),
            ("{ kind = \"gravity\" }", "acceleration"),
            ("{", "inline table"),
            ("", "no kind"),
        ] {
            let error = ForceChoice::parse(bad).unwrap_err();
            assert!(error.contains(says), "{bad}: {error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
    }
}

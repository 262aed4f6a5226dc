//! The kinds of force that a picture exerts: from the words of the text to the finder's plain
//! values.

use field::{Falloff, FlowRule, Line as Shade, Polarity};
use fit::force::{
    CoarseToFine, ColorEdge, Densities, Distance, Edge, Gvf, ImageForceKind, Likelihood, Line,
    LocalRegions, Regions, Scales, Termination, Texture, Vfc,
};

use crate::SceneError;
use crate::file::{
    DensityText, EdgeText, GvfText, KindText, LikelihoodText, PolarityText, RegionsText, ShadeText,
    VfcText,
};

/// What a text means, with defaults for what it leaves out; None for kinds that look at no picture.
pub(super) fn of_picture(key: &str, text: &KindText) -> Result<Option<ImageForceKind>, SceneError> {
    Ok(Some(match text {
        KindText::Edge(text) => ImageForceKind::Edge(edge(text)),
        KindText::ColorEdge(text) => {
            let usual = ColorEdge::default();
            ImageForceKind::ColorEdge(ColorEdge {
                sigma: text.sigma.unwrap_or(usual.sigma),
                strength: text.strength.unwrap_or(usual.strength),
            })
        }
        KindText::Scales(text) => {
            let usual = Scales::default();
            ImageForceKind::Scales(Scales {
                sigmas: text.sigmas.clone().unwrap_or(usual.sigmas),
                strength: text.strength.unwrap_or(usual.strength),
            })
        }
        KindText::CoarseToFine(text) => {
            let usual = CoarseToFine::default();
            ImageForceKind::CoarseToFine(CoarseToFine {
                sigmas: text.sigmas.clone().unwrap_or(usual.sigmas),
                strength: text.strength.unwrap_or(usual.strength),
                blur: text.blur.unwrap_or(usual.blur),
                hold: text.hold.unwrap_or(usual.hold),
            })
        }
        KindText::Line(text) => {
            let usual = Line::default();
            ImageForceKind::Line(Line {
                sigma: text.sigma.unwrap_or(usual.sigma),
                strength: text.strength.unwrap_or(usual.strength),
                shade: match text.shade {
                    Some(ShadeText::Dark) => Shade::Dark,
                    Some(ShadeText::Bright) | None => usual.shade,
                },
            })
        }
        KindText::Termination(text) => {
            let usual = Termination::default();
            ImageForceKind::Termination(Termination {
                sigma: text.sigma.unwrap_or(usual.sigma),
                strength: text.strength.unwrap_or(usual.strength),
                floor: text.floor.unwrap_or(usual.floor),
            })
        }
        KindText::Distance(text) => {
            let usual = Distance::default();
            ImageForceKind::Distance(Distance {
                sigma: text.sigma.unwrap_or(usual.sigma),
                strength: text.strength.unwrap_or(usual.strength),
                threshold: text.threshold.unwrap_or(usual.threshold),
                reach: text.reach,
            })
        }
        KindText::Gvf(text) => ImageForceKind::Gvf(gvf(key, text)?),
        KindText::Vfc(text) => ImageForceKind::Vfc(vfc(key, text)?),
        KindText::Regions(text) => ImageForceKind::Regions(regions(text)),
        KindText::LocalRegions(text) => {
            let usual = LocalRegions::default();
            ImageForceKind::LocalRegions(LocalRegions {
                regions: regions(&RegionsText {
                    sigma: text.sigma,
                    strength: text.strength,
                    grey: text.grey,
                }),
                radius: text.radius.unwrap_or(usual.radius),
            })
        }
        KindText::Likelihood(text) => ImageForceKind::Likelihood(likelihood(text)),
        KindText::Texture(text) => {
            let usual = Texture::default();
            ImageForceKind::Texture(Texture {
                sigmas: text.sigmas.clone().unwrap_or(usual.sigmas),
                strength: text.strength.unwrap_or(usual.strength),
                classes: text.classes.unwrap_or(usual.classes),
            })
        }
        _ => return Ok(None),
    }))
}

fn edge(text: &EdgeText) -> Edge {
    let usual = Edge::default();
    Edge {
        sigma: text.sigma.unwrap_or(usual.sigma),
        strength: text.strength.unwrap_or(usual.strength),
        polarity: text.polarity.map(|polarity| match polarity {
            PolarityText::DarkToBright => Polarity::DarkToBright,
            PolarityText::BrightToDark => Polarity::BrightToDark,
            PolarityText::Either => Polarity::Either,
        }),
    }
}

fn gvf(key: &str, text: &GvfText) -> Result<Gvf, SceneError> {
    let usual = Gvf::default();
    let rule = match (text.smoothness, text.spread) {
        (Some(_), Some(_)) => {
            let message = "give smoothness, or spread for the generalised flow, not both";
            return Err(SceneError::key(&format!("{key}: spread"), message));
        }
        (_, Some(spread)) => FlowRule::Generalised { spread },
        (Some(smoothness), None) => FlowRule::Plain { smoothness },
        (None, None) => usual.rule,
    };
    Ok(Gvf {
        sigma: text.sigma.unwrap_or(usual.sigma),
        strength: text.strength.unwrap_or(usual.strength),
        threshold: text.threshold.unwrap_or(usual.threshold),
        rule,
        knee: text.knee.unwrap_or(usual.knee),
    })
}

fn vfc(key: &str, text: &VfcText) -> Result<Vfc, SceneError> {
    let usual = Vfc::default();
    let falloff = match (text.exponent, text.width) {
        (Some(_), Some(_)) => {
            let message = "give exponent, or width for a Gaussian falloff, not both";
            return Err(SceneError::key(&format!("{key}: width"), message));
        }
        (_, Some(width)) => Falloff::Gaussian { width },
        (Some(exponent), None) => Falloff::Power { exponent },
        (None, None) => usual.falloff,
    };
    Ok(Vfc {
        sigma: text.sigma.unwrap_or(usual.sigma),
        strength: text.strength.unwrap_or(usual.strength),
        threshold: text.threshold.unwrap_or(usual.threshold),
        falloff,
        reach: text.reach,
        knee: text.knee.unwrap_or(usual.knee),
    })
}

fn regions(text: &RegionsText) -> Regions {
    let usual = Regions::default();
    Regions {
        sigma: text.sigma.unwrap_or(usual.sigma),
        strength: text.strength.unwrap_or(usual.strength),
        grey: text.grey.unwrap_or(usual.grey),
    }
}

fn likelihood(text: &LikelihoodText) -> Likelihood {
    let usual = Likelihood::default();
    Likelihood {
        sigma: text.sigma.unwrap_or(usual.sigma),
        strength: text.strength.unwrap_or(usual.strength),
        grey: text.grey.unwrap_or(usual.grey),
        classes: text.classes.unwrap_or(usual.classes),
        density: match text.density {
            Some(DensityText::Gaussian) => Densities::Gaussian,
            Some(DensityText::Mixture) => Densities::Mixture {
                components: text.components.unwrap_or(3),
            },
            Some(DensityText::Histogram) | None => Densities::Histogram {
                bandwidth: text.bandwidth,
            },
        },
    }
}

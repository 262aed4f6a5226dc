//! The world: the picture's force, gravity, walls, and the borders of the picture.

use std::sync::Arc;

use elastic::Profile;
use field::{EdgeForce, FieldError, ForceField, Smoothing};
use fit::force::Computing;
use glam::DVec2;
use integrator::State;
use snake::{Acting, ImageForce, Sampling, SnakeError, Wall, WallLaw, World};

use super::body::profile;
use super::force::{self, Sight};
use super::{Rules, number};
use crate::file::{
    BorderText, ComputedText, FieldText, ForceText, LawText, Rule, SceneText, WallText,
};
use crate::{Picture, SceneError};

/// Refuse a smoothing that would take minutes on a picture of this size, or that makes no sense.
pub(crate) fn smoothing(
    key: &str,
    smoothing: Smoothing,
    size: (usize, usize),
) -> Result<Smoothing, SceneError> {
    let checked = fit::force::check_smoothing(smoothing, size);
    checked.map_err(|problem| SceneError::key(key, problem))
}

pub(super) fn force_field(
    f: &FieldText,
    rules: Rules,
    sight: &Sight<'_>,
) -> Result<ForceField, SceneError> {
    let picture = sight.picture;
    let refuse = |error: FieldError| SceneError::key("field", error);
    let scale = |otherwise: f64| number::above_zero("field.scale", f.scale.unwrap_or(otherwise));
    let gain = |otherwise: f64| number::above_zero("field.gain", f.gain.unwrap_or(otherwise));
    if f.passes.is_some() && f.sigma.is_some() {
        let message = "give either passes or sigma, not both";
        return Err(SceneError::key("field.sigma", message));
    }
    let passes = f.passes.unwrap_or(field::REPORT_PASSES);
    let binomial = Smoothing::Binomial(passes);
    match rules.field {
        Rule::Report => {
            if f.sigma.is_some() {
                let message = "the report's field smooths by passes; needed: those";
                return Err(SceneError::key("field.sigma", message));
            }
            if picture.valid().is_some() {
                let message = "the report's field knows no mask; needed: field = \"corrected\"";
                return Err(SceneError::key("rules.field", message));
            }
            if f.computed == Some(ComputedText::Lazy) {
                let message = "the report's field is made as a whole; needed: \"whole\"";
                return Err(SceneError::key("field.computed", message));
            }
            smoothing("field.passes", binomial, picture.size())?;
            let (scale, gain) = (scale(field::REPORT_SCALE)?, gain(field::REPORT_GAIN)?);
            field::report_force(picture.levels(), passes, scale, gain).map_err(refuse)
        }
        Rule::Corrected => {
            // so that an edge pulls as hard as under the report's rules
            let usual = EdgeForce::as_strong_as_the_report().gain;
            let (key, smoothing) = match f.sigma {
                Some(sigma) => ("field.sigma", Smoothing::Gaussian(sigma)),
                None => ("field.passes", binomial),
            };
            let gain = gain(usual)? * scale(1.0)?;
            let computing = match f.computed {
                None => Computing::Auto,
                Some(ComputedText::Lazy) => Computing::Lazy,
                Some(ComputedText::Whole) => Computing::Whole,
            };
            let rule = EdgeForce { smoothing, gain };
            sight.edge_field(rule, computing, [key, "field.computed"])
        }
    }
}

/// The `[field]` of a picture: where it is written, or where there is no `[[force]]` that looks at the picture.
fn usual_field(text: &SceneText) -> Option<FieldText> {
    let looked_at = text.force.iter().any(|force| force::looks(&force.kind));
    match &text.field {
        Some(field) => Some(field.clone()),
        None if looked_at => None,
        None => Some(FieldText::default()),
    }
}

/// The world, and the field of the picture's `[field]` in it.
pub(super) fn world(
    text: &SceneText,
    rules: Rules,
    sight: Option<&Sight<'_>>,
    nodes: &[DVec2],
    closed: bool,
) -> Result<(World, Option<Arc<ForceField>>), SceneError> {
    let mut world = World::default();
    if let Some(g) = text.world.gravity {
        world = world.with_gravity(number::place("world.gravity", g)?);
    }
    let mut usual = None;
    if let (Some(sight), Some(f)) = (sight, usual_field(text)) {
        // one for all snakes of a scene, which have it in common
        let field = sight.usual(|| {
            sight.spend("field", 1)?;
            force_field(&f, rules, sight)
        })?;
        let sampling = match rules.sampling {
            Rule::Report => Sampling::OneAxis,
            Rule::Corrected => Sampling::Bilinear,
        };
        let weight = match &f.weight {
            Some(weight) => profile("field.weight", weight, nodes.len())?,
            None => Profile::Uniform(1.0),
        };
        let image = Acting::new(ImageForce::new(Arc::clone(&field), sampling));
        world = world.with_acting(image.weighted(weight));
        usual = Some(field);
    }
    let keyed = |(i, force): (usize, &'_ ForceText)| (format!("force {i}"), force.clone());
    let keyed: Vec<(String, ForceText)> = text.force.iter().enumerate().map(keyed).collect();
    world = force::add(world, &keyed, sight, nodes, closed)?;
    for (i, text) in text.world.wall.iter().enumerate() {
        world.walls.push(wall(&format!("world.wall {i}"), text)?);
    }
    if let Some(Sight { picture, .. }) = sight {
        for (point, normal, law) in borders(text.world.border, rules, picture) {
            let wall = Wall::new(point, normal, law);
            world
                .walls
                .push(wall.map_err(|e| SceneError::key("world.border", e))?);
        }
    }
    Ok((world, usual))
}

fn wall(key: &str, text: &WallText) -> Result<Wall, SceneError> {
    let law = match &text.law {
        LawText::Clamp => WallLaw::Clamp,
        LawText::Penalty(p) => WallLaw::Penalty {
            stiffness: p.stiffness,
            damping: p.damping,
        },
        LawText::Impact(i) => WallLaw::Impact {
            restitution: i.restitution,
            friction: i.friction,
        },
    };
    let point = number::place(&format!("{key}: point"), text.point)?;
    let normal = number::place(&format!("{key}: normal"), text.normal)?;
    Wall::new(point, normal, law).map_err(|e: SnakeError| SceneError::key(key, e))
}

/// The walls that the borders of a picture are.
fn borders(
    border: Option<BorderText>,
    rules: Rules,
    picture: &Picture,
) -> Vec<(DVec2, DVec2, WallLaw)> {
    let (width, height) = picture.size();
    let far = DVec2::new((width - 1) as f64, (height - 1) as f64);
    let border = border.unwrap_or(match rules.border {
        Rule::Report => BorderText::Clamp,
        Rule::Corrected => BorderText::Stop,
    });
    let (clamp, stop) = (
        WallLaw::Clamp,
        WallLaw::Impact {
            restitution: 0.0,
            friction: 0.0,
        },
    );
    match border {
        BorderText::None => Vec::new(),
        BorderText::Clamp => vec![(DVec2::ZERO, DVec2::Y, clamp), (far, DVec2::NEG_Y, clamp)],
        BorderText::Stop => vec![
            (DVec2::ZERO, DVec2::Y, stop),
            (far, DVec2::NEG_Y, stop),
            (DVec2::ZERO, DVec2::X, stop),
            (far, DVec2::NEG_X, stop),
        ],
    }
}

/// Refuse a start of which a node is off the picture. The report's program lets a node begin up to
/// a pixel above it, where its clamp catches it (D54, D57).
pub(super) fn inside(start: &State, picture: &Picture, rules: Rules) -> Result<(), SceneError> {
    let margin = if rules.border == Rule::Report {
        1.0
    } else {
        0.5
    };
    outside(&start.x, picture, margin).map_or(Ok(()), |message| {
        Err(SceneError::key("snake.start", format!("node {message}")))
    })
}

/// What to say of the first place farther than `margin` off a picture's pixel centers, if any.
///
/// Written so that a NaN is outside too.
pub(crate) fn outside(places: &[DVec2], picture: &Picture, margin: f64) -> Option<String> {
    let (width, height) = picture.size();
    let (least, most) = (-margin, DVec2::new(width as f64, height as f64) - margin);
    let i = places
        .iter()
        .position(|p| !(p.cmpge(DVec2::splat(least)).all() && p.cmple(most).all()))?;
    let p = places[i];
    Some(format!(
        "{i} at ({:.2}, {:.2}) is outside the picture of {width}×{height} pixels; needed: x from 0 to {} \
         and y from 0 to {}",
        p.x,
        p.y,
        width - 1,
        height - 1
    ))
}

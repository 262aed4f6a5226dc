//! Further snakes, contact and upkeep.

use snake::{Contact, Plastic, Snake, Upkeep};

use super::files::Files;
use super::force::Sight;
use super::{Rules, body, ends, map, number, refused, world};
use crate::SceneError;
use crate::company::Company;
use crate::file::{AlsoText, ContactText, SceneText, UpkeepText};
use crate::limits::{MOST_FORCES, MOST_IN_ALL, MOST_SNAKES};

/// The company of the scene's snake; None if it is alone and nothing looks after it.
pub(super) fn company(
    text: &SceneText,
    rules: Rules,
    sight: Option<&Sight<'_>>,
    first: &Snake,
    files: &Files<'_>,
) -> Result<Option<Company>, SceneError> {
    if text.also.is_empty() && text.contact.is_none() && text.upkeep.is_none() {
        return Ok(None);
    }
    let picture = sight.map(|sight| sight.picture);
    // what a further snake is given in place of: without the list of them, which would be copied for each
    let mut common = text.clone();
    common.also.clear();
    let mut nodes = first.body().len();
    let things = text.force.len() + text.world.wall.len();
    let mut others = Vec::new();
    for (k, also) in text.also.iter().enumerate() {
        let places = also.at.as_ref().map_or(1, Vec::len);
        if others.len() + places > MOST_SNAKES {
            let message = format!("makes more than {MOST_SNAKES} snakes, which are the most");
            return Err(SceneError::key(&format!("also {k}: at"), message));
        }
        let own = instead(&common, also);
        let each = (own.force.len() + own.world.wall.len()).max(things);
        if each.saturating_mul(others.len() + places) > MOST_FORCES {
            let got = others.len() + places;
            let message = format!(
                "{got} snakes of {each} forces and walls; both multiplied must be at most {MOST_FORCES}"
            );
            return Err(SceneError::key(&format!("also {k}: force"), message));
        }
        let within = |error: SceneError| match error {
            SceneError::Key { key, message } => SceneError::Key {
                key: format!("also {k}: {key}"),
                message,
            },
            other => other,
        };
        let mut shape = body::body(&own, rules, files).map_err(within)?;
        nodes = nodes.saturating_add(shape.len().saturating_mul(places));
        if nodes > MOST_IN_ALL {
            let message =
                format!("makes {nodes} nodes in all snakes; there must be at most {MOST_IN_ALL}");
            return Err(SceneError::key(&format!("also {k}: at"), message));
        }
        shape.maps = if also.material.is_none() && also.densities.is_none() {
            first.body().maps.clone()
        } else {
            map::maps(&own, picture, files).map_err(within)?
        };
        let start = body::start(&own, &shape, rules, files).map_err(within)?;
        // the same forces, unless their weights are meant for another number of nodes or they know the curve
        let same = shape.len() == first.body().len()
            && also.force.is_none()
            && !super::force::remembers(&own.force);
        let surroundings = if same {
            first.world().clone()
        } else {
            let closed = shape.topology.is_closed();
            let world = world::world(&own, rules, sight, &start.x, closed);
            world.map_err(within)?.0
        };
        let mut snake =
            Snake::new(shape, surroundings).map_err(|e| within(refused("snake", &e)))?;
        ends::slide(&own, &mut snake, &start, picture).map_err(within)?;
        body::damp(&own, &mut snake, &start).map_err(within)?;
        match &also.at {
            None => others.push((snake, start)),
            Some(places) => {
                let middle = elastic::center(&start.x, None);
                for (i, &place) in places.iter().enumerate() {
                    let place = number::place(&format!("also {k}: at[{i}]"), place)?;
                    let mut moved = start.clone();
                    let by = place - middle;
                    for x in &mut moved.x {
                        *x += by;
                    }
                    let mut snake = snake.clone();
                    if super::force::knows_places(&own.force) {
                        let mut there = own.clone();
                        super::force::shift(&mut there.force, by);
                        let closed = snake.body().topology.is_closed();
                        let world = world::world(&there, rules, sight, &moved.x, closed);
                        let world = world.map_err(within)?.0;
                        snake
                            .set_world(world)
                            .map_err(|e| within(refused("snake", &e)))?;
                    }
                    others.push((snake, moved));
                }
            }
        }
    }
    for (k, (_, start)) in others.iter().enumerate() {
        if let Some(picture) = picture {
            world::inside(start, picture, rules).map_err(|error| match error {
                SceneError::Key { message, .. } => {
                    SceneError::key("also", format!("snake {}: {message}", k + 1))
                }
                other => other,
            })?;
        }
    }
    Ok(Some(Company {
        others,
        contact: text.contact.as_ref().map(contact),
        upkeep: text
            .upkeep
            .as_ref()
            .map(upkeep)
            .transpose()?
            .unwrap_or_default(),
    }))
}

/// The text with what a further snake says in place of what the first says.
fn instead(text: &SceneText, also: &AlsoText) -> SceneText {
    let mut own = text.clone();
    own.also.clear();
    let snake = &mut own.snake;
    if let Some(start) = &also.start {
        snake.start = start.clone();
        snake.rest = None;
    }
    if also.rest.is_some() {
        snake.rest.clone_from(&also.rest);
    }
    if also.nodes.is_some() {
        snake.nodes = also.nodes;
    }
    if let Some(topology) = &also.topology {
        snake.topology = topology.clone();
    }
    snake.velocity = also.velocity.unwrap_or(snake.velocity);
    snake.spin = also.spin.unwrap_or(snake.spin);
    if let Some(material) = &also.material {
        own.material = material.clone();
    }
    if let Some(force) = &also.force {
        own.force.clone_from(force);
    }
    if let Some(densities) = &also.densities {
        own.densities = densities.clone();
    }
    own
}

fn contact(text: &ContactText) -> Contact {
    Contact {
        stiffness: text.stiffness,
        damping: text.damping,
        friction: text.friction,
        wall_friction: text.wall_friction,
        stick: text.stick,
        adhesion: text.adhesion,
        range: text.range,
        gap: text.gap,
        stop: text.stop,
        own: text.own,
    }
}

fn upkeep(text: &UpkeepText) -> Result<Upkeep, SceneError> {
    if text.every == 0 {
        return Err(SceneError::key("upkeep.every", "must be at least 1, got 0"));
    }
    Ok(Upkeep {
        every: text.every,
        stretch: text.stretch,
        least_area: text.least_area,
        merge: text.merge,
        plastic: text.plastic.as_ref().map(|plastic| Plastic {
            yields_at: plastic.yields_at,
            rate: plastic.rate,
        }),
        growth: text.growth,
    })
}

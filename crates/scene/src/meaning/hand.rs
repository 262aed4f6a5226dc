//! `[[hand]]`: what comes and goes during a run.

use elastic::Profile;
use glam::DVec2;
use integrator::State;
use snake::{Acting, Body, Snake, World};

use super::force;
use crate::SceneError;
use crate::file::{DirectionText, ForceText, HandText, KindText, SceneText, UpkeepText};
use crate::hand::{Grip, Held};

/// The hands of a scene on its own snake, and the world with their forces in it, which do nothing yet.
pub(super) fn own(
    text: &SceneText,
    mut world: World,
    body: &Body,
    start: &State,
) -> Result<(Vec<Grip>, World), SceneError> {
    let closed = body.topology.is_closed();
    let mut grips = Vec::new();
    if !text.hand.is_empty() {
        possible(text)?;
    }
    let own = text
        .hand
        .iter()
        .enumerate()
        .filter(|(_, hand)| hand.snake == 0);
    for (i, hand) in own {
        let (mut grip, given) = grip(&format!("hand {i}"), hand, &world, start, closed)?;
        if let (Held::Force { idle, .. }, Some(acting)) = (&mut grip.held, given) {
            // its column in a record is there all the time
            let still = acting.weighted(Profile::Uniform(0.0));
            world.forces.push(still.clone());
            *idle = Some(still);
        }
        grips.push(grip);
    }
    Ok((grips, world))
}

/// The hands on the further snakes.
pub(super) fn others(text: &SceneText, others: &[(Snake, State)]) -> Result<Vec<Grip>, SceneError> {
    let mut grips = Vec::new();
    let theirs = text
        .hand
        .iter()
        .enumerate()
        .filter(|(_, hand)| hand.snake > 0);
    for (i, hand) in theirs {
        let key = format!("hand {i}");
        let Some((snake, start)) = others.get(hand.snake - 1) else {
            let message = format!(
                "must be at most {}, the last snake there is, got {}",
                others.len(),
                hand.snake
            );
            return Err(SceneError::key(&format!("{key}: snake"), message));
        };
        let closed = snake.body().topology.is_closed();
        grips.push(grip(&key, hand, snake.world(), start, closed)?.0);
    }
    Ok(grips)
}

/// One hand, and the force that it brings, with a name that no other in the world has.
fn grip(
    key: &str,
    hand: &HandText,
    world: &World,
    start: &State,
    closed: bool,
) -> Result<(Grip, Option<Acting>), SceneError> {
    let (from, until) = times(key, hand)?;
    let (held, given) = match (&hand.force, hand.hold) {
        (None, Some(stretch)) => (Held::Nodes(nodes(key, stretch, start.len(), closed)?), None),
        (Some(force), None) => {
            let key = format!("{key}: force");
            blind(&key, force)?;
            let mut world = force::add(
                world.clone(),
                &[(key.clone(), force.clone())],
                None,
                &start.x,
                closed,
            )?;
            let Some(acting) = world.forces.pop() else {
                return Err(SceneError::key(&key, "is no force"));
            };
            let mut text = Box::new(force.clone());
            text.common.name = Some(acting.name().to_owned());
            let full = Box::new(acting.clone());
            let idle = None;
            (Held::Force { text, idle, full }, Some(acting))
        }
        _ => {
            let message = "needs one of the keys hold and force";
            return Err(SceneError::key(key, message));
        }
    };
    let snake = hand.snake;
    let grip = Grip {
        snake,
        closed,
        from,
        until,
        held,
    };
    Ok((grip, given))
}

/// Refuse hands on nodes that are numbered anew during the run, and on nodes that must be free.
fn possible(text: &SceneText) -> Result<(), SceneError> {
    if text.tips.is_some() {
        let message = "acts on nodes by their numbers, and ends that grow number them anew; \
                       leave out [[hand]] or [tips]";
        return Err(SceneError::key("hand", message));
    }
    let holds = text.hand.iter().position(|hand| hand.hold.is_some());
    let Some(i) = holds else { return Ok(()) };
    let key = format!("hand {i}: hold");
    let renumbers = |upkeep: &UpkeepText| {
        upkeep.stretch.is_some() || upkeep.least_area.is_some() || upkeep.merge.is_some()
    };
    if text.upkeep.as_ref().is_some_and(renumbers) {
        let message = "names nodes by their numbers, and [upkeep] numbers them anew; a force of kind freeze \
                       follows them";
        return Err(SceneError::key(&key, message));
    }
    if let Some(crate::file::FrameText::Terms(_)) = &text.snake.frame {
        let message = "must not be given with a frame that turns by its own equation, which needs every node \
                       free to move; use frame = \"turning\"";
        return Err(SceneError::key(&key, message));
    }
    Ok(())
}

fn times(key: &str, hand: &HandText) -> Result<(f64, f64), SceneError> {
    if !(hand.from.is_finite() && hand.from >= 0.0) {
        let message = format!("must be finite and at least 0, got {}", hand.from);
        return Err(SceneError::key(&format!("{key}: from"), message));
    }
    let until = hand.until.unwrap_or(f64::INFINITY);
    if until.is_nan() || until <= hand.from {
        let message = format!("must be after from, {}, got {until}", hand.from);
        return Err(SceneError::key(&format!("{key}: until"), message));
    }
    Ok((hand.from, until))
}

/// The nodes of a stretch, over the joint of a closed curve where the last lies before the first.
fn nodes(
    key: &str,
    [first, last]: [usize; 2],
    n: usize,
    closed: bool,
) -> Result<Vec<usize>, SceneError> {
    if first >= n || last >= n || (first > last && !closed) {
        let message = format!(
            "needed: [first, last] from 0 to {}, got [{first}, {last}]",
            n - 1
        );
        return Err(SceneError::key(&format!("{key}: hold"), message));
    }
    let count = (last + n - first) % n + 1;
    Ok((first..first + count).map(|i| i % n).collect())
}

/// Refuse a force that would have to look at the picture when the hand comes.
fn blind(key: &str, force: &ForceText) -> Result<(), SceneError> {
    let asks = match &force.kind {
        KindText::Pressure(text) => text.direction == Some(DirectionText::Picture),
        kind => force::looks(kind),
    };
    if asks {
        let message = "looks at the picture; needed: a [[force]] of its own with a schedule";
        return Err(SceneError::key(&format!("{key}: kind"), message));
    }
    Ok(())
}

/// The force of a hand, for the curve as it is.
pub(crate) fn force_now(
    text: &ForceText,
    nodes: &[DVec2],
    closed: bool,
) -> Result<Option<Acting>, SceneError> {
    let key = "hand: force".to_owned();
    let mut world = force::add(
        World::default(),
        &[(key, text.clone())],
        None,
        nodes,
        closed,
    )?;
    Ok(world.forces.pop())
}

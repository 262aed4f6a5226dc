//! `[[hand]]`: what comes and goes during a run.

use elastic::Profile;
use glam::DVec2;
use integrator::State;
use snake::{Acting, Body, World};

use super::force;
use crate::SceneError;
use crate::file::{DirectionText, ForceText, HandText, KindText, SceneText};
use crate::hand::{Grip, Hand, Held};

/// The hands of a scene, and the world with their forces in it, which do nothing yet.
pub(super) fn hand(
    text: &SceneText,
    mut world: World,
    body: &Body,
    start: &State,
) -> Result<(Hand, World), SceneError> {
    let closed = body.topology.is_closed();
    let mut grips = Vec::new();
    if !text.hand.is_empty() {
        alone(text)?;
    }
    for (i, hand) in text.hand.iter().enumerate() {
        let key = format!("hand {i}");
        let (from, until) = times(&key, hand)?;
        let held = match (&hand.force, hand.hold) {
            (None, Some(stretch)) => Held::Nodes(nodes(&key, stretch, start.len(), closed)?),
            (Some(force), None) => {
                let key = format!("{key}: force");
                blind(&key, force)?;
                world = force::add(world, &[(key, force.clone())], None, &start.x, closed)?;
                let Some(acting) = world.forces.pop() else {
                    continue; // one was added
                };
                let mut text = Box::new(force.clone());
                text.common.name = Some(acting.name().to_owned());
                let idle = acting.clone().weighted(Profile::Uniform(0.0));
                world.forces.push(idle.clone());
                Held::Force {
                    text,
                    idle,
                    full: Box::new(acting),
                }
            }
            _ => {
                let message = "one of the keys hold and force would do";
                return Err(SceneError::key(&key, message));
            }
        };
        grips.push(Grip { from, until, held });
    }
    Ok((Hand::of(grips, closed), world))
}

/// Refuse company that knows nothing of hands.
fn alone(text: &SceneText) -> Result<(), SceneError> {
    let others = [
        (!text.also.is_empty(), "[[also]]"),
        (text.contact.is_some(), "[contact]"),
        (text.upkeep.is_some(), "[upkeep]"),
        (text.tips.is_some(), "[tips]"),
    ];
    for (given, what) in others {
        if given {
            let message = format!(
                "is of one snake that nothing else looks after; without {what} it would do"
            );
            return Err(SceneError::key("hand", message));
        }
    }
    if let Some(crate::file::FrameText::Terms(_)) = &text.snake.frame {
        let message =
            "is not for a frame that turns by its own equation; frame = \"turning\" would do";
        return Err(SceneError::key("hand", message));
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
            "[first, last] from 0 to {} would do, got [{first}, {last}]",
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
        let message = "looks at the picture; a [[force]] of its own with a schedule would do";
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

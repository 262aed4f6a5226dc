//! What ends do: slide along a line, grow along a ridge.

use std::sync::Arc;

use field::{FieldError, Smoothing};
use glam::DVec2;
use integrator::State;
use snake::{Snake, Tips};

use super::{number, smoothing};
use crate::file::{EndText, EndWord, SceneText, ShadeText, TipsWord, TopologyText};
use crate::limits::MOST_NODES;
use crate::{Picture, SceneError};

/// Let the ends of a snake slide that are to.
pub(super) fn slide(
    text: &SceneText,
    snake: &mut Snake,
    start: &State,
    picture: Option<&Picture>,
) -> Result<(), SceneError> {
    let TopologyText::Ends(ends) = &text.snake.topology else {
        return Ok(());
    };
    let last = start.len() - 1;
    for (key, end, node) in [
        ("snake.topology.head", &ends.head, 0),
        ("snake.topology.tail", &ends.tail, last),
    ] {
        let (line, closed) = match end {
            EndText::Rail(rail) => {
                if rail.rail.len() > MOST_NODES {
                    let message = format!(
                        "has {} places; needed: at most {MOST_NODES}",
                        rail.rail.len()
                    );
                    return Err(SceneError::key(key, message));
                }
                let line: Vec<DVec2> = rail.rail.iter().map(|&p| DVec2::from_array(p)).collect();
                number::places(key, &line)?;
                (line, false)
            }
            EndText::Word(EndWord::Border) => {
                let Some(picture) = picture else {
                    let message = "there is no picture whose border to slide along; needed: { rail = [[x, y], …] }";
                    return Err(SceneError::key(key, message));
                };
                let (width, height) = picture.size();
                let far = DVec2::new((width - 1) as f64, (height - 1) as f64);
                let corners = [
                    DVec2::ZERO,
                    DVec2::new(far.x, 0.0),
                    far,
                    DVec2::new(0.0, far.y),
                ];
                (corners.to_vec(), true)
            }
            EndText::Word(_) => continue,
        };
        snake
            .slide(node, Some((&line, closed)))
            .map_err(|e| SceneError::key(key, e))?;
        let at = start.x[node];
        let foot = outline_foot(&line, closed, at);
        if at.distance(foot) > snake.body().spacing {
            let message = format!(
                "starts {:.2} from the line it slides along; needed: at most a spacing, {:.2}",
                at.distance(foot),
                snake.body().spacing
            );
            return Err(SceneError::key(key, message));
        }
    }
    Ok(())
}

/// The nearest place of a polyline.
fn outline_foot(line: &[DVec2], closed: bool, p: DVec2) -> DVec2 {
    let back = closed.then(|| [line[line.len() - 1], line[0]]);
    let pairs = line.windows(2).map(|pair| [pair[0], pair[1]]).chain(back);
    let feet = pairs.map(|[a, b]| {
        let along = b - a;
        let share = (p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        a + along * share.clamp(0.0, 1.0)
    });
    feet.min_by(|a, b| a.distance(p).total_cmp(&b.distance(p)))
        .unwrap_or(p)
}

/// The ends that grow, and after how many steps each time.
pub(super) fn tips(
    text: &SceneText,
    snake: &Snake,
    picture: Option<&Picture>,
) -> Result<Option<(Tips, u64)>, SceneError> {
    let Some(tips) = &text.tips else {
        return Ok(None);
    };
    let refuse = |key: &str, message: &dyn std::fmt::Display| {
        SceneError::key(&format!("tips{key}"), message)
    };
    let Some(picture) = picture else {
        return Err(refuse(
            "",
            &"there is no picture to grow along; needed: one with a line",
        ));
    };
    if text
        .force
        .iter()
        .any(|force| !super::force::is_field(&force.kind))
    {
        return Err(refuse(
            "",
            &"ends grow under forces that are fields of the picture; needed: those alone",
        ));
    }
    let sigma = tips.sigma.unwrap_or(2.0);
    smoothing("tips.sigma", Smoothing::Gaussian(sigma), picture.size())?;
    let least = number::finite("tips.least", tips.least.unwrap_or(0.5))?;
    let every = tips.every.unwrap_or(20);
    if every == 0 {
        return Err(refuse(".every", &"must be at least 1, got 0"));
    }
    let most = tips.most.unwrap_or(1000);
    if most > MOST_NODES {
        return Err(refuse(
            ".most",
            &format!("must be at most {MOST_NODES}, got {most}"),
        ));
    }
    let failed = |e: FieldError| SceneError::key("tips", e);
    let masked = picture.masked(picture.levels()).map_err(failed)?;
    let mut map = masked
        .smoothed(Smoothing::Gaussian(sigma))
        .map_err(failed)?;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for &level in &map {
        (low, high) = (low.min(level), high.max(level));
    }
    let span = (high - low).max(f64::MIN_POSITIVE);
    let bright = tips.shade != Some(ShadeText::Dark);
    map.mapv_inplace(|level| {
        if bright {
            (level - low) / span
        } else {
            (high - level) / span
        }
    });
    let (head, tail) = match tips.ends {
        None | Some(TipsWord::Both) => (true, true),
        Some(TipsWord::Head) => (true, false),
        Some(TipsWord::Tail) => (false, true),
    };
    let tips = Tips::new(Arc::new(map), least, most, head, tail);
    tips.validate(snake)
        .map_err(|e| SceneError::key("tips", e))?;
    Ok(Some((tips, every)))
}

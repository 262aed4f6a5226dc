//! A force field as arrows.

use glam::DVec2;
use scene::field::ForceField;
use serde_json::{Value, json};

use crate::LiveError;
use crate::packet::Packet;

/// Places along the longer side at most.
const MOST: usize = 96;

/// Places on a grid over a rectangle, `count` along its longer side.
pub(crate) fn grid(from: DVec2, to: DVec2, count: usize) -> Result<Vec<DVec2>, LiveError> {
    if count == 0 || count > MOST {
        return Err(LiveError::new(format!(
            "arrows must be from 1 to {MOST} along a side, got {count}"
        )));
    }
    let size = (to - from).max(DVec2::ZERO);
    let step = size.max_element() / count as f64;
    if step.is_nan() || step <= 0.0 {
        return Ok(Vec::new());
    }
    let mut places = Vec::new();
    let mut y = from.y + 0.5 * step;
    while y < to.y {
        let mut x = from.x + 0.5 * step;
        while x < to.x {
            places.push(DVec2::new(x, y));
            x += step;
        }
        y += step;
    }
    Ok(places)
}

/// The force at each place, and the largest of all.
pub(crate) fn arrows(field: &ForceField, places: &[DVec2], packet: &mut Packet) -> Value {
    let forces: Vec<DVec2> = places.iter().map(|p| field.at(*p)).collect();
    let most = forces.iter().map(|f| f.length()).fold(0.0, f64::max);
    json!({"at": packet.points(places), "f": packet.points(&forces), "most": most})
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may stop the process")]
mod tests {
    use super::*;

    #[test]
    fn a_grid_is_even_and_of_the_number_asked_for() {
        let places = grid(DVec2::ZERO, DVec2::new(10.0, 5.0), 10).unwrap();
        assert_eq!(places.len(), 50);
        assert_eq!(places[0], DVec2::splat(0.5));
        assert!(grid(DVec2::ZERO, DVec2::ONE, 97).is_err());
        assert!(grid(DVec2::ONE, DVec2::ZERO, 9).unwrap().is_empty());
    }
}

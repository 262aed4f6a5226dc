//! What the picture's force says: as arrows, at a place, and the grey along the normal of a node.

use glam::DVec2;
use serde_json::{Value, json};

use super::Pictures;
use super::edge::level;
use super::mend::check_node;
use crate::LiveError;
use crate::arrows::{arrows, grid};
use crate::packet::Packet;

/// Half the length of a profile, and the distance of its places. Pixels.
const HALF: f64 = 12.0;
const STEP: f64 = 0.25;

impl Pictures {
    /// Forces of the picture at places on a grid.
    pub(crate) fn arrows(
        &self,
        from: DVec2,
        to: DVec2,
        count: usize,
        packet: &mut Packet,
    ) -> Result<Value, LiveError> {
        // made when it is first asked for
        self.prepared.sight().map_err(LiveError::of)?;
        let Some(field) = self.prepared.field() else {
            return Err(LiveError::new("this picture has no edge force"));
        };
        let (low, high) = self.corners();
        let places = grid(from.max(low), to.min(high), count)?;
        Ok(arrows(field, &places, packet))
    }

    /// What the force says at a place.
    pub(crate) fn at(&self, p: DVec2) -> Result<Value, LiveError> {
        let (low, high) = self.corners();
        if !(p.cmpge(low).all() && p.cmple(high).all()) {
            return Ok(json!({"inside": false}));
        }
        self.prepared.sight().map_err(LiveError::of)?;
        let force = self.prepared.field().map(|field| field.at(p).to_array());
        let counts = self.valid.as_ref().is_none_or(|valid| {
            let (x, y) = nearest(p, valid.dim());
            valid[[y, x]]
        });
        let (height, width) = (self.picture.size().1, self.picture.size().0);
        let (x, y) = nearest(p, (height, width));
        Ok(json!({
            "inside": true, "level": level(&self.picture, p), "color": self.picture.color_at(x, y),
            "forces": [{"name": "edge", "f": force}], "counts": counts,
        }))
    }

    /// Grey along the normal of a node, from inside to outside.
    pub(crate) fn profile(&self, id: u32, node: usize) -> Result<Value, LiveError> {
        let one = self.one(id)?;
        check_node(one, node)?;
        let points = self.shown(id, one);
        let (n, at) = (points.len(), node.min(points.len() - 1));
        let (before, behind) = if one.closed {
            (points[(at + n - 1) % n], points[(at + 1) % n])
        } else {
            (points[at.saturating_sub(1)], points[(at + 1).min(n - 1)])
        };
        let mut normal = (behind - before).normalize_or_zero().perp();
        if one.closed && scene::elastic::signed_area(points) > 0.0 {
            normal = -normal;
        }
        let mut ways = Vec::new();
        let mut levels = Vec::new();
        let mut way = -HALF;
        while way <= HALF {
            ways.push(way);
            levels.push(level(&self.picture, points[at] + way * normal));
            way += STEP;
        }
        Ok(json!({
            "ways": ways, "levels": levels, "at": points[at].to_array(), "normal": normal.to_array(),
            "strength": one.strength.get(node), "error": one.error.get(node).copied().flatten(),
        }))
    }
}

/// The pixel nearest to a place.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "cut to the picture first"
)]
fn nearest(p: DVec2, (height, width): (usize, usize)) -> (usize, usize) {
    let last = DVec2::new(width as f64 - 1.0, height as f64 - 1.0);
    let p = p.round().clamp(DVec2::ZERO, last);
    (p.x as usize, p.y as usize)
}

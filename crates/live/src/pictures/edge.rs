//! The edge that a click means: the ridge of the slope nearest to it, and how it runs on.

use glam::DVec2;
use io::Picture;

/// How far from the click an edge may be. Pixels.
const NEAR: i32 = 6;

/// How far the edge may turn aside in one step. Pixels.
const ASIDE: i32 = 2;

/// Width of the differences that tell the slope. Pixels.
const WIDE: f64 = 1.5;

/// It runs on as long as it is so steep against where it was clicked.
const STEEP: f64 = 0.35;

/// Least slope of an edge, of the 256 levels of a screen, a pixel.
const LEAST: f64 = 1.0;

/// Places along the edge under a click, a pixel apart, as far as it goes on within `reach`; None where there is none.
pub(super) fn ridge(picture: &Picture, at: DVec2, reach: f64) -> Option<Vec<DVec2>> {
    let mut best = (at, 0.0);
    for dy in -NEAR..=NEAR {
        for dx in -NEAR..=NEAR {
            let way = DVec2::new(f64::from(dx), f64::from(dy));
            if way.length() > f64::from(NEAR) {
                continue;
            }
            // the nearer of two edges as steep
            let steep = slope(picture, at + way).length() / (1.0 + 0.1 * way.length());
            if steep > best.1 {
                best = (at + way, steep);
            }
        }
    }
    let (begin, _) = best;
    let first = slope(picture, begin);
    if first.length() < LEAST {
        return None;
    }
    let mut edge = vec![begin];
    for sense in [1.0, -1.0] {
        let (mut p, mut way) = (begin, sense * first.perp().normalize());
        let mut gone = 0.0;
        while gone < reach {
            let side = way.perp();
            let ahead = (-2 * ASIDE..=2 * ASIDE).map(|k| p + way + 0.5 * f64::from(k) * side);
            let next = ahead.max_by(|a, b| {
                let steep = |p: &DVec2| slope(picture, *p).length();
                steep(a).total_cmp(&steep(b))
            });
            let Some(next) = next else { break };
            let here = slope(picture, next);
            if here.length() < STEEP * first.length()
                || here.dot(first) < -0.5 * here.length() * first.length()
            {
                break;
            }
            gone += next.distance(p);
            way = (next - p).normalize_or(way);
            p = next;
            edge.push(p);
        }
    }
    Some(edge)
}

/// The slope of the grey picture at a place. Levels a pixel.
fn slope(picture: &Picture, p: DVec2) -> DVec2 {
    let level = |dx: f64, dy: f64| level(picture, p + DVec2::new(dx, dy));
    DVec2::new(
        (level(WIDE, 0.0) - level(-WIDE, 0.0)) / (2.0 * WIDE),
        (level(0.0, WIDE) - level(0.0, -WIDE)) / (2.0 * WIDE),
    )
}

/// The level between pixels; beyond the border that of the border.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "cut to the picture first"
)]
pub(crate) fn level(picture: &Picture, p: DVec2) -> f64 {
    let (width, height) = picture.size();
    let last = DVec2::new(width as f64 - 1.0, height as f64 - 1.0);
    let p = p.clamp(DVec2::ZERO, last);
    let (x, y) = (p.x.floor() as usize, p.y.floor() as usize);
    let (right, below) = ((x + 1).min(width - 1), (y + 1).min(height - 1));
    let (a, b) = (p.x - x as f64, p.y - y as f64);
    let row = |y: usize| (1.0 - a) * picture.level_at(x, y) + a * picture.level_at(right, y);
    (1.0 - b) * row(y) + b * row(below)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may stop the process")]
mod tests {
    use super::*;
    use scene::field::Grid;

    #[test]
    fn a_click_beside_a_circle_leads_along_it_and_no_farther_than_asked() {
        let center = DVec2::new(50.0, 50.0);
        let level = |(y, x): (usize, usize)| {
            let p = DVec2::new(x as f64, y as f64);
            40.0 + 150.0 * (30.5 - p.distance(center)).clamp(0.0, 1.0)
        };
        let picture = Picture::from_levels(Grid::from_shape_fn((100, 100), level));
        let edge = ridge(&picture, DVec2::new(82.0, 51.0), 20.0).unwrap();
        assert!(edge.len() > 30 && edge.len() < 46, "{}", edge.len());
        for p in &edge {
            assert!((p.distance(center) - 30.0).abs() < 1.0, "{p}");
        }
        assert!(ridge(&picture, DVec2::new(50.0, 50.0), 20.0).is_none());
    }
}

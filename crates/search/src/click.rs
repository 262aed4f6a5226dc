//! The search from a single place inside an object of unknown size.

use field::Pixels;
use glam::DVec2;

use crate::along::Polygon;
use crate::find::{Searched, Stopped, find_unless};
use crate::rules::Rules;

/// The smallest radius that is tried, and how each is larger than the last. Pixels.
const SMALLEST: f64 = 3.0;
const LARGER: f64 = 1.6;

/// The largest radius, as a share of the picture's shorter side.
const LARGEST: f64 = 0.5;

/// The power of an outline's radius that counts beside its edge: of many small closed curves in noise or texture one
/// has a strong edge by chance.
const SIZE: f64 = 0.4;

/// Points of the circles.
const POINTS: u32 = 64;

/// Look for the outline around a place: circles of growing size are tried, and the outline that is closed best for
/// its size is taken, the first of equals. None for a place outside the picture.
#[must_use]
pub fn find_around(pixels: &dyn Pixels, place: DVec2, rules: &Rules) -> Option<Searched> {
    find_around_unless(pixels, place, rules, &|| false)
        .ok()
        .flatten()
}

/// [`find_around`] that ends early when `asked` says so, as [`find_unless`] does.
///
/// # Errors
///
/// [`Stopped`] where `asked` has said yes.
pub fn find_around_unless(
    pixels: &dyn Pixels,
    place: DVec2,
    rules: &Rules,
    asked: &dyn Fn() -> bool,
) -> Result<Option<Searched>, Stopped> {
    let (width, height) = pixels.size();
    let size = DVec2::new(width as f64, height as f64);
    if !(place + 0.5).cmpge(DVec2::ZERO).all() || !(place + 0.5).cmple(size).all() {
        return Ok(None);
    }
    // a small window within an object takes its texture for edges, and any region in it has some
    let rules = &Rules {
        pure: 1.0,
        ..*rules
    };
    let mut best: Option<Searched> = None;
    let mut radius = SMALLEST;
    while radius <= LARGEST * size.min_element().max(2.0 * SMALLEST) {
        let turn = |i| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / f64::from(POINTS));
        let points = (0..POINTS).map(|i| place + radius * turn(i)).collect();
        let circle = Polygon {
            points,
            closed: true,
        };
        let found = find_unless(pixels, &circle, rules, asked)?;
        // an outline that leaves the place out is that of something else
        let found = found.filter(|found| outline::winding(&found.taken().points, place) != Some(0));
        if let Some(found) = found {
            let better = best
                .as_ref()
                .is_none_or(|known| worth(&found) > worth(known));
            if better {
                best = Some(found);
            }
        }
        radius *= LARGER;
    }
    Ok(best)
}

/// What speaks for an outline among others of other sizes: that of the start counts that it was found from.
fn worth(found: &Searched) -> f64 {
    let radius = found.seen.radius * found.pixel;
    found.taken().support.whole() * radius.powf(SIZE)
}

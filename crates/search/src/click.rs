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
const SIZE: f64 = 0.3;

/// The power of the number of circles that lead to an outline of its area, and by which factor areas are alike.
const AGAIN: f64 = 0.2;
const ALIKE: f64 = 1.2;

/// Points of the circles.
const POINTS: u32 = 64;

/// Places beside a click whose outlines are compared with its own, and how far they are from it, in radii of a disk of
/// its area.
const BESIDE: u32 = 4;
const APART: f64 = 0.3;

/// From those places sizes are tried from this share of the outline's to its inverse.
const SMALLER: f64 = 0.25;

/// Points across a box about two outlines that say how much they overlap.
const ACROSS: u32 = 48;

/// Look for the outline around a place: circles of growing size are tried, and the outline is taken that is closed
/// best for its size and for how many circles lead to it, the first of equals. None for a place outside the picture.
///
/// The same is done from places beside it within that outline: [`Searched::steady`] says how far they agree.
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
    let largest = LARGEST * size.min_element().max(2.0 * SMALLEST);
    let about = |place, sizes| {
        best_of(place, sizes, &|start| {
            find_unless(pixels, start, rules, asked)
        })
    };
    let Some(mut best) = about(place, (0.0, largest))? else {
        return Ok(None);
    };
    let outline = Polygon {
        points: best.taken().points.clone(),
        closed: true,
    };
    let radius = (outline.area() / std::f64::consts::PI).sqrt();
    let own = outline.points;
    let sizes = (SMALLER * radius, largest.min(radius / SMALLER));
    let turn =
        |k| DVec2::from_angle(std::f64::consts::TAU * (f64::from(k) + 0.5) / f64::from(BESIDE));
    let places = (0..BESIDE).map(|k| place + APART * radius * turn(k));
    let is_in = |p: &DVec2| {
        ::outline::winding(&own, *p) != Some(0)
            && (*p + 0.5).cmpge(DVec2::ZERO).all()
            && (*p + 0.5).cmple(size).all()
    };
    let mut overlaps = Vec::new();
    for beside in places.filter(is_in) {
        let other = about(beside, sizes)?;
        overlaps.extend(other.map(|other| overlap(&own, &other.taken().points)));
    }
    if !overlaps.is_empty() {
        best.steady = Some(overlaps.iter().sum::<f64>() / overlaps.len() as f64);
    }
    Ok(Some(best))
}

/// The best outline about a place from circles of radii from one to another.
fn best_of(
    place: DVec2,
    (least, most): (f64, f64),
    search: &dyn Fn(&Polygon) -> Result<Option<Searched>, Stopped>,
) -> Result<Option<Searched>, Stopped> {
    // with their areas and the radii of the circles
    let mut found: Vec<(Searched, f64, f64)> = Vec::new();
    let mut radius = SMALLEST;
    while radius <= most {
        if radius >= least {
            let turn =
                |i| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / f64::from(POINTS));
            let start = Polygon {
                points: (0..POINTS).map(|i| place + radius * turn(i)).collect(),
                closed: true,
            };
            // an outline that leaves the place out is that of something else
            let one = search(&start)?
                .filter(|one| outline::winding(&one.taken().points, place) != Some(0));
            found.extend(one.map(|one| {
                let outline = Polygon {
                    points: one.taken().points.clone(),
                    closed: true,
                };
                let area = outline.area();
                (one, area, radius)
            }));
        }
        radius *= LARGER;
    }
    let worth = |(one, area, radius): &(Searched, f64, f64)| {
        let alike = |other: &f64| other.max(*area) <= ALIKE * other.min(*area);
        let again = found.iter().filter(|(_, other, _)| alike(other)).count();
        one.taken().support.throughout() * radius.powf(SIZE) * (again as f64).powf(AGAIN)
    };
    let values: Vec<f64> = found.iter().map(worth).collect();
    let first = (0..values.len())
        .rev()
        .max_by(|a, b| values[*a].total_cmp(&values[*b]));
    Ok(first.map(|first| found.swap_remove(first).0))
}

/// How much two outlines have in common of what both enclose, by points of a grid.
fn overlap(a: &[DVec2], b: &[DVec2]) -> f64 {
    let all = || a.iter().chain(b).copied();
    let low = all().fold(DVec2::INFINITY, DVec2::min);
    let cell = (all().fold(DVec2::NEG_INFINITY, DVec2::max) - low) / f64::from(ACROSS);
    let (mut both, mut either) = (0_u32, 0_u32);
    for row in 0..ACROSS {
        for column in 0..ACROSS {
            let p = low + cell * (DVec2::new(f64::from(column), f64::from(row)) + 0.5);
            let [a, b] = [a, b].map(|curve| outline::winding(curve, p) != Some(0));
            both += u32::from(a && b);
            either += u32::from(a || b);
        }
    }
    f64::from(both) / f64::from(either.max(1))
}

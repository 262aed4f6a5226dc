//! Pictures drawn from numbers.

use field::drawn::{noisy, rounded};
use field::{EdgeForce, Grid, Smoothing};
use glam::DVec2;

use io::Picture;

use super::{number, smoothing};
use crate::SceneError;
use crate::file::{DrawnText, RegionText};
use crate::limits::{MOST_CORNERS, MOST_DRAWN};

/// A picture drawn from numbers: a region on a ground, blurred, with noise from a seed.
///
/// A pixel's level is the share of an 8 × 8 grid of points in its square that lies in the
/// region, between ground and region; then a Gaussian blur, then white noise, then rounding to
/// whole levels 0 … 255.
pub(super) fn picture(text: &DrawnText) -> Result<Picture, SceneError> {
    let key =
        |name: &str, message: String| SceneError::key(&format!("picture.drawn.{name}"), message);
    let [width, height] = text.size;
    let pixels = (width as u64).saturating_mul(height as u64);
    if pixels == 0 || pixels > MOST_DRAWN {
        let message =
            format!("got {width} × {height}; needed: from 1 × 1 to {MOST_DRAWN} pixels in all");
        return Err(key("size", message));
    }
    for (name, value, most) in [
        ("blur", text.blur, 1000.0),
        ("noise", text.noise, 1000.0),
        ("background", text.background, 255.0),
        ("foreground", text.foreground, 255.0),
    ] {
        if !(0.0..=most).contains(&value) {
            return Err(key(name, format!("got {value}; needed: from 0 to {most}")));
        }
    }
    check_region(&text.region)?;
    // each by itself: those of a list are looked at one after another
    let regions: Vec<&RegionText> = match &text.region {
        RegionText::Any(list) => list.iter().collect(),
        one => vec![one],
    };
    let share = |center: DVec2| {
        // each region is convex: with its four outermost points a pixel is inside as a whole
        let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        let whole = |region: &&RegionText| {
            let mut corners = corners.iter();
            corners.all(|&(i, j)| inside(region, center + DVec2::new(i, j) * (7.0 / 16.0)))
        };
        if regions.iter().any(whole) {
            return 1.0;
        }
        let mut share = 0.0;
        for j in 0..8 {
            for i in 0..8 {
                let offset = DVec2::new(f64::from(2 * i + 1), f64::from(2 * j + 1)) / 16.0 - 0.5;
                if regions.iter().any(|region| inside(region, center + offset)) {
                    share += 1.0 / 64.0;
                }
            }
        }
        share
    };
    let mut levels = Grid::from_shape_fn((height, width), |(y, x)| {
        let share = share(DVec2::new(x as f64, y as f64));
        text.background + (text.foreground - text.background) * share
    });
    if text.blur > 0.0 {
        let gaussian = Smoothing::Gaussian(text.blur);
        let blur = EdgeForce {
            smoothing: smoothing("picture.drawn.blur", gaussian, (width, height))?,
            gain: 1.0,
        };
        levels = field::edge_stages(&levels, &blur)
            .map_err(|error| key("blur", error.to_string()))?
            .smoothed;
    }
    if text.noise > 0.0 {
        levels = noisy(&levels, text.noise, text.seed);
    }
    Ok(Picture::from_levels(rounded(&levels)))
}

/// Whether a place is in a region that is no list.
fn inside(region: &RegionText, p: DVec2) -> bool {
    match region {
        RegionText::RightOf(x) => p.x > *x,
        RegionText::Box([x0, y0, x1, y1]) => {
            (*x0..=*x1).contains(&p.x) && (*y0..=*y1).contains(&p.y)
        }
        RegionText::Circle(c) => p.distance(DVec2::from_array(c.center)) <= c.radius,
        RegionText::Ellipse(e) => {
            let turned = DVec2::from_angle(-e.angle).rotate(p - DVec2::from_array(e.center));
            (turned / DVec2::from_array(e.axes)).length_squared() <= 1.0
        }
        RegionText::Road(road) => road.points.windows(2).any(|pair| {
            let (a, b) = (DVec2::from_array(pair[0]), DVec2::from_array(pair[1]));
            let along = b - a;
            let share = (p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
            p.distance(a + along * share.clamp(0.0, 1.0)) <= 0.5 * road.width
        }),
        RegionText::Any(_) => false, // a list in a list is refused
    }
}

/// Refuse a region whose numbers describe none.
fn check_region(region: &RegionText) -> Result<(), SceneError> {
    let at = |name: &str| format!("picture.drawn.region.{name}");
    match region {
        RegionText::Any(list) => {
            let nested = list.iter().any(|one| matches!(one, RegionText::Any(_)));
            if nested || !(1..=MOST_CORNERS).contains(&list.len()) {
                let message = format!("needed: 1 to {MOST_CORNERS} regions that are no lists");
                return Err(SceneError::key("picture.drawn.region.any", message));
            }
            list.iter().try_for_each(check_region)
        }
        RegionText::Road(road) => {
            number::length(&at("road.width"), road.width)?;
            let points = road.points.iter().map(|&p| DVec2::from_array(p));
            number::places(&at("road.points"), &points.collect::<Vec<_>>())?;
            if (2..=MOST_CORNERS).contains(&road.points.len()) {
                Ok(())
            } else {
                let (got, most) = (road.points.len(), MOST_CORNERS);
                let message = format!("has {got} places; needed: from 2 to {most}");
                Err(SceneError::key(&at("road.points"), message))
            }
        }
        RegionText::RightOf(x) => number::coordinate(&at("right-of"), *x).map(drop),
        RegionText::Box([x0, y0, x1, y1]) => {
            number::place(&at("box"), [*x0, *y0])?;
            number::place(&at("box"), [*x1, *y1]).map(drop)
        }
        RegionText::Circle(c) => {
            number::place(&at("circle.center"), c.center)?;
            number::length(&at("circle.radius"), c.radius).map(drop)
        }
        RegionText::Ellipse(e) => {
            number::place(&at("ellipse.center"), e.center)?;
            number::finite(&at("ellipse.angle"), e.angle)?;
            number::length(&at("ellipse.axes"), e.axes[0])?;
            number::length(&at("ellipse.axes"), e.axes[1]).map(drop)
        }
    }
}

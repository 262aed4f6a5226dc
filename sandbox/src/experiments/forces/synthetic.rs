//! Pictures whose truth is a formula, and the U that forces are tried on.
//!
//! A scene's `[picture.drawn]` draws such pictures too, but in whole grey levels, and no edge at an
//! angle; what is measured here to a hundredth of a pixel needs both.

use crate::prelude::*;
pub(super) use field::drawn::{noisy, rounded};
use field::{Grid, Line, Smoothing, drawn, line_strength};
use scene::ForceChoice;
use scene::fit::{Contour, Image, Options, Prepared, Session};

/// Grey level of the object.
pub(super) const OBJECT: f64 = 200.0;
/// Grey level around it.
pub(super) const AROUND: f64 = 60.0;
/// Edge length of the picture of the U.
pub(super) const SIZE: usize = 256;
/// Panels in a row.
const ROW: usize = 5;
/// Corners of the U: a square of 140 px with a slot of 50 px, 92 px deep, from above.
const CORNERS: [(f64, f64); 8] = [
    (58.0, 58.0),
    (103.0, 58.0),
    (103.0, 150.0),
    (153.0, 150.0),
    (153.0, 58.0),
    (198.0, 58.0),
    (198.0, 198.0),
    (58.0, 198.0),
];

/// A region drawn.
pub(super) fn covered(dim: (usize, usize), inside: impl Fn(DVec2) -> bool) -> Grid {
    drawn::covered(dim, inside, (OBJECT, AROUND))
}

/// The same, blurred by a Gaussian.
pub(super) fn blurred(picture: &Grid, sigma: f64) -> Result<Grid> {
    // the strength of bright lines is the smoothed picture itself
    Ok(line_strength(
        picture,
        Smoothing::Gaussian(sigma),
        Line::Bright,
    )?)
}

/// The U, blurred by one pixel and rounded to whole grey levels.
pub(super) fn u_shape() -> Result<Grid> {
    let sharp = covered((SIZE, SIZE), |p| {
        let square = p.cmpge(DVec2::splat(58.0)).all() && p.cmple(DVec2::splat(198.0)).all();
        square && !(p.x > 103.0 && p.x < 153.0 && p.y < 150.0)
    });
    Ok(rounded(&blurred(&sharp, 1.0)?))
}

/// The corners of its outline.
pub(super) fn u_corners() -> Vec<DVec2> {
    CORNERS.map(DVec2::from).to_vec()
}

/// Points of a closed polygon with its outward normal, so far apart on each of its edges and so far
/// from the edge's ends.
pub(super) fn along(corners: &[DVec2], apart: f64, inset: f64) -> Vec<(DVec2, DVec2)> {
    let mut out = Vec::new();
    for (i, &from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % corners.len()];
        let unit = (to - from).normalize();
        let mut way = inset;
        while way < from.distance(to) - inset {
            out.push((from + unit * way, -unit.perp()));
            way += apart;
        }
    }
    out
}

/// The scene of `snake fit` with forces as typed behind `--force`, several joined by a plus; the
/// default for none.
pub(super) fn fit(image: &Grid, start: &[DVec2], forces: &str) -> Result<Session> {
    let chosen = forces.split('+').filter(|force| !force.is_empty());
    let chosen: std::result::Result<Vec<_>, _> = chosen.map(ForceChoice::parse).collect();
    let chosen = chosen.map_err(refused)?.into_iter();
    let options = Options {
        forces: chosen.map(ForceChoice::for_fit).collect(),
        ..Options::motion()
    };
    let prepared = Prepared::of(&Image::grey(image.clone()), &options)?;
    Ok(prepared.session(&Contour::closed(start.to_vec()))?)
}

/// Mean distance of a closed polygon from another, by points at most a pixel apart.
pub(super) fn mean_distance(of: &[DVec2], from: &[DVec2]) -> f64 {
    let (mut sum, mut length) = (0.0, 0.0);
    for (i, &a) in of.iter().enumerate() {
        let b = of[(i + 1) % of.len()];
        let mut pieces = 1.0;
        while a.distance(b) > pieces {
            pieces += 1.0;
        }
        let step = a.distance(b) / pieces;
        let mut k = 0.5;
        while k < pieces {
            sum += step * outline::distance(from, true, a.lerp(b, k / pieces));
            k += 1.0;
        }
        length += a.distance(b);
    }
    if length > 0.0 {
        return sum / length;
    }
    let first = of.first();
    first.map_or(f64::NAN, |&p| outline::distance(from, true, p))
}

/// A panel with the U, pale.
pub(super) fn over_u(title: String, image: &Grid) -> Panel {
    let ground = Picture::new(grey(image)).faded(0.35);
    Panel::pixels(title, SIZE, SIZE).bare().with(ground)
}

/// Panels in rows of five, the last filled up.
pub(super) fn in_rows(title: &str, panels: &[Panel]) -> Figure {
    let empty = || Panel::pixels("", SIZE, SIZE).bare();
    let rows = panels.chunks(ROW).map(|row| {
        let mut row = row.to_vec();
        row.resize_with(ROW, empty);
        row
    });
    rows.fold(Figure::new(title, 940.0), |figure, row| {
        figure.with(212.0, row)
    })
}

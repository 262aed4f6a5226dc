//! Pictures whose truth is a formula: a region of one grey on another, as a camera would see it.

use crate::{SandboxError, real};
use field::{Grid, Line, Smoothing, line_strength};
use glam::DVec2;

/// Grey level of the object.
pub(super) const OBJECT: f64 = 200.0;
/// Grey level around it.
pub(super) const AROUND: f64 = 60.0;
/// Edge length of the picture of the U.
pub(super) const SIZE: usize = 256;
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

/// A region drawn: each pixel by the share of 8 × 8 points of it that lie inside.
pub(super) fn covered(dim: (usize, usize), inside: impl Fn(DVec2) -> bool) -> Grid {
    Grid::from_shape_fn(dim, |(row, column)| {
        let corner = DVec2::new(real(column), real(row)) - 0.5;
        let points = (0..64_usize).filter(|point| {
            let step = DVec2::new(real(point % 8), real(point / 8));
            inside(corner + (2.0 * step + 1.0) / 16.0)
        });
        AROUND + (OBJECT - AROUND) * real(points.count()) / 64.0
    })
}

/// The same, blurred by a Gaussian.
pub(super) fn blurred(id: &'static str, picture: &Grid, sigma: f64) -> Result<Grid, SandboxError> {
    // the strength of bright lines is the smoothed picture itself
    line_strength(picture, Smoothing::Gaussian(sigma), Line::Bright)
        .map_err(SandboxError::refused(id))
}

/// The U, blurred by one pixel and rounded to whole grey levels.
pub(super) fn u_shape(id: &'static str) -> Result<Grid, SandboxError> {
    let sharp = covered((SIZE, SIZE), |p| {
        let square = p.cmpge(DVec2::splat(58.0)).all() && p.cmple(DVec2::splat(198.0)).all();
        square && !(p.x > 103.0 && p.x < 153.0 && p.y < 150.0)
    });
    Ok(rounded(&blurred(id, &sharp, 1.0)?))
}

/// The corners of its outline.
pub(super) fn u_corners() -> Vec<DVec2> {
    CORNERS.map(DVec2::from).to_vec()
}

/// Its outline, a point every pixel or less.
pub(super) fn u_outline() -> Vec<DVec2> {
    let corners = u_corners();
    let mut out = Vec::new();
    for (i, &from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % corners.len()];
        let mut step = 0.0;
        while step < from.distance(to) {
            out.push(from + (to - from).normalize() * step);
            step += 1.0;
        }
    }
    out
}

/// White noise of a standard deviation, added to every pixel: splitmix64 and Box and Muller.
pub(super) fn noisy(picture: &Grid, deviation: f64, seed: u64) -> Grid {
    let mut numbers = 2 * (seed << 31)..;
    let mut uniform = || {
        let z = mixed(numbers.next().unwrap_or(0));
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit a double")]
        let number = (z >> 11) as f64;
        number / 2.0_f64.powi(53)
    };
    picture.mapv(|level| {
        let (a, b) = (uniform(), uniform());
        let size = (-2.0 * (a + 2.0_f64.powi(-53)).ln()).sqrt();
        level + deviation * size * (std::f64::consts::TAU * b).cos()
    })
}

fn mixed(number: u64) -> u64 {
    let z = number.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// Eight bits: whole grey levels, halves upwards.
pub(super) fn rounded(picture: &Grid) -> Grid {
    picture.mapv(|level| (level.clamp(0.0, 255.0) + 0.5).floor())
}

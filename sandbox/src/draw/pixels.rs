//! Grids as colors and arrows: pictures and fields.

use super::palette::{Color, diverging};
use super::panel::Layer;
use crate::real;
use ndarray::{Array2, s};

/// Grey levels 0 to 255 as colors.
#[must_use]
pub fn grey(levels: &Array2<f64>) -> Array2<Color> {
    levels.mapv(|level| Color(0, 0, 0).mix(Color::WHITE, level / 255.0))
}

/// The mean of every so many pixels by as many: what a drawing at a smaller size needs.
#[must_use]
pub fn shrunk(grid: &Array2<f64>, factor: usize) -> Array2<f64> {
    let (rows, columns) = grid.dim();
    let mean = |(row, column): (usize, usize)| {
        let (top, left) = (row * factor, column * factor);
        grid.slice(s![top..top + factor, left..left + factor])
            .mean()
            .unwrap_or(0.0)
    };
    Array2::from_shape_fn((rows / factor, columns / factor), mean)
}

/// A signed grid as colors; full color at the size that the given share of the pixels stays below.
#[must_use]
pub fn signed(grid: &Array2<f64>, share: f64) -> Array2<Color> {
    let mut sizes: Vec<f64> = grid.iter().map(|value| value.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    #[expect(clippy::cast_possible_truncation, reason = "a share of a count")]
    #[expect(clippy::cast_sign_loss, reason = "a share of a count")]
    let place = (share * real(sizes.len() - 1)) as usize;
    let full = sizes[place].max(f64::MIN_POSITIVE);
    // forty steps of color are as many as one sees, and make a small file
    grid.mapv(|value| diverging((value / full * 20.0).round() / 20.0))
}

/// Arrows in a window (left, top, columns, rows), as long as the root of the force, so that weak ones
/// are seen beside strong ones; those below a share of the strongest are left out. One for each cell
/// of so many pixels: in its middle.
#[must_use]
pub fn arrows(
    fx: &Array2<f64>,
    fy: &Array2<f64>,
    every: usize,
    least: f64,
    window: [usize; 4],
) -> Layer {
    let [left, top, columns, rows] = window;
    let places = (top + every / 2..top + rows)
        .step_by(every)
        .flat_map(|row| {
            (left + every / 2..left + columns)
                .step_by(every)
                .map(move |c| (row, c))
        })
        .collect();
    draw(fx, fy, places, every, least)
}

/// As [`arrows`], but each stands where the force is strongest in its cell: in a large picture an edge
/// would pass between the middles unseen.
#[must_use]
pub fn strongest_arrows(fx: &Array2<f64>, fy: &Array2<f64>, every: usize, least: f64) -> Layer {
    let (rows, columns) = fx.dim();
    let size = |at: (usize, usize)| fx[at].hypot(fy[at]);
    let mut places = Vec::new();
    for top in (0..rows).step_by(every) {
        for left in (0..columns).step_by(every) {
            let cell = (top..(top + every).min(rows))
                .flat_map(|row| (left..(left + every).min(columns)).map(move |c| (row, c)));
            places.extend(cell.max_by(|&a, &b| size(a).total_cmp(&size(b))));
        }
    }
    draw(fx, fy, places, every, least)
}

fn draw(
    fx: &Array2<f64>,
    fy: &Array2<f64>,
    places: Vec<(usize, usize)>,
    every: usize,
    least: f64,
) -> Layer {
    let size = |at: (usize, usize)| fx[at].hypot(fy[at]);
    let largest = places
        .iter()
        .map(|&at| size(at))
        .fold(f64::MIN_POSITIVE, f64::max);
    let arrows = places
        .into_iter()
        .filter(|&at| size(at) > least * largest)
        .map(|at| {
            let length = 1.25 * real(every) * (size(at) / largest).sqrt() / size(at);
            ((real(at.1), real(at.0)), (fx[at] * length, fy[at] * length))
        })
        .collect();
    Layer::Arrows {
        arrows,
        color: Color::RED,
    }
}

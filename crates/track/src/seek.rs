//! An object looked for by its appearance, wherever it may have gone.

use glam::DVec2;

use crate::palette::Palette;
use crate::ring;
use crate::window::Window;

/// Side of the squares that cells are gathered in, in radii; width of the ring around the object; sizes that are tried.
const SQUARE: f64 = 0.125;
const RING: f64 = 0.35;
const SIZES: [f64; 3] = [0.85, 1.0, 1.18];

/// Price of another size, and of the distance from the prediction at the reach.
const OTHER_SIZE: f64 = 0.05;
const FAR: f64 = 0.2;

/// Share of the object that must lie in the frame.
const SHARE: f64 = 0.15;

/// How many places are handed on.
const MOST: usize = 3;

/// Where an object may be: places and sizes, the best first. `ratio` says how much likelier a class is in the object
/// than
/// around it; `reach` how far from the prediction it may be; squares of the window that others cover count as ground.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "squares of a window of some hundred cells"
)]
pub(crate) fn sought(
    window: &Window,
    palette: &Palette,
    ratio: &dyn Fn(u8) -> f64,
    curve: &[DVec2],
    reach: f64,
) -> Vec<Vec<DVec2>> {
    let radius = ring::radius(curve);
    let side = (SQUARE * radius).max(1.0);
    let (columns, rows) = (
        (window.width as f64 / side).ceil() as usize,
        (window.height as f64 / side).ceil() as usize,
    );
    let corner = DVec2::new(window.left as f64, window.top as f64) - 0.5;
    // sums and counts of each square
    let mut map = vec![[0.0_f64; 2]; columns * rows];
    for y in 0..window.height {
        for x in 0..window.width {
            let Some(class) = window.class_at(y * window.width + x, palette) else {
                continue;
            };
            let at =
                ((y as f64 + 0.5) / side) as usize * columns + ((x as f64 + 0.5) / side) as usize;
            map[at][0] += ratio(class);
            map[at][1] += 1.0;
        }
    }
    let center = ring::middle(curve);
    let best_of = |size: f64| -> Vec<(f64, DVec2)> {
        let scaled: Vec<DVec2> = curve
            .iter()
            .map(|p| (size * (*p - center)) / side)
            .collect();
        let wide: Vec<DVec2> = scaled.iter().map(|p| *p * (1.0 + RING)).collect();
        let (inner, all) = (squares(&scaled), squares(&wide));
        let beside: Vec<(isize, isize)> = all
            .iter()
            .filter(|at| !inner.contains(at))
            .copied()
            .collect();
        let mut scores = Vec::with_capacity(columns * rows);
        let mean = |list: &[(isize, isize)], x: usize, y: usize| -> ([f64; 2], f64) {
            let (mut sum, mut found) = ([0.0; 2], 0.0);
            for (i, j) in list {
                let (u, v) = (x.cast_signed() + i, y.cast_signed() + j);
                if u >= 0 && v >= 0 && u < columns.cast_signed() && v < rows.cast_signed() {
                    let one = map[v.unsigned_abs() * columns + u.unsigned_abs()];
                    sum[0] += one[0];
                    sum[1] += one[1];
                    found += f64::from(u8::from(one[1] > 0.0));
                }
            }
            (sum, found / list.len().max(1) as f64)
        };
        for y in 0..rows {
            for x in 0..columns {
                let place = corner + side * (DVec2::new(x as f64, y as f64) + 0.5);
                let far = place.distance(center) / reach;
                if far > 1.0 {
                    scores.push((f64::NEG_INFINITY, place));
                    continue;
                }
                let (sum, share) = mean(&inner, x, y);
                let (around, _) = mean(&beside, x, y);
                let value = if share < SHARE {
                    f64::NEG_INFINITY
                } else {
                    let ring = if around[1] > 0.0 {
                        around[0] / around[1]
                    } else {
                        0.0
                    };
                    0.5 * (sum[0] / sum[1].max(1.0) - ring) * share.sqrt() - FAR * far * far
                };
                let other = if (size - 1.0).abs() > 1e-9 {
                    OTHER_SIZE
                } else {
                    0.0
                };
                scores.push((value - other, place));
            }
        }
        peaks(&scores, columns)
    };
    let mut found: Vec<(f64, DVec2, f64)> = SIZES
        .iter()
        .flat_map(|&size| {
            best_of(size)
                .into_iter()
                .map(move |(value, place)| (value, place, size))
        })
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(MOST);
    let laid =
        |place: DVec2, size: f64| curve.iter().map(|p| place + size * (*p - center)).collect();
    found
        .into_iter()
        .map(|(_, place, size)| laid(place, size))
        .collect()
}

/// Squares whose middle lies inside a curve about the origin.
#[allow(clippy::cast_possible_truncation, reason = "a few squares")]
fn squares(curve: &[DVec2]) -> Vec<(isize, isize)> {
    let low = curve.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = curve.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let mut squares = Vec::new();
    for y in low.y.floor() as isize..=high.y.ceil() as isize {
        for [from, to] in ring::spans(curve, y as f64) {
            squares.extend((from.ceil() as isize..=to.floor() as isize).map(|x| (x, y)));
        }
    }
    squares
}

/// The two highest local maxima.
fn peaks(scores: &[(f64, DVec2)], columns: usize) -> Vec<(f64, DVec2)> {
    let rows = scores.len() / columns.max(1);
    let mut peaks = Vec::new();
    for (at, one) in scores.iter().enumerate() {
        if !one.0.is_finite() {
            continue;
        }
        let (x, y) = (at % columns, at / columns);
        let near = |i: usize, j: usize| scores[j * columns + i].0;
        let highest = (y.saturating_sub(1)..=(y + 1).min(rows - 1))
            .flat_map(|j| (x.saturating_sub(1)..=(x + 1).min(columns - 1)).map(move |i| (i, j)))
            .all(|(i, j)| near(i, j) <= one.0);
        if highest {
            peaks.push(*one);
        }
    }
    peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
    peaks.truncate(2);
    peaks
}

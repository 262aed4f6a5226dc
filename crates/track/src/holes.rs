//! Pixels that do not count: filled from what lies beside them, so that there is no edge, and known to say nothing.

use field::Grid;
use fit::Image;
use ndarray::Array2;

/// A frame whose pixels that do not count lie between those that do, row by row. They still do not count.
pub(crate) fn filled(frame: &Image) -> Image {
    let pixels = frame.pixels();
    let Some(valid) = pixels.valid().filter(|valid| valid.iter().any(|ok| !ok)) else {
        return frame.clone();
    };
    let (width, height) = pixels.size();
    let image = if pixels.is_color() {
        let channel = |k: usize| {
            let level = |(y, x)| pixels.color(x, y)[k];
            bridged(Grid::from_shape_fn((height, width), level), valid)
        };
        Image::color([0, 1, 2].map(channel)).ok()
    } else {
        Some(Image::grey(bridged(pixels.levels().clone(), valid)))
    };
    let masked = image.and_then(|image| image.with_mask(valid.clone()).ok());
    masked.unwrap_or_else(|| frame.clone())
}

/// Levels that count, and straight lines between them along rows; a row without any is as the one before it.
fn bridged(mut levels: Grid, valid: &Array2<bool>) -> Grid {
    let (height, width) = levels.dim();
    let known: Vec<Vec<usize>> = (0..height)
        .map(|y| (0..width).filter(|&x| valid[[y, x]]).collect())
        .collect();
    for (y, known) in known.iter().enumerate() {
        let (Some(&first), Some(&last)) = (known.first(), known.last()) else {
            continue;
        };
        for x in 0..first {
            levels[[y, x]] = levels[[y, first]];
        }
        for x in last + 1..width {
            levels[[y, x]] = levels[[y, last]];
        }
        for pair in known.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            for x in from + 1..to {
                let share = (x - from) as f64 / (to - from) as f64;
                levels[[y, x]] = levels[[y, from]] + share * (levels[[y, to]] - levels[[y, from]]);
            }
        }
    }
    let whole = |y: &usize| !known[*y].is_empty();
    let Some(first) = (0..height).find(whole) else {
        return levels;
    };
    let mut from = first;
    for y in (0..first).rev().chain(first..height) {
        from = if y < first {
            first
        } else if known[y].is_empty() {
            from
        } else {
            y
        };
        for x in 0..width {
            levels[[y, x]] = levels[[from, x]];
        }
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_bridged_along_rows_and_rows_without_a_pixel_are_as_those_beside_them() {
        let levels = Grid::from_shape_fn((5, 6), |(y, x)| (10 * y + x) as f64);
        let hole =
            |y: usize, x: usize| y == 0 || y == 3 || (y == 1 && x < 2) || (2..4).contains(&x);
        let valid = Array2::from_shape_fn((5, 6), |(y, x)| !hole(y, x));
        let wrong = Grid::from_shape_fn((5, 6), |(y, x)| {
            if hole(y, x) {
                f64::from(1e6_f32)
            } else {
                levels[[y, x]]
            }
        });
        let got = bridged(wrong, &valid);
        let row = |y: f64| [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|x| 10.0 * y + x);
        // its first known pixel is the fifth
        let second = [14.0, 14.0, 14.0, 14.0, 14.0, 15.0];
        let want = [second, second, row(2.0), row(2.0), row(4.0)];
        for (y, want) in want.iter().enumerate() {
            for (x, want) in want.iter().enumerate() {
                assert!(
                    (got[[y, x]] - want).abs() < 1e-9,
                    "{y} {x}: {}",
                    got[[y, x]]
                );
            }
        }
    }
}

//! A square of pixels about a place between pixels.

use ndarray::Array2;

/// The square of `side` × `side` samples about (x, y), at distances of one pixel, linear between pixels; beyond the
/// border the last pixel is repeated.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "clamped to the picture"
)]
pub(crate) fn sampled(image: &Array2<f32>, x: f32, y: f32, side: usize, out: &mut [f32]) {
    let (height, width) = image.dim();
    let half = (side / 2) as f32;
    let (left, top) = (x - half, y - half);
    let (i, j) = (left.floor(), top.floor());
    let (a, b) = (left - i, top - j);
    let (i, j) = (i as isize, j as isize);
    let inner = i >= 0 && j >= 0 && i as usize + side < width && j as usize + side < height;
    if let (true, Some(pixels)) = (inner, image.as_slice()) {
        for (k, row) in out.chunks_exact_mut(side).take(side).enumerate() {
            let from = (j as usize + k) * width + i as usize;
            let upper = &pixels[from..=from + side];
            let lower = &pixels[from + width..=from + width + side];
            for (m, value) in row.iter_mut().enumerate() {
                let above = upper[m] + a * (upper[m + 1] - upper[m]);
                let below = lower[m] + a * (lower[m + 1] - lower[m]);
                *value = above + b * (below - above);
            }
        }
        return;
    }
    let column = |m: isize| m.clamp(0, width as isize - 1) as usize;
    let line = |k: isize| k.clamp(0, height as isize - 1) as usize;
    for (k, row) in out.chunks_exact_mut(side).take(side).enumerate() {
        let (upper, lower) = (line(j + k as isize), line(j + k as isize + 1));
        for (m, value) in row.iter_mut().enumerate() {
            let (here, next) = (column(i + m as isize), column(i + m as isize + 1));
            let above = image[[upper, here]] + a * (image[[upper, next]] - image[[upper, here]]);
            let below = image[[lower, here]] + a * (image[[lower, next]] - image[[lower, here]]);
            *value = above + b * (below - above);
        }
    }
}

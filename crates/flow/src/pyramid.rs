//! A picture, halved again and again.

use ndarray::Array2;

/// Weights of the smoothing before a picture is halved, on either side of the middle.
const MIDDLE: f32 = 0.375;
const BESIDE: f32 = 0.25;
const FAR: f32 = 0.0625;

/// The least side of a halved picture.
const LEAST: usize = 12;

/// A picture at several sizes: the full one first, each other half as wide and high as the one before.
#[derive(Debug, Clone)]
pub struct Pyramid {
    levels: Vec<Array2<f32>>,
}

impl Pyramid {
    /// A picture with so many sizes at most; none is made with a side of fewer than twelve pixels.
    #[must_use]
    pub fn of(image: Array2<f32>, most: usize) -> Self {
        let mut levels = vec![image];
        while levels.len() < most {
            let last = &levels[levels.len() - 1];
            let (height, width) = last.dim();
            if height.div_ceil(2) < LEAST || width.div_ceil(2) < LEAST {
                break;
            }
            let halved = halved(last);
            levels.push(halved);
        }
        Self { levels }
    }

    /// The pictures, the full one first.
    #[must_use]
    pub fn levels(&self) -> &[Array2<f32>] {
        &self.levels
    }
}

/// A picture smoothed by a binomial of five, of which every other pixel is kept; at borders the last pixel is repeated.
fn halved(image: &Array2<f32>) -> Array2<f32> {
    let (height, width) = image.dim();
    let (rows, columns) = (height.div_ceil(2), width.div_ceil(2));
    let mut out = Array2::zeros((rows, columns));
    let mut line = vec![0.0_f32; width];
    for y in 0..rows {
        let at = |d: isize| {
            let row = (2 * y).saturating_add_signed(d).min(height - 1);
            image.row(row)
        };
        let (a, b, c, d, e) = (at(-2), at(-1), at(0), at(1), at(2));
        for x in 0..width {
            line[x] = MIDDLE * c[x] + BESIDE * (b[x] + d[x]) + FAR * (a[x] + e[x]);
        }
        for x in 0..columns {
            let at = |d: isize| line[(2 * x).saturating_add_signed(d).min(width - 1)];
            out[[y, x]] = MIDDLE * at(0) + BESIDE * (at(-1) + at(1)) + FAR * (at(-2) + at(2));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halving_keeps_a_plane() {
        let plane = Array2::from_shape_fn((40, 50), |(y, x)| 3.0 * x as f32 - 2.0 * y as f32);
        let pyramid = Pyramid::of(plane, 5);
        assert_eq!(
            pyramid.levels().len(),
            2,
            "20 × 25 is the smallest with sides of 12 and more"
        );
        let half = &pyramid.levels()[1];
        assert_eq!(half.dim(), (20, 25));
        for ((y, x), level) in half
            .indexed_iter()
            .filter(|((y, x), _)| *y > 0 && *x > 0 && *y < 19 && *x < 24)
        {
            assert!(
                (level - (6.0 * x as f32 - 4.0 * y as f32)).abs() < 1e-3,
                "{x} {y} {level}"
            );
        }
    }
}

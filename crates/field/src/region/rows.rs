//! Sums over the inside of a polygon as differences of row sums along its border.

use crate::grid::Grid;
use crate::masked::MaskedImage;
use glam::DVec2;
use ndarray::Array2;

/// Walks once round a closed polygon in pieces that stay within one pixel each: `visit(row, x, height)`.
///
/// `x` is the middle of a piece, counted from the left border of the first pixel and clamped to the picture, `height`
/// how far the piece goes down, in pixels. For any S that is linear in x within a pixel, `Σ height · S(row, x)` is
/// exactly ∮ S dy, whatever the slope of the edges. What lies above or below the picture is left out.
pub(super) fn walk(
    polygon: &[DVec2],
    (height, width): (usize, usize),
    mut visit: impl FnMut(usize, f64, f64),
) {
    let Some(&last) = polygon.last() else { return };
    let wide = width as f64;
    let mut from = last;
    for &to in polygon {
        // in the rows' own count, where row k is the band from k to k + 1; always downwards
        let (sign, a, b) = if to.y > from.y {
            (1.0, from + 0.5, to + 0.5)
        } else {
            (-1.0, to + 0.5, from + 0.5)
        };
        from = to;
        let (top, bottom) = (a.y.max(0.0), b.y.min(height as f64));
        let slope = (b.x - a.x) / (b.y - a.y);
        let mut y = top;
        while y < bottom {
            let next = (y.floor() + 1.0).min(bottom);
            let row = index(y);
            let mut x = a.x + (y - a.y) * slope;
            let end = a.x + (next - a.y) * slope;
            let mut piece = |height: f64, x: f64, end: f64| {
                let middle = 0.5 * (x.clamp(0.0, wide) + end.clamp(0.0, wide));
                visit(row, middle, sign * height);
            };
            // one by one over the borders of pixels on the way; left and right of the picture there are none
            let (step, mut border) = if slope > 0.0 {
                (1.0, (x.floor() + 1.0).max(0.0))
            } else {
                (-1.0, (x.ceil() - 1.0).min(wide))
            };
            while (end - border) * step > 0.0 && (0.0..=wide).contains(&border) {
                let at = (a.y + (border - a.x) / slope).max(y).min(next);
                piece(at - y, x, border);
                (y, x) = (at, border);
                border += step;
            }
            piece(next - y, x, end);
            y = next;
        }
    }
}

/// A number that is not negative, cut to a whole one; NaN is 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "callers clamp to the picture before"
)]
pub(super) fn index(x: f64) -> usize {
    x as usize
}

/// A picture with the sums of its rows, and where a mask leaves pixels out, how many count.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RowSums {
    /// Grey levels less `offset`; 0 where a pixel does not count.
    pub(super) image: Grid,
    /// The first pixel that counts: so a constant picture is 0, and sums stay small.
    pub(super) offset: f64,
    valid: Option<Array2<bool>>,
    /// `sums[[y, x]]`: sum of row y before column x; one column more than the image.
    sums: Grid,
    counts: Option<Grid>,
    /// How many pixels count, and their sum.
    pub(super) total: Inside,
    /// Σ I² over them.
    pub(super) squares: f64,
}

/// How many pixels, cut ones by their share, and the sum of their grey levels.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Inside {
    pub(super) area: f64,
    pub(super) sum: f64,
}

impl Inside {
    pub(super) fn add(&mut self, weight: f64, other: Self) {
        self.area += weight * other.area;
        self.sum += weight * other.sum;
    }

    /// What is left of `whole` without this.
    pub(super) fn rest_of(self, whole: Self) -> Self {
        Self {
            area: whole.area - self.area,
            sum: whole.sum - self.sum,
        }
    }

    /// The mean, or that of `otherwise` where there is nothing.
    pub(super) fn mean_or(self, otherwise: f64) -> f64 {
        // sums of shares of pixels are good to some 1e-12
        if self.area > 1e-9 {
            self.sum / self.area
        } else {
            otherwise
        }
    }
}

impl RowSums {
    pub(super) fn new(picture: &MaskedImage) -> Self {
        let offset = picture.first();
        let mut image = picture.image().mapv(|v| v - offset);
        let valid = picture.valid().cloned();
        if let Some(valid) = &valid {
            ndarray::Zip::from(&mut image)
                .and(valid)
                .for_each(|v, &ok| {
                    if !ok {
                        *v = 0.0;
                    }
                });
        }
        let sums = prefix(&image);
        let counts = valid
            .as_ref()
            .map(|valid| prefix(&valid.mapv(|ok| f64::from(u8::from(ok)))));
        let width = image.ncols();
        let area = counts
            .as_ref()
            .map_or(image.len() as f64, |counts| counts.column(width).sum());
        let total = Inside {
            area,
            sum: sums.column(width).sum(),
        };
        let squares = image.iter().map(|v| v * v).sum();
        Self {
            image,
            offset,
            valid,
            sums,
            counts,
            total,
            squares,
        }
    }

    /// What row `row` holds left of `x`.
    pub(super) fn before(&self, row: usize, x: f64) -> Inside {
        let column = index(x).min(self.image.ncols() - 1);
        let part = x - column as f64;
        let sum = self.sums[[row, column]] + part * self.image[[row, column]];
        let area = self.counts.as_ref().map_or(x, |counts| {
            let (here, next) = (counts[[row, column]], counts[[row, column + 1]]);
            here + part * (next - here)
        });
        Inside { area, sum }
    }

    /// What lies inside a closed polygon of either orientation.
    pub(super) fn inside(&self, polygon: &[DVec2]) -> Inside {
        let mut inside = Inside::default();
        walk(polygon, self.image.dim(), |row, x, height| {
            inside.add(height, self.before(row, x));
        });
        if inside.area < 0.0 {
            inside = Inside {
                area: -inside.area,
                sum: -inside.sum,
            };
        }
        inside
    }

    /// The four pixels around a point, each with its weight and whether it counts.
    pub(super) fn at(&self, p: DVec2) -> Place {
        let weights = corners(p, self.image.dim());
        let (mut share, mut sum) = (0.0, 0.0);
        for (at, weight) in weights {
            if self.valid.as_ref().is_none_or(|valid| valid[at]) {
                share += weight;
                sum += weight * self.image[at];
            }
        }
        Place {
            share,
            grey: if share > 0.0 { sum / share } else { 0.0 },
        }
    }
}

/// The picture at a point: which share of the pixels around counts, and their mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) share: f64,
    pub(super) grey: f64,
}

/// The four pixels around a point with their bilinear weights; outside the picture, of the nearest point.
pub(super) fn corners(p: DVec2, (height, width): (usize, usize)) -> [([usize; 2], f64); 4] {
    let (x, tx, _) = crate::sample::cell(p.x, width);
    let (y, ty, _) = crate::sample::cell(p.y, height);
    let (right, down) = ((x + 1).min(width - 1), (y + 1).min(height - 1));
    [
        ([y, x], (1.0 - tx) * (1.0 - ty)),
        ([y, right], tx * (1.0 - ty)),
        ([down, x], (1.0 - tx) * ty),
        ([down, right], tx * ty),
    ]
}

fn prefix(image: &Grid) -> Grid {
    let (height, width) = image.dim();
    let mut sums = Grid::zeros((height, width + 1));
    for ((y, x), &value) in image.indexed_iter() {
        sums[[y, x + 1]] = sums[[y, x]] + value;
    }
    sums
}

/// The pieces of [`walk`], sorted by row, in memory that is used again.
#[derive(Debug, Clone, Default)]
pub(super) struct Crossings {
    walked: Vec<(usize, f64, f64)>,
    pieces: Vec<(f64, f64)>,
    /// Where each row of the picture begins in `pieces`; one more than there are rows.
    starts: Vec<usize>,
}

impl Crossings {
    /// Walks round a polygon. O(pixels crossed + rows).
    pub(super) fn fill(&mut self, polygon: &[DVec2], dim: (usize, usize)) {
        let Self {
            walked,
            pieces,
            starts,
        } = self;
        walked.clear();
        starts.clear();
        starts.resize(dim.0 + 2, 0);
        walk(polygon, dim, |row, x, height| {
            walked.push((row, x, height));
            starts[row + 2] += 1;
        });
        for row in 2..starts.len() {
            starts[row] += starts[row - 1];
        }
        pieces.clear();
        pieces.resize(walked.len(), (0.0, 0.0));
        for &(row, x, height) in &*walked {
            pieces[starts[row + 1]] = (x, height);
            starts[row + 1] += 1;
        }
    }

    /// Middle and height of every piece in a row.
    pub(super) fn row(&self, row: usize) -> &[(f64, f64)] {
        &self.pieces[self.starts[row]..self.starts[row + 1]]
    }
}

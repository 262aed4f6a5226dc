//! A number at every place of a picture, and the shares 0 … 1 that such numbers are made of.

use glam::DVec2;

use crate::distance::{edge_pixels, squared_distance};
use crate::edge::{EdgeForce, edge_stages};
use crate::error::{FieldError, positive};
use crate::grid::{Grid, admit};
use crate::sample::cell;
use crate::smooth::Smoothing;

/// A number at every place: bilinear between pixel centers, that of the border beyond them.
///
/// What lies between equal pixels is equal to the last bit, and nothing is ever outside [`Map::least`] to
/// [`Map::largest`].
///
/// ```
/// use field::Map;
/// use glam::DVec2;
///
/// let map = Map::new(&ndarray::array![[1.0, 3.0], [1.0, 3.0]])?;
/// assert_eq!(map.at(DVec2::new(0.25, 0.7)), 1.5);
/// assert_eq!(map.at(DVec2::new(9.0, -1.0)), 3.0);
/// # Ok::<(), field::FieldError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    values: Vec<f64>,
    width: usize,
    height: usize,
    least: f64,
    largest: f64,
}

impl Map {
    /// The map of these numbers. O(pixels).
    ///
    /// # Errors
    /// No pixels, a number that is not finite or absurdly large.
    pub fn new(values: &Grid) -> Result<Self, FieldError> {
        let values = admit(values, 1.0)?;
        let (height, width) = values.dim();
        let (least, largest) = span(&values);
        Ok(Self {
            values: values.into_raw_vec_and_offset().0,
            width,
            height,
            least,
            largest,
        })
    }

    /// The map that is `low` where the share is `from` or less, `high` where it is `to` or more, and straight between.
    ///
    /// # Errors
    /// As [`Map::new`]; a `to` that is not above `from`; a number that is not finite.
    pub fn of_shares(
        shares: &Grid,
        [from, to]: [f64; 2],
        [low, high]: [f64; 2],
    ) -> Result<Self, FieldError> {
        positive("the width of the range", to - from)?;
        let value = |share: f64| {
            let t = ((share - from) / (to - from)).clamp(0.0, 1.0);
            // both ends to the last bit, and a constant too
            if t < 1.0 {
                low + t * (high - low)
            } else {
                high
            }
        };
        Self::new(&shares.mapv(value))
    }

    /// The number at `p`. O(1). NaN where a coordinate is NaN or infinite.
    #[must_use]
    pub fn at(&self, p: DVec2) -> f64 {
        let (column, a, _) = cell(p.x, self.width);
        let (row, b, _) = cell(p.y, self.height);
        let right = usize::from(column + 1 < self.width);
        let below = if row + 1 < self.height { self.width } else { 0 };
        let first = row * self.width + column;
        let line = |at: usize| {
            let (left, right) = (self.values[at], self.values[at + right]);
            left + a * (right - left)
        };
        let (above, below) = (line(first), line(first + below));
        (above + b * (below - above)).clamp(self.least, self.largest)
    }

    /// The least number at any place.
    #[must_use]
    pub const fn least(&self) -> f64 {
        self.least
    }

    /// The largest.
    #[must_use]
    pub const fn largest(&self) -> f64 {
        self.largest
    }

    /// Columns and rows.
    #[must_use]
    pub const fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }
}

fn span(grid: &Grid) -> (f64, f64) {
    let bounds = (f64::INFINITY, f64::NEG_INFINITY);
    grid.iter().fold(bounds, |(a, b), &v| (a.min(v), b.max(v)))
}

/// How bright each pixel is: 0 at the darkest of the picture, 1 at the brightest; 0 throughout a constant.
///
/// As the shares below it is the same for a picture times any number, or at any depth.
///
/// # Errors
/// No pixels, one that is not finite or absurdly large.
pub fn grey_share(image: &Grid) -> Result<Grid, FieldError> {
    let image = admit(image, 1.0)?;
    let (least, largest) = span(&image);
    let width = largest - least;
    Ok(image.mapv(|v| {
        if width > 0.0 {
            (v - least) / width
        } else {
            0.0
        }
    }))
}

/// How much of an edge each pixel is: |∇(G ∗ I)| over the largest there is; 0 throughout a constant.
///
/// # Errors
/// What [`edge_force`](crate::edge_force) refuses.
pub fn edge_share(image: &Grid, smoothing: Smoothing) -> Result<Grid, FieldError> {
    let gain = 1.0;
    let strength = edge_stages(image, &EdgeForce { smoothing, gain })?.strength;
    Ok(over_largest(strength, image))
}

/// How much the grey levels around each pixel differ: their standard deviation under the window `G`, over the
/// largest there is; 0 throughout a constant.
///
/// ```text
/// P = √(G ∗ (I − m)² − (G ∗ (I − m))²),   m: the mean of the picture
/// ```
///
/// High where there is noise, texture or an edge.
///
/// # Errors
/// What [`edge_force`](crate::edge_force) refuses.
pub fn contrast_share(image: &Grid, window: Smoothing) -> Result<Grid, FieldError> {
    window.validate()?;
    let image = admit(image, 1.0)?;
    // about the mean, so that a bright picture keeps its digits
    let mean = image.sum() / image.len() as f64;
    let off = image.mapv(|v| v - mean);
    let (first, second) = (window.apply(&off), window.apply(&off.mapv(|v| v * v)));
    let spread = Grid::from_shape_fn(image.dim(), |at| {
        (second[at] - first[at] * first[at]).max(0.0).sqrt()
    });
    Ok(over_largest(spread, &image))
}

/// How far each pixel is from the nearest edge: 0 on it, 1 at `reach` pixels or more; 1 where there is none.
///
/// Edges are the pixels that are edge by at least `least` of the strongest, thinned as [`edge_pixels`] does.
///
/// # Errors
/// A `least` or `reach` that is not above 0, what [`edge_force`](crate::edge_force) refuses.
pub fn distance_share(
    image: &Grid,
    smoothing: Smoothing,
    least: f64,
    reach: f64,
) -> Result<Grid, FieldError> {
    positive("least", least)?;
    positive("reach", reach)?;
    let gain = 1.0;
    let strength = edge_stages(image, &EdgeForce { smoothing, gain })?.strength;
    let (_, largest) = span(&strength);
    if largest <= rounding(image) {
        return Ok(Grid::ones(image.dim()));
    }
    let edges = edge_pixels(image, smoothing, least * largest)?;
    Ok(squared_distance(&edges).mapv(|d| (d.sqrt() / reach).min(1.0)))
}

/// What a constant picture of that brightness may seem to have by rounding alone.
fn rounding(image: &Grid) -> f64 {
    let (least, largest) = span(image);
    1e-12 * least.abs().max(largest.abs())
}

fn over_largest(strength: Grid, image: &Grid) -> Grid {
    let (_, largest) = span(&strength);
    if largest <= rounding(image) {
        return Grid::zeros(strength.dim());
    }
    strength.mapv(|p| p / largest)
}

#[cfg(test)]
mod tests;

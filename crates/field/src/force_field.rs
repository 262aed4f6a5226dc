//! A force at every pixel center, and what it is in between.

use crate::error::{FieldError, OutsideField};
use crate::fast::{TileSource, tile_by_tile};
use crate::grid::Grid;
use crate::sample::{self, Flat, Interpolation};
use glam::{DMat2, DVec2};
use ndarray::{Array2, Zip};
use std::sync::Arc;

/// A force at every pixel center, whatever it was made from.
///
/// Pixel centers are at whole numbers, the first at (0, 0), x to the right and y down.
///
/// Kept in `f64`, in `f32` as [`fast_force`](crate::fast_force) makes it, or as tiles computed where they are asked
/// for ([`lazy_force`](crate::lazy_force)); who samples it cannot tell. Two fields are equal if all their forces are.
#[derive(Debug, Clone)]
pub struct ForceField {
    forces: Forces,
}

#[derive(Debug, Clone)]
enum Forces {
    Double(Array2<DVec2>),
    Single(Array2<[f32; 2]>),
    Tiles {
        tiles: Arc<dyn TileSource>,
        factor: f64,
    },
}

impl PartialEq for ForceField {
    fn eq(&self, other: &Self) -> bool {
        let same = |row, column| self.force(row, column) == other.force(row, column);
        self.dim() == other.dim()
            && (0..self.height()).all(|row| (0..self.width()).all(|column| same(row, column)))
    }
}

impl ForceField {
    /// A field from forces indexed `[[row, column]]`.
    ///
    /// # Errors
    /// No forces at all, or one that is not finite.
    pub fn new(forces: Array2<DVec2>) -> Result<Self, FieldError> {
        let (height, width) = forces.dim();
        if height == 0 || width == 0 {
            return Err(FieldError::Empty { width, height });
        }
        for ((row, column), force) in forces.indexed_iter() {
            if !force.is_finite() {
                let value = if force.x.is_finite() {
                    force.y
                } else {
                    force.x
                };
                return Err(FieldError::NotFinite { column, row, value });
            }
        }
        Ok(Self {
            forces: Forces::Double(forces.as_standard_layout().into_owned()),
        })
    }

    /// A field of `f32` forces that were checked where they were made.
    pub(crate) fn single(forces: Array2<[f32; 2]>) -> Self {
        Self {
            forces: Forces::Single(forces),
        }
    }

    /// Takes the memory of `f32` forces of this shape, or fresh memory if there is enough.
    pub(crate) fn take_single(
        &mut self,
        dim: (usize, usize),
    ) -> Result<Array2<[f32; 2]>, FieldError> {
        match std::mem::replace(&mut self.forces, Forces::Single(Array2::default((0, 0)))) {
            Forces::Single(forces) if forces.dim() == dim => Ok(forces),
            other => {
                drop(other);
                let (height, width) = dim;
                let pixels = height.saturating_mul(width);
                // asked for and given back: a failure while an array is made would end the program
                let mut probe = Vec::<[f32; 2]>::new();
                if probe.try_reserve_exact(pixels).is_err() {
                    return Err(FieldError::NoMemory {
                        width,
                        height,
                        bytes: pixels.saturating_mul(size_of::<[f32; 2]>()),
                    });
                }
                drop(probe);
                Ok(Array2::default(dim))
            }
        }
    }

    /// Replaces x components by those of another `f32` field of this shape.
    pub(crate) fn take_x_from(&mut self, other: &Self) {
        if let (Forces::Single(forces), Forces::Single(other)) = (&mut self.forces, &other.forces) {
            forces.zip_mut_with(other, |force, other| force[0] = other[0]);
        }
    }

    /// A field of tiles.
    pub(crate) fn tiles(tiles: Arc<dyn TileSource>) -> Self {
        Self {
            forces: Forces::Tiles { tiles, factor: 1.0 },
        }
    }

    /// The force at a pixel center known to be inside.
    #[inline]
    fn force(&self, row: usize, column: usize) -> DVec2 {
        match &self.forces {
            Forces::Double(forces) => forces[[row, column]],
            Forces::Single(forces) => widened(forces[[row, column]]),
            Forces::Tiles { tiles, factor } => widened(tiles.force(row, column)) * *factor,
        }
    }

    fn dim(&self) -> (usize, usize) {
        match &self.forces {
            Forces::Double(forces) => forces.dim(),
            Forces::Single(forces) => forces.dim(),
            Forces::Tiles { tiles, .. } => tiles.dim(),
        }
    }

    /// How many tiles of a lazy field have been computed so far; `None` for a field that is there as a whole.
    #[must_use]
    pub fn tiles_computed(&self) -> Option<usize> {
        match &self.forces {
            Forces::Tiles { tiles, .. } => Some(tiles.computed()),
            _ => None,
        }
    }

    /// A field from its two components.
    ///
    /// # Errors
    /// Grids of different shapes or without pixels, or a value that is not finite.
    pub fn from_components(x: &Grid, y: &Grid) -> Result<Self, FieldError> {
        if x.dim() != y.dim() {
            return Err(FieldError::ShapesDiffer {
                first: x.dim(),
                second: y.dim(),
            });
        }
        Self::new(Zip::from(x).and(y).map_collect(|&x, &y| DVec2::new(x, y)))
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.dim().1
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.dim().0
    }

    /// The force at a pixel center, or `None` outside the image.
    #[must_use]
    pub fn pixel(&self, column: usize, row: usize) -> Option<DVec2> {
        (row < self.height() && column < self.width()).then(|| self.force(row, column))
    }

    /// The force at any point: bilinear between the four pixel centers around it.
    ///
    /// A position outside the image is moved to the nearest point of the rectangle of pixel centers first, so
    /// this is continuous everywhere; a NaN coordinate gives a NaN force. Exact at pixel centers.
    /// The corrected form of report §4.2.2 (D51, D54).
    #[must_use]
    pub fn at(&self, p: DVec2) -> DVec2 {
        self.sample(p, Interpolation::Bilinear)
    }

    /// The force at any point, by a rule of interpolation.
    ///
    /// Outside the image, the force of the nearest point of the rectangle of pixel centers.
    #[must_use]
    pub fn sample(&self, p: DVec2, rule: Interpolation) -> DVec2 {
        let dim = self.dim();
        // asked once a point, not at every pixel, where the forces are
        match &self.forces {
            Forces::Double(f) => sample::value(|y, x| f[[y, x]].to_array(), dim, p, rule),
            Forces::Single(f) => sample::value(|y, x| widened(f[[y, x]]).to_array(), dim, p, rule),
            Forces::Tiles { tiles, factor } => {
                let force = |y, x| widened(tiles.force(y, x)).to_array();
                sample::value(force, dim, p, rule) * *factor
            }
        }
    }

    /// The force at any point and its slope, for schemes that look ahead: the columns are ∂F/∂x and ∂F/∂y.
    ///
    /// The slope is that of the interpolated force, so it jumps from pixel to pixel where the rule is bilinear.
    /// Beyond the outermost pixel centers the force does not change, and the slope across is 0.
    #[must_use]
    pub fn sample_with_slope(&self, p: DVec2, rule: Interpolation) -> (DVec2, DMat2) {
        let dim = self.dim();
        match &self.forces {
            Forces::Double(f) => sample::value_and_slope(|y, x| f[[y, x]].to_array(), dim, p, rule),
            Forces::Single(f) => {
                sample::value_and_slope(|y, x| widened(f[[y, x]]).to_array(), dim, p, rule)
            }
            Forces::Tiles { tiles, factor } => {
                let force = |y, x| widened(tiles.force(y, x)).to_array();
                let (value, slope) = sample::value_and_slope(force, dim, p, rule);
                (value * *factor, slope * *factor)
            }
        }
    }

    /// [`ForceField::sample`] at many points: the shorter of the two slices says how many.
    ///
    /// The same digits as point by point, several times faster from some tens of points on.
    pub fn sample_into(&self, points: &[DVec2], rule: Interpolation, forces: &mut [DVec2]) {
        match &self.forces {
            Forces::Double(f) => {
                if let Some(field) = Flat::new(f) {
                    sample::sample_flat(field, points, rule, forces);
                }
            }
            Forces::Single(f) => {
                if let Some(field) = Flat::new(f) {
                    sample::sample_flat(field, points, rule, forces);
                }
            }
            Forces::Tiles { tiles, factor } => {
                let n = points.len().min(forces.len());
                tile_by_tile(&**tiles, &points[..n], |tile, run| {
                    let forces = &mut forces[run.clone()];
                    sample::sample_flat(tile, &points[run], rule, forces);
                    for force in forces {
                        *force *= *factor;
                    }
                });
            }
        }
    }

    /// [`ForceField::sample_with_slope`] at many points: the shortest slice says how many.
    pub fn sample_with_slope_into(
        &self,
        points: &[DVec2],
        rule: Interpolation,
        forces: &mut [DVec2],
        slopes: &mut [DMat2],
    ) {
        match &self.forces {
            Forces::Double(f) => {
                if let Some(field) = Flat::new(f) {
                    sample::sample_flat_with_slope(field, points, rule, forces, slopes);
                }
            }
            Forces::Single(f) => {
                if let Some(field) = Flat::new(f) {
                    sample::sample_flat_with_slope(field, points, rule, forces, slopes);
                }
            }
            Forces::Tiles { tiles, factor } => {
                let n = points.len().min(forces.len()).min(slopes.len());
                tile_by_tile(&**tiles, &points[..n], |tile, run| {
                    let (forces, slopes) = (&mut forces[run.clone()], &mut slopes[run.clone()]);
                    sample::sample_flat_with_slope(tile, &points[run], rule, forces, slopes);
                    for (force, slope) in forces.iter_mut().zip(slopes) {
                        *force *= *factor;
                        *slope *= *factor;
                    }
                });
            }
        }
    }

    /// The force at a point by the rule of the report's program.
    ///
    /// ```text
    /// k = round(x), j = round(y)                       counting from 1, half away from zero
    /// fx = Fx[j, k] + (x − k) (Fx[j, k+1] − Fx[j, k])
    /// fy = Fy[j, k] + (y − j) (Fy[j+1, k] − Fy[j, k])
    /// ```
    ///
    /// `p` counts from 0 as everywhere here; the 1 is added inside. Each component is interpolated along its own
    /// axis only, from the nearest pixel with the slope towards the next: it jumps at every half (D51, D52, D53).
    /// Row 0 reads as row 1, the program's only guard.
    ///
    /// # Errors
    /// Where the program stops with an index error: left of −½, at and right of the last center less ½, at and
    /// below the last row's center less ½, above −1½, and for NaN (D54, D56).
    pub fn at_report(&self, p: DVec2) -> Result<DVec2, OutsideField> {
        let outside = |axis| OutsideField { at: p, axis };
        let (x, y) = (p.x + 1.0, p.y + 1.0);
        let (column, row) = (x.round(), y.round());
        let guarded = if row == 0.0 { 1.0 } else { row };
        // the program reads forcex before forcey (D58)
        let (k, next_k) = pair(column, self.width()).ok_or(outside('x'))?;
        let j = single(guarded, self.height()).ok_or(outside('x'))?;
        let (_, next_j) = pair(guarded, self.height()).ok_or(outside('y'))?;
        let here = self.force(j, k);
        let fx = (x - column) * (self.force(j, next_k).x - here.x) + here.x;
        let fy = (y - guarded) * (self.force(next_j, k).y - here.y) + here.y;
        Ok(DVec2::new(fx, fy))
    }

    /// Both components as grids.
    #[must_use]
    pub fn components(&self) -> (Grid, Grid) {
        let grid = |part: fn(DVec2) -> f64| {
            Grid::from_shape_fn(self.dim(), |(row, column)| part(self.force(row, column)))
        };
        (grid(|f| f.x), grid(|f| f.y))
    }

    /// The length of the longest force.
    #[must_use]
    pub fn largest(&self) -> f64 {
        let row =
            |row| (0..self.width()).map(move |column| self.force(row, column).length_squared());
        (0..self.height()).flat_map(row).fold(0.0, f64::max).sqrt()
    }

    /// The same field, every force times `factor`.
    ///
    /// A field kept in `f32` stays so, and rounds.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        match &mut self.forces {
            Forces::Double(forces) => forces.mapv_inplace(|f| f * factor),
            Forces::Single(forces) => forces.mapv_inplace(|f| narrowed(widened(f) * factor)),
            Forces::Tiles { factor: all, .. } => *all *= factor,
        }
        self
    }
}

#[inline]
fn widened([x, y]: [f32; 2]) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the point"
)]
fn narrowed(f: DVec2) -> [f32; 2] {
    [f.x as f32, f.y as f32]
}

/// The zero-based index of a whole number counted from 1, if it is one of `n`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "compared with 1 and n before"
)]
fn single(one_based: f64, n: usize) -> Option<usize> {
    (one_based >= 1.0 && one_based <= n as f64).then(|| one_based as usize - 1)
}

/// [`single`] and its successor, if both exist.
fn pair(one_based: f64, n: usize) -> Option<(usize, usize)> {
    let first = single(one_based, n)?;
    (first + 1 < n).then_some((first, first + 1))
}

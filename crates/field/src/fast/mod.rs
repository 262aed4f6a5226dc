//! The same two recipes as [`report_force`](crate::report_force) and [`edge_force`](crate::edge_force), as fast as
//! memory allows.
//!
//! Pixels of 8 or 16 bits or `f32` go in, both force components come out in `f32`, and the picture is read once:
//! every stage of a tile happens in the cache. Twenty passes and a derivative are one odd filter of 33 taps (what
//! is dropped sums to 1.5e-7 of all); the average across commutes with it and is done on lines. The
//! arithmetic is in vectors as wide as the processor has them, found when the program runs, each lane
//! rounding as a lone `f32` would: the result has the same bytes on every machine and for any number of threads.

mod lazy;
mod masks;
mod pixel;
mod plan;
mod room;
mod slide;
mod tile;
mod vector;

#[cfg(test)]
mod tests;

pub(crate) use lazy::{TileSource, tile_by_tile};
pub use pixel::Pixel;
pub use plan::Recipe;

use crate::error::FieldError;
use crate::force_field::ForceField;
use crate::smooth::wide::Wide;
use crate::{EdgeForce, Smoothing};
use ndarray::{ArcArray2, Array2, ArrayView2};
use plan::Plan;
use std::sync::{Arc, Mutex};
use tile::{Job, Place, QUANTUM, Scratch, TILE};

/// The force field of a recipe, fast and in `f32`.
///
/// [`FastForce`] for one picture; see there for exactness, cost and what is refused. For many pictures of the
/// same size, keep a [`FastForce`]: fresh memory costs more than the arithmetic.
///
/// # Errors
/// Those of [`FastForce::new`] and [`FastForce::field`].
pub fn fast_force<P: Pixel>(
    image: ArrayView2<'_, P>,
    recipe: &Recipe,
    threads: usize,
) -> Result<ForceField, FieldError> {
    FastForce::new(*recipe, threads)?.field(image)
}

/// A recipe made ready: its filters and the memory of its workers.
///
/// Forces are within `5e-7 · gain · scale · L` of the `f64` pipeline in either component, with L the largest
/// magnitude of a pixel and scale 1 for the corrected recipe (tested). Up to σ ≈ 18 px O(pixels · σ); memory is the output and
/// less than 1 MiB a thread (tested). Any number of threads gives the same bytes.
///
/// A filter beyond σ ≈ 18 px does not fit the tiles. Then the picture is smoothed on thinned-out lines, on one
/// thread and in the memory of several pictures, before it goes through the tiles, at a cost that no longer grows with σ; the bound above still holds
/// (tested), though no wave is smoothed better than to 1e-6 of its amplitude.
#[derive(Debug)]
pub struct FastForce {
    recipe: Recipe,
    plan: Option<Plan>,
    workers: Vec<Scratch>,
}

impl FastForce {
    /// Prepares a recipe for `threads` threads (0 counts as 1; so does any number in a browser, where none can be
    /// started).
    ///
    /// # Errors
    /// Numbers [`Recipe::validate`] refuses.
    pub fn new(recipe: Recipe, threads: usize) -> Result<Self, FieldError> {
        recipe.validate()?;
        let threads = if cfg!(target_family = "wasm") {
            1
        } else {
            threads.max(1)
        };
        let workers = std::iter::repeat_with(Scratch::default)
            .take(threads)
            .collect();
        Ok(Self {
            recipe,
            plan: Plan::new(&recipe),
            workers,
        })
    }

    /// The field of a picture.
    ///
    /// # Errors
    /// A picture without pixels, one whose field the machine has no memory for, or one with a pixel that is not finite
    /// or too large (the first in reading order is named).
    pub fn field<P: Pixel>(&mut self, image: ArrayView2<'_, P>) -> Result<ForceField, FieldError> {
        let mut field = ForceField::single(Array2::default((0, 0)));
        self.field_into(image, &mut field)?;
        Ok(field)
    }

    /// The field of a picture, in the memory of an earlier one if that has the same shape.
    ///
    /// # Errors
    /// Those of [`FastForce::field`]; `field` then holds no sensible forces.
    pub fn field_into<P: Pixel>(
        &mut self,
        image: ArrayView2<'_, P>,
        field: &mut ForceField,
    ) -> Result<(), FieldError> {
        let (height, width) = image.dim();
        if height == 0 || width == 0 {
            return Err(FieldError::Empty { width, height });
        }
        let Some(plan) = &self.plan else {
            *field = wide_force(image, &self.recipe, self.workers.len())?;
            return Ok(());
        };
        let mut forces = field.take_single((height, width))?;
        let bad = match forces.as_slice_mut() {
            Some(forces) => compute(plan, &mut self.workers, image, forces),
            None => false,
        };
        *field = ForceField::single(forces);
        if bad && let Some(error) = first_bad_pixel(&image, plan.largest_pixel) {
            return Err(error);
        }
        Ok(())
    }
}

/// Forces that fill the larger caches: 16 MiB.
const MANY: usize = 1 << 21;

/// Computes all tiles; says whether a pixel was met that should be refused.
fn compute<P: Pixel>(
    plan: &Plan,
    workers: &mut [Scratch],
    image: ArrayView2<'_, P>,
    forces: &mut [[f32; 2]],
) -> bool {
    let (height, width) = image.dim();
    // tiles of about equal size: no narrow ones at the end, and none wider than its vectors
    let size = |n: usize, most: usize| {
        let even = n.div_ceil(n.div_ceil(most)) + 4;
        even.next_multiple_of(QUANTUM) - 4
    };
    // enough bands for all workers, and none so low that most of it is margin
    let fair = height.div_ceil(4 * workers.len()).max(256);
    let (across, down) = (size(width, TILE.0), size(height, TILE.1.min(fair)));
    let many = forces.len() >= MANY;
    let queue = Mutex::new(forces.chunks_mut(down * width).enumerate());
    let work = |scratch: &mut Scratch| {
        let arch = lanes::registers();
        let mut bad = false;
        loop {
            // nothing can panic while the lock is held
            let next = queue.lock().map_or(None, |mut bands| bands.next());
            let Some((band, out)) = next else { return bad };
            for x in (0..width).step_by(across) {
                let place = Place {
                    x,
                    y: band * down,
                    width: across.min(width - x),
                    height: out.len() / width,
                };
                let (scratch, out) = (&mut *scratch, &mut out[x..]);
                bad |= arch.dispatch(Job {
                    plan,
                    image,
                    place,
                    scratch,
                    out,
                    out_stride: width,
                    many,
                });
            }
        }
    };
    let useful = height.div_ceil(down).min(workers.len());
    let Some((first, others)) = workers[..useful].split_first_mut() else {
        return false;
    };
    if others.is_empty() {
        return work(first);
    }
    std::thread::scope(|scope| {
        let others: Vec<_> = others
            .iter_mut()
            .map(|scratch| scope.spawn(|| work(scratch)))
            .collect();
        let mine = work(first);
        others
            .into_iter()
            .fold(mine, |bad, other| bad | other.join().unwrap_or(true))
    })
}

/// A force field that is computed where it is asked for, tile by tile, and remembered.
///
/// Sampling it gives the same bytes as the field of [`fast_force`], but only tiles of 124 × 64 pixels around the
/// points asked for are ever computed (121 × 61 apart: they overlap by what bicubic sampling looks at): following one cell in a huge
/// picture costs the cell, not the picture. May be sampled from several threads. The picture is an `Array2`, or shared as an
/// [`ArcArray2`](ndarray::ArcArray2) and then not copied. Pixels are not looked at before they are needed; forces within
/// reach of a pixel that is NaN, infinite or too large are NaN.
///
/// # Errors
/// No pixels, numbers [`Recipe::validate`] refuses, and a filter wider than the tiles hold (σ ≈ 18 px).
pub fn lazy_force<P: Pixel>(
    image: impl Into<ArcArray2<P>>,
    recipe: &Recipe,
) -> Result<ForceField, FieldError> {
    recipe.validate()?;
    let image = image.into();
    let (height, width) = image.dim();
    if height == 0 || width == 0 {
        return Err(FieldError::Empty { width, height });
    }
    let Some(plan) = Plan::new(recipe) else {
        let sigma = match *recipe {
            Recipe::Report { passes, .. } => Smoothing::Binomial(passes).sigma(),
            Recipe::Edge(rule) => rule.smoothing.sigma(),
        };
        return Err(FieldError::TooMuch {
            name: "sigma of a lazy field",
            value: sigma,
            most: 18.0,
        });
    };
    Ok(ForceField::tiles(Arc::new(lazy::Tiles::new(image, plan))))
}

/// Smoothing too wide for the tiles, then the rest of the recipe in them.
fn wide_force<P: Pixel>(
    image: ArrayView2<'_, P>,
    recipe: &Recipe,
    threads: usize,
) -> Result<ForceField, FieldError> {
    let (smoothing, rest) = match *recipe {
        Recipe::Report {
            passes,
            scale,
            gain,
        } => {
            let passes = Smoothing::Binomial(passes);
            let rest = Recipe::Report {
                passes: 0,
                scale,
                gain,
            };
            (passes, rest)
        }
        Recipe::Edge(EdgeForce { smoothing, gain }) => {
            let rest = EdgeForce {
                smoothing: Smoothing::Binomial(0),
                gain,
            };
            (smoothing, Recipe::Edge(rest))
        }
    };
    let mut fast = FastForce::new(rest, threads)?;
    let most = fast.plan.as_ref().map_or(f32::MAX, |p| p.largest_pixel);
    if let Some(error) = first_bad_pixel(&image, most) {
        return Err(error);
    }
    let dim = image.dim();
    let pixels: Vec<f32> = image.iter().map(|pixel| pixel.level()).collect();
    let wide = Wide::new(smoothing);
    let mut field = |smoothed: Vec<f32>| {
        // as many as there were
        match ArrayView2::from_shape(dim, &smoothed) {
            Ok(smoothed) => fast.field(smoothed),
            Err(_) => fast.field(image),
        }
    };
    match *recipe {
        Recipe::Report { .. } => {
            let x = field(wide.along_x(&pixels, dim.1))?;
            let mut y = field(wide.along_y(&pixels, dim.1))?;
            y.take_x_from(&x);
            Ok(y)
        }
        Recipe::Edge(_) => field(wide.along_y(&wide.along_x(&pixels, dim.1), dim.1)),
    }
}

/// The first pixel in reading order that is not finite or above `most`.
fn first_bad_pixel<P: Pixel>(image: &ArrayView2<'_, P>, most: f32) -> Option<FieldError> {
    image.indexed_iter().find_map(|((row, column), pixel)| {
        let (level, most) = (pixel.level(), f64::from(most));
        let value = f64::from(level);
        if !level.is_finite() {
            Some(FieldError::NotFinite { column, row, value })
        } else if value.abs() > most {
            Some(FieldError::TooLarge {
                column,
                row,
                value,
                most,
            })
        } else {
            None
        }
    })
}

//! Tiles that are computed when they are first looked at.

use super::pixel::Pixel;
use super::plan::Plan;
use super::tile::{Job, Place, SMALL_TILE, Scratch};
use ndarray::Array2;
use std::fmt;
use std::sync::OnceLock;

/// Columns kept of a tile: one more than it answers for, as there is one more row, so that no cell lies across two.
const STRIDE: usize = SMALL_TILE.0 + 1;

/// Forces that come a tile at a time, whatever the pixels were.
pub(crate) trait TileSource: Send + Sync + fmt::Debug {
    /// (rows, columns).
    fn dim(&self) -> (usize, usize);
    /// The force at a pixel center inside.
    fn force(&self, row: usize, column: usize) -> [f32; 2];
    /// The forces of the cell that begins at a pixel center: two of its row, two of the next.
    fn cell(&self, row: usize, column: usize) -> [[f32; 2]; 4];
    /// How many tiles have been computed so far.
    fn computed(&self) -> usize;
}

/// A picture, a plan and the tiles computed so far.
pub(super) struct Tiles<P> {
    image: Array2<P>,
    plan: Plan,
    tiles_across: usize,
    tiles: Vec<OnceLock<Box<[[f32; 2]]>>>,
}

impl<P: Pixel> Tiles<P> {
    pub(super) fn new(image: Array2<P>, plan: Plan) -> Self {
        let (height, width) = image.dim();
        let tiles_across = width.div_ceil(SMALL_TILE.0);
        let count = tiles_across * height.div_ceil(SMALL_TILE.1);
        let tiles = std::iter::repeat_with(OnceLock::new).take(count).collect();
        Self {
            image,
            plan,
            tiles_across,
            tiles,
        }
    }

    /// The tile that holds a pixel, and where in it.
    #[inline]
    fn tile(&self, row: usize, column: usize) -> (&[[f32; 2]], usize) {
        let tile = row / SMALL_TILE.1 * self.tiles_across + column / SMALL_TILE.0;
        let forces = self.tiles[tile].get_or_init(|| self.compute(tile));
        (forces, row % SMALL_TILE.1 * STRIDE + column % SMALL_TILE.0)
    }

    fn compute(&self, tile: usize) -> Box<[[f32; 2]]> {
        let (height, width) = self.image.dim();
        let x = tile % self.tiles_across * SMALL_TILE.0;
        let y = tile / self.tiles_across * SMALL_TILE.1;
        let place = Place {
            x,
            y,
            width: STRIDE.min(width - x),
            height: (SMALL_TILE.1 + 1).min(height - y),
        };
        let mut out = vec![[0.0; 2]; STRIDE * place.height];
        let bad = pulp::Arch::new().dispatch(Job {
            plan: &self.plan,
            image: self.image.view(),
            place,
            scratch: &mut Scratch::default(),
            out: &mut out,
            out_stride: STRIDE,
        });
        if bad {
            out.fill([f32::NAN; 2]);
        }
        out.into_boxed_slice()
    }
}

impl<P: Pixel> TileSource for Tiles<P> {
    fn dim(&self) -> (usize, usize) {
        self.image.dim()
    }

    #[inline]
    fn force(&self, row: usize, column: usize) -> [f32; 2] {
        let (tile, at) = self.tile(row, column);
        tile[at]
    }

    #[inline]
    fn cell(&self, row: usize, column: usize) -> [[f32; 2]; 4] {
        let (tile, at) = self.tile(row, column);
        let (above, below) = (&tile[at..at + 2], &tile[at + STRIDE..at + STRIDE + 2]);
        [above[0], above[1], below[0], below[1]]
    }

    fn computed(&self) -> usize {
        self.tiles
            .iter()
            .filter(|tile| tile.get().is_some())
            .count()
    }
}

impl<P> fmt::Debug for Tiles<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tiles")
            .field("plan", &self.plan)
            .finish_non_exhaustive()
    }
}

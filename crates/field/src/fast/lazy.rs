//! Tiles that are computed when they are first looked at.

use super::pixel::Pixel;
use super::plan::Plan;
use super::tile::{Job, Place, SMALL_TILE, Scratch};
use crate::sample::{Flat, cell};
use glam::DVec2;
use ndarray::ArcArray2;
use std::fmt;
use std::ops::Range;
use std::sync::OnceLock;

/// Columns and rows of cells that a tile answers for: three fewer than it has forces, so that the sixteen forces
/// around any of its cells lie in it.
const CELLS: (usize, usize) = (SMALL_TILE.0 - 3, SMALL_TILE.1 - 3);

/// Forces that come a tile at a time, whatever the pixels were.
pub(crate) trait TileSource: Send + Sync + fmt::Debug {
    /// (rows, columns).
    fn dim(&self) -> (usize, usize);
    /// The tile that answers for a row and column of tiles.
    fn tile(&self, down: usize, across: usize) -> Flat<'_, [f32; 2]>;
    /// How many tiles have been computed so far.
    fn computed(&self) -> usize;

    /// The force at a pixel center inside.
    #[inline]
    fn force(&self, row: usize, column: usize) -> [f32; 2] {
        self.tile(row / CELLS.1, column / CELLS.0).kept(row, column)
    }
}

/// Hands `work` runs of points, each with the tile that knows their neighbourhoods.
pub(crate) fn tile_by_tile(
    tiles: &dyn TileSource,
    points: &[DVec2],
    mut work: impl FnMut(Flat<'_, [f32; 2]>, Range<usize>),
) {
    let (height, width) = tiles.dim();
    let mut begin = 0;
    while let Some(&p) = points.get(begin) {
        let (x, along) = span(p.x, width, CELLS.0);
        let (y, down) = span(p.y, height, CELLS.1);
        // a position that is not finite is a group of its own, in tile 0
        let here = |p: &&DVec2| along.contains(&p.x) && down.contains(&p.y);
        let more = points[begin + 1..].iter().take_while(here).count();
        let end = begin + 1 + more;
        work(tiles.tile(y, x), begin..end);
        begin = end;
    }
}

/// The tile that a coordinate on a line of `n` falls into, and all coordinates that do.
fn span(x: f64, n: usize, cells: usize) -> (usize, Range<f64>) {
    let tile = cell(x, n).0 / cells;
    let last = n.saturating_sub(2) / cells;
    let from = if tile == 0 {
        f64::NEG_INFINITY
    } else {
        (tile * cells) as f64
    };
    let to = if tile == last {
        f64::INFINITY
    } else {
        ((tile + 1) * cells) as f64
    };
    (tile, from..to)
}

/// A picture, a plan and the tiles computed so far.
pub(super) struct Tiles<P> {
    image: ArcArray2<P>,
    plan: Plan,
    across: usize,
    tiles: Vec<OnceLock<Box<[[f32; 2]]>>>,
}

impl<P: Pixel> Tiles<P> {
    pub(super) fn new(image: ArcArray2<P>, plan: Plan) -> Self {
        let (height, width) = image.dim();
        let across = width.div_ceil(CELLS.0);
        let count = across * height.div_ceil(CELLS.1);
        let tiles = std::iter::repeat_with(OnceLock::new).take(count).collect();
        Self {
            image,
            plan,
            across,
            tiles,
        }
    }

    /// A tile's first column and row: one before its cells, where there is one.
    const fn first(down: usize, across: usize) -> (usize, usize) {
        let (x, y) = (across * CELLS.0, down * CELLS.1);
        (x.saturating_sub(1), y.saturating_sub(1))
    }

    fn compute(&self, (x, y): (usize, usize)) -> Box<[[f32; 2]]> {
        let (height, width) = self.image.dim();
        let place = Place {
            x,
            y,
            width: SMALL_TILE.0.min(width - x),
            height: SMALL_TILE.1.min(height - y),
        };
        let mut out = vec![[0.0; 2]; SMALL_TILE.0 * place.height];
        let bad = lanes::registers().dispatch(Job {
            plan: &self.plan,
            image: self.image.view(),
            place,
            scratch: &mut Scratch::default(),
            out: &mut out,
            out_stride: SMALL_TILE.0,
            many: false,
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
    fn tile(&self, down: usize, across: usize) -> Flat<'_, [f32; 2]> {
        let (x, y) = Self::first(down, across);
        let tile = &self.tiles[down * self.across + across];
        let forces = tile.get_or_init(|| self.compute((x, y)));
        Flat::window(forces, self.image.dim(), (y, x), SMALL_TILE.0)
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

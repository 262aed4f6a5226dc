//! The cells of some tens of points, found several at once in wide registers and without a branch.

use super::weights::{WHOLE, cell};
use glam::DVec2;

/// Points whose cells are found together: the arrays stay in the first cache.
pub(super) const GROUP: usize = 64;

/// Where the forces of a field, or of a window of it, lie in memory.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// The last pixel along x and along y.
    pub(super) last: [f64; 2],
    /// From one row to the next.
    pub(super) stride: f64,
    /// 2⁵² less what lies before the first force.
    pub(super) whole: f64,
}

/// Cells of a group of points.
pub(super) struct Group {
    /// Where in the field a neighbourhood begins; `usize::MAX` if the field does not hold all of it.
    pub(super) at: [usize; GROUP],
    pub(super) t: [[f64; GROUP]; 2],
    pub(super) slide: [[f64; GROUP]; 2],
}

impl Group {
    pub(super) const fn new() -> Self {
        Self {
            at: [0; GROUP],
            t: [[0.0; GROUP]; 2],
            slide: [[0.0; GROUP]; 2],
        }
    }

    /// Finds the cells of up to [`GROUP`] points; the neighbourhood is the cell, or one pixel wider if `CUBIC`.
    ///
    /// Says whether the field holds all neighbourhoods, as it does all cells.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a place in a slice")]
    pub(super) fn find<const CUBIC: bool, const SLOPE: bool>(
        &mut self,
        points: &[DVec2],
        place: Place,
    ) -> bool {
        let ([last_x, last_y], stride, whole) = (place.last, place.stride, place.whole);
        let (most_x, most_y) = (last_x - 1.0, last_y - 1.0);
        let [tx, ty] = &mut self.t;
        let [slide_x, slide_y] = &mut self.slide;
        let mut all_inner = true;
        for k in 0..points.len().min(GROUP) {
            let p = points[k];
            let (x, y) = (cell(p.x, last_x, most_x), cell(p.y, last_y, most_y));
            (tx[k], ty[k]) = (x.1, y.1);
            if SLOPE {
                (slide_x[k], slide_y[k]) = (x.2, y.2);
            }
            let place = |x: f64, y: f64| (y * stride + x + whole).to_bits() ^ WHOLE.to_bits();
            self.at[k] = if CUBIC {
                let inner = |at: f64, most: f64| (at >= 1.0) & (at < most);
                let inner = inner(x.0, most_x) & inner(y.0, most_y);
                all_inner &= inner;
                if inner {
                    place(x.0 - 1.0, y.0 - 1.0) as usize
                } else {
                    usize::MAX
                }
            } else {
                place(x.0, y.0) as usize
            };
        }
        all_inner
    }
}

/// Weights of the bicubic rule for a group of points.
pub(super) struct Weights([[f64; GROUP]; 4]);

impl Weights {
    pub(super) const fn new() -> Self {
        Self([[0.0; GROUP]; 4])
    }

    #[inline(always)]
    pub(super) fn fill(&mut self, n: usize, weights: impl Fn(usize) -> [f64; 4]) {
        let [a, b, c, d] = &mut self.0;
        for k in 0..n.min(GROUP) {
            [a[k], b[k], c[k], d[k]] = weights(k);
        }
    }

    #[inline(always)]
    pub(super) fn of(&self, k: usize) -> [f64; 4] {
        let [a, b, c, d] = &self.0;
        [a[k], b[k], c[k], d[k]]
    }
}

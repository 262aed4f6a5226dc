//! `c·u − ∇²u = b` on a rectangle of pixels, no flow through the border, by multigrid V-cycles.
//!
//! Each coarser grid has half the pixels a side (cells of 2 × 2, one row or column left over if odd), the equation
//! summed over each cell: ∇² is kept as fluxes between neighbouring pixels, which add up over a cell, so the coarse
//! equation is symmetric and positive like the fine one. Red-black Gauss–Seidel sweeps smooth.

use crate::grid::Grid;

/// One grid of the hierarchy.
struct Level {
    /// c, summed over a cell.
    reaction: Grid,
    /// Conductance between [y, x] and [y, x + 1]; 0 in the last column.
    right: Grid,
    /// Conductance between [y, x] and [y + 1, x]; 0 in the last row.
    down: Grid,
}

/// All grids, from fine to coarse.
pub(super) struct Solver {
    levels: Vec<Level>,
}

/// Sweeps before and after each coarser grid.
const SWEEPS: usize = 2;

/// Sweeps on the coarsest grid, of 2 × 2 pixels or fewer.
const COARSEST_SWEEPS: usize = 50;

/// Summed corrections of piecewise constants are too small by about half; this much is added back.
///
/// [braess95]
const OVERCORRECTION: f64 = 1.8;

impl Solver {
    /// The hierarchy for a reaction c ≥ 0, above 0 somewhere.
    pub(super) fn new(reaction: &Grid) -> Self {
        let (height, width) = reaction.dim();
        let line = |i: usize, n: usize| if i + 1 < n { 1.0 } else { 0.0 };
        let mut levels = vec![Level {
            reaction: reaction.clone(),
            right: Grid::from_shape_fn((height, width), |(_, x)| line(x, width)),
            down: Grid::from_shape_fn((height, width), |(y, _)| line(y, height)),
        }];
        while let Some(coarse) = levels.last().and_then(Level::coarser) {
            levels.push(coarse);
        }
        Self { levels }
    }

    /// Solves for one right-hand side: the solution, the cycles spent, the residual's share of `b`.
    ///
    /// Conjugate gradients with one V-cycle as the preconditioner.
    pub(super) fn solve(&self, b: &Grid, share: f64, most: u32) -> (Grid, u32, f64) {
        let fine = &self.levels[0];
        let mut u = Grid::zeros(b.dim());
        let size = dot(b, b).sqrt();
        if size <= 0.0 {
            return (u, 0, 0.0);
        }
        let mut r = b.clone();
        let mut z = self.cycle(0, &r);
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        for cycle in 1..=most {
            let ap = fine.apply(&p);
            let alpha = rz / dot(&p, &ap);
            u.scaled_add(alpha, &p);
            r.scaled_add(-alpha, &ap);
            let now = dot(&r, &r).sqrt() / size;
            if now <= share || cycle == most {
                return (u, cycle, now);
            }
            z = self.cycle(0, &r);
            let next = dot(&r, &z);
            let beta = next / rz;
            rz = next;
            p = &z + &(p * beta);
        }
        (u, most, f64::INFINITY)
    }

    /// An approximate solution of level `l` for the right-hand side `b`: one symmetric V-cycle from zero.
    fn cycle(&self, l: usize, b: &Grid) -> Grid {
        let level = &self.levels[l];
        let mut u = Grid::zeros(b.dim());
        let coarsest = l + 1 == self.levels.len();
        for _ in 0..if coarsest { COARSEST_SWEEPS } else { SWEEPS } {
            level.sweep(&mut u, b, false);
        }
        if !coarsest {
            let residual = b - &level.apply(&u);
            let mut coarse = Grid::zeros(self.levels[l + 1].reaction.dim());
            for ((y, x), r) in residual.indexed_iter() {
                coarse[[y / 2, x / 2]] += r;
            }
            let correction = self.cycle(l + 1, &coarse);
            for ((y, x), u) in u.indexed_iter_mut() {
                *u += OVERCORRECTION * correction[[y / 2, x / 2]];
            }
        }
        // the same sweeps backwards keep the cycle symmetric, as conjugate gradients want it
        for _ in 0..if coarsest { COARSEST_SWEEPS } else { SWEEPS } {
            level.sweep(&mut u, b, true);
        }
        u
    }
}

impl Level {
    /// The level of half the pixels a side, or `None` if this one is small enough.
    fn coarser(&self) -> Option<Self> {
        let (height, width) = self.reaction.dim();
        if height <= 2 && width <= 2 {
            return None;
        }
        let dim = (height.div_ceil(2), width.div_ceil(2));
        let (mut reaction, mut right, mut down) =
            (Grid::zeros(dim), Grid::zeros(dim), Grid::zeros(dim));
        for ((y, x), c) in self.reaction.indexed_iter() {
            reaction[[y / 2, x / 2]] += c;
            // only what crosses from one cell to the next conducts
            if x % 2 == 1 {
                right[[y / 2, x / 2]] += self.right[[y, x]];
            }
            if y % 2 == 1 {
                down[[y / 2, x / 2]] += self.down[[y, x]];
            }
        }
        Some(Self {
            reaction,
            right,
            down,
        })
    }

    /// Conductance-weighted sum over the neighbours, and c plus all conductances.
    #[inline]
    fn around(&self, u: &Grid, y: usize, x: usize) -> (f64, f64) {
        let (height, width) = u.dim();
        let (mut sum, mut diagonal) = (0.0, self.reaction[[y, x]]);
        let mut add = |k: f64, u: f64| {
            sum += k * u;
            diagonal += k;
        };
        if x + 1 < width {
            add(self.right[[y, x]], u[[y, x + 1]]);
        }
        if x > 0 {
            add(self.right[[y, x - 1]], u[[y, x - 1]]);
        }
        if y + 1 < height {
            add(self.down[[y, x]], u[[y + 1, x]]);
        }
        if y > 0 {
            add(self.down[[y - 1, x]], u[[y - 1, x]]);
        }
        (sum, diagonal)
    }

    /// `c·u − ∇²u`.
    fn apply(&self, u: &Grid) -> Grid {
        Grid::from_shape_fn(u.dim(), |(y, x)| {
            let (sum, diagonal) = self.around(u, y, x);
            diagonal * u[[y, x]] - sum
        })
    }

    /// One Gauss–Seidel sweep, red pixels then black, or the other way round.
    fn sweep(&self, u: &mut Grid, b: &Grid, backwards: bool) {
        let (height, width) = u.dim();
        for color in if backwards { [1, 0] } else { [0, 1] } {
            for y in 0..height {
                for x in ((y + color) % 2..width).step_by(2) {
                    let (sum, diagonal) = self.around(u, y, x);
                    // a lone pixel without reaction has nothing to say
                    if diagonal > 0.0 {
                        u[[y, x]] = (b[[y, x]] + sum) / diagonal;
                    }
                }
            }
        }
    }
}

fn dot(a: &Grid, b: &Grid) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

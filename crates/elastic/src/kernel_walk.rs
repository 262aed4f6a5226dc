//! Force and energy of a kernel of any order, in tiles along the curve.
//!
//! The force is a tower of differences, up and down:
//!
//! ```text
//! d₀ = e,        d[m][k] = d[m−1][k+1] − d[m−1][k]
//! g[p] = w_p d[p],   g[m][k] = w_m d[m][k] + g[m+1][k−1] − g[m+1][k],   F = −g₀
//! ```
//!
//! so each order costs two subtractions and two products a node. A tile is some nodes and p more on either
//! side, few enough for all its storeys to lie on the stack. What the ends are is said in the weights: a
//! difference that does not exist weighs nothing. Beyond a clamped end stands the mirror image of a node, which hands what it
//! feels on to that node.

use crate::kernel::{Kernel, power};
use crate::{End, Profile, Topology};
use glam::DVec2;

/// Nodes a tile: long enough that the p more on either side cost little.
const NODES: usize = 64;

/// A tile with its margins.
const WIDE: usize = NODES + 2 * Kernel::HIGHEST;

/// A tile: the differences of all orders over `len` nodes from `start` on. Place 0 is node `start − p`.
struct Tile {
    start: usize,
    len: usize,
    differences: [[DVec2; WIDE]; Kernel::HIGHEST + 1],
    weights: [f64; WIDE],
}

impl Kernel {
    /// Elastic force on every node, for any order.
    ///
    /// ```text
    /// F = − Σ Dᵐᵀ ωₘ Dᵐ e / h²ᵐ
    /// ```
    ///
    /// `e` holds one deformation a node; `force` is overwritten. Per arc length: M L T⁻². O(n p), allocates
    /// nothing. Minus the gradient of [`energy`](Self::energy) over `spacing`. Differences first: where
    /// nothing is tethered or anchored, a curve that is only shifted feels exactly nothing.
    ///
    /// The arguments are trusted: they are what [`validate`](Self::validate) would accept. Report Eq. 2.9.
    pub fn force(&self, e: &[DVec2], topology: Topology, spacing: f64, force: &mut [DVec2]) {
        force.fill(DVec2::ZERO);
        add_force((0, &self.weights), e, topology, spacing, force);
    }

    /// Elastic energy of a deformation, one number an order; those above p are 0. M L³ T⁻².
    ///
    /// ```text
    /// ξ_m = ½ h Σ ωₘ |Dᵐ e|² / h²ᵐ
    /// ```
    ///
    /// over the differences that exist. O(n p), allocates nothing. The arguments are trusted, as by
    /// [`force`](Self::force). Report Eq. 2.5 and 2.6.
    #[must_use]
    pub fn energy(
        &self,
        e: &[DVec2],
        topology: Topology,
        spacing: f64,
    ) -> [f64; Self::HIGHEST + 1] {
        energy((0, &self.weights), e, topology, spacing)
    }
}

/// Adds the force of the orders from `first` on.
pub(crate) fn add_force(
    (first, weights): (usize, &[Profile]),
    e: &[DVec2],
    topology: Topology,
    spacing: f64,
    force: &mut [DVec2],
) {
    debug_assert_eq!(e.len(), force.len(), "one force a node");
    let (p, n) = (first + weights.len() - 1, e.len());
    let mut tile = Tile::new();
    // on the mirror images beyond clamped ends
    let (mut before, mut after) = (DVec2::ZERO, DVec2::ZERO);
    for (number, out) in force.chunks_mut(NODES).enumerate() {
        tile.fill(e, topology, p, number * NODES, out.len());
        let mut flux = [DVec2::ZERO; WIDE];
        for m in (0..=p).rev() {
            let (from, to) = (p - m, tile.len + p);
            if m == 0 && p > 0 {
                if number == 0 {
                    before = flux[p - 1];
                }
                after = -flux[to - 1];
            }
            if let Some(profile) = m.checked_sub(first).map(|k| &weights[k]) {
                tile.weigh(profile, power(spacing, m), topology, (m, p, n));
            } else {
                tile.weights.fill(0.0);
            }
            let own = &tile.differences[m];
            // downwards, so that the neighbour below is still the one of the storey above
            for b in (from..to).rev() {
                let below = if b == 0 { DVec2::ZERO } else { flux[b - 1] };
                flux[b] = tile.weights[b] * own[b] + (below - flux[b]);
            }
        }
        for (out, flux) in out.iter_mut().zip(&flux[p..]) {
            *out -= *flux;
        }
    }
    if let Topology::Open { head, tail } = topology {
        if head == End::Clamped {
            force[1] += before;
        }
        if tail == End::Clamped {
            force[n - 2] += after;
        }
    }
}

/// The energy of the orders from `first` on.
pub(crate) fn energy(
    (first, weights): (usize, &[Profile]),
    e: &[DVec2],
    topology: Topology,
    spacing: f64,
) -> [f64; Kernel::HIGHEST + 1] {
    let (p, n) = (first + weights.len() - 1, e.len());
    let mut energy = [0.0; Kernel::HIGHEST + 1];
    let mut tile = Tile::new();
    for start in (0..n).step_by(NODES) {
        tile.fill(e, topology, p, start, NODES.min(n - start));
        for (m, profile) in (first..).zip(weights) {
            let factor = 0.5 * spacing * power(spacing, m);
            tile.weigh(profile, factor, topology, (m, p, n));
            // what begins before node 0 is counted with the first tile, and once round a ring
            let outside = start == 0 && !topology.is_closed();
            let from = if outside { 0 } else { p };
            energy[m] += tile.weights[from..p + tile.len]
                .iter()
                .zip(&tile.differences[m][from..])
                .map(|(w, d)| w * d.length_squared())
                .sum::<f64>();
        }
    }
    energy
}
impl Tile {
    const fn new() -> Self {
        Self {
            start: 0,
            len: 0,
            differences: [[DVec2::ZERO; WIDE]; Kernel::HIGHEST + 1],
            weights: [0.0; WIDE],
        }
    }

    /// Takes `len` nodes from `start` on with `p` more on either side, and all their differences.
    fn fill(&mut self, e: &[DVec2], topology: Topology, p: usize, start: usize, len: usize) {
        let n = e.len();
        (self.start, self.len) = (start, len);
        let wide = len + 2 * p;
        for (b, value) in self.differences[0][..wide].iter_mut().enumerate() {
            let place = start + b; // p more than the node
            *value = if (p..p + n).contains(&place) {
                e[place - p]
            } else {
                topology.seen(place, p, n).map_or(DVec2::ZERO, |i| e[i])
            };
        }
        for m in 1..=p {
            let (lower, upper) = self.differences.split_at_mut(m);
            let (lower, upper) = (&lower[m - 1], &mut upper[0]);
            for b in 0..wide - m {
                upper[b] = lower[b + 1] - lower[b];
            }
        }
    }

    /// The weights of the differences of order `m`, times `factor`; 0 where there is no difference.
    fn weigh(
        &mut self,
        profile: &Profile,
        factor: f64,
        topology: Topology,
        (m, p, n): (usize, usize, usize),
    ) {
        let weights = &mut self.weights[..self.len + p];
        let inside = self.start >= p && self.start + self.len + p <= n;
        match profile {
            Profile::Uniform(value) if inside || topology.is_closed() => {
                weights.fill(value * factor);
            }
            Profile::PerNode(values) if inside => {
                let first = self.start - p + m / 2;
                for (weight, value) in weights.iter_mut().zip(&values[first..]) {
                    *weight = value * factor;
                }
            }
            _ => {
                for (b, weight) in weights.iter_mut().enumerate() {
                    // place b is node start + b − p, and rows are counted from node −m
                    let row = (self.start + b + m)
                        .checked_sub(p)
                        .map(|at| topology.row(m, at, n));
                    *weight = row.map_or(0.0, |row| row.share * profile.at(row.weight) * factor);
                }
            }
        }
    }
}

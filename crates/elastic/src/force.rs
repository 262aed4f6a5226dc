//! The elastic force as a walk along the curve.
//!
//! The force on a node is the difference of two fluxes, one through each of its edges:
//!
//! ```text
//!   m[i] = ω₂[i] (e[i+1] − 2 e[i] + e[i−1]) / h⁴         moment at node i
//!   q[i] = ω₁[i] (e[i+1] − e[i]) / h²  −  (m[i+1] − m[i])  flux from node i to i+1
//!   F[i] = q[i] − q[i−1] − ω₀[i] e[i]
//! ```
//!
//! Each is computed once and handed on to the next node. What a curve's ends are appears only in four
//! numbers, the moments and fluxes at its two ends; the loop between them knows nothing of topology.
//! Differences first, then weights: a curve that is only shifted feels exactly nothing from tension
//! and rigidity, whatever the rounding.
//!
//! Orders above the second are added by a walk of their own (`kernel_walk`).
//!
//! One spacing serves the whole curve; edges of their own lengths are [`Spacings`](crate::Spacings).

use crate::profile::Lane;
use crate::{End, Material, Topology, kernel_walk};
use glam::DVec2;
use lanes::{flat, flat_mut, wide};

/// Elastic force on every node: what the curve feels for not being at rest.
///
/// ```text
/// F[i] = − ω₀ e[i] + D₁⁻(ω₁ D₁⁺ e)[i] − D₂(ω₂ D₂ e)[i] + …
/// ```
///
/// `e` holds one deformation a node; `force` has the same length and is overwritten. Per arc length:
/// M L T⁻². O(n p), allocates nothing. It is `−K e` with K of [`stiffness`](crate::stiffness), and minus
/// the gradient of [`elastic_energy`](crate::elastic_energy) over `spacing`, for every topology. A
/// [pinned](End::Pinned) end is told its force like any other.
///
/// The arguments are trusted: they are what [`stiffness`](crate::stiffness) would accept.
///
/// Report Eq. 3.2, moved to the right-hand side. The matrix printed after it has the sign of the
/// tension turned round (D1).
pub fn elastic_force(
    e: &[DVec2],
    topology: Topology,
    material: &Material,
    spacing: f64,
    force: &mut [DVec2],
) {
    debug_assert!(
        e.len() >= topology.least_nodes(),
        "the curve has the nodes its differences need"
    );
    debug_assert_eq!(e.len(), force.len(), "one force a node");
    let per_h2 = 1.0 / (spacing * spacing);
    let per_h4 = per_h2 * per_h2;
    let (tether, tension, rigidity) = (&material.tether, &material.tension, &material.rigidity);
    if let Some([w0, w1, w2]) = material.uniform_densities() {
        uniform(e, topology, [w0, w1 * per_h2, w2 * per_h4], force);
    } else {
        let (w0, w1, w2) = (Lane::new(tether), Lane::new(tension), Lane::new(rigidity));
        let weights = Weights {
            w0: |i: usize| w0.at(i),
            w1: |i: usize| w1.at(i) * per_h2,
            w2: |i: usize| w2.at(i) * per_h4,
        };
        let boundary = weights.boundary(e, topology);
        let walk = weights.walk(e, boundary.start(e), force);
        weights.finish(e, walk, &boundary, force);
    }
    if !material.higher.is_empty() {
        kernel_walk::add_force((3, &material.higher), e, topology, spacing, force);
    }
}

/// The same densities everywhere: between the two nodes at each end no flux need be kept apart.
///
/// ```text
/// F[i] = (ω₁/h² + 4 ω₂/h⁴) near − ω₂/h⁴ far − ω₀ e[i]
/// near = (e[i−1] − e[i]) + (e[i+1] − e[i]),   far = (e[i−2] − e[i]) + (e[i+2] − e[i])
/// ```
///
/// Nothing is handed on, so that the loop has no chain and fills registers of any width.
fn uniform(e: &[DVec2], topology: Topology, [w0, w1, w2]: [f64; 3], force: &mut [DVec2]) {
    let n = e.len();
    if n < LEAST {
        let weights = Weights::uniform([w0, w1, w2]);
        let boundary = weights.boundary(e, topology);
        let walk = weights.walk(e, boundary.start(e), force);
        weights.finish(e, walk, &boundary, force);
        return;
    }
    let at = |i: usize| e[i];
    uniform_ends(
        std::array::from_fn(|k| at(end_node(k, n))),
        topology,
        [w0, w1, w2],
        force,
    );
    let middle = flat_mut(&mut force[2..n - 2]);
    between(flat(e), [w0, w1, w2], middle);
}

/// Nodes needed to tell the ends from what is between them.
const LEAST: usize = 8;

/// The first four nodes of `n` and the last four.
const fn end_node(k: usize, n: usize) -> usize {
    if k < 4 { k } else { n - LEAST + k }
}

/// The force on the two nodes at each end, from the four nodes there.
fn uniform_ends(ends: [DVec2; LEAST], topology: Topology, w: [f64; 3], force: &mut [DVec2]) {
    let weights = Weights::uniform(w);
    let boundary = weights.boundary(&ends, topology);
    let mut out = [DVec2::ZERO; LEAST];
    weights.walk(&ends[..4], boundary.start(&ends), &mut out);
    let walk = weights.resume(&ends, LEAST - 2);
    weights.finish(&ends, walk, &boundary, &mut out);
    let n = force.len();
    force[..2].copy_from_slice(&out[..2]);
    force[n - 2..].copy_from_slice(&out[LEAST - 2..]);
}

/// The force on all nodes of `e` but two at each end; `e` and `force` are the coordinates in turn.
#[inline(always)]
fn five_points(e: &[f64], [w0, w1, w2]: [f64; 3], force: &mut [f64]) {
    let m = force.len();
    let near = w1 + 4.0 * w2;
    let (a, b, here) = (&e[..m], &e[2..m + 2], &e[4..m + 4]);
    let (c, d) = (&e[6..m + 6], &e[8..m + 8]);
    for k in 0..m {
        let e = here[k];
        force[k] = (near * ((b[k] - e) + (c[k] - e)) - w2 * ((a[k] - e) + (d[k] - e))) - w0 * e;
    }
}

wide! {
    /// The same in wide registers.
    fn between(e: &[f64], w: [f64; 3], force: &mut [f64]) {
        five_points(e, w, force);
    }
}

/// Nodes a block: its deformations, and the two on either side, stay in the first cache.
const BLOCK: usize = 128;

/// Nodes that a block needs: its own and two on either side.
const REACH: usize = BLOCK + 4;

/// Elastic force on every node of a body: [`elastic_force`] of `e = x − center − rest`.
///
/// To the same digits, but where the densities are the same everywhere and none is of an order above 2, `e` is never written down as
/// a whole. Otherwise it is left in `e`, which has as many nodes. O(n), allocates nothing.
///
/// Report Eq. 2.2 and 3.2.
pub fn body_force(
    [x, rest]: [&[DVec2]; 2],
    center: DVec2,
    (topology, material, spacing): (Topology, &Material, f64),
    e: &mut [DVec2],
    force: &mut [DVec2],
) {
    let n = x.len();
    let w = match material.uniform_densities() {
        Some([w0, w1, w2]) if n >= LEAST && material.higher.is_empty() => {
            let per_h2 = 1.0 / (spacing * spacing);
            [w0, w1 * per_h2, w2 * (per_h2 * per_h2)]
        }
        _ => {
            for ((e, x), rest) in e.iter_mut().zip(x).zip(rest) {
                *e = x - center - rest;
            }
            elastic_force(e, topology, material, spacing, force);
            return;
        }
    };
    let ends = std::array::from_fn(|k| {
        let i = end_node(k, n);
        x[i] - center - rest[i]
    });
    uniform_ends(ends, topology, w, force);
    in_blocks(
        flat(x),
        center,
        flat(rest),
        w,
        flat_mut(&mut force[2..n - 2]),
    );
}

/// Numbers that begin where a line of the cache does, so that fewer of their loads reach over two.
#[repr(align(64))]
struct Lines([f64; 2 * REACH]);

wide! {
    /// The force on all nodes but two at each end, the deformation made block by block.
    fn in_blocks(x: &[f64], center: DVec2, rest: &[f64], w: [f64; 3], force: &mut [f64]) {
        let mut centers = [[0.0; 2]; REACH];
        centers[..REACH.min(x.len() / 2)].fill([center.x, center.y]);
        let mut buffer = Lines([0.0; 2 * REACH]);
        for (k, block) in force.chunks_mut(2 * BLOCK).enumerate() {
            let from = 2 * k * BLOCK;
            let m = block.len() + 8;
            let (x, rest) = (&x[from..from + m], &rest[from..from + m]);
            let (centers, e) = (&centers.as_flattened()[..m], &mut buffer.0[..m]);
            for k in 0..m {
                e[k] = x[k] - centers[k] - rest[k];
            }
            five_points(e, w, block);
        }
    }
}

/// The second difference at a node that has both neighbours.
fn second(e: &[DVec2], i: usize) -> DVec2 {
    (e[i + 1] - e[i]) - (e[i] - e[i - 1])
}

/// What is handed on to node i: its edge to i+1, its moment, and the flux that comes in from i−1.
#[derive(Clone, Copy)]
struct Walk {
    edge: DVec2,
    moment: DVec2,
    flux: DVec2,
}

/// Moments and fluxes where the curve begins and ends.
struct Boundary {
    first_moment: DVec2,
    flux_in: DVec2,
    last_moment: DVec2,
    flux_out: DVec2,
}

impl Boundary {
    fn start(&self, e: &[DVec2]) -> Walk {
        Walk {
            edge: e[1] - e[0],
            moment: self.first_moment,
            flux: self.flux_in,
        }
    }
}

/// The densities by node, with `1/h²` and `1/h⁴` in them.
struct Weights<A, B, C> {
    w0: A,
    w1: B,
    w2: C,
}

impl Weights<(), (), ()> {
    fn uniform(
        [w0, w1, w2]: [f64; 3],
    ) -> Weights<impl Fn(usize) -> f64, impl Fn(usize) -> f64, impl Fn(usize) -> f64> {
        Weights {
            w0: move |_| w0,
            w1: move |_| w1,
            w2: move |_| w2,
        }
    }
}

impl<A: Fn(usize) -> f64, B: Fn(usize) -> f64, C: Fn(usize) -> f64> Weights<A, B, C> {
    /// The forces on all nodes of `e` but the last two, and what the walk hands on to those.
    #[inline(always)]
    fn walk(&self, e: &[DVec2], start: Walk, force: &mut [DVec2]) -> Walk {
        let Walk {
            mut edge,
            mut moment,
            mut flux,
        } = start;
        for (i, (out, three)) in force.iter_mut().zip(e.windows(3)).enumerate() {
            let next_edge = three[2] - three[1];
            let next_moment = (self.w2)(i + 1) * (next_edge - edge);
            let next_flux = (self.w1)(i) * edge - (next_moment - moment);
            *out = (next_flux - flux) - (self.w0)(i) * three[0];
            (edge, moment, flux) = (next_edge, next_moment, next_flux);
        }
        Walk { edge, moment, flux }
    }

    /// The forces on the last two nodes.
    #[inline(always)]
    fn finish(&self, e: &[DVec2], walk: Walk, boundary: &Boundary, force: &mut [DVec2]) {
        let i = e.len() - 2;
        let flux = (self.w1)(i) * walk.edge - (boundary.last_moment - walk.moment);
        force[i] = (flux - walk.flux) - (self.w0)(i) * e[i];
        force[i + 1] = (boundary.flux_out - flux) - (self.w0)(i + 1) * e[i + 1];
    }

    /// What a walk would hand on to node `i`, neither of the first two nor the last.
    fn resume(&self, e: &[DVec2], i: usize) -> Walk {
        let before = (self.w2)(i - 1) * second(e, i - 1);
        let moment = (self.w2)(i) * second(e, i);
        let flux = (self.w1)(i - 1) * (e[i] - e[i - 1]) - (moment - before);
        Walk {
            edge: e[i + 1] - e[i],
            moment,
            flux,
        }
    }

    /// The one place where the force asks what the ends are.
    fn boundary(&self, e: &[DVec2], topology: Topology) -> Boundary {
        let (w1, w2) = (&self.w1, &self.w2);
        let last = e.len() - 1;
        let first_edge = e[1] - e[0];
        let last_edge = e[last] - e[last - 1];
        let (head, tail) = match topology {
            Topology::Open { head, tail } => (head, tail),
            Topology::Closed => {
                let seam = e[0] - e[last];
                let first_moment = w2(0) * (first_edge - seam);
                let last_moment = w2(last) * (seam - last_edge);
                let flux = w1(last) * seam - (first_moment - last_moment);
                return Boundary {
                    first_moment,
                    flux_in: flux,
                    last_moment,
                    flux_out: flux,
                };
            }
        };
        let (first_moment, flux_in) = match head {
            End::Free | End::Pinned => (DVec2::ZERO, DVec2::ZERO),
            // half the moment of a bend between mirror images, taken up by the vice on both sides
            End::Clamped => (2.0 * w2(0) * first_edge, DVec2::ZERO),
            End::Anchored => {
                let edge = e[0];
                let moment = w2(0) * (first_edge - edge);
                (moment, w1(0) * edge - (moment - w2(0) * edge))
            }
        };
        let (last_moment, flux_out) = match tail {
            End::Free | End::Pinned => (DVec2::ZERO, DVec2::ZERO),
            End::Clamped => (-2.0 * w2(last) * last_edge, DVec2::ZERO),
            End::Anchored => {
                let edge = -e[last];
                let moment = w2(last) * (edge - last_edge);
                (moment, w1(last) * edge - (w2(last) * -edge - moment))
            }
        };
        Boundary {
            first_moment,
            flux_in,
            last_moment,
            flux_out,
        }
    }
}

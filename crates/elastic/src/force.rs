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

use crate::{End, Material, Profile, Topology};
use glam::DVec2;

/// Elastic force on every node: what the curve feels for not being at rest.
///
/// ```text
/// F[i] = − ω₀ e[i] + D₁⁻(ω₁ D₁⁺ e)[i] − D₂(ω₂ D₂ e)[i]
/// ```
///
/// `e` holds one deformation a node; `force` has the same length and is overwritten. Per arc length:
/// M L T⁻². O(n), allocates nothing. It is `−K e` with K of [`stiffness`](crate::stiffness), and minus
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
    if let (Profile::Uniform(w0), Profile::Uniform(w1), Profile::Uniform(w2)) =
        (&material.tether, &material.tension, &material.rigidity)
    {
        let (w0, w1, w2) = (*w0, w1 * per_h2, w2 * per_h4);
        walk(e, topology, |_| w0, |_| w1, |_| w2, force);
    } else {
        let (w0, w1, w2) = (
            Lane::new(&material.tether),
            Lane::new(&material.tension),
            Lane::new(&material.rigidity),
        );
        walk(
            e,
            topology,
            |i| w0.at(i),
            |i| w1.at(i) * per_h2,
            |i| w2.at(i) * per_h4,
            force,
        );
    }
}

/// Moments and fluxes where the curve begins and ends.
struct Boundary {
    first_moment: DVec2,
    flux_in: DVec2,
    last_moment: DVec2,
    flux_out: DVec2,
}

/// The loop of the module's head, over weights that already hold `1/h²` and `1/h⁴`.
#[inline(always)]
fn walk(
    e: &[DVec2],
    topology: Topology,
    w0: impl Fn(usize) -> f64,
    w1: impl Fn(usize) -> f64,
    w2: impl Fn(usize) -> f64,
    force: &mut [DVec2],
) {
    let n = e.len();
    let Boundary {
        first_moment,
        flux_in,
        last_moment,
        flux_out,
    } = boundary(e, topology, &w1, &w2);
    let mut edge = e[1] - e[0];
    let mut moment = first_moment;
    let mut flux = flux_in;
    for (i, (out, three)) in force.iter_mut().zip(e.windows(3)).enumerate() {
        let next_edge = three[2] - three[1];
        let next_moment = w2(i + 1) * (next_edge - edge);
        let next_flux = w1(i) * edge - (next_moment - moment);
        *out = (next_flux - flux) - w0(i) * three[0];
        (edge, moment, flux) = (next_edge, next_moment, next_flux);
    }
    let next_flux = w1(n - 2) * edge - (last_moment - moment);
    force[n - 2] = (next_flux - flux) - w0(n - 2) * e[n - 2];
    force[n - 1] = (flux_out - next_flux) - w0(n - 1) * e[n - 1];
}

fn boundary(
    e: &[DVec2],
    topology: Topology,
    w1: impl Fn(usize) -> f64,
    w2: impl Fn(usize) -> f64,
) -> Boundary {
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
        End::Anchored => {
            let edge = e[0];
            let moment = w2(0) * (first_edge - edge);
            (moment, w1(0) * edge - (moment - w2(0) * edge))
        }
    };
    let (last_moment, flux_out) = match tail {
        End::Free | End::Pinned => (DVec2::ZERO, DVec2::ZERO),
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

/// A profile read without a branch: a uniform one is a slice of one value, met at every index.
struct Lane<'a> {
    values: &'a [f64],
    mask: usize,
}

impl<'a> Lane<'a> {
    fn new(profile: &'a Profile) -> Self {
        match profile {
            Profile::Uniform(value) => Self {
                values: std::slice::from_ref(value),
                mask: 0,
            },
            Profile::PerNode(values) => Self {
                values,
                mask: usize::MAX,
            },
        }
    }

    #[inline(always)]
    fn at(&self, i: usize) -> f64 {
        self.values[i & self.mask]
    }
}

//! How stiff the curve is where one stands on it, and damping made from that.
//!
//! One constant γ suits one mode (D23). Two other rules need only the material: *local* damping, critical for
//! a node between neighbours that stay, and *internal* damping, proportional to stiffness, which acts on
//! bending and stretching and leaves the curve to fly and to spin as it likes. Neither is best for every mode:
//! the first grows with the number of nodes, since one node between two fixed ones is a stiff thing, and lets
//! long waves creep; the second lets long waves ring. The slope of the image belongs to whoever knows the image.

use crate::{ElasticError, Material, Motion, Profile, Topology, elastic_force, stiffness};
use glam::DVec2;

/// The stiffness one node feels while all others stay: the diagonal of K. M T⁻².
///
/// ```text
/// kᵢ = K[i][i],   inside ω₀ + 2 ω₁/h² + 6 ω₂/h⁴ for uniform densities
/// ```
///
/// One value a node. Between the least and the largest eigenvalue of K. O(n).
///
/// # Errors
///
/// As [`stiffness`].
pub fn local_stiffness(
    topology: Topology,
    material: &Material,
    spacing: f64,
    n: usize,
) -> Result<Vec<f64>, ElasticError> {
    Ok(stiffness(topology, material, spacing, n)?
        .diagonal()
        .to_vec())
}

/// The most stiffness a node can feel, whatever the others do: Gershgorin's bound, row by row. M T⁻².
///
/// ```text
/// Rᵢ = Σⱼ |K[i][j]|,   λ(M⁻¹K) ≤ max Rᵢ/μᵢ
/// ```
///
/// One value a node, at least [`local_stiffness`]. For uniform densities inside it is
/// ω₀ + 4 ω₁/h² + 16 ω₂/h⁴, which a ring of an even number of nodes reaches. Unlike one bound for all nodes it knows
/// that a stiff place may be heavy. O(n). `[golub13]`, 7.2.
///
/// # Errors
///
/// As [`stiffness`].
pub fn greatest_stiffness(
    topology: Topology,
    material: &Material,
    spacing: f64,
    n: usize,
) -> Result<Vec<f64>, ElasticError> {
    let k = stiffness(topology, material, spacing, n)?;
    let mut rows: Vec<f64> = k.diagonal().to_vec();
    for reach in 1..=k.half_width() {
        for i in 0..n {
            let entry = k.beside(i, reach).abs();
            rows[i] += entry;
            rows[(i + reach) % n] += entry;
        }
    }
    Ok(rows)
}

/// The damping density that is critical for each node alone. M T⁻¹.
///
/// ```text
/// γᵢ = 2 √(μᵢ kᵢ)
/// ```
///
/// `stiffness` has one value a node: of [`local_stiffness`], of the tether alone, of one mode; the slope of the image
/// under the node may have been added. Where it is negative the node is driven away and cannot ring: 0.
/// With k of [`local_stiffness`] a ring of uniform densities has at least √(6/16) = 0.61 of the critical damping in every
/// mode, most of it in the longest: those decay at about λ/γ, slowly on many nodes. Report §3.4.2.
#[must_use]
pub fn critical_damping(mass: &Profile, stiffness: &[f64]) -> Vec<f64> {
    let each = stiffness.iter().enumerate();
    each.map(|(i, k)| 2.0 * (mass.at(i) * k.max(0.0)).sqrt())
        .collect()
}

impl Material {
    /// The densities of internal damping: tension, rigidity and those above times a `time`, and no tether.
    ///
    /// ```text
    /// force = − β K v = elastic_force(v, …, damper),   β = time
    /// ```
    ///
    /// The force is that of [`elastic_force`] on velocities in place of deformations. Mode λ is damped like γ = β λ:
    /// critically where β = 2 √(μ/λ), less below, more above. The tether is left out, for it would brake the
    /// curve in flight. An explicit step needs β λ dt < 2 μ besides its own limit. Rayleigh's damping.
    #[must_use]
    pub fn damper(&self, time: f64) -> Self {
        Self {
            tether: Profile::Uniform(0.0),
            tension: self.tension.scaled(time),
            rigidity: self.rigidity.scaled(time),
            higher: self.higher.iter().map(|w| w.scaled(time)).collect(),
        }
    }
}

/// Damping inside the curve, of any curve that moves: nothing of it slows a flight or a spin.
///
/// ```text
/// F = − Pᵀ K P v,   P v = v − ċ − ω × q,   K of the damper
/// ```
///
/// P takes out the rigid part of a motion (it is the projection of least kinetic energy), its transpose hands the
/// sum of the forces and their torque back in proportion to mass. So both momenta are kept exactly, the power is
/// never positive, and a rigid motion feels nothing but rounding.
#[derive(Debug, Clone, Copy)]
pub struct InternalDamping<'a> {
    /// Which differences there are.
    pub topology: Topology,
    /// The densities of [`Material::damper`].
    pub damper: &'a Material,
    /// Mass density.
    pub mass: &'a Profile,
    /// Spacing at rest.
    pub spacing: f64,
}

impl InternalDamping<'_> {
    /// The damping force on every node. Per arc length: M L T⁻².
    ///
    /// `seen` is memory of the same length: the velocities without the rigid part. O(n), allocates nothing. What is in
    /// the struct is trusted, as by [`elastic_force`].
    pub fn force(
        &self,
        nodes: &[DVec2],
        velocities: &[DVec2],
        seen: &mut [DVec2],
        force: &mut [DVec2],
    ) {
        let motion = Motion::of(nodes, velocities, self.mass, self.spacing);
        for (seen, (x, v)) in seen.iter_mut().zip(nodes.iter().zip(velocities)) {
            *seen = *v - motion.rigid(*x);
        }
        elastic_force(seen, self.topology, self.damper, self.spacing, force);
        let (mut sum, mut torque) = (DVec2::ZERO, 0.0);
        for (x, f) in nodes.iter().zip(&*force) {
            sum += *f;
            torque += (*x - motion.center).perp_dot(*f);
        }
        let per = |total: f64| {
            if total > 0.0 {
                self.spacing / total
            } else {
                0.0
            }
        };
        let (push, twist) = (per(motion.mass) * sum, per(motion.inertia) * torque);
        for (i, (x, f)) in nodes.iter().zip(force).enumerate() {
            *f -= self.mass.at(i) * (push + twist * (*x - motion.center).perp());
        }
    }
}

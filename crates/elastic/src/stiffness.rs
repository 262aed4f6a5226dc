//! The stiffness matrix K, assembled from differences.
//!
//! ```text
//! K = ω₀ I + D₁ᵀ ω₁ D₁ / h² + D₂ᵀ ω₂ D₂ / h⁴
//! ```
//!
//! with one row of D₁ for each edge that exists and one row of D₂ for each bend. Whatever the ends and
//! the densities, K is then symmetric and never negative, and the force −K e is minus the gradient of
//! the energy per arc length. K does not know of pinned nodes: whoever holds them takes their rows and
//! columns out.

use crate::{Bound, ElasticError, Material, Profile, Topology};
use banded::Pentadiagonal;

/// The stiffness matrix of a curve: `−K e` is the elastic force on its nodes.
///
/// ```text
/// K = ω₀ I + D₁ᵀ ω₁ D₁ / h² + D₂ᵀ ω₂ D₂ / h⁴
/// ```
///
/// `n` × `n`, pentadiagonal, cyclic if the curve is closed. Per arc length: M T⁻². O(n).
///
/// Inside, a row of uniform densities reads `ω₂/h⁴, −ω₁/h² − 4ω₂/h⁴, ω₀ + 2ω₁/h² + 6ω₂/h⁴, …`, report
/// Eq. 3.2. With both ends [anchored](crate::End::Anchored) it is the matrix of the report's program
/// (D3). [Pinned](crate::End::Pinned) ends are not masked here: see
/// [`Topology::held`].
///
/// # Errors
///
/// Too few nodes, densities that do not fit or are not sound, a spacing that is not finite and above 0,
/// or so small that `h⁴` vanishes.
pub fn stiffness(
    topology: Topology,
    material: &Material,
    spacing: f64,
    n: usize,
) -> Result<Pentadiagonal, ElasticError> {
    topology.check_count(n)?;
    material.validate(n)?;
    let (per_h2, per_h4) = inverse_powers(spacing)?;
    let mut k = Pentadiagonal::new(n, topology.is_closed())?;
    k.add_diagonal(&material.tether.to_vec(n));
    for edge in topology.edges(n) {
        add(
            &mut k,
            material.tension.at(edge.weight) * per_h2,
            edge.nodes,
            [-1.0, 1.0],
        );
    }
    for bend in topology.bends(n) {
        add(
            &mut k,
            material.rigidity.at(bend.weight) * per_h4,
            bend.nodes,
            [1.0, -2.0, 1.0],
        );
    }
    Ok(k)
}

/// The matrix as the report's text prints it, wrong on purpose: only to show what is wrong with it.
///
/// ```text
/// K = (ω₀ − 2ω₁ + 6ω₂) I + (ω₁ − 4ω₂) J + ω₂ L
/// ```
///
/// J and L have ones on the first and second off-diagonals. The sign of ω₁ is turned round in both
/// places (D1), so K is indefinite once `ω₁² > 4 ω₀ ω₂` and the curve grows without bound at any time
/// step; and there is no `h` (D2). The report's own program is right: [`stiffness`] with anchored ends.
///
/// # Errors
///
/// Fewer than 3 nodes, or parameters that are negative or not finite.
pub fn stiffness_as_printed(
    tether: f64,
    tension: f64,
    rigidity: f64,
    n: usize,
) -> Result<Pentadiagonal, ElasticError> {
    if n < 3 {
        return Err(ElasticError::TooFewNodes { needed: 3, got: n });
    }
    for (name, value) in [
        ("tether", tether),
        ("tension", tension),
        ("rigidity", rigidity),
    ] {
        Profile::Uniform(value).validate(name, n, Bound::AtLeast(0.0))?;
    }
    let mut k = Pentadiagonal::new(n, false)?;
    k.add_identity(tether - 2.0 * tension + 6.0 * rigidity);
    for (reach, entry) in [(1, tension - 4.0 * rigidity), (2, rigidity)] {
        for i in 0..n - reach {
            k.add(i, i + reach, entry);
        }
    }
    Ok(k)
}

/// `1/h²` and `1/h⁴`.
fn inverse_powers(spacing: f64) -> Result<(f64, f64), ElasticError> {
    let per_h2 = 1.0 / (spacing * spacing);
    let per_h4 = per_h2 * per_h2;
    if spacing > 0.0 && spacing.is_finite() && per_h4.is_finite() {
        Ok((per_h2, per_h4))
    } else {
        Err(ElasticError::BadSpacing { value: spacing })
    }
}

/// Adds `weight · r rᵀ`, where `r` has the coefficients at those nodes that are real.
fn add<const M: usize>(
    k: &mut Pentadiagonal,
    weight: f64,
    nodes: [Option<usize>; M],
    coefficients: [f64; M],
) {
    let mut row = [(0, 0.0); M];
    let mut count = 0;
    for (node, coefficient) in nodes.into_iter().zip(coefficients) {
        if let Some(i) = node {
            row[count] = (i, coefficient);
            count += 1;
        }
    }
    k.add_outer(weight, &row[..count]);
}

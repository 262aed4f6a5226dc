//! The stiffness matrix K, assembled from differences.
//!
//! ```text
//! K = ω₀ I + D₁ᵀ ω₁ D₁ / h² + D₂ᵀ ω₂ D₂ / h⁴ + …
//! ```
//!
//! with one row of D₁ for each edge that exists, one row of D₂ for each bend, and so on to the order of the material. Whatever the ends and
//! the densities, K is then symmetric and never negative, and the force −K e is minus the gradient of
//! the energy per arc length. K does not know of pinned and clamped nodes: whoever holds them takes their rows
//! and columns out.

use crate::{Bound, ElasticError, Kernel, Material, Profile, Topology};
use banded::{Band, Pentadiagonal};
use std::ops::RangeInclusive;

/// The stiffness matrix of a curve: `−K e` is the elastic force on its nodes.
///
/// ```text
/// K = ω₀ I + D₁ᵀ ω₁ D₁ / h² + D₂ᵀ ω₂ D₂ / h⁴ + … + Dₚᵀ ωₚ Dₚ / h²ᵖ
/// ```
///
/// `n` × `n`, p diagonals on either side (two at least: pentadiagonal), cyclic if the curve is closed. Per arc length:
/// M T⁻². O(n p²).
///
/// Inside, a row of uniform densities reads `ω₂/h⁴, −ω₁/h² − 4ω₂/h⁴, ω₀ + 2ω₁/h² + 6ω₂/h⁴, …`, report
/// Eq. 3.2. With both ends [anchored](crate::End::Anchored) it is the matrix of the report's program
/// (D3). [Pinned](crate::End::Pinned) and [clamped](crate::End::Clamped) ends are not masked here: see
/// [`Topology::held`].
///
/// # Errors
///
/// Too few nodes, densities that do not fit or are not sound, a spacing that is 0, negative, not a number or
/// out of all measure, or a K that is not finite. Above order 2, as [`Kernel::stiffness`].
pub fn stiffness(
    topology: Topology,
    material: &Material,
    spacing: f64,
    n: usize,
) -> Result<Band, ElasticError> {
    topology.check_count(n)?;
    material.validate(n)?;
    if material.order() > 2 {
        let k = Kernel::from(material).stiffness(topology, spacing, n)?;
        return Ok(k.into());
    }
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
            bend.share * material.rigidity.at(bend.weight) * per_h4,
            bend.nodes,
            [1.0, -2.0, 1.0],
        );
    }
    if k.norm().is_finite() {
        Ok(k.into())
    } else {
        Err(ElasticError::TooStiff { spacing })
    }
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

/// Spacings whose fourth power is a number: whatever the unit, no curve is drawn outside these.
pub(crate) const SPACINGS: RangeInclusive<f64> = 1e-75..=1e75;

/// `1/h²` and `1/h⁴`.
fn inverse_powers(spacing: f64) -> Result<(f64, f64), ElasticError> {
    if !SPACINGS.contains(&spacing) {
        return Err(ElasticError::BadSpacing { value: spacing });
    }
    let per_h2 = 1.0 / (spacing * spacing);
    Ok((per_h2, per_h2 * per_h2))
}

/// Adds `weight · r rᵀ`, where `r` has the coefficients at those nodes that are real.
pub(crate) fn add<const M: usize>(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::End;

    const FREE: Topology = Topology::open(End::Free);

    fn refused(topology: Topology, material: &Material, spacing: f64, n: usize) -> String {
        stiffness(topology, material, spacing, n)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn a_bump_at_node_0_gives_the_first_column() {
        let k = stiffness(
            Topology::Closed,
            &Material::uniform(1.0, 10.0, 100.0),
            1.0,
            7,
        )
        .unwrap();
        let column: Vec<_> = (0..7).map(|i| k.entry(i, 0)).collect();
        assert_eq!(column, [621.0, -410.0, 100.0, 0.0, 0.0, 100.0, -410.0]);
        let k = stiffness(FREE, &Material::uniform(1.0, 10.0, 100.0), 1.0, 5).unwrap();
        let column: Vec<_> = (0..5).map(|i| k.entry(i, 0)).collect();
        assert_eq!(column, [111.0, -210.0, 100.0, 0.0, 0.0]);
    }

    #[test]
    fn waves_round_a_ring_are_its_modes() {
        let (w0, w1, w2, h, n) = (0.3, 5.0, 2.0, 0.8_f64, 15);
        let k = stiffness(Topology::Closed, &Material::uniform(w0, w1, w2), h, n).unwrap();
        for wave in 0..=7 {
            let theta = std::f64::consts::TAU * f64::from(wave) / n as f64;
            let sine = (theta / 2.0).sin().powi(2);
            let lambda = w0 + 4.0 * w1 / h.powi(2) * sine + 16.0 * w2 / h.powi(4) * sine * sine;
            let mode: Vec<_> = (0..n).map(|i| (theta * i as f64).cos()).collect();
            let mut product = vec![0.0; n];
            k.multiply_scalars_into(&mode, &mut product);
            for (p, e) in product.iter().zip(&mode) {
                assert!((p - lambda * e).abs() < 1e-14 * k.norm(), "wave {wave}");
            }
        }
    }

    #[test]
    fn a_spacing_that_cannot_be_divided_by_is_refused() {
        let material = Material::uniform(1.0, 1.0, 1.0);
        for bad in [
            -1.0,
            1e-100,
            1e100,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ] {
            let words = refused(FREE, &material, bad, 5);
            assert_eq!(
                words,
                format!("the spacing must be from 1e-75 to 1e75, got {bad}")
            );
        }
        let words = refused(FREE, &material, 0.0, 5);
        assert!(words.ends_with("got 0; do all nodes coincide?"), "{words}");
        assert!(stiffness(FREE, &material, 1e-75, 5).is_ok());
    }

    #[test]
    fn densities_that_overflow_are_refused() {
        let words = refused(FREE, &Material::uniform(0.0, 1e200, 0.0), 1e-70, 5);
        assert!(
            words.starts_with("the densities are too large for a spacing of"),
            "{words}"
        );
    }

    #[test]
    fn what_is_wrong_with_a_material_is_said_before_anything_is_built() {
        let words = refused(FREE, &Material::uniform(0.0, f64::INFINITY, 0.0), 1.0, 5);
        assert_eq!(words, "tension must be finite and at least 0, got inf");
        let mut material = Material::uniform(0.0, 1.0, 0.0);
        material.rigidity = vec![1.0, 1.0, -0.5, 1.0, 1.0].into();
        let words = refused(FREE, &material, 1.0, 5);
        assert_eq!(
            words,
            "rigidity must be finite and at least 0, got -0.5 at node 2"
        );
        let words = refused(Topology::Closed, &material, 1.0, 6);
        assert_eq!(
            words,
            "rigidity must have one value for each of the 6 nodes, got 5"
        );
        let words = stiffness_as_printed(1.0, -1.0, 1.0, 5)
            .unwrap_err()
            .to_string();
        assert_eq!(words, "tension must be finite and at least 0, got -1");
    }
}

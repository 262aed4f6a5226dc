//! From a body and the factors of its schedules and maps to what the schemes ask for.

use banded::Operator;
use elastic::{End, Material, Topology};

use crate::factors::Factors;
use crate::{Body, Center, Parameter, SnakeError};

/// The parameters of `body` times their factors.
pub(crate) fn scaled(body: &Body, factors: &Factors) -> Parameters {
    let n = body.len();
    (
        factors.material(&body.material),
        factors.times(Parameter::Mass, &body.mass).to_vec(n),
        factors.times(Parameter::Damping, &body.damping).to_vec(n),
    )
}

/// Whether the reaction of the frame has anything to take out of `−K e`.
///
/// The sum of `−K e` is `−Σ kⱼ eⱼ` with `k = K 1`. Closed or with natural ends, k is the tether
/// alone; where that and the mass are the same everywhere, the sum is that of e, which is zero
/// about the mean.
pub(crate) fn pushes(body: &Body, material: &Material) -> bool {
    let natural = match body.topology {
        Topology::Closed => true,
        Topology::Open { head, tail } => head != End::Anchored && tail != End::Anchored,
    };
    let even = body.frame.center == Center::Mean || body.mass.is_uniform();
    body.frame.reaction && !(natural && even && material.tether.is_uniform())
}

type Parameters = (Material, Vec<f64>, Vec<f64>);

/// The operator `Pᵀ K P`, held nodes taken out: K, and a correction of rank two for the frame.
///
/// ```text
/// P = I − 1 wᵀ,   Pᵀ K P = K − w kᵀ − k wᵀ + s w wᵀ,   k = K 1,   s = 1ᵀ K 1
/// ```
///
/// Without reaction (the report's frame) the force is `−K P x`, which is not symmetric; what is
/// returned then is its symmetric part up to rank two, `K − ½ (w kᵀ + k wᵀ)`. The implicit schemes
/// need the exact one and refuse such a frame where the difference matters. Where k = s w both are
/// `K − s w wᵀ`.
pub(crate) fn operator(
    body: &Body,
    material: &Material,
    weights: &[f64],
    held: &[bool],
) -> Result<Operator, SnakeError> {
    let n = body.len();
    let band = elastic::stiffness(body.topology, material, body.spacing, n)?;
    let mut row_sums = vec![0.0; n];
    band.multiply_scalars_into(&vec![1.0; n], &mut row_sums);
    let scale = band.diagonal().iter().fold(0.0_f64, |a, d| a.max(d.abs()));
    let drift = row_sums.iter().fold(0.0_f64, |a, k| a.max(k.abs()));
    let mut masked = band;
    masked.hold(held);
    if drift <= 1e-13 * scale {
        return Ok(Operator::from(masked));
    }
    let total: f64 = row_sums.iter().sum();
    let free = |values: &[f64]| -> Vec<f64> {
        values
            .iter()
            .zip(held)
            .map(|(&v, &h)| if h { 0.0 } else { v })
            .collect()
    };
    let along = |(&k, &w): (&f64, &f64)| (k - total * w).abs() <= 1e-13 * scale;
    if row_sums.iter().zip(weights).all(along) {
        // k = s w, as where tether and mass are the same everywhere: one column is enough
        let one = Operator::new(masked, vec![free(weights)], vec![-total]);
        return one.map_err(|error| SnakeError::Elastic(error.into()));
    }
    let middle = if body.frame.reaction {
        vec![total, -1.0, -1.0, 0.0]
    } else {
        vec![0.0, -0.5, -0.5, 0.0]
    };
    let columns = vec![free(weights), free(&row_sums)];
    Operator::new(masked, columns, middle).map_err(|error| SnakeError::Elastic(error.into()))
}

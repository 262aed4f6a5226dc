//! Taking a linear system apart into independent oscillators.
//!
//! A closed curve of equal nodes is cyclic: waves round it are its modes, and a Fourier transform finds
//! their amplitudes. For any other the eigenvectors of `M^-½ A M^-½` do, once, for as long as there are
//! not too many. Both need one damping for all: γ/μ the same at every node.

use banded::{Circulant, Dense};
use glam::DVec2;

use crate::{SchemeError, System};

/// The most nodes whose eigenvectors are computed: 1.7 seconds (measured, one busy core) and 8 MiB.
pub(crate) const MOST: usize = 1024;

/// γ/μ of two nodes counts as the same within this, relative: rounding of profiles and schedules.
const SAME: f64 = 1e-12;

/// The oscillators, and the way there and back.
#[derive(Debug, Clone)]
pub(crate) struct Modes {
    /// Stiffness over mass of each mode; never negative.
    pub(crate) stiffness: Vec<f64>,
    /// Damping over mass of all modes.
    pub(crate) damping: f64,
    basis: Basis,
}

#[derive(Debug, Clone)]
enum Basis {
    /// Waves round the ring.
    Waves(Box<Circulant>),
    /// Eigenvectors, row by row, in positions times √μ.
    Vectors {
        rows: Vec<Vec<f64>>,
        root: Vec<f64>,
        scaled: Vec<DVec2>,
    },
}

impl Modes {
    pub(crate) fn new(scheme: &'static str, system: &dyn System) -> Result<Self, SchemeError> {
        let damping = common_damping(scheme, system)?;
        match waves(system) {
            Some((circulant, stiffness)) => Ok(Self {
                stiffness,
                damping,
                basis: Basis::Waves(Box::new(circulant)),
            }),
            None => vectors(scheme, system, damping),
        }
    }

    /// Amplitudes of positions or velocities.
    pub(crate) fn amplitudes(&mut self, x: &[DVec2], modes: &mut [DVec2]) {
        match &mut self.basis {
            Basis::Waves(circulant) => circulant.to_modes(x, modes),
            Basis::Vectors { rows, root, scaled } => {
                for (scaled, (x, root)) in scaled.iter_mut().zip(x.iter().zip(&*root)) {
                    *scaled = *x * *root;
                }
                for (mode, row) in modes.iter_mut().zip(&*rows) {
                    *mode = row.iter().zip(&*scaled).map(|(&r, &x)| x * r).sum();
                }
            }
        }
    }

    /// Positions or velocities of amplitudes.
    pub(crate) fn points(&mut self, modes: &[DVec2], x: &mut [DVec2]) {
        match &mut self.basis {
            Basis::Waves(circulant) => circulant.from_modes(modes, x),
            Basis::Vectors { rows, root, .. } => {
                x.fill(DVec2::ZERO);
                for (mode, row) in modes.iter().zip(&*rows) {
                    for (x, &r) in x.iter_mut().zip(row) {
                        *x += *mode * r;
                    }
                }
                for (x, root) in x.iter_mut().zip(&*root) {
                    *x /= *root;
                }
            }
        }
    }
}

/// γ/μ of all nodes that can move.
fn common_damping(scheme: &'static str, system: &dyn System) -> Result<f64, SchemeError> {
    let free = (0..system.len()).filter(|&i| !system.held()[i]);
    let mut ratios = free.map(|i| system.damping()[i] / system.mass()[i]);
    let Some(first) = ratios.next() else {
        return Ok(0.0);
    };
    match ratios.find(|ratio| (ratio - first).abs() > SAME * first.abs()) {
        None => Ok(first),
        Some(other) => Err(SchemeError::NoModes {
            scheme,
            why: format!(
                "damping over mass must be the same at every node, here it is {first} and {other}; \
                 radau-5 does without"
            ),
        }),
    }
}

/// The waves of a closed curve of equal nodes.
fn waves(system: &dyn System) -> Option<(Circulant, Vec<f64>)> {
    let operator = system.stiffness();
    let mass = *system.mass().first()?;
    let equal = |values: &[f64]| {
        values
            .iter()
            .all(|value| value.to_bits() == values[0].to_bits())
    };
    let even = !system.held().contains(&true)
        && equal(system.mass())
        && operator.columns().iter().all(|column| equal(column));
    if !even {
        return None;
    }
    let circulant = Circulant::new(operator.band()).ok()?;
    let over_mass = |value: f64| (value / mass).max(0.0);
    let mut stiffness: Vec<f64> = circulant
        .eigenvalues()
        .iter()
        .map(|&value| over_mass(value))
        .collect();
    if !operator.columns().is_empty() {
        // what all nodes share changes the mode in which all move alike, and no other
        let mut product = vec![0.0; operator.len()];
        operator.multiply_scalars_into(&vec![1.0; operator.len()], &mut product);
        stiffness[0] = over_mass(product.iter().sum::<f64>() / operator.len() as f64);
    }
    Some((circulant, stiffness))
}

fn vectors(scheme: &'static str, system: &dyn System, damping: f64) -> Result<Modes, SchemeError> {
    let n = system.len();
    if n > MOST {
        let why = format!(
            "it is not a closed curve of equal nodes, and its {n} nodes are more than the {MOST} \
             whose eigenvectors are computed; radau-5 does without"
        );
        return Err(SchemeError::NoModes { scheme, why });
    }
    let held = system.held();
    let root: Vec<f64> = (0..n)
        .map(|i| {
            if held[i] {
                1.0
            } else {
                system.mass()[i].sqrt()
            }
        })
        .collect();
    let matrix = system.stiffness().dense();
    let eigen = Dense::from_fn(n, |i, j| matrix[(i, j)] / (root[i] * root[j])).eigen()?;
    let stiffness = eigen.values.iter().map(|value| value.max(0.0)).collect();
    let scaled = vec![DVec2::ZERO; n];
    let basis = Basis::Vectors {
        rows: eigen.vectors,
        root,
        scaled,
    };
    Ok(Modes {
        stiffness,
        damping,
        basis,
    })
}

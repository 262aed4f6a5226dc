//! The matrix of an implicit step, kept factored.
//!
//! Every scheme that takes the elastic force at the end of its step solves with
//! `S = p M + q C + A` for the increment of the positions, with `p` and `q` its own. The factor is
//! made once and again only when a schedule changes mass, damping or stiffness.

use banded::{Operator, OperatorFactor};
use glam::DVec2;

use crate::stepper::{self, Mass};
use crate::{Fault, SchemeError, System, Touch};

/// How much stiffer than its own row of `S` a node in contact is made.
const FIRM: f64 = 1e4;

/// `S = p M + q C + A`, factored.
#[derive(Debug)]
pub(crate) struct Solver {
    name: &'static str,
    need: Mass,
    /// `p` and `q`.
    weights: (f64, f64),
    matrix: Operator,
    factor: OperatorFactor,
    diagonal: Vec<f64>,
    /// Which nodes were in contact when `firm` was made.
    touching: Vec<bool>,
    now: Vec<bool>,
    firm: Option<OperatorFactor>,
    product: Vec<DVec2>,
}

impl Solver {
    pub(crate) fn new(
        name: &'static str,
        need: Mass,
        system: &dyn System,
        weights: (f64, f64),
    ) -> Result<Self, SchemeError> {
        let n = system.len();
        let mut diagonal = vec![0.0; n];
        fill(&mut diagonal, system, weights);
        let matrix = system.stiffness().shifted(1.0, &diagonal);
        let factor = matrix.factor()?;
        Ok(Self {
            name,
            need,
            weights,
            matrix,
            factor,
            diagonal,
            touching: vec![false; n],
            now: vec![false; n],
            firm: None,
            product: vec![DVec2::ZERO; n],
        })
    }

    /// Bring the system to time `t`, and the factor with it; true if it changed.
    pub(crate) fn advance(
        &mut self,
        system: &mut dyn System,
        t: f64,
        x: &[DVec2],
    ) -> Result<bool, Fault> {
        if !system.advance(t) {
            return Ok(false);
        }
        stepper::densities(self.name, system, self.need).map_err(|_| stepper::unsolvable(x))?;
        fill(&mut self.diagonal, system, self.weights);
        self.matrix = system.stiffness().shifted(1.0, &self.diagonal);
        self.factor = self.matrix.factor().map_err(|_| stepper::unsolvable(x))?;
        self.firm = None;
        Ok(true)
    }

    /// `S`.
    pub(crate) fn matrix(&self) -> &Operator {
        &self.matrix
    }

    /// Turn the forces `b` into the increment `S⁻¹ b`; `b` must be zero at held nodes.
    pub(crate) fn solve(&self, b: &mut [DVec2]) {
        self.factor.solve(b);
    }

    /// Whether a node was in contact at the last [`follow`](Self::follow).
    pub(crate) fn touches(&self, node: usize) -> bool {
        self.now[node]
    }

    /// Let the other nodes follow those in contact.
    ///
    /// `shift` says how far each touched node is moved and becomes how far every node is: the step is
    /// solved again with the touched ones where they must be. Keeps its factor as long as the same
    /// nodes touch.
    pub(crate) fn follow(&mut self, touches: &[Touch], shift: &mut [DVec2]) {
        self.now.fill(false);
        for touch in touches {
            self.now[touch.node] = true;
        }
        if self.firm.is_none() || self.now != self.touching {
            self.touching.copy_from_slice(&self.now);
            let band = self.matrix.band().diagonal();
            for (i, extra) in self.diagonal.iter_mut().enumerate() {
                *extra = if self.touching[i] {
                    FIRM * band[i]
                } else {
                    0.0
                };
            }
            self.firm = self.matrix.shifted(1.0, &self.diagonal).factor().ok();
        }
        let Some(firm) = &self.firm else { return };
        // (S + P) Δ = P shift, with P large at the touched nodes and zero elsewhere
        for (i, product) in self.product.iter_mut().enumerate() {
            let stiff = if self.touching[i] {
                FIRM * self.matrix.band().diagonal()[i]
            } else {
                0.0
            };
            *product = stiff * shift[i];
        }
        firm.solve(&mut self.product);
        for (i, shift) in shift.iter_mut().enumerate() {
            if !self.touching[i] {
                *shift = self.product[i];
            }
        }
    }
}

fn fill(diagonal: &mut [f64], system: &dyn System, (p, q): (f64, f64)) {
    let (mass, damping, held) = (system.mass(), system.damping(), system.held());
    for i in 0..diagonal.len() {
        // a held node stays where it is whatever stands here, so long as it is not zero
        diagonal[i] = if held[i] {
            p + q
        } else {
            p * mass[i] + q * damping[i]
        };
    }
}

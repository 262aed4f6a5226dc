//! The matrix of an implicit step, kept factored.
//!
//! Every scheme that takes the elastic force at the end of its step solves with
//! `S = p M + q C + A` for the increment of the positions, with `p` and `q` its own. The factor is
//! made once and again only when a schedule changes mass, damping or stiffness.

use banded::{Operator, OperatorFactor};
use glam::DVec2;

use crate::stepper::{self, Mass, Seen};
use crate::{Fault, SchemeError, System, Touch, each};

/// How much stiffer than its own row of `S` a node in contact is made.
const FIRM: f64 = 1e4;

/// How often the set of nodes in contact is mended.
const ROUNDS: usize = 20;

/// `S = p M + q C + A`, factored.
#[derive(Debug, Clone)]
pub(crate) struct Solver {
    name: &'static str,
    need: Mass,
    /// `p` and `q`.
    weights: (f64, f64),
    matrix: Operator,
    factor: OperatorFactor,
    diagonal: Vec<f64>,
    /// The mass all nodes have, if it is the same.
    mass: Option<f64>,
    /// The same for the damping.
    damping: Option<f64>,
    /// Which nodes were in contact when `firm` was made.
    touching: Vec<bool>,
    pushed: Vec<bool>,
    firm: Option<OperatorFactor>,
    product: Vec<DVec2>,
    seen: Seen,
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
            mass: each::common(system.mass()),
            damping: each::common(system.damping()),
            touching: vec![false; n],
            pushed: vec![false; n],
            firm: None,
            product: vec![DVec2::ZERO; n],
            seen: Seen::of(system),
        })
    }

    /// Bring the system to time `t`, and the factor with it; true if it changed.
    pub(crate) fn advance(
        &mut self,
        system: &mut dyn System,
        t: f64,
        x: &[DVec2],
    ) -> Result<bool, Fault> {
        if !self.seen.left_behind(system, t, x) {
            return Ok(false);
        }
        self.rebuild(system, x)?;
        Ok(true)
    }

    /// Make the factor again from the system as it is.
    pub(crate) fn rebuild(&mut self, system: &dyn System, x: &[DVec2]) -> Result<(), Fault> {
        stepper::densities(self.name, system, self.need).map_err(|_| stepper::unsolvable(x))?;
        fill(&mut self.diagonal, system, self.weights);
        self.matrix = system.stiffness().shifted(1.0, &self.diagonal);
        self.factor = self.matrix.factor().map_err(|_| stepper::unsolvable(x))?;
        self.firm = None;
        self.mass = each::common(system.mass());
        self.damping = each::common(system.damping());
        self.seen = Seen::of(system);
        Ok(())
    }

    /// Use other `p` and `q` from now on.
    pub(crate) fn reweigh(
        &mut self,
        system: &dyn System,
        weights: (f64, f64),
        x: &[DVec2],
    ) -> Result<(), Fault> {
        self.weights = weights;
        self.rebuild(system, x)
    }

    /// The mass of each node, and the one they share, if they do.
    pub(crate) fn masses<'a>(&self, system: &'a dyn System) -> ([&'a [f64]; 1], Option<[f64; 1]>) {
        ([system.mass()], self.mass.map(|mass| [mass]))
    }

    /// Mass and damping of each node, and those they share, if they do.
    pub(crate) fn densities<'a>(
        &self,
        system: &'a dyn System,
    ) -> ([&'a [f64]; 2], Option<[f64; 2]>) {
        let common = self
            .mass
            .zip(self.damping)
            .map(|(mass, damping)| [mass, damping]);
        ([system.mass(), system.damping()], common)
    }

    /// `S`.
    pub(crate) fn matrix(&self) -> &Operator {
        &self.matrix
    }

    /// What resists a node's increment besides the stiffness: its entry of `p M + q C`.
    pub(crate) fn inertia(&self, system: &dyn System, node: usize) -> f64 {
        let (p, q) = self.weights;
        p * system.mass()[node] + q * system.damping()[node]
    }

    /// Turn the forces `b` into the increment `S⁻¹ b`; `b` must be zero at held nodes.
    pub(crate) fn solve(&self, b: &mut [DVec2]) {
        self.factor.solve(b);
    }

    /// Whether a node was in contact at the last [`follow`](Self::follow).
    pub(crate) fn touches(&self, node: usize) -> bool {
        self.pushed[node]
    }

    /// Let the other nodes follow those in contact.
    ///
    /// `shift` says how far each touched node is moved and becomes how far every node is: the step is
    /// solved again with the touched ones where they must be. A node that would have to be pulled
    /// there is let go, and leaves `touches`. Keeps its factor as long as the same nodes touch.
    pub(crate) fn follow(&mut self, touches: &mut Vec<Touch>, shift: &mut [DVec2]) {
        self.pushed.fill(false);
        let mut again = false;
        for touch in &*touches {
            again |= self.touching[touch.node];
            self.pushed[touch.node] = true;
        }
        // those that were pushed last time are the best guess
        if again {
            for (now, before) in self.pushed.iter_mut().zip(&self.touching) {
                *now &= before;
            }
        }
        for round in 0..ROUNDS {
            self.push(shift);
            let mut changed = false;
            for touch in &*touches {
                let i = touch.node;
                let ahead = (shift[i] - self.product[i]).dot(shift[i]);
                // short of where it must be: pushed if held there, still inside if not
                let push = ahead > 0.0;
                if push != self.pushed[i] && ahead.abs() > 1e-12 * shift[i].length_squared() {
                    changed = true;
                    self.pushed[i] = push;
                }
            }
            if !changed {
                break;
            }
            if round + 2 == ROUNDS {
                // no set satisfies all: hold every one of them
                touches
                    .iter()
                    .for_each(|touch| self.pushed[touch.node] = true);
            }
        }
        touches.retain(|touch| self.pushed[touch.node]);
        for (i, shift) in shift.iter_mut().enumerate() {
            if !self.pushed[i] {
                *shift = self.product[i];
            }
        }
    }

    /// (S + P) Δ = P shift, with P large at the pushed nodes and zero elsewhere.
    fn push(&mut self, shift: &[DVec2]) {
        let band = self.matrix.band().diagonal();
        if self.firm.is_none() || self.pushed != self.touching {
            self.touching.copy_from_slice(&self.pushed);
            for (i, extra) in self.diagonal.iter_mut().enumerate() {
                *extra = if self.touching[i] {
                    FIRM * band[i]
                } else {
                    0.0
                };
            }
            self.firm = self.matrix.shifted(1.0, &self.diagonal).factor().ok();
        }
        for (i, product) in self.product.iter_mut().enumerate() {
            *product = if self.touching[i] {
                FIRM * band[i] * shift[i]
            } else {
                DVec2::ZERO
            };
        }
        match &self.firm {
            Some(firm) => firm.solve(&mut self.product),
            // too ill-conditioned to solve: nobody follows
            None => self.product.fill(DVec2::ZERO),
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

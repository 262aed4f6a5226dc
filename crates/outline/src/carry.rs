//! Mass and motion, handed from old nodes to new ones without loss.
//!
//! Velocities are drawn as positions are, so that a node that moves with its curve before moves with it
//! after. Then one rigid motion is added to all, the smallest that sets right what the drawing lost of
//! momentum and spin. A body in rigid motion is still in rigid motion.

use crate::error::{check_length, check_points};
use crate::{OutlineError, Plan};
use glam::DVec2;

/// Which length of the curve belongs to each node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lengths<'a> {
    /// The same to each.
    Even(f64),
    /// One for each.
    Each(&'a [f64]),
}

impl Lengths<'_> {
    fn of(&self, i: usize) -> f64 {
        match self {
            Self::Even(length) => *length,
            Self::Each(lengths) => lengths[i],
        }
    }

    fn check(&self, count: usize) -> Result<(), OutlineError> {
        match self {
            Self::Even(length) => check_values("the length of a node", &[*length]),
            Self::Each(lengths) => {
                check_length("the lengths", count, lengths.len())?;
                check_values("the length of a node", lengths)
            }
        }
    }
}

/// A moving curve with mass. The mass of node i is `density[i]` times its length.
#[derive(Debug, Clone, Copy)]
pub struct Body<'a> {
    /// Where the nodes are. L.
    pub positions: &'a [DVec2],
    /// How they move. L T⁻¹.
    pub velocities: &'a [DVec2],
    /// Mass for each length. M.
    pub density: &'a [f64],
    /// The length each node stands for. L.
    pub lengths: Lengths<'a>,
}

/// The motion of a body as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Σ m. M L.
    pub mass: f64,
    /// Σ m x / Σ m. L.
    pub center: DVec2,
    /// Σ m v. M L² T⁻¹.
    pub momentum: DVec2,
    /// Angular momentum about the center, Σ m (x − c) × v. M L³ T⁻¹.
    pub spin: f64,
    /// Moment of inertia about the center, Σ m |x − c|². M L³.
    pub inertia: f64,
    /// ½ Σ m |v|². M L³ T⁻².
    pub kinetic: f64,
}

/// What becomes of the totals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Totals {
    /// Mass, momentum and spin stay what they were.
    #[default]
    Kept,
    /// Each node has what it was handed: for a piece of a body that was split.
    Handed,
}

/// A body on its new nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Carried {
    /// Where the new nodes are.
    pub positions: Vec<DVec2>,
    /// How they move.
    pub velocities: Vec<DVec2>,
    /// Their densities.
    pub density: Vec<f64>,
    /// The factor by which all densities had to be raised to keep the mass.
    pub mass_factor: f64,
    /// Kinetic energy after less before: to be booked. M L³ T⁻².
    pub kinetic_change: f64,
    /// How far the center of mass has jumped, since the new nodes are other points of the curve. L.
    pub center_shift: DVec2,
}

impl Body<'_> {
    /// The motion of the body as a whole.
    ///
    /// # Errors
    /// Lists of different lengths; points that are not finite; densities or lengths that are negative or
    /// not finite; no mass at all.
    pub fn motion(&self) -> Result<Motion, OutlineError> {
        let n = self.positions.len();
        check_points("position", self.positions)?;
        check_points("velocity", self.velocities)?;
        check_length("the velocities", n, self.velocities.len())?;
        check_length("the densities", n, self.density.len())?;
        check_values("a density", self.density)?;
        self.lengths.check(n)?;
        let motion = self.sum();
        if motion.mass > 0.0 && motion.mass.is_finite() {
            return Ok(motion);
        }
        let bound = "positive and finite";
        Err(OutlineError::BadNumber {
            name: "the whole mass",
            bound,
            value: motion.mass,
        })
    }

    fn mass(&self, i: usize) -> f64 {
        self.density[i] * self.lengths.of(i)
    }

    fn sum(&self) -> Motion {
        let nodes = || (0..self.positions.len()).map(|i| (self.mass(i), i));
        let origin = self.positions.first().copied().unwrap_or_default();
        let mass: f64 = nodes().map(|(m, _)| m).sum();
        let moment: DVec2 = nodes().map(|(m, i)| m * (self.positions[i] - origin)).sum();
        let center = origin + moment / mass;
        let momentum: DVec2 = nodes().map(|(m, i)| m * self.velocities[i]).sum();
        let (mut spin, mut inertia, mut kinetic) = (0.0, 0.0, 0.0);
        let mean = momentum / mass;
        for (m, i) in nodes() {
            let (arm, v) = (self.positions[i] - center, self.velocities[i]);
            // about the center the mean velocity has no spin; without it fewer digits are lost
            spin += m * arm.perp_dot(v - mean);
            inertia += m * arm.length_squared();
            kinetic += 0.5 * m * v.length_squared();
        }
        Motion {
            mass,
            center,
            momentum,
            spin,
            inertia,
            kinetic,
        }
    }
}

impl Plan {
    /// Hands a moving body to the new nodes; `lengths` belong to those.
    ///
    /// ```text
    /// x' = W x     v' = W v + a + ω ⟂(x' − c')     μ' = f · C μ
    /// a = (P − P') / M     ω = (L − L') / I'        f = M / M'
    /// ```
    ///
    /// with `W` the drawn weights, `C` the convex ones, and primes for sums over the new nodes before they
    /// are corrected. Mass, momentum and spin about the center are then the old ones up to rounding, and
    /// the correction is the rigid motion that costs least. With [`Totals::Handed`] there is none, and `f` is 1.
    ///
    /// # Errors
    /// As [`Body::motion`], before and after; lists that do not have the lengths of this plan.
    pub fn carry(
        &self,
        body: &Body<'_>,
        lengths: Lengths<'_>,
        totals: Totals,
    ) -> Result<Carried, OutlineError> {
        check_length("the positions", self.old_len(), body.positions.len())?;
        let before = body.motion()?;
        let positions = self.draw(body.positions)?;
        let mut velocities = self.draw(body.velocities)?;
        let mut density = self.pour(body.density)?;
        let new = |velocities: &[DVec2], density: &[f64]| {
            Body {
                positions: &positions,
                velocities,
                density,
                lengths,
            }
            .motion()
        };
        let mut after = new(&velocities, &density)?;
        let mut mass_factor = 1.0;
        if totals == Totals::Kept {
            mass_factor = before.mass / after.mass;
            density
                .iter_mut()
                .for_each(|density| *density *= mass_factor);
            // the second time takes away the rounding of the first
            for _ in 0..2 {
                after = new(&velocities, &density)?;
                let push = (before.momentum - after.momentum) / after.mass;
                let turn = (before.spin - after.spin) / after.inertia;
                let turn = if turn.is_finite() { turn } else { 0.0 }; // all nodes in one point
                for (v, x) in velocities.iter_mut().zip(&positions) {
                    *v += push + turn * (*x - after.center).perp();
                }
            }
            after = new(&velocities, &density)?;
        }
        Ok(Carried {
            kinetic_change: after.kinetic - before.kinetic,
            center_shift: after.center - before.center,
            positions,
            velocities,
            density,
            mass_factor,
        })
    }
}

fn check_values(name: &'static str, values: &[f64]) -> Result<(), OutlineError> {
    let fine = |value: &f64| (0.0..=f64::MAX).contains(value);
    values
        .iter()
        .find(|value| !fine(value))
        .map_or(Ok(()), |&value| {
            Err(OutlineError::BadNumber {
                name,
                bound: "finite and not negative",
                value,
            })
        })
}

#[cfg(test)]
mod tests;

//! Elastic terms above the second order (report Eq. 2.6 to 2.9).

use std::any::Any;
use std::sync::Arc;

use elastic::{Kernel, Topology};
use glam::DVec2;
use integrator::Fault;

use super::{Curve, Force};
use crate::{Body, SnakeError};

/// The elastic force of the derivatives of the third and higher orders of the deformation.
///
/// ```text
/// f = −Σₘ Dᵐᵀ ωₘ Dᵐ (x − r) / h²ᵐ,   m = 3 … p
/// ```
///
/// A rigid motion of a curve with free ends, or of a closed one, costs nothing; no body frame is needed. Its energy is
/// exact. It is a force and no part of the matrix, so its stiffness counts in the step limit of every scheme:
/// [`Kernel::bound`], which even closed curves reach. O(n p) a step.
#[derive(Debug, Clone)]
pub struct Higher {
    kernel: Kernel,
    topology: Topology,
    rest: Arc<[DVec2]>,
    spacing: f64,
    e: Vec<DVec2>,
    own: Vec<DVec2>,
}

impl Higher {
    /// The orders above the second of a body; `weights` are those of the orders 3, 4 and on. M L²ᵐ T⁻².
    ///
    /// # Errors
    ///
    /// What [`Kernel::validate`] refuses; anchored ends and a rest shape that turns, of which these orders know nothing.
    pub fn new(body: &Body, weights: &[f64]) -> Result<Self, SnakeError> {
        let kernel = Kernel::uniform(&[&[0.0; 3], weights].concat());
        kernel.validate(body.topology, body.spacing, body.len())?;
        if let Topology::Open { head, tail } = body.topology
            && (head == elastic::End::Anchored || tail == elastic::End::Anchored)
        {
            return Err(SnakeError::NotOfHigherOrder {
                needed: "ends that are free or pinned",
            });
        }
        if body.frame.turn != crate::Turn::None {
            return Err(SnakeError::NotOfHigherOrder {
                needed: "a frame that does not turn",
            });
        }
        Ok(Self {
            kernel,
            topology: body.topology,
            rest: body.rest.as_slice().into(),
            spacing: body.spacing,
            e: Vec::new(),
            own: Vec::new(),
        })
    }
}

impl Force for Higher {
    fn name(&self) -> &'static str {
        "higher"
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        self.e.clear();
        self.e
            .extend(curve.x.iter().zip(&*self.rest).map(|(&x, &r)| x - r));
        self.own.resize(curve.x.len(), DVec2::ZERO);
        self.kernel
            .force(&self.e, self.topology, self.spacing, &mut self.own);
        for (force, &own) in force.iter_mut().zip(&self.own) {
            *force += own;
        }
        Ok(())
    }

    fn energy(&self, curve: &Curve<'_>) -> Option<f64> {
        let e: Vec<DVec2> = curve
            .x
            .iter()
            .zip(&*self.rest)
            .map(|(&x, &r)| x - r)
            .collect();
        Some(
            self.kernel
                .energy(&e, self.topology, self.spacing)
                .iter()
                .sum(),
        )
    }

    fn stiffness(&self) -> f64 {
        self.kernel.bound(self.spacing)
    }

    fn couples(&self) -> bool {
        true
    }

    fn validate(&self, n: usize) -> Result<(), SnakeError> {
        if n == self.rest.len() {
            Ok(())
        } else {
            Err(SnakeError::OtherLength {
                needed: self.rest.len(),
                got: n,
            })
        }
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

#[cfg(test)]
mod tests {
    use elastic::{End, Material};
    use integrator::{Scheme, System};

    use super::*;
    use crate::{Certificate, Frame, Snake, World};

    fn body(weights: [f64; 3]) -> Body {
        let nodes = elastic::circle(DVec2::ZERO, 10.0, 40);
        let [tether, tension, rigidity] = weights;
        Body::of(&nodes, Topology::Closed, 1.0)
            .unwrap()
            .with_material(Material::uniform(tether, tension, rigidity))
    }

    #[test]
    fn the_step_limit_is_that_of_the_stiffest_wave_of_all_orders() {
        let body = body([0.1, 2.0, 3.0]);
        let higher = Higher::new(&body, &[4.0, 5.0]).unwrap();
        let h = body.spacing;
        let steep = 4.0 / (h * h);
        let lambda =
            0.1 + 2.0 * steep + 3.0 * steep.powi(2) + 4.0 * steep.powi(3) + 5.0 * steep.powi(4);
        let snake = Snake::new(body, World::default().with(higher)).unwrap();
        let limit = Scheme::Leapfrog.step_limit(&snake).unwrap();
        // forty nodes are an even number, whose zigzag is that wave
        assert!((limit / (2.0 / lambda.sqrt()) - 1.0).abs() < 1e-9);
        let certificate = Certificate::of(&snake, None);
        let said = certificate
            .steps
            .iter()
            .find(|(scheme, _)| *scheme == Scheme::Leapfrog);
        assert!((said.unwrap().1.unwrap() / limit - 1.0).abs() < 1e-9);
        assert!(certificate.contact.abs() < 1e-300 && snake.contact_stiffness().0 > 1.0);
    }

    #[test]
    fn its_force_is_minus_the_gradient_of_its_energy_and_a_shift_costs_nothing() {
        let body = body([0.0; 3]);
        let mut higher = Higher::new(&body, &[0.3, 0.2]).unwrap();
        let mut x: Vec<DVec2> = body
            .rest
            .iter()
            .map(|&r| r + DVec2::new(3.0, -2.0))
            .collect();
        let mut force = vec![DVec2::ZERO; x.len()];
        fn seen(x: &[DVec2]) -> Curve<'_> {
            Curve {
                t: 0.0,
                x,
                v: &[],
                mass: &[],
                closed: true,
                spacing: 1.0,
            }
        }
        higher.add(&seen(&x), &mut force).unwrap();
        assert!(force.iter().all(|f| f.length() < 1e-11));
        x[7] += DVec2::new(0.4, 0.1);
        force.fill(DVec2::ZERO);
        higher.add(&seen(&x), &mut force).unwrap();
        let mut at = |by: f64| {
            x[8].x += by;
            let energy = higher.energy(&seen(&x)).unwrap();
            x[8].x -= by;
            energy
        };
        // energies of order 10, a quadratic: differences are exact but for rounding over 1e-3
        let slope = (at(1e-3) - at(-1e-3)) / 2e-3;
        assert!((body.spacing * force[8].x + slope).abs() < 1e-9 * slope.abs().max(1.0));
    }

    #[test]
    fn what_has_no_higher_orders_is_refused() {
        let mut turning = body([1.0; 3]);
        turning.frame = Frame::turning();
        assert!(
            Higher::new(&turning, &[1.0])
                .unwrap_err()
                .to_string()
                .contains("does not turn")
        );
        let strip = elastic::segment(DVec2::ZERO, DVec2::X, 12);
        let strip = Body::of(&strip, Topology::open(End::Anchored), 1.0).unwrap();
        assert!(Higher::new(&strip, &[1.0]).is_err());
        assert!(
            Higher::new(&body([1.0; 3]), &[1.0; 5])
                .unwrap_err()
                .to_string()
                .contains("0 to at most 6")
        );
    }
}

//! A stretch of the curve held where it is.

use std::any::Any;

use glam::{DMat2, DVec2};
use integrator::Fault;
use outline::Plan;

use super::{Curve, Force, Pull};
use crate::SnakeError;
use crate::error::{finite_at_least, place};

/// Nodes held by a spring each at the places they had: the soft form of
/// [`Snake::hold`](crate::Snake::hold).
///
/// ```text
/// f[i] = k (p[i] − x[i]) − c v[i]                          E = ½ h Σ k |x[i] − p[i]|²
/// ```
///
/// k is a density, M T⁻², as the tether is, and c one too, M T⁻¹. There is an energy where c is 0; otherwise the work is booked.
#[derive(Debug, Clone, PartialEq)]
pub struct Freeze {
    places: Vec<(usize, DVec2)>,
    stiffness: f64,
    damping: f64,
}

impl Freeze {
    /// Hold the nodes of `stretch` where they are among `nodes`.
    ///
    /// # Errors
    ///
    /// Refused: a node that there is not.
    pub fn new(
        nodes: &[DVec2],
        stretch: impl IntoIterator<Item = usize>,
        stiffness: f64,
    ) -> Result<Self, SnakeError> {
        let place = |node: usize| {
            let missing = SnakeError::NoSuchNode {
                node,
                nodes: nodes.len(),
            };
            nodes.get(node).map(|p| (node, *p)).ok_or(missing)
        };
        Ok(Self {
            places: stretch.into_iter().map(place).collect::<Result<_, _>>()?,
            stiffness,
            damping: 0.0,
        })
    }

    /// The same with a damper at each node. M T⁻¹.
    #[must_use]
    pub const fn with_damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// The nodes it holds.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        self.places.iter().map(|&(node, _)| node)
    }
}

impl Force for Freeze {
    fn name(&self) -> &'static str {
        "freeze"
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        for &(i, place) in &self.places {
            force[i] += self.stiffness * (place - curve.x[i]) - self.damping * curve.velocity(i);
        }
        Ok(())
    }

    fn add_slope(&mut self, _curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        for &(i, _) in &self.places {
            slope[i] -= DMat2::from_diagonal(DVec2::splat(self.stiffness));
        }
        true
    }

    fn energy(&self, curve: &Curve<'_>) -> Option<f64> {
        let mut squares = 0.0;
        for &(i, place) in &self.places {
            squares += curve.x[i].distance_squared(place);
        }
        (self.damping == 0.0).then_some(0.5 * curve.spacing * self.stiffness * squares)
    }

    fn pull(&self, _spacing: f64, _curve: Option<&Curve<'_>>) -> Pull {
        Pull {
            stiffness: self.stiffness,
            damping: self.damping,
        }
    }

    fn validate(&self, n: usize) -> Result<(), SnakeError> {
        for &(node, p) in &self.places {
            if node >= n {
                return Err(SnakeError::NoSuchNode { node, nodes: n });
            }
            place("a frozen node", p)?;
        }
        finite_at_least("a freeze's stiffness", 0.0, "at least 0", self.stiffness)?;
        finite_at_least("a freeze's damping", 0.0, "at least 0", self.damping)?;
        Ok(())
    }

    /// To the new nodes that are mostly of frozen ones, each at the place its own were frozen at.
    fn carry(&mut self, plan: &Plan) {
        let mut frozen = vec![None; plan.old_len()];
        for &(node, place) in &self.places {
            if let Some(frozen) = frozen.get_mut(node) {
                *frozen = Some(place);
            }
        }
        self.places.clear();
        for node in 0..plan.len() {
            let (mut share, mut sum) = (0.0, DVec2::ZERO);
            for &(from, weight) in plan.convex(node) {
                if let Some(place) = frozen[from as usize] {
                    share += weight;
                    sum += weight * place;
                }
            }
            if share > 0.5 {
                self.places.push((node, sum / share));
            }
        }
    }

    fn depends_on_velocity(&self) -> bool {
        self.damping > 0.0
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

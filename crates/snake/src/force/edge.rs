//! Edges of one polarity, seen along the normal of the curve.

use std::any::Any;
use std::sync::Arc;

use field::{ForceField, SignedEdge};
use glam::{DMat2, DVec2};
use integrator::Fault;

use super::{Curve, Force, Pull, nowhere, push_back};

/// The edges of a picture that are of the right polarity for the curve's own normal.
///
/// ```text
/// n = the outward normal at node i (of an open curve: (t_y, −t_x)),   f[i] = SignedEdge::at(x[i], n)
/// ```
///
/// At an open end n is that of the last edge. No energy: that of [`SignedEdge::energy`] depends on n too, and so on
/// the neighbors, on whom it would act; f is its gradient with the normals held fast. The work is booked.
#[derive(Debug, Clone)]
pub struct SignedEdgeForce {
    edge: Arc<SignedEdge>,
}

/// How far apart the places of a difference are. Between them the slope of a bicubic gradient is a line or two.
const STEP: f64 = 1e-3;

impl SignedEdgeForce {
    /// The force of `edge`; shared, since a picture is in it.
    #[must_use]
    pub const fn new(edge: Arc<SignedEdge>) -> Self {
        Self { edge }
    }

    /// The edges.
    #[must_use]
    pub const fn edge(&self) -> &Arc<SignedEdge> {
        &self.edge
    }

    /// The slope at node `i` at a fixed normal, by central differences.
    fn slope(&self, curve: &Curve<'_>, turn: f64, i: usize) -> DMat2 {
        let (x, n) = (curve.x[i], turn * curve.normal(i).normalize_or_zero());
        let along = |axis: DVec2| {
            (self.edge.at(x + STEP * axis, n) - self.edge.at(x - STEP * axis, n)) / (2.0 * STEP)
        };
        DMat2::from_cols(along(DVec2::X), along(DVec2::Y))
    }
}

impl Force for SignedEdgeForce {
    fn name(&self) -> &'static str {
        "signed-edge"
    }

    /// Faults: [`FaultKind::NotFinite`](integrator::FaultKind::NotFinite) for a node that is no place.
    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        if !curve.x.iter().sum::<DVec2>().is_finite()
            && let Some(fault) = nowhere(curve.x)
        {
            return Err(fault);
        }
        let turn = curve.turn();
        for (i, (f, &x)) in force.iter_mut().zip(curve.x).enumerate() {
            *f += self.edge.at(x, turn * curve.normal(i).normalize_or_zero());
        }
        Ok(())
    }

    /// At fixed normals; at a kink of the polarity, half of it.
    fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        let turn = curve.turn();
        for (i, slope) in slope.iter_mut().enumerate() {
            *slope += self.slope(curve, turn, i);
        }
        true
    }

    /// Anywhere: three times the largest second differences of the picture's gradient, which is as much as a cubic
    /// through them bends. O(pixels).
    fn pull(&self, _spacing: f64, curve: Option<&Curve<'_>>) -> Pull {
        let stiffness = match curve {
            Some(curve) => {
                let turn = curve.turn();
                let slopes = (0..curve.x.len()).map(|i| self.slope(curve, turn, i));
                slopes.map(push_back).fold(0.0, f64::max)
            }
            None => 3.0 * self.edge.gain() * most_bent(self.edge.gradient()),
        };
        Pull {
            stiffness,
            damping: 0.0,
        }
    }

    fn depends_on_velocity(&self) -> bool {
        false
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// The largest size of the second differences of both components of a field, in any direction.
fn most_bent(field: &ForceField) -> f64 {
    let at = |column: usize, row: usize| field.pixel(column, row).unwrap_or(DVec2::ZERO);
    let (w, h) = (field.width(), field.height());
    let mut most = 0.0_f64;
    for row in 0..h {
        for column in 0..w {
            let here = at(column, row);
            let mut squares = 0.0;
            if column > 0 && column + 1 < w {
                let bend = at(column - 1, row) + at(column + 1, row) - 2.0 * here;
                squares += bend.length_squared();
            }
            if row > 0 && row + 1 < h {
                let bend = at(column, row - 1) + at(column, row + 1) - 2.0 * here;
                squares += bend.length_squared();
            }
            if column + 1 < w && row + 1 < h {
                let [right, below] = [at(column + 1, row), at(column, row + 1)];
                let twist = at(column + 1, row + 1) + here - right - below;
                squares += 2.0 * twist.length_squared();
            }
            most = most.max(squares);
        }
    }
    most.sqrt()
}

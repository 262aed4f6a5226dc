//! What lies inside a curve and what outside, as a force.

use std::any::Any;
use std::sync::Arc;

use field::{Region, RegionScratch};
use glam::{DMat2, DVec2};
use integrator::Fault;

use super::{Curve, Force, Pull, nowhere};
use crate::SnakeError;

/// The push of a [`Region`] along the outward normals of a closed curve.
///
/// ```text
/// h f[i] = push(x[i]) N[i],   N[i] = ½ (x[i+1] − x[i−1]) turned outwards
/// ```
///
/// The push is a force per length of the curve as it is now. No energy: the region's own is that of the whole polygon, and
/// asking at nodes alone is its gradient only up to the square of the spacing; the work is booked instead.
///
/// Refused for open curves.
#[derive(Debug, Clone)]
pub struct RegionForce {
    region: Arc<dyn Region>,
    scratch: RegionScratch,
    push: Vec<f64>,
    shifted: Vec<DVec2>,
    other: Vec<f64>,
}

impl RegionForce {
    /// The force of `region`; shared, since a picture is in it.
    #[must_use]
    pub fn new(region: Arc<dyn Region>) -> Self {
        Self {
            region,
            scratch: RegionScratch::default(),
            push: Vec::new(),
            shifted: Vec::new(),
            other: Vec::new(),
        }
    }

    /// The region.
    #[must_use]
    pub fn region(&self) -> &Arc<dyn Region> {
        &self.region
    }

    /// How fast the push grows outwards, at each node: in `push`, from half a pixel inside to half a pixel outside.
    fn growth(&mut self, curve: &Curve<'_>) {
        let n = curve.x.len();
        self.shifted.resize(n, DVec2::ZERO);
        self.push.resize(n, 0.0);
        self.other.resize(n, 0.0);
        let turn = curve.turn();
        for (side, push) in [(-0.5, &mut self.other), (0.5, &mut self.push)] {
            for (i, x) in self.shifted.iter_mut().enumerate() {
                *x = curve.x[i] + side * turn * curve.normal(i).normalize_or_zero();
            }
            self.region
                .push_into(&self.shifted, &mut self.scratch, push);
        }
        for (push, inside) in self.push.iter_mut().zip(&self.other) {
            *push -= inside;
        }
    }
}

impl Force for RegionForce {
    fn name(&self) -> &'static str {
        "region"
    }

    /// Faults: [`FaultKind::NotFinite`](integrator::FaultKind::NotFinite) for a node that is no place.
    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        if !curve.x.iter().sum::<DVec2>().is_finite()
            && let Some(fault) = nowhere(curve.x)
        {
            return Err(fault);
        }
        self.push.resize(curve.x.len(), 0.0);
        self.region
            .push_into(curve.x, &mut self.scratch, &mut self.push);
        let density = curve.turn() / curve.spacing;
        for (i, (f, &push)) in force.iter_mut().zip(&self.push).enumerate() {
            *f += (density * push) * curve.normal(i);
        }
        Ok(())
    }

    /// The push's growth across a pixel, means and all, along the normal; what the curve's turning changes is left out.
    fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        self.growth(curve);
        for (i, (slope, &growth)) in slope.iter_mut().zip(&self.push).enumerate() {
            let normal = curve.normal(i);
            let unit = normal.normalize_or_zero();
            let pushed = unit * (growth * normal.length() / curve.spacing);
            *slope += DMat2::from_cols(pushed * unit.x, pushed * unit.y);
        }
        true
    }

    /// Estimated over a pixel at `curve`, the coupling of its neighbors by their normals added. Not known without a curve: 0.
    fn pull(&self, spacing: f64, curve: Option<&Curve<'_>>) -> Pull {
        let Some(curve) = curve else {
            return Pull::default();
        };
        let mut own = self.clone();
        own.growth(curve);
        let mut stiffness = 0.0_f64;
        for (i, growth) in own.push.iter().enumerate() {
            stiffness = stiffness.max(-growth * curve.normal(i).length() / spacing);
        }
        own.region
            .push_into(curve.x, &mut own.scratch, &mut own.push);
        let most = own.push.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        Pull {
            stiffness: stiffness + most / spacing,
            damping: 0.0,
        }
    }

    fn couples(&self) -> bool {
        true
    }

    fn needs_closed(&self) -> bool {
        true
    }

    fn validate(&self, _n: usize) -> Result<(), SnakeError> {
        Ok(()) // the picture was checked where it was prepared
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

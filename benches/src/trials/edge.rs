//! A ring on an edge, with the edge as a formula: smooth, so that orders can be seen.

use glam::{DMat2, DVec2};
use integrator::problems::Springs;
use integrator::{Fault, System, Wrapped};
use sandbox::prelude::*;

/// A round edge beside the middle of the ring: place, radius, steepness and reach.
const MIDDLE: DVec2 = DVec2::new(0.8, -0.5);
const RADIUS: f64 = 12.0;
const STEEP: f64 = 1.5;
const REACH: f64 = 2.0;

/// A ring of springs, pulled to a circle: `F = −a d exp(−d²/2s²) n`, `d` the distance from it.
#[derive(Debug)]
pub(super) struct EdgeRing {
    ring: Springs,
}

impl EdgeRing {
    pub(super) fn new(ring: Springs) -> Self {
        Self { ring }
    }
}

/// Force at a point, and its slope.
fn pull(p: DVec2) -> (DVec2, DMat2) {
    let out = p - MIDDLE;
    let r = out.length();
    let n = out / r;
    let d = r - RADIUS;
    let fade = (-0.5 * (d / REACH).powi(2)).exp();
    let force = -STEEP * d * fade;
    let slope = -STEEP * fade * (1.0 - (d / REACH).powi(2));
    let along = DMat2::from_cols(n * n.x, n * n.y);
    (
        force * n,
        slope * along + force / r * (DMat2::IDENTITY - along),
    )
}

impl Wrapped for EdgeRing {
    fn inner(&self) -> &dyn System {
        &self.ring
    }

    fn inner_mut(&mut self) -> &mut dyn System {
        &mut self.ring
    }

    fn external(
        &mut self,
        _t: f64,
        x: &[DVec2],
        _v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        for (f, &p) in force.iter_mut().zip(x) {
            *f += pull(p).0;
        }
        Ok(())
    }

    fn external_is_constant(&self) -> bool {
        false
    }

    fn external_slope(&mut self, _t: f64, x: &[DVec2], slope: &mut [DMat2]) -> bool {
        for (s, &p) in slope.iter_mut().zip(x) {
            *s = pull(p).1;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_the_edge_is_that_of_its_force() {
        for p in [
            DVec2::new(9.0, 3.0),
            DVec2::new(-4.0, 10.0),
            DVec2::new(0.0, -12.5),
        ] {
            let step = 1e-6;
            for (column, axis) in [(0, DVec2::X), (1, DVec2::Y)] {
                let change = (pull(p + step * axis).0 - pull(p - step * axis).0) / (2.0 * step);
                assert!((change - pull(p).1.col(column)).length() < 1e-8);
            }
        }
    }
}

//! A push away from a point, of finite reach.

use std::any::Any;

use glam::{DMat2, DVec2};
use integrator::Fault;

use super::{Curve, Force, Path, Pull};
use crate::SnakeError;
use crate::error::finite_at_least;

/// A smooth push away from a point, of finite reach: the volcano of \[kass88\] without its crater.
///
/// ```text
/// q = x − center,   u = max(0, 1 − |q|²/R²),   U = a R² u³ / 6
/// f = a u² q                                                E = h Σ U
/// ```
///
/// a is chosen so that the push is at most `strength`, M L T⁻², which it is at `|q| = R/√5`. Its slope is
/// continuous everywhere. A negative strength attracts. Energy while the center stays; the work of one that moves is booked.
#[derive(Debug, Clone, PartialEq)]
pub struct Repulsor {
    center: Path,
    reach: f64,
    strength: f64,
}

impl Repulsor {
    /// A push of at most `strength` away from `center`, felt nearer than `reach`.
    #[must_use]
    pub fn new(center: impl Into<Path>, reach: f64, strength: f64) -> Self {
        Self {
            center: center.into(),
            reach,
            strength,
        }
    }

    /// Where it is.
    #[must_use]
    pub const fn center(&self) -> &Path {
        &self.center
    }

    /// a: (25 √5 / 16) strength / R, since u² |q| / R is 16 / (25 √5) at its largest. M T⁻².
    fn scale(&self) -> f64 {
        25.0 * 5.0_f64.sqrt() / 16.0 * self.strength / self.reach
    }

    /// u, at least 0.
    fn depth(&self, q: DVec2) -> f64 {
        (1.0 - q.length_squared() / (self.reach * self.reach)).max(0.0)
    }
}

impl Force for Repulsor {
    fn name(&self) -> &'static str {
        "repulsor"
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        let (scale, (center, _)) = (self.scale(), self.center.at(curve.t));
        for (f, &x) in force.iter_mut().zip(curve.x) {
            let u = self.depth(x - center);
            *f += (scale * u * u) * (x - center);
        }
        Ok(())
    }

    fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        let (scale, (center, _)) = (self.scale(), self.center.at(curve.t));
        for (slope, &x) in slope.iter_mut().zip(curve.x) {
            let q = x - center;
            let u = self.depth(q);
            let turned = q * (-4.0 * u / (self.reach * self.reach));
            *slope +=
                (DMat2::IDENTITY * (u * u) + DMat2::from_cols(turned * q.x, turned * q.y)) * scale;
        }
        true
    }

    fn energy(&self, curve: &Curve<'_>) -> Option<f64> {
        let (center, _) = self.center.at(curve.t);
        let depth = curve.x.iter().map(|&x| self.depth(x - center));
        let cubes: f64 = depth.map(|u| u * u * u).sum();
        let most = self.scale() * self.reach * self.reach / 6.0;
        let still = self.center.is_still();
        still.then_some(curve.spacing * most * cubes)
    }

    /// Along q the slope is a u (5u − 4), across it a u²: from −4a/5 to a.
    fn pull(&self, _spacing: f64, _curve: Option<&Curve<'_>>) -> Pull {
        let scale = self.scale();
        Pull {
            stiffness: (0.8 * scale).max(-scale),
            damping: 0.0,
        }
    }

    fn validate(&self, _n: usize) -> Result<(), SnakeError> {
        finite_at_least(
            "a repulsor's reach",
            f64::MIN_POSITIVE,
            "above 0",
            self.reach,
        )?;
        finite_at_least("a repulsor's strength", f64::MIN, "a number", self.strength)?;
        self.center.validate("a repulsor's center")
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

//! Pressure: the snake as a balloon (report §5.4, Eq. 5.6), after [cohen91].

use std::any::Any;
use std::f64::consts::PI;

use glam::{DMat2, DVec2};
use integrator::Fault;

use super::{Curve, Force, Pull};
use crate::SnakeError;
use crate::error::finite_at_least;

/// A gas is squeezed no harder below this share of the area it was given with.
const LIQUID: f64 = 1e-3;

/// A pressure inside a closed curve, along its outward normals (report Eq. 5.6).
///
/// ```text
/// h f[i] = p N[i],   N[i] = ∂A/∂x[i] = ½ (x[i+1] − x[i−1]) turned outwards,   p = −dE/dA
///
/// constant   p = k                        E = −k A
/// gas        p = k A₀ / A                 E = −k A₀ ln(A / A₀)
/// area       p = k (1 − A / A₀)           E = ½ k (A − A₀)² / A₀
/// ```
///
/// k is a force per length of the curve as it is now, M L T⁻²; the report's unit normal times that length is N to second order,
/// and N makes the force the exact gradient of E. The sum over all nodes is 0: it moves nobody along.
///
/// *Which way is out* is settled by the sign of the area (D78) of the curve that a run begins with
/// ([`Force::settle`]), or else of the
/// first that the force acts on, and remembered; asking for an energy or a slope settles nothing. A
/// is the area with that sign, and a curve turned inside out has less than none. A constant
/// pressure below 0 ends at
/// A = 0, a gas has p = 1000 k below A₀/1000 and pushes the curve back from negative areas, and so does an area; none
/// is ever NaN for nodes that are places. A factor over time (a balloon that fades) is the schedule of [`Acting`](crate::Acting).
///
/// Refused for open curves.
///
/// \[cohen91\]
#[derive(Debug, Clone)]
pub struct Pressure {
    law: Law,
    k: f64,
    judge: Option<Box<dyn Force>>,
    met: Option<Met>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    Constant,
    Gas { area: f64 },
    Area { area: f64 },
}

/// What was settled where the curve was first met.
#[derive(Debug, Clone, Copy)]
struct Met {
    /// Sign of the area.
    turn: f64,
    /// Sign of an automatic pressure.
    sign: f64,
}

impl Pressure {
    const fn of(law: Law, k: f64) -> Self {
        Self {
            law,
            k,
            judge: None,
            met: None,
        }
    }

    /// The same pressure `k` always: above 0 inflates, below 0 deflates. M L T⁻².
    #[must_use]
    pub const fn constant(k: f64) -> Self {
        Self::of(Law::Constant, k)
    }

    /// A pressure of size `k` whose sign `judge` finds where the curve is first met: it inflates unless the
    /// judge pulls inwards, averaged over the length of the curve.
    ///
    /// ```text
    /// sign of Σ F(x[i]) · N[i], and + where that is 0
    /// ```
    ///
    /// The judge is any force and acts only in this question. A picture's edges answer it within their reach alone;
    /// what compares inside and outside ([`RegionForce`](crate::RegionForce)) answers from anywhere. A judge that has no force at a node
    /// (a fault) is taken as one that does not pull.
    #[must_use]
    pub fn automatic(k: f64, judge: impl Force + 'static) -> Self {
        Self {
            judge: Some(Box::new(judge)),
            ..Self::constant(k)
        }
    }

    /// A gas at constant temperature: pressure `k` at an area of `area`, and p A the same always.
    #[must_use]
    pub const fn gas(k: f64, area: f64) -> Self {
        Self::of(Law::Gas { area }, k)
    }

    /// A spring towards an area: pressure `k` where nothing is enclosed, none at `area`. The shape neither caves in nor
    /// blows up.
    #[must_use]
    pub const fn area(k: f64, area: f64) -> Self {
        Self::of(Law::Area { area }, k)
    }

    /// The pressure at an area, as [`Pressure::automatic`] left the sign. M L T⁻².
    #[must_use]
    pub fn at(&self, area: f64) -> f64 {
        self.by_sign(area, self.met.map_or(1.0, |met| met.sign))
    }

    fn by_sign(&self, area: f64, sign: f64) -> f64 {
        let k = self.k * sign;
        match self.law {
            Law::Constant if k < 0.0 && area <= 0.0 => 0.0,
            Law::Constant => k,
            Law::Gas { area: full } => k * full / area.max(LIQUID * full),
            Law::Area { area: full } => k * (1.0 - area / full),
        }
    }

    /// dp/dA.
    fn slope(&self, area: f64) -> f64 {
        match self.law {
            Law::Gas { area: full } if area > LIQUID * full => -self.k * full / (area * area),
            Law::Area { area: full } => -self.k / full,
            Law::Constant | Law::Gas { .. } => 0.0,
        }
    }

    /// What is settled, or would be by this curve.
    fn meet(&self, curve: &Curve<'_>) -> Met {
        self.met.unwrap_or_else(|| {
            let turn = curve.turn();
            let mut pull = 0.0;
            if let Some(judge) = &self.judge {
                let mut felt = vec![DVec2::ZERO; curve.x.len()];
                if judge.boxed().add(curve, &mut felt).is_ok() {
                    pull = turn
                        * (0..felt.len())
                            .map(|i| felt[i].dot(curve.normal(i)))
                            .sum::<f64>();
                }
            }
            let sign = if pull < 0.0 { -1.0 } else { 1.0 };
            Met { turn, sign }
        })
    }

    /// The area inside a curve, and what is settled.
    fn inside(&self, curve: &Curve<'_>) -> (f64, Met) {
        let met = self.meet(curve);
        (met.turn * elastic::signed_area(curve.x), met)
    }
}

impl Force for Pressure {
    fn name(&self) -> &'static str {
        match self.law {
            Law::Constant => "pressure",
            Law::Gas { .. } => "gas",
            Law::Area { .. } => "area",
        }
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        self.settle(curve);
        let (area, met) = self.inside(curve);
        let density = met.turn * self.at(area) / curve.spacing;
        for (i, f) in force.iter_mut().enumerate() {
            *f += density * curve.normal(i);
        }
        Ok(())
    }

    fn settle(&mut self, curve: &Curve<'_>) {
        self.met = Some(self.meet(curve));
    }

    /// `dp/dA N Nᵀ / h` of each node: a constant pressure does not change with a node of its own.
    fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        let density = self.slope(self.inside(curve).0) / curve.spacing;
        if density != 0.0 {
            for (i, slope) in slope.iter_mut().enumerate() {
                let normal = curve.normal(i);
                let pushed = density * normal;
                *slope += DMat2::from_cols(pushed * normal.x, pushed * normal.y);
            }
        }
        true
    }

    fn energy(&self, curve: &Curve<'_>) -> Option<f64> {
        let (area, met) = self.inside(curve);
        Some(match self.law {
            Law::Constant => match self.by_sign(1.0, met.sign) {
                p if p < 0.0 => -p * area.max(0.0),
                p => -p * area,
            },
            Law::Gas { area: full } => {
                let least = LIQUID * full;
                let below = (area - least).min(0.0) / least;
                -self.k * full * ((area.max(least) / full).ln() + below)
            }
            Law::Area { area: full } => 0.5 * self.k * (area - full) * (area - full) / full,
        })
    }

    /// ```text
    /// |p| / h + |dp/dA| Σ |N|² / h
    /// ```
    ///
    /// Without a curve that of a circle of the given area, at rest; of an area, also with nothing inside.
    fn pull(&self, spacing: f64, curve: Option<&Curve<'_>>) -> Pull {
        let (most, slope, squares) = match (curve, self.law) {
            (Some(curve), _) => {
                let (area, met) = self.inside(curve);
                let normals = (0..curve.x.len()).map(|i| curve.normal(i).length_squared());
                (
                    self.by_sign(area, met.sign),
                    self.slope(area),
                    normals.sum(),
                )
            }
            (None, Law::Constant) => (self.k, 0.0, 0.0),
            (None, Law::Gas { area } | Law::Area { area }) => {
                (self.k, self.slope(area), spacing * 2.0 * (PI * area).sqrt())
            }
        };
        Pull {
            stiffness: (most.abs() + slope.abs() * squares) / spacing,
            damping: 0.0,
        }
    }

    fn couples(&self) -> bool {
        true
    }

    fn needs_closed(&self) -> bool {
        true
    }

    fn validate(&self, n: usize) -> Result<(), SnakeError> {
        match self.law {
            Law::Constant => finite_at_least("a pressure", f64::MIN, "a number", self.k)?,
            Law::Gas { area } | Law::Area { area } => {
                finite_at_least("a pressure's area", f64::MIN_POSITIVE, "above 0", area)?;
                let what = "the pressure of a gas or an area";
                finite_at_least(what, 0.0, "at least 0", self.k)?
            }
        };
        self.judge
            .as_ref()
            .map_or(Ok(()), |judge| judge.validate(n))
    }

    fn carry(&mut self, plan: &outline::Plan) {
        if let Some(judge) = &mut self.judge {
            judge.carry(plan);
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

//! A force that turns about a place.

use std::any::Any;

use glam::{DMat2, DVec2};
use integrator::Fault;

use super::{Curve, Force, Pull};
use crate::SnakeError;
use crate::error::{finite_at_least, place};

/// Another force in axes that turn: a picture that rotates under the snake.
///
/// ```text
/// f(t, x) = R f₀(t, c + Rᵀ (x − c)),   R = R(Ω t)
/// ```
///
/// Its work is booked, for what turns has no energy. A step costs two rotations a node more than the force itself.
#[derive(Debug, Clone)]
pub struct Turned {
    force: Box<dyn Force>,
    about: DVec2,
    rate: f64,
    x: Vec<DVec2>,
    v: Vec<DVec2>,
    own: Vec<DVec2>,
    slopes: Vec<DMat2>,
}

impl Turned {
    /// That force turning about `about` by `rate` radians per unit of time, from +x towards +y; at time 0 it is as it was.
    #[must_use]
    pub const fn new(force: Box<dyn Force>, about: DVec2, rate: f64) -> Self {
        Self {
            force,
            about,
            rate,
            x: Vec::new(),
            v: Vec::new(),
            own: Vec::new(),
            slopes: Vec::new(),
        }
    }

    /// How far it has turned, as the unit vector that x̂ is turned to.
    fn rotation(&self, t: f64) -> DVec2 {
        DVec2::from_angle(self.rate * t)
    }

    /// The curve in axes that turn with the force.
    fn look(&mut self, curve: &Curve<'_>) -> DVec2 {
        let turn = self.rotation(curve.t);
        let back = DVec2::new(turn.x, -turn.y);
        let about = self.about;
        self.x.clear();
        let seen = curve.x.iter().map(|&x| about + back.rotate(x - about));
        self.x.extend(seen);
        self.v.clear();
        for (&x, &v) in curve.x.iter().zip(curve.v) {
            let drift = self.rate * (x - about).perp();
            self.v.push(back.rotate(v - drift));
        }
        turn
    }
}

impl Force for Turned {
    fn name(&self) -> &'static str {
        self.force.name()
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        let turn = self.look(curve);
        self.own.clear();
        self.own.resize(curve.x.len(), DVec2::ZERO);
        let seen = Curve {
            x: &self.x,
            v: &self.v,
            ..*curve
        };
        self.force.add(&seen, &mut self.own).map_err(|mut fault| {
            fault.at = curve.x[fault.node];
            fault
        })?;
        for (force, &own) in force.iter_mut().zip(&self.own) {
            *force += turn.rotate(own);
        }
        Ok(())
    }

    fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        let turn = self.look(curve);
        self.slopes.clear();
        self.slopes.resize(curve.x.len(), DMat2::ZERO);
        let seen = Curve {
            x: &self.x,
            v: &self.v,
            ..*curve
        };
        if !self.force.add_slope(&seen, &mut self.slopes) {
            return false;
        }
        let turn = DMat2::from_cols(turn, turn.perp());
        for (slope, &own) in slope.iter_mut().zip(&self.slopes) {
            *slope += turn * own * turn.transpose();
        }
        true
    }

    fn depends_on_velocity(&self) -> bool {
        self.force.depends_on_velocity()
    }

    fn is_constant(&self) -> bool {
        self.rate == 0.0 && self.force.is_constant()
    }

    fn pull(&self, spacing: f64, curve: Option<&Curve<'_>>) -> Pull {
        let Some(curve) = curve else {
            return self.force.pull(spacing, None);
        };
        let mut seen = self.clone();
        seen.look(curve);
        let seen = Curve {
            x: &seen.x,
            v: &seen.v,
            ..*curve
        };
        self.force.pull(spacing, Some(&seen))
    }

    fn couples(&self) -> bool {
        self.force.couples()
    }

    fn needs_closed(&self) -> bool {
        self.force.needs_closed()
    }

    fn validate(&self, n: usize) -> Result<(), SnakeError> {
        place("the place to turn about", self.about)?;
        finite_at_least("the rate of turning", f64::MIN, "a number", self.rate)?;
        self.force.validate(n)
    }

    fn carry(&mut self, plan: &outline::Plan) {
        self.force.carry(plan);
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
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::Spring;

    #[test]
    fn a_quarter_of_a_turn_on_the_force_and_its_slope_are_a_quarter_turned() {
        // a spring to (3, 1), turned about the origin by 90 degrees, is one to (−1, 3)
        let spring = |to: DVec2| Spring::at_node(0, to, 2.0);
        let mut turned = Turned::new(spring(DVec2::new(3.0, 1.0)).boxed(), DVec2::ZERO, FRAC_PI_2);
        let mut there = spring(DVec2::new(-1.0, 3.0));
        let (x, v) = ([DVec2::new(0.4, -0.7), DVec2::ONE], [DVec2::ZERO; 2]);
        let curve = Curve {
            t: 1.0,
            x: &x,
            v: &v,
            mass: &[1.0; 2],
            closed: false,
            spacing: 1.0,
        };
        let (mut a, mut b) = ([DVec2::ZERO; 2], [DVec2::ZERO; 2]);
        turned.add(&curve, &mut a).unwrap();
        there.add(&curve, &mut b).unwrap();
        // cos of the rounded quarter turn is 6e-17
        assert!((a[0] - b[0]).length() < 1e-14 && b[0].length() > 1.0);
        assert!(!turned.is_constant());
    }
}

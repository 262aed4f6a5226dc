//! Forces from outside: what they are asked, and the world's list of them.

mod gravity;
mod image;

pub use gravity::Gravity;
pub use image::{ImageForce, Sampling};

use std::any::Any;
use std::fmt;

use elastic::{Bound, Profile};
use glam::{DMat2, DVec2};
use integrator::Fault;

use crate::{Schedule, SnakeError};

/// A curve at one moment, as a force meets it.
#[derive(Debug, Clone, Copy)]
pub struct Curve<'a> {
    /// Time. T.
    pub t: f64,
    /// The nodes. L.
    pub x: &'a [DVec2],
    /// Their velocities. L T⁻¹.
    pub v: &'a [DVec2],
    /// μ of each node. M.
    pub mass: &'a [f64],
    /// Whether the last node is joined to the first.
    pub closed: bool,
    /// Spacing at rest: the length of curve that each node stands for. L.
    pub spacing: f64,
}

/// How stiff a force may become at one node, for step limits.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pull {
    /// The largest −∂f/∂x along any direction. M T⁻².
    pub stiffness: f64,
    /// The largest −∂f/∂v. M T⁻¹.
    pub damping: f64,
}

/// A force on the nodes of a snake from outside, per unit of arc length at rest.
///
/// A world holds any number of them, each with a weight along the curve ([`Acting`]). A new kind
/// needs no change anywhere else: what it answers here is all that a run, its ledger and its
/// certificate ask.
pub trait Force: fmt::Debug + Send + Sync {
    /// The word for it: its column in the ledger.
    fn name(&self) -> &'static str;

    /// Add the force on every node to `force`.
    ///
    /// # Errors
    ///
    /// A [`Fault`] at the first node at which the force has no value.
    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault>;

    /// Add ∂fᵢ/∂xᵢ of every node to `slope`; false, with `slope` as it was, where it is not known.
    fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        let _ = (curve, slope);
        false
    }

    /// The energy `E` of the whole curve with `h f = −∂E/∂x`, if there is one. M L³ T⁻².
    ///
    /// It may not change with time by itself: what moves or fades is booked as work.
    fn energy(&self, curve: &Curve<'_>) -> Option<f64> {
        let _ = curve;
        None
    }

    /// Whether the force is the same whatever place, velocity and time.
    fn is_constant(&self) -> bool {
        false
    }

    /// Bounds of its slopes: at `curve`, or anywhere without one.
    fn pull(&self, curve: Option<&Curve<'_>>) -> Pull {
        let _ = curve;
        Pull::default()
    }

    /// Check every value against a curve of `n` nodes.
    ///
    /// # Errors
    ///
    /// The first one that will not do, by name.
    fn validate(&self, n: usize) -> Result<(), SnakeError> {
        let _ = n;
        Ok(())
    }

    /// The curve has other nodes, made of the old ones as `plan` says: for forces that know nodes by
    /// their numbers.
    fn carry(&mut self, plan: &outline::Plan) {
        let _ = plan;
    }

    /// The same force once more.
    fn boxed(&self) -> Box<dyn Force>;

    /// Itself, for those who look for a kind they know.
    fn as_any(&self) -> &dyn Any;
}

impl Clone for Box<dyn Force> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

/// A force at work: with its weight along the curve and over time.
#[derive(Debug, Clone)]
pub struct Acting {
    name: String,
    force: Box<dyn Force>,
    weight: Profile,
    schedule: Option<Schedule>,
    scratch: Vec<DVec2>,
    slopes: Vec<DMat2>,
}

impl Acting {
    /// That force with weight 1.
    #[must_use]
    pub fn new(force: impl Force + 'static) -> Self {
        Self::boxed(Box::new(force))
    }

    /// The same for a kind known only at run time.
    #[must_use]
    pub fn boxed(force: Box<dyn Force>) -> Self {
        Self {
            name: force.name().to_owned(),
            force,
            weight: Profile::Uniform(1.0),
            schedule: None,
            scratch: Vec::new(),
            slopes: Vec::new(),
        }
    }

    /// The same called `name`: its column in the ledger.
    #[must_use]
    pub fn named(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// The same with a weight along the curve. Dimensionless, at least 0.
    #[must_use]
    pub fn weighted(mut self, weight: Profile) -> Self {
        self.weight = weight;
        self
    }

    /// The same with a factor over time.
    #[must_use]
    pub fn scheduled(mut self, schedule: Schedule) -> Self {
        self.schedule = Some(schedule);
        self
    }

    /// Follow a curve to other nodes.
    pub(crate) fn carry(&mut self, plan: &outline::Plan) {
        if let Profile::PerNode(values) = &mut self.weight
            && let Ok(poured) = plan.pour(values)
        {
            *values = poured;
        }
        self.force.carry(plan);
    }

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The force without its weight.
    #[must_use]
    pub fn force(&self) -> &dyn Force {
        &*self.force
    }

    /// The force as the kind it is, if it is that kind.
    #[must_use]
    pub fn downcast<F: Force + 'static>(&self) -> Option<&F> {
        self.force.as_any().downcast_ref()
    }

    /// Its weight along the curve.
    #[must_use]
    pub const fn weight(&self) -> &Profile {
        &self.weight
    }

    fn factor(&self, t: f64) -> f64 {
        self.schedule.as_ref().map_or(1.0, |s| s.at(t))
    }

    /// Weight of node `i` where the factor over time is `factor`.
    fn share(&self, factor: f64, i: usize) -> f64 {
        factor * self.weight.at(i)
    }

    /// Whether it acts as it is.
    fn is_plain(&self) -> bool {
        self.schedule.is_none()
            && matches!(self.weight, Profile::Uniform(w) if (w - 1.0).abs() == 0.0)
    }

    /// Add the weighted force on every node to `force`.
    ///
    /// # Errors
    ///
    /// As [`Force::add`].
    pub fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        if self.is_plain() {
            return self.force.add(curve, force);
        }
        let mut own = std::mem::take(&mut self.scratch);
        own.clear();
        own.resize(curve.x.len(), DVec2::ZERO);
        let outcome = self.force.add(curve, &mut own);
        let factor = self.factor(curve.t);
        for (i, (force, &own)) in force.iter_mut().zip(&own).enumerate() {
            *force += own * self.share(factor, i);
        }
        self.scratch = own;
        outcome
    }

    /// Add the weighted slopes; false where they are not known.
    pub(crate) fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        if self.is_plain() {
            return self.force.add_slope(curve, slope);
        }
        let mut own = std::mem::take(&mut self.slopes);
        own.clear();
        own.resize(curve.x.len(), DMat2::ZERO);
        let known = self.force.add_slope(curve, &mut own);
        let factor = self.factor(curve.t);
        for (i, (slope, &own)) in slope.iter_mut().zip(&own).enumerate() {
            *slope += own * self.share(factor, i);
        }
        self.slopes = own;
        known
    }

    /// Its energy: none where the weight changes along the curve or with time.
    #[must_use]
    pub fn energy(&self, curve: &Curve<'_>) -> Option<f64> {
        match (&self.weight, &self.schedule) {
            (Profile::Uniform(weight), None) => self.force.energy(curve).map(|e| e * weight),
            _ => None,
        }
    }

    /// Whether it is the same at any place, velocity and time.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.schedule.is_none() && self.force.is_constant()
    }

    /// Bounds of its slopes, its largest weights counted in.
    #[must_use]
    pub fn pull(&self, curve: Option<&Curve<'_>>) -> Pull {
        let n = match &self.weight {
            Profile::Uniform(_) => 1,
            Profile::PerNode(weights) => weights.len(),
        };
        let along = (0..n).map(|i| self.weight.at(i)).fold(0.0, f64::max);
        let most = along * self.schedule.as_ref().map_or(1.0, Schedule::largest);
        let pull = self.force.pull(curve);
        Pull {
            stiffness: most * pull.stiffness,
            damping: most * pull.damping,
        }
    }

    /// Check the force and its weight against a curve of `n` nodes.
    ///
    /// # Errors
    ///
    /// The first value that will not do, by name.
    pub fn validate(&self, n: usize) -> Result<(), SnakeError> {
        self.weight.validate("weight", n, Bound::AtLeast(0.0))?;
        self.force.validate(n)
    }
}

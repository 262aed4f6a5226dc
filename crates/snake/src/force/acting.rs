//! A force at work.

use elastic::{Bound, Profile};
use glam::{DMat2, DVec2};
use integrator::Fault;

use super::{Curve, Force, ImageForce, Pull, RegionForce, SignedEdgeForce};
use crate::{Schedule, SnakeError};

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

    /// Whether it comes from a picture.
    #[must_use]
    pub fn is_of_picture(&self) -> bool {
        self.downcast::<ImageForce>().is_some()
            || self.downcast::<SignedEdgeForce>().is_some()
            || self.downcast::<RegionForce>().is_some()
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

    /// When its factor over time has changed for the last time; minus infinity if it never does.
    #[must_use]
    pub fn end(&self) -> f64 {
        let end = self.schedule.as_ref().map(Schedule::end);
        end.unwrap_or(f64::NEG_INFINITY)
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

    /// As [`Force::settle`].
    pub(crate) fn settle(&mut self, curve: &Curve<'_>) {
        self.force.settle(curve);
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

    /// Whether it depends on the velocities of the nodes.
    #[must_use]
    pub fn depends_on_velocity(&self) -> bool {
        self.force.depends_on_velocity()
    }

    /// Whether the force on a node depends on where others are.
    #[must_use]
    pub fn couples(&self) -> bool {
        self.force.couples()
    }

    /// Bounds of its slopes, its largest weights counted in.
    #[must_use]
    pub fn pull(&self, spacing: f64, curve: Option<&Curve<'_>>) -> Pull {
        let n = match &self.weight {
            Profile::Uniform(_) => 1,
            Profile::PerNode(weights) => weights.len(),
        };
        let along = (0..n).map(|i| self.weight.at(i)).fold(0.0, f64::max);
        let most = along * self.schedule.as_ref().map_or(1.0, Schedule::largest);
        let pull = self.force.pull(spacing, curve);
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

//! A scheme at work: what all steppers share.

use glam::DVec2;

use crate::{Fault, FaultKind, SchemeError, State, System};

/// A scheme at work on one system with one step.
///
/// Owns the scratch space and whatever history the scheme needs. Between two steps the state is the
/// stepper's: whoever changes it starts a new one.
pub trait Stepper: std::fmt::Debug + Send + Sync {
    /// Move `state` one step on. Allocates nothing, unless the system's schedules change.
    ///
    /// # Errors
    ///
    /// A [`Fault`] when a force has no value or a number is not finite any more; the state is then
    /// as it was.
    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault>;

    /// The step.
    fn dt(&self) -> f64;

    /// Go on from another state, at any time, as if started there with [`Start::SecondOrder`].
    ///
    /// What depends on the step alone is kept, factors above all. A scheme of two steps also keeps its past where
    /// `state` is at the time its last step ended at, and so nearly where that ended.
    fn resume(&mut self, system: &mut dyn System, state: &State);

    /// Go on from the state that the last step ended at, with velocities that someone else has
    /// changed since, as contacts between two systems do. What does not depend on them is kept.
    fn kicked(&mut self, system: &mut dyn System, state: &State) {
        self.resume(system, state);
    }

    /// The same stepper once more, with all that it remembers.
    fn boxed(&self) -> Box<dyn Stepper>;
}

impl Clone for Box<dyn Stepper> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

/// The revision of a system that a scheme has its numbers from.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Seen(u64);

impl Seen {
    /// The present one.
    pub(crate) fn of(system: &dyn System) -> Self {
        Self(system.revision())
    }

    /// Bring the system to time `t` and nodes at `x`; whether it is another revision than the one seen.
    pub(crate) fn left_behind(&self, system: &mut dyn System, t: f64, x: &[DVec2]) -> bool {
        system.advance(t, x);
        system.revision() != self.0
    }
}

/// What is known at the start: how a scheme with history invents the step before the first (D19).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Start {
    /// Before the first step the nodes were at `x₀ − dt v₀`: the report's rule.
    FirstOrder,
    /// They were at `x₀ − dt v₀ + ½ dt² a₀`, so that the start loses no order.
    #[default]
    SecondOrder,
}

/// Time by counting steps: `t₀ + k · dt`, so that thousands of steps do not drift (D20).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    pub(crate) dt: f64,
    start: f64,
    count: u64,
}

impl Clock {
    pub(crate) fn new(state: &State, dt: f64) -> Self {
        Self {
            dt,
            start: state.t,
            count: 0,
        }
    }

    /// Count from this state on.
    pub(crate) fn restart(&mut self, state: &State) {
        *self = Self::new(state, self.dt);
    }

    /// Time at the beginning of the step to come.
    pub(crate) fn now(&self) -> f64 {
        self.start + count(self.count) * self.dt
    }

    /// Time at its end.
    pub(crate) fn next(&self) -> f64 {
        self.start + count(self.count + 1) * self.dt
    }

    /// Time at a share of it, 0 to 1.
    pub(crate) fn part(&self, share: f64) -> f64 {
        self.start + (count(self.count) + share) * self.dt
    }

    /// Such a share of the step is made already.
    pub(crate) fn rewind(&mut self, share: f64) {
        self.start -= share * self.dt;
    }

    /// The step is made.
    pub(crate) fn tick(&mut self, state: &mut State) {
        state.t = self.next();
        self.count += 1;
        state.step += 1;
    }
}

/// Exact up to 2⁵³ steps.
pub(crate) fn count(steps: u64) -> f64 {
    steps as f64
}

/// Elastic and external force together; what held nodes get is for the caller to leave out.
pub(crate) fn force(
    system: &mut dyn System,
    t: f64,
    x: &[DVec2],
    v: &[DVec2],
    force: &mut [DVec2],
) -> Result<(), Fault> {
    system.elastic(x, force);
    system.external(t, x, v, force)
}

/// External force alone, zero at held nodes.
pub(crate) fn external(
    system: &mut dyn System,
    t: f64,
    x: &[DVec2],
    v: &[DVec2],
    force: &mut [DVec2],
) -> Result<(), Fault> {
    force.fill(DVec2::ZERO);
    system.external(t, x, v, force)?;
    release(system.held(), force);
    Ok(())
}

/// Zero what held nodes got.
pub(crate) fn release(held: &[bool], values: &mut [DVec2]) {
    // mostly none is: to find that out without an early way out costs next to nothing
    if !held.iter().fold(false, |any, &held| any | held) {
        return;
    }
    for (value, &held) in values.iter_mut().zip(held) {
        if held {
            *value = DVec2::ZERO;
        }
    }
}

/// Refuse positions that are not finite any more.
pub(crate) fn finite(x: &[DVec2]) -> Result<(), Fault> {
    if lanes::finite(x) {
        return Ok(());
    }
    let node = x.iter().position(|p| !p.is_finite()).unwrap_or(0);
    Err(Fault {
        node,
        at: x[node],
        kind: FaultKind::NotFinite,
    })
}

/// The fault of a system whose schedules brought it where no step can be made.
pub(crate) fn unsolvable(x: &[DVec2]) -> Fault {
    let at = x.first().copied().unwrap_or(DVec2::ZERO);
    Fault {
        node: 0,
        at,
        kind: FaultKind::NoSolution,
    }
}

/// Whether a scheme can do without mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mass {
    /// Divides by it: above 0 at every node.
    Needed,
    /// At least 0.
    Optional,
}

/// Check everything a scheme relies on: lengths, signs, and that all numbers are finite.
pub(crate) fn check(
    scheme: &'static str,
    system: &dyn System,
    state: &State,
    dt: f64,
    need: Mass,
) -> Result<(), SchemeError> {
    if !(dt.is_finite() && dt > 0.0) {
        return Err(SchemeError::BadStep { dt });
    }
    if !((dt * dt).is_finite() && (1.0 / (dt * dt)).is_finite()) {
        return Err(SchemeError::BeyondNumbers { scheme, dt });
    }
    let needed = system.len();
    for (what, got) in [
        ("state.x", state.x.len()),
        ("state.v", state.v.len()),
        ("mass", system.mass().len()),
        ("damping", system.damping().len()),
        ("held", system.held().len()),
        ("stiffness", system.stiffness().len()),
    ] {
        if got != needed {
            return Err(SchemeError::Length { what, needed, got });
        }
    }
    densities(scheme, system, need)?;
    let bad = |(x, v): (&DVec2, &DVec2)| !(x.is_finite() && v.is_finite());
    match state.x.iter().zip(&state.v).position(bad) {
        Some(node) => Err(SchemeError::BadStart { node }),
        None => Ok(()),
    }
}

/// Check mass and damping alone: at the start, and again whenever a schedule changed them.
pub(crate) fn densities(
    scheme: &'static str,
    system: &dyn System,
    need: Mass,
) -> Result<(), SchemeError> {
    for (node, &mass) in system.mass().iter().enumerate() {
        // a held node does not move, so its mass is never divided by
        let least_met =
            mass > 0.0 || (mass >= 0.0 && (need == Mass::Optional || system.held()[node]));
        if !(mass.is_finite() && least_met) {
            return Err(SchemeError::BadMass { scheme, node, mass });
        }
    }
    match system
        .damping()
        .iter()
        .position(|&c| !(c.is_finite() && c >= 0.0))
    {
        Some(node) => Err(SchemeError::BadDamping {
            node,
            damping: system.damping()[node],
        }),
        None => Ok(()),
    }
}

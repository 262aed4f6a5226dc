//! The report's own scheme, to the letter.

use glam::DVec2;

use crate::contact::Contacts;
use crate::impulse::{Moment, Pace};
use crate::stepper::{self, Mass, Seen};
use crate::{Fault, Response, SchemeError, Start, State, Stepper, System, each};

/// Eq. 3.5 as the report's program computes it.
///
/// ```text
/// x⁺ = (f + α₁ x + α₂ x₋ − K e) dt² / μ,   α₁ = 2 μ/dt² − γ/dt,   α₂ = γ/dt − μ/dt²
/// ```
///
/// The velocity is the backward difference `(x − x₋) / dt` (D18). Positions are formed from terms as
/// large as `2 μ x / dt²`, so rounding grows over thousands of steps (D21), and time is the sum of
/// all `dt` (D20): both on purpose. A clamp leaves `x₋` alone (D57).
#[derive(Debug, Clone)]
pub(crate) struct Report {
    dt: f64,
    start: Start,
    first: bool,
    previous: Vec<DVec2>,
    backward: Vec<DVec2>,
    next: Vec<DVec2>,
    external: Vec<DVec2>,
    elastic: Vec<DVec2>,
    seen: Seen,
    contacts: Contacts,
}

impl Report {
    pub(crate) const NAME: &'static str = "report";

    pub(crate) fn new(
        system: &mut dyn System,
        state: &State,
        dt: f64,
        start: Start,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        stepper::check(Self::NAME, system, state, dt, Mass::Needed)?;
        let zeros = || vec![DVec2::ZERO; state.len()];
        let previous = state
            .x
            .iter()
            .zip(&state.v)
            .map(|(x, v)| x - v * dt)
            .collect();
        Ok(Self {
            dt,
            start,
            first: true,
            previous,
            backward: state.v.clone(),
            next: zeros(),
            external: zeros(),
            elastic: zeros(),
            seen: Seen::of(system),
            contacts: Contacts::new(state.len()),
        })
    }
}

impl Stepper for Report {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let dt = self.dt;
        let dt2 = dt * dt;
        if self.seen.left_behind(system, state.t, &state.x) {
            if stepper::densities(Self::NAME, system, Mass::Needed).is_err() {
                return Err(stepper::unsolvable(&state.x));
            }
            self.seen = Seen::of(system);
        }
        self.external.fill(DVec2::ZERO);
        system.external(state.t, &state.x, &self.backward, &mut self.external)?;
        system.elastic(&state.x, &mut self.elastic);
        let (mass, damping, held) = (system.mass(), system.damping(), system.held());
        if self.first && self.start == Start::SecondOrder {
            for i in (0..state.len()).filter(|&i| !held[i]) {
                let push = self.external[i] + self.elastic[i] - damping[i] * state.v[i];
                self.previous[i] = state.x[i] - dt * state.v[i] + 0.5 * dt2 * push / mass[i];
            }
        }
        let shared = each::common(mass).zip(each::common(damping));
        let step = move |[mu, gamma]: [f64; 2], [x, previous, external, elastic]: [f64; 4], _| {
            let alpha1 = 2.0 * mu / dt2 - gamma / dt;
            let alpha2 = gamma / dt - mu / dt2;
            (external + alpha1 * x + alpha2 * previous + elastic) * dt2 / mu
        };
        let from = [&state.x[..], &self.previous, &self.external, &self.elastic];
        let densities = ([mass, damping], shared.map(|(mu, gamma)| [mu, gamma]));
        each::weighted_onto(densities, from, &mut self.next, step);
        for (i, _) in held.iter().enumerate().filter(|(_, held)| **held) {
            self.next[i] = state.x[i];
        }
        stepper::finite(&self.next)?;
        self.first = false;
        each::onto(
            [&self.next, &state.x],
            &mut self.backward,
            move |[next, x], _| (next - x) / dt,
        );
        // where the nodes are now is the step before for the next one
        self.previous.copy_from_slice(&state.x);
        let moment = Moment {
            t: state.t + dt,
            dt,
            pace: Pace::Late,
        };
        let next = &mut self.next;
        if self
            .contacts
            .meet(system, moment, &state.x, next, &mut self.backward)?
        {
            for touch in self.contacts.touches() {
                let i = touch.node;
                if touch.response != Response::Clamp {
                    self.previous[i] = next[i] - dt * self.backward[i];
                }
            }
        }
        std::mem::swap(&mut state.x, &mut self.next);
        state.v.copy_from_slice(&self.backward);
        state.t += dt;
        state.step += 1;
        Ok(())
    }

    fn dt(&self) -> f64 {
        self.dt
    }

    fn resume(&mut self, _system: &mut dyn System, state: &State) {
        self.first = true;
        self.start = Start::SecondOrder;
        self.backward.copy_from_slice(&state.v);
    }

    /// The velocity is the difference of two positions: the earlier one changes with it.
    fn kicked(&mut self, _system: &mut dyn System, state: &State) {
        for (i, (now, before)) in state.v.iter().zip(&mut self.backward).enumerate() {
            if *now != *before {
                self.previous[i] -= self.dt * (*now - *before);
                *before = *now;
            }
        }
    }
}

/// How often the report's loop `while t < end, …, t = t + dt` goes round.
///
/// Rounding accumulates in `t`, so 500 at 0.01 takes 50001 steps, not 50000 (D20). None if the loop
/// never ends or an argument is not finite.
#[must_use]
pub fn report_steps(end: f64, dt: f64) -> Option<u64> {
    let most = 2.0_f64.powi(40);
    if !(end.is_finite() && dt.is_finite() && dt > 0.0 && end / dt < most) {
        return None;
    }
    let (mut t, mut steps) = (0.0, 0);
    while t < end {
        let later = t + dt;
        if later <= t {
            return None;
        }
        t = later;
        steps += 1;
    }
    Some(steps)
}

//! The energies of a snake, term by term, and the account of where they go.
//!
//! Each is an integral over the curve, `h Σ`, so that it does not depend on the number of nodes.
//! Where a force has a potential the energy is that potential. Where it has none (the report's
//! field is no gradient, D39; a field sampled between pixels is one only in the limit; what fades
//! or moves with time is none) the [`Ledger`] books minus the work that the force has done since
//! the run began. It books too what damping and contacts have taken and what changing parameters
//! have put in, so that the sum of everything stays what it was.

use glam::DVec2;
use integrator::{Fault, State};

use crate::{Snake, World};

/// Energy of every term at one moment. M L³ T⁻².
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Energies {
    /// `½ h Σ μ v²`.
    pub kinetic: f64,
    /// `½ h Σ ω₀ e²`.
    pub tether: f64,
    /// `½ h Σ ω₁ |D₁ e|²`.
    pub tension: f64,
    /// `½ h Σ ω₂ |D₂ e|²`.
    pub rigidity: f64,
    /// Of each force of the world, in its order: its potential, or minus its work since the run began.
    pub forces: Vec<f64>,
    /// `½ h Σ k d²` over the nodes behind penalty walls.
    pub wall: f64,
    /// Lost to damping since the run began.
    pub damping: f64,
    /// Lost in contacts since the run began.
    pub contact: f64,
    /// Minus what changing parameters have put in since the run began.
    pub parameters: f64,
}

impl Energies {
    /// What each of [`Energies::values`] is called in that world.
    #[must_use]
    pub fn names(world: &World) -> Vec<String> {
        Self::names_with(world.names())
    }

    /// The same with these names for the forces.
    pub fn names_with<'a>(forces: impl Iterator<Item = &'a str>) -> Vec<String> {
        let first = ["kinetic", "tether", "tension", "rigidity"];
        let last = ["wall", "damping", "contact", "parameters"];
        first
            .into_iter()
            .chain(forces)
            .chain(last)
            .map(str::to_owned)
            .collect()
    }

    /// Every term, in the order of [`Energies::names`].
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        let mut values = vec![self.kinetic, self.tether, self.tension, self.rigidity];
        values.extend(&self.forces);
        values.extend([self.wall, self.damping, self.contact, self.parameters]);
        values
    }

    /// The three elastic terms together: ξ of report Eq. 2.5.
    #[must_use]
    pub fn elastic(&self) -> f64 {
        self.tether + self.tension + self.rigidity
    }

    /// What could still move: everything but what is booked as lost or put in.
    #[must_use]
    pub fn mechanical(&self) -> f64 {
        self.kinetic + self.elastic() + self.forces.iter().sum::<f64>() + self.wall
    }

    /// The sum of all terms. With a [`Ledger`] it stays what it was, up to the errors of the scheme
    /// and of the account.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.mechanical() + self.damping + self.contact + self.parameters
    }
}

/// Follows a run and keeps account of what has no potential.
///
/// Between two states the motion is taken as the cubic through both places and velocities, and
/// powers are summed by Simpson's rule: an error of order 4 in the step where the scheme has one. A
/// step with a contact, whose velocity jumps, is booked by the trapezoidal rule: order 2. What a
/// contact takes is asked of the snake at the moment it happens.
#[derive(Debug, Clone)]
pub struct Ledger {
    before: State,
    /// Forces without a potential, by their place in the world.
    bookings: Vec<Booking>,
    damping: f64,
    /// What damping took per unit of time at the last state, under the damping there was then.
    rate: f64,
    contact: f64,
    parameters: f64,
    middle: State,
    force: Vec<DVec2>,
}

#[derive(Debug, Clone)]
struct Booking {
    index: usize,
    work: f64,
    /// Power at the last state.
    power: f64,
    /// Force at the last state.
    force: Vec<DVec2>,
}

impl Ledger {
    /// Begin at `state`.
    ///
    /// # Errors
    ///
    /// The fault of a force that has no value at a node.
    pub fn begin(snake: &mut Snake, state: &State) -> Result<Self, Fault> {
        snake.keep_account();
        let n = state.len();
        let mut bookings = Vec::new();
        for (index, potential) in snake
            .potentials(&snake.curve(state.t, &state.x, &state.v))
            .into_iter()
            .enumerate()
        {
            if potential.is_none() {
                let mut force = vec![DVec2::ZERO; n];
                snake.force_of(index, state, &mut force)?;
                let power = power(&force, &state.v);
                bookings.push(Booking {
                    index,
                    work: 0.0,
                    power,
                    force,
                });
            }
        }
        Ok(Self {
            before: state.clone(),
            bookings,
            damping: 0.0,
            rate: snake.loss(state),
            contact: 0.0,
            parameters: 0.0,
            middle: state.clone(),
            force: vec![DVec2::ZERO; n],
        })
    }

    /// Book the step that led to `state`.
    ///
    /// # Errors
    ///
    /// The fault of a force that has no value at a node; what was booked before stays.
    pub fn book(&mut self, snake: &mut Snake, state: &State) -> Result<(), Fault> {
        let h = snake.body().spacing;
        let dt = state.t - self.before.t;
        let lost = snake.take_lost();
        let smooth = lost.is_none();
        self.contact += lost.unwrap_or(0.0);
        self.parameters -= snake.take_put_in(&self.before, state);
        self.halfway(state, dt);
        let loss = |state: &State| snake.loss(state);
        let (before, after) = (self.rate, loss(state));
        self.damping += h * if smooth {
            dt / 6.0 * (before + 4.0 * loss(&self.middle) + after)
        } else {
            dt / 2.0 * (before + after)
        };
        self.rate = after;
        for booking in &mut self.bookings {
            self.force.fill(DVec2::ZERO);
            snake.force_of(booking.index, state, &mut self.force)?;
            let after = power(&self.force, &state.v);
            let work = if smooth {
                let mut middle = vec![DVec2::ZERO; state.len()];
                snake.force_of(booking.index, &self.middle, &mut middle)?;
                dt / 6.0 * (booking.power + 4.0 * power(&middle, &self.middle.v) + after)
            } else {
                let mut work = 0.0;
                for (i, &x) in state.x.iter().enumerate() {
                    work += 0.5 * (booking.force[i] + self.force[i]).dot(x - self.before.x[i]);
                }
                work
            };
            booking.work += h * work;
            booking.power = after;
            booking.force.copy_from_slice(&self.force);
        }
        self.before.clone_from(state);
        Ok(())
    }

    /// Go on from another state, as after a kick from outside or on other nodes: what is booked stays.
    ///
    /// # Errors
    ///
    /// As [`Ledger::begin`].
    pub fn resume(&mut self, snake: &mut Snake, state: &State) -> Result<(), Fault> {
        let n = state.len();
        snake.keep_account();
        self.before.clone_from(state);
        self.middle.clone_from(state);
        self.force.resize(n, DVec2::ZERO);
        for booking in &mut self.bookings {
            booking.force.clear();
            booking.force.resize(n, DVec2::ZERO);
            snake.force_of(booking.index, state, &mut booking.force)?;
            booking.power = power(&booking.force, &state.v);
        }
        Ok(())
    }

    /// All that is booked as lost, and minus all work.
    #[must_use]
    pub(crate) fn booked(&self) -> (f64, f64) {
        let work: f64 = self.bookings.iter().map(|booking| booking.work).sum();
        (self.damping + self.contact + self.parameters, 0.0 - work)
    }

    /// The cubic through both states, halfway.
    fn halfway(&mut self, state: &State, dt: f64) {
        let (from, middle) = (&self.before, &mut self.middle);
        middle.t = from.t + 0.5 * dt;
        for i in 0..state.len() {
            let way = state.x[i] - from.x[i];
            middle.x[i] = from.x[i] + 0.5 * way + dt / 8.0 * (from.v[i] - state.v[i]);
            middle.v[i] = 1.5 / dt * way - 0.25 * (from.v[i] + state.v[i]);
        }
    }

    /// The energies of `snake` at `state`, with all that is booked.
    pub fn energies(&self, snake: &mut Snake, state: &State) -> Energies {
        let mut energies = snake.energies(state);
        for booking in &self.bookings {
            // minus no work is plain zero
            energies.forces[booking.index] = 0.0 - booking.work;
        }
        energies.damping = self.damping;
        energies.contact = self.contact;
        energies.parameters = self.parameters;
        energies
    }
}

fn power(force: &[DVec2], v: &[DVec2]) -> f64 {
    force.iter().zip(v).map(|(f, v)| f.dot(*v)).sum()
}

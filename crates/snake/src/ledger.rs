//! The account of where the energies of a run go.

use glam::DVec2;
use integrator::{Fault, Scheme, Start, State, System};

use crate::account::Touched;
use crate::algebra::{Algebra, Booked};
use crate::factors::Factors;
use crate::{Energies, Parameter, Snake};

/// Follows a run and keeps account of what has no potential.
///
/// Under a scheme whose formulas it knows ([`Ledger::under`]) it counts as the scheme does, and the sum closes to
/// rounding. Otherwise the motion between two states is taken as the cubic through both places and velocities, and
/// powers are summed by Simpson's rule: an error of order 4 in the step where the scheme has one. A
/// step with a contact, whose velocity jumps, is booked by the trapezoidal rule: order 2. What a
/// contact takes is asked of the snake at the moment it happens.
///
/// When the snake or its world has been changed between two steps ([`Snake::add_force`], [`Snake::hold`],
/// [`Snake::set_body`], …), the sum of all terms just before, less that just after, is booked under `hand`. A force
/// keeps its column as long as one of its name acts; what a force without a potential had booked when it went is the hand's. Book every
/// step, before or after the change.
#[derive(Debug, Clone)]
pub struct Ledger {
    before: State,
    /// The snake as it was when last changed, to ask for its energies.
    was: Box<Snake>,
    /// Forces without a potential, by their place in the world.
    bookings: Vec<Booking>,
    damping: f64,
    /// What damping took per unit of time at the last state, under the damping there was then.
    rate: f64,
    contact: f64,
    frame: f64,
    scheme: f64,
    parameters: f64,
    hand: f64,
    upkeep: f64,
    /// The scheme whose algebra is known, and what it has used at the last state.
    algebra: Option<Algebra>,
    middle: State,
    /// What parameters were multiplied by at the last state.
    factors: Factors,
    force: Vec<DVec2>,
    halfway: Vec<DVec2>,
}

#[derive(Debug, Clone)]
pub(crate) struct Booking {
    pub(crate) index: usize,
    pub(crate) work: f64,
    /// Power at the last state.
    power: f64,
    /// Force at the last state.
    pub(crate) force: Vec<DVec2>,
}

impl Ledger {
    /// Begin at `state`.
    ///
    /// # Errors
    ///
    /// The fault of a force that has no value at a node.
    pub fn begin(snake: &mut Snake, state: &State) -> Result<Self, Fault> {
        snake.keep_account();
        snake.bring(state.t, &state.x);
        let n = state.len();
        Ok(Self {
            before: state.clone(),
            was: Box::new(snake.clone()),
            bookings: bookings(snake, state, |_| 0.0)?,
            damping: 0.0,
            rate: snake.loss(state),
            contact: 0.0,
            frame: 0.0,
            scheme: 0.0,
            parameters: 0.0,
            hand: 0.0,
            upkeep: 0.0,
            algebra: None,
            middle: state.clone(),
            factors: snake.factors_at(state.t, &state.x),
            force: vec![DVec2::ZERO; n],
            halfway: vec![DVec2::ZERO; n],
        })
    }

    /// The same for steps of that scheme: where its algebra is known, what it does to the energy by itself is booked
    /// under `scheme`, and damping and work as it counts them, so that the sum closes to rounding.
    ///
    /// Known are [`Scheme::Report`] and [`Scheme::Leapfrog`]; others are booked as they were.
    ///
    /// # Errors
    ///
    /// As [`Ledger::begin`].
    pub fn under(mut self, scheme: Scheme, start: Start, snake: &mut Snake) -> Result<Self, Fault> {
        self.algebra = Algebra::of(scheme, start);
        // a scheme that leaves out mass moves nothing that has kinetic energy
        snake.inertia = scheme != Scheme::GradientFlow;
        self.was.inertia = snake.inertia;
        self.begin_powers(snake)?;
        Ok(self)
    }

    /// Book the step that led to `state`.
    ///
    /// # Errors
    ///
    /// The fault of a force that has no value at a node; what was booked before stays.
    pub fn book(&mut self, snake: &mut Snake, state: &State) -> Result<(), Fault> {
        if snake.edits == self.was.edits {
            return self.steps(snake, state);
        }
        if !snake.just_changed() {
            // as it was when it was changed, not as it is at the end of the step
            let now = snake.factors.clone();
            snake.take(self.factors.clone());
            let changed = self.change(snake);
            snake.take(now);
            changed?;
            return self.steps(snake, state);
        }
        // changed at `state`: the step was still made by the snake as it was
        let mut was = self.was.clone();
        if snake.renewal.is_some() {
            // chosen since then by the snake itself
            was.body.damping.clone_from(&snake.body.damping);
        }
        was.keep_up_with(snake);
        was.account = snake.account.take();
        snake.keep_account();
        self.steps(&mut was, state)?;
        self.change(snake)
    }

    /// All sub-steps that led to `state`.
    fn steps(&mut self, snake: &mut Snake, state: &State) -> Result<(), Fault> {
        self.frame -= snake.take_frame_work();
        for passed in snake.take_trail() {
            let algebra = self.algebra.take_if(|_| passed.coarse);
            self.step(snake, &passed.state, passed.touched)?;
            if let Some(mut algebra) = algebra {
                // many steps in one are none of its formulas'
                algebra.go_on(snake, &passed.state, &self.bookings)?;
                self.algebra = Some(algebra);
            }
        }
        let touched = snake.take_touched();
        self.step(snake, state, touched)
    }

    fn step(
        &mut self,
        snake: &mut Snake,
        state: &State,
        touched: Option<Touched>,
    ) -> Result<(), Fault> {
        self.stop(snake)?;
        snake.bring(state.t, &state.x);
        let factors = snake.factors_at(state.t, &state.x);
        let before = std::mem::replace(&mut self.factors, factors);
        if let Some(mut algebra) = self.algebra.take() {
            let booked = self.by_algebra(&mut algebra, snake, state, touched);
            self.algebra = Some(algebra);
            booked?;
            self.before.clone_from(state);
            return Ok(());
        }
        let h = snake.body().spacing;
        let dt = state.t - self.before.t;
        let smooth = touched.is_none();
        self.contact += touched.map_or(0.0, |touched| touched.lost);
        self.interpolate(state, dt);
        let way = [&self.before, &self.middle, state].map(|state| (&state.x[..], &state.v[..]));
        self.parameters -= snake.put_in((&before, &self.factors), way, None);
        let loss = |state: &State| snake.loss(state);
        let (before, after) = (self.rate, loss(state));
        self.damping += h * if smooth {
            dt / 6.0 * (before + 4.0 * loss(&self.middle) + after)
        } else {
            dt / 2.0 * (before + after)
        };
        self.rate = after;
        if !snake.body().frame.reaction {
            let mut total = 0.0;
            for (weight, state) in [(1.0, &self.before), (4.0, &self.middle), (1.0, state)] {
                let factors = snake.factors_at(state.t, &state.x);
                snake.frame_force(&factors, &state.x, &mut self.force);
                total += weight * power(&self.force, &state.v);
            }
            self.frame -= h * dt / 6.0 * total;
        }
        for booking in &mut self.bookings {
            self.force.fill(DVec2::ZERO);
            snake.force_of(booking.index, state, &mut self.force)?;
            let after = power(&self.force, &state.v);
            let work = if smooth {
                self.halfway.fill(DVec2::ZERO);
                snake.force_of(booking.index, &self.middle, &mut self.halfway)?;
                dt / 6.0 * (booking.power + 4.0 * power(&self.halfway, &self.middle.v) + after)
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

    /// What a step has done by the algebra of its scheme.
    fn by_algebra(
        &mut self,
        algebra: &mut Algebra,
        snake: &mut Snake,
        state: &State,
        touched: Option<Touched>,
    ) -> Result<(), Fault> {
        let Booked {
            damping,
            frame,
            scheme,
            parameters,
            works,
            contact,
        } = algebra.step(snake, &self.before, state, touched, &self.bookings)?;
        self.damping += damping;
        self.frame -= frame;
        self.scheme -= scheme;
        self.parameters -= parameters;
        self.contact += contact;
        for (booking, work) in self.bookings.iter_mut().zip(works) {
            booking.work += work;
        }
        Ok(())
    }

    /// Nodes that a hand has stopped stand: what they had is its work.
    fn stop(&mut self, snake: &mut Snake) -> Result<(), Fault> {
        let (h, mut stopped, mut any) = (snake.body().spacing, 0.0, false);
        // the masses of that moment, not those of the step's end
        let mass = self.factors.times(Parameter::Mass, &snake.body().mass);
        for (i, v) in self.before.v.iter_mut().enumerate() {
            if snake.held()[i] && *v != DVec2::ZERO {
                stopped += 0.5 * h * mass.at(i) * v.length_squared();
                *v = DVec2::ZERO;
                any = true;
            }
        }
        if !any {
            return Ok(());
        }
        self.hand += if snake.inertia { stopped } else { 0.0 };
        let now = snake.factors.clone();
        snake.take(self.factors.clone());
        let begun = self.begin_powers(snake);
        snake.take(now);
        begun
    }

    /// What everything does per unit of time at the last state, asked anew.
    fn begin_powers(&mut self, snake: &mut Snake) -> Result<(), Fault> {
        self.rate = snake.loss(&self.before);
        if let Some(algebra) = &mut self.algebra {
            algebra.begin(snake, &self.before, &self.bookings)?;
        }
        for booking in &mut self.bookings {
            booking.force.clear();
            booking.force.resize(self.before.len(), DVec2::ZERO);
            snake.force_of(booking.index, &self.before, &mut booking.force)?;
            booking.power = power(&booking.force, &self.before.v);
        }
        Ok(())
    }

    /// Book the change of the snake that happened at the last state, where the scheme begins again.
    fn change(&mut self, snake: &mut Snake) -> Result<(), Fault> {
        let mut was = self.was.clone();
        was.keep_up_with(snake);
        let sum = self.energies(&mut was, &self.before).total();
        let mut works = vec![Some(0.0); was.world().forces.len()];
        for booking in &self.bookings {
            works[booking.index] = Some(booking.work);
        }
        let before = self.before.clone();
        self.bookings = bookings(snake, &before, |name| {
            let mut old = works.iter_mut().zip(was.world().names());
            let same = old.find(|(work, old)| work.is_some() && *old == name);
            same.and_then(|(work, _)| work.take()).unwrap_or(0.0)
        })?;
        self.hand += sum - self.energies(snake, &before).total();
        self.rate = snake.loss(&before);
        if let Some(algebra) = &mut self.algebra {
            algebra.begin(snake, &before, &self.bookings)?;
            algebra.resume();
        }
        *self.was = snake.clone();
        Ok(())
    }

    /// Book what has been done to the snake since the last step, if anything has, without waiting for the next.
    ///
    /// # Errors
    ///
    /// As [`Ledger::begin`].
    pub(crate) fn catch_up(&mut self, snake: &mut Snake) -> Result<(), Fault> {
        if snake.edits == self.was.edits {
            return Ok(());
        }
        self.change(snake)
    }

    /// Go on with another curve: other nodes, another rest shape, perhaps another scheme's first step. What that does to the
    /// sum is booked under `upkeep`. The forces are those of the same world.
    ///
    /// # Errors
    ///
    /// As [`Ledger::begin`].
    pub fn renew(
        &mut self,
        snake: &mut Snake,
        state: &State,
        scheme: Scheme,
        start: Start,
    ) -> Result<(), Fault> {
        let mut was = self.was.clone();
        let before = self.before.clone();
        let sum = self.energies(&mut was, &before).total();
        self.algebra = Algebra::of(scheme, start);
        self.resume(snake, state)?;
        *self.was = snake.clone();
        self.upkeep += sum - self.energies(snake, state).total();
        Ok(())
    }

    /// Go on from another state, as after a kick from outside or on other nodes: what is booked stays, and a change of
    /// the snake is not booked.
    ///
    /// # Errors
    ///
    /// As [`Ledger::begin`].
    pub fn resume(&mut self, snake: &mut Snake, state: &State) -> Result<(), Fault> {
        if let Some(algebra) = &mut self.algebra {
            algebra.resume();
        }
        self.go_on(snake, state)
    }

    /// The same where only velocities have been changed, and the scheme goes on.
    ///
    /// # Errors
    ///
    /// As [`Ledger::begin`].
    pub(crate) fn kicked(&mut self, snake: &mut Snake, state: &State) -> Result<(), Fault> {
        if let Some(algebra) = &mut self.algebra {
            algebra.kicked();
        }
        self.go_on(snake, state)
    }

    fn go_on(&mut self, snake: &mut Snake, state: &State) -> Result<(), Fault> {
        let n = state.len();
        snake.keep_account();
        snake.bring(state.t, &state.x);
        self.factors = snake.factors_at(state.t, &state.x);
        self.before.clone_from(state);
        self.middle.clone_from(state);
        self.force.resize(n, DVec2::ZERO);
        self.halfway.resize(n, DVec2::ZERO);
        self.begin_powers(snake)?;
        if snake.edits != self.was.edits {
            *self.was = snake.clone();
        }
        Ok(())
    }

    /// All that is booked, and minus all work for the only force.
    #[must_use]
    pub(crate) fn booked(&self) -> Energies {
        let work: f64 = self.bookings.iter().map(|booking| booking.work).sum();
        let mut energies = Energies {
            forces: vec![0.0 - work],
            ..Energies::default()
        };
        self.enter(&mut energies);
        energies
    }

    /// Write down what was lost and put in.
    const fn enter(&self, energies: &mut Energies) {
        energies.damping = self.damping;
        energies.contact = self.contact;
        energies.frame = self.frame;
        energies.scheme = self.scheme;
        energies.parameters = self.parameters;
        energies.hand = self.hand;
        energies.upkeep = self.upkeep;
    }

    /// The cubic through both states, halfway.
    fn interpolate(&mut self, state: &State, dt: f64) {
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
            if let Some(energy) = energies.forces.get_mut(booking.index) {
                // minus no work is plain zero
                *energy = 0.0 - booking.work;
            }
        }
        self.enter(&mut energies);
        energies
    }
}

/// An entry for each force without a potential; `work` says by its name what it has done so far, and is asked for every
/// force, in the order of the world.
fn bookings(
    snake: &mut Snake,
    state: &State,
    mut work: impl FnMut(&str) -> f64,
) -> Result<Vec<Booking>, Fault> {
    let potentials = snake.potentials(&snake.curve(state.t, &state.x, &state.v));
    let mut bookings = Vec::new();
    for (index, potential) in potentials.into_iter().enumerate() {
        let work = work(snake.world().forces[index].name());
        if potential.is_none() {
            let mut force = vec![DVec2::ZERO; state.len()];
            snake.force_of(index, state, &mut force)?;
            let power = power(&force, &state.v);
            bookings.push(Booking {
                index,
                work,
                power,
                force,
            });
        }
    }
    Ok(bookings)
}

fn power(force: &[DVec2], v: &[DVec2]) -> f64 {
    force.iter().zip(v).map(|(f, v)| f.dot(*v)).sum()
}

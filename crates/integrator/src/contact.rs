//! Obstacles met at the end of a step.
//!
//! A system says where a node that met something is put and how fast it leaves. Putting it there
//! costs or yields energy: it is moved against or along the forces on it. What comes out must not be
//! more than what went in, so the velocity that leads away from the obstacle is lowered by what the
//! move has yielded. In an implicit step the untouched nodes follow: the step is solved again with the
//! touched ones where they must be, or else a stiff body would be torn at every contact. Contacts are
//! met at the ends of steps only.

use glam::DVec2;

use crate::solver::Solver;
use crate::{Fault, Meeting, State, System, Touch, stepper};

/// The end of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment {
    /// Its time.
    pub(crate) t: f64,
    /// How long the step was.
    pub(crate) dt: f64,
    /// How far the velocities are behind the positions.
    pub(crate) pace: Pace,
}

impl Moment {
    /// How far the velocities are behind the positions.
    fn lag(self) -> f64 {
        match self.pace {
            Pace::Together => 0.0,
            Pace::Catching | Pace::Late => 0.5 * self.dt,
        }
    }
}

/// How velocities and positions of a scheme belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pace {
    /// At the same time.
    Together,
    /// The velocity is half a step late at the end of the step, but not after a touch.
    Catching,
    /// The velocity is always half a step late.
    Late,
}

/// Scratch space for contacts.
#[derive(Debug)]
pub(crate) struct Contacts {
    /// The touches of the last step.
    pub(crate) touches: Vec<Touch>,
    /// How far the touched nodes were moved, and those that followed.
    shift: Vec<DVec2>,
    /// Places and velocities before the touches.
    was: (Vec<DVec2>, Vec<DVec2>),
    force: Vec<DVec2>,
    product: Vec<DVec2>,
}

impl Contacts {
    pub(crate) fn new(n: usize) -> Self {
        let zeros = || vec![DVec2::ZERO; n];
        Self {
            touches: Vec::with_capacity(n),
            shift: zeros(),
            was: (zeros(), zeros()),
            force: zeros(),
            product: zeros(),
        }
    }

    /// Ask the system; true if any node touched something.
    pub(crate) fn find(
        &mut self,
        system: &mut dyn System,
        dt: f64,
        before: &[DVec2],
        x: &[DVec2],
        v: &[DVec2],
    ) -> bool {
        self.touches.clear();
        system.contacts(dt, before, x, v, &mut self.touches);
        let held = system.held();
        self.touches
            .retain(|touch| !held.get(touch.node).copied().unwrap_or(true));
        !self.touches.is_empty()
    }

    /// Meet all obstacles: put the touched nodes of `x` where they belong and turn their `v`.
    ///
    /// True if any node touched something.
    pub(crate) fn meet(
        &mut self,
        system: &mut dyn System,
        moment: Moment,
        before: &[DVec2],
        x: &mut [DVec2],
        v: &mut [DVec2],
    ) -> Result<bool, Fault> {
        self.meet_with(system, moment, before, x, v, None)
    }

    /// The same in an implicit step, whose other nodes follow the touched ones.
    pub(crate) fn meet_with(
        &mut self,
        system: &mut dyn System,
        moment: Moment,
        before: &[DVec2],
        x: &mut [DVec2],
        v: &mut [DVec2],
        solver: Option<&mut Solver>,
    ) -> Result<bool, Fault> {
        let Moment { t, dt, .. } = moment;
        if !self.find(system, dt, before, x, v) {
            return Ok(false);
        }
        self.was.0.copy_from_slice(x);
        self.was.1.copy_from_slice(v);
        self.shift.fill(DVec2::ZERO);
        let mut leaves = false;
        for touch in &self.touches {
            let i = touch.node;
            self.shift[i] = touch.position - x[i];
            leaves |= touch.velocity.is_some_and(|v| v.dot(self.shift[i]) > 0.0);
        }
        // what the move costs: ΔU, and the motion of those that follow
        let mut cost = 0.0;
        if let Some(solver) = solver {
            solver.follow(&mut self.touches, &mut self.shift);
            let mass = system.mass();
            for (i, &shift) in self.shift.iter().enumerate() {
                x[i] += shift;
                if !solver.touches(i) {
                    let rise = shift / dt;
                    cost += mass[i] * rise.dot(v[i] + 0.5 * rise);
                    v[i] += rise;
                }
            }
        }
        for touch in &self.touches {
            x[touch.node] = touch.position;
        }
        let mut share = 1.0;
        if leaves {
            stepper::force(system, t, x, v, &mut self.force)?;
            system
                .stiffness()
                .multiply_into(&self.shift, &mut self.product);
            // −F·δ − ½ δ·Aδ with F where they were put
            for (i, shift) in self.shift.iter().enumerate() {
                cost -= (self.force[i] + 0.5 * self.product[i]).dot(*shift);
            }
            share = self.share(system.mass(), moment, v, cost);
        }
        for touch in &self.touches {
            let i = touch.node;
            let mass = system.mass()[i];
            v[i] = match touch.velocity {
                None => (touch.position - before[i]) / dt,
                Some(asked) if leaves => self.tamed(mass, moment, i, asked, share),
                Some(asked) => asked,
            };
        }
        system.met(&Meeting {
            t,
            late: moment.lag(),
            before: (&self.was.0, &self.was.1),
            after: (x, v),
        });
        Ok(true)
    }

    /// How much of the speeds asked for the energy that went in can pay.
    ///
    /// What went in is the motion into the obstacle, less `cost`; all touched nodes share it.
    fn share(&self, mass: &[f64], moment: Moment, v: &[DVec2], cost: f64) -> f64 {
        let (mut spent, mut asked) = (-cost, 0.0);
        for touch in &self.touches {
            let i = touch.node;
            let (Some(away), Some(velocity)) = (self.shift[i].try_normalize(), touch.velocity)
            else {
                continue;
            };
            let late = v[i].dot(away);
            // the force before the move brings velocity and position to the same time
            let push = self.force[i] + self.product[i];
            let full = late + moment.lag() * push.dot(away) / mass[i];
            let into = if full < 0.0 {
                late.abs().min(full.abs())
            } else {
                0.0
            };
            spent += 0.5 * mass[i] * into * into;
            asked += 0.5 * mass[i] * velocity.dot(away).powi(2);
        }
        if asked <= 0.0 {
            1.0
        } else {
            (spent / asked).clamp(0.0, 1.0).sqrt()
        }
    }

    /// The velocity asked for, with `share` of its part away from the obstacle.
    fn tamed(&self, mass: f64, moment: Moment, i: usize, asked: DVec2, share: f64) -> DVec2 {
        let Some(away) = self.shift[i].try_normalize() else {
            return asked;
        };
        let out = asked.dot(away);
        if out <= 0.0 || mass <= 0.0 {
            return asked;
        }
        let mut most = share * out;
        if moment.pace == Pace::Late {
            most = (most - moment.lag() * self.force[i].dot(away) / mass).max(0.0);
        }
        asked + away * (out.min(most) - out)
    }
}

/// Kinetic energy, ½ Σ μ |v|².
#[must_use]
pub fn kinetic_energy(system: &dyn System, state: &State) -> f64 {
    0.5 * system
        .mass()
        .iter()
        .zip(&state.v)
        .map(|(m, v)| m * v.length_squared())
        .sum::<f64>()
}

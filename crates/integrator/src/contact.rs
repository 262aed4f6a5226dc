//! Obstacles met at the end of a step.
//!
//! A system says which nodes met an obstacle, where they are put, and by which law they leave. The
//! velocities are turned here, in four steps:
//!
//! 1. The touched nodes are put where they belong. In an implicit step the others follow: the step is
//!    solved again with the touched ones where they must be, or else a stiff body would be torn at
//!    every contact.
//! 2. The law gives the speed across. Putting a node elsewhere costs or yields energy; a speed away from
//!    the obstacle is lowered by what the move has yielded, so that no more comes out than went in.
//! 3. The impulse across is the change of that speed, with what the followers received. Friction takes
//!    at most its share of this impulse along the obstacle.
//! 4. Nothing else changes: the part of the velocity along a smooth obstacle is the one that the forces
//!    of the whole step gave it.
//!
//! A scheme that makes its step in two halves turns the velocity between them and supports the touched
//! nodes after the second, by the same law. Contacts are met at the ends of steps only.

mod friction;

use glam::DVec2;

use crate::impulse::{Moment, Pace, friction};
use crate::solver::Solver;
use crate::{Fault, Meeting, Response, State, System, Touch, stepper};

/// A node that comes no faster than its forces make it in so many steps lies on its obstacle.
const RESTING: f64 = 2.0;

/// Scratch space for contacts.
#[derive(Debug, Clone)]
pub(crate) struct Contacts {
    /// The touches of the last step.
    touches: Vec<Touch>,
    /// The speed across that each of them leaves its node with.
    speeds: Vec<f64>,
    /// How far the touched nodes were moved, and those that followed.
    shift: Vec<DVec2>,
    /// Places and velocities before the touches.
    was: (Vec<DVec2>, Vec<DVec2>),
    /// Velocities after them, and what the second half of a step added to them.
    turned: Vec<DVec2>,
    support: Vec<DVec2>,
    force: Vec<DVec2>,
    product: Vec<DVec2>,
    /// What followers received from each touch, as a change of its node's velocity.
    passed_on: Vec<f64>,
}

impl Contacts {
    pub(crate) fn new(n: usize) -> Self {
        let zeros = || vec![DVec2::ZERO; n];
        Self {
            touches: Vec::with_capacity(n),
            speeds: Vec::with_capacity(n),
            shift: zeros(),
            was: (zeros(), zeros()),
            turned: Vec::new(),
            support: Vec::new(),
            force: zeros(),
            product: zeros(),
            passed_on: Vec::new(),
        }
    }

    /// The touches of the last step.
    pub(crate) fn touches(&self) -> &[Touch] {
        &self.touches
    }

    /// Places and velocities before the touches of the last step.
    pub(crate) fn before(&self) -> (&[DVec2], &[DVec2]) {
        (&self.was.0, &self.was.1)
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
        let touched = self.answer(system, moment, before, x, v, solver)?;
        if touched {
            self.support.clear();
            system.met(&Meeting {
                t: moment.t,
                late: moment.lag(),
                before: (&self.was.0, &self.was.1),
                after: (x, v),
                support: &[],
            });
        }
        Ok(touched)
    }

    /// Meet all obstacles between the two halves of a step; [`Contacts::support`] must follow.
    pub(crate) fn meet_halfway(
        &mut self,
        system: &mut dyn System,
        moment: Moment,
        before: &[DVec2],
        x: &mut [DVec2],
        v: &mut [DVec2],
    ) -> Result<bool, Fault> {
        let touched = self.answer(system, moment, before, x, v, None)?;
        if touched {
            self.turned.clear();
            self.turned.extend_from_slice(v);
        }
        Ok(touched)
    }

    /// Hold the touched nodes against the second half of the step's forces, which is in `v` now: across
    /// the obstacle they leave with the speed that the energy allowed, along it nothing is changed but by friction.
    pub(crate) fn support(
        &mut self,
        system: &mut dyn System,
        moment: Moment,
        x: &[DVec2],
        v: &mut [DVec2],
    ) {
        self.support.clear();
        self.support.resize(v.len(), DVec2::ZERO);
        for (touch, &speed) in self.touches.iter().zip(&self.speeds) {
            let i = touch.node;
            let more = speed - v[i].dot(touch.normal);
            let mut change = touch.normal * more;
            change += friction(touch, v[i], more);
            v[i] += change;
            self.support[i] += change;
        }
        system.met(&Meeting {
            t: moment.t,
            late: moment.lag(),
            before: (&self.was.0, &self.was.1),
            after: (x, &self.turned),
            support: &self.support,
        });
    }

    fn answer(
        &mut self,
        system: &mut dyn System,
        moment: Moment,
        before: &[DVec2],
        x: &mut [DVec2],
        v: &mut [DVec2],
        solver: Option<&mut Solver>,
    ) -> Result<bool, Fault> {
        let dt = moment.dt;
        if !self.find(system, dt, before, x, v) {
            return Ok(false);
        }
        self.was.0.copy_from_slice(x);
        self.was.1.copy_from_slice(v);
        self.shift.fill(DVec2::ZERO);
        for touch in &self.touches {
            self.shift[touch.node] = touch.position - x[touch.node];
        }
        // what the move costs: ΔU, and the motion of those that follow
        let mut cost = 0.0;
        self.passed_on.clear();
        let mut solver = solver;
        if let Some(solver) = &mut solver {
            solver.follow(&mut self.touches, &mut self.shift);
            self.pass_on(system, solver, dt);
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
        if self.ask(before, dt, v) {
            stepper::force(system, moment.t, x, v, &mut self.force)?;
            system
                .stiffness()
                .multiply_into(&self.shift, &mut self.product);
            // −F·δ − ½ δ·Aδ with F where they were put
            for (i, shift) in self.shift.iter().enumerate() {
                cost -= (self.force[i] + 0.5 * self.product[i]).dot(*shift);
            }
            self.tame(system.mass(), moment, v, cost);
        }
        for (touch, &speed) in self.touches.iter().zip(&self.speeds) {
            let i = touch.node;
            v[i] = if moment.pace == Pace::Late && touch.response == Response::Clamp {
                // as the report's program forms it, to the last digit
                (touch.position - before[i]) / dt
            } else {
                v[i] + touch.normal * (speed - v[i].dot(touch.normal))
            };
        }
        self.rub(system, moment, before, x, v, solver.as_deref());
        Ok(true)
    }

    /// Ask every law for the speed across; whether any node is to leave its obstacle.
    fn ask(&mut self, before: &[DVec2], dt: f64, v: &[DVec2]) -> bool {
        self.speeds.clear();
        let mut leaves = false;
        for touch in &self.touches {
            let i = touch.node;
            let speed = v[i].dot(touch.normal);
            self.speeds.push(match touch.response {
                Response::Clamp => (touch.position - before[i]).dot(touch.normal) / dt,
                Response::Impact { restitution, .. } => {
                    let away = if speed < 0.0 {
                        -restitution * speed
                    } else {
                        speed
                    };
                    leaves |= away > 0.0;
                    away
                }
                Response::Guide => 0.0,
            });
        }
        leaves
    }

    /// Lower the speeds away from obstacles to what the energy that went in can pay.
    ///
    /// What went in is the motion into the obstacle, less `cost`; all touched nodes share it.
    fn tame(&mut self, mass: &[f64], moment: Moment, v: &[DVec2], cost: f64) {
        let (mut spent, mut asked) = (-cost, 0.0);
        for (touch, &speed) in self.touches.iter().zip(&self.speeds) {
            let (i, away) = (touch.node, touch.normal);
            if !matches!(touch.response, Response::Impact { .. }) {
                continue;
            }
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
            asked += 0.5 * mass[i] * speed * speed;
        }
        let share = if asked <= 0.0 {
            1.0
        } else {
            (spent / asked).clamp(0.0, 1.0).sqrt()
        };
        for (touch, speed) in self.touches.iter().zip(&mut self.speeds) {
            let i = touch.node;
            if !matches!(touch.response, Response::Impact { .. }) || *speed <= 0.0 || mass[i] <= 0.0
            {
                continue;
            }
            let pressed = -self.force[i].dot(touch.normal) / mass[i] * moment.dt;
            let mut most = if -v[i].dot(touch.normal) < RESTING * pressed {
                0.0 // what lies on its obstacle falls onto it anew at every step, and does not bounce
            } else {
                share * *speed
            };
            if moment.pace == Pace::Late {
                let half = moment.lag() * self.force[i].dot(touch.normal) / mass[i];
                most = (most - half).max(0.0);
            }
            *speed = speed.min(most);
        }
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

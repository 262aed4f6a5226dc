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

use glam::DVec2;

use crate::solver::Solver;
use crate::{Fault, Meeting, Response, State, System, Touch, stepper};

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
            Pace::Together { .. } => 0.0,
            Pace::Catching | Pace::Late => 0.5 * self.dt,
        }
    }

    /// How far a node is moved in a step by a force that changes its velocity by 1.
    fn way(self) -> f64 {
        match self.pace {
            Pace::Together { way } => way * self.dt,
            Pace::Catching | Pace::Late => self.dt,
        }
    }
}

/// How velocities and positions of a scheme belong together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Pace {
    /// At the same time. A constant force that changes the velocity by Δv in a step has moved the node
    /// by `way · dt · Δv`: ½, or 1 in Euler's methods.
    Together { way: f64 },
    /// The velocity is half a step late, and receives the second half of the forces after the touch.
    Catching,
    /// The velocity is always half a step late.
    Late,
}

/// Scratch space for contacts.
#[derive(Debug)]
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
            let change = impulse(touch, v[i], more, more);
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
        if let Some(solver) = solver {
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
        for (k, (touch, &speed)) in self.touches.iter().zip(&self.speeds).enumerate() {
            let i = touch.node;
            if moment.pace == Pace::Late && touch.response == Response::Clamp {
                // as the report's program forms it, to the last digit
                v[i] = (touch.position - before[i]) / dt;
                continue;
            }
            let across = speed - v[i].dot(touch.normal);
            let pressed = across + self.passed_on.get(k).copied().unwrap_or(0.0);
            let change = impulse(touch, v[i], across, pressed);
            // friction acts during the step: what it slows is not carried as far
            let along = change - touch.normal * change.dot(touch.normal);
            v[i] += change;
            x[i] += moment.way() * along;
        }
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
            let mut most = share * *speed;
            if moment.pace == Pace::Late {
                let half = moment.lag() * self.force[i].dot(touch.normal) / mass[i];
                most = (most - half).max(0.0);
            }
            *speed = speed.min(most);
        }
    }

    /// Divide what the followers have received among the touches that pushed them.
    ///
    /// In an implicit step a touched node hands a part of its obstacle's impulse on to others within the
    /// step. Friction acts by the whole.
    fn pass_on(&mut self, system: &dyn System, solver: &Solver, dt: f64) {
        let rough = |touch: &Touch| matches!(touch.response, Response::Impact { friction, .. } if friction > 0.0);
        if !self.touches.iter().any(rough) {
            return;
        }
        let mut received = DVec2::ZERO;
        for (i, &shift) in self.shift.iter().enumerate() {
            if !solver.touches(i) {
                received += solver.inertia(system, i) * shift;
            }
        }
        solver
            .matrix()
            .multiply_into(&self.shift, &mut self.product);
        // nodes at one obstacle have one normal
        let mut pushes: Vec<(DVec2, f64)> = Vec::new();
        for touch in &self.touches {
            let push = self.product[touch.node].dot(touch.normal).max(0.0);
            match pushes
                .iter_mut()
                .find(|(normal, _)| *normal == touch.normal)
            {
                Some((_, sum)) => *sum += push,
                None => pushes.push((touch.normal, push)),
            }
        }
        for touch in &self.touches {
            let i = touch.node;
            let push = self.product[i].dot(touch.normal).max(0.0);
            let all = pushes.iter().find(|(normal, _)| *normal == touch.normal);
            let share = all.map_or(0.0, |(_, sum)| if *sum > 0.0 { push / sum } else { 0.0 });
            let inertia = solver.inertia(system, i);
            let passed = received.dot(touch.normal).max(0.0) * share;
            self.passed_on.push(if inertia > 0.0 {
                passed / (inertia * dt)
            } else {
                0.0
            });
        }
    }
}

/// The change of a velocity: `across` along the normal, and the friction of an impulse of `pressed`.
fn impulse(touch: &Touch, v: DVec2, across: f64, pressed: f64) -> DVec2 {
    let mut change = touch.normal * across;
    if let Response::Impact { friction, .. } = touch.response
        && friction > 0.0
        && pressed > 0.0
    {
        let along = v - touch.normal * v.dot(touch.normal);
        let slip = along.length();
        if slip > 0.0 {
            change -= along * ((friction * pressed).min(slip) / slip);
        }
    }
    change
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

#[cfg(test)]
mod tests {
    use super::*;

    fn touch(restitution: f64, friction: f64) -> Touch {
        Touch {
            node: 0,
            position: DVec2::ZERO,
            normal: DVec2::X,
            response: Response::Impact {
                restitution,
                friction,
            },
        }
    }

    #[test]
    fn friction_takes_its_share_of_the_impulse_across() {
        // from −4 to 2 across: an impulse of 6, friction at most 0.6 of it, 3.0 − 0.6
        let v = DVec2::new(-4.0, 3.0);
        let after = v + impulse(&touch(0.5, 0.1), v, 6.0, 6.0);
        assert!((after - DVec2::new(2.0, 2.4)).length() < 1e-14);
    }

    #[test]
    fn friction_counts_the_impulse_that_was_given_and_not_the_one_asked_for() {
        // the speed away was lowered to 1: the impulse is 5
        let v = DVec2::new(-4.0, 3.0);
        let after = v + impulse(&touch(0.5, 0.1), v, 5.0, 5.0);
        assert!((after - DVec2::new(1.0, 2.5)).length() < 1e-14);
    }

    #[test]
    fn strong_friction_stops_the_slip_and_does_not_turn_it_round() {
        let v = DVec2::new(-4.0, 3.0);
        let after = v + impulse(&touch(0.0, 5.0), v, 4.0, 4.0);
        assert!(after.length() < 1e-15);
    }

    #[test]
    fn a_node_that_leaves_already_keeps_its_velocity() {
        let v = DVec2::new(4.0, 3.0);
        assert_eq!(impulse(&touch(0.5, 0.1), v, 0.0, 0.0), DVec2::ZERO);
    }
}

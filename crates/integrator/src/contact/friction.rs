//! Friction of all touches of a step, by the impulses that were given across.

use glam::DVec2;

use super::Contacts;
use crate::impulse::{Moment, friction};
use crate::solver::Solver;
use crate::{Response, System, Touch};

impl Contacts {
    /// Friction, by the impulses across that have been given.
    ///
    /// It acts during the step and shortens the way along the obstacle; in an implicit step as a
    /// force in the step's own
    /// equation, so that a stiff body is not torn. It takes no more than the way and the speed there are: a force
    /// against the way of its node takes energy, whatever the scheme.
    pub(super) fn rub(
        &mut self,
        system: &dyn System,
        moment: Moment,
        before: &[DVec2],
        x: &mut [DVec2],
        v: &mut [DVec2],
        solver: Option<&Solver>,
    ) {
        let way = moment.way();
        self.product.fill(DVec2::ZERO);
        let mut any = false;
        for (k, touch) in self.touches.iter().enumerate() {
            let i = touch.node;
            let across = (v[i] - self.was.1[i]).dot(touch.normal);
            let pressed = across + self.passed_on.get(k).copied().unwrap_or(0.0);
            let mut change = friction(touch, v[i], pressed);
            let gone = (x[i] - before[i]).dot(change.normalize_or_zero());
            if way * change.length() > -gone {
                change = change.normalize_or_zero() * (-gone / way).max(0.0);
            }
            if change == DVec2::ZERO {
                continue;
            }
            any = true;
            match solver {
                None => {
                    v[i] += change;
                    x[i] += way * change;
                }
                Some(solver) => self.product[i] += solver.inertia(system, i) * way * change,
            }
        }
        if let Some(solver) = solver.filter(|_| any) {
            solver.solve(&mut self.product);
            for (i, &moved) in self.product.iter().enumerate() {
                x[i] += moved;
                v[i] += moved / way;
            }
        }
    }

    /// Divide what the followers have received among the touches that pushed them.
    ///
    /// In an implicit step a touched node hands a part of its obstacle's impulse on to others within the
    /// step. Friction acts by the whole.
    pub(super) fn pass_on(&mut self, system: &dyn System, solver: &Solver, dt: f64) {
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

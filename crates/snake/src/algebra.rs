//! What one step of a scheme does to the energy, term by term, from the formulas of the scheme.
//!
//! With F = F^c + f + d the force on a node (F^c with a potential, f without, d that of dampers), w the velocity that
//! carried it over the step, U the potential of F^c and sums over the curve left out:
//!
//! ```text
//! report    μ (w⁺ − w) = dt (F − γ w),   x⁺ = x + dt w⁺
//!   Δ½μw²  = ½ dt (F − γ w)·(w⁺ + w)
//!   scheme = −ΔS,   S = ½ dt F^c·w
//!
//! leapfrog  μ (w − v) = ½ dt (F − γ v),   x⁺ = x + dt w,   μ (v⁺ − w) = ½ dt (F⁺ − γ v⁺)
//!   Δ½μv²  = ¼ dt [(F − γ v)·(w + v) + (F⁺ − γ v⁺)·(v⁺ + w)]
//!   scheme = −ΔS,   S = −⅛ dt²/μ F^c·(F − γ v)
//! ```
//!
//! where `scheme` is Δ½μv² of F^c alone, less its work by the trapezoidal rule, `½ (F^c + F^c⁺)·(x⁺ − x)`. S is a number
//! of the state: what the energy lacks for velocities half a step late, and what a leapfrog's swings by. The trapezoidal
//! rule is −ΔU where F^c is linear; elsewhere Simpson's rule on the same chord is nearer, from where a wall's spring sets in, and the
//! difference, `⅓ (F^c + F^c⁺ − 2 F^c in the middle)·(x⁺ − x)`, is the scheme's as well. Nothing here asks for an energy, except where a
//! contact puts nodes elsewhere: that takes what energy and S were before, less what they are after.

use elastic::Material;
use glam::DVec2;
use integrator::{Fault, Scheme, Start, State, System};

use crate::account::Touched;
use crate::factors::Factors;
use crate::ledger::Booking;
use crate::{Parameter, Snake, Wall};

/// Which formulas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rule {
    Report,
    Leapfrog,
}

/// A scheme whose formulas are known, and what it has used at the last state.
#[derive(Debug, Clone)]
pub(crate) struct Algebra {
    rule: Rule,
    /// Whether the next step begins with another velocity than the state's: in the report's scheme, started to second
    /// order, with the one half a step ago; in leapfrog, started to first order, as if the state's were that one.
    catches_up: bool,
    last: Seen,
}

/// What acts on every node at one state.
#[derive(Debug, Clone, Default)]
struct Seen {
    /// F^c.
    pull: Vec<DVec2>,
    /// What a frame without reaction adds to it.
    frame: Vec<DVec2>,
    /// d.
    drag: Vec<DVec2>,
    /// f, one by one, in the order of the bookings.
    loads: Vec<Vec<DVec2>>,
    /// All of them together.
    total: Vec<DVec2>,
    factors: Factors,
    mass: Vec<f64>,
    damping: Vec<f64>,
}

/// What a step has done. M L³ T⁻².
#[derive(Debug, Default)]
pub(crate) struct Booked {
    pub(crate) damping: f64,
    pub(crate) frame: f64,
    pub(crate) scheme: f64,
    pub(crate) parameters: f64,
    /// Of the forces without a potential, in the order of the bookings.
    pub(crate) works: Vec<f64>,
    pub(crate) contact: f64,
}

fn dot(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

impl Seen {
    /// Ask for everything at `x`, dampers and forces with the velocities `v` that the scheme hands them.
    fn at(
        snake: &mut Snake,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        bookings: &[Booking],
    ) -> Result<Self, Fault> {
        let n = x.len();
        let zeros = || vec![DVec2::ZERO; n];
        let mut seen = Self {
            pull: zeros(),
            frame: zeros(),
            drag: zeros(),
            ..Self::default()
        };
        seen.factors = snake.factors_at(t, x);
        (seen.mass, seen.damping) = snake.densities_under(&seen.factors);
        snake.conservative_force(&seen.factors, t, x, bookings, &mut seen.pull)?;
        if !snake.body().frame.reaction {
            snake.frame_force(&seen.factors, x, &mut seen.frame);
        }
        snake.damper_force(x, v, &mut seen.drag);
        for booking in bookings {
            let mut load = zeros();
            let (forces, curve) = snake.forces(t, x, v);
            if let Some(acting) = forces.get_mut(booking.index) {
                acting.add(&curve, &mut load)?;
            }
            snake.free(&mut load);
            seen.loads.push(load);
        }
        seen.total.clone_from(&seen.pull);
        let parts = [&seen.frame, &seen.drag].into_iter().chain(&seen.loads);
        for part in parts {
            for (total, part) in seen.total.iter_mut().zip(part) {
                *total += *part;
            }
        }
        // a line takes what is across it, and does no work
        for k in 0..snake.rails.len() {
            let node = snake.rails[k].0;
            seen.total[node] = snake.along_rail(node, x[node], seen.total[node]);
        }
        Ok(seen)
    }

    /// F − γ v.
    fn net(&self, i: usize, v: DVec2) -> DVec2 {
        self.total[i] - self.damping[i] * v
    }
}

impl Algebra {
    /// None where the formulas are not known.
    pub(crate) fn of(scheme: Scheme, start: Start) -> Option<Self> {
        let rule = match scheme {
            Scheme::Report => Rule::Report,
            Scheme::Leapfrog => Rule::Leapfrog,
            _ => return None,
        };
        Some(Self {
            rule,
            catches_up: (rule == Rule::Report) == (start == Start::SecondOrder),
            last: Seen::default(),
        })
    }

    /// Begin, or begin again, at a state.
    pub(crate) fn begin(
        &mut self,
        snake: &mut Snake,
        state: &State,
        bookings: &[Booking],
    ) -> Result<(), Fault> {
        self.last = Seen::at(snake, state.t, &state.x, &state.v, bookings)?;
        Ok(())
    }

    /// The same where the scheme goes on.
    pub(crate) fn go_on(
        &mut self,
        snake: &mut Snake,
        state: &State,
        bookings: &[Booking],
    ) -> Result<(), Fault> {
        self.catches_up = false;
        self.begin(snake, state, bookings)
    }

    /// The same where the scheme begins again as well.
    pub(crate) fn resume(&mut self) {
        self.catches_up = self.rule == Rule::Report;
    }

    /// The same where the scheme goes on from velocities that someone else has changed.
    pub(crate) fn kicked(&mut self) {
        self.catches_up &= self.rule == Rule::Report;
    }

    /// What the step from `from` to `to` has done.
    pub(crate) fn step(
        &mut self,
        snake: &mut Snake,
        from: &State,
        to: &State,
        touched: Option<Touched>,
        bookings: &[Booking],
    ) -> Result<Booked, Fault> {
        let (h, dt) = (snake.body().spacing, to.t - from.t);
        let held = snake.held().to_vec();
        let n = to.len();
        let mut booked = Booked::default();
        // where the step led before anything was touched, and what carried it there
        let x = touched.as_ref().map_or(&to.x, |touched| &touched.before.0);
        let carried: Vec<DVec2> = (0..n)
            .map(|i| match &touched {
                _ if held[i] => DVec2::ZERO,
                Some(touched) => touched.before.1[i],
                None => (x[i] - from.x[i]) / dt,
            })
            .collect();
        let here = Seen::at(snake, to.t, x, &carried, bookings)?;
        if self.rule == Rule::Report {
            // its damping may have been chosen anew when the step began, after the one before was booked
            self.last.damping = snake.densities_under(&self.last.factors).1;
        }
        let last = &self.last;
        let mut v = from.v.clone();
        for i in (0..n).filter(|&i| self.catches_up && !held[i]) {
            let kick = 0.5 * dt / last.mass[i];
            v[i] = match self.rule {
                Rule::Report => v[i] - kick * last.net(i, v[i]),
                Rule::Leapfrog => (v[i] + kick * last.total[i]) / (1.0 + kick * last.damping[i]),
            };
            let lost = from.v[i].length_squared() - v[i].length_squared();
            booked.scheme -= 0.5 * h * last.mass[i] * lost;
        }
        self.catches_up = false;
        // velocities at the end of the step, before anything was touched
        let full: Vec<DVec2> = match (self.rule, &touched) {
            (Rule::Report, _) => carried.clone(),
            (Rule::Leapfrog, None) => to.v.clone(),
            (Rule::Leapfrog, Some(_)) => (0..n)
                .map(|i| {
                    let kick = 0.5 * dt / here.mass[i];
                    let settle = 1.0 + kick * here.damping[i];
                    let whole = (carried[i] + kick * here.total[i]) / settle;
                    if held[i] { DVec2::ZERO } else { whole }
                })
                .collect(),
        };
        // how long each force works along each sum of velocities: those at the start, those at the end
        let (early, late): (Vec<DVec2>, Vec<DVec2>) = (0..n)
            .map(|i| match self.rule {
                Rule::Report => (0.5 * dt * (carried[i] + v[i]), DVec2::ZERO),
                Rule::Leapfrog => (
                    0.25 * dt * (carried[i] + v[i]),
                    0.25 * dt * (full[i] + carried[i]),
                ),
            })
            .unzip();
        let work =
            |first: &[DVec2], second: &[DVec2]| h * (dot(first, &early) + dot(second, &late));
        booked.damping = -work(&last.drag, &here.drag);
        for i in (0..n).filter(|&i| !held[i]) {
            booked.damping += h * last.damping[i] * v[i].dot(early[i]);
            booked.damping += h * here.damping[i] * full[i].dot(late[i]);
        }
        let store = self.store(last, &v, &held, dt) - self.store(&here, &full, &held, dt);
        booked.scheme += h * store;
        booked.scheme += h * self.bend(snake, from, (to.t, x), &here, bookings)?;
        booked.frame = work(&last.frame, &here.frame);
        let half = |a: &[DVec2], b: &[DVec2]| -> Vec<DVec2> {
            a.iter().zip(b).map(|(a, b)| 0.5 * (*a + *b)).collect()
        };
        let (middle_x, middle_v) = (half(&from.x, x), half(&v, &full));
        let way = [(&from.x[..], &v[..]), (&middle_x, &middle_v), (x, &full)];
        let factors = (&last.factors, &here.factors);
        booked.parameters = snake.put_in(factors, way, Some(&carried));
        let pairs = last.loads.iter().zip(&here.loads);
        booked.works = pairs.map(|(first, second)| work(first, second)).collect();
        if let Some(touched) = &touched {
            let before = snake.mechanical(to.t, x, &full);
            let seen = match self.rule {
                Rule::Report => &to.v,
                Rule::Leapfrog => &touched.after,
            };
            let after = Seen::at(snake, to.t, &to.x, seen, bookings)?;
            // where the forces and the impulses alone lead: a force that the scheme leaves out shows
            let led: Vec<DVec2> = match self.rule {
                Rule::Report => to.v.clone(),
                Rule::Leapfrog => (0..n)
                    .map(|i| {
                        let kick = 0.5 * dt / after.mass[i];
                        let whole =
                            (seen[i] + kick * after.total[i]) / (1.0 + kick * after.damping[i]);
                        let support = touched.support.get(i).copied().unwrap_or_default();
                        if held[i] {
                            DVec2::ZERO
                        } else {
                            whole + support
                        }
                    })
                    .collect(),
            };
            booked.contact = before - snake.mechanical(to.t, &to.x, &led);
            // what the scheme holds back is the contact's to take as well
            let moved = self.store(&here, &full, &held, dt) - self.store(&after, &led, &held, dt);
            booked.contact += h * moved;
            booked.scheme += h * moved;
            self.last = after;
        } else {
            self.last = here;
        }
        Ok(booked)
    }

    /// What the energy lacks at a state because of the scheme: what `scheme` above is the change of, with its sign turned.
    fn store(&self, seen: &Seen, v: &[DVec2], held: &[bool], dt: f64) -> f64 {
        let each = (0..v.len()).filter(|&i| !held[i]).map(|i| match self.rule {
            Rule::Report => 0.5 * dt * seen.pull[i].dot(v[i]),
            Rule::Leapfrog => -0.125 * dt * dt / seen.mass[i] * seen.pull[i].dot(seen.net(i, v[i])),
        });
        each.sum()
    }

    /// Work of F^c over the step by the trapezoidal rule, less that by Simpson's; of a wall's spring that sets in on the way less that
    /// from where it does.
    fn bend(
        &self,
        snake: &mut Snake,
        from: &State,
        (t, x): (f64, &[DVec2]),
        here: &Seen,
        bookings: &[Booking],
    ) -> Result<f64, Fault> {
        let middle: Vec<DVec2> = x
            .iter()
            .zip(&from.x)
            .map(|(a, b)| 0.5 * (*a + *b))
            .collect();
        let mut force = vec![DVec2::ZERO; x.len()];
        let now = 0.5 * (from.t + t);
        let factors = snake.halfway(now, &self.last.factors, &here.factors);
        snake.conservative_force(&factors, now, &middle, bookings, &mut force)?;
        let mut bend = 0.0;
        for i in 0..x.len() {
            let ends = self.last.pull[i] + here.pull[i];
            bend += (ends - 2.0 * force[i]).dot(x[i] - from.x[i]) / 3.0;
        }
        Ok(bend + snake.set_in(&from.x, x))
    }
}

impl Snake {
    /// Work of walls that push on a part of the way only: what Simpson's rule makes of it, less what it is.
    fn set_in(&self, from: &[DVec2], to: &[DVec2]) -> f64 {
        let mut sum = 0.0;
        for wall in self.world.walls.iter().filter(|wall| wall.is_spring()) {
            for (i, (&a, &b)) in from.iter().zip(to).enumerate() {
                let (begin, end) = (wall.distance(a), wall.distance(b));
                if self.held[i] || (begin < 0.0) == (end < 0.0) {
                    continue;
                }
                let push = |x: DVec2| wall.force(x, DVec2::ZERO).dot(b - a);
                let simpson = (push(a) + 4.0 * push(0.5 * (a + b)) + push(b)) / 6.0;
                // one of both ends is inside, and the force falls straight to 0 at the wall
                let inside = begin.min(end) / (begin.min(end) - begin.max(end));
                sum += simpson - 0.5 * inside * (push(a) + push(b));
            }
        }
        sum
    }

    /// Nodes that may not move feel nothing.
    fn free(&self, force: &mut [DVec2]) {
        for (force, _) in force.iter_mut().zip(&self.held).filter(|(_, held)| **held) {
            *force = DVec2::ZERO;
        }
    }

    /// Mass and damping of every node under these factors.
    fn densities_under(&self, factors: &Factors) -> (Vec<f64>, Vec<f64>) {
        let n = self.body.len();
        let mass = factors.times(Parameter::Mass, &self.body.mass).to_vec(n);
        (
            mass,
            factors
                .times(Parameter::Damping, &self.body.damping)
                .to_vec(n),
        )
    }

    /// −K e of every node under these factors, held or not; and its sum.
    fn raw_elastic(&mut self, factors: &Factors, x: &[DVec2], force: &mut [DVec2]) -> DVec2 {
        let rotation = self.rotation_under(factors, x);
        let mut e = std::mem::take(&mut self.deformation);
        self.deformation_from(x, rotation, &mut e);
        let own: Material;
        let material = if factors.same(&self.factors) {
            &self.material
        } else {
            own = factors.material(&self.body.material);
            &own
        };
        let body = &self.body;
        elastic::elastic_force(&e, body.topology, material, body.spacing, force);
        self.deformation = e;
        force.iter().copied().sum()
    }

    /// Everything that has a potential: −Pᵀ K e, forces of the world but those booked, springs of walls. Overwrites `force`.
    pub(crate) fn conservative_force(
        &mut self,
        factors: &Factors,
        t: f64,
        x: &[DVec2],
        bookings: &[Booking],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        let total = self.raw_elastic(factors, x, force);
        for (force, &weight) in force.iter_mut().zip(&self.weights) {
            *force -= total * weight;
        }
        let still = vec![DVec2::ZERO; x.len()];
        let (forces, curve) = self.forces(t, x, &still);
        for (index, acting) in forces.iter_mut().enumerate() {
            if bookings.iter().all(|booking| booking.index != index) {
                acting.add(&curve, force)?;
            }
        }
        for wall in self.world.walls.iter().filter(|wall| wall.is_spring()) {
            for (force, &x) in force.iter_mut().zip(x) {
                *force += wall.force(x, DVec2::ZERO);
            }
        }
        self.free(force);
        Ok(())
    }

    /// What a frame without reaction adds to −Pᵀ K e, so that −K e is felt. Overwrites `force`.
    pub(crate) fn frame_force(&mut self, factors: &Factors, x: &[DVec2], force: &mut [DVec2]) {
        let total = self.raw_elastic(factors, x, force);
        for (force, &weight) in force.iter_mut().zip(&self.weights) {
            *force = total * weight;
        }
        self.free(force);
    }

    /// Internal damping, and the dampers of penalty walls. Adds to `force`.
    fn damper_force(&mut self, x: &[DVec2], v: &[DVec2], force: &mut [DVec2]) {
        self.add_inner(x, v, force);
        let springs = self.world.walls.iter().filter(|wall| Wall::is_spring(wall));
        for wall in springs {
            for ((force, &x), &v) in force.iter_mut().zip(x).zip(v) {
                *force += wall.force(x, v) - wall.force(x, DVec2::ZERO);
            }
        }
        self.free(force);
    }
}

//! What mass-spring and position-based methods make of a scene: particles, springs, hinges, gas, walls.

use sandbox::prelude::*;
use scene::Scene;
use snake::{Contact, Gravity, Plastic, Pressure, WallLaw};
use std::ops::Range;

/// A spring between two particles.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spring {
    pub ends: [usize; 2],
    pub rest: f64,
    pub stiffness: f64,
}

/// A spring of the turning angle at the middle one of three particles.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hinge {
    pub nodes: [usize; 3],
    pub rest: f64,
    pub stiffness: f64,
}

/// One curve among the particles.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    pub nodes: Range<usize>,
    pub closed: bool,
    /// Its gas: pressure times area.
    pub gas: Option<f64>,
    /// Length of curve that a particle stands for.
    pub length: f64,
}

/// A half plane that may not be entered.
#[derive(Debug, Clone, Copy)]
pub(super) struct Floor {
    pub point: DVec2,
    pub normal: DVec2,
    pub stiffness: f64,
    pub damping: f64,
}

/// Particles with everything that acts on them.
#[derive(Debug, Clone)]
pub(super) struct Model {
    pub x: Vec<DVec2>,
    pub v: Vec<DVec2>,
    /// Inverse masses; 0 for one that is pinned.
    pub light: Vec<f64>,
    pub mass: Vec<f64>,
    /// Share of the velocity that a medium takes in a unit of time.
    pub drag: f64,
    pub gravity: DVec2,
    pub curves: Vec<Curve>,
    pub springs: Vec<Spring>,
    pub hinges: Vec<Hinge>,
    pub floors: Vec<Floor>,
    pub contact: Option<Contact>,
    pub plastic: Option<Plastic>,
}

/// The turning angle from one edge to the next, and its slopes with the three places.
pub(super) fn turning(a: DVec2, b: DVec2, c: DVec2) -> (f64, [DVec2; 3]) {
    let (u, w) = (b - a, c - b);
    let angle = u.perp_dot(w).atan2(u.dot(w));
    let (first, last) = (u.perp() / u.length_squared(), w.perp() / w.length_squared());
    (angle, [first, -(first + last), last])
}

impl Model {
    /// The bodies of a scene, as springs of the same resistance.
    ///
    /// A spring and a hinge know stretch and bend alone. So that they resist as the snake does, a ring gets the same
    /// stiffness against being blown up and against being made oval, which is solved:
    ///
    /// ```text
    /// λₘ = ω₀ + ω₁ (m/R)² + ω₂ (m/R)⁴,   E A = λ₁ R²,   B = 2/9 R⁴ (λ₃ + 9 λ₁)/16
    /// ```
    ///
    /// and an open curve ω₁ and ω₂ themselves. A string held at both ends has springs without length at rest, as the snake's
    /// is: its tension is ω₁ wherever it lies.
    pub(super) fn of(scene: &Scene) -> Self {
        let mut model = Self {
            x: Vec::new(),
            v: Vec::new(),
            light: Vec::new(),
            mass: Vec::new(),
            drag: 0.0,
            gravity: DVec2::ZERO,
            curves: Vec::new(),
            springs: Vec::new(),
            hinges: Vec::new(),
            floors: Vec::new(),
            contact: None,
            plastic: None,
        };
        let mut all = vec![(&scene.snake, &scene.start)];
        if let Some(company) = &scene.company {
            all.extend(company.others.iter().map(|(snake, state)| (snake, state)));
            model.contact = company.contact;
            model.plastic = company.upkeep.plastic;
        }
        for (snake, start) in all {
            let body = snake.body();
            let (n, from, h) = (body.len(), model.x.len(), body.spacing);
            let closed = body.topology.is_closed();
            let held = body.topology.held(n);
            let weights = &body.material;
            let (w0, w1, w2) = (
                weights.tether.at(0),
                weights.tension.at(0),
                weights.rigidity.at(0),
            );
            let radius = h * real(n) / std::f64::consts::TAU;
            let mode = |m: f64| {
                let k = (m / radius).powi(2);
                w0 + w1 * k + w2 * k * k
            };
            let (stretch, bend) = if closed {
                let oval = (mode(3.0) + 9.0 * mode(1.0)) / 16.0;
                (
                    mode(1.0) * radius * radius,
                    2.0 / 9.0 * radius.powi(4) * oval,
                )
            } else {
                (w1, w2)
            };
            let taut = held[0] && held[n - 1];
            let edges = if closed { n } else { n - 1 };
            for i in 0..edges {
                let j = (i + 1) % n;
                let rest = if taut {
                    0.0
                } else {
                    body.rest[i].distance(body.rest[j])
                };
                model.springs.push(Spring {
                    ends: [from + i, from + j],
                    rest,
                    stiffness: stretch / h,
                });
            }
            if bend > 0.0 {
                let middles = if closed { 0..n } else { 1..n - 1 };
                for i in middles {
                    let [a, b] = [(i + n - 1) % n, (i + 1) % n];
                    let (rest, _) = turning(body.rest[a], body.rest[i], body.rest[b]);
                    model.hinges.push(Hinge {
                        nodes: [from + a, from + i, from + b],
                        rest,
                        stiffness: bend / h,
                    });
                }
            }
            let mut gas = None;
            for acting in &snake.world().forces {
                if let Some(gravity) = acting.downcast::<Gravity>() {
                    model.gravity = gravity.0;
                } else if let Some(pressure) = acting.downcast::<Pressure>() {
                    let area = elastic::signed_area(&start.x).abs();
                    gas = Some(pressure.at(area) * area);
                }
            }
            for i in 0..n {
                let mass = body.mass.at(i) * h;
                model.mass.push(mass);
                model.light.push(if held[i] { 0.0 } else { 1.0 / mass });
            }
            model.drag = body.damping.at(0) / body.mass.at(0);
            model.x.extend(&start.x);
            model.v.extend(&start.v);
            model.curves.push(Curve {
                nodes: from..from + n,
                closed,
                gas,
                length: h,
            });
        }
        for wall in &scene.snake.world().walls {
            if let WallLaw::Penalty { stiffness, damping } = wall.law() {
                model.floors.push(Floor {
                    point: wall.point(),
                    normal: wall.normal(),
                    stiffness,
                    damping,
                });
            }
        }
        model
    }

    /// The curve that a particle is on.
    pub(super) fn nodes(&self, curve: usize) -> &[DVec2] {
        &self.x[self.curves[curve].nodes.clone()]
    }

    /// Push of each curve's gas on its particles: `p N`, N the outward normal times length.
    pub(super) fn gas(&self, mut push: impl FnMut(usize, DVec2)) {
        for curve in &self.curves {
            let Some(gas) = curve.gas else { continue };
            let x = &self.x[curve.nodes.clone()];
            let area = elastic::signed_area(x);
            let pressure = gas / area.abs().max(1e-3) * area.signum();
            let n = x.len();
            for i in 0..n {
                let along = x[(i + 1) % n] - x[(i + n - 1) % n];
                let out = 0.5 * DVec2::new(along.y, -along.x);
                push(curve.nodes.start + i, pressure * out);
            }
        }
    }

    /// Lengths and angles at rest that give way: of a spring and of a hinge by the same share of what they were.
    pub(super) fn flow(&mut self, dt: f64) {
        let Some(plastic) = self.plastic else { return };
        let share = -(-plastic.rate * dt).exp_m1();
        let give = |rest: &mut f64, now: f64| {
            let off = now - *rest;
            let beyond = (off.abs() - plastic.yields_at * rest.abs()).max(0.0);
            *rest += share * beyond * off.signum();
        };
        for spring in &mut self.springs {
            let [a, b] = spring.ends;
            give(&mut spring.rest, self.x[a].distance(self.x[b]));
        }
        for hinge in &mut self.hinges {
            let [a, b, c] = hinge.nodes;
            give(&mut hinge.rest, turning(self.x[a], self.x[b], self.x[c]).0);
        }
    }

    /// Momentum of all.
    pub(super) fn momentum(&self) -> DVec2 {
        self.v.iter().zip(&self.mass).map(|(v, m)| *m * *v).sum()
    }

    /// Energy of motion.
    pub(super) fn kinetic(&self) -> f64 {
        let each = self.v.iter().zip(&self.mass);
        each.map(|(v, m)| 0.5 * m * v.length_squared()).sum()
    }

    /// Energy of springs, hinges, gas and gravity; walls and contacts left out.
    pub(super) fn potential(&self) -> f64 {
        let springs = self.springs.iter().map(|s| {
            let off = self.x[s.ends[0]].distance(self.x[s.ends[1]]) - s.rest;
            0.5 * s.stiffness * off * off
        });
        let hinges = self.hinges.iter().map(|h| {
            let [a, b, c] = h.nodes;
            let off = turning(self.x[a], self.x[b], self.x[c]).0 - h.rest;
            0.5 * h.stiffness * off * off
        });
        let heights = self.x.iter().zip(&self.mass);
        let gravity = heights.map(|(x, m)| -m * self.gravity.dot(*x));
        let gas = self.curves.iter().filter_map(|curve| {
            let area = elastic::signed_area(&self.x[curve.nodes.clone()]).abs();
            curve.gas.map(|gas| -gas * area.max(1e-3).ln())
        });
        springs.sum::<f64>() + hinges.sum::<f64>() + gravity.sum::<f64>() + gas.sum::<f64>()
    }

    /// A bound of the square of the highest frequency, contacts and walls counted in.
    pub(super) fn fastest(&self) -> f64 {
        let mut most = 0.0_f64;
        for curve in &self.curves {
            let mut own = 0.0_f64;
            for s in self
                .springs
                .iter()
                .filter(|s| curve.nodes.contains(&s.ends[0]))
            {
                own = own.max(4.0 * s.stiffness);
            }
            let mut bent = 0.0_f64;
            for h in self
                .hinges
                .iter()
                .filter(|h| curve.nodes.contains(&h.nodes[1]))
            {
                bent = bent.max(16.0 * h.stiffness / (curve.length * curve.length));
            }
            let wall: f64 = self.floors.iter().map(|f| f.stiffness * curve.length).sum();
            let touch = self
                .contact
                .map_or(0.0, |c| 4.0 * c.stiffness * curve.length);
            let lightest = self.mass[curve.nodes.clone()]
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min);
            most = most.max((own + bent + wall + touch) / lightest);
        }
        most
    }
}

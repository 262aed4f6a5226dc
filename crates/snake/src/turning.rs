//! The rotating body frame of report §5.2: three coupled equations for center, angle and deformation.
//!
//! Long because the three equations, their inertial forces and what is booked of them share one derivation.

use std::fmt;
use std::str::FromStr;

use banded::{Band, Operator};
use elastic::Bound;
use glam::DVec2;
use integrator::{Fault, State, System};

use crate::turn::{pull, rotation};
use crate::{Snake, SnakeError, Turn, WallLaw};

/// An inertial force that nodes feel in a frame that turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Term {
    /// −μ ω × (ω × q): away from the center.
    Centrifugal,
    /// −2 μ ω × ė: square to the motion in the frame.
    Coriolis,
    /// −μ ω̇ × q: against the turn that speeds up, Euler's force.
    Transverse,
}

impl Term {
    /// All three.
    pub const ALL: &[Self] = &[Self::Centrifugal, Self::Coriolis, Self::Transverse];

    /// Its name in texts.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Centrifugal => "centrifugal",
            Self::Coriolis => "coriolis",
            Self::Transverse => "transverse",
        }
    }
}

impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Term {
    type Err = SnakeError;

    fn from_str(text: &str) -> Result<Self, SnakeError> {
        let found = Self::ALL.iter().find(|term| term.name() == text);
        found.copied().ok_or_else(|| SnakeError::UnknownName {
            what: "term of a turning frame",
            name: text.to_owned(),
            known: "centrifugal, coriolis, transverse",
        })
    }
}

/// A snake seen from a frame that turns with it (report Eq. 5.2 to 5.4).
///
/// ```text
/// m c̈ + ∫ γ v̇ = ∫ f
/// d/dt (I ω + ∫ μ q × ė) + ∫ γ q × v̇ = ∫ q × f                 I = ∫ μ |q|²   (D74)
/// μ ë + μ c̈ + μ ω × (ω × q) + 2 μ ω × ė + μ ω̇ × q + γ v̇ + K e = f,   q = r + e
/// ```
///
/// As a [`System`] it has two nodes more than the snake: the `q` in body axes, then `c`, then `(θ, 0)`, so
/// that any scheme with mass moves all of it. Their velocities are `ė`, `ċ` and `(ω, 0)`; place in space is
/// `c + R(θ) q`.
///
/// The moment of the third equation is the second but for the elastic torque `Σ q × K e = Σ r × K e`. So
/// together they say that this torque is zero, which is where the frame points: the angle of [`Turn::Fit`].
/// Differentiated twice that gives ω̇; a term that pulls back an angle that is off keeps the errors of the
/// steps from adding up. Without the transverse force ω̇ follows from the second equation as it stands; without
/// the Coriolis force the second equation does not hold, and angular momentum is lost.
///
/// All inertial forces are explicit and depend on velocities: Runge and Kutta's scheme and those of higher
/// order keep their order, leapfrog and Newmark's method are of order 1.
#[derive(Debug, Clone)]
pub struct Turning {
    snake: Snake,
    terms: [bool; 3],
    mass: Vec<f64>,
    damping: Vec<f64>,
    held: Vec<bool>,
    stiffness: Operator,
    /// K r without its sum.
    pull: Vec<DVec2>,
    /// The rate at which an angle that is off is pulled back: that of the shape swinging about its own.
    rate: f64,
    space: State,
    force: Vec<DVec2>,
    elastic: Vec<DVec2>,
}

impl Turning {
    /// That snake in a frame that turns; what its own frame says of turning is passed over.
    ///
    /// # Errors
    ///
    /// Refused: nodes that are held, walls other than penalty walls, schedules, maps, damping that is chosen
    /// again and again, a frame without reaction, a node without mass, a body without elasticity, which
    /// has no shape to turn.
    pub fn new(snake: &Snake) -> Result<Self, SnakeError> {
        let refuse = |needed| Err(SnakeError::NotInTurningFrame { needed });
        let n = snake.len();
        if snake.held().contains(&true) {
            return refuse("every node free to move");
        }
        let hard = |wall: &crate::Wall| !matches!(wall.law(), WallLaw::Penalty { .. });
        if snake.world().walls.iter().any(hard) {
            return refuse("walls that are penalty walls");
        }
        let body = snake.body();
        if !(body.schedules.is_empty() && body.maps.is_empty()) || snake.renewal.is_some() {
            return refuse("parameters that stay the same");
        }
        if !snake.body().frame.reaction {
            return refuse("the reaction of the frame");
        }
        let above = Bound::Above(0.0);
        snake.body().mass.validate("mass", n, above)?;
        let mut body = snake.body().clone();
        body.frame.turn = Turn::None;
        let snake = Snake::new(body, snake.world().clone())?;
        let body = snake.body();
        let (pull, _) = pull(body, &body.material, &snake.weights);
        let (mut swing, mut inertia) = (0.0, 0.0);
        for (i, (k, r)) in pull.iter().zip(&body.rest).enumerate() {
            swing += k.dot(*r);
            inertia += snake.mass[i] * r.length_squared();
        }
        if swing <= 0.0 {
            return refuse("some elasticity");
        }
        let sum = |values: &[f64]| values.iter().sum::<f64>();
        let with = |values: &[f64], last| [values, &[sum(values), last]].concat();
        Ok(Self {
            terms: [true; 3],
            mass: with(&snake.mass, 1.0),
            damping: with(&snake.damping, 0.0),
            held: vec![false; n + 2],
            stiffness: stiffness(&snake)?,
            pull,
            rate: (swing / inertia).sqrt(),
            space: State::at_rest(vec![DVec2::ZERO; n]),
            force: vec![DVec2::ZERO; n],
            elastic: vec![DVec2::ZERO; n + 2],
            snake,
        })
    }

    /// The same without one of the inertial forces.
    #[must_use]
    pub fn without(mut self, term: Term) -> Self {
        self.terms[term as usize] = false;
        self
    }

    /// Whether an inertial force is left out.
    pub(crate) fn lacks_any(&self) -> bool {
        self.terms.contains(&false)
    }

    /// What the absence of inertial forces does to the nodes' energy in space at a state, per unit of time.
    ///
    /// A force that is left out of the equation of the frame acts in space, with its sign turned:
    /// without the Coriolis force
    /// it is `2 μ ω × ė`. Without the transverse force the frame no longer points where the shape
    /// fits best, and what the elastic force
    /// of the frame does beyond that of the best fit, whose energy is told, counts as well.
    ///
    /// # Errors
    ///
    /// The fault of a force that has no value at a node.
    pub(crate) fn power_of_absence(&mut self, state: &State) -> Result<f64, Fault> {
        let (n, x, v) = (self.snake.len(), &state.x, &state.v);
        let mut force = vec![DVec2::ZERO; n + 2];
        self.external(state.t, x, v, &mut force)?;
        let (omega, gain) = (v[n + 1].x, force[n + 1].x);
        let turn = DVec2::from_angle(x[n + 1].x);
        let drift = DVec2::new(turn.x, -turn.y).rotate(v[n]);
        let [centrifugal, coriolis, transverse] =
            self.terms.map(|there| if there { 0.0 } else { 1.0 });
        let mut power = 0.0;
        for i in 0..n {
            let (q, u) = (x[i], v[i]);
            let absent = 2.0 * coriolis * omega * u.perp() - centrifugal * omega * omega * q
                + transverse * gain * q.perp();
            power += self.mass[i] * absent.dot(drift + omega * q.perp() + u);
        }
        let space = self.leave(state);
        let own = self.strain(turn, &space.x);
        let fit = self.strain(rotation(&self.pull, &space.x), &space.x);
        for ((own, fit), v) in own.iter().zip(&fit).zip(&space.v) {
            power += (*own - *fit).dot(*v);
        }
        Ok(self.snake.body().spacing * power)
    }

    /// The elastic force in space of the rest shape turned by that much, its sum taken out.
    fn strain(&self, turn: DVec2, x: &[DVec2]) -> Vec<DVec2> {
        let (body, weights) = (self.snake.body(), &self.snake.weights);
        let (center, back) = (self.snake.center(x), DVec2::new(turn.x, -turn.y));
        let off = |(&x, &r): (&DVec2, &DVec2)| back.rotate(x - center) - r;
        let e: Vec<DVec2> = x.iter().zip(&body.rest).map(off).collect();
        let mut force = vec![DVec2::ZERO; e.len()];
        elastic::elastic_force(&e, body.topology, &body.material, body.spacing, &mut force);
        let sum: DVec2 = force.iter().sum();
        let pairs = force.iter().zip(weights);
        pairs.map(|(&f, &w)| turn.rotate(f - sum * w)).collect()
    }

    /// The snake, whose frame does not turn.
    #[must_use]
    pub const fn snake(&self) -> &Snake {
        &self.snake
    }

    /// θ at a state of this system, not reduced to one turn.
    #[must_use]
    pub fn angle(&self, state: &State) -> f64 {
        state.x[self.snake.len() + 1].x
    }

    /// ω at a state of this system. T⁻¹.
    #[must_use]
    pub fn angular_velocity(&self, state: &State) -> f64 {
        state.v[self.snake.len() + 1].x
    }

    /// A motion in space as this system sees it, the frame in its best fit.
    #[must_use]
    pub fn enter(&self, space: &State) -> State {
        let n = self.snake.len();
        let center = self.snake.center(&space.x);
        let weights = &self.snake.weights;
        let velocity: DVec2 = space.v.iter().zip(weights).map(|(&v, &w)| v * w).sum();
        let turn = rotation(&self.pull, &space.x);
        let back = DVec2::new(turn.x, -turn.y);
        let mut state = State {
            x: space.x.iter().map(|&x| back.rotate(x - center)).collect(),
            v: space.v.iter().map(|&v| back.rotate(v - velocity)).collect(),
            ..space.clone()
        };
        let (mut moment, mut arm) = (0.0, 0.0);
        for i in 0..n {
            moment += self.pull[i].perp_dot(state.v[i]);
            arm += self.pull[i].dot(state.x[i]);
        }
        let omega = if arm > 0.0 { moment / arm } else { 0.0 };
        for i in 0..n {
            state.v[i] -= omega * state.x[i].perp();
        }
        state.x.extend([center, DVec2::new(turn.to_angle(), 0.0)]);
        state.v.extend([velocity, DVec2::new(omega, 0.0)]);
        state
    }

    /// A state of this system in space: `x = c + R q`, `v = ċ + R (ω × q + ė)` (report Eq. 5.2, D76).
    #[must_use]
    pub fn leave(&self, state: &State) -> State {
        let n = self.snake.len();
        let mut space = State {
            t: state.t,
            step: state.step,
            ..State::at_rest(vec![DVec2::ZERO; n])
        };
        leave(n, &state.x, &state.v, &mut space);
        space
    }
}

fn leave(n: usize, x: &[DVec2], v: &[DVec2], space: &mut State) {
    let (center, velocity, omega) = (x[n], v[n], v[n + 1].x);
    let turn = DVec2::from_angle(x[n + 1].x);
    for i in 0..n {
        space.x[i] = center + turn.rotate(x[i]);
        space.v[i] = velocity + turn.rotate(omega * x[i].perp() + v[i]);
    }
}

/// K for the nodes and nothing for the other two. The corners of a closed band are columns of low rank, for
/// the two nodes more stand where it would wrap round; above order 2, where those would be many, the band is wider by two.
fn stiffness(snake: &Snake) -> Result<Operator, SnakeError> {
    let (body, n) = (snake.body(), snake.len());
    let k = elastic::stiffness(body.topology, &body.material, body.spacing, n)?;
    let refused = |error: banded::BandedError| SnakeError::Elastic(error.into());
    let (p, closed) = (k.half_width(), body.topology.is_closed());
    let round = closed && p > 2;
    let reach = if round { p + 2 } else { p };
    let mut band = Band::new(n + 2, reach, round).map_err(refused)?;
    for i in 0..n {
        band.add(i, i, k.diagonal()[i]);
        for reach in (1..=p).filter(|reach| round || i + reach < n) {
            band.add(i, (i + reach) % n, k.beside(i, reach));
        }
    }
    if !closed || round {
        return Ok(Operator::from(band));
    }
    let unit = |i: usize| (0..n + 2).map(|j| f64::from(u8::from(i == j))).collect();
    let columns: Vec<Vec<f64>> = [0, 1, n - 2, n - 1].map(unit).to_vec();
    let mut middle = vec![0.0; 16];
    for (a, i) in [(0, 0), (1, 1)] {
        for (b, j) in [(2, n - 2), (3, n - 1)] {
            // entries inside the band are there already
            let corner = if j - i > 2 { k.entry(i, j) } else { 0.0 };
            middle[4 * a + b] = corner;
            middle[4 * b + a] = corner;
        }
    }
    Operator::new(band, columns, middle).map_err(refused)
}

impl System for Turning {
    fn len(&self) -> usize {
        self.mass.len()
    }

    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn damping(&self) -> &[f64] {
        &self.damping
    }

    fn held(&self) -> &[bool] {
        &self.held
    }

    fn stiffness(&self) -> &Operator {
        &self.stiffness
    }

    /// −K (q − r), and nothing on the last two nodes.
    fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]) {
        let (n, body) = (self.snake.len(), self.snake.body());
        for (i, e) in self.space.v.iter_mut().enumerate() {
            *e = x[i] - body.rest[i];
        }
        let own = &mut force[..n];
        elastic::elastic_force(
            &self.space.v,
            body.topology,
            &body.material,
            body.spacing,
            own,
        );
        force[n..].fill(DVec2::ZERO);
    }

    fn external(
        &mut self,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        let n = self.snake.len();
        let mut own = std::mem::take(&mut self.elastic);
        self.elastic(x, &mut own);
        leave(n, x, v, &mut self.space);
        self.force.fill(DVec2::ZERO);
        let (space, felt) = (&self.space, &mut self.force);
        self.snake.external(t, &space.x, &space.v, felt)?;
        let weights = &self.snake.weights;
        let mean =
            |values: &[DVec2]| -> DVec2 { values.iter().zip(weights).map(|(&p, &w)| p * w).sum() };
        // about the center itself: without one of the terms the others would drive rounding away
        let (center, drift) = (mean(x), mean(v));
        let (omega, turn) = (v[n + 1].x, DVec2::from_angle(x[n + 1].x));
        let back = DVec2::new(turn.x, -turn.y);
        let [centrifugal, coriolis, transverse] = self.terms;
        let elastic_sum: DVec2 = own.iter().sum();
        let (mut push, mut drag) = (DVec2::ZERO, DVec2::ZERO);
        for i in 0..n {
            push += felt[i];
            drag += self.damping[i] * (space.v[i] - v[n]);
        }
        let total_damping = self.damping[n];
        force[n] += push - drag;
        let lift = back.rotate(push - drag - total_damping * v[n]) / self.mass[n];
        let (mut moment, mut arm, mut off, mut sway) = (0.0, 0.0, 0.0, 0.0);
        let (mut torque, mut inertia, mut growth, mut spin) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..n {
            let (m, gamma) = (self.mass[i], self.damping[i]);
            let (q, u) = (x[i] - center, v[i] - drift);
            let outer = back.rotate(felt[i] - gamma * space.v[i]);
            let mut f = outer - m * lift - elastic_sum * weights[i];
            if centrifugal {
                f += m * omega * omega * q;
            }
            if coriolis {
                f -= 2.0 * m * omega * u.perp();
            }
            let a = (f + own[i]) / m;
            moment += self.pull[i].perp_dot(a);
            sway += self.pull[i].perp_dot(u);
            off += self.pull[i].perp_dot(q);
            arm += self.pull[i].dot(q);
            torque += q.perp_dot(outer);
            inertia += m * q.length_squared();
            growth += 2.0 * m * q.dot(u);
            spin += m * q.perp_dot(a);
            // the scheme itself takes γ ė
            force[i] += f + gamma * v[i];
        }
        let gain = if transverse {
            (moment + 2.0 * self.rate * sway + self.rate * self.rate * off) / arm
        } else {
            (torque - growth * omega - spin) / inertia
        };
        if transverse {
            for i in 0..n {
                force[i] -= self.mass[i] * gain * (x[i] - center).perp();
            }
        }
        force[n + 1].x += gain;
        self.elastic = own;
        Ok(())
    }

    fn contact_stiffness(&self) -> (f64, f64) {
        self.snake.contact_stiffness()
    }

    fn internal_damping(&self) -> f64 {
        self.snake.internal_damping()
    }
}

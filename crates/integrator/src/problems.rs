//! Systems with their exact motion: what every scheme is measured against.
//!
//! Springs in all regimes, chains and rings of masses, free fall, a spring pushed in time, and one
//! whose stiffness is half elastic, half external. Each comes with the answer as a closed formula in
//! the textbook's form, written independently of what the exact schemes use.

use std::f64::consts::PI;
use std::fmt;

use banded::{BandedError, Operator, Pentadiagonal};
use glam::{DMat2, DVec2};

use crate::{Fault, State, System};

/// Masses on springs, each in its own tether to a rest place, coupled by a band.
#[derive(Debug, Clone)]
pub struct Springs {
    /// Mass of each node.
    pub mass: Vec<f64>,
    /// Damping of each node.
    pub damping: Vec<f64>,
    /// Which nodes may not move.
    pub held: Vec<bool>,
    /// Where the elastic force vanishes.
    pub rest: Vec<DVec2>,
    /// Uniform acceleration.
    pub gravity: DVec2,
    /// Stiffness of an external spring from each node to its rest place.
    pub pull: f64,
    /// External force `amplitude · cos(frequency · t)` on every node.
    pub drive: (DVec2, f64),
    stiffness: Operator,
    deformation: Vec<DVec2>,
}

impl Springs {
    /// Nodes of equal mass and damping, coupled by `stiffness`, at rest in the origin.
    #[must_use]
    pub fn new(stiffness: Operator, mass: f64, damping: f64) -> Self {
        let n = stiffness.len();
        Self {
            mass: vec![mass; n],
            damping: vec![damping; n],
            held: vec![false; n],
            rest: vec![DVec2::ZERO; n],
            gravity: DVec2::ZERO,
            pull: 0.0,
            drive: (DVec2::ZERO, 0.0),
            stiffness,
            deformation: vec![DVec2::ZERO; n],
        }
    }

    /// Couple the nodes otherwise.
    pub fn set_stiffness(&mut self, stiffness: Operator) {
        self.stiffness = stiffness;
    }
}

impl System for Springs {
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

    fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]) {
        for (e, (x, rest)) in self.deformation.iter_mut().zip(x.iter().zip(&self.rest)) {
            *e = x - rest;
        }
        self.stiffness.multiply_into(&self.deformation, force);
        force.iter_mut().for_each(|f| *f = -*f);
    }

    fn external(
        &mut self,
        t: f64,
        x: &[DVec2],
        _v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        let push = self.drive.0 * (self.drive.1 * t).cos();
        for i in 0..x.len() {
            force[i] += self.gravity * self.mass[i] + push - self.pull * (x[i] - self.rest[i]);
        }
        Ok(())
    }

    fn external_is_constant(&self) -> bool {
        self.pull == 0.0 && self.drive.0 == DVec2::ZERO
    }

    fn external_slope(&mut self, _t: f64, _x: &[DVec2], slope: &mut [DMat2]) -> bool {
        slope.fill(DMat2::from_diagonal(DVec2::splat(-self.pull)));
        true
    }
}

/// A system, where it starts, and where it is at any time after.
pub struct Problem {
    /// What moves.
    pub system: Springs,
    /// Where it starts, at time 0.
    pub state: State,
    /// The exact state at a time.
    pub exact: Box<dyn Fn(f64) -> State>,
}

impl fmt::Debug for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Problem")
            .field("system", &self.system)
            .field("state", &self.state)
            .finish_non_exhaustive()
    }
}

/// Free motion of `m ü + c u̇ + k u = 0`: `(u, u̇)` from rest at 1, and from 0 with velocity 1.
///
/// Each of the three regimes by its textbook formula (report §3.4.2); exact but for rounding unless
/// the two roots nearly meet without doing so.
#[must_use]
pub fn spring_motion(m: f64, c: f64, k: f64, t: f64) -> [(f64, f64); 2] {
    let (b, square) = (0.5 * c / m, k / m);
    let excess = b * b - square;
    if excess < 0.0 {
        let (w, fade) = ((-excess).sqrt(), (-b * t).exp());
        let (sin, cos) = (w * t).sin_cos();
        return [
            (fade * (cos + b / w * sin), -fade * square / w * sin),
            (fade * sin / w, fade * (cos - b / w * sin)),
        ];
    }
    if excess <= 0.0 {
        let fade = (-b * t).exp();
        return [
            (fade * (1.0 + b * t), -fade * b * b * t),
            (fade * t, fade * (1.0 - b * t)),
        ];
    }
    let root = excess.sqrt();
    let fast = -b - root;
    let slow = square / fast;
    let (f, s) = ((fast * t).exp(), (slow * t).exp());
    let apart = slow - fast;
    [
        ((slow * f - fast * s) / apart, slow * fast * (f - s) / apart),
        ((s - f) / apart, (slow * s - fast * f) / apart),
    ]
}

/// One way of moving all nodes together.
#[derive(Debug, Clone)]
struct Mode {
    stiffness: f64,
    position: Vec<DVec2>,
    velocity: Vec<DVec2>,
}

/// A problem that is a sum of free modes about the rest place.
fn modal(system: Springs, pull: f64, modes: Vec<Mode>) -> Problem {
    let (m, c) = (system.mass[0], system.damping[0]);
    let rest = system.rest.clone();
    let exact = move |t: f64| {
        let mut state = State::at_rest(rest.clone());
        state.t = t;
        for mode in &modes {
            let [(u, du), (w, dw)] = spring_motion(m, c, mode.stiffness + pull, t);
            for i in 0..state.x.len() {
                state.x[i] += u * mode.position[i] + w * mode.velocity[i];
                state.v[i] += du * mode.position[i] + dw * mode.velocity[i];
            }
        }
        state
    };
    Problem {
        system,
        state: exact(0.0),
        exact: Box::new(exact),
    }
}

/// A band of size `n`: the same three numbers in every row.
fn uniform(n: usize, cyclic: bool, rows: [f64; 3]) -> Result<Operator, BandedError> {
    let [diagonal, first, second] = rows;
    let mut band = Pentadiagonal::new(n, cyclic)?;
    band.add_identity(diagonal);
    for i in 0..n {
        for (offset, value) in [(1, first), (2, second)] {
            if cyclic || i + offset < n {
                band.add(i, (i + offset) % n, value);
            }
        }
    }
    Ok(Operator::from(band))
}

/// A damped spring, three times side by side: `m ü + c u̇ + k u = 0`.
///
/// The first node starts at rest at `u = 1` as in report §3.4.2, the others move already.
///
/// # Errors
///
/// Refused: fewer nodes than the band reaches over.
pub fn damped_spring(m: f64, c: f64, k: f64) -> Result<Problem, BandedError> {
    shared_spring(m, c, k, 0.0)
}

/// The same with `share` of the stiffness in the external force, where explicit rules meet it.
///
/// # Errors
///
/// Refused: fewer nodes than the band reaches over.
pub fn shared_spring(m: f64, c: f64, k: f64, share: f64) -> Result<Problem, BandedError> {
    let mut system = Springs::new(uniform(3, false, [k * (1.0 - share), 0.0, 0.0])?, m, c);
    system.pull = k * share;
    let position = vec![
        DVec2::new(1.0, 0.0),
        DVec2::new(0.5, -0.25),
        DVec2::new(0.0, 2.0),
    ];
    let velocity = vec![DVec2::ZERO, DVec2::new(1.0, 0.5), DVec2::new(-1.0, 0.0)];
    let mode = Mode {
        stiffness: k * (1.0 - share),
        position,
        velocity,
    };
    Ok(modal(system, k * share, vec![mode]))
}

/// A spring that starts at rest in place and is pushed by `cos(frequency · t)` along x.
///
/// # Errors
///
/// Refused: fewer nodes than the band reaches over.
pub fn driven_spring(m: f64, c: f64, k: f64, frequency: f64) -> Result<Problem, BandedError> {
    let mut system = Springs::new(uniform(3, false, [k, 0.0, 0.0])?, m, c);
    system.drive = (DVec2::X, frequency);
    let start = State::at_rest(vec![DVec2::ZERO; 3]);
    // steady motion a cos + b sin, and the free motion that cancels it at the start
    let stiff = k - m * frequency * frequency;
    let drag = c * frequency;
    let size = stiff * stiff + drag * drag;
    let (a, b) = (stiff / size, drag / size);
    let exact = move |t: f64| {
        let [(u, du), (w, dw)] = spring_motion(m, c, k, t);
        let (sin, cos) = (frequency * t).sin_cos();
        let x = a * cos + b * sin - a * u - b * frequency * w;
        let v = frequency * (b * cos - a * sin) - a * du - b * frequency * dw;
        State {
            t,
            step: 0,
            x: vec![DVec2::new(x, 0.0); 3],
            v: vec![DVec2::new(v, 0.0); 3],
        }
    };
    Ok(Problem {
        system,
        state: start,
        exact: Box::new(exact),
    })
}

/// `n` masses in a row, springs of stiffness `k` between them and to a wall at each end.
///
/// Modes `sin(π j (i + 1) / (n + 1))` with stiffness `4 k sin²(π j / (2 (n + 1)))`; three of them move.
///
/// # Errors
///
/// Refused: fewer nodes than the band reaches over.
pub fn chain(n: usize, m: f64, c: f64, k: f64) -> Result<Problem, BandedError> {
    let system = Springs::new(uniform(n, false, [2.0 * k, -k, 0.0])?, m, c);
    let size = n as f64 + 1.0;
    let mode = |j: usize, x: DVec2, v: DVec2| {
        let angle = PI * j as f64 / size;
        let shape = |along: DVec2| (1..=n).map(|i| along * (angle * i as f64).sin()).collect();
        let stiffness = 4.0 * k * (0.5 * angle).sin().powi(2);
        Mode {
            stiffness,
            position: shape(x),
            velocity: shape(v),
        }
    };
    let modes = vec![
        mode(1, DVec2::new(1.0, 0.0), DVec2::new(0.0, 0.5)),
        mode(2, DVec2::new(0.2, -0.3), DVec2::ZERO),
        mode(n, DVec2::new(0.1, 0.1), DVec2::new(0.0, 0.1)),
    ];
    Ok(modal(system, 0.0, modes))
}

/// A closed ring of `n` masses with tether, tension over h² and rigidity over h⁴ as given.
///
/// Stiffness of mode `k`: `ω₀ + 4 ω₁ s + 16 ω₂ s²` with `s = sin²(π k / n)`. It moves along as a
/// whole, and in three modes, the stiffest among them.
///
/// # Errors
///
/// Refused: fewer nodes than the band reaches over.
pub fn ring(n: usize, m: f64, c: f64, stiffness: [f64; 3]) -> Result<Problem, BandedError> {
    let [w0, w1, w2] = stiffness;
    let rows = [w0 + 2.0 * w1 + 6.0 * w2, -w1 - 4.0 * w2, w2];
    let mut system = Springs::new(uniform(n, true, rows)?, m, c);
    let turn = move |k: usize, i: usize| 2.0 * PI * ((k * i) % n) as f64 / n as f64;
    system.rest = (0..n)
        .map(|i| 10.0 * DVec2::from_angle(turn(1, i)))
        .collect();
    let mode = |k: usize, x: f64, v: DVec2| {
        let s = (PI * k as f64 / n as f64).sin().powi(2);
        let position = (0..n).map(|i| x * DVec2::from_angle(turn(k, i))).collect();
        let velocity = (0..n).map(|i| v * turn(k, i).cos()).collect();
        Mode {
            stiffness: w0 + 4.0 * w1 * s + 16.0 * w2 * s * s,
            position,
            velocity,
        }
    };
    let modes = vec![
        mode(0, 0.5, DVec2::new(0.25, -0.5)),
        mode(2, 1.0, DVec2::new(0.0, 0.5)),
        mode(3, 0.25, DVec2::ZERO),
        mode(n / 2, 0.01, DVec2::ZERO),
    ];
    Ok(modal(system, 0.0, modes))
}

/// Five nodes thrown and falling with acceleration `gravity`, slowed by damping `c`.
///
/// # Errors
///
/// Refused: fewer nodes than the band reaches over.
pub fn free_fall(m: f64, c: f64, gravity: DVec2) -> Result<Problem, BandedError> {
    let mut system = Springs::new(uniform(5, true, [0.0; 3])?, m, c);
    system.gravity = gravity;
    let mut start = State::at_rest((0..5).map(|i| DVec2::new(f64::from(i), 10.0)).collect());
    start.v = (0..5).map(|i| DVec2::new(1.0, -f64::from(i))).collect();
    let from = start.clone();
    let exact = move |t: f64| {
        let mut state = State { t, ..from.clone() };
        for i in 0..5 {
            let (x, v) = (from.x[i], from.v[i]);
            if c > 0.0 {
                let last = gravity * m / c;
                let gone = -(-c * t / m).exp_m1();
                state.x[i] = x + last * t + (v - last) * gone * m / c;
                state.v[i] = v + (last - v) * gone;
            } else {
                state.x[i] = x + v * t + 0.5 * gravity * t * t;
                state.v[i] = v + gravity * t;
            }
        }
        state
    };
    Ok(Problem {
        system,
        state: start,
        exact: Box::new(exact),
    })
}

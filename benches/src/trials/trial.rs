//! The problems every scheme is tried on.

use super::edge::EdgeRing;
use integrator::problems::{self, spring_motion};
use integrator::{Scheme, Start, State, System};
use sandbox::prelude::*;
use scene::Scene;
use std::f64::consts::TAU;

/// Nodes of the rings.
pub const NODES: usize = 200;

/// Something to move, from where, for how long, and where it should be then.
pub struct Trial {
    /// What moves.
    pub system: Box<dyn System>,
    /// Where it starts.
    pub start: State,
    /// For how long.
    pub until: f64,
    /// Where it should be, after these shares of the time; the last is the end.
    pub truth: Vec<(f64, Vec<DVec2>)>,
    /// What is wanted of its runs.
    pub care: Care,
}

/// What is wanted of the runs of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Care {
    /// Forces and times: each run is repeated for its least time, as far as errors fall.
    Timed,
    /// Forces only, up to an error of 1e-6 px: one run each, the same numbers on every machine.
    Counted,
}

impl Trial {
    /// The same trial, of which only forces are counted.
    #[must_use]
    pub fn counted(self) -> Self {
        Self {
            care: Care::Counted,
            ..self
        }
    }
}

impl std::fmt::Debug for Trial {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Trial")
            .field("until", &self.until)
            .finish_non_exhaustive()
    }
}

/// Waves round the ring at the start: number, and amplitude in pixels.
const WAVES: [(usize, f64); 4] = [(2, 1.0), (3, 0.5), (5, 0.2), (10, 0.28)];

fn wave(k: usize, i: usize) -> DVec2 {
    DVec2::from_angle(TAU * real((k * i) % NODES) / real(NODES))
}

/// A ring of 200 nodes let go at rest in gravity, bent in four waves: `μ = γ = ω₀ = 1`, and
/// rigidity so that the largest stiffness is `ratio` times the least.
///
/// The answer is exact: each wave and the fall are damped springs of their own.
///
/// # Errors
///
/// None for ratios above 1.
pub fn ring(ratio: f64, gravity: f64) -> Result<Trial> {
    let rigidity = (ratio - 1.0) / 16.0;
    let problem = problems::ring(NODES, 1.0, 1.0, [1.0, 0.0, rigidity])?;
    let mut system = problem.system;
    system.gravity = DVec2::new(0.0, gravity);
    let (rest, until) = (system.rest.clone(), 5.0);
    let at = |t: f64| -> Vec<DVec2> {
        let fallen = system.gravity * (1.0 - spring_motion(1.0, 1.0, 1.0, t)[0].0);
        let place = |(i, rest): (usize, &DVec2)| {
            let waves = WAVES.iter().map(|&(k, size)| {
                let s = (std::f64::consts::PI * real(k) / real(NODES)).sin().powi(2);
                let stiffness = 1.0 + 16.0 * rigidity * s * s;
                size * spring_motion(1.0, 1.0, stiffness, t)[0].0 * wave(k, i)
            });
            *rest + fallen + waves.sum::<DVec2>()
        };
        rest.iter().enumerate().map(place).collect()
    };
    let (start, truth) = (State::at_rest(at(0.0)), vec![(1.0, at(until))]);
    Ok(Trial {
        system: Box::new(system),
        start,
        until,
        truth,
        care: Care::Timed,
    })
}

/// A light stiff ring let go at rest beside an edge that catches it: `μ = 0.01`, `γ = ω₀ = 1`.
///
/// Judged half way, while it moves, and at the end.
///
/// # Errors
///
/// Whatever the reference refuses.
pub fn edge(ratio: f64) -> Result<Trial> {
    let problem = problems::ring(NODES, 0.01, 1.0, [1.0, 0.0, (ratio - 1.0) / 16.0])?;
    let start = State::at_rest(problem.system.rest.clone());
    referred(Box::new(EdgeRing::new(problem.system)), start, 5.0, 1e-12)
}

/// The rigid ball of figure 2.4 against a wall that is a stiff spring.
///
/// # Errors
///
/// Whatever the scene or the reference refuses.
pub fn wall() -> Result<Trial> {
    let scene = Scene::named("rigid-ball-penalty")?;
    referred(Box::new(scene.snake), scene.start, 7.0, 1e-12)
}

/// The apple of figures 4.6 to 4.8: 20 units of time, in which most of the way is made.
///
/// # Errors
///
/// Whatever the scene or the reference refuses.
pub fn apple() -> Result<Trial> {
    let scene = Scene::named("apple")?;
    referred(Box::new(scene.snake), scene.start, 20.0, 1e-11)
}

/// A trial whose truth is the adaptive reference's, half way and at the end.
fn referred(
    mut system: Box<dyn System>,
    start: State,
    until: f64,
    tolerance: f64,
) -> Result<Trial> {
    let mut state = start.clone();
    let scheme = Scheme::DormandPrince { tolerance };
    let half = 0.5 * until;
    let mut stepper = scheme.start(&mut *system, &state, half, Start::SecondOrder)?;
    let mut truth = Vec::new();
    for share in [0.5, 1.0] {
        stepper.step(&mut *system, &mut state)?;
        truth.push((share, state.x.clone()));
    }
    Ok(Trial {
        system,
        start,
        until,
        truth,
        care: Care::Timed,
    })
}

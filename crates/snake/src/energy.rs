//! The energies of a snake, term by term.
//!
//! Each is an integral over the curve, `h Σ`, so that it does not depend on the number of nodes.
//! Where a force has a potential the energy is that potential. Where it has none (the report's
//! field is no gradient, D39; a field sampled between pixels is one only in the limit) the
//! [`Ledger`] books minus the work the force has done since the run began, so that the sum means
//! the same thing in either case: without damping and contact it stays what it was.

use glam::DVec2;
use integrator::{Fault, State};

use crate::Snake;

/// Energy of every term at one moment. M L³ T⁻².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    /// `½ h Σ μ v²`.
    pub kinetic: f64,
    /// `½ h Σ ω₀ e²`.
    pub tether: f64,
    /// `½ h Σ ω₁ |D₁ e|²`.
    pub tension: f64,
    /// `½ h Σ ω₂ |D₂ e|²`.
    pub rigidity: f64,
    /// `−h Σ μ g·x`.
    pub gravity: f64,
    /// `½ h Σ k d²` over the nodes behind penalty walls.
    pub wall: f64,
    /// Minus the work of the picture's force since the run began.
    pub image: f64,
}

impl Energies {
    /// What each column means, in the order of [`Energies::values`].
    pub const NAMES: [&str; 7] = [
        "kinetic", "tether", "tension", "rigidity", "gravity", "wall", "image",
    ];

    /// Every term, in the order of [`Energies::NAMES`].
    #[must_use]
    pub const fn values(&self) -> [f64; 7] {
        [
            self.kinetic,
            self.tether,
            self.tension,
            self.rigidity,
            self.gravity,
            self.wall,
            self.image,
        ]
    }

    /// The three elastic terms together: ξ of report Eq. 2.5.
    #[must_use]
    pub fn elastic(&self) -> f64 {
        self.tether + self.tension + self.rigidity
    }

    /// The sum of all terms.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.values().iter().sum()
    }
}

/// Follows a run and keeps the work that has no potential.
///
/// The work of a step is the mean of the forces before and after it, times the way: second order
/// in the step.
#[derive(Debug, Clone)]
pub struct Ledger {
    place: Vec<DVec2>,
    force: Vec<DVec2>,
    now: Vec<DVec2>,
    image_work: f64,
}

impl Ledger {
    /// Begin at `state`.
    ///
    /// # Errors
    ///
    /// The fault of the picture's force at a node that it cannot be read at.
    pub fn begin(snake: &mut Snake, state: &State) -> Result<Self, Fault> {
        let mut force = vec![DVec2::ZERO; snake.body().len()];
        snake.image_force(&state.x, &mut force)?;
        Ok(Self {
            place: state.x.clone(),
            now: force.clone(),
            force,
            image_work: 0.0,
        })
    }

    /// Book the step that led to `state`.
    ///
    /// # Errors
    ///
    /// As [`Ledger::begin`].
    pub fn book(&mut self, snake: &mut Snake, state: &State) -> Result<(), Fault> {
        if snake.world().image().is_none() {
            return Ok(());
        }
        snake.image_force(&state.x, &mut self.now)?;
        let mut work = 0.0;
        for (i, &x) in state.x.iter().enumerate() {
            work += 0.5 * (self.force[i] + self.now[i]).dot(x - self.place[i]);
        }
        self.image_work += work * snake.body().spacing;
        self.place.copy_from_slice(&state.x);
        std::mem::swap(&mut self.force, &mut self.now);
        Ok(())
    }

    /// The energies of `snake` at `state`, the picture's work included.
    pub fn energies(&self, snake: &mut Snake, state: &State) -> Energies {
        Energies {
            image: -self.image_work,
            ..snake.energies(state)
        }
    }
}

//! The energies of a snake, term by term, and the account of where they go.
//!
//! Each is an integral over the curve, `h Σ`, so that it does not depend on the number of nodes.
//! Where a force has a potential the energy is that potential. Where it has none (the report's
//! field is no gradient, D39; a field sampled between pixels is one only in the limit; what fades
//! or moves with time is none) the [`Ledger`](crate::Ledger) books minus the work that the force has done since
//! the run began. It books too what damping and contacts have taken and what changing parameters
//! and a hand have put in, so that the sum of everything stays what it was.

use crate::Snake;

/// Energy of every term at one moment. M L³ T⁻².
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Energies {
    /// `½ h Σ μ v²`.
    pub kinetic: f64,
    /// `½ h Σ ω₀ e²`.
    pub tether: f64,
    /// `½ h Σ ω₁ |D₁ e|²`.
    pub tension: f64,
    /// `½ h Σ ω₂ |D₂ e|²`.
    pub rigidity: f64,
    /// `½ h Σ ωₘ |Dₘ e|²` over the orders m above the second; none for a body without them.
    pub higher: Option<f64>,
    /// Of each force of the world, in its order: its potential, or minus its work since the run began.
    pub forces: Vec<f64>,
    /// `½ h Σ k d²` over the nodes behind penalty walls.
    pub wall: f64,
    /// Lost to damping since the run began.
    pub damping: f64,
    /// Lost in contacts since the run began.
    pub contact: f64,
    /// Minus what a body frame without reaction has put in since the run began (D4). It pushes the body as a whole, which
    /// no energy of its deformation does.
    pub frame: f64,
    /// Minus what the scheme's own algebra has put in since the run began, where it is known
    /// ([`Ledger::under`](crate::Ledger::under)).
    pub scheme: f64,
    /// Minus what schedules and maps of parameters have put in since the run began.
    pub parameters: f64,
    /// Minus what changes of the snake and its world by hand have put in since the run began, and what
    /// was booked of forces that are gone.
    pub hand: f64,
    /// Minus what has been put in where the curve became another one: other nodes, another rest shape, growth, a piece cut off.
    pub upkeep: f64,
}

impl Energies {
    /// What each of [`Energies::values`] is called for that snake.
    #[must_use]
    pub fn names(snake: &Snake) -> Vec<String> {
        let orders = snake.body().material.order() > 2;
        Self::names_with(orders, snake.world().names())
    }

    /// The same with these names for the forces; `orders`: whether there are elastic terms above the second order.
    pub fn names_with<'a>(orders: bool, forces: impl Iterator<Item = &'a str>) -> Vec<String> {
        let first = ["kinetic", "tether", "tension", "rigidity"];
        let last = [
            "wall",
            "damping",
            "contact",
            "frame",
            "scheme",
            "parameters",
            "hand",
            "upkeep",
        ];
        first
            .into_iter()
            .chain(orders.then_some("higher"))
            .chain(forces)
            .chain(last)
            .map(str::to_owned)
            .collect()
    }

    /// Every term, in the order of [`Energies::names`].
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        let mut values = vec![self.kinetic, self.tether, self.tension, self.rigidity];
        values.extend(self.higher);
        values.extend(&self.forces);
        values.extend([self.wall, self.damping, self.contact]);
        values.extend([self.frame, self.scheme, self.parameters]);
        values.extend([self.hand, self.upkeep]);
        values
    }

    /// The elastic terms together: ξ of report Eq. 2.5.
    #[must_use]
    pub fn elastic(&self) -> f64 {
        self.tether + self.tension + self.rigidity + self.higher.unwrap_or(0.0)
    }

    /// What could still move: everything but what is booked as lost or put in.
    #[must_use]
    pub fn mechanical(&self) -> f64 {
        self.kinetic + self.elastic() + self.forces.iter().sum::<f64>() + self.wall
    }

    /// The sum of all terms. With a [`Ledger`](crate::Ledger) it stays what it was, up to the errors of the scheme
    /// and of the account.
    #[must_use]
    pub fn total(&self) -> f64 {
        let put_in = self.frame + self.scheme + self.parameters + self.hand + self.upkeep;
        self.mechanical() + self.damping + self.contact + put_in
    }
}

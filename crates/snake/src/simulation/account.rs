//! Where the energies of a crowd go.
//!
//! A kick changes the kinetic energy by its impulse times the mean of the velocities before and after. What the kicks around a step
//! put in beyond the work of their forces over the way of the step is the scheme's: what a leapfrog's energy swings by. None of this asks
//! for an energy, so the sum is a check of kicks against forces and of forces against energies.

use super::passage::Tally;
use super::{Member, Simulation, SimulationError};
use crate::Energies;

/// What a crowd itself has booked, above what its members have.
#[derive(Debug, Clone)]
pub(super) struct Books {
    /// Whether an account is kept.
    pub kept: bool,
    /// Lost in contacts between members.
    pub lost: f64,
    /// All that the ledgers of members have booked that are gone.
    pub gone: Energies,
    /// Minus what kicks have put in beyond the work of contacts.
    pub scheme: f64,
    /// Minus what upkeep has put in.
    pub upkeep: f64,
    /// Minus what snakes that joined or left have brought.
    pub hand: f64,
}

impl Books {
    pub(super) fn new(kept: bool) -> Self {
        Self {
            kept,
            lost: 0.0,
            gone: Energies::default(),
            scheme: 0.0,
            upkeep: 0.0,
            hand: 0.0,
        }
    }
    /// What half a kick has done.
    pub(super) fn kicked(&mut self, tally: Tally) {
        if self.kept {
            self.lost += tally.lost;
            self.scheme -= tally.work;
        }
    }

    /// A member is gone that had booked so much.
    pub(super) fn retire(&mut self, booked: &Energies) {
        if self.gone.forces.is_empty() {
            self.gone.forces.push(0.0);
        }
        add_up(&mut self.gone, booked);
    }

    /// What contacts have done on the way of a step.
    pub(super) fn passed(&mut self, tally: Tally) {
        if self.kept {
            self.lost += tally.lost;
            self.scheme += tally.work;
        }
    }
}

/// Add one member's energies to those of all, its forces together.
fn add_up(sum: &mut Energies, energies: &Energies) {
    sum.kinetic += energies.kinetic;
    sum.tether += energies.tether;
    sum.tension += energies.tension;
    sum.rigidity += energies.rigidity;
    if let (Some(sum), Some(more)) = (&mut sum.higher, energies.higher) {
        *sum += more;
    }
    sum.forces[0] += energies.forces.iter().sum::<f64>();
    sum.wall += energies.wall;
    sum.damping += energies.damping;
    sum.contact += energies.contact;
    sum.frame += energies.frame;
    sum.scheme += energies.scheme;
    sum.parameters += energies.parameters;
    sum.hand += energies.hand;
    sum.upkeep += energies.upkeep;
}

impl Simulation {
    /// What the forces of [`Simulation::energies`] are called: those of every member's world together, and what
    /// the contacts between members hold.
    pub const FORCES: [&str; 2] = ["outside", "between"];

    /// All energies, those of the members added up. Losses in contacts between members stand under
    /// `contact`, minus what their kicks have put in beyond the work of their forces under `scheme`, and what
    /// [`Upkeep`](super::Upkeep) has put in under `upkeep`. Without an account ([`Rules`](super::Rules)) what would be
    /// booked is 0.
    pub fn energies(&mut self) -> Energies {
        let mut sum = Energies {
            forces: vec![0.0; 2],
            higher: self.orders.then_some(0.0),
            contact: self.books.lost,
            scheme: self.books.scheme,
            upkeep: self.books.upkeep,
            hand: self.books.hand,
            ..Energies::default()
        };
        if let Some(contact) = &self.contact {
            sum.forces[1] = self.meetings.energy(contact, &self.members)
                + self.footings.energy(contact, &self.members);
        }
        let members = self.members.iter_mut().map(Member::energies);
        for energies in members.chain([self.books.gone.clone()]) {
            add_up(&mut sum, &energies);
        }
        sum
    }
}

impl Simulation {
    /// The energies of snake number `id` alone, force by force, with what its own account has booked.
    ///
    /// # Errors
    ///
    /// A number that no snake has.
    pub fn energies_of(&mut self, id: usize) -> Result<Energies, SimulationError> {
        let k = self.index(id)?;
        Ok(self.members[k].energies())
    }
}

impl Member {
    /// Its energies, with what its own ledger has booked.
    fn energies(&mut self) -> Energies {
        match &self.ledger {
            Some(ledger) => ledger.energies(&mut self.snake, &self.state),
            None => self.snake.energies(&self.state),
        }
    }

    /// Tell its scheme, and its ledger if it keeps one, that someone else has moved it.
    pub(super) fn resume(&mut self) -> Result<(), SimulationError> {
        let stepper = self.pace.stepper();
        stepper.resume(&mut self.snake, &self.state);
        self.told = self.snake.edits;
        let Some(ledger) = &mut self.ledger else {
            return Ok(());
        };
        let member = self.id;
        let resumed = ledger.resume(&mut self.snake, &self.state);
        resumed.map_err(|fault| SimulationError::Fault { member, fault })
    }

    /// The same where only its velocities have been changed.
    pub(super) fn kicked(&mut self) -> Result<(), SimulationError> {
        let stepper = self.pace.stepper();
        stepper.kicked(&mut self.snake, &self.state);
        let Some(ledger) = &mut self.ledger else {
            return Ok(());
        };
        let member = self.id;
        let kicked = ledger.kicked(&mut self.snake, &self.state);
        kicked.map_err(|fault| SimulationError::Fault { member, fault })
    }
}

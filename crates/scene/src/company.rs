//! Scenes of more than one snake, or of one whose curve is looked after.

use integrator::State;
use snake::{Contact, Snake, Upkeep};

/// Whom a scene's snake shares its world with, and how curves are kept in order.
#[derive(Debug, Clone)]
pub struct Company {
    /// The further snakes, each where it starts.
    pub others: Vec<(Snake, State)>,
    /// What happens where curves meet; None: they pass through each other.
    pub contact: Option<Contact>,
    /// How curves are kept in order.
    pub upkeep: Upkeep,
}

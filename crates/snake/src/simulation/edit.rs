//! What a user may change between two steps.

use elastic::Profile;
use glam::DVec2;

use super::{Entry, Simulation, SimulationError, Stepping};
use crate::{Acting, Body, Parameter, SnakeError, World};

/// A change of one snake, made between two steps and felt from the next one on.
#[derive(Debug, Clone)]
pub enum Edit {
    /// Hold these nodes fast: each loses its velocity with the next step.
    Hold(Vec<usize>),
    /// Let go of these nodes. Ends that are pinned stay so.
    Release(Vec<usize>),
    /// One more force: a spring that pulls, a repulsor that pushes, any other.
    Add(Acting),
    /// The first force of that name acts no longer.
    Remove(String),
    /// A force in the place of the first one of its name.
    Replace(Acting),
    /// A parameter that is the same all along the curve.
    Set(Parameter, f64),
    /// Another body of as many nodes.
    Body(Box<Body>),
    /// Another rest shape of as many nodes.
    Rest(Vec<DVec2>),
    /// Another world: other forces and walls, as of the next picture of a sequence.
    World(World),
}

impl Simulation {
    /// Change snake number `id`.
    ///
    /// # Errors
    ///
    /// A number that no snake has, and whatever the change is refused for; then nothing has changed.
    pub fn edit(&mut self, id: usize, edit: Edit) -> Result<(), SimulationError> {
        let k = self.index(id)?;
        let member = &mut self.members[k];
        let snake = &mut member.snake;
        match edit {
            Edit::Hold(nodes) => snake.hold(nodes)?,
            Edit::Release(nodes) => snake.release(nodes)?,
            Edit::Add(acting) => snake.add_force(acting)?,
            Edit::Remove(name) => {
                let gone = snake.remove_force(&name);
                gone.ok_or(SnakeError::NoSuchForce { name })?;
            }
            Edit::Replace(acting) => {
                let name = acting.name().to_owned();
                snake.replace_force(&name, acting)?;
            }
            Edit::Set(parameter, value) => {
                let mut body = snake.body().clone();
                body.set(parameter, Profile::Uniform(value))?;
                snake.set_body(body)?;
            }
            Edit::Body(body) => snake.set_body(*body)?,
            Edit::Rest(rest) => snake.set_rest(rest)?,
            Edit::World(world) => snake.set_world(world)?,
        }
        member.lightest = super::lightest(&member.snake);
        self.orders |= member.snake.body().material.order() > 2;
        Ok(())
    }

    /// Expect changes of snake number `id` until the time `t`: before that one that does not move waits, and is not
    /// called at rest. Minus infinity: no longer.
    ///
    /// # Errors
    ///
    /// A number that no snake has.
    pub fn expect_edits_until(&mut self, id: usize, t: f64) -> Result<(), SimulationError> {
        let k = self.index(id)?;
        self.members[k].snake.expect_changes_until(t);
        Ok(())
    }

    /// Go on by other steps, of another scheme or another length.
    ///
    /// # Errors
    ///
    /// As [`Simulation::new`]; then nothing has changed.
    pub fn set_stepping(&mut self, stepping: Stepping) -> Result<(), SimulationError> {
        let mut other = self.clone();
        other.stepping = stepping;
        other.begin = (self.t, self.step);
        other.check_alone(other.members.len())?;
        (other.parts, other.least_parts, other.cut) = (1, 1, None);
        if let Some(contact) = other.contact {
            other.cut(other.contact_limit(&contact))?;
        }
        for k in 0..other.members.len() {
            let (id, mut snake) = (other.members[k].id, other.members[k].snake.clone());
            other.check_step(id, &snake)?;
            other.remember(k);
            let begun = other.pace_of(k, &mut snake, &other.members[k].state);
            let (pace, cuts) = begun.map_err(|error| error.of(id))?;
            let member = &mut other.members[k];
            (member.snake, member.pace, member.cuts) = (snake, pace, cuts);
            member.resume()?;
        }
        *self = other;
        Ok(())
    }

    /// Let curves push each other by these rules from now on; None: they pass through each other.
    ///
    /// # Errors
    ///
    /// As [`Simulation::new`]; then nothing has changed.
    pub fn set_contact(&mut self, contact: Option<super::Contact>) -> Result<(), SimulationError> {
        let mut other = self.clone();
        other.contact = contact;
        other.check_alone(other.members.len())?;
        (other.parts, other.least_parts, other.cut) = (1, 1, None);
        if let Some(contact) = &contact {
            contact.validate()?;
            other.cut(other.contact_limit(contact))?;
        }
        other.meet(None)?;
        *self = other;
        Ok(())
    }

    /// Put snake number `id` at these places with these velocities, at the time it is.
    ///
    /// # Errors
    ///
    /// A number that no snake has, a state of another number of nodes, a place at which a force has no value; then
    /// nothing has changed.
    pub fn move_to(
        &mut self,
        id: usize,
        x: Vec<DVec2>,
        v: Vec<DVec2>,
    ) -> Result<(), SimulationError> {
        let mut other = self.clone();
        let (k, before) = (other.index(id)?, other.sum());
        let needed = other.members[k].state.len();
        for got in [x.len(), v.len()] {
            if got != needed {
                return Err(SnakeError::OtherLength { needed, got }.into());
            }
        }
        other.remember(k);
        let member = &mut other.members[k];
        (member.state.x, member.state.v) = (x, v);
        let (mut snake, state) = (member.snake.clone(), member.state.clone());
        let begun = other.pace_of(k, &mut snake, &state);
        let (pace, cuts) = begun.map_err(|error| error.of(id))?;
        let member = &mut other.members[k];
        (member.snake, member.pace, member.cuts) = (snake, pace, cuts);
        member.resume()?;
        other.meet(None)?;
        other.books.hand += before - other.sum();
        *self = other;
        Ok(())
    }

    /// One more snake from now on; its number.
    ///
    /// # Errors
    ///
    /// As [`Simulation::new`]; then nothing has changed.
    pub fn add(&mut self, entry: Entry) -> Result<usize, SimulationError> {
        self.check_alone(self.members.len() + 1)?;
        let (id, before) = (self.next_id, self.sum());
        self.admit(entry)?;
        self.meet(None)?;
        self.books.hand += before - self.sum();
        Ok(id)
    }

    /// Take snake number `id` out; what it leaves as.
    ///
    /// # Errors
    ///
    /// A number that no snake has.
    pub fn remove(&mut self, id: usize) -> Result<Entry, SimulationError> {
        let (k, before) = (self.index(id)?, self.sum());
        let member = self.retire(k);
        self.meet(None)?;
        self.books.hand += before - self.sum();
        Ok(Entry {
            snake: member.snake,
            state: member.state,
            terms: member.terms,
            tips: member.tips,
        })
    }

    /// The sum of all energies, where an account is kept.
    fn sum(&mut self) -> f64 {
        if self.books.kept {
            self.energies().total()
        } else {
            0.0
        }
    }

    /// Where in the list snake number `id` is.
    pub(super) fn index(&self, id: usize) -> Result<usize, SimulationError> {
        let mut members = self.members.iter();
        let found = members.position(|member| member.id == id);
        found.ok_or(SimulationError::NoSuchSnake { id })
    }
}

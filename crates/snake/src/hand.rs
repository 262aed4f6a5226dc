//! The hand: forces that come and go during a run, and nodes held fast.
//!
//! A [`Simulation`](crate::Simulation) does this by [`Edit`](crate::Edit). Its account of energies books under `hand`
//! what the change itself has put in or taken.

use outline::Plan;

use crate::parameters::operator;
use crate::snake::admit;
use crate::{Acting, Snake, SnakeError};

impl Snake {
    /// Let one more force act, from the next step on.
    ///
    /// # Errors
    ///
    /// Refused: whatever [`Snake::new`] refuses of a world; then nothing has changed.
    pub fn add_force(&mut self, acting: Acting) -> Result<(), SnakeError> {
        self.world.forces.push(acting);
        if let Err(error) = admit(&self.world, &self.body) {
            self.world.forces.pop();
            return Err(error);
        }
        self.note();
        Ok(())
    }

    /// Let the first force called `name` act no longer; None where there is none.
    pub fn remove_force(&mut self, name: &str) -> Option<Acting> {
        let index = self.index_of(name)?;
        self.note();
        Some(self.world.forces.remove(index))
    }

    /// Put another force in the place of the first one called `name`: a parameter that changes. Gives back the old one.
    ///
    /// # Errors
    ///
    /// Refused: a name that no force has, and whatever [`Snake::new`] refuses of a world; then nothing has changed.
    pub fn replace_force(&mut self, name: &str, acting: Acting) -> Result<Acting, SnakeError> {
        let missing = || SnakeError::NoSuchForce {
            name: name.to_owned(),
        };
        let index = self.index_of(name).ok_or_else(missing)?;
        let old = std::mem::replace(&mut self.world.forces[index], acting);
        if let Err(error) = admit(&self.world, &self.body) {
            self.world.forces[index] = old;
            return Err(error);
        }
        self.note();
        Ok(old)
    }

    /// Hold these nodes fast, until [`Snake::release`]d: each loses its velocity with the next step. The soft form is
    /// [`Freeze`](crate::Freeze).
    ///
    /// # Errors
    ///
    /// Refused: a node that there is not; then nothing has changed.
    pub fn hold(&mut self, nodes: impl IntoIterator<Item = usize>) -> Result<(), SnakeError> {
        self.grasp(nodes, true)
    }

    /// Let go of these nodes. Ends that are pinned stay so.
    ///
    /// # Errors
    ///
    /// Refused: a node that there is not; then nothing has changed.
    pub fn release(&mut self, nodes: impl IntoIterator<Item = usize>) -> Result<(), SnakeError> {
        self.grasp(nodes, false)
    }

    /// A hand means to change something until the time `t`, like a schedule that has not ended: before that a
    /// snake that does not move waits, and is not called at rest. Minus infinity: no longer.
    pub const fn expect_changes_until(&mut self, t: f64) {
        self.expected = t;
    }

    fn grasp(
        &mut self,
        nodes: impl IntoIterator<Item = usize>,
        fast: bool,
    ) -> Result<(), SnakeError> {
        let before = self.grasped.clone();
        for node in nodes {
            let missing = SnakeError::NoSuchNode {
                node,
                nodes: before.len(),
            };
            match self.grasped.get_mut(node) {
                Some(grasped) => *grasped = fast,
                None => {
                    self.grasped = before;
                    return Err(missing);
                }
            }
        }
        self.hold_again()?;
        self.note();
        Ok(())
    }

    /// Form anew what depends on the nodes held.
    pub(crate) fn hold_again(&mut self) -> Result<(), SnakeError> {
        let mut held = self.body.topology.held(self.body.len());
        for (held, &grasped) in held.iter_mut().zip(&self.grasped) {
            *held |= grasped;
        }
        self.stiffness = operator(&self.body, &self.material, &self.weights, &held)?;
        self.any_held = held.contains(&true);
        self.held = held;
        Ok(())
    }

    /// Something changed: the schemes are to be told, and a ledger will ask.
    pub(crate) const fn note(&mut self) {
        self.revision += 1;
        self.note_quietly();
    }

    /// Something changed that is in no scheme's matrix.
    pub(crate) const fn note_quietly(&mut self) {
        self.edits += 1;
        self.asked_before = self.asked;
    }

    /// Be the snake `old` was, on other nodes: hold those that are mostly of held ones.
    pub(crate) fn follow(&mut self, old: &Self, plan: &Plan) -> Result<(), SnakeError> {
        self.stay(old);
        let last = self.body.len() - 1;
        for (node, rail) in &old.rails {
            // it is an end that slides, and ends stay ends
            let node = if *node == 0 { 0 } else { last };
            self.rails.push((node, rail.clone()));
        }
        let share = |node: usize| -> f64 {
            let held = |&&(from, _): &&(u32, f64)| old.grasped.get(from as usize) == Some(&true);
            let terms = plan.convex(node).iter().filter(held);
            terms.map(|(_, weight)| weight).sum()
        };
        self.hold((0..plan.len()).filter(|&node| share(node) > 0.5))
    }

    /// Whether no step has been made since the last change.
    pub(crate) const fn just_changed(&self) -> bool {
        self.asked == self.asked_before
    }

    fn index_of(&self, name: &str) -> Option<usize> {
        let mut forces = self.world.forces.iter();
        forces.position(|acting| acting.name() == name)
    }
}

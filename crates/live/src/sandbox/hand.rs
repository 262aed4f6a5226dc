//! The hand in a scene: it pulls by a spring, holds, pushes and throws.

use glam::DVec2;
use scene::elastic::Profile;
use scene::snake::{Acting, Edit, Freeze, Repulsor};

use super::{HAND, PUSH, Sandbox};
use crate::LiveError;

/// Share of the stiffness that the scheme's step allows a single node.
const SHARE: f64 = 0.2;

/// A snake that is pulled swings about the hand so many times in a second of looking.
const SWINGS: f64 = 2.0;

/// The hand takes hold of one part in so many of the nodes, to either side.
const STRETCH: usize = 10;

/// What the hand holds.
#[derive(Debug, Clone)]
pub(crate) struct Drag {
    pub snake: usize,
    pub node: usize,
    /// Where the node is pulled to.
    pub to: DVec2,
    /// The nodes that it holds, each with its way from the node.
    stretch: Vec<(usize, DVec2)>,
    /// How strongly it holds each node of the snake.
    weights: Vec<f64>,
}

impl Sandbox {
    /// Pull a node to a place, with the stretch about it as it is when the hand takes hold, and the rest of a closed
    /// curve more weakly: a single node of a soft curve would come alone.
    pub(super) fn drag(&mut self, id: usize, node: usize, to: DVec2) -> Result<(), LiveError> {
        let held = self
            .drag
            .as_ref()
            .filter(|drag| drag.snake == id && drag.node == node);
        let mut drag = match held {
            Some(held) => held.clone(),
            None => self.take(id, node)?,
        };
        let fresh = held.is_none();
        drag.to = to;
        let mut places = self.member(id)?.state().x.clone();
        for (i, offset) in &drag.stretch {
            places[*i] = to + *offset;
        }
        let (stiffness, damping) = self.grip(id, &drag.weights)?;
        let stretch = drag.stretch.iter().map(|(i, _)| *i);
        let hold = Freeze::new(&places, stretch, stiffness).map_err(LiveError::of)?;
        let acting = Acting::new(hold.with_damping(damping))
            .named(HAND)
            .weighted(Profile::PerNode(drag.weights.clone()));
        if fresh {
            self.drop()?;
            self.edit(id, Edit::Add(acting))?;
        } else {
            self.edit(id, Edit::Replace(acting))?;
        }
        self.drag = Some(drag);
        Ok(())
    }

    /// Take hold of a node and of the stretch about it, ever more weakly away from it.
    fn take(&self, id: usize, node: usize) -> Result<Drag, LiveError> {
        let member = self.member(id)?;
        let (x, n) = (&member.state().x, member.state().len());
        if node >= n {
            return Err(LiveError::new(format!(
                "snake {id} has {n} nodes, got node {node}"
            )));
        }
        let far = (n / STRETCH).max(1);
        let mut weights = vec![0.0; n];
        let mut stretch = Vec::new();
        for (i, weight) in weights.iter_mut().enumerate() {
            let away = node.abs_diff(i);
            let away = if member.is_closed() {
                away.min(n - away)
            } else {
                away
            };
            if away <= far {
                let share = away as f64 / (far + 1) as f64;
                *weight = (0.5 * std::f64::consts::PI * share).cos().powi(2);
            }
            // a ball lies in the hand as a whole; of a rope one end may stay behind
            if member.is_closed() {
                *weight = 0.25 + 0.75 * *weight;
            }
            if *weight > 0.0 {
                stretch.push((i, x[i] - x[node]));
            }
        }
        Ok(Drag {
            snake: id,
            node,
            to: x[node],
            stretch,
            weights,
        })
    }

    /// Stiffness and damping of the hand's springs: the whole snake follows as fast as an eye does, and the step stays
    /// stable.
    fn grip(&self, id: usize, weights: &[f64]) -> Result<(f64, f64), LiveError> {
        let member = self.member(id)?;
        let dt = self.simulation().stepping().dt;
        let body = member.snake().body();
        let masses = body.mass.to_vec(body.len());
        let least = masses.iter().copied().fold(f64::INFINITY, f64::min);
        let total = masses.iter().sum::<f64>() / weights.iter().sum::<f64>();
        let frequency = std::f64::consts::TAU * SWINGS / self.rate;
        let most = SHARE * 4.0 * least / (dt * dt);
        let stiffness = (total * frequency * frequency).min(most);
        let damping = (total * stiffness).sqrt().min(SHARE * least / dt);
        Ok((stiffness.max(f64::MIN_POSITIVE), damping))
    }

    /// Pull no longer.
    pub(super) fn drop(&mut self) -> Result<(), LiveError> {
        if let Some(Drag { snake: id, .. }) = self.drag.take()
            && self.member(id).is_ok()
        {
            self.edit(id, Edit::Remove(HAND.to_owned()))?;
        }
        Ok(())
    }

    /// Hold a node.
    pub(super) fn pin(&mut self, id: usize, node: usize) -> Result<(), LiveError> {
        self.edit(id, Edit::Hold(vec![node]))?;
        let pins = self.pins.entry(id).or_default();
        if !pins.contains(&node) {
            pins.push(node);
        }
        Ok(())
    }

    /// Let a node go.
    pub(super) fn unpin(&mut self, id: usize, node: usize) -> Result<(), LiveError> {
        self.edit(id, Edit::Release(vec![node]))?;
        if let Some(pins) = self.pins.get_mut(&id) {
            pins.retain(|pin| *pin != node);
        }
        Ok(())
    }

    /// Push everything away from a place.
    pub(super) fn push(&mut self, at: DVec2, reach: f64) -> Result<(), LiveError> {
        if !(reach.is_finite() && reach > 0.0) {
            return Err(LiveError::new(format!(
                "a push must reach farther than 0, got {reach}"
            )));
        }
        let (dt, rate, pushes) = (
            self.simulation().stepping().dt,
            self.rate,
            self.push.is_some(),
        );
        self.edit_all(|snake| {
            let n = snake.body().len();
            let masses = snake.body().mass.to_vec(n);
            let least = masses.iter().copied().fold(f64::INFINITY, f64::min);
            let mean = masses.iter().sum::<f64>() / n as f64;
            // across its reach in half a second of looking, within what the step allows
            let wanted = mean * reach * (4.0 / rate).powi(2);
            let strength = wanted.min(SHARE * least * reach / (dt * dt));
            let acting = Acting::new(Repulsor::new(at, reach, strength)).named(PUSH);
            let there = snake.world().names().any(|name| name == PUSH);
            Some(if pushes && there {
                Edit::Replace(acting)
            } else {
                Edit::Add(acting)
            })
        })?;
        self.push = Some((at, reach));
        Ok(())
    }

    /// Push no longer.
    pub(super) fn leave(&mut self) -> Result<(), LiveError> {
        if self.push.take().is_some() {
            self.edit_all(|snake| {
                let there = snake.world().names().any(|name| name == PUSH);
                there.then(|| Edit::Remove(PUSH.to_owned()))
            })?;
        }
        Ok(())
    }
}

//! What a user does to a curve between two steps.

use elastic::{Material, Profile};
use glam::DVec2;
use snake::{Acting, ImageForce, Sampling, SnakeError, Spring};

use crate::{FitError, OptionKey, Problem, Session};

/// What a user does to a curve between two steps.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Edit {
    /// Hold these nodes where they are.
    Hold(Vec<usize>),
    /// Let these nodes go.
    Release(Vec<usize>),
    /// Pull a node by a spring; a further pull takes its place.
    Pull {
        /// Which node.
        node: usize,
        /// To where. Pixels.
        to: DVec2,
        /// Stiffness of the spring. M L² T⁻².
        stiffness: f64,
    },
    /// Pull no longer.
    LetGo,
    /// Let the edge force pull with another strength, as
    /// [`Options::strength`](crate::Options::strength) says.
    Strength(f64),
    /// Give the curve another resistance.
    Material {
        /// As [`Options::tether`](crate::Options::tether).
        tether: f64,
        /// As [`Options::tension`](crate::Options::tension).
        tension: f64,
        /// As [`Options::rigidity`](crate::Options::rigidity).
        rigidity: f64,
    },
}

/// What the pulling spring is called.
const HAND: &str = "hand";

impl Session {
    /// Change something; the curve moves on from where it is, with all the steps there may be.
    ///
    /// # Errors
    ///
    /// By its key: a node that there is not, a number out of its range; then nothing has changed.
    pub fn edit(&mut self, edit: Edit) -> Result<(), FitError> {
        let refuse = |key: OptionKey| move |error: SnakeError| FitError::new(key, error);
        match edit {
            Edit::Hold(nodes) => self.snake.hold(nodes).map_err(refuse(OptionKey::Nodes))?,
            Edit::Release(nodes) => self
                .snake
                .release(nodes)
                .map_err(refuse(OptionKey::Nodes))?,
            Edit::Pull {
                node,
                to,
                stiffness,
            } => {
                if node >= self.state.len() {
                    let problem = Problem::Count {
                        least: 0,
                        most: self.state.len() as u64 - 1,
                        got: node as u64,
                    };
                    return Err(FitError::new(OptionKey::Nodes, problem));
                }
                if let Some(got) = to.to_array().into_iter().find(|c| !c.is_finite()) {
                    let needed = "finite";
                    return Err(FitError::new(
                        OptionKey::Pull,
                        Problem::Number { needed, got },
                    ));
                }
                let stiffness = Problem::above_zero(stiffness)
                    .map_err(|problem| FitError::new(OptionKey::Pull, problem))?;
                let spring = Acting::new(Spring::at_node(node, to, stiffness)).named(HAND);
                let before = self.snake.remove_force(HAND);
                if let Err(error) = self.snake.add_force(spring) {
                    if let Some(before) = before {
                        // it was there, so it is not refused
                        let _ = self.snake.add_force(before);
                    }
                    return Err(FitError::new(OptionKey::Pull, error));
                }
            }
            Edit::LetGo => drop(self.snake.remove_force(HAND)),
            Edit::Strength(strength) => self.pull_by(strength)?,
            Edit::Material {
                tether,
                tension,
                rigidity,
            } => {
                for (key, value) in [
                    (OptionKey::Tether, tether),
                    (OptionKey::Tension, tension),
                    (OptionKey::Rigidity, rigidity),
                ] {
                    Problem::at_least_zero(value).map_err(|problem| FitError::new(key, problem))?;
                }
                let material = Material::uniform(tether, tension, rigidity);
                let body = self.snake.body().clone().with_material(material);
                let set = self.snake.set_body(body);
                set.map_err(refuse(OptionKey::Rigidity))?;
            }
        }
        self.begin_again();
        Ok(())
    }

    /// The edge force with another strength.
    fn pull_by(&mut self, strength: f64) -> Result<(), FitError> {
        let strength = Problem::above_zero(strength)
            .map_err(|problem| FitError::new(OptionKey::Strength, problem))?;
        let Some(field) = self.prepared.field() else {
            let message = "is that of the edge force, and other forces were chosen";
            let problem = Problem::Other(message.to_owned());
            return Err(FitError::new(OptionKey::Strength, problem));
        };
        let weight = strength / self.prepared.options().strength;
        let force = ImageForce::new(field.clone(), Sampling::Bilinear);
        let acting = Acting::new(force).weighted(Profile::Uniform(weight));
        let replaced = self.snake.replace_force("image", acting);
        replaced.map_err(|error| FitError::new(OptionKey::Strength, error))?;
        Ok(())
    }
}

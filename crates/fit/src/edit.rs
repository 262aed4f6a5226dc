//! What a user does to a curve between two steps.

use elastic::{Material, Profile};
use glam::DVec2;
use snake::{Acting, ImageForce, Repulsor, Sampling, SimulationError, Spring};

use crate::force::PULL;
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
    /// Push nodes away from a place: as strongly as so many edges of the picture's contrast pull. A further push is one
    /// more.
    Push {
        /// From where. Pixels.
        from: DVec2,
        /// How far it is felt. Pixels.
        reach: f64,
        /// Against the pull of an edge.
        pulls: f64,
    },
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
        match edit {
            Edit::Hold(nodes) => self.change(OptionKey::Nodes, snake::Edit::Hold(nodes))?,
            Edit::Release(nodes) => self.change(OptionKey::Nodes, snake::Edit::Release(nodes))?,
            Edit::Pull {
                node,
                to,
                stiffness,
            } => {
                let nodes = self.nodes().len();
                if node >= nodes {
                    let problem = Problem::Count {
                        least: 0,
                        most: nodes as u64 - 1,
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
                let edit = if self.pulls() {
                    snake::Edit::Replace(spring)
                } else {
                    snake::Edit::Add(spring)
                };
                self.change(OptionKey::Pull, edit)?;
            }
            Edit::LetGo if self.pulls() => {
                self.change(OptionKey::Pull, snake::Edit::Remove(HAND.to_owned()))?;
            }
            Edit::LetGo => {}
            Edit::Push { from, reach, pulls } => {
                let numbers = [from.x, from.y, pulls];
                if let Some(got) = numbers.into_iter().find(|number| !number.is_finite()) {
                    let needed = "finite";
                    let problem = Problem::Number { needed, got };
                    return Err(FitError::new(OptionKey::Pull, problem));
                }
                let reach = Problem::above_zero(reach)
                    .map_err(|problem| FitError::new(OptionKey::Pull, problem))?;
                let push = Acting::new(Repulsor::new(from, reach, PULL * pulls));
                self.change(OptionKey::Pull, snake::Edit::Add(push))?;
            }
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
                let body = self.member().snake().body().clone().with_material(material);
                self.change(OptionKey::Rigidity, snake::Edit::Body(Box::new(body)))?;
            }
        }
        self.begin_again();
        Ok(())
    }

    /// Whether a pull acts.
    fn pulls(&self) -> bool {
        let mut names = self.member().snake().world().names();
        names.any(|name| name == HAND)
    }

    /// Change the curve; refusals are those of an option.
    fn change(&mut self, key: OptionKey, edit: snake::Edit) -> Result<(), FitError> {
        let id = self.member().id();
        let changed = self.simulation.edit(id, edit);
        changed.map_err(|error| match error {
            SimulationError::Snake(error) => FitError::new(key, error),
            error => FitError::new(key, Problem::Other(error.to_string())),
        })
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
        self.change(OptionKey::Strength, snake::Edit::Replace(acting))
    }
}

//! Kinds that look at the curve alone: pressures, springs, pushes.

use elastic::signed_area;
use fit::force::{ImageForceKind, Regions};
use snake::{Freeze, Path, Pressure, RegionForce, Repulsor, SnakeError, Spring};

use super::{Around, number};
use crate::SceneError;
use crate::file::{AreaText, DirectionText, FreezeText, PressureText, RepulsorText, SpringText};

impl Around<'_> {
    fn at(&self, name: &str) -> String {
        format!("{}: {name}", self.key)
    }

    fn refuse(&self) -> impl Fn(SnakeError) -> SceneError {
        let key = self.key.to_owned();
        move |error| SceneError::key(&key, error)
    }

    fn at_least_0(&self, name: &str, given: Option<f64>) -> Result<f64, SceneError> {
        match given {
            Some(value) if !(value.is_finite() && value >= 0.0) => {
                let message = format!("must be finite and at least 0, got {value}");
                Err(SceneError::key(&self.at(name), message))
            }
            given => Ok(given.unwrap_or(0.0)),
        }
    }

    pub(super) fn pressure(&self, text: &PressureText) -> Result<Pressure, SceneError> {
        let k = number::finite(&self.at("pressure"), text.pressure)?;
        match text.direction {
            None | Some(DirectionText::Given) => Ok(Pressure::constant(k)),
            Some(DirectionText::Picture) => {
                // what is like the inside is to be inside, wherever the edges are
                let regions = ImageForceKind::Regions(Regions::default());
                let judge = self.seen()?.region(&regions);
                let judge = judge.map_err(|error| SceneError::key(self.key, error.problem))?;
                let judge = judge.map(RegionForce::new);
                Ok(judge.map_or(Pressure::constant(k), |judge| Pressure::automatic(k, judge)))
            }
        }
    }

    /// Pressure and area of a gas or an area; that of the start unless given.
    pub(super) fn volume(&self, text: &AreaText) -> Result<(f64, f64), SceneError> {
        let k = number::above_zero(&self.at("pressure"), text.pressure)?;
        let area = match text.area {
            Some(area) => number::above_zero(&self.at("area"), area)?,
            None => {
                let area = signed_area(self.nodes).abs();
                if area.is_nan() || area <= 0.0 {
                    let message = "the start encloses nothing; needed: an area above 0";
                    return Err(SceneError::key(&self.at("area"), message));
                }
                area
            }
        };
        Ok((k, area))
    }

    /// A point that stays, or moves along `path`.
    fn place(
        &self,
        name: &str,
        point: Option<[f64; 2]>,
        path: Option<&Vec<[f64; 3]>>,
    ) -> Result<Path, SceneError> {
        match (point, path) {
            (Some(point), None) => Ok(number::place(&self.at(name), point)?.into()),
            (None, Some(list)) => {
                let key = self.at("path");
                let mut points = Vec::new();
                for &[t, x, y] in list {
                    points.push((t, number::place(&key, [x, y])?));
                }
                Path::new(points).map_err(|e| SceneError::key(&key, e))
            }
            _ => {
                let message = "needed: one of a place and a path, [[time, x, y], …]";
                Err(SceneError::key(&self.at(name), message))
            }
        }
    }

    pub(super) fn spring(&self, text: &SpringText) -> Result<Spring, SceneError> {
        let stiffness = number::above_zero(&self.at("stiffness"), text.stiffness)?;
        let damping = self.at_least_0("damping", text.damping)?;
        let target = self.place("to", text.to, text.path.as_ref())?;
        let spring = match (text.node, text.from) {
            (Some(node), None) => {
                if node >= self.nodes.len() {
                    let last = self.nodes.len() - 1;
                    let message = format!("there is no node {node}; needed: 0 to {last}");
                    return Err(SceneError::key(&self.at("node"), message));
                }
                Spring::at_node(node, target, stiffness)
            }
            (None, Some(from)) => {
                let from = number::place(&self.at("from"), from)?;
                Spring::at_nearest(self.nodes, self.closed, from, target, stiffness)
                    .map_err(self.refuse())?
            }
            _ => {
                let message = "needed: one of node and from, a place near the curve";
                return Err(SceneError::key(&self.at("node"), message));
            }
        };
        Ok(spring.with_damping(damping))
    }

    pub(super) fn repulsor(&self, text: &RepulsorText) -> Result<Repulsor, SceneError> {
        let center = self.place("at", text.at, text.path.as_ref())?;
        let reach = number::length(&self.at("reach"), text.reach)?;
        let push = number::finite(&self.at("push"), text.push)?;
        Ok(Repulsor::new(center, reach, push))
    }

    pub(super) fn freeze(&self, text: &FreezeText) -> Result<Freeze, SceneError> {
        let n = self.nodes.len();
        let [first, last] = text.stretch;
        let backwards = first > last && !self.closed;
        if first >= n || last >= n || backwards {
            let message = format!(
                "needed: [first, last] from 0 to {}, got [{first}, {last}]",
                n - 1
            );
            return Err(SceneError::key(&self.at("stretch"), message));
        }
        let stiffness = number::above_zero(&self.at("stiffness"), text.stiffness)?;
        let damping = self.at_least_0("damping", text.damping)?;
        // over the joint where the last lies before the first
        let count = (last + n - first) % n + 1;
        let nodes = (first..first + count).map(|i| i % n);
        let freeze = Freeze::new(self.nodes, nodes, stiffness).map_err(self.refuse())?;
        Ok(freeze.with_damping(damping))
    }

    /// Refuse an open curve under a kind that asks for an inside.
    pub(super) fn closed(&self, word: &str) -> Result<(), SceneError> {
        if self.closed {
            return Ok(());
        }
        let message = format!("{word} asks what is inside; needed: a closed curve");
        Err(SceneError::key(&self.at("kind"), message))
    }
}

//! A scene in motion, under the hand.

mod atlas;
mod bodies;
mod export;
mod field;
mod hand;
mod shape;
mod values;
mod view;
mod world;

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

pub(crate) use export::FORMATS;
use glam::DVec2;
use scene::snake::{Edit, Member, Outcome, Simulation, Snake};
use scene::{Course, Scene, SceneText};

use crate::request::Body;
use crate::{LiveError, Pair};
use hand::Drag;

/// Seconds that the run which a scene plans takes to look at.
const SECONDS: f64 = 12.0;

/// Force by which the hand pulls.
const HAND: &str = "hand of the user";
/// Force by which the hand pushes.
const PUSH: &str = "push of the user";

/// A scene in motion.
#[derive(Debug, Clone)]
pub(crate) struct Sandbox {
    /// What it was made of.
    scene: Arc<Scene>,
    /// Its text as it was opened.
    source: Arc<str>,
    course: Course,
    /// Time that passes in a second of looking. T.
    rate: f64,
    /// What the hand holds: a node of a snake, and where it is pulled to.
    drag: Option<Drag>,
    /// From where the hand pushes, and how far.
    push: Option<(DVec2, f64)>,
    /// Nodes of each snake that are held.
    pins: BTreeMap<usize, Vec<usize>>,
    /// Why it cannot go on.
    end: Option<End>,
}

/// Why a scene cannot go on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct End {
    pub words: String,
    /// Which node, where one is to blame, and where it is.
    pub node: Option<(usize, DVec2)>,
}

impl Sandbox {
    /// A scene of that text.
    pub(crate) fn open(text: &SceneText) -> Result<Self, LiveError> {
        let scene = text.scene().map_err(LiveError::of)?;
        // a run of one long step has no moments to look at
        if scene.plan.each {
            return Err(LiveError::new(
                "steps that the program chooses for the whole run leave no moments to be seen; needed: run.dt as a number",
            ));
        }
        let course = scene.course(true).map_err(LiveError::of)?;
        let span = scene.plan.until.steps as f64 * scene.plan.dt;
        let span = scene.plan.until.time.map_or(span, |time| time.min(span));
        let rate = if span > 0.0 { span / SECONDS } else { 1.0 };
        Ok(Self {
            scene: Arc::new(scene),
            source: text.to_string().into(),
            course,
            rate,
            drag: None,
            push: None,
            pins: BTreeMap::new(),
            end: None,
        })
    }

    /// The scene as it was at the start.
    pub(crate) fn again(&self) -> Result<Self, LiveError> {
        let course = self.scene.course(true).map_err(LiveError::of)?;
        Ok(Self {
            course,
            drag: None,
            push: None,
            pins: BTreeMap::new(),
            end: None,
            ..self.clone()
        })
    }

    /// The picture it lives in.
    pub(crate) fn picture(&self) -> Option<&Arc<io::Picture>> {
        self.scene.picture.as_ref()
    }

    /// Its text as it was opened.
    pub(crate) fn source(&self) -> &str {
        &self.source
    }

    /// Steps in a second of looking.
    pub(crate) fn pace(&self) -> f64 {
        self.rate / self.simulation().stepping().dt
    }

    pub(crate) fn steps(&self) -> u64 {
        self.simulation().steps()
    }

    pub(crate) const fn simulation(&self) -> &Simulation {
        self.course.simulation()
    }

    pub(crate) const fn end(&self) -> Option<&End> {
        self.end.as_ref()
    }

    /// One step; false where none can be made.
    pub(crate) fn step(&mut self) -> bool {
        if self.end.is_some() {
            return false;
        }
        let ended = match self.course.step() {
            Ok(ControlFlow::Continue(())) => {
                if !self.simulation().members().is_empty() {
                    return true;
                }
                End {
                    words: "nothing is left that could move".to_owned(),
                    node: None,
                }
            }
            Ok(ControlFlow::Break(outcome)) => self.broken(outcome),
            Err(error) => End {
                words: error.to_string(),
                node: None,
            },
        };
        self.end = Some(ended);
        false
    }

    /// What an outcome says, and where.
    fn broken(&self, outcome: Outcome) -> End {
        let node = match outcome {
            Outcome::Diverged { node, .. } => {
                let mut members = self.simulation().members().iter();
                // the state before the step that could not be made
                members
                    .find_map(|member| member.state().x.get(node).copied())
                    .map(|at| (node, at))
            }
            Outcome::LeftField { node, at, .. } => Some((node, at)),
            _ => None,
        };
        End {
            words: outcome.to_string(),
            node,
        }
    }

    /// Make a change.
    pub(crate) fn act(&mut self, change: &Body) -> Result<(), LiveError> {
        let done = match change {
            Body::Drag { snake, node, to } => self.drag(*snake, *node, place(*to)?),
            Body::Drop => self.drop(),
            Body::Pin { snake, node } => self.pin(*snake, *node),
            Body::Unpin { snake, node } => self.unpin(*snake, *node),
            Body::Push { at, reach } => self.push(place(*at)?, *reach),
            Body::Leave => self.leave(),
            Body::Throw { snake, velocity } => self.throw(*snake, place(*velocity)?),
            Body::Ball { points } => self.ball(points),
            Body::Delete { snake } => self.delete(*snake),
            Body::Gravity { g } => self.gravity(place(*g)?),
            Body::Wall {
                index,
                point,
                normal,
            } => self.wall(*index, place(*point)?, place(*normal)?),
            Body::NoWall { index } => self.no_wall(*index),
            Body::Set { key, value, snake } => self.set(key, *value, *snake),
            Body::Plane {
                mass,
                damping,
                snake,
            } => self
                .set("mass", *mass, *snake)
                .and_then(|()| self.set("damping", *damping, *snake)),
            Body::Stepping { scheme, dt } => self.stepping(scheme.as_deref(), *dt),
            Body::Contact { on } => self.contact(*on),
        };
        // another world may let it go on
        if done.is_ok() {
            self.end = None;
        }
        done
    }

    /// The snake of that number.
    fn member(&self, id: usize) -> Result<&Member, LiveError> {
        let mut members = self.simulation().members().iter();
        members
            .find(|member| member.id() == id)
            .ok_or_else(|| LiveError::new(format!("there is no snake {id}")))
    }

    /// The snake of that number, or the first.
    fn member_or_first(&self, id: Option<usize>) -> Result<&Member, LiveError> {
        match id {
            Some(id) => self.member(id),
            None => {
                let first = self.simulation().members().first();
                first.ok_or_else(|| LiveError::new("there is no snake"))
            }
        }
    }

    fn ids(&self) -> Vec<usize> {
        let members = self.simulation().members().iter();
        members.map(Member::id).collect()
    }

    /// Make this edit of every snake; nothing has changed where one is refused.
    fn edit_all(&mut self, edit: impl Fn(&Snake) -> Option<Edit>) -> Result<(), LiveError> {
        let mut course = self.course.clone();
        for id in self.ids() {
            if let Some(edit) = edit(self.member(id)?.snake()) {
                course
                    .simulation_mut()
                    .edit(id, edit)
                    .map_err(LiveError::of)?;
            }
        }
        self.course = course;
        Ok(())
    }

    fn edit(&mut self, id: usize, edit: Edit) -> Result<(), LiveError> {
        let simulation = self.course.simulation_mut();
        simulation.edit(id, edit).map_err(LiveError::of)
    }

    /// Everything that tells two scenes apart, as bytes.
    pub(crate) fn bytes(&self, out: &mut Vec<u8>) {
        out.extend(self.source.as_bytes());
        out.extend(self.simulation().steps().to_le_bytes());
        for member in self.simulation().members() {
            out.extend(member.id().to_le_bytes());
            let state = member.state();
            for p in state.x.iter().chain(&state.v) {
                out.extend(p.x.to_le_bytes());
                out.extend(p.y.to_le_bytes());
            }
            let body = member.snake().body();
            out.extend(format!("{:?}{:?}{:?}", body.material, body.mass, body.damping).as_bytes());
            out.extend(format!("{:?}", member.snake().world()).as_bytes());
        }
        out.extend(format!("{:?}", self.simulation().stepping()).as_bytes());
        out.extend(
            format!(
                "{:?}{:?}{:?}{:?}",
                self.drag, self.push, self.pins, self.end
            )
            .as_bytes(),
        );
    }
}

/// A pair of numbers as a place or a way.
pub(crate) fn place(pair: Pair) -> Result<DVec2, LiveError> {
    let place = DVec2::from_array(pair);
    let far = io::limits::FARTHEST;
    if place.is_finite() && place.abs().max_element() <= far {
        return Ok(place);
    }
    let [x, y] = pair;
    Err(LiveError::new(format!(
        "a place must be within {far} of the origin, got ({x}, {y})"
    )))
}

//! Forces and holds that come and go during a run, as an observer's hand would bring and take them.

use integrator::State;
use snake::{Acting, Snake};

use crate::SceneError;
use crate::file::ForceText;
use crate::meaning::force_now;

/// The hands of a scene: forces and holds, each from one time until another. [`Scene::run`](crate::Scene::run) lets them
/// take hold and let go after the steps whose times these are; the default has none.
///
/// A hand looks at the curve when it takes hold: a spring is at the point of the curve nearest *then*, frozen nodes stay where they are
/// *then*. Whoever wants more gives [`snake::run`] an observer, which may change the snake as it likes.
#[derive(Debug, Clone, Default)]
pub struct Hand {
    grips: Vec<Grip>,
    closed: bool,
    /// Which of them have hold.
    active: Vec<bool>,
}

#[derive(Debug, Clone)]
pub(crate) struct Grip {
    pub from: f64,
    pub until: f64,
    pub held: Held,
}

#[derive(Debug, Clone)]
pub(crate) enum Held {
    Nodes(Vec<usize>),
    Force {
        /// Under the name it has in the world.
        text: Box<ForceText>,
        /// What stands in its place while it does nothing.
        idle: Acting,
        /// What it would be on the curve at the start: as stiff as it will be.
        full: Box<Acting>,
    },
}

impl Hand {
    pub(crate) fn of(grips: Vec<Grip>, closed: bool) -> Self {
        let active = vec![false; grips.len()];
        Self {
            grips,
            closed,
            active,
        }
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.grips.is_empty()
    }

    /// Let all forces of all hands act at once, for step limits.
    pub(crate) fn take_all(&self, snake: &mut Snake) {
        for grip in &self.grips {
            if let Held::Force { full, .. } = &grip.held {
                // it has the name and the place of one that passed at the door
                let _ = replace(snake, Acting::clone(full));
            }
        }
    }

    /// When the last of them has come, and gone if it goes.
    pub(crate) fn end(&self) -> f64 {
        let times = self.grips.iter().flat_map(|grip| [grip.from, grip.until]);
        times
            .filter(|t| t.is_finite())
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// Let go and take hold where it is time; what was done, in words.
    pub(crate) fn act(
        &mut self,
        snake: &mut Snake,
        state: &State,
        slack: f64,
    ) -> Result<Vec<String>, SceneError> {
        let mut said = Vec::new();
        let now = state.t + slack;
        for i in 0..self.grips.len() {
            if self.active[i] && now >= self.grips[i].until {
                self.active[i] = false;
                self.let_go(snake, i)?;
                said.push(self.say(state.t, i, "lets go of"));
            }
        }
        for i in 0..self.grips.len() {
            let grip = &self.grips[i];
            if !self.active[i] && now >= grip.from && now < grip.until {
                match &grip.held {
                    Held::Nodes(nodes) => hold(snake, nodes, true)?,
                    Held::Force { text, idle, .. } => self.put(snake, text, idle, state)?,
                }
                self.active[i] = true;
                said.push(self.say(state.t, i, "takes hold of"));
            }
        }
        Ok(said)
    }

    fn let_go(&self, snake: &mut Snake, i: usize) -> Result<(), SceneError> {
        match &self.grips[i].held {
            Held::Nodes(nodes) => {
                hold(snake, nodes, false)?;
                // what others hold as well stays held
                for (grip, active) in self.grips.iter().zip(&self.active) {
                    if let (Held::Nodes(nodes), true) = (&grip.held, active) {
                        hold(snake, nodes, true)?;
                    }
                }
                Ok(())
            }
            Held::Force { idle, .. } => replace(snake, idle.clone()),
        }
    }

    /// Put the force in its place, found anew from the curve.
    fn put(
        &self,
        snake: &mut Snake,
        text: &ForceText,
        idle: &Acting,
        state: &State,
    ) -> Result<(), SceneError> {
        let acting = force_now(text, &state.x, self.closed)?;
        replace(snake, acting.unwrap_or_else(|| idle.clone()))
    }

    fn say(&self, t: f64, i: usize, does: &str) -> String {
        let what = match &self.grips[i].held {
            Held::Nodes(nodes) => match nodes[..] {
                [one] => format!("node {one}"),
                _ => format!("{} nodes", nodes.len()),
            },
            Held::Force { idle, .. } => format!("the curve, {}", idle.name()),
        };
        format!("t = {t:.4}: hand {i} {does} {what}")
    }
}

fn hold(snake: &mut Snake, nodes: &[usize], fast: bool) -> Result<(), SceneError> {
    let nodes = nodes.iter().copied();
    let done = if fast {
        snake.hold(nodes)
    } else {
        snake.release(nodes)
    };
    done.map_err(|e| SceneError::key("hand", e))
}

fn replace(snake: &mut Snake, acting: Acting) -> Result<(), SceneError> {
    let name = acting.name().to_owned();
    let old = snake.replace_force(&name, acting);
    old.map(|_| ()).map_err(|e| SceneError::key("hand", e))
}

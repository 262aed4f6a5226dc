//! Forces and holds that come and go during a run, as an observer's hand would bring and take them.

use integrator::State;
use snake::{Acting, Edit, Snake};

use crate::SceneError;
use crate::file::ForceText;
use crate::meaning::force_now;

/// The hands of a scene: forces and holds, each on one snake, from one time until another.
/// [`Scene::run`](crate::Scene::run) lets them take hold and let go after the steps whose times these are; the
/// default has none.
///
/// A hand looks at the curve when it takes hold: a spring is at the point of the curve nearest *then*, frozen nodes stay where they are
/// *then*. An observer of [`snake::Simulation::run`] may make any [`Edit`].
#[derive(Debug, Clone, Default)]
pub struct Hand {
    grips: Vec<Grip>,
    /// Which of them have hold.
    active: Vec<bool>,
}

#[derive(Debug, Clone)]
pub(crate) struct Grip {
    /// Whose curve, and whether it is closed.
    pub snake: usize,
    pub closed: bool,
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
        /// What stands in its place while it does nothing; None where its place is empty then.
        idle: Option<Acting>,
        /// What it would be on the curve at the start: as stiff as it will be.
        full: Box<Acting>,
    },
}

/// A change that a hand makes: of which snake, what, and in words.
pub(crate) type Deed = (usize, Edit, String);

impl Hand {
    pub(crate) fn of(grips: Vec<Grip>) -> Self {
        let active = vec![false; grips.len()];
        Self { grips, active }
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.grips.is_empty()
    }

    /// Let all forces of all hands on snake number `index` act at once, for step limits.
    pub(crate) fn take_all(&self, index: usize, snake: &mut Snake) {
        for grip in self.grips.iter().filter(|grip| grip.snake == index) {
            if let Held::Force { full, idle, .. } = &grip.held {
                // it has the name and the place of one that was accepted
                let full = Acting::clone(full);
                let _ = match idle {
                    Some(_) => snake
                        .replace_force(full.name().to_owned().as_str(), full)
                        .map(|_| ()),
                    None => snake.add_force(full),
                };
            }
        }
    }

    /// Whether any of them acts on that snake.
    pub(crate) fn acts_on(&self, index: usize) -> bool {
        self.grips.iter().any(|grip| grip.snake == index)
    }

    /// When the last of them has come, and gone if it goes.
    pub(crate) fn end(&self) -> f64 {
        let times = self.grips.iter().flat_map(|grip| [grip.from, grip.until]);
        times
            .filter(|t| t.is_finite())
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// Let go and take hold where it is time, at `t`: what is to be done. `of` says where a snake is, if it is there.
    pub(crate) fn act<'a>(
        &mut self,
        t: f64,
        slack: f64,
        of: impl Fn(usize) -> Option<&'a State>,
    ) -> Result<Vec<Deed>, SceneError> {
        let mut deeds = Vec::new();
        let now = t + slack;
        for i in 0..self.grips.len() {
            if self.active[i] && now >= self.grips[i].until {
                self.active[i] = false;
                if of(self.grips[i].snake).is_some() {
                    let edit = self.let_go(i);
                    deeds.push((self.grips[i].snake, edit, self.say(t, i, "lets go of")));
                }
            }
        }
        for i in 0..self.grips.len() {
            let grip = &self.grips[i];
            let comes = !self.active[i] && now >= grip.from && now < grip.until;
            let Some(state) = of(grip.snake).filter(|_| comes) else {
                continue;
            };
            let edit = match &grip.held {
                Held::Nodes(nodes) => Edit::Hold(nodes.clone()),
                Held::Force { text, idle, .. } => {
                    // found anew from the curve
                    let acting = force_now(text, &state.x, grip.closed)?;
                    match (acting, idle) {
                        (Some(acting), Some(_)) => Edit::Replace(acting),
                        (Some(acting), None) => Edit::Add(acting),
                        (None, Some(idle)) => Edit::Replace(idle.clone()),
                        (None, None) => continue,
                    }
                }
            };
            self.active[i] = true;
            deeds.push((self.grips[i].snake, edit, self.say(t, i, "takes hold of")));
        }
        Ok(deeds)
    }

    /// How hand `i` lets go.
    fn let_go(&self, i: usize) -> Edit {
        match &self.grips[i].held {
            Held::Nodes(nodes) => {
                // what others hold as well stays held
                let snake = self.grips[i].snake;
                let held = |node: &usize| {
                    let mut others = self.grips.iter().zip(&self.active);
                    others.any(|(grip, active)| match &grip.held {
                        Held::Nodes(nodes) => {
                            *active && grip.snake == snake && nodes.contains(node)
                        }
                        Held::Force { .. } => false,
                    })
                };
                Edit::Release(nodes.iter().copied().filter(|node| !held(node)).collect())
            }
            Held::Force {
                idle: Some(idle), ..
            } => Edit::Replace(idle.clone()),
            Held::Force { full, .. } => Edit::Remove(full.name().to_owned()),
        }
    }

    fn say(&self, t: f64, i: usize, does: &str) -> String {
        let grip = &self.grips[i];
        let whose = match grip.snake {
            0 => String::new(),
            snake => format!(" of snake {snake}"),
        };
        let what = match &grip.held {
            Held::Nodes(nodes) => match nodes[..] {
                [one] => format!("node {one}{whose}"),
                _ => format!("{} nodes{whose}", nodes.len()),
            },
            Held::Force { full, .. } => format!("the curve{whose}, {}", full.name()),
        };
        format!("t = {t:.4}: hand {i} {does} {what}")
    }
}

//! A situation ready to run: a snake, its start, and the plan of the run.

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

use field::ForceField;
use glam::DVec2;
use integrator::{Scheme, SchemeError, Start, State};
use snake::{Certificate, Snake, Term, Tips, Until};

use crate::company::Company;
use crate::hand::Hand;
use crate::limits::{MOST_KEPT, MOST_STEPS};
use crate::meaning::{USUAL_TOLERANCE, number};
use crate::{Picture, SceneError, SceneText};

/// How a drawing should look at a scene.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct View {
    /// Whether y grows upwards on the page (chapter 2) or downwards (pictures).
    pub y_up: bool,
    /// The corners of what should be seen; everything when not given.
    pub window: Option<(DVec2, DVec2)>,
}

/// What a run keeps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recording {
    /// Every so many steps, counted from 0.
    pub every: Option<u64>,
    /// And at these steps.
    pub steps: Vec<u64>,
    /// Keep velocities too.
    pub velocities: bool,
    /// Keep energies too.
    pub energies: bool,
}

impl Recording {
    /// The same with its steps in order: what [`Recording::keeps`] needs.
    pub(crate) fn sorted(&self) -> Self {
        let mut sorted = self.clone();
        sorted.steps.sort_unstable();
        sorted
    }

    pub(crate) fn keeps(&self, step: u64) -> bool {
        self.every
            .is_some_and(|every| step.is_multiple_of(every.max(1)))
            || self.steps.binary_search(&step).is_ok()
    }

    /// Points and velocities that a run of `steps` steps of `n` nodes would keep at most.
    fn kept(&self, steps: u64, n: usize) -> u64 {
        let moments = self.every.map_or(0, |every| steps / every.max(1));
        let listed = (self.steps.len() as u64).min(steps);
        let each = (n as u64).saturating_mul(1 + u64::from(self.velocities));
        moments
            .saturating_add(listed)
            .saturating_add(2)
            .saturating_mul(each)
    }
}

/// How to run a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Which scheme.
    pub scheme: Scheme,
    /// The step. T.
    pub dt: f64,
    /// Make every step in as many sub-steps as it takes for each to err by at most so many pixels; None for
    /// steps of `dt` as they are.
    pub tolerance: Option<f64>,
    /// Whether every such sub-step is a step of its own; `dt` is then the time of the whole run.
    pub each: bool,
    /// When to stop.
    pub until: Until,
    /// How the first step is begun (D19).
    pub start_rule: Start,
    /// Whether a step beyond the limit is made all the same.
    pub force: bool,
    /// What to keep.
    pub recording: Recording,
}

impl Plan {
    /// Let the program choose the steps: a plan of equal ones becomes one that takes as long, in steps of their own
    /// length where snakes meet (`shared`), and else with every sub-step a step of its own. A plan that has chosen steps stays.
    pub fn choose_steps(&mut self, shared: bool) {
        if self.tolerance.is_some() {
            return;
        }
        self.tolerance = Some(USUAL_TOLERANCE);
        if !shared {
            let time = self.until.steps as f64 * self.dt;
            self.each = true;
            self.dt = time;
            self.until.steps = MOST_STEPS;
            self.until.time = Some(time);
        }
    }

    /// Take steps of another length: the run takes as long as before, and what is kept is kept at the nearest times.
    /// A step that is not finite and above 0 is stored unchanged; [`Scene::check`] refuses it.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at least 0, and a number beyond u64 becomes the largest"
    )]
    pub fn set_step(&mut self, dt: f64) {
        let ratio = if dt.is_finite() && dt > 0.0 {
            self.dt / dt
        } else {
            1.0
        };
        let scaled = |steps: u64| (steps as f64 * ratio).round() as u64;
        self.until.steps = scaled(self.until.steps);
        self.recording.every = self.recording.every.map(|every| scaled(every).max(1));
        for step in &mut self.recording.steps {
            *step = scaled(*step);
        }
        (self.dt, self.tolerance) = (dt, None);
    }

    /// Steps that a run of `n` nodes may make before its record is too long.
    pub(crate) fn room(&self, n: usize) -> u64 {
        let most = self.until.steps;
        if self.recording.kept(most, n) <= MOST_KEPT {
            return most;
        }
        let each = MOST_KEPT / self.recording.kept(1, n).max(1);
        most.min(each.saturating_mul(self.recording.every.unwrap_or(1)))
    }
}

/// A situation: what the text of a scene describes.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The name it is called by.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// Where in the report it belongs.
    pub report: Option<String>,
    /// More words for people.
    pub note: Option<String>,
    /// How to look at it.
    pub view: View,
    /// The picture it lives in.
    pub picture: Option<Arc<Picture>>,
    /// That picture's force field.
    pub field: Option<Arc<ForceField>>,
    /// The snake.
    pub snake: Snake,
    /// The inertial forces of a frame that turns by its own equation (report §5.2); None for any other frame.
    pub terms: Option<Vec<Term>>,
    /// Ends that grow, and after how many steps each time.
    pub tips: Option<(Tips, u64)>,
    /// Forces and holds that come and go.
    pub hand: Hand,
    /// Whom it shares its world with, and how curves are kept in order.
    pub company: Option<Company>,
    /// Where it starts, and how fast.
    pub start: State,
    /// How to run it.
    pub plan: Plan,
    /// The least distance of two edges that the smoothing of the picture keeps apart, if known. Pixels.
    pub resolves: Option<f64>,
    /// What people should know of it though nothing is refused.
    pub notes: Vec<String>,
    /// The files that it was read from, as far as they are known: no result may take their place.
    pub inputs: Vec<PathBuf>,
}

impl Scene {
    /// A scene that comes with the program.
    ///
    /// # Errors
    ///
    /// [`SceneError::UnknownScene`] with the nearest name.
    pub fn named(name: &str) -> Result<Self, SceneError> {
        SceneText::named(name)?.scene()
    }

    /// A scene from a file, or from standard input for `-`.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, or whatever [`Scene::parse`] refuses, by the file's name.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        SceneText::load(path)?.scene()
    }

    /// A scene from text; files that it names are looked for in `folder`.
    ///
    /// # Errors
    ///
    /// Text that is no TOML, an unknown key (with the nearest known one), a missing key, a value
    /// that will not do: each by its key or line.
    pub fn parse(name: &str, text: &str, folder: &Path) -> Result<Self, SceneError> {
        SceneText::parse(name, text, folder)?.scene()
    }

    /// Largest stable step of the scene's scheme wherever the curve may go and at all times of the run; `None` if any
    /// is stable. What [`Scene::check`] refuses by, and what [`snake::Certificate`] says.
    #[must_use]
    pub fn step_limit(&self) -> Option<f64> {
        Certificate::limit(&self.of_the_run(), self.plan.scheme).map(|limit| limit.dt)
    }

    /// What has no effect under the scheme that the plan names.
    pub(crate) fn remarks(&self) -> Vec<String> {
        let mut starts = vec![&self.start];
        if let Some(company) = &self.company {
            starts.extend(company.others.iter().map(|(_, start)| start));
        }
        let moves = |start: &&State| start.v.iter().any(|v| *v != DVec2::ZERO);
        let mut remarks = Vec::new();
        if self.plan.scheme == Scheme::GradientFlow && starts.iter().any(moves) {
            remarks.push(
                "gradient-flow has no inertia: the velocity given at the start has no effect"
                    .to_owned(),
            );
        }
        remarks
    }

    /// The snake, told when it is to run.
    #[must_use]
    pub fn of_the_run(&self) -> Snake {
        let mut snake = self.snake.clone();
        let (from, to) = self.span();
        snake.run_between(from, to);
        self.hand.take_all(0, &mut snake);
        snake
    }

    /// When the run begins, and when it ends at the latest.
    pub(crate) fn span(&self) -> (f64, f64) {
        let (plan, begin) = (&self.plan, self.start.t);
        let end = match plan.until.time {
            Some(time) if plan.each => time,
            Some(time) => time.min(begin + plan.until.steps as f64 * plan.dt),
            None => begin + plan.until.steps as f64 * plan.dt,
        };
        (begin, end)
    }

    /// Whether the plan can be carried out: what [`Scene::run`] asks before the first step.
    ///
    /// # Errors
    ///
    /// A step beyond the limit unless the plan forces it, densities that the scheme cannot move,
    /// more steps or a larger record than can be meant; by the key.
    pub fn check(&self) -> Result<(), SceneError> {
        let plan = &self.plan;
        if plan.until.steps > MOST_STEPS {
            let message = format!("must be at most {MOST_STEPS}, got {}", plan.until.steps);
            return Err(SceneError::key("run.steps", message));
        }
        let n = self.snake.body().len();
        let kept = plan.recording.kept(plan.until.steps, n);
        // how many sub-steps there will be is not known yet
        if kept > MOST_KEPT && !plan.each {
            let message =
                format!("would keep {kept} points; needed: at most {MOST_KEPT}, so fewer moments");
            return Err(SceneError::key("record.every", message));
        }
        let maps = &self.snake.body().maps;
        if !maps.is_empty() && matches!(plan.scheme, Scheme::Exact | Scheme::Etd2) {
            let message = format!(
                "{} finds all modes of the curve beforehand, and maps change them at every step; needed: leapfrog or newmark",
                plan.scheme.name()
            );
            return Err(SceneError::key("run.scheme", message));
        }
        // before the limit, which is zero without mass
        if plan.scheme != Scheme::GradientFlow
            && let Some(node) = self
                .snake
                .body()
                .mass
                .to_vec(n)
                .iter()
                .position(|&m| m <= 0.0)
        {
            let message = format!(
                "{} needs mass above 0 at every node, node {node} has none; gradient-flow does not",
                plan.scheme.name()
            );
            return Err(SceneError::key("densities.mass", message));
        }
        if let Some(tolerance) = plan.tolerance {
            number::above_zero("run.tolerance", tolerance)?;
            if let Some(own) = plan.scheme.parameter()
                && matches!(plan.scheme, Scheme::DormandPrince { .. })
                && Scheme::from_str(plan.scheme.name()).is_ok_and(|usual| usual != plan.scheme)
            {
                let message = format!(
                    "chosen steps are held to run.tolerance = {tolerance} pixels, so dormand-prince must have no tolerance of its \
                     own, got {own}"
                );
                return Err(SceneError::key("run.scheme", message));
            }
            self.check_substeps()?;
            if self.company.is_some() && plan.each {
                let message = "snakes that meet are written at times they share; needed: a time between steps";
                return Err(SceneError::key("run.output", message));
            }
            if maps.every > 0.0 {
                let message = "steps that are tried and made again would look again as well; needed: 0, at every step";
                return Err(SceneError::key("maps.every", message));
            }
            if plan.scheme == Scheme::Report {
                let message = "the scheme report keeps one step: its velocity and its damping are differences over it, \
                               and would jump with it; needed: leapfrog, which is the same motion";
                return Err(SceneError::key("run.scheme", message));
            }
            if self.tips.is_some() {
                let message = "\"auto\" is for curves of as many nodes; needed: a number";
                return Err(SceneError::key("run.dt", message));
            }
            if self.terms.is_some() {
                let message =
                    "\"auto\" is for frames without an equation of their own; needed: a number";
                return Err(SceneError::key("run.dt", message));
            }
        }
        // sub-steps stay below the limit by themselves
        let force = plan.force || plan.tolerance.is_some();
        let check = |snake: &Snake| {
            let checked = snake.check_step(plan.scheme, plan.dt, force);
            checked.map_err(|e| refused_step(&e))
        };
        check(&self.of_the_run())?;
        let others = self.company.iter().flat_map(|company| &company.others);
        for (k, (snake, _)) in others.enumerate() {
            if self.hand.acts_on(k + 1) {
                let mut snake = snake.clone();
                self.hand.take_all(k + 1, &mut snake);
                check(&snake)?;
            }
        }
        Ok(())
    }
}

/// An error of the scheme, under the key it belongs to.
pub(crate) fn refused_step(error: &SchemeError) -> SceneError {
    let key = match error {
        SchemeError::BadStep { .. }
        | SchemeError::AboveLimit { .. }
        | SchemeError::BeyondNumbers { .. } => return SceneError::Step(error.to_string()),
        SchemeError::BadMass { .. } => "densities.mass",
        SchemeError::BadDamping { .. } => "densities.damping",
        SchemeError::BadStart { .. } => "snake.start",
        _ => "run.scheme",
    };
    SceneError::key(key, error)
}

//! What can be said of a snake before it moves: frequencies, largest steps, damping, time to rest.

use std::fmt;

use glam::DVec2;
use integrator::{Fault, Limit, Scheme, State, System};

use crate::modes::{ModeOfMotion, fastest, free, modes};
use crate::{Acting, ImageForce, Pull, RegionForce, SignedEdgeForce, Snake};

/// Rest: a deformation has fallen to this share of what it was.
const REST: f64 = 0.01;

/// What a snake's parameters say about its motion, before a step is made.
///
/// ```text
/// elastic   ω = √λ,   K u = λ M u
/// image     ω = √(κ/μ),   κ: how steeply a picture pushes back, −∂F/∂x
/// contact   ω = √(k/μ),   k: stiffness of penalty walls
/// ```
///
/// Parameters are those of the time the snake stands at (and of the place, where a state is given). Modes are exact where γ/μ is the same at every
/// node, and of first order in its differences otherwise. O(n log n) for a closed curve of equal
/// nodes, O(n³) for others up to 400 nodes, and beyond only the slowest and the fastest: O(n).
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate {
    /// Nodes.
    pub nodes: usize,
    /// Highest frequency of the elastic force. T⁻¹. Infinite for a node without mass.
    pub elastic: f64,
    /// Highest frequency about an edge of a picture. T⁻¹. 0 without a picture.
    pub image: f64,
    /// The slope κ behind it. M T⁻².
    pub image_slope: f64,
    /// Highest frequency at a penalty wall. T⁻¹. 0 without one.
    pub contact: f64,
    /// The largest step of each scheme of [`Scheme::ALL`], image and contacts counted; None where
    /// no step is too large.
    pub steps: Vec<(Scheme, Option<f64>)>,
    /// Whether that holds wherever the nodes go and whatever schedules say during the run, or only for
    /// forces as they are at one state.
    pub anywhere: bool,
    /// All modes from the slowest up; or those that nothing brings back, the slowest of the others,
    /// and the fastest (see
    /// [`Certificate::complete`]).
    pub modes: Vec<ModeOfMotion>,
    /// Whether `modes` are all of them.
    pub complete: bool,
}

impl Certificate {
    /// Ask a snake. With a state, the picture's slope is taken at its nodes; without, it is the
    /// steepest anywhere in the picture, O(pixels), and parameters that change with place are those that ask for the
    /// shortest steps.
    #[must_use]
    pub fn of(snake: &Snake, state: Option<&State>) -> Self {
        if state.is_some() {
            return Self::as_it_is(snake, state);
        }
        let hardest = snake.at_its_hardest();
        let first = hardest.first().filter(|_| !snake.body().maps.is_empty());
        let mut one = Self::as_it_is(first.unwrap_or(snake), None);
        for other in &hardest {
            let other = Self::bounds(other, None);
            one.elastic = one.elastic.max(other.elastic);
            one.image = one.image.max(other.image);
            one.contact = one.contact.max(other.contact);
            for ((_, limit), (_, other)) in one.steps.iter_mut().zip(other.steps) {
                *limit = match (*limit, other) {
                    (Some(a), Some(b)) => Some(a.min(b)),
                    (a, b) => a.or(b),
                };
            }
        }
        one
    }

    fn as_it_is(snake: &Snake, state: Option<&State>) -> Self {
        let (modes, complete) = modes(snake);
        Self {
            modes,
            complete,
            ..Self::bounds(snake, state)
        }
    }

    /// All but the modes.
    fn bounds(snake: &Snake, state: Option<&State>) -> Self {
        let least = free(snake, snake.mass()).fold(f64::INFINITY, f64::min);
        let frequency = |stiffness: f64| (stiffness / least).sqrt();
        let pull = felt(snake, state, |_| true);
        // what a slope at each node by itself does not hold
        let between = felt(snake, state, Acting::couples);
        let image_slope = pull.stiffness;
        let (contact, _) = snake.world().contact_stiffness();
        let felt = Felt { snake, pull };
        let coupled = Felt {
            snake,
            pull: between,
        };
        let shortest = Scheme::Leapfrog.step_limit(&felt).unwrap_or(1.0);
        let limit = |scheme: Scheme| {
            // this one has the picture's slope in its matrix
            let system: &dyn System = match scheme {
                Scheme::LinearlyImplicit => &coupled,
                _ => &felt,
            };
            // beyond any time the snake knows of, only rounding decides
            let limit = scheme.step_limit(system).filter(|dt| *dt < 1e12 * shortest);
            (scheme, limit)
        };
        Self {
            nodes: snake.len(),
            elastic: fastest(snake),
            image: if image_slope > 0.0 {
                frequency(image_slope)
            } else {
                0.0
            },
            image_slope,
            contact: if contact > 0.0 {
                frequency(contact)
            } else {
                0.0
            },
            steps: Scheme::ALL.iter().map(|&scheme| limit(scheme)).collect(),
            anywhere: state.is_none(),
            modes: Vec::new(),
            complete: false,
        }
    }

    /// The largest step of one scheme wherever the nodes may go, and what sets it; None where any is stable.
    ///
    /// As [`Certificate::of`] without a state, for whoever needs no more: O(n), and O(pixels).
    #[must_use]
    pub fn limit(snake: &Snake, scheme: Scheme) -> Option<Limit> {
        let hardest = snake.at_its_hardest();
        if hardest.is_empty() {
            return Self::limit_as_it_is(snake, scheme);
        }
        let limits = hardest
            .iter()
            .map(|snake| Self::limit_as_it_is(snake, scheme));
        limits.flatten().min_by(|a, b| a.dt.total_cmp(&b.dt))
    }

    /// The largest step of one scheme for a snake whose forces push back by at most `slope`, whatever forces it
    /// has: for pictures whose slopes are known by a bound alone. M T⁻². None where any step is stable. O(n).
    #[must_use]
    pub fn limit_for_slope(snake: &Snake, scheme: Scheme, slope: f64) -> Option<f64> {
        let pull = Pull {
            stiffness: slope,
            damping: 0.0,
        };
        scheme.step_limit(&Felt { snake, pull })
    }

    fn limit_as_it_is(snake: &Snake, scheme: Scheme) -> Option<Limit> {
        let own = Limit::of(scheme, snake);
        let implicit = scheme == Scheme::LinearlyImplicit;
        let pull = felt(snake, None, |acting| !implicit || acting.couples());
        let drawn = felt(snake, None, |acting| !implicit && is_picture(acting));
        let shortest = Scheme::Leapfrog.step_limit(snake).unwrap_or(1.0);
        let dt = scheme.step_limit(&Felt { snake, pull });
        let dt = dt.filter(|dt| *dt < 1e12 * shortest)?;
        let picture = drawn.stiffness >= 0.5 * pull.stiffness;
        // rates add up: what the limit without forces leaves over is theirs
        let theirs = own.map_or(1.0, |own| 1.0 - (dt / own.dt) * (dt / own.dt));
        let of = match own {
            Some(own) if theirs < 1e-3 => own.of,
            Some(_) if theirs < 0.5 && picture => "the elastic force and the slope of the picture",
            Some(_) if theirs < 0.5 => "the elastic force and the slopes of other forces",
            _ if picture => "the slope of the picture",
            _ => "the slope of a force",
        };
        Some(Limit { dt, of })
    }

    /// The rate of the mode that is last to come to rest. T⁻¹. 0 where one never does.
    #[must_use]
    pub fn slowest_decay(&self) -> f64 {
        self.modes
            .iter()
            .map(ModeOfMotion::decay)
            .fold(f64::INFINITY, f64::min)
    }

    /// Time until the slowest mode has fallen to a hundredth; None without damping. T.
    #[must_use]
    pub fn time_to_rest(&self) -> Option<f64> {
        let rate = self.slowest_decay();
        (rate > 0.0).then(|| -REST.ln() / rate)
    }

    /// How many modes ring, and how many creep.
    #[must_use]
    pub fn ringing_and_creeping(&self) -> (usize, usize) {
        let ringing = self
            .modes
            .iter()
            .filter(|mode| mode.damping_ratio() < 1.0)
            .count();
        (ringing, self.modes.len() - ringing)
    }
}

impl fmt::Display for Certificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "highest frequencies, 1/T")?;
        for (name, value) in [
            ("elastic", self.elastic),
            ("image", self.image),
            ("contact", self.contact),
        ] {
            writeln!(f, "  {name:<18} {value:.6}")?;
        }
        let (ringing, creeping) = self.ringing_and_creeping();
        let slowest = self.modes.iter().find(|mode| mode.frequency > 0.0);
        match (self.complete, slowest, self.modes.last()) {
            (true, _, _) => writeln!(f, "modes: {ringing} ring, {creeping} creep")?,
            (false, Some(slow), Some(fast)) => writeln!(
                f,
                "damping ratio from {:.4} (slowest mode) to {:.4} (fastest)",
                slow.damping_ratio(),
                fast.damping_ratio()
            )?,
            _ => {}
        }
        match self.time_to_rest() {
            Some(time) => writeln!(f, "to a hundredth of any deformation in {time:.4} T")?,
            None => writeln!(f, "never comes to rest: a mode has no damping")?,
        }
        let where_to = if self.anywhere {
            "wherever the curve may go"
        } else {
            "where the curve is"
        };
        writeln!(f, "largest step {where_to}, T")?;
        for (scheme, limit) in &self.steps {
            match limit {
                Some(dt) if *dt > 0.0 => writeln!(f, "  {:<18} {dt:.6}", scheme.name())?,
                Some(_) => writeln!(f, "  {:<18} none is small enough", scheme.name())?,
                None => writeln!(f, "  {:<18} any", scheme.name())?,
            }
        }
        Ok(())
    }
}

/// How steeply the forces push a node back at most, and how much they damp it.
fn felt(snake: &Snake, state: Option<&State>, counts: impl Fn(&Acting) -> bool) -> Pull {
    let mut sum = Pull::default();
    for acting in snake.world().forces.iter().filter(|acting| counts(acting)) {
        let curve = state.map(|state| snake.curve(state.t, &state.x, &state.v));
        let pull = acting.pull(snake.body().spacing, curve.as_ref());
        sum.stiffness += pull.stiffness;
        sum.damping += pull.damping;
    }
    sum
}

/// Whether a force is that of a picture.
fn is_picture(acting: &Acting) -> bool {
    acting.downcast::<ImageForce>().is_some()
        || acting.downcast::<SignedEdgeForce>().is_some()
        || acting.downcast::<RegionForce>().is_some()
}

/// The snake with the slopes of its forces where a penalty wall would be, to ask for largest steps.
struct Felt<'a> {
    snake: &'a Snake,
    pull: Pull,
}

impl System for Felt<'_> {
    fn len(&self) -> usize {
        self.snake.len()
    }
    fn mass(&self) -> &[f64] {
        self.snake.mass()
    }
    fn damping(&self) -> &[f64] {
        self.snake.damping()
    }
    fn held(&self) -> &[bool] {
        self.snake.held()
    }
    fn stiffness(&self) -> &banded::Operator {
        self.snake.stiffness()
    }
    fn elastic(&mut self, _: &[DVec2], force: &mut [DVec2]) {
        force.fill(DVec2::ZERO); // asked for its limits only; it never moves
    }
    fn external(&mut self, _: f64, _: &[DVec2], _: &[DVec2], _: &mut [DVec2]) -> Result<(), Fault> {
        Ok(())
    }
    fn contact_stiffness(&self) -> (f64, f64) {
        let (stiffness, damping) = self.snake.contact_stiffness();
        (stiffness + self.pull.stiffness, damping + self.pull.damping)
    }
    fn internal_damping(&self) -> f64 {
        self.snake.internal_damping()
    }
}

#[cfg(test)]
#[path = "certificate_tests.rs"]
mod tests;

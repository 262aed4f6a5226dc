//! What can be said of a snake before it moves: frequencies, largest steps, damping, time to rest.

use std::fmt;

use banded::{Circulant, Dense};
use glam::DVec2;
use integrator::{Fault, Limit, Scheme, State, System};

use crate::{Acting, ImageForce, Pull, RegionForce, SignedEdgeForce, Snake};

/// The most nodes whose modes are found one by one where the curve is not a ring of equal nodes.
const MOST: usize = 400;

/// Rest: a deformation has fallen to this share of what it was.
const REST: f64 = 0.01;

/// One way for the whole curve to move, as a damped oscillator `ü + 2 ζ ω u̇ + ω² u = 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeOfMotion {
    /// ω: its frequency without damping. T⁻¹. 0: nothing brings it back.
    pub frequency: f64,
    /// γ/(2μ) as this mode feels it. T⁻¹.
    pub fading: f64,
}

impl ModeOfMotion {
    /// ζ: below 1 it rings, above 1 it creeps, at 1 it is first at rest. Infinite where ω = 0.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        if self.frequency > 0.0 || self.fading > 0.0 {
            self.fading / self.frequency
        } else {
            0.0
        }
    }

    /// The rate at which it decays in the end: the slower of its two roots; for ω = 0, that of its
    /// velocity. T⁻¹.
    #[must_use]
    pub fn decay(&self) -> f64 {
        let (b, w) = (self.fading, self.frequency);
        if w > 0.0 && b > w {
            w * (w / (b + ((b - w) * (b + w)).sqrt()))
        } else if w > 0.0 {
            b
        } else {
            2.0 * b
        }
    }
}

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
/// nodes, O(n³) for others up to 400 nodes, and only the outermost modes beyond: O(n).
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
    /// All modes from the slowest up, or the outermost two (see [`Certificate::complete`]).
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
        let hardest = snake.at_its_hardest().filter(|_| state.is_none());
        let Some([damped, light]) = hardest else {
            return Self::as_it_is(snake, state);
        };
        let (mut one, other) = (Self::as_it_is(&damped, None), Self::as_it_is(&light, None));
        for ((_, limit), (_, other)) in one.steps.iter_mut().zip(other.steps) {
            *limit = match (*limit, other) {
                (Some(a), Some(b)) => Some(a.min(b)),
                (a, b) => a.or(b),
            };
        }
        one
    }

    fn as_it_is(snake: &Snake, state: Option<&State>) -> Self {
        let least = free(snake, snake.mass()).fold(f64::INFINITY, f64::min);
        let frequency = |stiffness: f64| (stiffness / least).sqrt();
        let pull = felt(snake, state, |_| true);
        // what a slope at each node by itself does not hold
        let between = felt(snake, state, Acting::couples);
        let image_slope = pull.stiffness;
        let (contact, _) = snake.world().contact_stiffness();
        let (modes, complete) = modes(snake);
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
            elastic: modes.last().map_or(0.0, |mode| mode.frequency),
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
            modes,
            complete,
        }
    }

    /// The largest step of one scheme wherever the nodes may go, and what sets it; None where any is stable.
    ///
    /// As [`Certificate::of`] without a state, for whoever needs no more: O(n), and O(pixels).
    #[must_use]
    pub fn limit(snake: &Snake, scheme: Scheme) -> Option<Limit> {
        let Some(hardest) = snake.at_its_hardest() else {
            return Self::limit_as_it_is(snake, scheme);
        };
        let limits = hardest.map(|snake| Self::limit_as_it_is(&snake, scheme));
        let all = limits.into_iter().flatten();
        all.min_by(|a, b| a.dt.total_cmp(&b.dt))
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
        match (self.complete, self.modes.first(), self.modes.last()) {
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
        writeln!(f, "largest step, T")?;
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

/// Values at nodes that may move.
fn free<'a>(snake: &'a Snake, values: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let pairs = values.iter().zip(snake.held());
    pairs.filter(|(_, held)| !**held).map(|(&value, _)| value)
}

/// Modes from the slowest up, and whether these are all.
pub(crate) fn modes(snake: &Snake) -> (Vec<ModeOfMotion>, bool) {
    let (mass, damping) = (snake.mass(), snake.damping());
    let least = free(snake, mass).fold(f64::INFINITY, f64::min);
    if least == f64::INFINITY {
        return (Vec::new(), true); // every node is held
    }
    if least <= 0.0 {
        let frantic = ModeOfMotion {
            frequency: f64::INFINITY,
            fading: f64::INFINITY,
        };
        return (vec![frantic], false);
    }
    let mode = |stiffness: f64, fading: f64| ModeOfMotion {
        frequency: stiffness.max(0.0).sqrt(),
        fading,
    };
    // a stiffness below the rounding of the largest is none
    let clean = |mut modes: Vec<ModeOfMotion>| {
        let most = modes.iter().map(|mode| mode.frequency).fold(0.0, f64::max);
        for mode in modes.iter_mut().filter(|mode| mode.frequency < 1e-6 * most) {
            mode.frequency = 0.0;
        }
        modes
    };
    if let Some(values) = waves(snake) {
        let fading = 0.5 * damping[0] / mass[0];
        let modes = values.iter().map(|value| mode(value / mass[0], fading));
        return (clean(modes.collect()), true);
    }
    let n = snake.len();
    let held = snake.held();
    if n <= MOST {
        let matrix = snake.stiffness().dense();
        let root: Vec<f64> = (0..n)
            .map(|i| if held[i] { 1.0 } else { mass[i].sqrt() })
            .collect();
        let scaled = Dense::from_fn(n, |i, j| matrix[(i, j)] / (root[i] * root[j]));
        if let Ok(eigen) = scaled.eigen() {
            let pairs = eigen.values.iter().zip(&eigen.vectors);
            // held nodes are modes of their own, of no stiffness: not motions
            let moving = pairs.filter(|(_, u)| (0..n).any(|i| !held[i] && u[i].abs() > 1e-6));
            let fading = |u: &[f64]| -> f64 {
                (0..n)
                    .map(|i| {
                        if held[i] {
                            0.0
                        } else {
                            u[i] * u[i] * damping[i] / mass[i]
                        }
                    })
                    .sum()
            };
            let modes = moving.map(|(&value, u)| mode(value, 0.5 * fading(u)));
            return (clean(modes.collect()), true);
        }
    }
    outermost(snake)
}

/// Eigenvalues of a closed curve of equal nodes, in ascending order.
fn waves(snake: &Snake) -> Option<Vec<f64>> {
    let equal = |values: &[f64]| values.iter().all(|v| v.to_bits() == values[0].to_bits());
    let operator = snake.stiffness();
    let even = !snake.held().contains(&true)
        && equal(snake.mass())
        && equal(snake.damping())
        && operator.columns().iter().all(|column| equal(column));
    let circulant = even
        .then(|| Circulant::new(operator.band()).ok())
        .flatten()?;
    let mut values = circulant.eigenvalues().to_vec();
    if !operator.columns().is_empty() {
        // what all nodes share only changes the mode in which all move alike
        let mut product = vec![0.0; values.len()];
        operator.multiply_scalars_into(&vec![1.0; values.len()], &mut product);
        values[0] = product.iter().sum::<f64>() / values.len() as f64;
    }
    values.sort_by(f64::total_cmp);
    Some(values)
}

/// The outermost two modes: stiffness by bisection, damping from its extremes. A body frame only lowers eigenvalues to 0 or leaves them between their neighbours, so the band's stand in.
fn outermost(snake: &Snake) -> (Vec<ModeOfMotion>, bool) {
    let weights: Vec<f64> = snake
        .mass()
        .iter()
        .zip(snake.held())
        .map(|(&mass, &held)| if held { 1.0 } else { mass })
        .collect();
    let band = snake.stiffness().band();
    let ratios = snake.damping().iter().zip(snake.mass()).zip(snake.held());
    let moving = ratios.filter(|(_, held)| !**held).map(|((c, m), _)| c / m);
    let (low, high) = moving.fold((f64::INFINITY, 0.0_f64), |(low, high), ratio| {
        (low.min(ratio), high.max(ratio))
    });
    let slow = banded::smallest_eigenvalue(band, &weights).max(0.0);
    let fast = banded::largest_eigenvalue(band, &weights).max(0.0);
    // slowest to rest: the least fading where it rings, the most where it creeps
    let candidates = [low, high].map(|ratio| ModeOfMotion {
        frequency: slow.sqrt(),
        fading: 0.5 * ratio,
    });
    let first = if candidates[0].decay() <= candidates[1].decay() {
        0
    } else {
        1
    };
    let last = ModeOfMotion {
        frequency: fast.sqrt(),
        fading: 0.5 * low,
    };
    (vec![candidates[first], last], false)
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
}

#[cfg(test)]
#[path = "certificate_tests.rs"]
mod tests;

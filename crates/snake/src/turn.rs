//! The rest shape turned to where it fits best, so that a rigid rotation costs no elastic energy.

use std::fmt;
use std::str::FromStr;

use elastic::{Material, Profile};
use glam::DVec2;

use crate::factors;
use crate::schedule::Factors;
use crate::{Body, Parameter, SnakeError};

/// Whether the rest shape turns with the body (report §5.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Turn {
    /// It keeps its direction: a rotated snake counts as deformed (report ch. 2, D12).
    #[default]
    None,
    /// By the angle that leaves the least elastic energy.
    ///
    /// ```text
    /// ξ = min over θ of ½ h (P x − R r)ᵀ K (P x − R r),   θ = atan2(Σ k × x, Σ k · x),   k = Pᵀ K r
    /// ```
    ///
    /// At the minimum the energy does not change with θ, so its gradient is that of a θ held fixed: the
    /// force is −Pᵀ K (P x − R r), without a sum and without a torque. Where no angle is better
    /// than another (a shape turned inside out) θ is 0.
    Fit,
}

impl Turn {
    /// Both of them.
    pub const ALL: &[Self] = &[Self::None, Self::Fit];

    /// Its name in texts.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Fit => "fit",
        }
    }
}

impl fmt::Display for Turn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Turn {
    type Err = SnakeError;

    fn from_str(text: &str) -> Result<Self, SnakeError> {
        let found = Self::ALL.iter().find(|turn| turn.name() == text);
        found.copied().ok_or_else(|| SnakeError::UnknownName {
            what: "turn",
            name: text.to_owned(),
            known: "none, fit",
        })
    }
}

/// Below this part of what the sums could be they are rounding, and no angle fits.
const NOTHING: f64 = 1e-13;

/// A rest shape that turns, and what it pulls with.
#[derive(Debug, Clone)]
pub(crate) struct TurningRest {
    /// K r of the tether, the tension, the rigidity and, if any, the orders above alone, the reaction of the frame taken
    /// out: what the angle is asked of. Their sums are zero.
    parts: Vec<Vec<DVec2>>,
    /// K r as the frame's rule has it, at the present factors.
    push: Vec<DVec2>,
    pull: Vec<DVec2>,
}

impl TurningRest {
    /// None for a rest shape that keeps its direction.
    pub(crate) fn new(body: &Body, weights: &[f64], factors: &factors::Factors) -> Option<Self> {
        if body.frame.turn == Turn::None {
            return None;
        }
        let none = || Profile::Uniform(0.0);
        let own = factors.by_place().material(&body.material);
        let (tether, tension, rigidity) = (
            own.tether.clone(),
            own.tension.clone(),
            own.rigidity.clone(),
        );
        let factors = factors.common;
        let alone = |tether, tension, rigidity, higher| {
            let material = Material {
                tether,
                tension,
                rigidity,
                higher,
            };
            pull(body, &material, weights)
        };
        let mut parts = vec![
            alone(tether, none(), none(), Vec::new()),
            alone(none(), tension, none(), Vec::new()),
            alone(none(), none(), rigidity, Vec::new()),
        ];
        if !own.higher.is_empty() {
            parts.push(alone(none(), none(), none(), own.higher.clone()));
        }
        let zeros = || vec![DVec2::ZERO; body.len()];
        let mut turning = Self {
            parts: parts.iter().map(|(fit, _)| fit.clone()).collect(),
            push: zeros(),
            pull: zeros(),
        };
        for i in 0..body.len() {
            for ((fit, raw), factor) in parts.iter().zip(elastic_ones(factors)) {
                turning.pull[i] += factor * fit[i];
                turning.push[i] += factor * if body.frame.reaction { fit[i] } else { raw[i] };
            }
        }
        Some(turning)
    }

    /// The rotation that fits `x` best, as the unit vector that x̂ is turned to. O(n).
    pub(crate) fn rotation(&self, x: &[DVec2]) -> DVec2 {
        rotation(&self.pull, x)
    }

    /// The same at other factors of the densities.
    pub(crate) fn rotation_at(&self, x: &[DVec2], factors: Factors) -> DVec2 {
        let mut pull = vec![DVec2::ZERO; x.len()];
        for (factor, part) in elastic_ones(factors).into_iter().zip(&self.parts) {
            for (pull, part) in pull.iter_mut().zip(part) {
                *pull += factor * *part;
            }
        }
        rotation(&pull, x)
    }

    /// Add what turning the rest shape changes in the elastic force: (R − 1) K r.
    pub(crate) fn add(&self, x: &[DVec2], force: &mut [DVec2]) {
        let rotation = self.rotation(x);
        for (f, &push) in force.iter_mut().zip(&self.push) {
            *f += rotation.rotate(push) - push;
        }
    }
}

/// The factors of the elastic densities, in the order of the parts.
fn elastic_ones(factors: Factors) -> [f64; 4] {
    Parameter::ELASTIC.map(|parameter| factors[parameter])
}

/// K r with the frame's reaction taken out, and as it is.
pub(crate) fn pull(body: &Body, material: &Material, weights: &[f64]) -> (Vec<DVec2>, Vec<DVec2>) {
    let mut raw = vec![DVec2::ZERO; body.len()];
    elastic::elastic_force(&body.rest, body.topology, material, body.spacing, &mut raw);
    for force in &mut raw {
        *force = -*force;
    }
    let total: DVec2 = raw.iter().sum();
    let fit = raw.iter().zip(weights).map(|(&k, &w)| k - total * w);
    (fit.collect(), raw)
}

/// The angle of Σ k·x and Σ k×x, as a unit vector; x̂ where there is none. The k have no sum.
pub(crate) fn rotation(pull: &[DVec2], x: &[DVec2]) -> DVec2 {
    // about any node, for the digits
    let origin = x.first().copied().unwrap_or_default();
    let (mut sums, mut sizes) = (DVec2::ZERO, DVec2::ZERO);
    for (k, x) in pull.iter().zip(x) {
        let q = *x - origin;
        sums += DVec2::new(k.dot(q), k.perp_dot(q));
        sizes += DVec2::new(k.length_squared(), q.length_squared());
    }
    let length = sums.length();
    if length > NOTHING * (sizes.x * sizes.y).sqrt() {
        sums / length
    } else {
        DVec2::X
    }
}

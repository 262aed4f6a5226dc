//! Damping chosen by the program, which report §3.4.2 wishes for.

use std::fmt;
use std::str::FromStr;

use elastic::Profile;
use glam::{DMat2, DVec2};
use integrator::{State, System};

use crate::error::finite_at_least;
use crate::modes::resisting;
use crate::renewal::Renewal;
use crate::{Parameter, Snake, SnakeError};

/// A rule that chooses the damping of a snake.
///
/// The first four set γ, the damping by the medium, and the last two β, the damping inside the body;
/// each leaves the other as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// γ as given, at every node. M T⁻¹.
    Constant(f64),
    /// Critical for one elastic mode, `γ = 2 μ ω = 2 √(μ λ)`: counted from 0, the slowest that resists.
    Mode(usize),
    /// Critical for each node between neighbours that stay: `γᵢ = 2 √(μᵢ κᵢ)` with κ the diagonal of K
    /// plus the slope of the picture along the steepest direction at the node. Chosen once.
    Local,
    /// The same, chosen again whenever so much time has passed. T.
    Renewed(f64),
    /// β as given. T.
    Internal(f64),
    /// β = 2/ω: internal damping critical for one elastic mode.
    InternalMode(usize),
}

const KNOWN: &str = "constant(γ), mode(k), local, renewed(time), internal(time), internal-mode(k)";

impl Damping {
    /// Its name in texts, without its parameter.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Constant(_) => "constant",
            Self::Mode(_) => "mode",
            Self::Local => "local",
            Self::Renewed(_) => "renewed",
            Self::Internal(_) => "internal",
            Self::InternalMode(_) => "internal-mode",
        }
    }
}

impl fmt::Display for Damping {
    /// The name, and the parameter in parentheses: `mode(1)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Constant(value) | Self::Renewed(value) | Self::Internal(value) => {
                write!(f, "{}({value:?})", self.name())
            }
            Self::Mode(mode) | Self::InternalMode(mode) => write!(f, "{}({mode})", self.name()),
            Self::Local => f.write_str(self.name()),
        }
    }
}

impl FromStr for Damping {
    type Err = SnakeError;

    fn from_str(text: &str) -> Result<Self, SnakeError> {
        let unknown = || SnakeError::UnknownName {
            what: "damping",
            name: text.to_owned(),
            known: KNOWN,
        };
        let Some((name, value)) = text.strip_suffix(')').and_then(|text| text.split_once('('))
        else {
            return match text {
                "local" => Ok(Self::Local),
                _ => Err(unknown()),
            };
        };
        let (number, mode) = (value.trim().parse::<f64>(), value.trim().parse::<usize>());
        match (name.trim(), number, mode) {
            ("constant", Ok(value), _) => Ok(Self::Constant(value)),
            ("renewed", Ok(value), _) => Ok(Self::Renewed(value)),
            ("internal", Ok(value), _) => Ok(Self::Internal(value)),
            ("mode", _, Ok(mode)) => Ok(Self::Mode(mode)),
            ("internal-mode", _, Ok(mode)) => Ok(Self::InternalMode(mode)),
            _ => Err(unknown()),
        }
    }
}

impl Snake {
    /// Let a rule choose the damping, for the snake as it is at `state`.
    ///
    /// Its schemes are told at their next step. The report's scheme has a step limit that damping lowers:
    /// ask it again afterwards.
    ///
    /// # Errors
    ///
    /// Refused: a number that is not finite or negative, a time of 0 between renewals, a mode that
    /// the body has not, a state of another number of nodes. Then nothing has changed.
    pub fn damp(&mut self, rule: Damping, state: &State) -> Result<(), SnakeError> {
        if state.len() != self.len() {
            return Err(SnakeError::OtherLength {
                needed: self.len(),
                got: state.len(),
            });
        }
        self.bring(state.t, &state.x);
        let mut body = self.body.clone();
        let mut renewal = None;
        match rule {
            Damping::Constant(gamma) => body.damping = Profile::Uniform(gamma),
            Damping::Mode(mode) => {
                body.damping = body.mass.scaled(2.0 * self.frequency(mode)?);
            }
            Damping::Local => body.damping = self.local_damping(state.t, &state.x)?,
            Damping::Renewed(every) => {
                finite_at_least("renewal", f64::MIN_POSITIVE, "above 0", every)?;
                body.damping = self.local_damping(state.t, &state.x)?;
                renewal = Some(Renewal::every(every, state.t + every));
            }
            Damping::Internal(beta) => body.internal = beta,
            Damping::InternalMode(mode) => body.internal = 2.0 / self.frequency(mode)?,
        }
        if matches!(rule, Damping::Internal(_) | Damping::InternalMode(_)) {
            renewal = self.renewal;
        }
        self.set_body(body)?;
        self.renewal = renewal;
        Ok(())
    }

    /// ω of the elastic mode number `mode` of those that resist.
    fn frequency(&self, mode: usize) -> Result<f64, SnakeError> {
        resisting(self, mode).map_err(|modes| SnakeError::NoMode { mode, modes })
    }

    /// γ of every node from the stiffness it feels: its elastic diagonal and the world's slope.
    fn local_damping(&mut self, t: f64, x: &[DVec2]) -> Result<Profile, SnakeError> {
        let (n, body) = (self.len(), &self.body);
        let mut stiffness =
            elastic::local_stiffness(body.topology, &self.material, body.spacing, n)?;
        let mut slope = vec![DMat2::ZERO; n];
        self.external_slope(t, x, &mut slope);
        for (stiffness, slope) in stiffness.iter_mut().zip(&slope) {
            *stiffness += steepest(*slope);
        }
        let mass = Profile::PerNode(self.mass.clone());
        Ok(Profile::PerNode(elastic::critical_damping(
            &mass, &stiffness,
        )))
    }

    /// Choose the damping again if it is time; true if it was.
    pub(crate) fn renew(&mut self, t: f64, x: &[DVec2]) -> bool {
        let due = self.renewal.as_mut().is_some_and(|renewal| renewal.meet(t));
        // what was accepted at the start is accepted again
        if due && let Ok(damping) = self.local_damping(t, x) {
            self.damping = self
                .factors
                .times(Parameter::Damping, &damping)
                .to_vec(self.len());
            self.body.damping = damping;
        }
        due
    }
}

/// The largest −∂f/∂x along any direction, at least 0: the larger eigenvalue of the symmetric part.
fn steepest(slope: DMat2) -> f64 {
    let (xx, yy) = (-slope.x_axis.x, -slope.y_axis.y);
    let xy = -0.5 * (slope.x_axis.y + slope.y_axis.x);
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    (mean + half.hypot(xy)).max(0.0)
}

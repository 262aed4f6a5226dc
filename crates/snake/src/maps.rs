//! Parameters that change with place: what the picture under a node says of them (report §3.4.1).

use std::sync::Arc;

use elastic::Topology;
use field::Map;
use glam::DVec2;

use crate::error::finite_at_least;
use crate::parameter::PerParameter;
use crate::{Parameter, SnakeError};

/// One optional map of factors for each parameter of the motion.
///
/// ```text
/// ωᵢ = profile(sᵢ) · schedule(t) · map(xᵢ)
/// ```
///
/// A map is an outside agent that sets the parameter of whoever stands there. The elastic force is `−K e` with the parameters as
/// found, and not the gradient of the energy over place, which would push a curve to where deforming it is cheap. So a
/// closed way may put energy in or take it out; a ledger books it under `parameters`. A node whose mass changes keeps its
/// velocity. ω₁, which belongs to the edge from a node to the next, is asked for in the middle of the edge. The center
/// of mass that the body frame stands on is that of the profile: where a stretch of curve counts for more does not
/// change with the ground below it.
///
/// Limits of steps and certificates count with the largest factors there are (of the mass with the least), so nothing
/// depends on which of them a node will meet.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Maps {
    /// Factor of ω₀.
    pub tether: Option<Arc<Map>>,
    /// Factor of ω₁.
    pub tension: Option<Arc<Map>>,
    /// Factor of ω₂.
    pub rigidity: Option<Arc<Map>>,
    /// Factor of μ. Above 0.
    pub mass: Option<Arc<Map>>,
    /// Factor of γ.
    pub damping: Option<Arc<Map>>,
    /// Time between two looks; 0: at every step. T.
    pub every: f64,
}

/// Factors by place: one a node, where a parameter has a map.
pub(crate) type Places = PerParameter<Option<Vec<f64>>>;

impl Maps {
    /// Whether nothing changes with place.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.tether.is_none()
            && self.tension.is_none()
            && self.rigidity.is_none()
            && self.mass.is_none()
            && self.damping.is_none()
    }

    /// Check every factor.
    ///
    /// # Errors
    ///
    /// A factor below 0, of the mass one that is not above 0; an interval between looks that is not
    /// a finite number above 0.
    pub fn validate(&self) -> Result<(), SnakeError> {
        finite_at_least("the time between looks", 0.0, "at least 0", self.every)?;
        for parameter in Parameter::ALL {
            let Some(map) = self.of(parameter) else {
                continue;
            };
            let (least, bound) = if parameter == Parameter::Mass {
                (f64::MIN_POSITIVE, "above 0")
            } else {
                (0.0, "at least 0")
            };
            finite_at_least(factor_of(parameter), least, bound, map.least())?;
        }
        Ok(())
    }

    /// The factors under nodes at `x`. O(n).
    pub(crate) fn at(&self, x: &[DVec2], topology: Topology) -> Places {
        PerParameter::of(|parameter| {
            let map = self.of(parameter)?;
            Some(if parameter == Parameter::Tension {
                middles(x, topology).map(|p| map.at(p)).collect()
            } else {
                x.iter().map(|&p| map.at(p)).collect()
            })
        })
    }

    /// The factors that ask for the shortest steps, at each of `n` nodes; of the damping the largest, or the least.
    pub(crate) fn hardest(&self, n: usize, damped: bool) -> Places {
        PerParameter::of(|parameter| {
            let map = self.of(parameter)?;
            let least = match parameter {
                Parameter::Mass => true,
                Parameter::Damping => !damped,
                _ => false,
            };
            Some(vec![if least { map.least() } else { map.largest() }; n])
        })
    }

    fn of(&self, parameter: Parameter) -> Option<&Map> {
        match parameter {
            Parameter::Tether => self.tether.as_deref(),
            Parameter::Tension => self.tension.as_deref(),
            Parameter::Rigidity => self.rigidity.as_deref(),
            Parameter::Mass => self.mass.as_deref(),
            Parameter::Damping => self.damping.as_deref(),
            Parameter::Higher | Parameter::Internal => None,
        }
    }
}

/// The user's word for the factors of a parameter.
const fn factor_of(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Tether => "a factor of the tether",
        Parameter::Tension => "a factor of the tension",
        Parameter::Rigidity => "a factor of the rigidity",
        Parameter::Higher => "a factor of the higher orders",
        Parameter::Mass => "a factor of the mass",
        Parameter::Damping => "a factor of the damping",
        Parameter::Internal => "a factor of the internal damping",
    }
}

/// The middle of the edge from each node to the next; the last node of an open curve itself.
fn middles(x: &[DVec2], topology: Topology) -> impl Iterator<Item = DVec2> + '_ {
    (0..x.len()).map(move |i| match x.get(i + 1) {
        Some(&next) => 0.5 * (x[i] + next),
        None if topology.is_closed() => 0.5 * (x[i] + x[0]),
        None => x[i],
    })
}

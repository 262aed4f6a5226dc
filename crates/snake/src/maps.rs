//! Parameters that change with place: what the picture under a node says of them (report §3.4.1).

use std::sync::Arc;

use elastic::Topology;
use field::Map;
use glam::DVec2;

use crate::SnakeError;
use crate::error::finite_at_least;

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

/// Factors of the five parameters by place: one a node, where there is a map.
pub(crate) type Places = [Option<Vec<f64>>; 5];

const NAMES: [&str; 5] = [
    "a factor of the tether",
    "a factor of the tension",
    "a factor of the rigidity",
    "a factor of the mass",
    "a factor of the damping",
];

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
        for (k, map) in self.all().into_iter().enumerate() {
            let Some(map) = map else { continue };
            let (least, bound) = if k == MASS {
                (f64::MIN_POSITIVE, "above 0")
            } else {
                (0.0, "at least 0")
            };
            finite_at_least(NAMES[k], least, bound, map.least())?;
        }
        Ok(())
    }

    /// The factors under nodes at `x`. O(n).
    pub(crate) fn at(&self, x: &[DVec2], topology: Topology) -> Places {
        let mut k = 0;
        self.all().map(|map| {
            let edges = k == TENSION;
            k += 1;
            map.map(|map| {
                if edges {
                    middles(x, topology).map(|p| map.at(p)).collect()
                } else {
                    x.iter().map(|&p| map.at(p)).collect()
                }
            })
        })
    }

    /// The factors that ask for the shortest steps, at each of `n` nodes; of the damping the largest, or the least.
    pub(crate) fn hardest(&self, n: usize, damped: bool) -> Places {
        let mut k = 0;
        self.all().map(|map| {
            let least = k == MASS || k == DAMPING && !damped;
            k += 1;
            map.map(|map| vec![if least { map.least() } else { map.largest() }; n])
        })
    }

    fn all(&self) -> [Option<&Map>; 5] {
        [
            &self.tether,
            &self.tension,
            &self.rigidity,
            &self.mass,
            &self.damping,
        ]
        .map(Option::as_deref)
    }
}

/// Their numbers among the five.
const TENSION: usize = 1;
const MASS: usize = 3;
const DAMPING: usize = 4;

/// The middle of the edge from each node to the next; the last node of an open curve itself.
fn middles(x: &[DVec2], topology: Topology) -> impl Iterator<Item = DVec2> + '_ {
    (0..x.len()).map(move |i| match x.get(i + 1) {
        Some(&next) => 0.5 * (x[i] + next),
        None if topology.is_closed() => 0.5 * (x[i] + x[0]),
        None => x[i],
    })
}

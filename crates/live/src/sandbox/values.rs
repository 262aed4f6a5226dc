//! What of a scene can be set: parameters, scheme and step, with their limits.

use std::str::FromStr;

use scene::integrator::Scheme;
use scene::snake::{Certificate, Edit, Parameter, Stepping};
use serde_json::{Value, json};

use super::Sandbox;
use super::atlas::mean;
use crate::LiveError;

/// Parameters that the page has sliders for, with their symbols and units.
const SLIDERS: [(Parameter, &str, &str); 6] = [
    (Parameter::Tether, "ω₀", "M/T²"),
    (Parameter::Tension, "ω₁", "M L²/T²"),
    (Parameter::Rigidity, "ω₂", "M L⁴/T²"),
    (Parameter::Mass, "μ", "M"),
    (Parameter::Damping, "γ", "M/T"),
    (Parameter::Internal, "β", "T"),
];

impl Sandbox {
    /// Set a parameter of one snake or of all.
    pub(super) fn set(
        &mut self,
        key: &str,
        value: f64,
        id: Option<usize>,
    ) -> Result<(), LiveError> {
        let parameter = Parameter::from_str(key).map_err(LiveError::of)?;
        if let Some(id) = id {
            self.member(id)?;
            return self.edit(id, Edit::Set(parameter, value));
        }
        self.edit_all(|_| Some(Edit::Set(parameter, value)))
    }

    /// Move by another scheme, or by other steps: those beyond the limit are made all the same, so that one sees what
    /// becomes of them.
    pub(super) fn stepping(
        &mut self,
        scheme: Option<&str>,
        dt: Option<f64>,
    ) -> Result<(), LiveError> {
        let now = *self.simulation().stepping();
        let scheme = match scheme {
            Some(name) => Scheme::from_str(name).map_err(LiveError::of)?,
            None => now.scheme,
        };
        let stepping = Stepping {
            scheme,
            dt: dt.unwrap_or(now.dt),
            force: true,
            ..now
        };
        if !(stepping.dt.is_finite() && stepping.dt > 0.0) {
            let got = stepping.dt;
            return Err(LiveError::new(format!(
                "the step must be above 0, got {got}"
            )));
        }
        let set = self.course.simulation_mut().set_stepping(stepping);
        set.map_err(LiveError::of)
    }

    /// Parameters, schemes and steps, with their limits.
    pub(crate) fn values(&self, id: Option<usize>) -> Result<Value, LiveError> {
        let member = self.member_or_first(id)?;
        let (snake, body) = (member.snake(), member.snake().body());
        let n = body.len();
        let parameters = SLIDERS.map(|(parameter, symbol, unit)| {
            let profile = match parameter {
                Parameter::Tether => &body.material.tether,
                Parameter::Tension => &body.material.tension,
                Parameter::Rigidity => &body.material.rigidity,
                Parameter::Mass => &body.mass,
                Parameter::Damping => &body.damping,
                _ => &scene::elastic::Profile::Uniform(body.internal),
            };
            json!({
                "key": parameter.name(), "symbol": symbol, "unit": unit,
                "value": mean(profile, n), "varies": !profile.is_uniform(),
            })
        });
        let stepping = self.simulation().stepping();
        let limit = Certificate::limit(snake, stepping.scheme);
        let schemes = Scheme::ALL.iter().map(|scheme| {
            json!({"name": scheme.name(), "summary": scheme.summary(), "order": scheme.order()})
        });
        Ok(json!({
            "snake": member.id(), "nodes": n, "parameters": parameters,
            "scheme": stepping.scheme.name(), "schemes": schemes.collect::<Vec<Value>>(),
            "dt": stepping.dt, "dt-limit": limit.map(|limit| limit.dt), "limited-by": limit.map(|limit| limit.of),
            "contact": self.simulation().contact().is_some(),
        }))
    }
}

//! The body: rest shape, material, densities, schedules; and the state it starts in.

use std::path::Path;

use elastic::{Material, Profile, SpacingRule};
use glam::DVec2;
use integrator::State;
use snake::{Body, Frame, Schedule, Schedules};

use super::shape::{self, nodes, topology};
use super::{Rules, number, refused};
use crate::SceneError;
use crate::file::{ProfileText, Rule, SceneText};

pub(crate) fn profile(key: &str, text: &ProfileText, n: usize) -> Result<Profile, SceneError> {
    match text {
        ProfileText::Uniform(value) => Ok(Profile::Uniform(*value)),
        ProfileText::PerNode(values) if values.len() == n => Ok(Profile::PerNode(values.clone())),
        ProfileText::PerNode(values) => {
            let got = values.len();
            let message = format!("has {got} numbers for {n} nodes; one a node would do");
            Err(SceneError::key(key, message))
        }
        ProfileText::Along(along) => {
            // a schedule in s instead of t: the same straight lines between points
            let line = straight(&format!("{key}.along"), "s", "value", &along.along)?;
            if let Some([s, _]) = along.along.iter().find(|[s, _]| !(0.0..=1.0).contains(s)) {
                let message = format!("s runs from 0 to 1, got {s}");
                return Err(SceneError::key(&format!("{key}.along"), message));
            }
            let last = (n.max(2) - 1) as f64;
            Ok(Profile::PerNode(
                (0..n).map(|i| line.at(i as f64 / last)).collect(),
            ))
        }
    }
}

/// Straight lines through pairs whose first numbers ascend and whose second are not negative.
pub(crate) fn straight(
    key: &str,
    first: &str,
    second: &str,
    pairs: &[[f64; 2]],
) -> Result<Schedule, SceneError> {
    let refuse = |message: String| {
        let message = format!("{message}; [[{first}, {second}], …] would do");
        Err(SceneError::key(key, message))
    };
    if pairs.is_empty() {
        return refuse("has no entry".to_owned());
    }
    for (i, &[at, value]) in pairs.iter().enumerate() {
        if !at.is_finite() || (i > 0 && at <= pairs[i - 1][0]) {
            return refuse(format!(
                "{first} must be finite and ascend, but entry {i} is at {at}"
            ));
        }
        if !(value.is_finite() && value >= 0.0) {
            return refuse(format!(
                "{second} must be finite and at least 0, but entry {i} has {value}"
            ));
        }
    }
    Schedule::new(pairs.iter().map(|&[at, value]| (at, value)).collect())
        .map_err(|e| SceneError::key(key, e))
}

fn schedules(text: &SceneText) -> Result<Schedules, SceneError> {
    let one = |key: &str, list: &Option<Vec<[f64; 2]>>| -> Result<Option<Schedule>, SceneError> {
        list.as_ref()
            .map(|list| straight(&format!("schedule.{key}"), "time", "factor", list))
            .transpose()
    };
    let s = &text.schedule;
    if let Some(&[t, _]) = s.mass.iter().flatten().find(|[_, factor]| *factor <= 0.0) {
        let message = format!("factors of the mass must be above 0, but at {t} it is not");
        return Err(SceneError::key("schedule.mass", message));
    }
    Ok(Schedules {
        tether: one("tether", &s.tether)?,
        tension: one("tension", &s.tension)?,
        rigidity: one("rigidity", &s.rigidity)?,
        mass: one("mass", &s.mass)?,
        damping: one("damping", &s.damping)?,
    })
}

fn material(text: &SceneText, n: usize) -> Result<Material, SceneError> {
    let m = &text.material;
    let mut material = Material {
        tether: profile("material.tether", &m.tether, n)?,
        tension: profile("material.tension", &m.tension, n)?,
        rigidity: profile("material.rigidity", &m.rigidity, n)?,
    };
    for (key, list) in [
        ("material.corners", &m.corners),
        ("material.breaks", &m.breaks),
    ] {
        if let Some(bad) = list.iter().find(|&&i| i >= n) {
            let message = format!("there is no node {bad}; 0 to {} would do", n - 1);
            return Err(SceneError::key(key, message));
        }
    }
    // as elastic::Material::with_corner and with_break, but any number of them in one go
    if !(m.corners.is_empty() && m.breaks.is_empty()) {
        let mut rigidity = material.rigidity.to_vec(n);
        let mut tension = material.tension.to_vec(n);
        for &i in &m.corners {
            rigidity[i] = 0.0;
        }
        for &i in &m.breaks {
            (tension[i], rigidity[i], rigidity[(i + 1) % n]) = (0.0, 0.0, 0.0);
        }
        material.rigidity = Profile::PerNode(rigidity);
        if !m.breaks.is_empty() {
            material.tension = Profile::PerNode(tension);
        }
    }
    Ok(material)
}

pub(super) fn body(text: &SceneText, rules: Rules, folder: &Path) -> Result<Body, SceneError> {
    let topology = topology(&text.snake.topology, rules);
    let (shape, key) = match &text.snake.rest {
        Some(rest) => (rest, "snake.rest"),
        None => (&text.snake.start, "snake.start"),
    };
    let rest = nodes(text, shape, key, rules, folder)?;
    let n = rest.len();
    elastic::validate_nodes(&rest, topology).map_err(|e| shape::refused(key, &e))?;
    let rule = match rules.spacing {
        Rule::Corrected => SpacingRule::Closed,
        Rule::Report => SpacingRule::OpenMean,
    };
    let spacing = elastic::spacing(&rest, topology.is_closed(), rule);
    let frame = match rules.frame {
        Rule::Report => Frame::report(),
        Rule::Corrected => Frame::corrected(),
    };
    let mut body = Body {
        topology,
        rest,
        spacing,
        material: material(text, n)?,
        mass: profile("densities.mass", &text.densities.mass, n)?,
        damping: profile("densities.damping", &text.densities.damping, n)?,
        internal: 0.0,
        frame,
        schedules: schedules(text)?,
    };
    body.validate().map_err(|e| refused(key, &e))?;
    body.recenter().map_err(|e| refused(key, &e))?;
    Ok(body)
}

pub(super) fn start(
    text: &SceneText,
    body: &Body,
    rules: Rules,
    folder: &Path,
) -> Result<State, SceneError> {
    let x = nodes(text, &text.snake.start, "snake.start", rules, folder)?;
    if x.len() != body.len() {
        let (got, needed) = (x.len(), body.len());
        let message = format!("has {got} nodes, but the rest shape has {needed}; as many would do");
        return Err(SceneError::key("snake.start", message));
    }
    let velocity = number::place("snake.velocity", text.snake.velocity)?;
    let spin = number::coordinate("snake.spin", text.snake.spin)?;
    let center = elastic::center(&x, None);
    let held = body.topology.held(body.len());
    let mut state = State::at_rest(x);
    for i in 0..state.v.len() {
        if !held[i] {
            state.v[i] = velocity + (state.x[i] - center).perp() * spin;
        }
    }
    debug_assert!(state.v.iter().all(|v: &DVec2| v.is_finite()));
    Ok(state)
}

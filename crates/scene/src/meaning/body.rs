//! The body: rest shape, material, densities, schedules; and the state it starts in.

use elastic::{Material, Profile, SpacingRule};
use glam::DVec2;
use integrator::State;
use snake::{Body, Damping, Frame, Maps, Schedule, Schedules, Snake, SnakeError, Term};

use super::files::Files;
use super::shape::{self, nodes, topology};
use super::{Rules, number, refused};
use crate::SceneError;
use crate::error::clip;
use crate::file::{
    DampingText, FrameText, FrameWord, InternalText, ProfileText, Rule, SceneText, TermText,
};

pub(crate) fn profile(key: &str, text: &ProfileText, n: usize) -> Result<Profile, SceneError> {
    match text {
        ProfileText::Uniform(value) => Ok(Profile::Uniform(*value)),
        ProfileText::PerNode(values) if values.len() == n => Ok(Profile::PerNode(values.clone())),
        ProfileText::PerNode(values) => {
            let got = values.len();
            let message = format!("has {got} numbers for {n} nodes; needed: one a node");
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
        let message = format!("{message}; needed: [[{first}, {second}], …]");
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
    if s.higher.is_some() && text.material.higher.is_empty() {
        let message = "there is nothing to multiply: give material.higher its weights";
        return Err(SceneError::key("schedule.higher", message));
    }
    Ok(Schedules {
        tether: one("tether", &s.tether)?,
        tension: one("tension", &s.tension)?,
        rigidity: one("rigidity", &s.rigidity)?,
        mass: one("mass", &s.mass)?,
        damping: one("damping", &s.damping)?,
        higher: one("higher", &s.higher)?,
    })
}

fn material(text: &SceneText, n: usize) -> Result<Material, SceneError> {
    let m = &text.material;
    let mut material = Material {
        tether: profile("material.tether", &m.tether.profile, n)?,
        tension: profile("material.tension", &m.tension.profile, n)?,
        rigidity: profile("material.rigidity", &m.rigidity.profile, n)?,
        higher: (m.higher.iter())
            .map(|weight| profile("material.higher", weight, n))
            .collect::<Result<_, _>>()?,
    };
    for (key, list) in [
        ("material.corners", &m.corners),
        ("material.breaks", &m.breaks),
    ] {
        if let Some(bad) = list.iter().find(|&&i| i >= n) {
            let message = format!("there is no node {bad}; needed: 0 to {}", n - 1);
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
        if !m.higher.is_empty() {
            let refuse = |e| refused("material", &SnakeError::Elastic(e));
            for &i in &m.corners {
                material = material.with_corner(i, n).map_err(refuse)?;
            }
            for &i in &m.breaks {
                material = material.with_break(i, n).map_err(refuse)?;
            }
        }
    }
    Ok(material)
}

pub(super) fn body(text: &SceneText, rules: Rules, files: &Files<'_>) -> Result<Body, SceneError> {
    let topology = topology(&text.snake.topology, rules);
    let (shape, key) = match &text.snake.rest {
        Some(rest) => (rest, "snake.rest"),
        None => (&text.snake.start, "snake.start"),
    };
    let rest = nodes(text, shape, key, rules, files)?;
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
    let frame = match &text.snake.frame {
        None | Some(FrameText::Word(FrameWord::Translating)) => frame,
        Some(_) if rules.frame == Rule::Report => {
            let message = "the report's frame does not turn; needed: rules.frame = \"corrected\"";
            return Err(SceneError::key("snake.frame", message));
        }
        Some(_) => Frame::turning(),
    };
    let mut body = Body {
        topology,
        rest,
        spacing,
        material: material(text, n)?,
        mass: profile("densities.mass", &text.densities.mass.profile, n)?,
        damping: match &text.densities.damping {
            DampingText::Given(given) => profile("densities.damping", &given.profile, n)?,
            DampingText::Rule(_) => Profile::Uniform(0.0),
        },
        internal: match &text.densities.internal {
            Some(InternalText::Given(time)) => *time,
            Some(InternalText::Rule(_)) | None => 0.0,
        },
        frame,
        schedules: schedules(text)?,
        maps: Maps::default(),
    };
    body.validate().map_err(|e| refused(key, &e))?;
    body.recenter().map_err(|e| refused(key, &e))?;
    Ok(body)
}

/// Let the rules of `[densities]` choose the damping of a snake, which is at `start`.
pub(super) fn damp(text: &SceneText, snake: &mut Snake, start: &State) -> Result<(), SceneError> {
    let chosen = |key: &str, word: &str, inside: bool| -> Result<Damping, SceneError> {
        let refuse = |message: String| SceneError::key(key, message);
        let known = if inside {
            "a time, \"critical\" or \"mode(k)\""
        } else {
            "a profile, \"critical\", \"mode(k)\", \"local\" or \"renewed(time)\""
        };
        let rule = match word.trim() {
            "critical" => Damping::Mode(0),
            other => other.parse().map_err(|_| {
                refuse(format!(
                    "there is no rule {:?}; needed: {known}",
                    clip(other)
                ))
            })?,
        };
        match (rule, inside) {
            (Damping::Mode(mode), true) => Ok(Damping::InternalMode(mode)),
            (Damping::Mode(_) | Damping::Local | Damping::Renewed(_), false) => Ok(rule),
            _ => Err(refuse(format!(
                "{rule} is no rule of this key; needed: {known}"
            ))),
        }
    };
    let mut rules = Vec::new();
    if let Some(InternalText::Rule(word)) = &text.densities.internal {
        let key = "densities.internal";
        rules.push((key, chosen(key, word, true)?));
    }
    if let DampingText::Rule(word) = &text.densities.damping {
        let key = "densities.damping";
        let rule = chosen(key, word, false)?;
        if matches!(rule, Damping::Renewed(_)) && text.upkeep.is_some() {
            let message = "nodes that come and go are damped as their neighbours are; needed: \"local\" with [upkeep]";
            return Err(SceneError::key(key, message));
        }
        rules.push((key, rule));
    }
    for (key, rule) in rules {
        snake
            .damp(rule, start)
            .map_err(|e| SceneError::key(key, e))?;
    }
    Ok(())
}

/// The inertial forces of a frame that turns by its own equation; None for one that does not.
pub(super) fn terms(text: &SceneText) -> Result<Option<Vec<Term>>, SceneError> {
    let Some(FrameText::Terms(kept)) = &text.snake.frame else {
        return Ok(None);
    };
    let term = |text: &TermText| match text {
        TermText::Centrifugal => Term::Centrifugal,
        TermText::Coriolis => Term::Coriolis,
        TermText::Transverse => Term::Transverse,
    };
    Ok(Some(kept.terms.iter().map(term).collect()))
}

pub(super) fn start(
    text: &SceneText,
    body: &Body,
    rules: Rules,
    files: &Files<'_>,
) -> Result<State, SceneError> {
    let x = nodes(text, &text.snake.start, "snake.start", rules, files)?;
    if x.len() != body.len() {
        let (got, needed) = (x.len(), body.len());
        let message = format!("has {got} nodes, but the rest shape has {needed}; needed: as many");
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

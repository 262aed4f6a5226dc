//! From the text of a scene to the scene: what the words mean, and every refusal by its key.

use std::path::Path;
use std::sync::Arc;

use elastic::{End, Material, Parameter, Profile, SpacingRule, Topology};
use field::{EdgeForce, ForceField, Smoothing};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use snake::{
    Body, Center, External, Frame, ImageForce, Rest, Sampling, Schedule, Schedules, Snake, Until,
    Wall, WallLaw, World,
};

use crate::file::{
    BorderText, EndText, LawText, OpenClosed, PictureText, ProfileText, Rule, RulesText, SceneText,
    ShapeText, TopologyText, UpDown,
};
use crate::scene::{Plan, Recording, Scene, View};
use crate::{Contour, Picture, SceneError, catalogue};

/// Whose rules each part follows, after `all` has been filled in.
#[derive(Debug, Clone, Copy)]
struct Rules {
    frame: Rule,
    ends: Rule,
    field: Rule,
    sampling: Rule,
    spline: Rule,
    spacing: Rule,
    start: Rule,
    border: Rule,
    clock: Rule,
    scheme: Rule,
}

impl Rules {
    fn of(text: &RulesText) -> Self {
        let (all, each) = match text {
            RulesText::All(rule) => (*rule, Box::default()),
            RulesText::Each(each) => (each.all.unwrap_or(Rule::Corrected), each.clone()),
        };
        Self {
            frame: each.frame.unwrap_or(all),
            ends: each.ends.unwrap_or(all),
            field: each.field.unwrap_or(all),
            sampling: each.sampling.unwrap_or(all),
            spline: each.spline.unwrap_or(all),
            spacing: each.spacing.unwrap_or(all),
            start: each.start.unwrap_or(all),
            border: each.border.unwrap_or(all),
            clock: each.clock.unwrap_or(all),
            scheme: all,
        }
    }
}

/// Build the scene of `text`; files it names are looked for in `folder`.
pub(crate) fn build(name: &str, text: &SceneText, folder: &Path) -> Result<Scene, SceneError> {
    let rules = Rules::of(&text.rules);
    let picture = text
        .picture
        .as_ref()
        .map(|p| picture(p, folder))
        .transpose()?;
    let field = picture
        .as_ref()
        .map(|p| force_field(text, rules, p))
        .transpose()?
        .map(Arc::new);
    let body = body(text, rules, folder)?;
    let world = world(text, rules, picture.as_ref(), field.clone(), body.len())?;
    let start = start(text, &body, rules, folder)?;
    if let (Some(picture), Some(_)) = (&picture, &field) {
        inside(&start, picture, rules)?;
    }
    let snake = Snake::new(body, world).map_err(|e| SceneError::key(place(&e), e))?;
    let plan = plan(text, rules)?;
    let view = View {
        y_up: text.view.y == Some(UpDown::Up),
        window: text
            .view
            .window
            .map(|[x0, y0, x1, y1]| (DVec2::new(x0, y0), DVec2::new(x1, y1))),
    };
    Ok(Scene {
        name: name.to_owned(),
        title: text.title.clone(),
        report: text.report.clone(),
        note: text.note.clone(),
        view,
        picture: picture.map(Arc::new),
        field,
        snake,
        start,
        plan,
    })
}

/// The table of the file that an error of the body or the world belongs to.
fn place(error: &snake::SnakeError) -> &'static str {
    match error {
        snake::SnakeError::NoMass => "densities.mass",
        snake::SnakeError::BadSchedule { .. } => "schedule",
        snake::SnakeError::NoNormal { .. } => "world.wall",
        snake::SnakeError::Elastic(elastic::ElasticError::BadParameter { name, .. })
        | snake::SnakeError::Elastic(elastic::ElasticError::WrongLength { name, .. })
        | snake::SnakeError::BadNumber { name, .. } => match *name {
            "mass" => "densities.mass",
            "damping" => "densities.damping",
            "tether" => "material.tether",
            "tension" => "material.tension",
            "rigidity" => "material.rigidity",
            "gravity" => "world.gravity",
            "image weight" => "field.weight",
            _ if name.starts_with("a wall") => "world.wall",
            _ => "snake",
        },
        _ => "snake",
    }
}

fn picture(text: &PictureText, folder: &Path) -> Result<Picture, SceneError> {
    match text {
        PictureText::File(file) => Picture::load(&folder.join(file)),
        PictureText::Shipped(name) => Picture::shipped(name),
        PictureText::Drawn(drawn) => Picture::drawn(drawn),
    }
}

/// The report's scale for its pictures (meant for their display, D48).
const REPORT_SCALE: f64 = 0.15;
/// The report's gain (D40).
const REPORT_GAIN: f64 = 10.0;
/// The report's passes (D37).
const PASSES: u32 = 20;
/// Gain of the corrected field: `0.15 · 4 · 10`, so that an edge pulls as hard as under the
/// report's rules and its material parameters mean the same.
const GAIN: f64 = 6.0;

fn force_field(
    text: &SceneText,
    rules: Rules,
    picture: &Picture,
) -> Result<ForceField, SceneError> {
    let f = &text.field;
    let refuse = |error: field::FieldError| SceneError::key("field", error);
    if f.passes.is_some() && f.sigma.is_some() {
        return Err(SceneError::key(
            "field.sigma",
            "give either passes or sigma, not both",
        ));
    }
    match rules.field {
        Rule::Report => {
            if f.sigma.is_some() {
                return Err(SceneError::key(
                    "field.sigma",
                    "the report's field smooths by passes",
                ));
            }
            let scale = f.scale.unwrap_or(REPORT_SCALE);
            let gain = f.gain.unwrap_or(REPORT_GAIN);
            let passes = f.passes.unwrap_or(PASSES);
            field::report_force(&picture.levels, passes, scale, gain).map_err(refuse)
        }
        Rule::Corrected => {
            let smoothing = match f.sigma {
                Some(sigma) => Smoothing::Gaussian(sigma),
                None => Smoothing::Binomial(f.passes.unwrap_or(PASSES)),
            };
            let gain = f.gain.unwrap_or(GAIN) * f.scale.unwrap_or(1.0);
            field::edge_force(&picture.levels, &EdgeForce { smoothing, gain }).map_err(refuse)
        }
    }
}

fn topology(text: &TopologyText, rules: Rules) -> Topology {
    let end = |end: EndText| match end {
        EndText::Free => End::Free,
        EndText::Anchored => End::Anchored,
        EndText::Pinned => End::Pinned,
    };
    match text {
        TopologyText::Word(OpenClosed::Closed) => Topology::Closed,
        TopologyText::Word(OpenClosed::Open) => {
            let both = if rules.ends == Rule::Report {
                End::Anchored
            } else {
                End::Free
            };
            Topology::Open {
                head: both,
                tail: both,
            }
        }
        TopologyText::Ends(ends) => Topology::Open {
            head: end(ends.head),
            tail: end(ends.tail),
        },
    }
}

fn points(list: &[[f64; 2]]) -> Vec<DVec2> {
    list.iter().map(|&p| DVec2::from_array(p)).collect()
}

/// The nodes of a shape; `key` is where it stands.
fn nodes(
    text: &SceneText,
    shape: &ShapeText,
    key: &str,
    rules: Rules,
    folder: &Path,
) -> Result<Vec<DVec2>, SceneError> {
    let closed = matches!(topology(&text.snake.topology, rules), Topology::Closed);
    let parameter = match rules.spline {
        Rule::Report => Parameter::PointIndex,
        Rule::Corrected => Parameter::ArcLength,
    };
    let refuse = |error: elastic::ElasticError| SceneError::key(key, error);
    let count = || {
        let n = text
            .snake
            .nodes
            .ok_or_else(|| SceneError::key("snake.nodes", "is missing"))?;
        if n > MOST_NODES {
            let message = format!("got {n}; at most {MOST_NODES} would do");
            return Err(SceneError::key("snake.nodes", message));
        }
        Ok(n)
    };
    let through =
        |clicks: &[DVec2]| elastic::spline(clicks, count()?, parameter, closed).map_err(refuse);
    match shape {
        ShapeText::Circle(c) => Ok(elastic::circle(
            DVec2::from_array(c.center),
            c.radius,
            count()?,
        )),
        ShapeText::Ellipse(e) => {
            let axes = DVec2::from_array(e.axes);
            Ok(elastic::ellipse(
                DVec2::from_array(e.center),
                axes,
                e.angle,
                count()?,
            ))
        }
        ShapeText::Segment(s) => {
            let (from, to) = (DVec2::from_array(s.from), DVec2::from_array(s.to));
            Ok(elastic::segment(from, to, count()?))
        }
        ShapeText::Points(list) => through(&points(list)),
        ShapeText::Nodes(list) => Ok(points(list)),
        ShapeText::File(file) => through(&Contour::load(&folder.join(file))?.points),
        ShapeText::Shipped(name) => through(&catalogue::contour(name)?.points),
    }
}

/// Nodes a snake may have.
const MOST_NODES: usize = 10_000_000;

fn profile(key: &str, text: &ProfileText, n: usize) -> Result<Profile, SceneError> {
    match text {
        ProfileText::Uniform(value) => Ok(Profile::Uniform(*value)),
        ProfileText::PerNode(values) if values.len() == n => Ok(Profile::PerNode(values.clone())),
        ProfileText::PerNode(values) => {
            let message = format!(
                "has {} numbers for {n} nodes; one a node would do",
                values.len()
            );
            Err(SceneError::key(key, message))
        }
        ProfileText::Along(along) => {
            // a schedule in s instead of t: the same straight lines between points
            let pairs = along.along.iter().map(|&[s, value]| (s, value)).collect();
            let line = Schedule::new(pairs)
                .map_err(|e| SceneError::key(key, format!("along = [[s, value], …]: {e}")))?;
            let last = (n.max(2) - 1) as f64;
            Ok(Profile::PerNode(
                (0..n).map(|i| line.at(i as f64 / last)).collect(),
            ))
        }
    }
}

fn body(text: &SceneText, rules: Rules, folder: &Path) -> Result<Body, SceneError> {
    let topology = topology(&text.snake.topology, rules);
    let (shape, key) = match &text.snake.rest {
        Some(rest) => (rest, "snake.rest"),
        None => (&text.snake.start, "snake.start"),
    };
    let rest = nodes(text, shape, key, rules, folder)?;
    let n = rest.len();
    elastic::validate_nodes(&rest, topology).map_err(|e| {
        let few = matches!(e, elastic::ElasticError::TooFewNodes { .. });
        SceneError::key(if few { "snake.nodes" } else { key }, e)
    })?;
    let mut material = Material {
        tether: profile("material.tether", &text.material.tether, n)?,
        tension: profile("material.tension", &text.material.tension, n)?,
        rigidity: profile("material.rigidity", &text.material.rigidity, n)?,
    };
    for (key, list) in [
        ("material.corners", &text.material.corners),
        ("material.breaks", &text.material.breaks),
    ] {
        if let Some(bad) = list.iter().find(|&&i| i >= n) {
            let message = format!("there is no node {bad}; 0 to {} would do", n - 1);
            return Err(SceneError::key(key, message));
        }
    }
    for &i in &text.material.corners {
        material = material
            .with_corner(i, n)
            .map_err(|e| SceneError::key("material.corners", e))?;
    }
    for &i in &text.material.breaks {
        material = material
            .with_break(i, n)
            .map_err(|e| SceneError::key("material.breaks", e))?;
    }
    let rule = match rules.spacing {
        Rule::Corrected => SpacingRule::Closed,
        Rule::Report => SpacingRule::OpenMean,
    };
    let spacing = elastic::spacing(&rest, topology.is_closed(), rule);
    let frame = match rules.frame {
        Rule::Report => Frame {
            center: Center::Mean,
            reaction: false,
        },
        Rule::Corrected => Frame::corrected(),
    };
    let mut body = Body {
        topology,
        rest,
        spacing,
        material,
        mass: profile("densities.mass", &text.densities.mass, n)?,
        damping: profile("densities.damping", &text.densities.damping, n)?,
        frame,
        schedules: schedules(text)?,
    };
    body.validate().map_err(|e| SceneError::key(place(&e), e))?;
    body.recenter()
        .map_err(|e| SceneError::key("densities.mass", e))?;
    Ok(body)
}

fn schedules(text: &SceneText) -> Result<Schedules, SceneError> {
    let one = |key: &str, list: &Option<Vec<[f64; 2]>>| -> Result<Option<Schedule>, SceneError> {
        list.as_ref()
            .map(|list| Schedule::new(list.iter().map(|&[t, f]| (t, f)).collect()))
            .transpose()
            .map_err(|e| SceneError::key(&format!("schedule.{key}"), e))
    };
    let s = &text.schedule;
    Ok(Schedules {
        tether: one("tether", &s.tether)?,
        tension: one("tension", &s.tension)?,
        rigidity: one("rigidity", &s.rigidity)?,
        mass: one("mass", &s.mass)?,
        damping: one("damping", &s.damping)?,
    })
}

fn world(
    text: &SceneText,
    rules: Rules,
    picture: Option<&Picture>,
    field: Option<Arc<ForceField>>,
    n: usize,
) -> Result<World, SceneError> {
    let mut world = World::default();
    if let Some(g) = text.world.gravity {
        world
            .externals
            .push(External::Gravity(DVec2::from_array(g)));
    }
    if let Some(field) = field {
        let sampling = match rules.sampling {
            Rule::Report => Sampling::OneAxis,
            Rule::Corrected => Sampling::Bilinear,
        };
        let weight = match &text.field.weight {
            Some(weight) => profile("field.weight", weight, n)?,
            None => Profile::Uniform(1.0),
        };
        world.externals.push(External::Image(ImageForce {
            field,
            sampling,
            weight,
        }));
    }
    for wall in &text.world.wall {
        let law = match &wall.law {
            LawText::Clamp => WallLaw::Clamp,
            LawText::Penalty(p) => WallLaw::Penalty {
                stiffness: p.stiffness,
                damping: p.damping,
            },
            LawText::Impact(i) => WallLaw::Impact {
                restitution: i.restitution,
                friction: i.friction,
            },
        };
        let (point, normal) = (
            DVec2::from_array(wall.point),
            DVec2::from_array(wall.normal),
        );
        world
            .walls
            .push(Wall::new(point, normal, law).map_err(|e| SceneError::key("world.wall", e))?);
    }
    if let Some(picture) = picture {
        let (width, height) = picture.size();
        let far = DVec2::new((width - 1) as f64, (height - 1) as f64);
        let border = text.world.border.unwrap_or(match rules.border {
            Rule::Report => BorderText::Clamp,
            Rule::Corrected => BorderText::Stop,
        });
        let stop = WallLaw::Impact {
            restitution: 0.0,
            friction: 0.0,
        };
        let sides: &[(DVec2, DVec2)] = match border {
            BorderText::None => &[],
            BorderText::Clamp => &[(DVec2::ZERO, DVec2::Y), (far, DVec2::NEG_Y)],
            BorderText::Stop => &[
                (DVec2::ZERO, DVec2::Y),
                (far, DVec2::NEG_Y),
                (DVec2::ZERO, DVec2::X),
                (far, DVec2::NEG_X),
            ],
        };
        let law = if border == BorderText::Clamp {
            WallLaw::Clamp
        } else {
            stop
        };
        for &(point, normal) in sides {
            world.walls.push(
                Wall::new(point, normal, law).map_err(|e| SceneError::key("world.border", e))?,
            );
        }
    }
    Ok(world)
}

fn start(text: &SceneText, body: &Body, rules: Rules, folder: &Path) -> Result<State, SceneError> {
    let x = nodes(text, &text.snake.start, "snake.start", rules, folder)?;
    if x.len() != body.len() {
        let message = format!(
            "has {} nodes, but the rest shape has {}",
            x.len(),
            body.len()
        );
        return Err(SceneError::key("snake.start", message));
    }
    if let Some(i) = x.iter().position(|p| !p.is_finite()) {
        return Err(SceneError::key(
            "snake.start",
            format!("node {i} is no place: {}", x[i]),
        ));
    }
    let velocity = DVec2::from_array(text.snake.velocity);
    if !velocity.is_finite() || !text.snake.spin.is_finite() {
        return Err(SceneError::key(
            "snake.velocity",
            "velocity and spin must be finite",
        ));
    }
    let center = elastic::center(&x, None);
    let mut state = State::at_rest(x);
    for i in 0..state.v.len() {
        let turning = (state.x[i] - center).perp() * text.snake.spin;
        state.v[i] = if body.topology.held(body.len())[i] {
            DVec2::ZERO
        } else {
            velocity + turning
        };
    }
    Ok(state)
}

/// Refuse a start of which a node is off the picture. The report's program lets a node begin up to
/// a pixel above it, where its clamp catches it (D54, D57).
fn inside(start: &State, picture: &Picture, rules: Rules) -> Result<(), SceneError> {
    let (width, height) = picture.size();
    let half = DVec2::splat(if rules.border == Rule::Report {
        1.0
    } else {
        0.5
    });
    let far = DVec2::new(width as f64, height as f64) - half;
    match start
        .x
        .iter()
        .position(|p| p.cmplt(-half).any() || p.cmpgt(far).any())
    {
        None => Ok(()),
        Some(i) => {
            let p = start.x[i];
            let message = format!(
                "node {i} at ({:.2}, {:.2}) is outside the picture of {width}×{height} pixels",
                p.x, p.y
            );
            Err(SceneError::key("snake.start", message))
        }
    }
}

fn plan(text: &SceneText, rules: Rules) -> Result<Plan, SceneError> {
    let run = &text.run;
    let scheme = match &run.scheme {
        Some(name) => name
            .parse::<Scheme>()
            .map_err(|e| SceneError::key("run.scheme", e))?,
        None if rules.scheme == Rule::Report => Scheme::Report,
        None => Scheme::Leapfrog,
    };
    if !(run.dt.is_finite() && run.dt > 0.0) {
        let message = format!("must be finite and above 0, got {}", run.dt);
        return Err(SceneError::key("run.dt", message));
    }
    let steps = match (run.steps, run.time) {
        (Some(steps), None) => steps,
        (None, Some(time)) if time.is_finite() && time >= 0.0 && time / run.dt < MOST_STEPS => {
            match rules.clock {
                Rule::Report => integrator::report_steps(time, run.dt).ok_or_else(|| {
                    SceneError::key("run.time", "takes more steps than can be counted")
                })?,
                Rule::Corrected => steps_in(time, run.dt),
            }
        }
        (None, Some(time)) => {
            let message =
                format!("must be finite, at least 0 and below {MOST_STEPS:e} steps, got {time}");
            return Err(SceneError::key("run.time", message));
        }
        (None, None) => {
            return Err(SceneError::key(
                "run",
                "needs steps or time, so that it ends",
            ));
        }
        (Some(_), Some(_)) => {
            return Err(SceneError::key(
                "run",
                "give either steps or time, not both",
            ));
        }
    };
    let rest = match &run.rest {
        None => None,
        Some(rest) => {
            for (key, value) in [("speed", rest.speed), ("force", rest.force)] {
                if !(value.is_finite() && value > 0.0) {
                    let message = format!("must be finite and above 0, got {value}");
                    return Err(SceneError::key(&format!("run.rest.{key}"), message));
                }
            }
            Some(Rest {
                speed: rest.speed,
                force: rest.force,
                every: rest.every.max(1),
            })
        }
    };
    let start_rule = match rules.start {
        Rule::Report => Start::FirstOrder,
        Rule::Corrected => Start::SecondOrder,
    };
    let record = &text.record;
    let recording = Recording {
        every: record.every,
        steps: record.steps.clone().unwrap_or_default(),
        velocities: record.velocities,
        energies: record.energies,
    };
    if recording.every == Some(0) {
        return Err(SceneError::key("record.every", "must be at least 1, got 0"));
    }
    let until = Until { steps, rest };
    Ok(Plan {
        scheme,
        dt: run.dt,
        until,
        start_rule,
        force: run.force,
        recording,
    })
}

/// Steps that a time may be long; a run of more says so by `steps`.
const MOST_STEPS: f64 = 1e9;

/// Steps that fill `time`: the nearest whole number, not an accumulated one (D20).
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the caller has checked that the quotient is from 0 to 1e9"
)]
fn steps_in(time: f64, dt: f64) -> u64 {
    (time / dt).round() as u64
}

//! A fit that is watched: stepped, edited, finished.

use std::ops::ControlFlow;

use elastic::{ElasticError, Material, Parameter, Profile, Topology};
use glam::DVec2;
use integrator::{Relaxation, Scheme, Start, State, Stepper};
use snake::{
    Acting, Body, Certificate, ImageForce, Outcome, Rest, Running, Sampling, Snake, SnakeError, Spring, Until, Wall,
    WallLaw, World,
};

use crate::limits::MOST_NODES;
use crate::options::Step;
use crate::result::StepReason;
use crate::{
    Choices, Contour, Evidence, Fit, FitError, OptionKey, Prepared, Problem, nodes::node_evidence,
};

/// The least distance of the found sides of a bar that is wide enough, in σ: those of a thin line are 2 σ apart
/// however thin it is, those of a bar of 2 σ are 2.3 σ.
const RESOLVES: f64 = 2.5;

/// The first step of a fit that chooses its steps; it is cut at once where it moves a node too far. T.
const FIRST_DT: f64 = 1.0;

/// The longest way of a node in a step, in σ: over a quarter of σ the force of an edge is linear to a
/// fourteenth of its largest value, ½ · 1.38 · (1/4)² of 0.61 (with f = s e^(−s²/2) and 1.38 its most curvature).
const REACH: f64 = 0.25;

/// The longest step for chosen forces: no slope tells how far a step may go where a force jumps. T.
const MOST_CHOSEN_DT: f64 = 0.2;

/// A curve on its way to an outline, one step or many at a time.
///
/// ```
/// use fit::{Contour, Edit, Image, Options, Prepared};
/// use glam::DVec2;
///
/// let bright = |x: usize, y: usize| (x as f64 - 30.0).hypot(y as f64 - 30.0) < 15.0;
/// let levels = field::Grid::from_shape_fn((61, 61), |(y, x)| if bright(x, y) { 200.0 } else { 50.0 });
/// let prepared = Prepared::of(&Image::grey(levels), &Options::default())?;
/// let mut session = prepared.session(&Contour::circle(DVec2::new(31.0, 30.0), 18.0))?;
/// while session.step(5).is_none() {} // draw session.nodes() here
/// session.edit(Edit::Pull { node: 0, to: DVec2::new(52.0, 30.0), stiffness: 20.0 })?;
/// session.step(200);
/// assert!(session.nodes()[0].x > 47.0);
/// session.edit(Edit::LetGo)?;
/// assert!((session.finish().contour.points[0].x - 45.0).abs() < 1.0);
/// # Ok::<(), fit::FitError>(())
/// ```
#[derive(Debug)]
pub struct Session {
    prepared: Prepared,
    snake: Snake,
    start: Vec<DVec2>,
    closed: bool,
    state: State,
    stepper: Box<dyn Stepper>,
    running: Running,
    outcome: Option<Outcome>,
    chosen: Choices,
}

/// What a user does to a curve between two steps.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Edit {
    /// Hold these nodes where they are.
    Hold(Vec<usize>),
    /// Let these nodes go.
    Release(Vec<usize>),
    /// Pull a node by a spring; a further pull takes its place.
    Pull {
        /// Which node.
        node: usize,
        /// To where. Pixels.
        to: DVec2,
        /// Stiffness of the spring. M L² T⁻².
        stiffness: f64,
    },
    /// Pull no longer.
    LetGo,
    /// Let the edge force pull with another strength, as [`Options::strength`](crate::Options::strength) says.
    Strength(f64),
    /// Give the curve another resistance.
    Material {
        /// As [`Options::tether`](crate::Options::tether).
        tether: f64,
        /// As [`Options::tension`](crate::Options::tension).
        tension: f64,
        /// As [`Options::rigidity`](crate::Options::rigidity).
        rigidity: f64,
    },
}

/// What the pulling spring is called.
const HAND: &str = "hand";

impl Session {
    pub(crate) fn new(prepared: &Prepared, start: &Contour) -> Result<Self, FitError> {
        let closed = start.closed;
        let x = place(prepared, start)?;
        let options = prepared.options();
        let topology = if closed {
            Topology::Closed
        } else {
            Topology::open(elastic::End::Free)
        };
        let material = Material::uniform(options.tether, options.tension, options.rigidity);
        let body = Body::of(&x, topology, 1.0)
            .map_err(unfit)?
            .with_material(material)
            .with_damping(options.damping);
        let spacing = body.spacing;
        let world = bordered(prepared.world(&x, closed)?, prepared)?;
        let mut snake = Snake::new(body, world).map_err(unfit)?;
        let mut state = State::at_rest(x.clone());
        let (stepper, chosen) = mover(prepared, &mut snake, &state)?;
        let running = Running::begin(&mut snake, &state, until(options.steps));
        state.step = 0;
        let chosen = Choices {
            contrast: prepared.sight().true_contrast(),
            nodes: x.len(),
            spacing,
            gain: prepared.field().map(|_| prepared.gain()),
            ..chosen
        };
        Ok(Self {
            prepared: prepared.clone(),
            snake,
            start: x,
            closed,
            state,
            stepper,
            running,
            outcome: None,
            chosen,
        })
    }

    /// Make so many steps; how it ended, if it has ended.
    pub fn step(&mut self, steps: u64) -> Option<Outcome> {
        if self.outcome.is_none() {
            let watch = &mut |_: &mut Snake, _: &State| ControlFlow::Continue(());
            let stepper = &mut *self.stepper;
            let running = &mut self.running;
            self.outcome = running.go(&mut self.snake, stepper, &mut self.state, (steps, watch));
        }
        self.outcome
    }

    /// The nodes as they are.
    #[must_use]
    pub fn nodes(&self) -> &[DVec2] {
        &self.state.x
    }

    /// The nodes as they were at the start.
    #[must_use]
    pub fn start(&self) -> &[DVec2] {
        &self.start
    }

    /// Steps made so far.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.state.step
    }

    /// What was chosen, and why.
    #[must_use]
    pub const fn chosen(&self) -> &Choices {
        &self.chosen
    }

    /// Change something; the curve moves on from where it is, with all the steps there may be.
    ///
    /// # Errors
    ///
    /// By its key: a node that there is not, a number out of its range; then nothing has changed.
    pub fn edit(&mut self, edit: Edit) -> Result<(), FitError> {
        let refuse = |key: OptionKey| move |error: SnakeError| FitError::new(key, error);
        match edit {
            Edit::Hold(nodes) => self.snake.hold(nodes).map_err(refuse(OptionKey::Nodes))?,
            Edit::Release(nodes) => self
                .snake
                .release(nodes)
                .map_err(refuse(OptionKey::Nodes))?,
            Edit::Pull {
                node,
                to,
                stiffness,
            } => {
                if node >= self.state.len() || !to.is_finite() {
                    let problem = Problem::Count {
                        least: 0,
                        most: self.state.len() as u64 - 1,
                        got: node as u64,
                    };
                    return Err(FitError::new(OptionKey::Nodes, problem));
                }
                let stiffness = Problem::above_zero(stiffness)
                    .map_err(|problem| FitError::new(OptionKey::Strength, problem))?;
                let spring = Acting::new(Spring::at_node(node, to, stiffness)).named(HAND);
                let before = self.snake.remove_force(HAND);
                if let Err(error) = self.snake.add_force(spring) {
                    if let Some(before) = before {
                        // it was there, so it is not refused
                        let _ = self.snake.add_force(before);
                    }
                    return Err(FitError::new(OptionKey::Strength, error));
                }
            }
            Edit::LetGo => drop(self.snake.remove_force(HAND)),
            Edit::Strength(strength) => self.pull_by(strength)?,
            Edit::Material {
                tether,
                tension,
                rigidity,
            } => {
                for (key, value) in [
                    (OptionKey::Tether, tether),
                    (OptionKey::Tension, tension),
                    (OptionKey::Rigidity, rigidity),
                ] {
                    Problem::at_least_zero(value).map_err(|problem| FitError::new(key, problem))?;
                }
                let material = Material::uniform(tether, tension, rigidity);
                let body = self.snake.body().clone().with_material(material);
                let set = self.snake.set_body(body);
                set.map_err(refuse(OptionKey::Rigidity))?;
            }
        }
        self.begin_again();
        Ok(())
    }

    /// The edge force with another strength.
    fn pull_by(&mut self, strength: f64) -> Result<(), FitError> {
        let strength = Problem::above_zero(strength)
            .map_err(|problem| FitError::new(OptionKey::Strength, problem))?;
        let Some(field) = self.prepared.field() else {
            let message = "is that of the edge force, and other forces were chosen";
            let problem = Problem::Other(message.to_owned());
            return Err(FitError::new(OptionKey::Strength, problem));
        };
        let weight = strength / self.prepared.options().strength;
        let force = ImageForce::new(field.clone(), Sampling::Bilinear);
        let acting = Acting::new(force).weighted(Profile::Uniform(weight));
        let replaced = self.snake.replace_force("image", acting);
        replaced.map_err(|error| FitError::new(OptionKey::Strength, error))?;
        Ok(())
    }

    /// Look for rest anew.
    fn begin_again(&mut self) {
        self.stepper.resume(&mut self.snake, &self.state);
        let until = until(self.prepared.options().steps);
        self.running = Running::begin(&mut self.snake, &self.state, until);
        self.outcome = None;
    }

    /// Move on to the end, and say what was found.
    #[must_use]
    pub fn finish(mut self) -> Fit {
        let outcome = self.step(u64::MAX);
        // it always ends: the steps are counted
        let step = self.state.step;
        let outcome = outcome.unwrap_or(Outcome::Finished { step });
        let blown_up = matches!(outcome, Outcome::Diverged { .. });
        let settled = matches!(outcome, Outcome::Settled { .. });
        let sigma = self.prepared.options().sigma;
        let quality = settled.then(|| {
            Evidence::of(&mut self.snake, &self.start, &self.state, Some(RESOLVES * sigma))
        });
        let nodes = if blown_up {
            Vec::new()
        } else {
            node_evidence(&self.prepared, &mut self.snake, &self.state)
        };
        Fit {
            contour: Contour {
                points: self.state.x,
                closed: self.closed,
            },
            nodes,
            quality,
            outcome,
            steps: step,
            chosen: self.chosen,
        }
    }
}

/// When a fit stops: nodes may slide along the outline for as long as they like.
fn until(steps: u64) -> Until {
    let rest = Rest {
        shape: true,
        ..Rest::default()
    };
    Until::at_rest(rest, steps)
}

/// The nodes of a start, evenly along a spline through its points, in the image.
fn place(prepared: &Prepared, start: &Contour) -> Result<Vec<DVec2>, FitError> {
    let clicks = start.clicks();
    let (width, height) = prepared.sight().image().size();
    let most = DVec2::new(width as f64, height as f64) - 0.5;
    // written so that a NaN is outside too
    let inside = |p: &DVec2| p.cmpge(DVec2::splat(-0.5)).all() && p.cmple(most).all();
    if let Some(index) = clicks.iter().position(|p| !inside(p)) {
        let DVec2 { x, y } = clicks[index];
        let problem = Problem::Outside {
            index,
            x,
            y,
            width,
            height,
        };
        return Err(FitError::new(OptionKey::Start, problem));
    }
    let along = elastic::length(&clicks, start.closed);
    let nodes = prepared.options().nodes.along(along);
    if nodes > MOST_NODES {
        let problem = Problem::Count {
            least: 3,
            most: MOST_NODES as u64,
            got: nodes as u64,
        };
        return Err(FitError::new(OptionKey::Nodes, problem));
    }
    let x = elastic::spline(&clicks, nodes, Parameter::ArcLength, start.closed);
    let mut x = x.map_err(|error| curve(&error))?;
    let last = last_pixel(prepared);
    for p in &mut x {
        *p = p.clamp(DVec2::ZERO, last);
    }
    Ok(x)
}

/// The center of the last pixel.
fn last_pixel(prepared: &Prepared) -> DVec2 {
    let (width, height) = prepared.sight().image().size();
    DVec2::new((width - 1) as f64, (height - 1) as f64)
}

/// A world within the borders of the image.
fn bordered(mut world: World, prepared: &Prepared) -> Result<World, FitError> {
    let law = WallLaw::Impact {
        restitution: 0.0,
        friction: 0.0,
    };
    let last = last_pixel(prepared);
    for (point, normal) in [
        (DVec2::ZERO, DVec2::X),
        (DVec2::ZERO, DVec2::Y),
        (last, DVec2::NEG_X),
        (last, DVec2::NEG_Y),
    ] {
        world = world.with_wall(Wall::new(point, normal, law).map_err(unfit)?);
    }
    Ok(world)
}

/// What moves the curve, and why so; the other choices are filled in by the caller.
fn mover(
    prepared: &Prepared,
    snake: &mut Snake,
    state: &State,
) -> Result<(Box<dyn Stepper>, Choices), FitError> {
    let refuse = |error| FitError::new(OptionKey::Step, Problem::Scheme(error));
    let choices = |scheme, step, why| Choices {
        contrast: 0.0,
        nodes: 0,
        spacing: 0.0,
        gain: None,
        scheme,
        step,
        why,
    };
    if prepared.relaxes() {
        let reach = REACH * prepared.options().sigma;
        let stepper = Relaxation::new(snake, state, FIRST_DT, reach).map_err(refuse)?;
        let why = StepReason::Grows { reach };
        return Ok((Box::new(stepper), choices(Relaxation::NAME, FIRST_DT, why)));
    }
    // the usual force is smooth; forces of regions jump, which a scheme that extrapolates them does not bear
    let (scheme, limit) = if prepared.field().is_some() {
        let limit = Certificate::limit_for_slope(snake, Scheme::Sbdf2, prepared.steepest());
        (Scheme::Sbdf2, limit)
    } else {
        let limit = Certificate::limit(snake, Scheme::Leapfrog);
        (Scheme::Leapfrog, limit.map(|limit| limit.dt))
    };
    let limit = limit.unwrap_or(f64::INFINITY);
    let (dt, why) = match prepared.options().step {
        Step::Equal(dt) if dt > limit => {
            let problem = Problem::Unstable {
                most: limit,
                got: dt,
            };
            return Err(FitError::new(OptionKey::Step, problem));
        }
        Step::Equal(dt) => (dt, StepReason::Asked),
        Step::Chosen if 0.5 * limit < MOST_CHOSEN_DT => {
            (0.5 * limit, StepReason::HalfOf { limit })
        }
        Step::Chosen => (MOST_CHOSEN_DT, StepReason::MayJump),
    };
    let stepper = scheme.start(snake, state, dt, Start::SecondOrder);
    Ok((stepper.map_err(refuse)?, choices(scheme.name(), dt, why)))
}

fn unfit(error: SnakeError) -> FitError {
    match error {
        SnakeError::Elastic(error) => curve(&error),
        error => FitError::new(OptionKey::Start, error),
    }
}

/// An error of the curve, under the option it belongs to.
fn curve(error: &ElasticError) -> FitError {
    let key = match error {
        ElasticError::TooFewNodes { .. } => OptionKey::Nodes,
        ElasticError::TooStiff { .. } => OptionKey::Rigidity,
        _ => OptionKey::Start,
    };
    FitError::new(key, error.clone())
}

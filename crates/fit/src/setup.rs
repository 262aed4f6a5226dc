//! From a start and options to a curve that can be moved: its nodes, the borders of its world, its
//! steps.

use elastic::{ElasticError, Parameter};
use glam::DVec2;
use integrator::{Relaxation, Scheme};
use snake::{Certificate, SimulationError, Snake, SnakeError, Stepping, Wall, WallLaw, World};

use crate::limits::MOST_NODES;
use crate::options::Step;
use crate::result::StepReason;
use crate::{Contour, FitError, Moved, OptionKey, Prepared, Problem};

/// The first step of a fit that chooses its steps; it is cut at once where it moves a node too far.
/// T.
const FIRST_DT: f64 = 1.0;

/// The longest way of a node in a step, in σ: over a quarter of σ the force of an edge is linear to
/// a fourteenth of its largest value, ½ · 1.38 · (1/4)² of 0.61 (with f = s e^(−s²/2) and 1.38 its
/// most curvature).
const REACH: f64 = 0.25;

/// The longest step for chosen forces: no slope tells how far a step may go where a force jumps. T.
const MOST_CHOSEN_DT: f64 = 0.2;

/// As many nodes as the options say for a start.
pub(crate) fn nodes(prepared: &Prepared, start: &Contour) -> usize {
    let along = elastic::length(&start.clicks(), start.closed);
    prepared.options().nodes.along(along)
}

/// Refuse points that are not in the image.
pub(crate) fn inside(prepared: &Prepared, points: &[DVec2]) -> Result<(), FitError> {
    let (width, height) = prepared.image().size();
    let most = DVec2::new(width as f64, height as f64) - 0.5;
    // written so that a NaN is outside too
    let inside = |p: &DVec2| p.cmpge(DVec2::splat(-0.5)).all() && p.cmple(most).all();
    let Some(index) = points.iter().position(|p| !inside(p)) else {
        return Ok(());
    };
    let DVec2 { x, y } = points[index];
    let problem = Problem::Outside {
        index,
        x,
        y,
        width,
        height,
    };
    Err(FitError::new(OptionKey::Start, problem))
}

/// So many nodes of a start, evenly along a spline through its points, in the image.
pub(crate) fn place(
    prepared: &Prepared,
    start: &Contour,
    nodes: usize,
) -> Result<Vec<DVec2>, FitError> {
    let clicks = start.clicks();
    inside(prepared, &clicks)?;
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
    let (width, height) = prepared.image().size();
    DVec2::new((width - 1) as f64, (height - 1) as f64)
}

/// A world within the borders of the image.
pub(crate) fn bordered(mut world: World, prepared: &Prepared) -> Result<World, FitError> {
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
pub(crate) fn stepping(prepared: &Prepared, snake: &Snake) -> Result<(Stepping, Moved), FitError> {
    let choices = |scheme, step, why| Moved {
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
        let stepping = Stepping {
            relax: Some(reach),
            ..Stepping::of(Scheme::LinearlyImplicit, FIRST_DT)
        };
        let why = StepReason::Grows { reach };
        return Ok((stepping, choices(Relaxation::NAME, FIRST_DT, why)));
    }
    // the usual force is smooth; forces of regions jump, which a scheme that extrapolates them does
    // not bear
    let (scheme, limit) = if prepared.field().is_some() {
        let limit = Certificate::limit_for_slope(
            snake,
            Scheme::Sbdf2,
            prepared.steepest(prepared.forces()?),
        );
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
        Step::Chosen if 0.5 * limit < MOST_CHOSEN_DT => (0.5 * limit, StepReason::HalfOf { limit }),
        Step::Chosen => (MOST_CHOSEN_DT, StepReason::MayJump),
    };
    Ok((Stepping::of(scheme, dt), choices(scheme.name(), dt, why)))
}

/// An error of the simulation, under the option it belongs to.
pub(crate) fn unmoved(error: SimulationError) -> FitError {
    match error {
        SimulationError::Scheme { error, .. } => {
            FitError::new(OptionKey::Step, Problem::Scheme(error))
        }
        SimulationError::Snake(error) => unfit(error),
        error => FitError::new(OptionKey::Start, Problem::Other(error.to_string())),
    }
}

pub(crate) fn unfit(error: SnakeError) -> FitError {
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

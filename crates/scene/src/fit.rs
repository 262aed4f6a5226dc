//! A scene for one picture and one drawn contour: what `snake fit` runs.

use std::sync::Arc;

use elastic::{ElasticError, Material, Parameter, Topology};
use field::{EdgeForce, ForceField, Polarity, Smoothing};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use snake::{
    Acting, Body, Certificate, Pressure, Rest, Sampling, Snake, SnakeError, Until, Wall, WallLaw,
    World,
};

use crate::file::ForceText;
use crate::limits::MOST_NODES;
use crate::meaning::force::{self, Sight};
use crate::meaning::{outside, smoothing};
use crate::scene::{Plan, Recording, Scene, View};
use crate::{Computing, ForceChoice, Picture, SceneError};

/// The least distance of the found sides of a bar that is wide enough, in σ: those of a thin line are 2 σ apart
/// however thin it is, those of a bar of 2 σ are 2.3 σ.
const RESOLVES: f64 = 2.5;

/// The longest step, for pictures that pull weakly: the usual curve is damped at a rate of 2. T.
const MOST_DT: f64 = 1.0;

/// The same for other forces than the usual one: no slope tells how far a step may go where a force jumps. T.
const MOST_CHOSEN_DT: f64 = 0.2;

/// How to fit a contour to a picture. [`Fit::default`] suits outlines of some tens to thousands of
/// pixels drawn within about ten pixels of an edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Number of nodes; by default one every four pixels, 16 at least and 4000 at most.
    pub nodes: Option<usize>,
    /// Whether the curve is closed; by default as its file says, and closed when it does not.
    pub closed: Option<bool>,
    /// ω₀. M T⁻².
    pub tether: f64,
    /// ω₁. M L² T⁻².
    pub tension: f64,
    /// ω₂. M L⁴ T⁻².
    pub rigidity: f64,
    /// γ. M T⁻¹. μ is 1.
    pub damping: f64,
    /// Smoothing of the picture before it is differentiated, as σ in pixels.
    pub sigma: f64,
    /// Force of an edge as high as the picture's own contrast, relative to that of an edge of 120
    /// grey levels under the report's rules.
    pub strength: f64,
    /// Forces to pull with instead of that edge force; none for it alone.
    pub forces: Vec<ForceChoice>,
    /// Which edges attract, going outwards: of that edge force, and of every chosen one that does not say.
    pub polarity: Polarity,
    /// Whether the edge force is computed where the curve goes, or as a whole.
    pub computing: Computing,
    /// Pressure inside the curve, in pulls of that edge force at strength 1: above 0 it grows, below 0 it shrinks.
    pub balloon: f64,
    /// The step; by default half of the largest that is stable anywhere in the picture, and at most
    /// 1 (0.2 with chosen forces).
    pub dt: Option<f64>,
    /// Steps at most.
    pub steps: u64,
}

impl Default for Fit {
    fn default() -> Self {
        Self {
            nodes: None,
            closed: None,
            tether: 0.0,
            tension: 20.0,
            rigidity: 100.0,
            damping: 2.0,
            sigma: 10.0_f64.sqrt(),
            strength: 1.0,
            forces: Vec::new(),
            polarity: Polarity::Either,
            computing: Computing::Auto,
            balloon: 0.0,
            dt: None,
            steps: 40_000,
        }
    }
}

impl Fit {
    /// The scene of this fit: `contour` in `picture`, under the corrected rules.
    ///
    /// The picture's contrast is measured (from the 2nd to the 98th percentile of its levels) and
    /// the gain chosen so that the result does not depend on the picture's exposure.
    ///
    /// # Errors
    ///
    /// A contour with too few points or outside the picture, or a number that will not do; by the
    /// name of the flag.
    pub fn scene(
        &self,
        picture: Picture,
        contour: &io::shapes::Shape,
    ) -> Result<Scene, SceneError> {
        let closed = self.closed.or(contour.closed).unwrap_or(true);
        let mut clicks = contour.first().to_vec();
        // a polygon whose last point repeats the first is closed already
        if closed && clicks.len() > 1 && clicks.first() == clicks.last() {
            clicks.pop();
        }
        if let Some(message) = outside(&clicks, &picture, 0.5) {
            return Err(SceneError::key("--from", format!("point {message}")));
        }
        let along = elastic::length(&clicks, closed);
        let nodes = self.nodes.unwrap_or_else(|| nodes_for(along));
        if nodes > MOST_NODES {
            let message = format!("got {nodes}; at most {MOST_NODES} would do");
            return Err(SceneError::key("--nodes", message));
        }
        let mut x =
            elastic::spline(&clicks, nodes, Parameter::ArcLength, closed).map_err(|e| curve(&e))?;
        let (width, height) = picture.size();
        let last = DVec2::new((width - 1) as f64, (height - 1) as f64);
        for p in &mut x {
            *p = p.clamp(DVec2::ZERO, last);
        }
        for (flag, value) in [
            ("--tether", self.tether),
            ("--tension", self.tension),
            ("--rigidity", self.rigidity),
            ("--damping", self.damping),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                let message = format!("must be finite and at least 0, got {value}");
                return Err(SceneError::key(flag, message));
            }
        }
        if !(self.strength.is_finite() && self.strength > 0.0) {
            let message = format!("must be finite and above 0, got {}", self.strength);
            return Err(SceneError::key("--strength", message));
        }
        let sight = Sight::of(&picture)?.for_fit(self.computing);
        let mut notes = picture.notes().to_vec();
        notes.extend(sight.note());
        let topology = if closed {
            Topology::Closed
        } else {
            Topology::open(elastic::End::Free)
        };
        let unfit = |e: SnakeError| match &e {
            SnakeError::Elastic(e) => curve(e),
            _ => SceneError::key("--from", e),
        };
        let body = Body::of(&x, topology, 1.0)
            .map_err(unfit)?
            .with_material(Material::uniform(self.tether, self.tension, self.rigidity))
            .with_damping(self.damping);
        let (mut world, field) = self.world(&sight, &x, closed)?;
        let law = WallLaw::Impact {
            restitution: 0.0,
            friction: 0.0,
        };
        for (point, normal) in [
            (DVec2::ZERO, DVec2::X),
            (DVec2::ZERO, DVec2::Y),
            (last, DVec2::NEG_X),
            (last, DVec2::NEG_Y),
        ] {
            world = world.with_wall(Wall::new(point, normal, law).map_err(unfit)?);
        }
        let snake = Snake::new(body, world).map_err(unfit)?;
        // the usual force is smooth: steps as long as the picture allows, whatever the spacing of the nodes and their
        // stiffness. Forces of regions jump, which a scheme that extrapolates them does not bear
        let scheme = if field.is_some() {
            Scheme::Sbdf2
        } else {
            Scheme::Leapfrog
        };
        let (limit, share) = self.step_limit(&snake, scheme, field.as_deref(), &sight);
        if let Some(dt) = self.dt.filter(|dt| !(dt.is_finite() && *dt > 0.0)) {
            let message = format!("must be finite and above 0, got {dt}");
            return Err(SceneError::key("--dt", message));
        }
        if let Some(dt) = self.dt.filter(|dt| *dt > limit) {
            let message = format!(
                "a step of {dt} is too large: must be at most {limit}, the largest stable step in this picture"
            );
            return Err(SceneError::key("--dt", message));
        }
        let most = if field.is_some() {
            MOST_DT
        } else {
            MOST_CHOSEN_DT
        };
        let dt = self.dt.unwrap_or((share * limit).min(most));
        Ok(Scene {
            name: "fit".to_owned(),
            title: "a contour fitted to a picture".to_owned(),
            report: None,
            note: None,
            view: View::default(),
            picture: Some(Arc::new(picture)),
            field,
            start: State::at_rest(x),
            terms: None,
            tips: None,
            hand: crate::Hand::default(),
            company: None,
            snake,
            plan: Plan {
                scheme,
                dt,
                tolerance: None,
                each: false,
                // nodes may slide along the outline for as long as they like
                until: Until::at_rest(
                    Rest {
                        shape: true,
                        ..Rest::default()
                    },
                    self.steps,
                ),
                start_rule: Start::SecondOrder,
                force: false,
                recording: Recording::default(),
            },
            resolves: Some(RESOLVES * self.sigma),
            notes,
            inputs: Vec::new(),
        })
    }

    /// The largest stable step anywhere in the picture, and which share of it to take.
    ///
    /// The usual field is computed where the curve goes, and not as a whole for this: its slopes
    /// are bounded by the picture's
    /// range of levels, H. With gain g, the force of one dimension has the slope g (H/2) ∫|G‴| at most, and
    /// ∫|G‴| = 2 (1 + 4 e^(−3/2)) / (√(2π) σ³) for a Gaussian G.
    fn step_limit(
        &self,
        snake: &Snake,
        scheme: Scheme,
        field: Option<&ForceField>,
        sight: &Sight<'_>,
    ) -> (f64, f64) {
        if field.is_some() {
            let gain = self.gain(sight);
            let total = 2.0 * (1.0 + 4.0 * (-1.5_f64).exp());
            let sharp = (std::f64::consts::TAU.sqrt() * self.sigma.powi(3)).recip();
            let slope = 0.5 * gain * sight.range() * total * sharp;
            let limit = Certificate::limit_for_slope(snake, scheme, slope);
            return (limit.unwrap_or(f64::INFINITY), 1.0);
        }
        let limit = Certificate::limit(snake, scheme);
        (limit.map_or(f64::INFINITY, |limit| limit.dt), 0.5)
    }

    /// The gain of the usual edge force.
    fn gain(&self, sight: &Sight<'_>) -> f64 {
        let usual = EdgeForce::as_strong_as_the_report().gain;
        self.strength * usual * 120.0 / sight.contrast()
    }

    /// The forces of the picture, and the field of the usual one.
    fn world(
        &self,
        sight: &Sight<'_>,
        nodes: &[DVec2],
        closed: bool,
    ) -> Result<(World, Option<Arc<ForceField>>), SceneError> {
        if !self.balloon.is_finite() {
            let message = format!("must be finite, got {}", self.balloon);
            return Err(SceneError::key("--balloon", message));
        }
        let mut world = World::default();
        let mut field = None;
        let mut chosen = self.forces.clone();
        if chosen.is_empty() {
            if self.polarity == Polarity::Either {
                let usual = Arc::new(self.usual_field(sight)?);
                world = world.with_image(Arc::clone(&usual), Sampling::Bilinear);
                field = Some(usual);
            } else {
                let size = sight.picture.size();
                smoothing("--sigma", Smoothing::Gaussian(self.sigma), size)?;
                // that edge force at another σ has another pull
                let strength = self.strength * 10.0 / (self.sigma * self.sigma);
                chosen.push(ForceChoice::edge(self.sigma, strength));
            }
        }
        let keyed = |choice: &ForceChoice| {
            let text = choice.clone().with_polarity(self.polarity).0;
            (format!("--force {}", choice.kind()), text)
        };
        let keyed: Vec<(String, ForceText)> = chosen.iter().map(keyed).collect();
        world = force::add(world, &keyed, Some(sight), nodes, closed)?;
        if self.balloon.abs() > 0.0 {
            if !closed {
                let message = "asks what is inside; a closed contour would do";
                return Err(SceneError::key("--balloon", message));
            }
            let pressure = Pressure::constant(force::PULL * self.balloon);
            world = world.with_acting(Acting::new(pressure).named("balloon"));
        }
        Ok((world, field))
    }

    /// The field of the usual edge force.
    fn usual_field(&self, sight: &Sight<'_>) -> Result<ForceField, SceneError> {
        let rule = EdgeForce {
            smoothing: Smoothing::Gaussian(self.sigma),
            gain: self.gain(sight),
        };
        sight.edge_field(rule, ["--sigma", "--computed"])
    }
}

/// An error of the curve, under the flag it belongs to.
fn curve(error: &ElasticError) -> SceneError {
    let flag = match error {
        ElasticError::TooFewNodes { .. } => "--nodes",
        ElasticError::TooStiff { .. } => "--rigidity",
        _ => "--from",
    };
    SceneError::key(flag, error)
}

/// One node every four pixels.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to a small positive range first"
)]
fn nodes_for(along: f64) -> usize {
    (along / 4.0).clamp(16.0, 4000.0).round() as usize
}

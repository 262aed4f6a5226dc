//! A circle moved by one force alone until it rests.

use super::synthetic::{AROUND, OBJECT};
use crate::{SandboxError, real};
use elastic::{Material, Topology};
use field::{
    Canny, Classes, Density, EdgeForce, Falloff, FieldError, FlowRule, ForceField, Grid,
    LikelihoodRegions, Line, LocalRegions, MaskedImage, Polarity, REPORT_GAIN, REPORT_PASSES,
    REPORT_SCALE, Region, RegionScratch, SignedEdge, Smoothing, TwoRegions, VectorFlow, edge_force,
    edge_points, edge_stages, gradient_force, line_strength, multiscale_edge_strength,
    point_distance_force, report_force, termination_strength, vector_convolution, vector_flow,
};
use glam::DVec2;
use integrator::{Fault, Scheme, Start, State};
use outline::Between;
use snake::{Body, Curve, Force, Sampling, Snake, World};
use std::any::Any;
use std::sync::Arc;

/// A force this share of the largest is at half its strength.
const FLOOR: f64 = 0.01;
/// Steps between two times that nodes are evened out.
const ROUND: usize = 25;
const STEPS: u64 = 25;

/// A field whose strength is about 1 from near to far: `F / (|F| + floor)`, where it is not nearly zero.
fn evened(id: &'static str, field: &ForceField) -> Result<ForceField, SandboxError> {
    let floor = FLOOR * field.largest();
    let (mut x, mut y) = field.components();
    for (x, y) in x.iter_mut().zip(y.iter_mut()) {
        let size = x.hypot(*y) + floor;
        *x /= size;
        *y /= size;
    }
    ForceField::from_components(&x, &y).map_err(SandboxError::refused(id))
}

/// Regions as a force on nodes, along the outward normal, as strong on a stretched curve as on any: the push of
/// [`snake::RegionForce`] is one of the curve's present length, and a circle that grows to twelve times its own would feel
/// twelve times the force.
#[derive(Debug, Clone)]
struct Regions {
    regions: Arc<dyn Region>,
    scratch: RegionScratch,
    push: Vec<f64>,
}

impl Force for Regions {
    fn name(&self) -> &'static str {
        "regions"
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        self.push.resize(curve.x.len(), 0.0);
        self.regions
            .push_into(curve.x, &mut self.scratch, &mut self.push);
        let normals = elastic::normals(curve.x, true);
        for ((force, normal), push) in force.iter_mut().zip(normals).zip(&self.push) {
            *force += normal * *push;
        }
        Ok(())
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// Edges of one polarity, evened as fields are.
#[derive(Debug, Clone)]
struct OneSided {
    edge: Arc<SignedEdge>,
    floor: f64,
}

impl Force for OneSided {
    fn name(&self) -> &'static str {
        "one polarity"
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        let normals = elastic::normals(curve.x, true);
        for ((force, normal), &at) in force.iter_mut().zip(normals).zip(curve.x) {
            let pull = self.edge.at(at, normal);
            *force += pull / (pull.length() + self.floor);
        }
        Ok(())
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// Regions of a kind, of about strength 1; None for a kind that is none.
fn regions(kind: &str, image: &Grid) -> Result<Option<Arc<dyn Region>>, FieldError> {
    let gain = 0.5 / (OBJECT - AROUND).powi(2);
    let region: Arc<dyn Region> = match kind {
        "two regions" => Arc::new(TwoRegions::new(image, gain)?),
        "local regions" => Arc::new(LocalRegions::new(&TwoRegions::new(image, gain)?, 16.0)?),
        "likelihood" => {
            let classes = Classes::grey(&MaskedImage::whole(image)?, 64)?;
            let bandwidth = (OBJECT - AROUND) / 20.0;
            Arc::new(LikelihoodRegions::new(
                &classes,
                Density::Parzen { bandwidth },
                0.1,
            )?)
        }
        _ => return Ok(None),
    };
    Ok(Some(region))
}

/// What moves a circle: one world after another.
pub(super) fn worlds(
    id: &'static str,
    kind: &str,
    image: &Grid,
) -> Result<Vec<World>, SandboxError> {
    let no = || SandboxError::refused::<FieldError>(id);
    let edge_field = |smoothing| {
        edge_force(
            image,
            &EdgeForce {
                smoothing,
                gain: 1.0,
            },
        )
        .map_err(no())
    };
    let fine = Smoothing::Gaussian(1.0);
    let rule = EdgeForce {
        smoothing: fine,
        gain: 1.0,
    };
    let strength = || {
        edge_stages(image, &rule)
            .map(|stages| stages.strength)
            .map_err(no())
    };
    let flow = |rule| {
        let flow = VectorFlow {
            rule,
            residual: 1e-6,
        };
        vector_flow(&strength()?, &flow)
            .map(|flow| flow.field)
            .map_err(no())
    };
    let fields = match kind {
        "report" => {
            vec![report_force(image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN).map_err(no())?]
        }
        "corrected" => vec![edge_field(Smoothing::Binomial(REPORT_PASSES))?],
        "coarse to fine" => [24.0, 12.0, 6.0, 3.0]
            .into_iter()
            .map(|sigma| edge_field(Smoothing::Gaussian(sigma)))
            .collect::<Result<_, _>>()?,
        "distance" => {
            let rule = Canny {
                sigma: 1.0,
                high: 10.0,
                low: 5.0,
            };
            let edges = edge_points(image, &rule).map_err(no())?;
            let points: Vec<DVec2> = edges.iter().map(|edge| edge.position).collect();
            vec![point_distance_force(&points, image.dim(), 1.0, f64::INFINITY).map_err(no())?]
        }
        "several scales" => {
            let strength = multiscale_edge_strength(image, &[1.0, 2.0, 4.0, 8.0, 16.0]);
            vec![gradient_force(&strength.map_err(no())?, 1.0).map_err(no())?]
        }
        "line" => {
            let strength = line_strength(image, Smoothing::Gaussian(3.0), Line::Bright);
            vec![gradient_force(&strength.map_err(no())?, 1.0).map_err(no())?]
        }
        "termination" => {
            let strength = termination_strength(image, Smoothing::Gaussian(3.0), 1.0);
            vec![gradient_force(&strength.map_err(no())?, 1.0).map_err(no())?]
        }
        "one polarity" => {
            let smoothing = Smoothing::Binomial(REPORT_PASSES);
            let edge = SignedEdge::new(image, smoothing, Polarity::BrightToDark, 1.0);
            let force = OneSided {
                edge: Arc::new(edge.map_err(no())?),
                floor: FLOOR * edge_field(smoothing)?.largest(),
            };
            return Ok(vec![World::default().with(force)]);
        }
        "GVF" => vec![flow(FlowRule::Plain { smoothness: 0.2 })?],
        "generalised GVF" => vec![flow(FlowRule::Generalised { spread: 0.05 })?],
        "VFC" => {
            let falloff = Falloff::Power { exponent: 2.0 };
            vec![vector_convolution(&strength()?, falloff, 128.0).map_err(no())?]
        }
        _ => {
            let regions = regions(kind, image).map_err(no())?;
            let worlds = regions.map(|regions| {
                let force = Regions {
                    regions,
                    scratch: RegionScratch::default(),
                    push: Vec::new(),
                };
                World::default().with(force)
            });
            return Ok(worlds.into_iter().collect());
        }
    };
    let world = |field: ForceField| {
        Ok(World::default().with_image(Arc::new(evened(id, &field)?), Sampling::Bilinear))
    };
    fields.into_iter().map(world).collect()
}

/// Where a circle ends, and whether it rests there.
pub(super) fn settle(
    id: &'static str,
    worlds: &[World],
    start: Vec<DVec2>,
) -> Result<(Vec<DVec2>, bool), SandboxError> {
    let body = Body::of(&start, Topology::Closed, 1.0)
        .map_err(SandboxError::refused(id))?
        .with_damping(1.0);
    let h = body.spacing;
    // as stiff for nodes of any spacing; enough to smooth what the force leaves rough
    let material = Material::uniform(0.0, 0.02 * h * h, 0.01 * h.powi(4));
    let body = body.with_material(material);
    let mut state = State::at_rest(start);
    let mut rests = false;
    // forces of about 1 move a node by about a pixel a step; the last steps are shorter, so that it can rest
    let last = worlds.last().map(|world| (world, 0.1, 10));
    for (world, dt, rounds) in worlds.iter().map(|world| (world, 1.0, 60)).chain(last) {
        let mut snake =
            Snake::new(body.clone(), world.clone()).map_err(SandboxError::refused(id))?;
        let mut stepper = Scheme::GradientFlow
            .start(&mut snake, &state, dt, Start::SecondOrder)
            .map_err(SandboxError::refused(id))?;
        for _ in 0..rounds {
            let before = state.x.clone();
            for _ in 0..STEPS {
                if stepper.step(&mut snake, &mut state).is_err() {
                    break;
                }
            }
            // nodes that ran apart or together are evened out, as any snake's would be
            let Ok(plan) = outline::slide(&state.x, true, state.len(), Between::Cubic) else {
                return Ok((state.x, false)); // it has shrunk to a point
            };
            state.x = plan.draw(&state.x).map_err(SandboxError::refused(id))?;
            state.v.fill(DVec2::ZERO);
            stepper.resume(&mut snake, &state);
            let ways = state.x.iter().map(|&p| outline::distance(&before, true, p));
            let speed = ways.sum::<f64>() / real(state.len()) / (dt * real(ROUND));
            rests = speed < 0.02;
            if speed < 0.004 {
                break;
            }
        }
    }
    Ok((state.x, rests))
}

/// Mean distance of a closed polygon from another, by points at most a pixel apart.
pub(super) fn mean_distance(of: &[DVec2], from: &[DVec2]) -> f64 {
    let (mut sum, mut length) = (0.0, 0.0);
    for (i, &a) in of.iter().enumerate() {
        let b = of[(i + 1) % of.len()];
        let mut pieces = 1.0;
        while a.distance(b) > pieces {
            pieces += 1.0;
        }
        let step = a.distance(b) / pieces;
        let mut k = 0.5;
        while k < pieces {
            sum += step * outline::distance(from, true, a.lerp(b, k / pieces));
            k += 1.0;
        }
        length += a.distance(b);
    }
    if length > 0.0 {
        sum / length
    } else {
        of.first()
            .map_or(f64::NAN, |&p| outline::distance(from, true, p))
    }
}

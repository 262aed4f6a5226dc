//! A circle moved by one shipped force alone, evened, until it rests.

use super::synthetic::fit;
use crate::prelude::*;
use elastic::{Material, Topology};
use field::{Grid, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, RegionScratch, report_force};
use integrator::{Fault, Scheme, State};
use outline::Between;
use snake::{
    Acting, Body, Curve as Nodes, Force, ImageForce, RegionForce, Sampling, Snake, Until, World,
};
use std::any::Any;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The pull of a force of strength 1 at an edge.
const PULL: f64 = 17.4;
/// Steps between two times that nodes are evened out.
const ROUND: u32 = 25;

/// A force whose strength is about 1 from near to far: `F / (|F| + PULL / 100)`, so that only its
/// direction counts where it is not nearly zero. Regions push by all of their strength up to the
/// border itself and would swing about it: half of it, along the normal of the curve as it is.
#[derive(Debug, Clone)]
struct Evened(Acting);

impl Force for Evened {
    fn name(&self) -> &'static str {
        "evened"
    }

    fn add(&mut self, curve: &Nodes<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        if let Some(regions) = self.0.downcast::<RegionForce>() {
            let mut push = vec![0.0; force.len()];
            let scratch = &mut RegionScratch::default();
            regions.region().push_into(curve.x, scratch, &mut push);
            let normals = elastic::normals(curve.x, true);
            for ((force, normal), push) in force.iter_mut().zip(normals).zip(push) {
                *force += normal * (0.5 * push / PULL);
            }
            return Ok(());
        }
        let mut own = vec![DVec2::ZERO; force.len()];
        self.0.add(curve, &mut own)?;
        for (force, own) in force.iter_mut().zip(own) {
            *force += own / (own.length() + 0.01 * PULL);
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

/// What moves a circle, one force after another: as typed behind `--force`, or the report's.
pub(super) fn stages(kind: &str, image: &Grid) -> Result<Vec<World>> {
    let world = |force: &dyn Force| World::default().with(Evened(Acting::boxed(force.boxed())));
    if kind == "report" {
        let field = report_force(image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN)?;
        return Ok(vec![world(&ImageForce::new(
            Arc::new(field),
            Sampling::Bilinear,
        ))]);
    }
    let circle = elastic::circle(DVec2::splat(128.0), 60.0, 60);
    let session = fit(image, &circle, kind)?;
    let shipped = session.simulation().members()[0].snake().world().clone();
    let stages = shipped.forces.iter().map(|acting| World {
        walls: shipped.walls.clone(),
        ..world(acting.force())
    });
    Ok(stages.collect())
}

/// Where a circle ends, and whether it rests there.
pub(super) fn settle(stages: &[World], start: Vec<DVec2>) -> Result<(Vec<DVec2>, bool)> {
    let body = Body::of(&start, Topology::Closed, 1.0)?.with_damping(1.0);
    let h = body.spacing;
    // as stiff for nodes of any spacing; enough to smooth what the force leaves rough
    let material = Material::uniform(0.0, 0.02 * h * h, 0.01 * h.powi(4));
    let body = body.with_material(material);
    let mut state = State::at_rest(start);
    let mut rests = false;
    // forces of about 1 move a node by about a pixel a step; the last steps are shorter, so that it can rest
    let last = stages.last().map(|world| (world, 0.1, 10));
    for (world, dt, rounds) in stages.iter().map(|world| (world, 1.0, 60)).chain(last) {
        let mut snake = Snake::new(body.clone(), world.clone())?;
        for _ in 0..rounds {
            let before = state.x.clone();
            let until = Until::steps(u64::from(ROUND));
            let watch = &mut |_: &State| ControlFlow::Continue(());
            moved(
                &mut snake,
                &mut state,
                (Scheme::GradientFlow, dt),
                &until,
                watch,
            )?;
            // nodes that ran apart or together are evened out, as any snake's would be
            let Ok(plan) = outline::slide(&state.x, true, state.len(), Between::Cubic) else {
                return Ok((state.x, false)); // it has shrunk to a point
            };
            state = State::at_rest(plan.draw(&state.x)?);
            let ways = state.x.iter().map(|&p| outline::distance(&before, true, p));
            let speed = mean(ways) / (dt * f64::from(ROUND));
            rests = speed < 0.02;
            if speed < 0.004 {
                break;
            }
        }
    }
    Ok((state.x, rests))
}

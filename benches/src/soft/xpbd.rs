//! Extended position-based dynamics, [macklin16]: places are predicted, then constraints with a compliance put them right.

use super::model::{Model, turning};
use super::touch::touches;
use sandbox::prelude::*;

/// One step with so many passes over all constraints.
pub(super) fn step(model: &mut Model, dt: f64, passes: usize) {
    let before = model.x.clone();
    let mut push: Vec<DVec2> = model.mass.iter().map(|m| *m * model.gravity).collect();
    model.gas(|node, force| push[node] += force);
    let keep = 1.0 / (1.0 + model.drag * dt);
    for i in 0..model.x.len() {
        if model.light[i] > 0.0 {
            model.v[i] = keep * (model.v[i] + dt * model.light[i] * push[i]);
            model.x[i] += dt * model.v[i];
        }
    }
    let reach = model.contact.map_or(0.0, |law| 2.0 * law.gap);
    let near = if model.contact.is_some() {
        touches(model, reach)
    } else {
        Vec::new()
    };
    let mut stretched = vec![0.0; model.springs.len()];
    let mut bent = vec![0.0; model.hinges.len()];
    for _ in 0..passes {
        for (spring, multiplier) in model.springs.iter().zip(&mut stretched) {
            let [a, b] = spring.ends;
            let way = model.x[b] - model.x[a];
            let Some(along) = way.try_normalize() else {
                continue;
            };
            let soft = 1.0 / (spring.stiffness * dt * dt);
            let light = model.light[a] + model.light[b];
            let change = -(way.length() - spring.rest + soft * *multiplier) / (light + soft);
            *multiplier += change;
            model.x[a] -= model.light[a] * change * along;
            model.x[b] += model.light[b] * change * along;
        }
        for (hinge, multiplier) in model.hinges.iter().zip(&mut bent) {
            let [a, b, c] = hinge.nodes;
            let (angle, slopes) = turning(model.x[a], model.x[b], model.x[c]);
            let soft = 1.0 / (hinge.stiffness * dt * dt);
            let each = hinge.nodes.into_iter().zip(slopes);
            let light: f64 = each
                .clone()
                .map(|(node, slope)| model.light[node] * slope.length_squared())
                .sum();
            let change = -(angle - hinge.rest + soft * *multiplier) / (light + soft);
            *multiplier += change;
            for (node, slope) in each {
                model.x[node] += model.light[node] * change * slope;
            }
        }
        for i in 0..model.x.len() {
            for floor in &model.floors {
                let depth = (floor.point - model.x[i]).dot(floor.normal);
                if depth > 0.0 && model.light[i] > 0.0 {
                    model.x[i] += depth * floor.normal;
                }
            }
        }
        let Some(law) = model.contact else { continue };
        for touch in &near {
            let [a, b] = touch.ends;
            let shares = [1.0 - touch.along, touch.along];
            let over = |x: &[DVec2]| x[touch.node] - shares[0] * x[a] - shares[1] * x[b];
            let depth = law.gap - over(&model.x).dot(touch.way);
            let lights = [model.light[touch.node], model.light[a], model.light[b]];
            let total =
                lights[0] + shares[0] * shares[0] * lights[1] + shares[1] * shares[1] * lights[2];
            if depth <= 0.0 || total <= 0.0 {
                continue;
            }
            let slid = over(&model.x) - over(&before);
            let slid = slid - slid.dot(touch.way) * touch.way;
            let rub = (law.friction * depth).min(slid.length());
            let change = (depth * touch.way - rub * slid.normalize_or_zero()) / total;
            model.x[touch.node] += lights[0] * change;
            model.x[a] -= shares[0] * lights[1] * change;
            model.x[b] -= shares[1] * lights[2] * change;
        }
    }
    for (i, before) in before.iter().enumerate() {
        if model.light[i] > 0.0 {
            model.v[i] = (model.x[i] - *before) / dt;
        }
    }
    model.flow(dt);
}

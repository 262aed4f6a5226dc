//! Masses and springs, symplectic Euler: what a first course in simulation builds.

use super::model::{Model, turning};
use super::touch::touches;
use sandbox::prelude::*;

/// One step: all forces, then velocities, then places.
pub(super) fn step(model: &mut Model, dt: f64) {
    let mut force: Vec<DVec2> = model.mass.iter().map(|m| *m * model.gravity).collect();
    for spring in &model.springs {
        let [a, b] = spring.ends;
        let way = model.x[b] - model.x[a];
        let length = way.length();
        if length > 0.0 {
            let pull = spring.stiffness * (length - spring.rest) / length * way;
            force[a] += pull;
            force[b] -= pull;
        }
    }
    for hinge in &model.hinges {
        let [a, b, c] = hinge.nodes;
        let (angle, slopes) = turning(model.x[a], model.x[b], model.x[c]);
        let moment = -hinge.stiffness * (angle - hinge.rest);
        for (node, slope) in hinge.nodes.into_iter().zip(slopes) {
            force[node] += moment * slope;
        }
    }
    model.gas(|node, push| force[node] += push);
    for curve in &model.curves {
        for node in curve.nodes.clone() {
            for floor in &model.floors {
                let depth = (floor.point - model.x[node]).dot(floor.normal);
                if depth > 0.0 {
                    let damp = floor.damping * model.v[node].dot(floor.normal);
                    let push = (floor.stiffness * depth - damp).max(0.0);
                    force[node] += curve.length * push * floor.normal;
                }
            }
        }
    }
    if let Some(law) = model.contact {
        for touch in touches(model, law.gap) {
            let [a, b] = touch.ends;
            let (first, second) = (1.0 - touch.along, touch.along);
            let v = model.v[touch.node] - first * model.v[a] - second * model.v[b];
            let normal = v.dot(touch.way);
            let stiff = law.stiffness * (law.gap - touch.distance);
            let push = touch.length * (stiff - law.damping * normal).max(0.0);
            let slip = v - normal * touch.way;
            // Coulomb's, and never more than would turn a third of the slip round
            let most = model.mass[touch.node] * slip.length() / (3.0 * dt);
            let rub = (law.friction * push).min(most);
            let total = push * touch.way - rub * slip.normalize_or_zero();
            force[touch.node] += total;
            force[a] -= first * total;
            force[b] -= second * total;
        }
    }
    let keep = 1.0 / (1.0 + model.drag * dt);
    for i in 0..model.x.len() {
        if model.light[i] > 0.0 {
            model.v[i] = keep * (model.v[i] + dt * model.light[i] * force[i]);
            model.x[i] += dt * model.v[i];
        }
    }
    model.flow(dt);
}

//! Rings in rows, each touching its neighbors: what crowds are timed and counted on. They keep an account of energies, as
//! [`Crowd::new`] says, unless told not to.

use std::error::Error;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use snake::{Body, Contact, Crowd, Snake, Timing, Upkeep, World};

/// So many rings, so many in a row, each of so many nodes.
pub(crate) fn crowd(count: u32, row: u32, nodes: usize) -> Result<Crowd, Box<dyn Error>> {
    let mut snakes = Vec::new();
    for k in 0..count {
        let at = 2.05 * DVec2::new(f64::from(k % row), f64::from(k / row));
        let nodes = elastic::circle(at, 1.0, nodes);
        let body = Body::of(&nodes, Topology::Closed, 1.0)?
            .with_material(Material::uniform(1.0, 1.0, 0.1));
        snakes.push((Snake::new(body, World::default())?, State::at_rest(nodes)));
    }
    let timing = Timing {
        scheme: Scheme::Leapfrog,
        dt: 1e-3,
        tolerance: None,
        start: Start::SecondOrder,
        force: false,
    };
    let law = Contact {
        stiffness: 50.0,
        damping: 1.0,
        friction: 0.3,
        wall_friction: 0.0,
        stick: 1.0,
        adhesion: 0.0,
        range: 0.0,
        gap: 0.1,
        stop: 0.1,
        own: false,
    };
    Ok(Crowd::new(snakes, timing, Some(law), Upkeep::default())?)
}

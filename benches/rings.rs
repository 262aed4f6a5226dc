//! Rings in rows, each touching its neighbors: what crowds are timed and counted on.

use std::error::Error;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, State};
use snake::{Body, Contact, Entry, Rules, Simulation, Snake, Stepping, World};

/// So many rings, so many in a row, each of so many nodes, with an account of energies or without.
pub(crate) fn crowd(
    (count, row): (u32, u32),
    nodes: usize,
    energies: bool,
) -> Result<Simulation, Box<dyn Error>> {
    let mut snakes = Vec::new();
    for k in 0..count {
        let at = 2.05 * DVec2::new(f64::from(k % row), f64::from(k / row));
        let nodes = elastic::circle(at, 1.0, nodes);
        let body = Body::of(&nodes, Topology::Closed, 1.0)?
            .with_material(Material::uniform(1.0, 1.0, 0.1));
        snakes.push(Entry::new(
            Snake::new(body, World::default())?,
            State::at_rest(nodes),
        ));
    }
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
    let rules = Rules {
        contact: Some(law),
        energies,
        ..Rules::default()
    };
    Ok(Simulation::new(
        snakes,
        Stepping::of(Scheme::Leapfrog, 1e-3),
        &rules,
    )?)
}

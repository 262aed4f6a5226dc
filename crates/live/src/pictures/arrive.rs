//! The way of an outline from its start: a body whose rest shape is what the search has found, let go where the start
//! is.

use glam::DVec2;
use scene::elastic::{self, Material, Topology};
use scene::integrator::{Scheme, State};
use scene::snake::{Body, Freeze, Simulation, Snake, Stepping, World};

use super::{One, Pictures};

/// Nodes that are seen to move.
const NODES: usize = 400;

/// The step. T.
const DT: f64 = 1.0 / 30.0;

/// Stiffness of the tether and damping: the slowest mode is critical and takes a second of looking. M T⁻², M T⁻¹.
const TETHER: f64 = 36.0;
const DAMPING: f64 = 11.0;

/// It has arrived where no node is farther from the outline than so many pixels, or after so many steps.
const NEAR: f64 = 0.05;
const MOST_STEPS: u32 = 120;

/// An outline on its way.
#[derive(Debug, Clone)]
pub(crate) struct Arrival {
    simulation: Simulation,
    /// Where the nodes will be.
    goal: Vec<DVec2>,
    steps: u32,
}

impl Arrival {
    /// From a start to an outline; None where there is nothing to be seen of it.
    fn new(start: &[DVec2], outline: &[DVec2], closed: bool) -> Option<Self> {
        let n = outline.len().min(NODES);
        let goal = elastic::resample(outline, n, closed).ok()?;
        let mut from = elastic::resample(start, n, closed).ok()?;
        if closed {
            if elastic::signed_area(&from) * elastic::signed_area(&goal) < 0.0 {
                from.reverse();
            }
            let turn = best_turn(&from, &goal);
            from.rotate_left(turn);
        }
        let topology = if closed {
            Topology::Closed
        } else {
            Topology::open(elastic::End::Free)
        };
        // the rest shape stands where the outline is: a tether to fixed places
        let body = Body::of(&goal, topology, 1.0)
            .ok()?
            .with_material(Material::uniform(0.0, 40.0, 20.0))
            .with_damping(DAMPING);
        let hold = Freeze::new(&goal, 0..n, TETHER);
        let world = World::default().with(hold.ok()?);
        let snake = Snake::new(body, world).ok()?;
        let stepping = Stepping::of(Scheme::Imex, DT);
        let simulation = Simulation::of(snake, State::at_rest(from), stepping).ok()?;
        Some(Self {
            simulation,
            goal,
            steps: 0,
        })
    }

    /// One step; whether it goes on.
    fn step(&mut self) -> bool {
        self.steps += 1;
        let moved = self.simulation.step().is_ok_and(|flow| flow.is_continue());
        let away = self.nodes().iter().zip(&self.goal);
        let far = away.map(|(x, goal)| x.distance(*goal)).fold(0.0, f64::max);
        moved && far > NEAR && self.steps < MOST_STEPS
    }

    /// Where it is.
    pub(super) fn nodes(&self) -> &[DVec2] {
        let first = self.simulation.members().first();
        first.map_or(&self.goal, |member| &member.state().x)
    }
}

/// By how many nodes a closed curve is to be turned, so that its nodes are nearest to those of another one.
fn best_turn(from: &[DVec2], goal: &[DVec2]) -> usize {
    let n = goal.len();
    // a few nodes tell it
    let every = (n / 24).max(1);
    let away = |turn: usize| -> f64 {
        let some = (0..n).step_by(every);
        some.map(|i| from[(i + turn) % n].distance_squared(goal[i]))
            .sum()
    };
    (0..n)
        .min_by(|a, b| away(*a).total_cmp(&away(*b)))
        .unwrap_or(0)
}

impl Pictures {
    /// Let an outline move from its start to where it was found.
    pub(super) fn set_out(&mut self, id: u32, one: &One) {
        let start = if one.start.len() < 3 {
            // a click grows
            let middle = one.start.first().copied().unwrap_or_default();
            one.points.iter().map(|p| middle.lerp(*p, 0.05)).collect()
        } else {
            one.start.clone()
        };
        match Arrival::new(&start, &one.points, one.closed) {
            Some(arrival) => self.arriving.insert(id, arrival),
            None => self.arriving.remove(&id),
        };
    }

    /// One step of all that are on their way.
    pub(super) fn arrive(&mut self) {
        self.arriving.retain(|_, arrival| arrival.step());
    }
}

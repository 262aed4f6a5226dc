//! Nodes that slide along a line: the border of a picture, or another curve.

use glam::DVec2;
use integrator::{Response, System, Touch};
use outline::Rail;

use crate::{Snake, SnakeError};

/// So near its line, and so slow across it, a node is left alone. L, L T⁻¹.
const NEAR: f64 = 1e-10;

impl Snake {
    /// Let node `node` slide along the polyline through `points`, without friction; none lets it go. What [`elastic::Hold::Along`] is
    /// at one moment, for a whole run.
    ///
    /// The line pushes with what of all other forces is across it. After each step the node is put at the nearest point of the line, from which a bend
    /// or an implicit scheme may have carried it, and loses its velocity across: that is booked under contacts. First order in dt where the
    /// line bends. Newmark's method keeps a tremble across the line, in which no rest is seen.
    ///
    /// # Errors
    ///
    /// Refused: a node that there is not, points that no line goes through.
    pub fn slide(
        &mut self,
        node: usize,
        points: Option<(&[DVec2], bool)>,
    ) -> Result<(), SnakeError> {
        let nodes = self.body.len();
        if node >= nodes {
            return Err(SnakeError::NoSuchNode { node, nodes });
        }
        let rail = points
            .map(|(points, closed)| Rail::new(points, closed))
            .transpose()?;
        self.rails.retain(|(at, _)| *at != node);
        self.rails.extend(rail.map(|rail| (node, rail)));
        self.note();
        Ok(())
    }

    /// Whether a line holds this node.
    pub(crate) fn slides(&self, node: usize) -> bool {
        self.rails.iter().any(|(at, _)| *at == node)
    }

    /// Add the push of the lines: it takes what of all other forces is across them. `before` is what stood in `force` at sliding nodes first. O(n), for a snake that slides.
    pub(crate) fn push_of_rails(&mut self, x: &[DVec2], before: &[DVec2], force: &mut [DVec2]) {
        if self.rails.is_empty() {
            return;
        }
        let mut own = vec![DVec2::ZERO; x.len()];
        self.elastic(x, &mut own);
        for ((node, _), &before) in self.rails.iter().zip(before) {
            let all = own[*node] + force[*node] - before;
            force[*node] += self.along_rail(*node, x[*node], all) - all;
        }
    }

    /// Put sliding nodes back on their lines.
    pub(crate) fn back_on_rails(&self, x: &[DVec2], v: &[DVec2], touches: &mut Vec<Touch>) {
        for (node, rail) in &self.rails {
            let node = *node;
            if let Some(foot) = rail.nearest(x[node]) {
                let tangent = foot.on.tangent;
                // on a straight line the push alone keeps it there, but for rounding
                if foot.distance < NEAR && tangent.perp_dot(v[node]).abs() < NEAR {
                    continue;
                }
                touches.push(Touch {
                    node,
                    position: foot.on.at,
                    normal: tangent.perp(),
                    response: Response::Guide,
                });
            }
        }
    }

    /// What a line leaves of a force on a node.
    pub(crate) fn along_rail(&self, node: usize, x: DVec2, force: DVec2) -> DVec2 {
        let held = self.rails.iter().find(|(at, _)| *at == node);
        match held.and_then(|(_, rail)| rail.nearest(x)) {
            Some(foot) => foot.on.tangent * foot.on.tangent.dot(force),
            None => force,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use elastic::{End, Material, Topology};
    use integrator::{Scheme, State};

    use super::*;
    use crate::{Body, Outcome, Rest, Simulation, Stepping, Until, World};

    /// A strip pinned at (0, 0) that hangs on a rail at its other end, stretched.
    fn strip(rail: &[DVec2], scheme: Scheme) -> (Outcome, State) {
        let topology = Topology::Open {
            head: End::Pinned,
            tail: End::Free,
        };
        let rest = elastic::segment(DVec2::ZERO, DVec2::new(6.0, 0.0), 13);
        let body = Body::of(&rest, topology, 1.0)
            .unwrap()
            .with_material(Material::uniform(0.0, 20.0, 0.0))
            .with_damping(1.5);
        let start: Vec<DVec2> = rest
            .iter()
            .map(|p| DVec2::new(p.x * 8.0 / 6.0, p.x * 5.0 / 6.0))
            .collect();
        let mut snake = Snake::new(body, World::default()).unwrap();
        snake.slide(12, Some((rail, false))).unwrap();
        let stepping = Stepping::of(scheme, 0.02);
        let mut simulation = Simulation::of(snake, State::at_rest(start), stepping).unwrap();
        let until = Until::at_rest(Rest::default(), 20_000);
        let outcome = simulation.run(&until, &mut |_| ControlFlow::Continue(()));
        (outcome.unwrap(), simulation.members()[0].state().clone())
    }

    #[test]
    fn a_strip_whose_end_slides_comes_to_rest_where_its_pull_is_square_to_the_line() {
        // the line x = 8: what pulls the end is the tension of x − r, horizontal there
        let upright = [DVec2::new(8.0, -20.0), DVec2::new(8.0, 20.0)];
        for scheme in [Scheme::Leapfrog, Scheme::BackwardEuler, Scheme::Rk4] {
            let (outcome, state) = strip(&upright, scheme);
            assert!(
                matches!(outcome, Outcome::Settled { .. }),
                "{scheme}: {outcome}"
            );
            let end = state.x[12];
            // rest is judged to a thousandth of the forces
            assert!(
                (end.x - 8.0).abs() < 1e-9 && end.y.abs() < 0.05,
                "{scheme}: {end}"
            );
        }
    }

    #[test]
    fn it_stays_on_a_bent_line_all_the_way() {
        let arc: Vec<DVec2> = (0..=90)
            .map(|i| 9.0 * DVec2::from_angle(f64::from(i).to_radians()))
            .collect();
        let (_, state) = strip(&arc, Scheme::Leapfrog);
        let rail = Rail::new(&arc, false).unwrap();
        assert!(rail.nearest(state.x[12]).unwrap().distance < 1e-12);
    }

    #[test]
    fn a_line_of_no_length_and_a_node_that_is_not_there_are_refused() {
        let circle = elastic::circle(DVec2::ZERO, 3.0, 8);
        let mut snake = Snake::new(
            Body::of(&circle, Topology::Closed, 1.0).unwrap(),
            World::default(),
        )
        .unwrap();
        assert!(snake.slide(8, None).is_err());
        assert!(snake.slide(0, Some((&[DVec2::ONE; 3], false))).is_err());
    }
}

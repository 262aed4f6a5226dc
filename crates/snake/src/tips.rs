//! Ends that grow along a ridge.

use std::sync::Arc;

use elastic::{End, Profile, Topology};
use field::Grid;
use glam::DVec2;
use integrator::State;

use crate::{Body, Snake, SnakeError};

/// Ends of an open snake that grow, a node at a time, where a map says that the line goes on.
///
/// From a tip all directions up to 60° from the curve's own are tried: the mean of the map over one and a half spacings ahead, times the
/// cosine of the turn. The tip has stopped for good where the mean of the best is below the threshold, where straight on leads off the map, and where it
/// would meet the curve. The grown curve forgets: its rest shape is where it is, evenly spaced.
#[derive(Debug, Clone)]
pub struct Tips {
    map: Arc<Grid>,
    least: f64,
    most: usize,
    /// Whether the head and the tail still grow.
    growing: [bool; 2],
}

/// Directions tried to either side, and the step between them in radians: up to 60°.
const ASIDE: i32 = 12;
const TURN: f64 = std::f64::consts::PI / 36.0;

impl Tips {
    /// Tips that follow `map` where it is at least `least`, up to `most` nodes.
    #[must_use]
    pub const fn new(map: Arc<Grid>, least: f64, most: usize, head: bool, tail: bool) -> Self {
        Self {
            map,
            least,
            most,
            growing: [head, tail],
        }
    }

    /// Whether the head and the tail still grow.
    #[must_use]
    pub const fn growing(&self) -> [bool; 2] {
        self.growing
    }

    /// Whether this snake can grow at all.
    ///
    /// # Errors
    ///
    /// Refused: a closed curve, an end that grows and is not free, parameters that differ along the curve, a rest shape that turns, forces that are meant for
    /// a number of nodes.
    pub fn validate(&self, snake: &Snake) -> Result<(), SnakeError> {
        let refuse = |needed| Err(SnakeError::CannotGrow { needed });
        let body = snake.body();
        let Topology::Open { head, tail } = body.topology else {
            return refuse("an open curve");
        };
        let free =
            |grows: bool, end: End, node: usize| !grows || end == End::Free && !snake.slides(node);
        if !(free(self.growing[0], head, 0) && free(self.growing[1], tail, snake.body().len() - 1))
        {
            return refuse("ends that are free where they grow");
        }
        let m = &body.material;
        let all = [
            &m.tether,
            &m.tension,
            &m.rigidity,
            &body.mass,
            &body.damping,
        ];
        if all
            .into_iter()
            .chain(&m.higher)
            .any(|profile| !matches!(profile, Profile::Uniform(_)))
        {
            return refuse("parameters that are the same all along");
        }
        if body.frame.turn != crate::Turn::None {
            return refuse("a frame that does not turn");
        }
        if snake.world().validate(body.len() + 1).is_err() {
            return refuse("forces with one weight all along");
        }
        Ok(())
    }

    /// The snake and its state with a node more at each tip that goes on; none if no tip does.
    ///
    /// # Errors
    ///
    /// As [`Tips::validate`].
    pub fn grow(
        &mut self,
        snake: &Snake,
        state: &State,
    ) -> Result<Option<(Snake, State)>, SnakeError> {
        self.validate(snake)?;
        let h = snake.body().spacing;
        let mut grown = state.clone();
        for end in 0..2 {
            if !self.growing[end] {
                continue;
            }
            if end == 0 {
                grown.x.reverse();
                grown.v.reverse();
            }
            let next = if grown.x.len() < self.most {
                self.next(&grown.x, h)
            } else {
                None
            };
            match next {
                Some(next) => {
                    grown.x.push(next);
                    grown.v.push(DVec2::ZERO);
                }
                None => self.growing[end] = false,
            }
            if end == 0 {
                grown.x.reverse();
                grown.v.reverse();
            }
        }
        if grown.x.len() == state.x.len() {
            return Ok(None);
        }
        let mut body = Body {
            rest: even(&grown.x, h),
            ..snake.body().clone()
        };
        body.recenter()?;
        let mut other = Snake::new(body, snake.world().clone())?;
        other.rails.clone_from(&snake.rails);
        // an end that slides and does not grow is still the first or the last
        let more = grown.x.len() - state.x.len();
        for (node, _) in &mut other.rails {
            *node += if *node > 0 { more } else { 0 };
        }
        Ok(Some((other, grown)))
    }

    /// Where the curve goes on beyond its last node.
    fn next(&self, x: &[DVec2], h: f64) -> Option<DVec2> {
        let n = x.len();
        let tip = x[n - 1];
        let own = (tip - x[n.saturating_sub(4)]).try_normalize()?;
        if self.level(tip + 1.5 * h * own) == f64::NEG_INFINITY {
            return None;
        }
        let mut best = (f64::NEG_INFINITY, f64::NEG_INFINITY, own);
        // from the middle outwards, so that of equals the straightest wins
        for k in 0..=2 * ASIDE {
            let side = if k % 2 == 0 { k / 2 } else { -(k + 1) / 2 };
            let turn = DVec2::from_angle(TURN * f64::from(side));
            let way = turn.rotate(own);
            let ahead = (1..=6).map(|j| self.level(tip + way * (0.25 * f64::from(j) * h)));
            let mean = ahead.sum::<f64>() / 6.0;
            if mean * turn.x > best.0 {
                best = (mean * turn.x, mean, way);
            }
        }
        let next = tip + h * best.2;
        let meets = x[..n - 1].iter().any(|p| p.distance(next) < 0.9 * h);
        (best.1 >= self.least && !meets).then_some(next)
    }

    /// The map at a place, bilinear; nothing off it.
    fn level(&self, p: DVec2) -> f64 {
        let (rows, columns) = self.map.dim();
        let inside =
            p.x >= 0.0 && p.y >= 0.0 && p.x <= (columns - 1) as f64 && p.y <= (rows - 1) as f64;
        if !inside {
            return f64::NEG_INFINITY;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "inside the map"
        )]
        let cell = |v: f64, most: usize| (v.floor() as usize).min(most.saturating_sub(2));
        let (i, j) = (cell(p.x, columns), cell(p.y, rows));
        let (tx, ty) = (p.x - i as f64, p.y - j as f64);
        let at = |j: usize, i: usize| self.map[[j.min(rows - 1), i.min(columns - 1)]];
        let above = at(j, i) * (1.0 - tx) + at(j, i + 1) * tx;
        let below = at(j + 1, i) * (1.0 - tx) + at(j + 1, i + 1) * tx;
        above * (1.0 - ty) + below * ty
    }
}

/// The curve with every edge as long as `h`, its direction kept.
fn even(x: &[DVec2], h: f64) -> Vec<DVec2> {
    let mut at = x[0];
    let mut out = vec![at];
    for pair in x.windows(2) {
        at += h * (pair[1] - pair[0]).normalize_or_zero();
        out.push(at);
    }
    out
}

#[cfg(test)]
mod tests {
    use elastic::Material;

    use super::*;
    use crate::World;

    /// A ridge along y = 20 that ends at x = 60, and its map.
    fn ridge() -> Arc<Grid> {
        Arc::new(Grid::from_shape_fn((41, 101), |(y, x)| {
            let off = (y as f64 - 20.0) / 2.0;
            if x <= 60 {
                (-0.5 * off * off).exp()
            } else {
                0.0
            }
        }))
    }

    fn snake(from: DVec2, to: DVec2) -> (Snake, State) {
        let nodes = elastic::segment(from, to, 6);
        let body = Body::of(&nodes, Topology::open(End::Free), 1.0)
            .unwrap()
            .with_material(Material::uniform(0.0, 1.0, 1.0));
        (
            Snake::new(body, World::default()).unwrap(),
            State::at_rest(nodes),
        )
    }

    #[test]
    fn a_tip_follows_the_ridge_and_stops_where_it_ends() {
        let (mut snake, mut state) = snake(DVec2::new(20.0, 20.0), DVec2::new(30.0, 20.0));
        let mut tips = Tips::new(ridge(), 0.5, 100, false, true);
        let mut rounds = 0;
        while let Some((grown, at)) = tips.grow(&snake, &state).unwrap() {
            (snake, state) = (grown, at);
            rounds += 1;
        }
        let tip = state.x[state.x.len() - 1];
        // within a spacing of 2 of the end of the ridge
        assert!(
            (tip.x - 60.0).abs() < 2.0 && (tip.y - 20.0).abs() < 0.5,
            "{tip}"
        );
        assert_eq!(
            (rounds, tips.growing()),
            (state.x.len() - 6, [false, false])
        );
        assert_eq!(snake.body().len(), state.x.len());
        assert_eq!(state.x[0], DVec2::new(20.0, 20.0));
    }

    #[test]
    fn both_tips_grow_and_stop_at_the_borders_of_the_map() {
        let map = Arc::new(Grid::from_elem((41, 101), 1.0));
        let (mut snake, mut state) = snake(DVec2::new(40.0, 20.0), DVec2::new(50.0, 20.0));
        let mut tips = Tips::new(map, 0.5, 1000, true, true);
        while let Some((grown, at)) = tips.grow(&snake, &state).unwrap() {
            (snake, state) = (grown, at);
        }
        // at 20 and 70 with spacing 2: to within one and a half spacings of the border they look ahead to
        assert!(state.x[0].x < 3.0 && state.x[state.x.len() - 1].x > 97.0);
    }

    #[test]
    fn what_cannot_grow_is_refused_with_what_would() {
        let tips = Tips::new(ridge(), 0.5, 100, true, true);
        let circle = elastic::circle(DVec2::new(50.0, 20.0), 9.0, 12);
        let circle = Snake::new(
            Body::of(&circle, Topology::Closed, 1.0).unwrap(),
            World::default(),
        )
        .unwrap();
        assert!(
            tips.validate(&circle)
                .unwrap_err()
                .to_string()
                .contains("an open curve")
        );
        let nodes = elastic::segment(DVec2::ZERO, DVec2::X, 6);
        let pinned = Body::of(&nodes, Topology::open(End::Pinned), 1.0).unwrap();
        let pinned = Snake::new(pinned, World::default()).unwrap();
        assert!(
            tips.validate(&pinned)
                .unwrap_err()
                .to_string()
                .contains("free")
        );
    }
}

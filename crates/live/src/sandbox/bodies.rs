//! Snakes that come, go and are thrown.

use glam::DVec2;
use scene::elastic::{self, Topology};
use scene::integrator::State;
use scene::snake::{Body, Contact, Entry, Member, Snake};

use super::{HAND, PUSH, Sandbox, place};
use crate::{LiveError, Pair};

/// Nodes that a drawn ball has.
const NODES: (usize, usize) = (16, 240);

/// Snakes that a scene may have.
const MOST_SNAKES: usize = 400;

/// Share of the stiffness of contacts that the step allows.
const SHARE: f64 = 0.25;

impl Sandbox {
    /// Add a ball of that outline, of the first snake's material.
    pub(super) fn ball(&mut self, points: &[Pair]) -> Result<(), LiveError> {
        let first = self.member_or_first(None)?;
        let (body, world) = (first.snake().body(), first.snake().world().clone());
        if self.simulation().members().len() >= MOST_SNAKES {
            return Err(LiveError::new(format!(
                "a scene may have {MOST_SNAKES} snakes at most"
            )));
        }
        let drawn: Vec<DVec2> = points.iter().map(|p| place(*p)).collect::<Result<_, _>>()?;
        if drawn.len() < 3 {
            let got = drawn.len();
            return Err(LiveError::new(format!(
                "the outline of a ball must have at least 3 points, got {got}"
            )));
        }
        let count = elastic::length(&drawn, true) / body.spacing;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to a small positive range first"
        )]
        let count = count.clamp(NODES.0 as f64, NODES.1 as f64).round() as usize;
        let even = elastic::resample(&drawn, count, true).map_err(LiveError::of)?;
        let mut nodes = smooth(even);
        let crossed = outline::crossings(&nodes, true).map_err(LiveError::of)?;
        if !crossed.is_empty() {
            return Err(LiveError::new(
                "the outline of a ball must not cross itself",
            ));
        }
        // as the first runs
        if elastic::signed_area(&nodes) * elastic::signed_area(&first.state().x) < 0.0 {
            nodes.reverse();
        }
        let mut ball =
            Body::of(&nodes, Topology::Closed, body.mass.at(0)).map_err(LiveError::of)?;
        ball.material = elastic::Material::uniform(
            body.material.tether.at(0),
            body.material.tension.at(0),
            body.material.rigidity.at(0),
        );
        ball = ball.with_damping(body.damping.at(0));
        ball.internal = body.internal;
        ball.frame = body.frame;
        let mut world = world;
        // what is meant for the first alone
        world.forces.retain(|acting| {
            acting.name() != HAND && acting.name() != PUSH && acting.validate(nodes.len()).is_ok()
        });
        let snake = Snake::new(ball, world).map_err(LiveError::of)?;
        let mut course = self.course.clone();
        let added = course
            .simulation_mut()
            .add(Entry::new(snake, State::at_rest(nodes)));
        added.map_err(LiveError::of)?;
        self.course = course;
        if self.simulation().contact().is_none() && self.simulation().members().len() == 2 {
            self.contact(true)?;
        }
        Ok(())
    }

    /// Take a snake out.
    pub(super) fn delete(&mut self, id: usize) -> Result<(), LiveError> {
        self.member(id)?;
        if self.simulation().members().len() < 2 {
            return Err(LiveError::new("the last snake of a scene must stay"));
        }
        let removed = self.course.simulation_mut().remove(id);
        removed.map_err(LiveError::of)?;
        self.pins.remove(&id);
        self.drag = self.drag.take().filter(|drag| drag.snake != id);
        Ok(())
    }

    /// Give a snake a velocity; nodes that are held keep still.
    pub(super) fn throw(&mut self, id: usize, velocity: DVec2) -> Result<(), LiveError> {
        let member = self.member(id)?;
        let (x, mut v) = (member.state().x.clone(), member.state().v.clone());
        for (i, v) in v.iter_mut().enumerate() {
            if !self.pins.get(&id).is_some_and(|pins| pins.contains(&i)) {
                *v = velocity;
            }
        }
        let moved = self.course.simulation_mut().move_to(id, x, v);
        moved.map_err(LiveError::of)
    }

    /// Whether curves push each other.
    pub(super) fn contact(&mut self, on: bool) -> Result<(), LiveError> {
        let simulation = self.simulation();
        let usual = self
            .scene
            .company
            .as_ref()
            .and_then(|company| company.contact);
        let rules = on.then(|| usual.unwrap_or_else(|| self.usual_contact(simulation.members())));
        let set = self.course.simulation_mut().set_contact(rules);
        set.map_err(LiveError::of)
    }

    /// Contacts as stiff as the step allows, between curves of these spacings and masses.
    fn usual_contact(&self, members: &[Member]) -> Contact {
        let dt = self.simulation().stepping().dt;
        let each = members.iter().map(|member| {
            let body = member.snake().body();
            let least = body
                .mass
                .to_vec(body.len())
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            (least, body.spacing)
        });
        let (mass, spacing) = each.fold((f64::INFINITY, 0.0_f64), |(m, h), (mass, spacing)| {
            (m.min(mass), h.max(spacing))
        });
        let stiffness = SHARE * mass / (dt * dt);
        Contact {
            stiffness,
            damping: 0.1 * (stiffness * mass).sqrt(),
            friction: 0.0,
            wall_friction: 0.0,
            stick: 0.0,
            gap: 0.25 * spacing,
            adhesion: 0.0,
            range: 0.0,
            stop: 0.5 * spacing,
            own: false,
        }
    }
}

/// A drawn line without the trembling of a hand: each node twice half way to the middle of its neighbors.
fn smooth(mut nodes: Vec<DVec2>) -> Vec<DVec2> {
    let n = nodes.len();
    for _ in 0..2 {
        let before = nodes.clone();
        for (i, node) in nodes.iter_mut().enumerate() {
            *node = 0.5 * before[i] + 0.25 * (before[(i + 1) % n] + before[(i + n - 1) % n]);
        }
    }
    nodes
}

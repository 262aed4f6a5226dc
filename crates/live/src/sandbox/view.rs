//! A scene as it is to be drawn.

use glam::DVec2;
use scene::snake::{Energies, Simulation, WallLaw};
use serde_json::{Value, json};

use super::Sandbox;
use crate::engine::Show;
use crate::packet::Packet;

impl Sandbox {
    /// What stays from frame to frame: the scene's name, what should be seen of it.
    pub(crate) fn about(&self) -> Value {
        let scene = &self.scene;
        let window = scene.view.window.unwrap_or_else(|| self.bounds());
        json!({
            "name": scene.name, "title": scene.title, "report": scene.report, "note": scene.note,
            "notes": scene.notes, "y-up": scene.view.y_up,
            "window": [window.0.to_array(), window.1.to_array()],
            "picture": scene.picture.as_ref().map(|picture| picture.size()),
            "energies": self.energy_names(),
        })
    }

    /// The scene now.
    pub(crate) fn frame(&self, show: Show, packet: &mut Packet) -> Value {
        let simulation = self.simulation();
        let mut snakes = Vec::new();
        for member in simulation.members() {
            let state = member.state();
            let center = member.snake().center(&state.x);
            let mut one = json!({
                "id": member.id(), "closed": member.is_closed(), "x": packet.points(&state.x),
                "center": center.to_array(), "pins": self.pins.get(&member.id()),
            });
            if show.velocities {
                one["v"] = packet.points(&state.v);
            }
            if show.forces {
                one["forces"] = forces(member.snake().clone(), state, packet);
            }
            snakes.push(one);
        }
        let energies = show.energies.then(|| {
            let mut watched = simulation.clone();
            watched.energies().values()
        });
        json!({
            "rate": self.rate, "t": simulation.t(), "step": simulation.steps(), "snakes": snakes,
            "walls": self.walls().iter().map(|wall| json!({
                "point": wall.point().to_array(), "normal": wall.normal().to_array(),
                "law": law(wall.law()),
            })).collect::<Vec<Value>>(),
            "gravity": self.gravity_now().to_array(),
            "drag": self.drag.as_ref().map(|drag| json!({
                "snake": drag.snake, "node": drag.node, "to": drag.to.to_array(),
            })),
            "push": self.push.map(|(at, reach)| json!({"at": at.to_array(), "reach": reach})),
            "end": self.end.as_ref().map(|end| json!({
                "words": end.words, "node": end.node.map(|(node, at)| json!([node, at.to_array()])),
            })),
            "energies": energies,
        })
    }

    /// Names of the energies, in the order of their values.
    fn energy_names(&self) -> Vec<String> {
        Energies::names_with(self.simulation().orders(), Simulation::FORCES.into_iter())
    }

    /// The corners of what the scene shows where it does not say: its curves and walls, with a margin.
    fn bounds(&self) -> (DVec2, DVec2) {
        if let Some(picture) = self.picture() {
            let (width, height) = picture.size();
            let far = DVec2::new(width as f64, height as f64) - 0.5;
            return (DVec2::splat(-0.5), far);
        }
        let members = self.simulation().members().iter();
        let points = members.flat_map(|member| member.state().x.iter().copied());
        let points = points.chain(self.walls().iter().map(|wall| wall.point()));
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = points.fold(none, |(low, high), p| (low.min(p), high.max(p)));
        let margin = 0.35 * (high - low).max_element();
        (low - margin, high + margin)
    }
}

/// Every force on a snake, by its name: the elastic one, then those of the world.
fn forces(
    mut snake: scene::snake::Snake,
    state: &scene::integrator::State,
    packet: &mut Packet,
) -> Value {
    let n = state.len();
    let mut out = Vec::new();
    let mut force = vec![DVec2::ZERO; n];
    snake.strain_force(&state.x, &mut force);
    out.push(json!({"name": "elastic", "f": packet.points(&force)}));
    let names: Vec<String> = snake.world().names().map(str::to_owned).collect();
    for (index, name) in names.into_iter().enumerate() {
        force.fill(DVec2::ZERO);
        // where a force has no value there is none to be drawn
        if snake.force_of(index, state, &mut force).is_ok() {
            out.push(json!({"name": name, "f": packet.points(&force)}));
        }
    }
    Value::Array(out)
}

fn law(law: WallLaw) -> String {
    match law {
        WallLaw::Clamp => "clamp".to_owned(),
        WallLaw::Penalty { stiffness, damping } => {
            format!("penalty, stiffness {stiffness}, damping {damping}")
        }
        WallLaw::Impact {
            restitution,
            friction,
        } => format!("impact, restitution {restitution}, friction {friction}"),
    }
}

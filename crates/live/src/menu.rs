//! The shipped scenes: a list, and a small drawing of each.

use scene::{SCENES, Scene, headline};
use serde_json::{Value, json};

use crate::LiveError;
use crate::packet::Packet;

/// All shipped scenes, with title and place in the report.
pub(crate) fn menu() -> Value {
    let scenes = SCENES.iter().map(|(name, _)| {
        let (title, report) = headline(name).unwrap_or_default();
        json!({"name": name, "title": title, "report": report})
    });
    Value::Array(scenes.collect())
}

/// A small drawing of a shipped scene: its curves at the start, its walls.
pub(crate) fn thumb(name: &str, packet: &mut Packet) -> Result<Value, LiveError> {
    let scene = Scene::named(name).map_err(LiveError::of)?;
    let others = scene.company.iter().flat_map(|company| &company.others);
    let others = others.map(|(snake, start)| (snake, start));
    let all = std::iter::once((&scene.snake, &scene.start)).chain(others);
    let curves: Vec<Value> = all
        .map(|(snake, start)| {
            let closed = snake.body().topology.is_closed();
            json!({"x": packet.points(&start.x), "closed": closed})
        })
        .collect();
    let walls: Vec<Value> = scene
        .snake
        .world()
        .walls
        .iter()
        .map(|wall| json!({"point": wall.point().to_array(), "normal": wall.normal().to_array()}))
        .collect();
    Ok(json!({
        "curves": curves, "walls": walls, "y-up": scene.view.y_up,
        "window": scene.view.window.map(|(a, b)| [a.to_array(), b.to_array()]),
        "picture": scene.picture.as_ref().map(|picture| picture.size()),
    }))
}

//! What the forces of a scene's picture say, as arrows and at a place.

use glam::DVec2;
use scene::field::ForceField;
use scene::snake::ImageForce;
use serde_json::{Value, json};

use super::Sandbox;
use crate::LiveError;
use crate::arrows::{arrows, grid};
use crate::packet::Packet;

impl Sandbox {
    /// The field of the first force of a picture.
    fn field(&self) -> Option<&ForceField> {
        let first = self.simulation().members().first()?;
        let mut forces = first.snake().world().forces.iter();
        let own = forces.find_map(|acting| acting.downcast::<ImageForce>());
        own.map(|force| &**force.field())
            .or(self.scene.field.as_deref())
    }

    /// Forces of the picture at places on a grid.
    pub(crate) fn arrows(
        &self,
        from: DVec2,
        to: DVec2,
        count: usize,
        packet: &mut Packet,
    ) -> Result<Value, LiveError> {
        let (Some(field), Some(picture)) = (self.field(), self.picture()) else {
            return Err(LiveError::new(
                "this scene has no picture with a force field",
            ));
        };
        let (width, height) = picture.size();
        let far = DVec2::new(width as f64, height as f64) - 0.5;
        let places = grid(from.max(DVec2::splat(-0.5)), to.min(far), count)?;
        Ok(arrows(field, &places, packet))
    }

    /// What each force of a picture says at a place.
    pub(crate) fn at(&self, p: DVec2) -> Result<Value, LiveError> {
        let first = self.member_or_first(None)?;
        let fields = first.snake().world().forces.iter().filter_map(|acting| {
            let force = acting.downcast::<ImageForce>()?;
            Some(json!({"name": acting.name(), "f": force.field().at(p).to_array()}))
        });
        let level = self
            .picture()
            .map(|picture| crate::pictures::level(picture, p));
        Ok(json!({"inside": true, "level": level, "forces": fields.collect::<Vec<Value>>()}))
    }
}

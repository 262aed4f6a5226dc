//! What a scene's snakes live among: gravity and walls.

use glam::DVec2;
use scene::snake::{Acting, Edit, Gravity, Wall, WallLaw, World};

use super::Sandbox;
use crate::LiveError;

/// Walls that a scene may have.
const MOST_WALLS: usize = 64;

impl Sandbox {
    /// Another gravity for all.
    pub(super) fn gravity(&mut self, g: DVec2) -> Result<(), LiveError> {
        self.edit_all(|snake| {
            let mut world = snake.world().clone();
            let is_gravity = |acting: &&mut Acting| acting.downcast::<Gravity>().is_some();
            match world.forces.iter_mut().find(is_gravity) {
                Some(acting) => *acting = Acting::new(Gravity(g)).named(acting.name()),
                None => world = world.with_gravity(g),
            }
            Some(Edit::World(world))
        })
    }

    /// The gravity that the first snake feels.
    pub(super) fn gravity_now(&self) -> DVec2 {
        let first = self.simulation().members().first();
        let forces = first.map_or(&[][..], |member| &member.snake().world().forces);
        let gravity = forces
            .iter()
            .filter_map(|acting| acting.downcast::<Gravity>());
        gravity.map(|gravity| gravity.0).sum()
    }

    /// The walls of the first snake.
    pub(super) fn walls(&self) -> &[Wall] {
        let first = self.simulation().members().first();
        first.map_or(&[][..], |member| &member.snake().world().walls)
    }

    /// One more wall, or another place for one.
    pub(super) fn wall(
        &mut self,
        index: Option<usize>,
        point: DVec2,
        normal: DVec2,
    ) -> Result<(), LiveError> {
        let walls = self.walls();
        let usual = walls.first().map_or(
            WallLaw::Impact {
                restitution: 0.5,
                friction: 0.0,
            },
            Wall::law,
        );
        let law = match index {
            Some(index) => self.the_wall(index)?.law(),
            None if walls.len() >= MOST_WALLS => {
                return Err(LiveError::new(format!(
                    "a scene may have {MOST_WALLS} walls at most"
                )));
            }
            None => usual,
        };
        let wall = Wall::new(point, normal, law).map_err(LiveError::of)?;
        self.with_walls(|walls| match index {
            Some(index) => walls[index] = wall,
            None => walls.push(wall),
        })
    }

    /// Take a wall away.
    pub(super) fn no_wall(&mut self, index: usize) -> Result<(), LiveError> {
        self.the_wall(index)?;
        self.with_walls(|walls| {
            walls.remove(index);
        })
    }

    fn the_wall(&self, index: usize) -> Result<&Wall, LiveError> {
        let walls = self.walls();
        let count = walls.len();
        walls
            .get(index)
            .ok_or_else(|| LiveError::new(format!("there are {count} walls, got wall {index}")))
    }

    /// The same walls for all.
    fn with_walls(&mut self, change: impl Fn(&mut Vec<Wall>)) -> Result<(), LiveError> {
        let mut walls = self.walls().to_vec();
        change(&mut walls);
        self.edit_all(|snake| {
            let forces = snake.world().forces.clone();
            let walls = walls.clone();
            Some(Edit::World(World { forces, walls }))
        })
    }
}

//! Sequences of frames whose true outlines are formulas: what moves, deforms, hides, leaves, divides and crosses.
//!
//! Each frame is drawn as the pictures of [`synthetic`](crate::synthetic) are: by shares of 8 × 8 points of a pixel,
//! blurred by one pixel, with noise of the seed 100 + frame (of deviation 5 unless said), rounded to 8 bits. Level 200
//! on 60, 192 × 192 pixels and 40 frames unless said. A texture is a smooth function of the place in the object (of the
//! place on the ground), so it moves with it.
//!
//! ```
//! let all = score::sequences::sequences();
//! let fall = all.iter().find(|sequence| sequence.name == "move_fall").unwrap();
//! let (picture, truth) = (fall.frame(10), fall.truth(10));
//! assert_eq!(picture.dim(), (192, 192));
//! // one object, a circle of radius 18 at (30 + 3 t, 24 + 0.09 t²)
//! assert_eq!((truth.len(), truth[0].0), (1, 1));
//! let center = glam::DVec2::new(60.0, 33.0);
//! assert!(truth[0].1.iter().all(|p| (p.distance(center) - 18.0).abs() < 1e-12));
//! ```

mod crowd;
mod many;
mod region;
mod scene;
mod single;
#[cfg(test)]
mod tests;

use field::Grid;
use glam::DVec2;
use ndarray::Array2;

use region::cut;
use scene::{Body, Scene};

/// An object and its outline.
pub type Outlined = (u32, Vec<DVec2>);

/// What happens to an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// From this frame on nothing of it is seen, but it goes on.
    Vanished,
    /// From this frame on it is seen again.
    Returned,
    /// From this frame on it is outside of the picture.
    Left,
    /// This is its first frame; it came from outside of the picture or from nothing.
    Born,
    /// From this frame on there are its children instead.
    Divided,
    /// From this frame on it is no more.
    Lost,
    /// Its velocity jumps: the step to the next frame is the first with the new one.
    Kicked,
}

/// A sequence of frames with its truth.
#[derive(Debug, Clone, PartialEq)]
pub struct Sequence {
    /// Its name.
    pub name: String,
    /// Width and height. Pixels.
    pub size: [usize; 2],
    /// Standard deviation of the noise. Levels.
    pub noise: f64,
    /// What happens: frame, object, event; by frame.
    pub events: Vec<(usize, u32, Event)>,
    /// Objects that are children, and their parents.
    pub parents: Vec<(u32, u32)>,
    scenes: Vec<Scene>,
}

impl Sequence {
    fn new(name: &str, scene: impl Fn(usize) -> Scene) -> Self {
        Self {
            name: name.to_owned(),
            size: [192, 192],
            noise: 5.0,
            events: Vec::new(),
            parents: Vec::new(),
            scenes: (0..40).map(scene).collect(),
        }
    }

    fn with(mut self, events: &[(usize, u32, Event)]) -> Self {
        self.events = events.to_vec();
        self
    }

    /// How many frames it has.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.scenes.len()
    }

    /// The picture of a frame: grey levels 0 … 255, whole numbers. Frames beyond the last are the last.
    #[must_use]
    pub fn frame(&self, t: usize) -> Grid {
        let t = t.min(self.frames() - 1);
        self.scenes[t].draw(self.size, self.noise, 100 + t as u64)
    }

    /// The same without noise.
    #[must_use]
    pub fn clean(&self, t: usize) -> Grid {
        self.scenes[t.min(self.frames() - 1)].draw(self.size, 0.0, 0)
    }

    /// The true outlines of a frame, by object: what is in the picture of those that are seen.
    ///
    /// Of an object that another hides in part, the whole outline; of objects in contact, each to the line of contact;
    /// of one across the border, the part in the picture. Polygons of some thousand nodes, within 2e-4 pixels of their
    /// curves.
    #[must_use]
    pub fn truth(&self, t: usize) -> Vec<Outlined> {
        let [width, height] = self.size.map(|side| side as f64 - 0.5);
        let sides = [
            (DVec2::NEG_X, 0.5),
            (DVec2::NEG_Y, 0.5),
            (DVec2::X, width),
            (DVec2::Y, height),
        ];
        let mut truth = Vec::new();
        for body in self.objects(t).filter(|body| !body.hidden) {
            let mut ring = body.region.outline();
            for (normal, offset) in sides {
                ring = cut(&ring, normal, offset);
            }
            if ring.len() >= 3 {
                truth.push((body.id, ring));
            }
        }
        truth
    }

    /// The outlines of all objects of a frame as they are, seen or not, in the picture or not.
    #[must_use]
    pub fn bodies(&self, t: usize) -> Vec<Outlined> {
        self.objects(t)
            .map(|body| (body.id, body.region.outline()))
            .collect()
    }

    /// The outlines of frame 0, to start from.
    #[must_use]
    pub fn start(&self) -> Vec<Outlined> {
        self.truth(0)
    }

    /// The true objects of a frame as labels ([`labelled`](crate::tracking::labelled)).
    #[must_use]
    pub fn labels(&self, t: usize) -> Array2<u32> {
        let [width, height] = self.size;
        crate::tracking::labelled(&self.truth(t), (height, width))
    }

    fn objects(&self, t: usize) -> impl Iterator<Item = &Body> {
        let scene = &self.scenes[t.min(self.frames() - 1)];
        scene.bodies.iter().filter(|body| body.id > 0)
    }
}

/// All of them: the cases of one object, then those of several.
#[must_use]
pub fn sequences() -> Vec<Sequence> {
    let mut all = single::cases();
    all.extend(many::cases());
    all.push(crowd::crowd());
    all
}

//! Sequences of frames whose true outlines are formulas: what moves, deforms, hides, leaves, divides and crosses.
//!
//! Each frame is drawn as the pictures of [`synthetic`](crate::synthetic) are: by shares of 8 × 8 points of a pixel,
//! blurred by one pixel, with noise of the seed 100 + frame (of deviation 5 unless said), rounded to 8 bits. Level 200
//! on 60, 192 × 192 pixels and 40 frames unless said. A texture is a smooth function of the place in the object (of
//! the place on the ground), so it moves with it.
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
    /// of one across the border, the part in the picture. Polygons of about a thousand nodes, within 3e-4 pixels of
    /// their curves.
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
///
/// - `move_const`: a circle of radius 20 at (40 + 2.8 t, 96).
/// - `move_fall`: radius 18 at (30 + 3 t, 24 + 0.09 t²).
/// - `move_bounce`: radius 18 at (40 + 2.5 t, 24 + 0.36 u²), u = ((t + 20) mod 40) − 20: its velocity jumps at 20.
/// - `kick`: radius 18, it falls by 4 pixels a frame from (60, 30); the steps from the frames 20 and 34 are of 26
///   pixels, 30 degrees to the right of upwards, and what they have beyond the fall halves in every frame after. At a
///   kick a share of 0.168 of its area is also that of the frame before. A circle of radius 13 and of the same level
///   rests below its path at (72, 150).
/// - `vanish`: as `move_const`, without the circle in the frames 15 … 19.
/// - `turn`: an ellipse of half axes 50 and 20 at (96, 96), turned by 4 t degrees.
/// - `turn_fast`: by 12 t degrees, with texture of deviation 15 on it and on the ground.
/// - `breathe`: `r = 45 + 12 sin(0.2 t) cos 2a` about (96, 96).
/// - `grow`: a circle of radius 12 + t at (96, 96).
/// - `amoeba_tex`: `r = 28 + 6 cos(2a + 0.15 t) + 4 cos(3a − 0.2 t) + 2 cos(5a + 0.1 t)` about (60 + 1.8 t, 96 + 20
///   sin(t / 8)), of level 130 on 110, texture of deviation 14 on it, carried with polar angle and share of the radius.
/// - `amoeba_camo`: the same with texture of that deviation on the ground too.
/// - `noise_cnr2`: the amoeba of level 104 on 96, noise 4.
/// - `fade`: the amoeba of level 60 + 140 · 0.93ᵗ.
/// - `occluded`: a circle of radius 18 at (32 + 3.2 t, 96) passes behind a bar of level 130 that covers the columns 79
///   … 113.
/// - `distractor`: radius 16 at (40 + 2.6 t, 78); an equal circle at (152 − 2.6 t, 113) passes it at 35 pixels.
/// - `tongue`: radius 22 at (36 + 3 t, 96), along a bar of level 190 and thickness 14 that touches it from below.
/// - `camera`: an ellipse of half axes 28 and 20 and level 160 at (66 + 1.5 t, 96), turned by 2 t degrees, on level
///   100, with texture of deviation 15 on it and on the ground. In the frames 4 k + 2 and 4 k + 3 the whole picture is
///   shifted by 15 pixels in a direction that changes with k by the golden angle.
/// - `leave`: a circle of radius 18 at (209.5 + 5 (4 − |t − 19.5|), 80 + 0.8 t): over the right border, wholly
///   outside in the frames 16 … 23, and back.
/// - `divide`: ovals of Cassini of the area of a circle of radius 28 about (96, 96): a circle until frame 4; then the
///   foci part along an axis at 30 degrees, evenly, so that the neck closes at frame 20. One object until frame 19,
///   from frame 20 on two that touch in a point and then part.
/// - `cross`: circles of radius 12 that cross at 120 degrees, at (96, 96) + 4.3 (t − 19.5) (±cos 30°, sin 30°):
///   they overlap in the frames 17 … 22. Both outlines are whole; both have one level, so only their motion tells
///   which is which.
/// - `crowd`: twenty discs of radius 8 … 11 and level 160 … 220 in five columns and four rows. Each wanders at one
///   pixel a frame in a direction that turns; the two of a pair (1 and 2, 3 and 4 …) make for each other from frame 6
///   to 20 and part again. Where two would overlap by more than 1.5 pixels they are pushed apart, and each ends at the
///   line of equal power of the two. The objects 5, 12 and 16 are lost at the frames 14, 26 and 33; 15 leaves over the
///   right border; 22 comes over the left one, 21, 23 and 24 appear and grow for five frames.
#[must_use]
pub fn sequences() -> Vec<Sequence> {
    let mut all = single::cases();
    all.extend(many::cases());
    all.push(crowd::crowd());
    all
}

//! Pictures whose true outline is a formula, so that errors can be measured below a pixel.
//!
//! A region covers each pixel by a share of 8 × 8 points; then the picture is blurred, made noisy and
//! rounded to 8 bits
//! ([`field::drawn`]). The same case is the same picture on every machine that rounds logarithms and cosines alike.
//!
//! ```
//! use score::synthetic::{Case, Shape};
//!
//! let disc = Case { shape: Shape::Ellipse { half: [30.0, 30.0], angle: 0.0 }, ..Case::default() };
//! let picture = disc.picture();
//! assert_eq!((picture[[100, 100]], picture[[2, 2]]), (disc.bright, disc.dark));
//! let truth = disc.truth();
//! assert!(truth.iter().all(|p| (p.distance(disc.center) - 30.0).abs() < 1e-12));
//! ```

mod cases;
#[cfg(test)]
mod tests;

pub use cases::{cases, series};

use std::f64::consts::TAU;

use field::Grid;
use field::drawn::{covered, noisy, rounded};
use glam::DVec2;

/// Nodes of a true outline that is curved: those of a circle of radius 90 are within 3e-5 pixels of it.
const NODES: u32 = 4096;

/// The form of a region about its center.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// An ellipse by its half axes, the first turned by an angle from +x towards +y.
    Ellipse {
        /// Half axes. Pixels.
        half: [f64; 2],
        /// Radians.
        angle: f64,
    },
    /// `r(t) = radius (1 + depth cos(lobes · t))`, t the polar angle.
    Star {
        /// Pixels.
        radius: f64,
        /// Below 1.
        depth: f64,
        /// How many lobes.
        lobes: u32,
    },
    /// A polygon by its corners, from the center.
    Polygon(Vec<DVec2>),
}

/// A picture of one region.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// Width and height. Pixels.
    pub size: [usize; 2],
    /// The form of the region.
    pub shape: Shape,
    /// Where its center is. Pixels.
    pub center: DVec2,
    /// Level of the region.
    pub bright: f64,
    /// Level around it.
    pub dark: f64,
    /// Standard deviation of the Gaussian that blurs it. Pixels.
    pub blur: f64,
    /// Standard deviation of the noise. Levels.
    pub noise: f64,
    /// The seed of the noise.
    pub seed: u64,
    /// The share of pixels that are black or white instead, half of each.
    pub salt_and_pepper: f64,
    /// Light from one side: levels a pixel from the middle column to the right.
    pub shade: f64,
    /// A box of level 255, by its least and its greatest x and y, that is no part of the truth.
    pub distractor: Option<[DVec2; 2]>,
}

impl Default for Case {
    /// A disc of radius 60 in the middle of 200 × 200 pixels, blurred by one pixel, without noise.
    fn default() -> Self {
        Self {
            name: "disk".to_owned(),
            size: [200, 200],
            shape: Shape::Ellipse {
                half: [60.0, 60.0],
                angle: 0.0,
            },
            center: DVec2::splat(99.5),
            bright: 200.0,
            dark: 60.0,
            blur: 1.0,
            noise: 0.0,
            seed: 0,
            salt_and_pepper: 0.0,
            shade: 0.0,
            distractor: None,
        }
    }
}

impl Shape {
    /// Whether a place, counted from the center, is in it.
    fn holds(&self, p: DVec2) -> bool {
        match self {
            Self::Ellipse { half, angle } => {
                let turned = DVec2::from_angle(-angle).rotate(p);
                (turned / DVec2::from_array(*half)).length_squared() <= 1.0
            }
            Self::Star { .. } => p.length() <= self.radius_at(p.to_angle()),
            Self::Polygon(corners) => outline::place(corners, p) != outline::Place::Outside,
        }
    }

    /// How far a star reaches at a polar angle.
    fn radius_at(&self, t: f64) -> f64 {
        match self {
            Self::Star {
                radius,
                depth,
                lobes,
            } => radius * (1.0 + depth * (f64::from(*lobes) * t).cos()),
            _ => 0.0,
        }
    }

    /// Its outline about the center.
    fn outline(&self) -> Vec<DVec2> {
        let angles = (0..NODES).map(|i| TAU * f64::from(i) / f64::from(NODES));
        match self {
            Self::Ellipse { half, angle } => {
                let (half, turn) = (DVec2::from_array(*half), DVec2::from_angle(*angle));
                let on = |t: f64| turn.rotate(half * DVec2::from_angle(t));
                angles.map(on).collect()
            }
            Self::Star { .. } => {
                let on = |t: f64| self.radius_at(t) * DVec2::from_angle(t);
                angles.map(on).collect()
            }
            Self::Polygon(corners) => corners.clone(),
        }
    }
}

impl Case {
    /// The picture: grey levels 0 … 255, whole numbers.
    #[must_use]
    pub fn picture(&self) -> Grid {
        let [width, height] = self.size;
        let inside = |p: DVec2| self.shape.holds(p - self.center);
        let mut picture = covered((height, width), inside, (self.bright, self.dark));
        if let Some([low, high]) = self.distractor {
            let within = |p: DVec2| p.cmpge(low).all() && p.cmple(high).all();
            let share = covered((height, width), within, (1.0, 0.0));
            picture.zip_mut_with(&share, |level, share| *level += (255.0 - *level) * share);
        }
        if self.blur > 0.0 {
            picture = blurred(&picture, self.blur);
        }
        for ((_, x), level) in picture.indexed_iter_mut() {
            *level += self.shade * (x as f64 - (width / 2) as f64);
        }
        if self.noise > 0.0 {
            picture = noisy(&picture, self.noise, self.seed);
        }
        if self.salt_and_pepper > 0.0 {
            for ((y, x), level) in picture.indexed_iter_mut() {
                let place = 2 * (y * width + x) as u64;
                let w = field::drawn::uniform(self.seed, place);
                if w < 0.5 * self.salt_and_pepper {
                    *level = 0.0;
                } else if w < self.salt_and_pepper {
                    *level = 255.0;
                }
            }
        }
        rounded(&picture)
    }

    /// The true outline: a polygon so fine that it is the curve to 3e-5 pixels.
    #[must_use]
    pub fn truth(&self) -> Vec<DVec2> {
        let mut outline = self.shape.outline();
        outline.iter_mut().for_each(|p| *p += self.center);
        outline
    }

    /// Three circles to start from, by name, about points that are not the center: `near` of 1.1 times the radius of a
    /// circle of the same area, 2.5 pixels off in a direction that depends on the seed; `outside` of 1.55 times and
    /// `inside` of 0.45 times that radius.
    #[must_use]
    pub fn starts(&self) -> [(&'static str, Vec<DVec2>); 3] {
        // the golden angle: no two seeds have the same direction
        let turn = 2.399_963_229_728_653 * (self.seed % 4096) as f64;
        let circle = |share: f64, offset: f64| {
            let center = self.center + offset * DVec2::from_angle(turn);
            let radius = share * self.radius();
            let on = |i: u32| center + radius * DVec2::from_angle(TAU * f64::from(i) / 100.0);
            (0..100).map(on).collect()
        };
        [
            ("near", circle(1.1, 2.5)),
            ("outside", circle(1.55, 0.0)),
            ("inside", circle(0.45, 0.0)),
        ]
    }

    /// The radius of a circle of the same area.
    #[must_use]
    pub fn radius(&self) -> f64 {
        crate::Measures::of(&[self.shape.outline()]).map_or(0.0, |m| 0.5 * m.equivalent_diameter)
    }
}

/// Blurred by a Gaussian that ends four standard deviations out, rows then columns; beyond the border goes on what is
/// at it.
pub(crate) fn blurred(picture: &Grid, sigma: f64) -> Grid {
    let mut weights = vec![1.0];
    let mut k = 1.0;
    while k <= (4.0 * sigma).ceil() {
        weights.push((-k * k / (2.0 * sigma * sigma)).exp());
        k += 1.0;
    }
    let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    let along = |picture: &Grid, down: bool| {
        let (height, width) = picture.dim();
        Grid::from_shape_fn((height, width), |(y, x)| {
            let (at, most) = if down {
                (y, height - 1)
            } else {
                (x, width - 1)
            };
            let level = |at: usize| {
                if down {
                    picture[[at, x]]
                } else {
                    picture[[y, at]]
                }
            };
            let pair = |(k, weight): (usize, &f64)| {
                weight * (level(at.saturating_sub(k)) + level((at + k).min(most)))
            };
            let beside: f64 = weights.iter().enumerate().skip(1).map(pair).sum();
            (weights[0] * level(at) + beside) / sum
        })
    };
    along(&along(picture, false), true)
}

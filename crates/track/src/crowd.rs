//! What all objects together look like, and where in a frame that is seen.

use field::Pixels;
use glam::DVec2;

use crate::palette::{Feature, Palette, SAMPLE};
use crate::region::{filled, grown};
use crate::ring;
use crate::sight::lightness;
use crate::view::View;
use crate::window::{Lightness, Window, cells, to_cells};

/// The radius of the middle object in cells is at most this: larger ones are seen in blocks.
const RADIUS: f64 = 50.0;

/// What lies within so many steps of an outline is neither taught as object nor as ground. Cells.
const MARGIN: usize = 2;

/// Two classes count as each other by (1 + (distance / this)²)⁻². Units of lightness.
const LIKE: f32 = 6.0;

/// How fast it follows.
const LEARN: f32 = 0.1;

/// Added to the share of each class, over their number.
const UNSEEN: f32 = 0.01;

/// Objects can be told from the ground if less of the ground and more of the objects looks like objects.
const MOST_GROUND: f64 = 0.4;
const LEAST_OBJECTS: f64 = 0.6;

/// Which features are lightness and color.
const COLORS: [usize; 3] = [0, 2, 3];

/// The appearance of all objects against that of the ground.
#[derive(Debug, Clone)]
pub(crate) struct Crowd {
    block: usize,
    light: Lightness,
    palette: Palette,
    /// Shares of classes on the ground and in objects.
    shares: [Vec<f32>; 2],
    /// The mean features of the ground and of objects.
    means: [Feature; 2],
    /// The area of the middle object. Cells.
    pub area: f64,
}

impl Crowd {
    /// What objects of those outlines look like in a frame; None if they enclose nothing.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small count"
    )]
    pub(crate) fn of(pixels: &dyn Pixels, outlines: &[&[DVec2]]) -> Option<Self> {
        let radius = middle(outlines.iter().map(|outline| ring::radius(outline)))?;
        let block = (radius / RADIUS).ceil().max(1.0) as usize;
        let (columns, rows) = cells(pixels.size(), block);
        let last = DVec2::new(columns as f64, rows as f64) - 1.0;
        let light = lightness(pixels, block, DVec2::ZERO, last);
        let window = whole(pixels, block, light);
        let owner = owners((columns, rows), block, outlines);
        let sides = sides((columns, rows), &owner);
        let mut sample = Vec::new();
        for side in &sides {
            let step = side.len().div_ceil(SAMPLE).max(1);
            sample.extend(side.iter().step_by(step).map(|&at| window.features[at]));
        }
        let palette = Palette::of(&sample, light.color);
        let shares = shares(&window, &palette, &sides);
        let means = means(&window, &sides).map(Option::unwrap_or_default);
        Some(Self {
            means,
            block,
            light,
            palette,
            shares,
            area: std::f64::consts::PI * (radius / block as f64).powi(2),
        })
    }

    /// A frame in which objects have those outlines; of `taught` it learns what they look like. None where objects
    /// cannot be told from the ground.
    pub(crate) fn view(
        &mut self,
        pixels: &dyn Pixels,
        outlines: &[&[DVec2]],
        taught: &[bool],
    ) -> Option<View> {
        let size = cells(pixels.size(), self.block);
        let window = whole(pixels, self.block, self.light);
        let owner = owners(size, self.block, outlines);
        let mut sides = sides(size, &owner);
        sides[1].retain(|at| taught.get(owner[*at].wrapping_sub(1)) == Some(&true));
        let now = shares(&window, &self.palette, &sides);
        for (side, (own, now)) in sides.iter().zip(self.shares.iter_mut().zip(&now)) {
            if !side.is_empty() {
                let pairs = own.iter_mut().zip(now);
                pairs.for_each(|(own, now)| *own += LEARN * (now - *own));
            }
        }
        for (own, now) in self.means.iter_mut().zip(means(&window, &sides)) {
            if let Some(now) = now {
                let pairs = own.iter_mut().zip(now);
                pairs.for_each(|(own, now)| *own += LEARN * (now - *own));
            }
        }
        let radii = outlines.iter().zip(taught);
        let radii = radii.filter(|(_, taught)| **taught);
        if let Some(radius) = middle(radii.map(|(outline, _)| ring::radius(outline))) {
            let area = std::f64::consts::PI * (radius / self.block as f64).powi(2);
            self.area += f64::from(LEARN) * (area - self.area);
        }
        let like: Vec<bool> = self.shares[0]
            .iter()
            .zip(&self.shares[1])
            .map(|(ground, object)| object > ground)
            .collect();
        let like = (0..window.features.len()).map(|at| {
            let class = window.class_at(at, &self.palette);
            class.is_some_and(|class| like[usize::from(class)])
        });
        let like: Vec<bool> = like.collect();
        let share = |side: &[usize]| {
            let found = side.iter().filter(|&&at| like[at]).count();
            found as f64 / side.len().max(1) as f64
        };
        let [ground, objects] = [share(&sides[0]), share(&sides[1])];
        let told = ground < MOST_GROUND && (objects > LEAST_OBJECTS || sides[1].is_empty());
        told.then(|| View {
            size,
            block: self.block as f64,
            like,
            level: self.levels(&window),
            owner,
        })
    }
}

impl Crowd {
    /// How far cells are from the ground towards objects: by lightness and color.
    fn levels(&self, window: &Window) -> Vec<f32> {
        let [ground, object] = self.means;
        let way = COLORS.map(|k| object[k] - ground[k]);
        let size: f32 = way.iter().map(|v| v * v).sum();
        let one = |feature: &Feature| {
            let along: f32 = COLORS
                .iter()
                .zip(way)
                .map(|(&k, way)| way * (feature[k] - ground[k]))
                .sum();
            if size > 0.0 { along / size } else { 0.0 }
        };
        window.features.iter().map(one).collect()
    }
}

/// The mean features of cells; None where there are none.
fn means(window: &Window, sides: &[Vec<usize>; 2]) -> [Option<Feature>; 2] {
    [0, 1].map(|side: usize| {
        let mut sum = [0.0_f64; 4];
        for &at in &sides[side] {
            let feature = &window.features[at];
            sum.iter_mut()
                .zip(feature)
                .for_each(|(sum, v)| *sum += f64::from(*v));
        }
        let count = sides[side].len() as f64;
        #[allow(clippy::cast_possible_truncation, reason = "a mean of f32")]
        let mean = sum.map(|sum| (sum / count) as f32);
        (count > 0.0).then_some(mean)
    })
}

/// The middle of some numbers.
fn middle(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    numbers
        .get(numbers.len() / 2)
        .copied()
        .filter(|radius| *radius > 0.5)
}

/// The whole frame.
fn whole(pixels: &dyn Pixels, block: usize, light: Lightness) -> Window {
    let (columns, rows) = cells(pixels.size(), block);
    let last = DVec2::new(columns as f64, rows as f64);
    Window::of(pixels, block, light, DVec2::ZERO, last)
}

/// For each cell the first outline that encloses it, from 1.
fn owners(size: (usize, usize), block: usize, outlines: &[&[DVec2]]) -> Vec<usize> {
    let mut owner = vec![0; size.0 * size.1];
    for (own, outline) in outlines.iter().enumerate() {
        let curve: Vec<DVec2> = outline.iter().map(|p| to_cells(*p, block as f64)).collect();
        filled(size, &curve, |at| {
            if owner[at] == 0 {
                owner[at] = own + 1;
            }
        });
    }
    owner
}

/// Cells well outside of all objects, and cells well inside one.
fn sides(size: (usize, usize), owner: &[usize]) -> [Vec<usize>; 2] {
    let covered: Vec<bool> = owner.iter().map(|own| *own > 0).collect();
    let free: Vec<bool> = covered.iter().map(|covered| !covered).collect();
    let near_covered = grown(size, &covered, MARGIN);
    let near_free = grown(size, &free, 1);
    let all = || 0..owner.len();
    [
        all().filter(|&at| !near_covered[at]).collect(),
        all().filter(|&at| !near_free[at]).collect(),
    ]
}

/// Shares of classes on both sides, each shared with those like it.
fn shares(window: &Window, palette: &Palette, sides: &[Vec<usize>; 2]) -> [Vec<f32>; 2] {
    let n = palette.len();
    let entries = palette.entries();
    [0, 1].map(|side: usize| {
        let mut counts = vec![0.0_f32; n];
        for &at in &sides[side] {
            if let Some(class) = window.class_at(at, palette) {
                counts[usize::from(class)] += 1.0;
            }
        }
        let total = counts.iter().sum::<f32>().max(1.0);
        let near = |a: usize, b: usize| {
            let far: f32 = entries[a]
                .iter()
                .zip(&entries[b])
                .map(|(a, b)| (a - b) * (a - b))
                .sum();
            (1.0 + far / (LIKE * LIKE)).powi(-2)
        };
        (0..n)
            .map(|a| {
                let sum: f32 = (0..n).map(|b| near(a, b) * counts[b]).sum();
                sum / total + UNSEEN / n as f32 * f32::from(u8::from(side == 0))
            })
            .collect()
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by it")]

    use super::*;

    /// Two discs of radius 12 and different levels; a third one, nearly like the first, that nobody has outlined.
    const DISCS: [(f64, f64, f64); 3] = [
        (25.0, 30.0, 160.0),
        (70.0, 30.0, 220.0),
        (48.0, 65.0, 165.0),
    ];
    const RADIUS: f64 = 12.0;

    fn within(p: DVec2) -> Option<usize> {
        DISCS
            .iter()
            .position(|disc| p.distance(DVec2::new(disc.0, disc.1)) <= RADIUS)
    }

    #[test]
    fn what_looks_like_objects_is_found_wherever_it_is() {
        let image = fit::Image::grey(field::Grid::from_shape_fn((90, 100), |(y, x)| {
            let p = DVec2::new(x as f64, y as f64);
            let noise = 10.0 * (field::drawn::uniform(3, (100 * y + x) as u64) - 0.5);
            noise + within(p).map_or(60.0, |disc| DISCS[disc].2)
        }));
        let outlines = [0, 1].map(|disc| {
            let center = DVec2::new(DISCS[disc].0, DISCS[disc].1);
            fit::Contour::circle(center, RADIUS).points
        });
        let outlines = outlines.each_ref().map(Vec::as_slice);
        let mut crowd = Crowd::of(image.pixels(), &outlines).unwrap();
        assert!((crowd.area / (std::f64::consts::PI * 144.0) - 1.0).abs() < 0.02);
        let view = crowd
            .view(image.pixels(), &outlines, &[true, true])
            .unwrap();
        let wrong = (0..9000).filter(|at| {
            let p = DVec2::new((at % 100) as f64, (at / 100) as f64);
            let edge = DISCS
                .iter()
                .any(|disc| (p.distance(DVec2::new(disc.0, disc.1)) - RADIUS).abs() < 1.5);
            !edge && view.like[*at] != within(p).is_some()
        });
        assert_eq!(wrong.count(), 0);
        assert_eq!(view.owner[30 * 100 + 25], 1);
        assert_eq!(view.owner[30 * 100 + 70], 2);
        assert_eq!(view.owner[65 * 100 + 48], 0);
        assert!(view.share(outlines[1]) > 0.95);
    }

    #[test]
    fn nothing_is_told_from_a_ground_that_looks_the_same() {
        let image = fit::Image::grey(field::Grid::from_shape_fn((90, 100), |(y, x)| {
            200.0 * field::drawn::uniform(3, (100 * y + x) as u64)
        }));
        let outline = fit::Contour::circle(DVec2::splat(40.0), RADIUS).points;
        let outlines = [outline.as_slice()];
        let mut crowd = Crowd::of(image.pixels(), &outlines).unwrap();
        assert!(crowd.view(image.pixels(), &outlines, &[true]).is_none());
    }
}

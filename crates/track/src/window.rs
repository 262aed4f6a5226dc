//! The part of a frame about an object, as features: lightness, color, texture.
//!
//! All lengths are *cells*: one pixel where the object is small, blocks of b × b pixels where it is large. Cell (0,
//! 0) is the first block of the frame; a window is a rectangle of cells.

use std::cell::Cell;

use field::Pixels;
use glam::DVec2;

use crate::palette::{Feature, Palette};
use crate::plane::Plane;

/// Smoothing of the levels, σ of the window in which texture is measured, radius of its erosion. Cells.
const SMOOTH: f32 = 1.0;
const TEXTURE: f32 = 2.5;
const ERODED: usize = 5;

/// Weight of color and of texture against lightness.
const COLOR: f32 = 1.5;
const GRAIN: f32 = 1.5;

/// How levels become lightness: fixed by the first frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lightness {
    pub low: f64,
    pub factor: f64,
    pub color: bool,
}

/// No class was looked up yet.
const UNKNOWN: u8 = u8::MAX;

/// Features of a rectangle of cells.
#[derive(Debug)]
pub(crate) struct Window {
    /// The first cell.
    pub left: usize,
    pub top: usize,
    pub width: usize,
    pub height: usize,
    pub features: Vec<Feature>,
    /// Which of them are compared: 2 without color.
    pub channels: usize,
    classes: Vec<Cell<u8>>,
    owners: Vec<Owner>,
}

/// To which object a cell belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Owner {
    /// This one, or none.
    Free,
    /// Another one alone.
    Other,
    /// This one and another: which lies in front is not known.
    Shared,
    /// Its pixels do not count.
    Masked,
}

/// From pixels to cells of blocks of that side, and back.
pub(crate) fn to_cells(p: DVec2, block: f64) -> DVec2 {
    (p + 0.5) / block - 0.5
}

pub(crate) fn to_pixels(p: DVec2, block: f64) -> DVec2 {
    (p + 0.5) * block - 0.5
}

/// How many cells a frame has each way.
pub(crate) fn cells((width, height): (usize, usize), block: usize) -> (usize, usize) {
    ((width / block).max(1), (height / block).max(1))
}

impl Window {
    /// The cells between two corners, as far as the frame goes.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the frame"
    )]
    pub(crate) fn of(
        pixels: &dyn Pixels,
        block: usize,
        lightness: Lightness,
        low: DVec2,
        high: DVec2,
    ) -> Self {
        let (columns, rows) = cells(pixels.size(), block);
        let clamped = |v: f64, most: usize| v.clamp(0.0, most as f64) as usize;
        let (left, top) = (
            clamped(low.x.floor(), columns - 1),
            clamped(low.y.floor(), rows - 1),
        );
        let right = clamped(high.x.ceil() + 1.0, columns).max(left + 1);
        let bottom = clamped(high.y.ceil() + 1.0, rows).max(top + 1);
        let (width, height) = (right - left, bottom - top);
        let mean = |x: usize, y: usize| -> [f64; 3] {
            let mut sums = [0.0; 3];
            for j in 0..block {
                for i in 0..block {
                    let (x, y) = ((left + x) * block + i, (top + y) * block + j);
                    if lightness.color {
                        let color = pixels.color(x, y);
                        sums.iter_mut().zip(color).for_each(|(sum, v)| *sum += v);
                    } else {
                        sums[0] += pixels.level(x, y);
                    }
                }
            }
            let count = (block * block) as f64;
            sums.map(|sum| if sum.is_finite() { sum / count } else { 0.0 })
        };
        let mut planes = if lightness.color {
            let mut planes = [(); 3].map(|()| Plane::from_fn(width, height, |_, _| 0.0));
            for y in 0..height {
                for x in 0..width {
                    let lab = search::lab(mean(x, y));
                    for (plane, value) in planes.iter_mut().zip(lab) {
                        plane.data[y * width + x] = value as f32;
                    }
                }
            }
            planes.to_vec()
        } else {
            let light = |level: f64| (lightness.factor * (level - lightness.low)) as f32;
            vec![Plane::from_fn(width, height, |x, y| light(mean(x, y)[0]))]
        };
        let texture = texture(&planes[0]);
        for plane in &mut planes {
            *plane = plane.smoothed(SMOOTH);
        }
        let feature = |at: usize| -> Feature {
            let grain = GRAIN * texture.data[at];
            match &planes[..] {
                [l, a, b] => [l.data[at], grain, COLOR * a.data[at], COLOR * b.data[at]],
                _ => [planes[0].data[at], grain, 0.0, 0.0],
            }
        };
        let features: Vec<Feature> = (0..width * height).map(feature).collect();
        let classes = vec![Cell::new(UNKNOWN); features.len()];
        let channels = if lightness.color { 4 } else { 2 };
        let counts = |at: usize| {
            pixels.valid().is_none_or(|valid| {
                let (x, y) = (left + at % width, top + at / width);
                (0..block * block).all(|k| valid[[y * block + k / block, x * block + k % block]])
            })
        };
        let owner = |at: usize| {
            if counts(at) {
                Owner::Free
            } else {
                Owner::Masked
            }
        };
        let owners = (0..features.len()).map(owner).collect();
        Self {
            left,
            top,
            width,
            height,
            features,
            channels,
            classes,
            owners,
        }
    }

    /// The number of the cell that holds a place.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked to lie in the window"
    )]
    fn cell(&self, p: DVec2) -> Option<usize> {
        let (x, y) = (
            (p.x + 0.5).floor() - self.left as f64,
            (p.y + 0.5).floor() - self.top as f64,
        );
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64;
        inside.then(|| y as usize * self.width + x as usize)
    }

    /// The class of the cell that holds a place; None outside.
    pub(crate) fn class(&self, p: DVec2, palette: &Palette) -> Option<u8> {
        self.cell(p).and_then(|at| self.class_at(at, palette))
    }

    /// The class of a cell by its number.
    pub(crate) fn class_at(&self, at: usize, palette: &Palette) -> Option<u8> {
        if self.says_nothing(at) {
            return None;
        }
        let known = self.classes[at].get();
        if known != UNKNOWN {
            return Some(known);
        }
        let class = palette.nearest(&self.features[at]);
        self.classes[at].set(class);
        Some(class)
    }

    /// Whether what a cell shows is of an object that is not known, or does not count.
    fn says_nothing(&self, at: usize) -> bool {
        matches!(self.owners[at], Owner::Shared | Owner::Masked)
    }

    /// Whether a place belongs to another object alone.
    pub(crate) fn is_other(&self, p: DVec2) -> bool {
        self.cell(p)
            .is_some_and(|at| self.owners[at] == Owner::Other)
    }

    /// Mark the cells of another object: where this one is expected too, either may lie in front.
    pub(crate) fn own(&mut self, expected: &[DVec2], other: &[DVec2]) {
        let (mine, theirs) = (self.inside(expected), self.inside(other));
        for ((owner, mine), theirs) in self.owners.iter_mut().zip(mine).zip(theirs) {
            if theirs && *owner != Owner::Masked {
                *owner = if mine { Owner::Shared } else { Owner::Other };
            }
        }
    }

    /// The features between cells, linear; None outside.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked to lie in the window"
    )]
    pub(crate) fn feature(&self, p: DVec2) -> Option<Feature> {
        if self.says_nothing(self.cell(p)?) {
            return None;
        }
        let x = (p.x - self.left as f64).clamp(0.0, (self.width - 1) as f64);
        let y = (p.y - self.top as f64).clamp(0.0, (self.height - 1) as f64);
        let (i, j) = (x as usize, y as usize);
        let (a, b) = ((x - i as f64) as f32, (y - j as f64) as f32);
        let (right, below) = ((i + 1).min(self.width - 1), (j + 1).min(self.height - 1));
        let at = |i: usize, j: usize| &self.features[j * self.width + i];
        let (p, q, r, s) = (at(i, j), at(right, j), at(i, below), at(right, below));
        let mut out = [0.0; 4];
        for (k, out) in out.iter_mut().enumerate() {
            let above = p[k] + a * (q[k] - p[k]);
            let under = r[k] + a * (s[k] - r[k]);
            *out = above + b * (under - above);
        }
        Some(out)
    }

    /// Which cells have their middle inside a curve.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the window first"
    )]
    pub(crate) fn inside(&self, curve: &[DVec2]) -> Vec<bool> {
        let corner = DVec2::new(self.left as f64, self.top as f64);
        let mut inside = vec![false; self.width * self.height];
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); self.height];
        let n = curve.len();
        for i in 0..n {
            let (a, b) = (curve[i] - corner, curve[(i + 1) % n] - corner);
            let (top, bottom) = if a.y <= b.y { (a, b) } else { (b, a) };
            let from = top.y.ceil().clamp(0.0, self.height as f64) as usize;
            let to = bottom.y.ceil().clamp(0.0, self.height as f64) as usize;
            for (y, row) in crossings.iter_mut().enumerate().take(to).skip(from) {
                let share = (y as f64 - top.y) / (bottom.y - top.y);
                row.push(top.x + share * (bottom.x - top.x));
            }
        }
        for (row, crossings) in inside.chunks_mut(self.width.max(1)).zip(&mut crossings) {
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let from = pair[0].ceil().clamp(0.0, self.width as f64) as usize;
                let to = pair[1].ceil().clamp(0.0, self.width as f64) as usize;
                if from < to {
                    row[from..to].fill(true);
                }
            }
        }
        inside
    }
}

/// Local standard deviation, and of that the least nearby: an edge's own contrast would spill beyond it.
fn texture(light: &Plane) -> Plane {
    let mean = light.smoothed(TEXTURE);
    let squares = light.map(|v| v * v).smoothed(TEXTURE);
    let spread = mean
        .data
        .iter()
        .zip(&squares.data)
        .map(|(mean, square)| (square - mean * mean).max(0.0).sqrt());
    let spread = Plane {
        data: spread.collect(),
        ..mean
    };
    spread.eroded(ERODED).smoothed(SMOOTH)
}

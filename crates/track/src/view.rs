//! A frame as all objects together see it: what looks like them, and which of them covers it.

use glam::DVec2;

use crate::region::{Region, filled};
use crate::window::{to_cells, to_pixels};

/// A region of more than this share of an outline is the whole object.
const WHOLE: f64 = 0.75;

/// The ways to cells within two steps.
const STEPS: [(isize, isize); 12] = [
    (0, -2),
    (-1, -1),
    (0, -1),
    (1, -1),
    (-2, 0),
    (-1, 0),
    (1, 0),
    (2, 0),
    (-1, 1),
    (0, 1),
    (1, 1),
    (0, 2),
];

/// A frame as the crowd sees it.
#[derive(Debug, Clone)]
pub(crate) struct View {
    pub size: (usize, usize),
    pub block: f64,
    /// Which cells look like objects.
    pub like: Vec<bool>,
    /// How far each cell is from the mean of the ground, 0, towards that of objects, 1.
    pub level: Vec<f32>,
    /// The number of the object that covers a cell, from 1; 0 for none.
    pub owner: Vec<usize>,
}

impl View {
    pub(crate) fn to_cells(&self, curve: &[DVec2]) -> Vec<DVec2> {
        curve.iter().map(|p| to_cells(*p, self.block)).collect()
    }

    pub(crate) fn to_pixels(&self, curve: &[DVec2]) -> Vec<DVec2> {
        curve.iter().map(|p| to_pixels(*p, self.block)).collect()
    }

    /// Which share of a curve's cells in the frame looks like objects.
    pub(crate) fn share(&self, curve: &[DVec2]) -> f64 {
        let (mut like, mut all) = (0.0, 0.0);
        filled(self.size, &self.to_cells(curve), |at| {
            all += 1.0;
            like += f64::from(u8::from(self.like[at]));
        });
        if all > 0.0 { like / all } else { 0.0 }
    }

    /// The highest level on a line, one cell at a time; or the lowest.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the grid"
    )]
    pub(crate) fn extreme(&self, from: DVec2, to: DVec2, highest: bool) -> f32 {
        let steps = from.distance(to).ceil().max(1.0);
        let (width, height) = self.size;
        let last = DVec2::new(width as f64 - 1.0, height as f64 - 1.0);
        let mut k = 0.0;
        let mut found: Option<f32> = None;
        while k <= steps {
            let p = from.lerp(to, k / steps).round().clamp(DVec2::ZERO, last);
            let level = self.level[p.y as usize * width + p.x as usize];
            found = Some(match found {
                Some(found) if highest => found.max(level),
                Some(found) => found.min(level),
                None => level,
            });
            k += 1.0;
        }
        found.unwrap_or(0.0)
    }

    /// Whether a region fills most of a curve.
    pub(crate) fn fills(&self, region: &Region, curve: &[DVec2]) -> bool {
        let mut all = 0.0;
        filled(self.size, &self.to_cells(curve), |_| all += 1.0);
        region.cells.len() as f64 > WHOLE * all
    }

    /// The middle level of a region.
    pub(crate) fn middle_level(&self, cells: &[usize]) -> f32 {
        let mut levels: Vec<f32> = cells.iter().map(|&at| self.level[at]).collect();
        levels.sort_by(f32::total_cmp);
        levels.get(levels.len() / 2).copied().unwrap_or(0.0)
    }

    /// Whether a cell lies within two steps of those of another object.
    pub(crate) fn is_beside_other(&self, at: usize, own: usize) -> bool {
        let (width, height) = self.size;
        let (x, y) = ((at % width).cast_signed(), (at / width).cast_signed());
        STEPS.iter().any(|(i, j)| {
            let (x, y) = (x + i, y + j);
            let inside = x >= 0 && y >= 0 && x < width.cast_signed() && y < height.cast_signed();
            inside && {
                let owner = self.owner[y.unsigned_abs() * width + x.unsigned_abs()];
                owner != 0 && owner != own
            }
        })
    }

    /// An object covers these cells from now on, where none does.
    pub(crate) fn cover(&mut self, own: usize, curve: &[DVec2]) {
        let curve = self.to_cells(curve);
        filled(self.size, &curve, |at| {
            if self.owner[at] == 0 {
                self.owner[at] = own;
            }
        });
    }
}

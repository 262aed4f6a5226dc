//! What a frame says for a curve: whether what lies inside and outside, and across it, is what was learnt.

use glam::DVec2;

use crate::edges::Edges;
use crate::palette::{Feature, Palette};
use crate::profile::{HALF, Profiles, SAMPLES};
use crate::tables::{Ratios, Strips};
use crate::window::Window;

/// The most that a profile may speak against a node, in variances.
const WORST: f64 = 6.0;

/// Least depth of the strips that are looked at. Cells.
const LEAST: f64 = 4.0;

/// A frame says something for a curve of which this share at least lies in it.
const SHARE: f64 = 0.25;

/// What was learnt, as a frame is compared with it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Look<'a> {
    pub window: &'a Window,
    pub palette: &'a Palette,
    pub ratios: &'a Ratios,
    pub profiles: Option<&'a Profiles>,
    /// Edges, and the slope of half an edge in this window.
    pub edges: Option<(&'a Edges, f32)>,
}

/// What lies in another object speaks so much against this one.
const OTHERS: f64 = -1.5;

impl Look<'_> {
    /// How much likelier a place is inside than outside, by the tables of a node; None where nothing is known.
    pub(crate) fn ratio(&self, node: usize, place: DVec2) -> Option<f64> {
        if self.window.is_other(place) {
            return Some(OTHERS);
        }
        let class = self.window.class(place, self.palette)?;
        Some(self.ratios.at(node, class))
    }
}

/// Evidence of each node and the mean; about 1 at best.
#[derive(Debug, Clone)]
pub(crate) struct Evidence {
    /// None where the node lies outside the frame.
    pub nodes: Vec<Option<f64>>,
    pub mean: f64,
}

/// Features about a place, along the normal; None where one of them lies outside.
pub(crate) fn across(
    window: &Window,
    strips: &Strips<'_>,
    node: usize,
    offset: f64,
) -> Option<[Feature; SAMPLES]> {
    let mut samples = [[0.0; 4]; SAMPLES];
    for (k, sample) in samples.iter_mut().enumerate() {
        let d = offset + k as f64 - HALF as f64;
        *sample = window.feature(strips.curve[node] + d * strips.normals[node])?;
    }
    Some(samples)
}

impl Evidence {
    pub(crate) fn of(look: Look<'_>, strips: &Strips<'_>) -> Self {
        let depth = (0.5 * strips.depth).max(LEAST);
        let side = |node: usize, sign: f64, room: f64| -> Option<f64> {
            let (mut sum, mut count) = (0.0, 0.0);
            let mut d = 1.0;
            while d <= depth && (d <= room || d < 2.0) {
                let place = strips.curve[node] + sign * d * strips.normals[node];
                if let Some(ratio) = look.ratio(node, place) {
                    sum += ratio;
                    count += 1.0;
                }
                d += 1.0;
            }
            (count > 0.0).then(|| sum / count)
        };
        let one = |node: usize| -> Option<f64> {
            let [inner, outer] = strips.room[node];
            let region = 0.5 * (side(node, -1.0, inner)? - side(node, 1.0, 1.8 * outer)?);
            let Some(profiles) = look.profiles else {
                return Some(region);
            };
            let samples = across(look.window, strips, node, 0.0)?;
            let misfit = profiles.misfit(node, &samples).min(WORST) / WORST;
            Some(region - 0.5 * misfit)
        };
        let nodes: Vec<Option<f64>> = (0..strips.curve.len()).map(one).collect();
        let known = nodes.iter().flatten().count();
        let mean = if known as f64 >= SHARE * nodes.len() as f64 {
            nodes.iter().flatten().sum::<f64>() / known as f64
        } else {
            0.0
        };
        Self { nodes, mean }
    }
}

//! A snake on a picture, told in numbers: how high its top is, how much of it is stuck on the
//! contour, how far it is from the hand-drawn truth.

use crate::prelude::*;
use integrator::{State, System};
use ndarray::Array2;
use scene::Scene;
use std::f64::consts::TAU;

/// A closed contour to measure against, and boxes where it says nothing.
#[derive(Debug)]
pub(crate) struct Truth {
    pub(crate) contour: Vec<DVec2>,
    boxes: &'static [(&'static str, [f64; 4])],
    /// A node nearer than this is stuck on it, in pixels.
    near: f64,
}

impl Truth {
    /// The apple's contour as drawn by hand.
    pub(crate) fn apple() -> Result<Self> {
        Ok(Self {
            contour: scene::contour("apple-truth")?.first().to_vec(),
            boxes: &scene::APPLE_DISTURBING,
            near: 4.0,
        })
    }

    /// An ellipse that was drawn by numbers.
    pub(crate) fn ellipse(center: DVec2, semi_axes: DVec2) -> Self {
        let at = |i: usize| center + semi_axes * DVec2::from_angle(TAU * real(i) / 720.0);
        Self {
            contour: (0..720).map(at).collect(),
            boxes: &[],
            near: 2.0,
        }
    }

    /// Distance to the contour.
    pub(crate) fn distance(&self, p: DVec2) -> f64 {
        outline::distance(&self.contour, true, p)
    }

    /// Whether a place is in none of the boxes.
    pub(crate) fn counts(&self, p: DVec2) -> bool {
        let inside = |b: &[f64; 4]| p.x >= b[0] && p.x <= b[2] && p.y >= b[1] && p.y <= b[3];
        !self.boxes.iter().any(|(_, b)| inside(b))
    }

    /// Which nodes are stuck.
    pub(crate) fn stuck(&self, nodes: &[DVec2]) -> Vec<bool> {
        let near = |&p: &DVec2| self.distance(p) < self.near;
        nodes.iter().map(near).collect()
    }

    /// Mean distance of the nodes outside the boxes, and how many they are.
    pub(crate) fn mean_distance(&self, nodes: &[DVec2]) -> (f64, usize) {
        let kept = nodes.iter().filter(|&&p| self.counts(p));
        let kept: Vec<f64> = kept.map(|&p| self.distance(p)).collect();
        (mean(kept.iter().copied()), kept.len())
    }
}

/// Share of the nodes that are stuck.
pub(crate) fn share_of(stuck: &[bool]) -> f64 {
    mean(stuck.iter().map(|&stuck| flag(stuck)))
}

/// The highest node.
pub(crate) fn top(nodes: &[DVec2]) -> DVec2 {
    let highest = nodes.iter().copied().min_by(|a, b| a.y.total_cmp(&b.y));
    highest.unwrap_or_default()
}

/// A run on a picture.
#[derive(Debug)]
pub(crate) struct Story {
    pub(crate) scene: Scene,
    pub(crate) run: scene::Record,
    pub(crate) truth: Truth,
}

impl Story {
    /// Runs a scene.
    pub(crate) fn of(name: &str, changes: &[(&str, &str)], truth: Truth) -> Result<Self> {
        let (scene, run) = ran(name, changes)?;
        Ok(Self { scene, run, truth })
    }

    /// The nodes at the frame nearest to a time.
    pub(crate) fn at(&self, t: f64) -> &[DVec2] {
        let distance = |frame: &&scene::Frame| (frame.t - t).abs();
        let frames = self.run.frames.iter();
        let frame = frames.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        frame.map_or(&[], |frame| frame.nodes())
    }

    /// The nodes at the end.
    pub(crate) fn last(&self) -> &[DVec2] {
        last(&self.run)
    }

    /// The picture's and the elastic force on every node.
    pub(crate) fn forces(&self, nodes: &[DVec2]) -> (Vec<DVec2>, Vec<DVec2>) {
        let mut snake = self.scene.snake.clone();
        let n = nodes.len();
        let (mut image, mut elastic) = (vec![DVec2::ZERO; n], vec![DVec2::ZERO; n]);
        // its only force; a place without any has none
        let _ = snake.force_of(0, &State::at_rest(nodes.to_vec()), &mut image);
        snake.elastic(nodes, &mut elastic);
        (image, elastic)
    }

    /// The same, summed over the nodes above a height.
    pub(crate) fn forces_above(&self, nodes: &[DVec2], y: f64) -> (DVec2, DVec2) {
        let (image, elastic) = self.forces(nodes);
        let above = (0..nodes.len()).filter(|&i| nodes[i].y < y);
        above.fold((DVec2::ZERO, DVec2::ZERO), |sum, i| {
            (sum.0 + image[i], sum.1 + elastic[i])
        })
    }

    /// Keeps the run, the story moment by moment, and what is needed to draw them.
    ///
    /// `compared` moments apart go into `expected/`; `None` for none.
    pub(crate) fn keep(&self, record: &mut Record, compared: Option<usize>, tolerance: f64) {
        record.keep_run("curves", &self.run);
        keep_truth(record, &self.truth);
        if let Some(picture) = &self.scene.picture {
            record.keep_grid("picture", halved(picture.levels()));
        }
        let compared = compared.map(|step| (Table::new("story"), step));
        for (table, step) in std::iter::once((Table::raw("fine"), 1)).chain(compared) {
            let frames = || self.run.frames.iter().step_by(step);
            let stuck = frames().map(|frame| share_of(&self.truth.stuck(frame.nodes())));
            let distance = frames().map(|frame| self.truth.mean_distance(frame.nodes()).0);
            record.keep(
                table
                    .with("t", ROUNDING, frames().map(|frame| frame.t))
                    .with(
                        "top x [px]",
                        8.0,
                        frames().map(|frame| top(frame.nodes()).x),
                    )
                    .with(
                        "top y [px]",
                        tolerance,
                        frames().map(|frame| top(frame.nodes()).y),
                    )
                    // a node or two at the border of being stuck
                    .with("stuck [of the nodes]", 0.03, stuck)
                    .with("distance [px]", tolerance, distance),
            );
        }
    }
}

/// Keeps a contour so that it can be drawn, and told stuck nodes from others.
fn keep_truth(record: &mut Record, truth: &Truth) {
    let near = truth.contour.iter().map(|_| truth.near);
    let table = Table::raw("truth").xy("px", EXACT, &truth.contour);
    record.keep(table.exact("near [px]", near));
}

/// A contour read back from a record, without its boxes.
pub(crate) fn truth_of(record: &Record) -> Result<Truth> {
    let contour = record.xy("truth")?.into_iter().map(DVec2::from);
    Ok(Truth {
        contour: contour.collect(),
        boxes: &[],
        near: record.column("truth", "near")?[0],
    })
}

/// A large picture at half its size, by the mean of four pixels; a small one as it is.
fn halved(levels: &Array2<f64>) -> Array2<f64> {
    let (rows, columns) = levels.dim();
    if rows < 300 {
        return levels.clone();
    }
    Array2::from_shape_fn((rows / 2, columns / 2), |(row, column)| {
        let at = |i: usize, j: usize| levels[[2 * row + i, 2 * column + j]];
        ((at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1)) / 4.0).round()
    })
}

//! A snake on a picture, told in numbers: how high its top is, how much of it is stuck on the
//! contour, how far it is from the hand-drawn truth.

use crate::experiments::motion::{changed_scene, keep_energies, keep_frames, to_the_end};
use crate::{Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
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
    pub(crate) fn apple(id: &'static str) -> Result<Self, SandboxError> {
        let contour = scene::contour("apple-truth").map_err(SandboxError::refused(id))?;
        Ok(Self {
            contour: contour.first().to_vec(),
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
        let n = self.contour.len();
        let edges = (0..n).map(|i| (self.contour[i], self.contour[(i + 1) % n]));
        edges.fold(f64::INFINITY, |least, (a, b)| {
            let along = (p - a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE);
            least.min(p.distance(a.lerp(b, along.clamp(0.0, 1.0))))
        })
    }

    /// Whether a place is in none of the boxes.
    pub(crate) fn counts(&self, p: DVec2) -> bool {
        let inside = |b: &[f64; 4]| p.x >= b[0] && p.x <= b[2] && p.y >= b[1] && p.y <= b[3];
        !self.boxes.iter().any(|(_, b)| inside(b))
    }

    /// Which nodes are stuck.
    pub(crate) fn stuck(&self, nodes: &[DVec2]) -> Vec<bool> {
        nodes
            .iter()
            .map(|&p| self.distance(p) < self.near)
            .collect()
    }

    /// Mean distance of the nodes outside the boxes, and how many they are.
    pub(crate) fn mean_distance(&self, nodes: &[DVec2]) -> (f64, usize) {
        let kept: Vec<f64> = nodes
            .iter()
            .filter(|&&p| self.counts(p))
            .map(|&p| self.distance(p))
            .collect();
        (
            kept.iter().sum::<f64>() / real(kept.len().max(1)),
            kept.len(),
        )
    }
}

/// Share of the nodes that are stuck.
pub(crate) fn share(stuck: &[bool]) -> f64 {
    real(stuck.iter().filter(|&&s| s).count()) / real(stuck.len().max(1))
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
    pub(crate) fn of(
        id: &'static str,
        name: &str,
        changes: &[(&str, &str)],
        truth: Truth,
    ) -> Result<Self, SandboxError> {
        let mut scene = changed_scene(id, name, changes)?;
        let run = to_the_end(id, &mut scene)?;
        Ok(Self { scene, run, truth })
    }

    /// The nodes at the frame nearest to a time.
    pub(crate) fn at(&self, t: f64) -> &[DVec2] {
        let distance = |frame: &&scene::Frame| (frame.t - t).abs();
        let frame = self
            .run
            .frames
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        frame.map_or(&[], |frame| frame.nodes())
    }

    /// The nodes at the end.
    pub(crate) fn last(&self) -> &[DVec2] {
        self.run.last().map_or(&[], |frame| frame.nodes())
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

    /// Keeps frames, energies, the story frame by frame, and what is needed to draw them.
    ///
    /// `compared` rows apart go into `expected/`; `None` for none.
    pub(crate) fn keep(&self, record: &mut Record, compared: Option<usize>, tolerance: Tolerance) {
        keep_frames(record, "curves", &self.run);
        keep_energies(record, "energy", &self.run);
        keep_truth(record, &self.truth);
        if let Some(picture) = &self.scene.picture {
            record.keep_grid("picture", halved(picture.levels()));
        }
        let tables = [
            (Table::raw("fine"), Some(1)),
            (Table::new("story"), compared),
        ];
        for (table, step) in tables {
            let Some(step) = step else { continue };
            let frames: Vec<&scene::Frame> = self.run.frames.iter().step_by(step).collect();
            let pick = |value: &dyn Fn(&[DVec2]) -> f64| -> Vec<f64> {
                frames.iter().map(|frame| value(frame.nodes())).collect()
            };
            let some = Tolerance::Absolute(0.03); // a node or two at the border of being stuck
            record.keep(
                table
                    .with(
                        "t",
                        "",
                        Tolerance::ROUNDING,
                        frames.iter().map(|f| f.t).collect(),
                    )
                    .with("top x", "px", Tolerance::Absolute(8.0), pick(&|x| top(x).x))
                    .with("top y", "px", tolerance, pick(&|x| top(x).y))
                    .with(
                        "stuck",
                        "of the nodes",
                        some,
                        pick(&|x| share(&self.truth.stuck(x))),
                    )
                    .with(
                        "distance",
                        "px",
                        tolerance,
                        pick(&|x| self.truth.mean_distance(x).0),
                    ),
            );
        }
    }
}

/// Keeps a contour so that it can be drawn, and told stuck nodes from others.
fn keep_truth(record: &mut Record, truth: &Truth) {
    record.keep(
        Table::raw("truth")
            .with(
                "x",
                "px",
                Tolerance::EXACT,
                truth.contour.iter().map(|p| p.x).collect(),
            )
            .with(
                "y",
                "px",
                Tolerance::EXACT,
                truth.contour.iter().map(|p| p.y).collect(),
            )
            .with(
                "near",
                "px",
                Tolerance::EXACT,
                vec![truth.near; truth.contour.len()],
            ),
    );
}

/// A contour read back from a record, without its boxes.
pub(crate) fn truth_of(record: &Record) -> Result<Truth, SandboxError> {
    let points = record.points("truth", "x", "y")?;
    Ok(Truth {
        contour: points.into_iter().map(|(x, y)| DVec2::new(x, y)).collect(),
        boxes: &[],
        near: record
            .column("truth", "near")?
            .first()
            .copied()
            .unwrap_or(0.0),
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

//! What experiments with moving snakes share: a scene's run as tables, and its frames read back.

use crate::draw::{Color, Line};
use crate::{Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
use scene::Scene;
use std::path::Path;

/// A shipped scene, some of its words exchanged for others: `[(from, to)]`.
pub(crate) fn changed_scene(
    id: &'static str,
    name: &str,
    changes: &[(&str, &str)],
) -> Result<Scene, SandboxError> {
    let Some((_, text)) = scene::SCENES.iter().find(|(known, _)| *known == name) else {
        return Scene::named(name).map_err(SandboxError::refused(id)); // refused with the nearest name
    };
    let mut text = (*text).to_owned();
    for (from, to) in changes {
        if !text.contains(from) {
            return Err(SandboxError::refused(id)(format!(
                "{name} does not say {from}"
            )));
        }
        text = text.replace(from, to);
    }
    Scene::parse(name, &text, Path::new(".")).map_err(SandboxError::refused(id))
}

/// Runs a scene to its end.
pub(crate) fn to_the_end(
    id: &'static str,
    scene: &mut Scene,
) -> Result<scene::Record, SandboxError> {
    scene
        .run(&mut |_| std::ops::ControlFlow::Continue(()))
        .map_err(SandboxError::refused(id))
}

/// A point as the drawing kit takes it.
pub(crate) fn pair(p: DVec2) -> (f64, f64) {
    (p.x, p.y)
}

/// Keeps the frames of a run as a table of one row a node and frame; read back by [`Frames`].
pub(crate) fn keep_frames(record: &mut Record, name: &'static str, run: &scene::Record) {
    let nodes = || {
        run.frames
            .iter()
            .flat_map(|frame| frame.nodes().iter().map(move |&p| (frame.t, p)))
    };
    record.keep(
        Table::raw(name)
            .with("t", "", Tolerance::EXACT, nodes().map(|n| n.0).collect())
            .with("x", "", Tolerance::EXACT, nodes().map(|n| n.1.x).collect())
            .with("y", "", Tolerance::EXACT, nodes().map(|n| n.1.y).collect()),
    );
}

/// Keeps the energies of a run: time, every term, and "total".
pub(crate) fn keep_energies(record: &mut Record, name: &'static str, run: &scene::Record) {
    let kept: Vec<(f64, &snake::Energies)> = run
        .frames
        .iter()
        .filter_map(|frame| Some((frame.t, frame.energies.as_ref()?)))
        .collect();
    let mut table = Table::raw(name).with(
        "t",
        "",
        Tolerance::EXACT,
        kept.iter().map(|(t, _)| *t).collect(),
    );
    for (column, term) in run.terms.iter().enumerate() {
        let values = kept.iter().map(|(_, e)| e.values()[column]).collect();
        table = table.with(term, "", Tolerance::EXACT, values);
    }
    let totals = kept.iter().map(|(_, e)| e.mechanical()).collect();
    let elastic = kept.iter().map(|(_, e)| e.elastic()).collect();
    record.keep(table.with("elastic", "", Tolerance::EXACT, elastic).with(
        "total",
        "",
        Tolerance::EXACT,
        totals,
    ));
}

/// Frames read back from a table that [`keep_frames`] wrote.
#[derive(Debug)]
pub(crate) struct Frames {
    nodes: usize,
    times: Vec<f64>,
    points: Vec<(f64, f64)>,
}

impl Frames {
    /// The frames in that table.
    pub(crate) fn of(record: &Record, table: &str) -> Result<Self, SandboxError> {
        let t = record.column(table, "t")?;
        let points = record.points(table, "x", "y")?;
        let first = t.first().map_or(0, |t| t.to_bits());
        let nodes = t.iter().take_while(|t| t.to_bits() == first).count().max(1);
        Ok(Self {
            nodes,
            times: t.iter().copied().step_by(nodes).collect(),
            points,
        })
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.times.len()
    }

    /// The time of a frame.
    pub(crate) fn t(&self, frame: usize) -> f64 {
        self.times[frame]
    }

    /// The nodes of a frame.
    pub(crate) fn curve(&self, frame: usize) -> Vec<(f64, f64)> {
        self.points[frame * self.nodes..(frame + 1) * self.nodes].to_vec()
    }

    /// The same as vectors.
    pub(crate) fn nodes(&self, frame: usize) -> Vec<DVec2> {
        let curve = self.curve(frame);
        curve.into_iter().map(|(x, y)| DVec2::new(x, y)).collect()
    }

    /// The frame nearest in time.
    pub(crate) fn nearest(&self, t: f64) -> usize {
        let distance = |i: &usize| (self.times[*i] - t).abs();
        (0..self.len())
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or(0)
    }

    /// The frames nearest to `0, every, 2 every …` up to the last.
    pub(crate) fn each(&self, every: f64) -> Vec<usize> {
        let end = self.times.last().copied().unwrap_or(0.0);
        let mut out: Vec<usize> = (0..100_000)
            .map(|i| real(i) * every)
            .take_while(|t| *t <= end + 1e-9)
            .map(|t| self.nearest(t))
            .collect();
        out.dedup();
        out
    }

    /// A closed curve as a line.
    pub(crate) fn ring(&self, frame: usize, color: Color) -> Line {
        Line::new(self.curve(frame), color).closed()
    }
}

/// Every `step`-th value, the first included.
pub(crate) fn thin<T: Copy>(values: &[T], step: usize) -> Vec<T> {
    values.iter().copied().step_by(step.max(1)).collect()
}

/// Least and largest of finite values, a little room added.
pub(crate) fn range(values: impl IntoIterator<Item = f64>, room: f64) -> (f64, f64) {
    let (low, high) = values
        .into_iter()
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        });
    let span = (high - low).max(1e-12);
    (low - room * span, high + room * span)
}

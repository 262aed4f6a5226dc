//! Drawings of runs: curves over each other, energies over time.

use crate::prelude::*;

/// Lines of a table over time: a column, what it is called, a color.
pub(crate) fn over_time(
    record: &Record,
    table: &str,
    columns: &[(&str, &str, Color)],
    title: &str,
    label: &str,
) -> Result<Panel> {
    let points = columns.iter().map(|one| record.points(table, "t", one.0));
    let points = points.collect::<Result<Vec<_>>>()?;
    Ok(lines_over_time(points, columns, title, label))
}

/// Energies of a run over time: a term, what it is called, a color.
pub(crate) fn energies(
    record: &Record,
    run: &str,
    terms: &[(&str, &str, Color)],
    title: &str,
) -> Result<Panel> {
    let points = terms.iter().map(|one| record.run(run)?.energy(one.0));
    let points = points.collect::<Result<Vec<_>>>()?;
    Ok(lines_over_time(points, terms, title, "energy"))
}

fn lines_over_time(
    points: Vec<Vec<(f64, f64)>>,
    names: &[(&str, &str, Color)],
    title: &str,
    label: &str,
) -> Panel {
    let end = points.first().and_then(|points| points.last());
    let end = end.map_or(1.0, |point| point.0);
    let (low, mut high) = range(points.iter().flatten().map(|p| p.1), 0.06);
    if names.iter().any(|(_, name, _)| !name.is_empty()) {
        high += 0.3 * (high - low); // room for the legend
    }
    let panel = plot(title, ("t", 0.0, end), (label, low, high));
    let lines = points.into_iter().zip(names);
    lines.fold(panel, |panel, (points, (_, name, color))| {
        panel.with(line(points, *color).named(*name).weighing(0.9))
    })
}

/// The account over time: what is there piled from zero up, and the sum.
pub(crate) fn account(
    record: &Record,
    run: &str,
    title: &str,
    terms: &[(&str, &str, Color)],
) -> Result<Panel> {
    let run = record.run(run)?;
    let mut ground: Vec<(f64, f64)> = run.account.iter().map(|row| (row.0, 0.0)).collect();
    let end = ground.last().map_or(1.0, |point| point.0);
    let mut panel = plot(title, ("t / s", 0.0, end), ("energy", 0.0, 1.0));
    let mut highest = 0.0_f64;
    for (term, name, color) in terms {
        let values = run.energy(term)?;
        // a potential may begin anywhere
        let lowest = values.iter().fold(0.0_f64, |a, p| a.min(p.1));
        let edge = ground.iter().zip(&values);
        let edge: Vec<(f64, f64)> = edge.map(|(g, v)| (g.0, g.1 + (v.1 - lowest))).collect();
        highest = edge.iter().fold(highest, |a, p| a.max(p.1));
        let around = edge.iter().copied().chain(ground.into_iter().rev());
        panel = panel
            .with(area(around, *color, 0.55))
            .with(line(edge.clone(), *color).weighing(0.5).named(*name));
        ground = edge;
    }
    panel.y.to = 1.35 * highest;
    Ok(panel)
}

/// Curves of one moment in a panel without axes, the inside of closed ones filled.
pub fn picture(
    title: impl Into<String>,
    curves: &[Curve],
    [x0, y0, x1, y1]: [f64; 4],
    color: &dyn Fn(usize) -> Color,
) -> Panel {
    let mut panel = plot(title, ("", x0, x1), ("", y0, y1)).equal().bare();
    for curve in curves {
        let (points, color) = (curve.points(), color(curve.id));
        if curve.closed {
            panel = panel.with(area(points.clone(), color, 0.18));
        }
        panel = panel.with(line(points, color).weighing(0.8));
    }
    panel
}

/// A wall from one point to another.
pub fn wall(from: impl Into<(f64, f64)>, to: impl Into<(f64, f64)>) -> Line {
    line([from.into(), to.into()], Color::INK).weighing(1.4)
}

impl Run {
    /// A moment's first curve, led back to its first node.
    pub(crate) fn ring(&self, frame: usize, color: Color) -> Line {
        line(self.pairs(frame), color).closed()
    }
}

/// Moments over each other from blue (the start) to red (the end).
pub(crate) fn snapshots(mut panel: Panel, run: &Run, chosen: &[usize], weight: f64) -> Panel {
    let end = run.t(chosen.last().copied().unwrap_or(0)).max(1e-9);
    let begin = run.t(chosen.first().copied().unwrap_or(0));
    for &frame in chosen {
        let share = (run.t(frame) - begin) / (end - begin).max(1e-9);
        let color = Color::BLUE.mix(Color::RED, share);
        panel = panel.with(run.ring(frame, color).weighing(weight));
    }
    panel
}

//! A ball as the report draws it: snapshots over each other, the wall, the way of the center.

use super::course::RECOVERED;
use crate::prelude::*;

/// Time between two snapshots, in seconds.
const BETWEEN: f64 = 0.5;

/// A panel with the wall at x = 0, seen from the right.
fn at_the_wall(
    title: impl Into<String>,
    (left, right): (f64, f64),
    (low, high): (f64, f64),
) -> Panel {
    let panel = plot(title, ("x", left, right), ("y", low, high)).equal();
    panel
        .with(area(
            [(left, low), (0.0, low), (0.0, high), (left, high)],
            Color::GREY,
            0.45,
        ))
        .with(line([(0.0, low), (0.0, high)], Color::INK).weighing(1.2))
}

/// The report's panel: one ball, snapshots every half second, the wall, the way of the center.
fn report_panel(record: &Record, title: &str) -> Result<Panel> {
    let frames = record.run("curves")?;
    let chosen = frames.each(BETWEEN);
    let all = || chosen.iter().flat_map(|&i| frames.nodes(i));
    let right = range(all().map(|p| p.x), 0.04).1.max(7.0);
    let panel = at_the_wall(title, (-0.35, right), range(all().map(|p| p.y), 0.06));
    let way = line(record.points("fine", "center x", "center y")?, Color::INK);
    let way = way.dashed().weighing(0.7).named("center of mass");
    Ok(snapshots(panel, frames, &chosen, 0.7).with(way))
}

/// The same around the moment the ball is squeezed most.
fn close_up(record: &Record) -> Result<Panel> {
    let frames = record.run("curves")?;
    let first = record.told("first contact")?;
    let least = record.told("time of the least area")?;
    let last = record.told("last contact")?;
    let until = (least + (least - first))
        .min(last.max(least))
        .min(first + 3.0);
    let times = (0..7).map(|i| first + (until - first) * real(i) / 6.0);
    let chosen: Vec<usize> = times.map(|t| frames.nearest(t)).collect();
    let all = || chosen.iter().flat_map(|&i| frames.nodes(i));
    let right = range(all().map(|p| p.x), 0.06).1;
    let title = format!("at the wall, {first:.2} s to {until:.2} s");
    let panel = at_the_wall(title, (-0.3, right), range(all().map(|p| p.y), 0.08));
    Ok(snapshots(panel, frames, &chosen, 0.8))
}

/// A panel whose time is in seconds.
fn in_seconds(mut panel: Panel) -> Panel {
    panel.x.label = "t / s".to_owned();
    panel
}

/// The figure of one ball: as the report draws it, at the wall, and its numbers over time.
pub(crate) fn figure(record: &Record, title: &str) -> Result<Figure> {
    let mut seen = report_panel(record, "a snapshot every 0.5 s, from blue to orange")?;
    seen.share = 1.3;
    let own = [("deformation", "its own", Color::BLUE)];
    let shape = over_time(
        record,
        "fine",
        &own,
        "deformation from its shape",
        "rms of e",
    )?;
    let end = shape.x.to;
    let limit = line([(0.0, RECOVERED), (end, RECOVERED)], Color::GREY);
    let limit = limit.dashed().weighing(0.6).named("recovered below 0.04");
    let area = over_time(
        record,
        "fine",
        &[("area", "", Color::GREEN)],
        "area",
        "of the start",
    )?;
    let terms = [
        ("kinetic", "kinetic", Color::BLUE),
        ("elastic", "elastic", Color::RED),
        ("gravity", "gravity", Color::GREEN),
        ("total", "sum", Color::INK),
    ];
    let energy = energies(record, "curves", &terms, "energy")?;
    let below = [shape.with(limit), area, energy].map(in_seconds).to_vec();
    Ok(Figure::new(title, 900.0)
        .with(430.0, vec![seen, close_up(record)?])
        .with(230.0, below))
}

/// The ball in motion, in real time.
pub(crate) fn animation(record: &Record) -> Result<Animation> {
    let frames = record.run("curves")?;
    let way = record.points("fine", "center x", "center y")?;
    let all = || (0..frames.len()).flat_map(|i| frames.nodes(i));
    let (low, high) = range(all().map(|p| p.y), 0.05);
    let right = range(all().map(|p| p.x), 0.03).1;
    let stroke = |points: Vec<(f64, f64)>, color: Color, width: f64| Stroke {
        points,
        color,
        width,
    };
    let shots = (0..frames.len()).step_by(4).map(|i| {
        let gone = way[..=i.min(way.len() - 1)].to_vec();
        let strokes = vec![
            stroke(vec![(0.0, low), (0.0, high)], Color::INK, 3.0),
            stroke(gone, Color::GREY, 1.5),
            stroke(frames.ring(i, Color::BLUE).points, Color::BLUE, 2.5),
        ];
        Shot { strokes, hold: 8 }
    });
    Ok(Animation {
        view: [-0.2, high, right.max(7.0), low],
        width: 320,
        ground: None,
        shots: shots.collect(),
    })
}

/// Figure and animation of one ball.
pub(crate) fn one(record: &Record, title: &str, caption: &'static str) -> Drawn {
    with_motion(record, figure(record, title)?, caption)
}

/// A figure of a ball, and its animation.
pub(crate) fn with_motion(record: &Record, figure: Figure, caption: &'static str) -> Drawn {
    let words = "The same in motion, in real time.";
    Ok(vec![
        Artefact::figure(caption, figure),
        Artefact::further("moving", words, animation(record)?),
    ])
}

//! A ball as the report draws it: snapshots over each other, the wall, the way of the center.

use super::course::RECOVERED;
use crate::draw::{Animation, Axis, Color, Corner, Figure, Layer, Line, Panel, Shot, Stroke};
use crate::experiments::motion::{Frames, range};
use crate::experiments::over_time::over_time;
use crate::{Artefact, Body, Record, SandboxError};

/// Time between two snapshots, in seconds.
const BETWEEN: f64 = 0.5;

/// Snapshots over each other from blue (the start) to red (the end).
pub(crate) fn snapshots(mut panel: Panel, frames: &Frames, chosen: &[usize], weight: f64) -> Panel {
    let end = frames.t(chosen.last().copied().unwrap_or(0)).max(1e-9);
    let begin = frames.t(chosen.first().copied().unwrap_or(0));
    for &frame in chosen {
        let share = (frames.t(frame) - begin) / (end - begin).max(1e-9);
        let color = Color::BLUE.mix(Color::RED, share);
        panel = panel.with(frames.ring(frame, color).weighing(weight));
    }
    panel
}

/// The wall at x = 0, seen from the right.
fn wall(panel: Panel, low: f64, high: f64, left: f64) -> Panel {
    panel
        .with(Layer::Area {
            points: vec![(left, low), (0.0, low), (0.0, high), (left, high)],
            color: Color::GREY,
            opacity: 0.45,
        })
        .with(Line::new(vec![(0.0, low), (0.0, high)], Color::INK).weighing(1.2))
}

/// The report's panel: one ball, snapshots every half second, the wall, the way of the center.
pub(crate) fn report_panel(record: &Record, title: &str) -> Result<Panel, SandboxError> {
    let frames = Frames::of(record, "curves")?;
    let chosen = frames.each(BETWEEN);
    let all = || chosen.iter().flat_map(|&i| frames.curve(i));
    let right = range(all().map(|p| p.0), 0.04).1.max(7.0);
    let (low, high) = range(all().map(|p| p.1), 0.06);
    let panel = Panel::new(
        title,
        Axis::new("x", -0.35, right),
        Axis::new("y", low, high),
    )
    .equal();
    let panel = wall(panel, low, high, -0.35);
    let panel = snapshots(panel, &frames, &chosen, 0.7);
    let way = record.points("fine", "center x", "center y")?;
    Ok(panel.with(
        Line::new(way, Color::INK)
            .dashed()
            .weighing(0.7)
            .named("center of mass"),
    ))
}

/// The same around the moment the ball is squeezed most.
fn close_up(record: &Record) -> Result<Panel, SandboxError> {
    let frames = Frames::of(record, "curves")?;
    let (first, least) = (
        record.number("first contact")?,
        record.number("time of the least area")?,
    );
    let last = record.number("last contact")?;
    let until = (least + (least - first))
        .min(last.max(least))
        .min(first + 3.0);
    let count = 7;
    let chosen: Vec<usize> = (0..count)
        .map(|i| first + (until - first) * crate::real(i) / crate::real(count - 1))
        .map(|t| frames.nearest(t))
        .collect();
    let all = || chosen.iter().flat_map(|&i| frames.curve(i));
    let right = range(all().map(|p| p.0), 0.06).1;
    let (low, high) = range(all().map(|p| p.1), 0.08);
    let title = format!("at the wall, {first:.2} s to {until:.2} s");
    let panel = Panel::new(
        title,
        Axis::new("x", -0.3, right),
        Axis::new("y", low, high),
    )
    .equal();
    let panel = wall(panel, low, high, -0.3);
    Ok(snapshots(panel, &frames, &chosen, 0.8))
}

/// A quantity over time, which is in seconds here.
fn over_seconds(
    record: &Record,
    table: &str,
    columns: &[(&str, &str, Color)],
    title: &str,
    label: &str,
) -> Result<Panel, SandboxError> {
    let mut panel = over_time(record, table, columns, title, label)?;
    panel.x.label = "t / s".to_owned();
    Ok(panel)
}

/// The figure of one ball: as the report draws it, at the wall, and its numbers over time.
pub(crate) fn figure(record: &Record, title: &str) -> Result<Figure, SandboxError> {
    let mut seen = report_panel(record, "a snapshot every 0.5 s, from blue to orange")?;
    seen.share = 1.3;
    let shape = over_seconds(
        record,
        "fine",
        &[("deformation", "its own", Color::BLUE)],
        "deformation from its shape",
        "rms of e",
    )?;
    let end = record.column("fine", "t")?.last().copied().unwrap_or(1.0);
    let limit = Line::new(vec![(0.0, RECOVERED), (end, RECOVERED)], Color::GREY)
        .dashed()
        .weighing(0.6)
        .named("recovered below 0.04");
    let area = over_seconds(
        record,
        "fine",
        &[("area", "", Color::GREEN)],
        "area",
        "of the start",
    )?;
    let energy = over_seconds(
        record,
        "energy",
        &[
            ("kinetic", "kinetic", Color::BLUE),
            ("elastic", "elastic", Color::RED),
            ("gravity", "gravity", Color::GREEN),
            ("total", "sum", Color::INK),
        ],
        "energy",
        "energy",
    )?;
    Ok(Figure::new(title, 900.0)
        .with(430.0, vec![seen, close_up(record)?])
        .with(230.0, vec![shape.with(limit), area, energy]))
}

/// The ball in motion, in real time.
pub(crate) fn animation(record: &Record) -> Result<Animation, SandboxError> {
    let frames = Frames::of(record, "curves")?;
    let way = record.points("fine", "center x", "center y")?;
    let (low, high) = range(
        (0..frames.len()).flat_map(|i| frames.curve(i)).map(|p| p.1),
        0.05,
    );
    let right = range(
        (0..frames.len()).flat_map(|i| frames.curve(i)).map(|p| p.0),
        0.03,
    )
    .1;
    let stroke = |points: Vec<(f64, f64)>, color: Color, width: f64| Stroke {
        points,
        color,
        width,
    };
    let shots = (0..frames.len())
        .step_by(4)
        .map(|i| {
            let mut ring = frames.curve(i);
            ring.push(ring[0]);
            Shot {
                strokes: vec![
                    stroke(vec![(0.0, low), (0.0, high)], Color::INK, 3.0),
                    stroke(way[..=i.min(way.len() - 1)].to_vec(), Color::GREY, 1.5),
                    stroke(ring, Color::BLUE, 2.5),
                ],
                hold: 8,
            }
        })
        .collect();
    Ok(Animation {
        view: [-0.2, high, right.max(7.0), low],
        width: 320,
        ground: None,
        shots,
    })
}

/// Figure and animation of one ball.
pub(crate) fn one(
    record: &Record,
    title: &str,
    caption: &'static str,
) -> Result<Vec<Artefact>, SandboxError> {
    Ok(vec![
        Artefact::figure(caption, figure(record, title)?),
        Artefact::further(
            "moving",
            "The same in motion, in real time.",
            Body::Animation(animation(record)?),
        ),
    ])
}

/// A legend corner other than the usual, for panels whose curves run there.
pub(crate) fn legend_low(panel: Panel) -> Panel {
    panel.legend_at(Corner::BottomRight)
}

//! The legend of a panel: what it names, and where it lies on nothing.

use super::chart::{Area, local, rgb, stroke, text_style, unsigned, write};
use super::figure::{DrawError, LINE, UNITS};
use super::frame::Frame;
use super::palette::Color;
use super::panel::{Corner, Layer, Line, Panel};
use plotters::prelude::{Circle, Rectangle};
use plotters::style::Color as _;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// A name, its color, and its line where it is one.
pub(super) type Entry = (String, Color, Option<Line>);

/// Height of a row and width of its sample, in page units.
const ROW: f64 = 15.0 * UNITS;
const SAMPLE: f64 = 20.0 * UNITS;
/// Between the legend and the frame.
const GAP: f64 = 7.0 * UNITS;

/// The layers of a panel that have a name.
pub(super) fn entries(panel: &Panel) -> Vec<Entry> {
    let named = panel.layers.iter().filter_map(|layer| match layer {
        Layer::Line(line) => Some((line.label.clone(), line.color, Some(line.clone()))),
        Layer::Dots { label, color, .. } => Some((label.clone(), *color, None)),
        _ => None,
    });
    named.filter(|entry| !entry.0.is_empty()).collect()
}

/// Width and height of a legend in page units; nothing for none.
pub(super) fn size(entries: &[Entry]) -> (f64, f64) {
    let longest = entries.iter().map(|entry| entry.0.chars().count()).max();
    longest.map_or((0.0, 0.0), |longest| {
        (
            SAMPLE + 10.0 * UNITS + crate::real(longest) * 5.4 * UNITS,
            ROW * crate::real(entries.len()),
        )
    })
}

/// The upper left corner of a place in the frame where a legend of that size lies on nothing: the
/// corner asked for if it can be, else another corner, else the first free place. Pictures are ground
/// and do not count.
pub(super) fn free_place(panel: &Panel, frame: &Frame, size: (f64, f64)) -> Option<(f64, f64)> {
    let (left, top) = (frame.left + GAP, frame.top + GAP);
    let (right, bottom) = (frame.right - GAP - size.0, frame.bottom - GAP - size.1);
    let corner = |corner: Corner| match corner {
        Corner::TopLeft => (left, top),
        Corner::TopRight => (right, top),
        Corner::BottomLeft => (left, bottom),
        Corner::BottomRight => (right, bottom),
    };
    let asked = corner(panel.legend);
    if size.1 <= 0.0 {
        return Some(asked);
    }
    let occupied = occupied(panel, frame);
    if occupied.is_empty() {
        return Some(asked); // a panel that is only a legend
    }
    if right < left || bottom < top {
        return None;
    }
    let all = [
        panel.legend,
        Corner::TopRight,
        Corner::TopLeft,
        Corner::BottomRight,
        Corner::BottomLeft,
    ];
    let between = (0..=8).flat_map(|down| {
        (0..=12).map(move |across| {
            (
                right + (left - right) * f64::from(across) / 12.0,
                top + (bottom - top) * f64::from(down) / 8.0,
            )
        })
    });
    all.into_iter()
        .map(corner)
        .chain(between)
        .find(|&place| is_free(&occupied, panel, frame, place, size))
}

/// Whether nothing that is drawn lies in a box.
fn is_free(
    occupied: &[(f64, f64)],
    panel: &Panel,
    frame: &Frame,
    at: (f64, f64),
    size: (f64, f64),
) -> bool {
    let edge = 3.0 * UNITS;
    let inside = |p: &(f64, f64)| {
        (at.0 - edge..=at.0 + size.0 + edge).contains(&p.0)
            && (at.1 - edge..=at.1 + size.1 + edge).contains(&p.1)
    };
    if occupied.iter().any(inside) {
        return false;
    }
    // areas count as a whole
    let samples = (0..=4).flat_map(|i| (0..=4).map(move |j| (f64::from(i), f64::from(j))));
    let mut samples = samples.map(|(i, j)| (at.0 + size.0 * i / 4.0, at.1 + size.1 * j / 4.0));
    !samples.any(|p| {
        panel.layers.iter().any(|layer| match layer {
            Layer::Area { points, .. } => {
                let placed: Vec<(f64, f64)> =
                    points.iter().map(|&q| placed(panel, frame, q)).collect();
                encloses(&placed, p)
            }
            _ => false,
        })
    })
}

fn placed(panel: &Panel, frame: &Frame, at: (f64, f64)) -> (f64, f64) {
    frame.place((panel.x.place(at.0), panel.y.place(at.1)))
}

/// Whether a polygon encloses a point: crossings of a ray to the right.
fn encloses(polygon: &[(f64, f64)], p: (f64, f64)) -> bool {
    let mut odd = false;
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        if (a.1 > p.1) != (b.1 > p.1) && p.0 < a.0 + (b.0 - a.0) * (p.1 - a.1) / (b.1 - a.1) {
            odd = !odd;
        }
    }
    odd
}

/// Points so close on everything drawn that no legend falls between them.
fn occupied(panel: &Panel, frame: &Frame) -> Vec<(f64, f64)> {
    let step = 6.0 * UNITS;
    let at = |p: (f64, f64)| placed(panel, frame, p);
    let mut out = Vec::new();
    let mut segment = |a: (f64, f64), b: (f64, f64)| {
        let Some((a, b)) = frame.cut(a, b) else {
            return;
        };
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        let mut way = 0.0;
        while way < length {
            let share = way / length;
            out.push((a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1)));
            way += step;
        }
        out.push(b);
    };
    for layer in &panel.layers {
        match layer {
            Layer::Line(line) => {
                for pair in line.points.windows(2) {
                    let (a, b) = (at(pair[0]), at(pair[1]));
                    if [a.0, a.1, b.0, b.1].iter().all(|part| part.is_finite()) {
                        segment(a, b);
                    }
                }
            }
            Layer::Dots { points, .. } => points.iter().for_each(|&p| segment(at(p), at(p))),
            Layer::Arrows { arrows, .. } => {
                for (start, vector) in arrows {
                    segment(at(*start), at((start.0 + vector.0, start.1 + vector.1)));
                }
            }
            Layer::Text {
                at: place,
                words,
                centered,
                ..
            } => {
                let (x, y) = at(*place);
                let half = crate::real(words.chars().count()) * 2.9 * UNITS;
                let middle = if *centered { x } else { x + half };
                segment((middle - half, y), (middle + half, y));
            }
            Layer::Area { points, .. } => {
                for pair in points.windows(2) {
                    segment(at(pair[0]), at(pair[1]));
                }
            }
            Layer::Picture(_) => {}
        }
    }
    out
}

/// Draws a legend with its upper left corner at a place.
pub(super) fn draw(
    area: &Area<'_>,
    frame: &Frame,
    entries: &[Entry],
    (left, top): (f64, f64),
) -> Result<(), DrawError> {
    if entries.is_empty() {
        return Ok(());
    }
    let (width, height) = size(entries);
    // the samples may lie beside the frame
    let frame = &Frame {
        left: frame.left.min(left),
        right: frame.right.max(left + width),
        ..*frame
    };
    let corners = [(left, top), (left + width, top + height)].map(|p| local(area, p));
    area.draw(&Rectangle::new(
        corners,
        rgb(Color::WHITE).mix(0.85).filled(),
    ))?;
    for (index, (words, color, line)) in entries.iter().enumerate() {
        let y = top + ROW * (crate::real(index) + 0.5);
        let start = left + 3.0 * UNITS;
        match line {
            Some(line) => {
                let points = [(start, y), (start + SAMPLE, y)];
                stroke(area, frame, &points, *color, line.weight, line.dash)?;
            }
            None => {
                let middle = local(area, (start + SAMPLE / 2.0, y));
                area.draw(&Circle::new(
                    middle,
                    unsigned(LINE * 1.8),
                    rgb(*color).filled(),
                ))?;
            }
        }
        let style = text_style(10.5, Color::INK).pos(Pos::new(HPos::Left, VPos::Center));
        write(area, words, &style, (start + SAMPLE + 5.0 * UNITS, y))?;
    }
    Ok(())
}

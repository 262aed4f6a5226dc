//! Curves over a picture: panels, strips of frames, animations.

use super::story::{Truth, truth_of};
use crate::prelude::*;
use ndarray::Array2;

/// The part that is not on the contour.
pub(crate) const LOOSE: Color = Color::YELLOW;
/// The part that is.
pub(crate) const HELD: Color = Color::SKY;

/// Width and height of the picture in its own pixels.
fn size(picture: &Array2<f64>) -> (f64, f64) {
    let (rows, columns) = picture.dim();
    let scale = if rows >= 150 { 2.0 } else { 1.0 }; // large ones are kept at half size
    (scale * real(columns), scale * real(rows))
}

/// A panel with the picture, as wide as it is.
pub(crate) fn over_picture(record: &Record, title: &str, bare: bool) -> Result<Panel> {
    let picture = record.grid("picture")?;
    let (width, height) = size(picture);
    let (right, bottom) = (width - 0.5, height - 0.5);
    let mut panel = plot(title, ("x / px", -0.5, right), ("y / px", bottom, -0.5)).equal();
    panel.grid = false;
    if bare {
        panel = panel.bare();
    }
    let mut ground = Picture::new(picture.mapv(whole_grey)).over([-0.5, -0.5, right, bottom]);
    ground.smooth = height > 150.0;
    Ok(panel.with(ground))
}

/// The parts of a curve where `stuck` is, or is not, as asked; neighbours of the other kind are
/// included so that no gap is left.
fn part(curve: &[(f64, f64)], stuck: &[bool], wanted: bool, closed: bool) -> Vec<(f64, f64)> {
    let n = curve.len();
    let gap = (f64::NAN, f64::NAN);
    let edges = if closed { n } else { n.saturating_sub(1) };
    let mut out = vec![gap];
    for i in 0..edges {
        let next = (i + 1) % n;
        // an edge counts as stuck when both its nodes are
        if (stuck[i] && stuck[next]) == wanted {
            if out.last() != Some(&curve[i]) {
                out.push(gap);
                out.push(curve[i]);
            }
            out.push(curve[next]);
        }
    }
    out
}

/// The snake over a panel: yellow, and blue where it is stuck on the contour.
pub(crate) fn snake_on(
    panel: Panel,
    nodes: &[DVec2],
    truth: &Truth,
    closed: bool,
    weight: f64,
) -> Panel {
    let parts = parts(&pairs(nodes), &truth.stuck(nodes), closed).into_iter();
    parts.fold(panel, |panel, (points, color)| {
        panel.with(line(points, color).weighing(weight))
    })
}

/// The loose part and the stuck one, each in its color.
fn parts(curve: &[(f64, f64)], stuck: &[bool], closed: bool) -> [(Vec<(f64, f64)>, Color); 2] {
    [(false, LOOSE), (true, HELD)]
        .map(|(wanted, color)| (part(curve, stuck, wanted, closed), color))
}

/// One frame as the report shows them: the picture and the snake, nothing else.
pub(crate) fn frame_panel(record: &Record, letter: &str, t: f64, closed: bool) -> Result<Panel> {
    let frames = record.run("curves")?;
    let frame = frames.nearest(t);
    let title = format!("{letter})  t = {:.0}", frames.t(frame));
    let panel = over_picture(record, &title, true)?;
    Ok(snake_on(
        panel,
        frames.nodes(frame),
        &truth_of(record)?,
        closed,
        1.3,
    ))
}

/// Many frames over a part of the picture: left, top, right, bottom in its own pixels.
pub(crate) fn window(record: &Record, times: &[f64], part: [usize; 4]) -> Result<Panel> {
    let picture = record.grid("picture")?;
    let half = if size(picture).0 / real(picture.ncols()) > 1.5 {
        2
    } else {
        1
    };
    let [left, top, right, bottom] = part.map(|edge| edge / half);
    let cut = picture.slice(ndarray::s![top..bottom, left..right]);
    let extent = part.map(|edge| real(edge) - 0.5);
    let mut ground = Picture::new(cut.mapv(whole_grey)).over(extent);
    ground.smooth = true;
    let x = ("x / px", extent[0], extent[2]);
    let y = Axis::new("y / px", extent[3], extent[1]).with_ticks(5);
    let mut panel = plot("where the stem holds it", x, y).equal().with(ground);
    panel.grid = false;
    Ok(curves_on(panel, record.run("curves")?, times))
}

fn whole_grey(level: f64) -> Color {
    #[expect(clippy::cast_possible_truncation, reason = "a grey level is 0 to 255")]
    #[expect(clippy::cast_sign_loss, reason = "a grey level is 0 to 255")]
    let level = level.clamp(0.0, 255.0) as u8;
    Color(level, level, level)
}

/// Curves at several times, from yellow to red.
fn curves_on(panel: Panel, frames: &Run, times: &[f64]) -> Panel {
    times.iter().enumerate().fold(panel, |panel, (index, &t)| {
        let share = real(index) / real(times.len().max(2) - 1);
        let color = Color::YELLOW.mix(Color(0xe0, 0x10, 0x10), share);
        panel.with(line(frames.pairs(frames.nearest(t)), color).weighing(0.8))
    })
}

/// Many frames over one picture from blue to orange, the truth thin.
pub(crate) fn all_over(record: &Record, times: &[f64]) -> Result<Panel> {
    let title = "yellow at the start, red at the end; green: the contour by hand";
    let truth = line(record.xy("truth")?, Color::GREEN)
        .closed()
        .weighing(0.5);
    let panel = over_picture(record, title, false)?.with(truth);
    Ok(curves_on(panel, record.run("curves")?, times))
}

/// How high the top stands, upright as in the picture, and how much of the curve is on the contour.
pub(crate) fn height_and_stuck(record: &Record) -> Result<(Panel, Panel)> {
    let top = [("top y", "", Color::BLUE)];
    let mut height = over_time(record, "fine", &top, "height of the top", "y / px")?;
    (height.y.from, height.y.to) = (height.y.to, height.y.from);
    let part = [("stuck", "", Color::GREEN)];
    let title = "part stuck on the contour";
    let stuck = over_time(record, "fine", &part, title, "of the nodes")?;
    Ok((height, stuck))
}

/// Times as upright lines with letters, to find the frames again.
pub(crate) fn marked(mut panel: Panel, times: &[f64], letters: &str) -> Panel {
    let (low, high) = (panel.y.from, panel.y.to);
    for (&t, letter) in times.iter().zip(letters.chars()) {
        let upright = line([(t, low), (t, high)], Color::LIGHT).weighing(0.5);
        panel.layers.insert(0, upright.into());
        let at = (t, low + 0.965 * (high - low));
        panel.layers.push(text(at, letter, Color::GREY));
    }
    panel
}

/// The snake in motion over its picture.
pub(crate) fn animation(
    record: &Record,
    closed: bool,
    chosen: impl IntoIterator<Item = usize>,
    width: usize,
) -> Result<Animation> {
    let frames = record.run("curves")?;
    let truth = truth_of(record)?;
    let picture = record.grid("picture")?;
    let (wide, high) = size(picture);
    let scale = wide / real(picture.ncols());
    // the animation's ground has its pixel centers at whole numbers, so it is shown in its own pixels
    let place = |p: (f64, f64)| ((p.0 + 0.5) / scale - 0.5, (p.1 + 0.5) / scale - 0.5);
    let shot = |frame: usize| {
        let curve: Vec<(f64, f64)> = frames.pairs(frame).into_iter().map(place).collect();
        let parts = parts(&curve, &truth.stuck(frames.nodes(frame)), closed);
        let width = 2.6;
        let stroke = |(points, color)| Stroke {
            points,
            color,
            width,
        };
        let strokes = parts.map(stroke).to_vec();
        Shot { strokes, hold: 7 }
    };
    let mut shots: Vec<Shot> = chosen.into_iter().map(shot).collect();
    let end = shots.len() - 1;
    (shots[0].hold, shots[end].hold) = (120, 120);
    Ok(Animation {
        view: [-0.5, -0.5, wide / scale - 0.5, high / scale - 0.5],
        width,
        ground: Some(picture.clone()),
        shots,
    })
}

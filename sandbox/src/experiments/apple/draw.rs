//! Curves over a picture: panels, strips of frames, animations.

use super::story::{Truth, truth_of};
use crate::draw::{Animation, Axis, Color, Layer, Line, Panel, Picture, Shot, Stroke};
use crate::experiments::motion::{Frames, pair};
use crate::experiments::over_time::over_time;
use crate::{Record, SandboxError, real};
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
pub(crate) fn over_picture(
    record: &Record,
    title: &str,
    bare: bool,
) -> Result<Panel, SandboxError> {
    let picture = record.grid("picture")?;
    let (width, height) = size(picture);
    let axes = if bare { ("", "") } else { ("x / px", "y / px") };
    let mut panel = Panel::new(
        title,
        Axis::new(axes.0, -0.5, width - 0.5),
        Axis::new(axes.1, height - 0.5, -0.5),
    )
    .equal();
    panel.grid = false;
    if bare {
        panel = panel.bare();
    }
    let mut ground = Picture::new(picture.mapv(grey)).over([-0.5, -0.5, width - 0.5, height - 0.5]);
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
    frames: &Frames,
    frame: usize,
    truth: &Truth,
    closed: bool,
    weight: f64,
) -> Panel {
    let curve = frames.curve(frame);
    let stuck = truth.stuck(&frames.nodes(frame));
    [(false, LOOSE), (true, HELD)]
        .into_iter()
        .fold(panel, |panel, (wanted, color)| {
            panel.with(Line::new(part(&curve, &stuck, wanted, closed), color).weighing(weight))
        })
}

/// One frame as the report shows them: the picture and the snake, nothing else.
pub(crate) fn frame_panel(
    record: &Record,
    letter: &str,
    t: f64,
    closed: bool,
) -> Result<Panel, SandboxError> {
    let frames = Frames::of(record, "curves")?;
    let frame = frames.nearest(t);
    let title = format!("{letter})  t = {:.0}", frames.t(frame));
    let panel = over_picture(record, &title, true)?;
    Ok(snake_on(
        panel,
        &frames,
        frame,
        &truth_of(record)?,
        closed,
        1.3,
    ))
}

/// Many frames over a part of the picture: left, top, right, bottom in its own pixels.
pub(crate) fn window(
    record: &Record,
    times: &[f64],
    part: [usize; 4],
) -> Result<Panel, SandboxError> {
    let picture = record.grid("picture")?;
    let scale = size(picture).0 / real(picture.ncols());
    let [left, top, right, bottom] = part.map(real);
    let rows = (part[3] - part[1]) / if scale > 1.5 { 2 } else { 1 };
    let columns = (part[2] - part[0]) / if scale > 1.5 { 2 } else { 1 };
    let (first_row, first_column) = (
        part[1] * rows / (part[3] - part[1]),
        part[0] * columns / (part[2] - part[0]),
    );
    let pixels = Array2::from_shape_fn((rows, columns), |(row, column)| {
        grey(picture[[first_row + row, first_column + column]])
    });
    let extent = [left - 0.5, top - 0.5, right - 0.5, bottom - 0.5];
    let mut ground = Picture::new(pixels).over(extent);
    ground.smooth = true;
    let mut panel = Panel::new(
        "where the stem holds it",
        Axis::new("x / px", extent[0], extent[2]),
        Axis::new("y / px", extent[3], extent[1]).with_ticks(5),
    )
    .equal()
    .with(ground);
    panel.grid = false;
    let frames = Frames::of(record, "curves")?;
    Ok(curves_on(panel, &frames, times, false))
}

fn grey(level: f64) -> Color {
    #[expect(clippy::cast_possible_truncation, reason = "a grey level is 0 to 255")]
    #[expect(clippy::cast_sign_loss, reason = "a grey level is 0 to 255")]
    let level = level.clamp(0.0, 255.0) as u8;
    Color(level, level, level)
}

/// Curves at several times, from yellow to red.
fn curves_on(panel: Panel, frames: &Frames, times: &[f64], closed: bool) -> Panel {
    times.iter().enumerate().fold(panel, |panel, (index, &t)| {
        let share = real(index) / real(times.len().max(2) - 1);
        let color = Color::YELLOW.mix(Color(0xe0, 0x10, 0x10), share);
        let line = Line::new(frames.curve(frames.nearest(t)), color).weighing(0.8);
        panel.with(if closed { line.closed() } else { line })
    })
}

/// Many frames over one picture from blue to orange, the truth thin.
pub(crate) fn all_over(
    record: &Record,
    times: &[f64],
    closed: bool,
) -> Result<Panel, SandboxError> {
    let frames = Frames::of(record, "curves")?;
    let mut panel = over_picture(
        record,
        "yellow at the start, red at the end; green: the contour by hand",
        false,
    )?;
    let truth: Vec<(f64, f64)> = truth_of(record)?.contour.iter().map(|&p| pair(p)).collect();
    panel = panel.with(Line::new(truth, Color::GREEN).closed().weighing(0.5));
    Ok(curves_on(panel, &frames, times, closed))
}

/// How high the top stands, upright as in the picture, and how much of the curve is on the contour.
pub(crate) fn height_and_stuck(record: &Record) -> Result<(Panel, Panel), SandboxError> {
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
        panel.layers.insert(
            0,
            Line::new(vec![(t, low), (t, high)], Color::LIGHT)
                .weighing(0.5)
                .into(),
        );
        panel.layers.push(Layer::Text {
            at: (t, low + 0.965 * (high - low)),
            words: letter.to_string(),
            color: Color::GREY,
            centered: true,
        });
    }
    panel
}

/// The snake in motion over its picture.
pub(crate) fn animation(
    record: &Record,
    closed: bool,
    chosen: &[usize],
    width: usize,
) -> Result<Animation, SandboxError> {
    let frames = Frames::of(record, "curves")?;
    let truth = truth_of(record)?;
    let picture = record.grid("picture")?;
    let (wide, high) = size(picture);
    let scale = wide / real(picture.ncols());
    // the animation's ground has its pixel centers at whole numbers, so it is shown in its own pixels
    let place = |p: &(f64, f64)| ((p.0 + 0.5) / scale - 0.5, (p.1 + 0.5) / scale - 0.5);
    let last = chosen.len().saturating_sub(1);
    let shots = chosen
        .iter()
        .enumerate()
        .map(|(index, &frame)| {
            let curve: Vec<(f64, f64)> = frames.curve(frame).iter().map(place).collect();
            let stuck = truth.stuck(&frames.nodes(frame));
            let strokes = [(false, LOOSE), (true, HELD)]
                .into_iter()
                .map(|(wanted, color)| Stroke {
                    points: part(&curve, &stuck, wanted, closed),
                    color,
                    width: 2.6,
                })
                .collect();
            let hold = if index == 0 || index == last { 120 } else { 7 };
            Shot { strokes, hold }
        })
        .collect();
    Ok(Animation {
        view: [-0.5, -0.5, wide / scale - 0.5, high / scale - 0.5],
        width,
        ground: Some(picture.clone()),
        shots,
    })
}

//! One panel on a rectangle of the page: plotters draws axes and numbers, the layers follow in
//! page units, cut at the frame.

use super::figure::{DrawError, LINE, Page, UNITS};
use super::frame::{Frame, cut, dashes, log_ticks, numbers};
use super::legend;
use super::palette::Color;
use super::panel::{Axis, Dash, Layer, Panel, Scale};
use plotters::prelude::{
    ChartBuilder, Circle, DrawingArea, IntoFont, PathElement, Polygon, RGBColor, SVGBackend,
    TextStyle,
};
use plotters::style::Color as _;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Draws a panel; pictures are kept for the page, which puts them below everything.
pub(crate) fn draw(area: &Area<'_>, panel: &Panel, page: &mut Page) -> Result<(), DrawError> {
    let sides = Sides::of(area, panel, 0.0);
    let entries = legend::entries(panel);
    let size = legend::size(&entries);
    let (sides, place) = match legend::free_place(panel, &sides.frame(area, panel), size) {
        Some(place) => (sides, place),
        // nowhere inside without lying on something: beside the frame
        None => {
            let sides = Sides::of(area, panel, size.0 / UNITS + 4.0);
            let frame = sides.frame(area, panel);
            (sides, (frame.right + 8.0 * UNITS, frame.top))
        }
    };
    let frame = axes(area, panel, &sides)?;
    for layer in &panel.layers {
        draw_layer(area, panel, &frame, layer, page)?;
    }
    legend::draw(area, &frame, &entries, place)
}

/// What lies around the frame of a panel, in page pixels.
struct Sides {
    left: f64,
    beside: f64,
    right: f64,
    above: f64,
    below: f64,
    spare: (f64, f64),
}

impl Sides {
    /// Room for numbers, words and heading, and `extra` at the right.
    fn of(area: &Area<'_>, panel: &Panel, extra: f64) -> Self {
        let (width, height) = area.dim_in_pixel();
        let (width, height) = (f64::from(width) / UNITS, f64::from(height) / UNITS);
        let below = label_room(&panel.x, 14.0, 15.0);
        let beside = label_room(&panel.y, 38.0, 16.0);
        let above = if panel.title.is_empty() { 6.0 } else { 22.0 };
        let right = extra + if panel.x.ticks == 0 { 4.0 } else { 14.0 };
        let left = if panel.y.label.is_empty() { 4.0 } else { 9.0 };
        let mut spare = (0.0, 0.0);
        if panel.equal {
            let (free_x, free_y) = (width - left - beside - right, height - below - above);
            let (x0, x1) = (panel.x.place(panel.x.from), panel.x.place(panel.x.to));
            let (y0, y1) = (panel.y.place(panel.y.from), panel.y.place(panel.y.to));
            let unit = (free_x / (x1 - x0).abs()).min(free_y / (y1 - y0).abs());
            spare = (
                (free_x - unit * (x1 - x0).abs()) / 2.0,
                (free_y - unit * (y1 - y0).abs()) / 2.0,
            );
        }
        Self {
            left,
            beside,
            right,
            above,
            below,
            spare,
        }
    }

    /// Where the frame will be.
    fn frame(&self, area: &Area<'_>, panel: &Panel) -> Frame {
        let (x, y) = area.get_base_pixel();
        let (width, height) = area.dim_in_pixel();
        let (x, y) = (f64::from(x), f64::from(y));
        Frame {
            left: x + UNITS * (self.left + self.spare.0 + self.beside),
            right: x + f64::from(width) - UNITS * (self.right + self.spare.0),
            top: y + UNITS * (self.above + self.spare.1),
            bottom: y + f64::from(height) - UNITS * (self.spare.1 + self.below),
            x: (panel.x.place(panel.x.from), panel.x.place(panel.x.to)),
            y: (panel.y.place(panel.y.from), panel.y.place(panel.y.to)),
        }
    }
}

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

pub(crate) fn text_style(size: f64, color: Color) -> TextStyle<'static> {
    // the backend divides by 1.24, and knows no unit but its own
    ("sans-serif", size * 1.24 * UNITS)
        .into_font()
        .color(&rgb(color))
}

pub(super) fn rgb(color: Color) -> RGBColor {
    RGBColor(color.0, color.1, color.2)
}

/// A page length in whole units.
pub(crate) fn units(length: f64) -> i32 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a page is a few thousand units wide"
    )]
    let whole = (length * UNITS).round() as i32;
    whole
}

fn whole(at: (f64, f64)) -> (i32, i32) {
    #[expect(clippy::cast_possible_truncation, reason = "cut at the frame before")]
    let point = (at.0.round() as i32, at.1.round() as i32);
    point
}

fn axes(area: &Area<'_>, panel: &Panel, sides: &Sides) -> Result<Frame, DrawError> {
    let (x0, x1) = (panel.x.place(panel.x.from), panel.x.place(panel.x.to));
    let (y0, y1) = (panel.y.place(panel.y.from), panel.y.place(panel.y.to));
    let mut builder = ChartBuilder::on(area);
    builder
        .margin_top(units(sides.above + sides.spare.1))
        .margin_right(units(sides.right + sides.spare.0))
        .margin_left(units(sides.left + sides.spare.0))
        .margin_bottom(units(sides.spare.1))
        .x_label_area_size(units(sides.below))
        .y_label_area_size(units(sides.beside));
    let mut chart = builder.build_cartesian_2d(x0..x1, y0..y1)?;
    let (x_numbers, y_numbers) = (numbers(&panel.x), numbers(&panel.y));
    let mut mesh = chart.configure_mesh();
    mesh.x_labels(labels(&panel.x))
        .y_labels(labels(&panel.y))
        .x_label_formatter(&x_numbers)
        .y_label_formatter(&y_numbers)
        .max_light_lines(0)
        .bold_line_style(rgb(Color::LIGHT).stroke_width(unsigned(LINE * 0.5)))
        .axis_style(rgb(Color::INK).stroke_width(unsigned(LINE * 0.6)))
        .label_style(text_style(10.0, Color::INK))
        .axis_desc_style(text_style(11.0, Color::INK))
        .set_all_tick_mark_size(if panel.x.ticks == 0 { 0 } else { units(3.0) });
    if !panel.grid {
        mesh.disable_mesh();
    }
    if panel.x.ticks == 0 && panel.y.ticks == 0 {
        mesh.disable_axes();
    }
    if !panel.x.label.is_empty() {
        mesh.x_desc(panel.x.label.clone());
    }
    if !panel.y.label.is_empty() {
        mesh.y_desc(panel.y.label.clone());
    }
    mesh.draw()?;

    let (across, down) = chart.plotting_area().get_pixel_range();
    let frame = Frame {
        left: f64::from(across.start),
        right: f64::from(across.end),
        top: f64::from(down.start),
        bottom: f64::from(down.end),
        x: (x0, x1),
        y: (y0, y1),
    };
    decades(area, panel, &frame)?;
    if !panel.title.is_empty() {
        let middle = ((frame.left + frame.right) / 2.0, frame.top - 5.0 * UNITS);
        let style = text_style(11.5, Color::INK).pos(Pos::new(HPos::Center, VPos::Bottom));
        write(area, &panel.title, &style, middle)?;
    }
    Ok(frame)
}

/// How many numbers the drawing library may write; it knows nothing of logarithms.
fn labels(axis: &Axis) -> usize {
    match axis.scale {
        Scale::Linear => axis.ticks.max(1),
        Scale::Log => 0,
    }
}

/// Ticks, numbers and grid lines of logarithmic axes.
fn decades(area: &Area<'_>, panel: &Panel, frame: &Frame) -> Result<(), DrawError> {
    let (thin, tick) = (LINE * 0.5, 3.0 * UNITS);
    let line = |from: (f64, f64), to: (f64, f64), color: Color| -> Result<(), DrawError> {
        let path = vec![local(area, from), local(area, to)];
        let style = rgb(color).stroke_width(unsigned(thin));
        area.draw(&PathElement::new(path, style))?;
        Ok(())
    };
    if panel.x.scale == Scale::Log {
        let style = text_style(10.0, Color::INK).pos(Pos::new(HPos::Center, VPos::Top));
        for (at, words) in log_ticks(&panel.x) {
            let x = frame.place((at, frame.y.0)).0;
            if panel.grid {
                line((x, frame.top), (x, frame.bottom), Color::LIGHT)?;
            }
            line((x, frame.bottom), (x, frame.bottom + tick), Color::INK)?;
            write(area, &words, &style, (x, frame.bottom + 2.0 * tick))?;
        }
    }
    if panel.y.scale == Scale::Log {
        let style = text_style(10.0, Color::INK).pos(Pos::new(HPos::Right, VPos::Center));
        for (at, words) in log_ticks(&panel.y) {
            let y = frame.place((frame.x.0, at)).1;
            if panel.grid {
                line((frame.left, y), (frame.right, y), Color::LIGHT)?;
            }
            line((frame.left - tick, y), (frame.left, y), Color::INK)?;
            write(area, &words, &style, (frame.left - 2.0 * tick, y))?;
        }
    }
    Ok(())
}

pub(super) fn unsigned(length: f64) -> u32 {
    units(length / UNITS).unsigned_abs().max(1)
}

fn label_room(axis: &Axis, numbers: f64, words: f64) -> f64 {
    let numbers = if axis.ticks == 0 { 4.0 } else { numbers + 4.0 };
    numbers + if axis.label.is_empty() { 0.0 } else { words }
}

fn draw_layer(
    area: &Area<'_>,
    panel: &Panel,
    frame: &Frame,
    layer: &Layer,
    page: &mut Page,
) -> Result<(), DrawError> {
    let place = |at: (f64, f64)| frame.place((panel.x.place(at.0), panel.y.place(at.1)));
    match layer {
        Layer::Line(line) => {
            let points: Vec<(f64, f64)> = line.points.iter().map(|&p| place(p)).collect();
            stroke(area, frame, &points, line.color, line.weight, line.dash)
        }
        Layer::Dots {
            points,
            radius,
            color,
            ..
        } => {
            for at in points
                .iter()
                .map(|&p| place(p))
                .filter(|&p| frame.contains(p))
            {
                area.draw(&Circle::new(
                    local(area, at),
                    unsigned(LINE * radius),
                    rgb(*color).filled(),
                ))?;
            }
            Ok(())
        }
        Layer::Arrows { arrows, color } => {
            for &(start, vector) in arrows {
                let (a, b) = (
                    place(start),
                    place((start.0 + vector.0, start.1 + vector.1)),
                );
                arrow(area, frame, a, b, *color)?;
            }
            Ok(())
        }
        Layer::Area {
            points,
            color,
            opacity,
        } => {
            let points: Vec<(i32, i32)> = points
                .iter()
                .map(|&p| place(p))
                .map(|(x, y)| {
                    (
                        x.clamp(frame.left, frame.right),
                        y.clamp(frame.top, frame.bottom),
                    )
                })
                .map(|p| local(area, p))
                .collect();
            area.draw(&Polygon::new(points, rgb(*color).mix(*opacity).filled()))?;
            Ok(())
        }
        Layer::Picture(picture) => {
            let [left, top, right, bottom] = picture.extent;
            let (a, b) = (place((left, top)), place((right, bottom)));
            page.pictures.push((picture.clone(), [a.0, a.1, b.0, b.1]));
            Ok(())
        }
        Layer::Text {
            at,
            words,
            color,
            centered,
        } => {
            let across = if *centered { HPos::Center } else { HPos::Left };
            let style = text_style(10.5, *color).pos(Pos::new(across, VPos::Center));
            write(area, words, &style, place(*at))
        }
    }
}

/// Page units to the area's own.
pub(super) fn local(area: &Area<'_>, at: (f64, f64)) -> (i32, i32) {
    let (x, y) = whole(at);
    let (x0, y0) = area.get_base_pixel();
    (x - x0, y - y0)
}

pub(super) fn write(
    area: &Area<'_>,
    words: &str,
    style: &TextStyle<'_>,
    at: (f64, f64),
) -> Result<(), DrawError> {
    area.draw_text(words, style, local(area, at))?;
    Ok(())
}

fn arrow(
    area: &Area<'_>,
    frame: &Frame,
    a: (f64, f64),
    b: (f64, f64),
    color: Color,
) -> Result<(), DrawError> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length = dx.hypot(dy);
    if !(frame.contains(a) && length > 0.5 * UNITS) {
        return Ok(());
    }
    let b = frame.cut(a, b).map_or(b, |cut| cut.1);
    let head = (0.38 * length).min(8.0 * UNITS);
    let (ux, uy) = (dx / length, dy / length);
    let neck = (b.0 - head * ux, b.1 - head * uy);
    let side = (-uy * head * 0.45, ux * head * 0.45);
    stroke(area, frame, &[a, neck], color, 0.7, Dash::Solid)?;
    let tip = [
        local(area, b),
        local(area, (neck.0 + side.0, neck.1 + side.1)),
        local(area, (neck.0 - side.0, neck.1 - side.1)),
    ];
    area.draw(&Polygon::new(tip.to_vec(), rgb(color).filled()))?;
    Ok(())
}

/// A line in page units, cut at the frame and at points that are not finite, dashed if asked.
pub(super) fn stroke(
    area: &Area<'_>,
    frame: &Frame,
    points: &[(f64, f64)],
    color: Color,
    weight: f64,
    dash: Dash,
) -> Result<(), DrawError> {
    let style = rgb(color).stroke_width(unsigned(LINE * weight));
    for run in cut(frame, points) {
        let pieces = match dash {
            Dash::Solid => vec![run],
            Dash::Dashed => dashes(&run, 5.0 * UNITS, 3.5 * UNITS),
        };
        for piece in pieces {
            let mut path: Vec<(i32, i32)> = piece.iter().map(|&p| local(area, p)).collect();
            path.dedup();
            if path.len() > 1 {
                area.draw(&PathElement::new(path, style))?;
            }
        }
    }
    Ok(())
}

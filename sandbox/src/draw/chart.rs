//! One panel on a rectangle of the page: plotters draws axes and numbers, the layers follow in
//! page units, cut at the frame.

use super::figure::{DrawError, LINE, Page, UNITS};
use super::frame::{Frame, cut, dashes, numbers};
use super::palette::Color;
use super::panel::{Axis, Corner, Dash, Layer, Line, Panel};
use plotters::prelude::{
    ChartBuilder, Circle, DrawingArea, IntoFont, PathElement, Polygon, RGBColor, Rectangle,
    SVGBackend, TextStyle,
};
use plotters::style::Color as _;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Draws a panel; pictures are kept for the page, which puts them below everything.
pub(crate) fn draw(area: &Area<'_>, panel: &Panel, page: &mut Page) -> Result<(), DrawError> {
    let frame = axes(area, panel)?;
    for layer in &panel.layers {
        draw_layer(area, panel, &frame, layer, page)?;
    }
    legend(area, panel, &frame)
}

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

pub(crate) fn text_style(size: f64, color: Color) -> TextStyle<'static> {
    // the backend divides by 1.24, and knows no unit but its own
    ("sans-serif", size * 1.24 * UNITS)
        .into_font()
        .color(&rgb(color))
}

fn rgb(color: Color) -> RGBColor {
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

fn axes(area: &Area<'_>, panel: &Panel) -> Result<Frame, DrawError> {
    let (width, height) = area.dim_in_pixel();
    let (width, height) = (f64::from(width) / UNITS, f64::from(height) / UNITS);
    let below = label_room(&panel.x, 14.0, 15.0);
    let beside = label_room(&panel.y, 38.0, 16.0);
    let above = if panel.title.is_empty() { 6.0 } else { 22.0 };
    let right = if panel.x.ticks == 0 { 4.0 } else { 14.0 };
    let (x0, x1) = (panel.x.place(panel.x.from), panel.x.place(panel.x.to));
    let (y0, y1) = (panel.y.place(panel.y.from), panel.y.place(panel.y.to));
    let left = if panel.y.label.is_empty() { 4.0 } else { 9.0 };
    let (free_x, free_y) = (width - left - beside - right, height - below - above);
    let (mut spare_x, mut spare_y) = (0.0, 0.0);
    if panel.equal {
        let unit = (free_x / (x1 - x0).abs()).min(free_y / (y1 - y0).abs());
        spare_x = (free_x - unit * (x1 - x0).abs()) / 2.0;
        spare_y = (free_y - unit * (y1 - y0).abs()) / 2.0;
    }

    let mut builder = ChartBuilder::on(area);
    builder
        .margin_top(units(above + spare_y))
        .margin_right(units(right + spare_x))
        .margin_left(units(left + spare_x))
        .margin_bottom(units(spare_y))
        .x_label_area_size(units(below))
        .y_label_area_size(units(beside));
    let mut chart = builder.build_cartesian_2d(x0..x1, y0..y1)?;
    let (x_numbers, y_numbers) = (numbers(&panel.x), numbers(&panel.y));
    let mut mesh = chart.configure_mesh();
    mesh.x_labels(panel.x.ticks.max(1))
        .y_labels(panel.y.ticks.max(1))
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
    if !panel.title.is_empty() {
        let middle = ((frame.left + frame.right) / 2.0, frame.top - 5.0 * UNITS);
        let style = text_style(11.5, Color::INK).pos(Pos::new(HPos::Center, VPos::Bottom));
        write(area, &panel.title, &style, middle)?;
    }
    Ok(frame)
}

fn unsigned(length: f64) -> u32 {
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
fn local(area: &Area<'_>, at: (f64, f64)) -> (i32, i32) {
    let (x, y) = whole(at);
    let (x0, y0) = area.get_base_pixel();
    (x - x0, y - y0)
}

fn write(
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
fn stroke(
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

fn legend(area: &Area<'_>, panel: &Panel, frame: &Frame) -> Result<(), DrawError> {
    let entries: Vec<(&str, Color, Option<Line>)> = panel
        .layers
        .iter()
        .filter_map(|layer| match layer {
            Layer::Line(line) if !line.label.is_empty() => {
                Some((line.label.as_str(), line.color, Some(line.clone())))
            }
            Layer::Dots { label, color, .. } if !label.is_empty() => {
                Some((label.as_str(), *color, None))
            }
            _ => None,
        })
        .collect();
    let Some(longest) = entries.iter().map(|entry| entry.0.chars().count()).max() else {
        return Ok(());
    };
    let (row, sample) = (15.0 * UNITS, 20.0 * UNITS);
    let width = sample + 10.0 * UNITS + crate::real(longest) * 5.4 * UNITS;
    let height = row * crate::real(entries.len());
    let gap = 7.0 * UNITS;
    let left = match panel.legend {
        Corner::TopLeft | Corner::BottomLeft => frame.left + gap,
        Corner::TopRight | Corner::BottomRight => frame.right - gap - width,
    };
    let top = match panel.legend {
        Corner::TopLeft | Corner::TopRight => frame.top + gap,
        Corner::BottomLeft | Corner::BottomRight => frame.bottom - gap - height,
    };
    let corners = [(left, top), (left + width, top + height)].map(|p| local(area, p));
    area.draw(&Rectangle::new(
        corners,
        rgb(Color::WHITE).mix(0.85).filled(),
    ))?;
    for (index, (words, color, line)) in entries.into_iter().enumerate() {
        let y = top + row * (crate::real(index) + 0.5);
        let start = left + 3.0 * UNITS;
        match line {
            Some(line) => {
                let points = [(start, y), (start + sample, y)];
                stroke(area, frame, &points, color, line.weight, line.dash)?;
            }
            None => {
                let middle = local(area, (start + sample / 2.0, y));
                area.draw(&Circle::new(
                    middle,
                    unsigned(LINE * 1.8),
                    rgb(color).filled(),
                ))?;
            }
        }
        let style = text_style(10.5, Color::INK).pos(Pos::new(HPos::Left, VPos::Center));
        write(area, words, &style, (start + sample + 5.0 * UNITS, y))?;
    }
    Ok(())
}

//! Error against forces and against time, one color a scheme.

use super::problems::schemes;
use integrator::Scheme;
use sandbox::prelude::*;

/// The color of a scheme, the same on every chart: explicit ones warm, implicit ones cool, exact
/// ones dark.
pub(super) fn color(scheme: Scheme) -> Color {
    match scheme {
        Scheme::Report => Color::RED,
        Scheme::Leapfrog => Color::ORANGE,
        Scheme::Rk4 => Color::YELLOW,
        Scheme::DormandPrince { .. } => Color(0x99, 0x6b, 0x3d),
        Scheme::BackwardEuler => Color(0xb8, 0xbd, 0xc4),
        Scheme::Imex => Color::GREY,
        Scheme::LinearlyImplicit => Color(0x5c, 0x62, 0x6a),
        Scheme::Newmark => Color::SKY,
        Scheme::GeneralizedAlpha { .. } => Color(0x9a, 0xd4, 0xc4),
        Scheme::Sbdf2 => Color::BLUE,
        Scheme::Gauss4 => Color::PURPLE,
        Scheme::Radau5 => Color(0x7a, 0x3b, 0x8f),
        Scheme::Exact => Color::INK,
        Scheme::Etd2 => Color::GREEN,
        _ => Color::LIGHT,
    }
}

/// Decades that hold all points of a column.
fn decades(record: &Record, column: &str) -> Result<(f64, f64)> {
    let mut values = Vec::new();
    for scheme in schemes() {
        values.extend(
            record
                .column(scheme.name(), column)?
                .iter()
                .filter(|value| **value > 0.0),
        );
    }
    if values.is_empty() {
        return Ok((1.0, 10.0));
    }
    let decade = |exponent: f64| 10.0_f64.powf(exponent);
    let low = least(values.iter().copied()).log10().floor();
    Ok((decade(low), decade(most(values).log10().ceil())))
}

pub(super) fn draw(record: &Record) -> Drawn {
    let mut panels = Vec::new();
    for (column, label, title) in [
        ("forces", "forces of the whole curve", "work counted"),
        ("time", "time, start included / µs", "work timed"),
    ] {
        let (from, to) = decades(record, column)?;
        let error = Axis::log("largest distance from the truth / px", 1e-12, 1e1).with_ticks(7);
        let mut panel = plot(title, Axis::log(label, from, to), error);
        for scheme in schemes() {
            let points = record.points(scheme.name(), column, "error")?.into_iter();
            let points: Vec<(f64, f64)> = points.map(|(x, y)| (x, y.max(1e-12))).collect();
            let color = color(scheme);
            panel = panel
                .with(line(points.clone(), color))
                .with(dots(points, 1.6, color));
        }
        panels.push(panel);
    }
    panels.push(legend());
    Artefact::only(
        "Down and left is better. Left: forces asked for. Right: time of a whole run on one thread, start included, on \
         the machine that drew this.",
        Figure::new("Error against work", 1080.0).with(430.0, panels),
    )
}

/// A panel without axes that names the colors.
fn legend() -> Panel {
    let mut panel = plot("", ("", 0.0, 1.0), ("", 0.0, 1.0)).bare();
    panel.share = 0.42;
    for scheme in schemes() {
        let name = match scheme {
            Scheme::DormandPrince { .. } => scheme.name().to_owned(),
            _ => scheme.to_string(),
        };
        panel = panel.with(line([], color(scheme)).weighing(1.6).named(name));
    }
    panel.legend_at(Corner::TopLeft)
}

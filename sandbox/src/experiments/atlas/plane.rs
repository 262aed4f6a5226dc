//! A plane of parameters: predicted ground, measured dots, and their comparison.

use super::regime::{Point, Regime};
use crate::prelude::*;
use integrator::Scheme;
use ndarray::Array2;

/// Dots measured along each axis, and pixels of the ground behind them.
const DOTS: usize = 15;
const GROUND: usize = 180;

/// The two schemes every plane is drawn for.
const SCHEMES: [(Scheme, &str); 2] = [
    (Scheme::Report, "the report's scheme"),
    (Scheme::Leapfrog, "centred damping"),
];

/// A curve over a plane: what it is, its ordinate where it has one, and whose scheme's it is if
/// it is not the equation's own.
pub(crate) type Border = (&'static str, fn(f64) -> f64, Option<Scheme>);

/// What tells one plane from another.
pub(crate) struct Plane {
    pub(crate) title: &'static str,
    pub(crate) x: (&'static str, f64, f64),
    pub(crate) y: (&'static str, f64, f64),
    /// The parameters at a point of the plane.
    pub(crate) at: fn(f64, f64) -> Point,
    /// Borders of the equation of motion itself, whatever the scheme.
    pub(crate) borders: &'static [Border],
    pub(crate) caption: &'static str,
}

/// The color of a regime.
fn color(regime: usize) -> Color {
    match regime {
        0 => Color::BLUE,
        1 => Color::GREEN,
        2 => Color::ORANGE,
        3 => Color::PURPLE,
        _ => Color::RED,
    }
}

/// A value at a share of a logarithmic axis.
fn along((_, from, to): (&str, f64, f64), share: f64) -> f64 {
    from * (to / from).powf(share)
}

impl Plane {
    /// Predict the ground, measure the dots.
    pub(crate) fn run(&self) -> Result {
        let mut record = Record::default();
        let share = |i: usize, of: usize| (real(i) + 0.5) / real(of);
        for (scheme, _) in SCHEMES {
            let name = scheme.name();
            let ground = |(row, column)| {
                let x = along(self.x, share(column, GROUND));
                let y = along(self.y, 1.0 - share(row, GROUND));
                real((self.at)(x, y).predicted(scheme).index())
            };
            record.keep_grid(name, Array2::from_shape_fn((GROUND, GROUND), ground));
            let mut columns: [Vec<f64>; 4] = Default::default();
            let (mut wrong, mut at_border, mut seen) = (0, 0, [0; Regime::ALL.len()]);
            for (i, j) in (0..DOTS).flat_map(|i| (0..DOTS).map(move |j| (i, j))) {
                let (x, y) = (along(self.x, share(i, DOTS)), along(self.y, share(j, DOTS)));
                let point = (self.at)(x, y);
                let (told, found) = (point.predicted(scheme), point.measured(scheme)?);
                let corners = [(0.98, 0.98), (0.98, 1.02), (1.02, 0.98), (1.02, 1.02)];
                let mut near = corners.iter().map(|(dx, dy)| (self.at)(dx * x, dy * y));
                let firm = near.all(|point| point.predicted(scheme) == told);
                at_border += usize::from(!firm);
                wrong += usize::from(firm && told != found);
                seen[found.index()] += 1;
                let row = [x, y, real(told.index()), real(found.index())];
                columns
                    .iter_mut()
                    .zip(row)
                    .for_each(|(column, value)| column.push(value));
            }
            let mut own = record.under(name);
            own.note("dots off their prediction", real(wrong), EXACT);
            own.note("dots within 2 % of a border", real(at_border), EXACT);
            for (regime, count) in Regime::ALL.into_iter().zip(seen) {
                let words = regime.words().replace(',', ";");
                record.note(format!("{name}: {words}"), real(count), EXACT);
            }
            let [x, y, told, found] = columns;
            let table = Table::raw(name).exact(self.x.0, x).exact(self.y.0, y);
            record.keep(table.exact("predicted", told).exact("measured", found));
        }
        Ok(record)
    }

    /// A panel without axes that names colors and lines.
    fn legend(&self) -> Panel {
        let mut panel = plot("", ("", 0.0, 1.0), ("", 0.0, 1.0)).bare();
        panel.share = 0.62;
        for regime in Regime::ALL {
            panel = panel.with(dots([], 1.9, color(regime.index())).named(regime.words()));
        }
        for (index, (what, _, _)) in self.borders.iter().enumerate() {
            panel = panel.with(border(index, []).named(*what));
        }
        panel.legend_at(Corner::TopLeft)
    }

    pub(crate) fn draw(&self, record: &Record) -> Drawn {
        let mut panels = Vec::new();
        for (scheme, words) in SCHEMES {
            let name = scheme.name();
            let pale = record.grid(name)?.map(|&regime| {
                let known = Regime::ALL.iter().position(|r| real(r.index()) >= regime);
                Color::WHITE.mix(color(known.unwrap_or(0)), 0.28)
            });
            let extent = [self.x.1, self.y.2, self.x.2, self.y.1];
            let axis = |(label, from, to): (&str, f64, f64)| Axis::log(label, from, to);
            let ground = Picture::new(pale).over(extent);
            let mut panel = plot(words, axis(self.x), axis(self.y)).with(ground);
            panel.grid = false;
            for (index, (_, at, whose)) in self.borders.iter().enumerate() {
                if whose.is_none_or(|whose| whose == scheme) {
                    let x = (0..=1500).map(|i| along(self.x, real(i) / 1500.0));
                    let points = x.map(|x| (x, at(x))).filter(|p| p.1 > 0.0);
                    panel = panel.with(border(index, points));
                }
            }
            let places = record.points(name, self.x.0, self.y.0)?;
            let found = record.column(name, "measured")?;
            for regime in Regime::ALL {
                let index = real(regime.index());
                let these = places
                    .iter()
                    .zip(found)
                    .filter(|(_, found)| (*found - index).abs() < 0.5);
                panel = panel.with(dots(
                    these.map(|(place, _)| *place),
                    1.9,
                    color(regime.index()),
                ));
            }
            panels.push(panel);
        }
        panels.push(self.legend());
        Artefact::only(
            self.caption,
            Figure::new(self.title, 1120.0).with(440.0, panels),
        )
    }
}

/// The line of a border: the first solid, the second dashed, the others grey.
fn border(index: usize, points: impl IntoIterator<Item = (f64, f64)>) -> Line {
    let color = if index < 2 { Color::INK } else { Color::GREY };
    let line = line(points, color).weighing(0.8);
    if index == 1 { line.dashed() } else { line }
}

/// Dots on a border that may be left out: a twentieth.
pub(crate) const LEFT_OUT: f64 = 0.05 * 225.0;

//! A plane of parameters: predicted ground, measured dots, and their comparison.

use super::regime::{Point, Regime};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel, Picture};
use crate::{Artefact, Body, Finding, Record, SandboxError, Table, Tolerance, real};
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
    pub(crate) fn run(&self) -> Result<Record, SandboxError> {
        let mut record = Record::default();
        let share = |i: usize, of: usize| (real(i) + 0.5) / real(of);
        for (scheme, _) in SCHEMES {
            let name = scheme.name();
            let ground = Array2::from_shape_fn((GROUND, GROUND), |(row, column)| {
                let x = along(self.x, share(column, GROUND));
                let y = along(self.y, 1.0 - share(row, GROUND));
                real((self.at)(x, y).predicted(scheme).index())
            });
            record.keep_grid(name, ground);
            let mut columns = [Vec::new(), Vec::new(), Vec::new(), Vec::new()];
            let (mut wrong, mut at_border, mut seen) = (0, 0, [0; Regime::ALL.len()]);
            for i in 0..DOTS {
                for j in 0..DOTS {
                    let (x, y) = (along(self.x, share(i, DOTS)), along(self.y, share(j, DOTS)));
                    let point = (self.at)(x, y);
                    let (told, found) = (point.predicted(scheme), point.measured(scheme)?);
                    let firm = [0.98, 1.02].iter().all(|dx| {
                        [0.98, 1.02]
                            .iter()
                            .all(|dy| (self.at)(dx * x, dy * y).predicted(scheme) == told)
                    });
                    at_border += usize::from(!firm);
                    wrong += usize::from(firm && told != found);
                    seen[found.index()] += 1;
                    let row = [x, y, real(told.index()), real(found.index())];
                    columns
                        .iter_mut()
                        .zip(row)
                        .for_each(|(column, value)| column.push(value));
                }
            }
            record.note(
                format!("{name}: dots off their prediction"),
                real(wrong),
                "",
                Tolerance::EXACT,
            );
            record.note(
                format!("{name}: dots within 2 % of a border"),
                real(at_border),
                "",
                Tolerance::EXACT,
            );
            for (regime, count) in Regime::ALL.into_iter().zip(seen) {
                let words = regime.words().replace(',', ";");
                record.note(
                    format!("{name}: {words}"),
                    real(count),
                    "",
                    Tolerance::EXACT,
                );
            }
            let [x, y, told, found] = columns;
            record.keep(
                Table::raw(name)
                    .with(self.x.0.replace(',', ";"), "", Tolerance::ROUNDING, x)
                    .with(self.y.0.replace(',', ";"), "", Tolerance::ROUNDING, y)
                    .with("predicted", "", Tolerance::EXACT, told)
                    .with("measured", "", Tolerance::EXACT, found),
            );
        }
        Ok(record)
    }

    /// A panel without axes that names colors and lines.
    fn legend(&self) -> Panel {
        let mut panel = Panel::new("", Axis::new("", 0.0, 1.0), Axis::new("", 0.0, 1.0)).bare();
        panel.share = 0.62;
        for regime in Regime::ALL {
            panel = panel.with(Layer::Dots {
                points: Vec::new(),
                radius: 1.9,
                color: color(regime.index()),
                label: regime.words().to_owned(),
            });
        }
        for (index, (what, _, _)) in self.borders.iter().enumerate() {
            panel = panel.with(stroke(index, Vec::new()).named(*what));
        }
        panel.legend_at(Corner::TopLeft)
    }

    pub(crate) fn draw(&self, record: &Record) -> Result<Vec<Artefact>, SandboxError> {
        let mut panels = Vec::new();
        for (scheme, words) in SCHEMES {
            let name = scheme.name();
            let pale = record.grid(name)?.map(|&regime| {
                let index = Regime::ALL
                    .iter()
                    .position(|r| real(r.index()) >= regime)
                    .unwrap_or(0);
                Color::WHITE.mix(color(index), 0.28)
            });
            let extent = [self.x.1, self.y.2, self.x.2, self.y.1];
            let axis = |(label, from, to): (&str, f64, f64)| Axis::log(label, from, to);
            let mut panel =
                Panel::new(words, axis(self.x), axis(self.y)).with(Picture::new(pale).over(extent));
            panel.grid = false;
            for (index, (_, border, whose)) in self.borders.iter().enumerate() {
                if whose.is_some_and(|whose| whose != scheme) {
                    continue;
                }
                let points = (0..=1500)
                    .map(|i| along(self.x, real(i) / 1500.0))
                    .map(|x| (x, border(x)))
                    .filter(|p| p.1 > 0.0)
                    .collect();
                panel = panel.with(stroke(index, points));
            }
            let columns = [self.x.0, self.y.0, "measured"].map(|name| name.replace(',', ";"));
            let [x, y, found] = &columns;
            let (x, y) = (record.column(name, x)?, record.column(name, y)?);
            let found = record.column(name, found)?;
            for regime in Regime::ALL {
                let points: Vec<(f64, f64)> = (0..x.len())
                    .filter(|&i| (found[i] - real(regime.index())).abs() < 0.5)
                    .map(|i| (x[i], y[i]))
                    .collect();
                panel = panel.with(Layer::Dots {
                    points,
                    radius: 1.9,
                    color: color(regime.index()),
                    label: String::new(),
                });
            }
            panels.push(panel);
        }
        panels.push(self.legend());
        let figure = Figure::new(self.title, 1120.0).with(440.0, panels);
        Ok(vec![Artefact {
            suffix: "",
            caption: self.caption,
            body: Body::Figure(figure),
        }])
    }
}

/// The line of a border: the first solid, the second dashed, the others grey.
fn stroke(index: usize, points: Vec<(f64, f64)>) -> Line {
    let line = Line::new(points, if index < 2 { Color::INK } else { Color::GREY }).weighing(0.8);
    if index == 1 { line.dashed() } else { line }
}

/// Whether every dot that is not on a border lies on its ground.
pub(crate) fn all_as_predicted(record: &Record) -> Result<Finding, SandboxError> {
    let (mut wrong, mut at_border) = (0.0, 0.0);
    for (scheme, _) in SCHEMES {
        let name = scheme.name();
        wrong += record.number(&format!("{name}: dots off their prediction"))?;
        at_border += record.number(&format!("{name}: dots within 2 % of a border"))?;
    }
    let all = real(2 * DOTS * DOTS) - at_border;
    let found = format!("{} of {all}, {at_border} on a border left out", all - wrong);
    // who left most dots out could not be wrong
    Ok(Finding::new(
        wrong < 0.5 && at_border < 0.05 * real(2 * DOTS * DOTS),
        found,
    ))
}

/// How many dots of a regime a scheme has.
pub(crate) fn count(record: &Record, scheme: Scheme, regime: Regime) -> Result<f64, SandboxError> {
    record.number(&format!(
        "{}: {}",
        scheme.name(),
        regime.words().replace(',', ";")
    ))
}

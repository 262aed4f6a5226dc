//! Two edges close together: where the force says they are (D47).

use super::synthetic::{AROUND, OBJECT};
use crate::prelude::*;
use field::{
    EdgeForce, Grid, Polarity, REPORT_PASSES, Region, RegionScratch, SignedEdge, Smoothing,
    TwoRegions, edge_force,
    signal::{force, smooth_binomial},
};

/// Widths of the bars, in pixels.
const WIDTHS: [usize; 9] = [2, 3, 4, 5, 6, 8, 10, 12, 16];
/// Those drawn one by one.
const SHOWN: [(usize, &str); 3] = [(4, "bar-4"), (8, "bar-8"), (16, "bar-16")];
const LENGTH: usize = 100;
const ROWS: usize = 24;
/// The first sample of the bar; its left edge lies half a pixel before.
const FIRST: usize = 42;
/// Fewer passes: σ = 1.
const FEW: u32 = 2;
/// The kinds of force, in the order of the table.
const KINDS: [&str; 5] = [
    "program",
    "corrected",
    "fewer passes",
    "signed edge",
    "two regions",
];

/// Where the force of two close edges vanishes.
pub(crate) const BARS: Experiment = Experiment {
    id: "sec-4-2-bars",
    title: "Two edges close together",
    place: "§4.2.1",
    question: "A bright bar 2 to 16 px wide has two edges. How far from them does each force come to rest, and does \
               knowing the sign of the edge, or looking at regions, help?",
    claims: &[
        claim(
            "the report's force rests 2.4, 1.5, 0.85, 0.34 and 0.014 px outside the edges of bars \
               2, 4, 6, 8 and 12 px wide [D47]",
        )
        .judged(|r| {
            let (mut worst, mut words) = (0.0_f64, Vec::new());
            for (width, expected, within) in [
                (2, 2.4, 0.05),
                (4, 1.5, 0.05),
                (6, 0.85, 0.005),
                (8, 0.34, 0.005),
                (12, 0.014, 0.0005),
            ] {
                let found = outside(r, "program", width)?;
                worst = worst.max((found - expected).abs() / within);
                words.push(format!("{found:.3}"));
            }
            Ok(Finding::new(
                worst <= 1.0,
                format!("{} px", words.join(", ")),
            ))
        }),
        claim("so x tanh(w x/σ²) = w has it, for bars of 4 px and more [theory §10.3]").judged(
            |r| {
                let wide = WIDTHS.into_iter().filter(|&width| width >= 4);
                let apart =
                    |width| Ok(outside(r, "program", width)? - outside(r, "theory", width)?);
                let worst = most(
                    wide.map(apart)
                        .collect::<Result<Vec<f64>>>()?
                        .iter()
                        .map(|v| v.abs()),
                );
                Ok(Finding::new(
                    worst < 0.06,
                    format!("{worst:.3} px apart at most"),
                ))
            },
        ),
        claim(
            "the corrected force does the same: it is the smoothing, not a slip, that pushes edges \
               apart [theory §10.3]",
        )
        .when(&[close("program @ bars", "corrected @ bars", 0.01)]),
        claim("less smoothing helps: two passes are exact from 6 px on [theory §10.3]").judged(
            |r| {
                let narrow = outside(r, "fewer passes", 2)?;
                let wide = outside(r, "fewer passes", 6)?;
                let words = format!("{wide:.4} px at 6 px; still {narrow:.2} px at 2 px");
                Ok(Finding::new(wide.abs() < 0.01 && narrow > 0.1, words))
            },
        ),
        claim(
            "the sign of the edge does not help: the steepest place is where it was [theory §10.3]",
        )
        .when(&[close("signed edge @ bars", "corrected @ bars", 0.15)]),
        claim("but with the sign no node is drawn to the other edge [theory]").when(&[
            above("corrected: zeros that attract; bar of 8 px", 1.5),
            below("signed edge: zeros that attract; bar of 8 px", 1.5),
        ]),
        claim("two regions, which look at no edge, are exact at every width [[chanvese01]]")
            .when(&[near("two regions @ bars", 0.0, 0.01)]),
    ],
    run,
    draw,
};

/// How far outside the true edge a force rests, by the table.
fn outside(record: &Record, kind: &str, width: usize) -> Result<f64> {
    let widths = record.told_column("bars", "width")?;
    let found = widths.iter().zip(record.column("bars", kind)?);
    let mut found = found.filter(|(w, _)| (*w - real(width)).abs() < 0.5);
    Ok(found.next().map_or(f64::NAN, |(_, off)| *off))
}

/// The bar along a row.
fn bar(width: usize) -> Vec<f64> {
    let inside = FIRST..FIRST + width;
    let level = |x| if inside.contains(&x) { OBJECT } else { AROUND };
    (0..LENGTH).map(level).collect()
}

fn left_edge() -> f64 {
    real(FIRST) - 0.5
}

/// Places a pixel at which a force is looked at.
const FINE: usize = 20;

/// Places where a force turns from forwards to backwards; what is weaker than a thousandth of it is nothing.
fn rests(at: &dyn Fn(f64) -> f64) -> Vec<f64> {
    let place = |i: usize| real(i) / real(FINE);
    let values: Vec<f64> = (FINE..(LENGTH - 1) * FINE).map(|i| at(place(i))).collect();
    let least = 1e-3 * most(values.iter().map(|v| v.abs()));
    let mut forwards = None;
    let mut out = Vec::new();
    for (i, &value) in values.iter().enumerate() {
        if value > least {
            forwards = Some(i);
        } else if value < -least
            && let Some(start) = forwards.take()
        {
            // between the last strong pull forwards and the first backwards
            let turn = (start..i).find(|&k| values[k + 1] <= 0.0).unwrap_or(start);
            let (a, b) = (values[turn], values[turn + 1]);
            out.push(place(turn + FINE) + a / (a - b) / real(FINE));
        }
    }
    out
}

fn program(width: usize) -> impl Fn(f64) -> f64 {
    let sampled = force(&smooth_binomial(&bar(width), REPORT_PASSES));
    move |x| {
        let cell = x.floor().clamp(0.0, real(LENGTH - 2));
        let place = (0..LENGTH - 2)
            .find(|&i| real(i) >= cell)
            .unwrap_or(LENGTH - 2);
        sampled[place] + (x - cell) * (sampled[place + 1] - sampled[place])
    }
}

/// A force along the row, by the place.
type Along = Box<dyn Fn(f64) -> f64>;

/// The force of each kind along the row, with the outward normal of the bar's right edge.
fn kinds(width: usize) -> Result<Vec<Along>> {
    let row = bar(width);
    let picture = Grid::from_shape_fn((ROWS, LENGTH), |(_, x)| row[x]);
    let along = |x: f64| DVec2::new(x, real(ROWS / 2));
    let edge = |passes: u32| {
        let smoothing = Smoothing::Binomial(passes);
        edge_force(
            &picture,
            &EdgeForce {
                smoothing,
                gain: 1.0,
            },
        )
    };
    let (corrected, few) = (edge(REPORT_PASSES)?, edge(FEW)?);
    let smoothing = Smoothing::Binomial(REPORT_PASSES);
    let signed = SignedEdge::new(&picture, smoothing, Polarity::BrightToDark, 1.0)?;
    let regions = TwoRegions::new(&picture, 1.0 / (OBJECT - AROUND).powi(2))?;
    let (left, middle) = (left_edge(), left_edge() + 0.5 * real(width));
    Ok(vec![
        Box::new(program(width)),
        Box::new(move |x| corrected.at(along(x)).x),
        Box::new(move |x| few.at(along(x)).x),
        Box::new(move |x| signed.at(along(x), DVec2::X).x),
        // a box from the bar's middle to x has half of it at least; the left side stands on the left edge
        Box::new(move |x| {
            if x <= middle {
                return 0.0;
            }
            let (top, bottom, node) = (-0.5, real(ROWS) - 0.5, along(x));
            let corners = [
                (left, top),
                (x, top),
                node.into(),
                (x, bottom),
                (left, bottom),
            ];
            let mut push = [0.0; 5];
            let polygon = corners.map(DVec2::from);
            regions.push_into(&polygon, &mut RegionScratch::default(), &mut push);
            push[2]
        }),
    ])
}

/// The x > w that solves x tanh(w x/σ²) = w, by halving.
fn theory(half: f64, sigma_squared: f64) -> f64 {
    let (mut low, mut high) = (half, half + 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if middle * (half * middle / sigma_squared).tanh() < half {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

fn run() -> Result {
    let mut record = Record::default();
    let mut columns: [Vec<f64>; 5] = Default::default();
    for width in WIDTHS {
        let right = left_edge() + real(width);
        let forces = kinds(width)?;
        for ((name, at), column) in KINDS.into_iter().zip(&forces).zip(&mut columns) {
            let found = rests(at.as_ref());
            column.push(found.last().copied().unwrap_or(f64::NAN) - right);
            if width == 8 {
                let zeros = format!("{name}: zeros that attract; bar of 8 px");
                record.note(zeros, real(found.len()), EXACT);
            }
        }
        if let Some((_, table)) = SHOWN.iter().find(|shown| shown.0 == width) {
            let middle = left_edge() + 0.5 * real(width);
            let x: Vec<f64> = (0..=400).map(|i| 0.1 * real(i) - 20.0).collect();
            let mut table = Table::raw(table).exact("x [px]", x.clone());
            for (name, at) in KINDS.into_iter().zip(&forces) {
                let values: Vec<f64> = x.iter().map(|&x| at(middle + x)).collect();
                let largest = most(values.iter().map(|v| v.abs()));
                let share = values.iter().map(|v| v / largest);
                table = table.exact(format!("{name} [of the largest]"), share);
            }
            record.keep(table);
        }
    }
    let widths = WIDTHS.map(real);
    // the passes, and the two derivatives that average over two pixels each
    let square = f64::from(REPORT_PASSES) / 2.0 + 2.0 / 3.0;
    let ideal = widths.map(|width| theory(0.5 * width, square) - 0.5 * width);
    let mut table = Table::new("bars").exact("width [px]", widths);
    for (name, column) in KINDS.into_iter().zip(columns) {
        table = table.with(format!("{name} [px]"), 1e-6, column);
    }
    record.keep(table.with("theory [px]", 1e-6, ideal));
    Ok(record)
}

/// Colors and words of the kinds.
const DRAWN: [(Color, &str); 5] = [
    (Color::RED, "the program, 20 passes"),
    (Color::BLUE, "corrected, 20 passes"),
    (Color::SKY, "corrected, 2 passes"),
    (Color::PURPLE, "signed edge, 20 passes"),
    (Color::GREEN, "two regions"),
];

fn draw(record: &Record) -> Drawn {
    let width = Axis::new("width of the bar / px", 0.0, 17.0).with_ticks(9);
    let place = Axis::new("outside the true edge / px", -0.25, 2.75).with_ticks(7);
    let theory = line(record.points("bars", "width", "theory")?, Color::GREY).dashed();
    let mut off = plot(
        "where the force of the right edge comes to rest",
        width,
        place,
    )
    .with(theory.named("theory: x tanh(w x/σ²) = w"));
    for (i, (name, (color, words))) in KINDS.into_iter().zip(DRAWN).enumerate() {
        let points = record.points("bars", "width", name)?;
        let radius = if name == "program" { 3.2 } else { 1.8 };
        off = off.with(dots(points.clone(), radius, color).named(words));
        if i >= 2 {
            off = off.with(line(points, color).weighing(0.7));
        }
    }
    let mut panels = Vec::new();
    for (width, table) in SHOWN {
        let half = 0.5 * real(width);
        let bar = [(-half, -1.1), (half, -1.1), (half, 1.1), (-half, 1.1)];
        let words = if width == 4 {
            "share of its largest"
        } else {
            ""
        };
        let place = Axis::new("from the bar's middle / px", -14.0, 14.0).with_ticks(8);
        let force = Axis::new(words, -1.1, 1.1).with_ticks(5);
        let mut panel = plot(format!("force along a bar of {width} px"), place, force)
            .with(area(bar, Color::YELLOW, 0.35))
            .with(line([(-14.0, 0.0), (14.0, 0.0)], Color::GREY).weighing(0.6));
        for (name, (color, _)) in KINDS.into_iter().zip(DRAWN).skip(1) {
            if name != "fewer passes" {
                panel = panel.with(line(record.points(table, "x", name)?, color));
            }
        }
        panels.push(panel);
    }
    Artefact::only(
        "Above: how far outside the right edge of a bar each force vanishes. Below: the forces along three bars \
         (yellow), colors as above; the signed edge and the regions are those a node on the right side feels.",
        Figure::new("§4.2.1  Two edges repel each other (D47)", 860.0)
            .with(330.0, vec![off])
            .with(250.0, panels),
    )
}

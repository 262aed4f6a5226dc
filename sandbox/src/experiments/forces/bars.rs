//! Two edges close together: where the force says they are (D47).

use super::synthetic::{AROUND, OBJECT};
use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use field::{
    EdgeForce, Grid, Polarity, REPORT_PASSES, Region, RegionScratch, SignedEdge, Smoothing,
    TwoRegions, edge_force,
    signal::{force, smooth_binomial},
};
use glam::DVec2;

const ID: &str = "sec-4-2-bars";
/// Widths of the bars, in pixels.
const WIDTHS: [usize; 9] = [2, 3, 4, 5, 6, 8, 10, 12, 16];
/// Those drawn one by one.
const SHOWN: [usize; 3] = [4, 8, 16];
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
    id: ID,
    title: "Two edges close together",
    place: "§4.2.1",
    question: "A bright bar 2 to 16 px wide has two edges. How far from them does each force come to rest, and does \
               knowing the sign of the edge, or looking at regions, help?",
    claims: &[
        Claim {
            says: "the report's force rests 2.4, 1.5, 0.85, 0.34 and 0.014 px outside the edges of bars 2, 4, 6, 8 and 12 px wide",
            source: "D47",
            judge: |r| {
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
            },
        },
        Claim {
            says: "so x tanh(w x/σ²) = w has it, for bars of 4 px and more",
            source: "theory §10.3",
            judge: |r| {
                let mut worst = 0.0_f64;
                for width in WIDTHS.into_iter().filter(|&width| width >= 4) {
                    let apart = outside(r, "program", width)? - outside(r, "theory", width)?;
                    worst = worst.max(apart.abs());
                }
                Ok(Finding::new(
                    worst < 0.06,
                    format!("{worst:.3} px apart at most"),
                ))
            },
        },
        Claim {
            says: "the corrected force does the same: it is the smoothing, not a slip, that pushes edges apart",
            source: "theory §10.3",
            judge: |r| {
                let mut worst = 0.0_f64;
                for width in WIDTHS {
                    let apart = outside(r, "program", width)? - outside(r, "corrected", width)?;
                    worst = worst.max(apart.abs());
                }
                Ok(Finding::new(
                    worst < 0.01,
                    format!("{worst:.4} px apart at most"),
                ))
            },
        },
        Claim {
            says: "less smoothing helps: two passes are exact from 6 px on",
            source: "theory §10.3",
            judge: |r| {
                let (narrow, wide) = (
                    outside(r, "fewer passes", 2)?,
                    outside(r, "fewer passes", 6)?,
                );
                Ok(Finding::new(
                    wide.abs() < 0.01 && narrow > 0.1,
                    format!("{wide:.4} px at 6 px; still {narrow:.2} px at 2 px"),
                ))
            },
        },
        Claim {
            says: "the sign of the edge does not help: the steepest place is where it was",
            source: "theory §10.3",
            judge: |r| {
                let mut worst = 0.0_f64;
                for width in WIDTHS {
                    let apart = outside(r, "signed edge", width)? - outside(r, "corrected", width)?;
                    worst = worst.max(apart.abs());
                }
                Ok(Finding::new(
                    worst < 0.15,
                    format!("{worst:.3} px apart at most"),
                ))
            },
        },
        Claim {
            says: "but with the sign no node is drawn to the other edge",
            source: "theory",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("corrected: zeros that attract; bar of 8 px", 1.5),
                        below("signed edge: zeros that attract; bar of 8 px", 1.5),
                    ],
                )
            },
        },
        Claim {
            says: "two regions, which look at no edge, are exact at every width",
            source: "[chanvese01]",
            judge: |r| {
                let mut worst = 0.0_f64;
                for width in WIDTHS {
                    worst = worst.max(outside(r, "two regions", width)?.abs());
                }
                Ok(Finding::new(
                    worst < 0.01,
                    format!("{worst:.4} px off at most"),
                ))
            },
        },
    ],
    run,
    draw,
};

/// How far outside the true edge a force rests, by the table.
fn outside(record: &Record, kind: &str, width: usize) -> Result<f64, SandboxError> {
    let widths = record.told_column("bars", "width")?;
    let found = widths.iter().zip(record.column("bars", kind)?);
    let mut found = found.filter(|(w, _)| (*w - real(width)).abs() < 0.5);
    Ok(found.next().map_or(f64::NAN, |(_, off)| *off))
}

/// The bar along a row.
fn bar(width: usize) -> Vec<f64> {
    (0..LENGTH)
        .map(|x| {
            if (FIRST..FIRST + width).contains(&x) {
                OBJECT
            } else {
                AROUND
            }
        })
        .collect()
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
    let least = 1e-3 * values.iter().map(|v| v.abs()).fold(0.0, f64::max);
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
        let place = (0..LENGTH)
            .find(|&i| real(i) >= cell)
            .unwrap_or(0)
            .min(LENGTH - 2);
        sampled[place] + (x - cell) * (sampled[place + 1] - sampled[place])
    }
}

/// A force along the row, by the place.
type Along = Box<dyn Fn(f64) -> f64>;

/// The force of each kind along the row, with the outward normal of the bar's right edge.
fn kinds(width: usize) -> Result<Vec<Along>, SandboxError> {
    let row = bar(width);
    let picture = Grid::from_shape_fn((ROWS, LENGTH), |(_, x)| row[x]);
    let along = |x: f64| DVec2::new(x, real(ROWS / 2));
    let edge = |passes: u32| {
        let rule = EdgeForce {
            smoothing: Smoothing::Binomial(passes),
            gain: 1.0,
        };
        edge_force(&picture, &rule).map_err(SandboxError::refused(ID))
    };
    let (corrected, few) = (edge(REPORT_PASSES)?, edge(FEW)?);
    let signed = SignedEdge::new(
        &picture,
        Smoothing::Binomial(REPORT_PASSES),
        Polarity::BrightToDark,
        1.0,
    )
    .map_err(SandboxError::refused(ID))?;
    let regions = TwoRegions::new(&picture, 1.0 / (OBJECT - AROUND).powi(2))
        .map_err(SandboxError::refused(ID))?;
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
            let (top, bottom) = (-0.5, real(ROWS) - 0.5);
            let node = along(x);
            let polygon = [
                DVec2::new(left, top),
                DVec2::new(x, top),
                node,
                DVec2::new(x, bottom),
                DVec2::new(left, bottom),
            ];
            let mut push = [0.0; 5];
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

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); KINDS.len()];
    for width in WIDTHS {
        let right = left_edge() + real(width);
        let forces = kinds(width)?;
        for ((name, at), column) in KINDS.into_iter().zip(&forces).zip(&mut columns) {
            let found = rests(at.as_ref());
            let last = found.last().copied().unwrap_or(f64::NAN);
            column.push(last - right);
            if width == 8 {
                record.note(
                    format!("{name}: zeros that attract; bar of 8 px"),
                    real(found.len()),
                    "",
                    Tolerance::EXACT,
                );
            }
        }
        if SHOWN.contains(&width) {
            let middle = left_edge() + 0.5 * real(width);
            let x: Vec<f64> = (0..=400).map(|i| 0.1 * real(i) - 20.0).collect();
            let mut table = Table::raw(match width {
                4 => "bar-4",
                8 => "bar-8",
                _ => "bar-16",
            })
            .with("x", "px", Tolerance::EXACT, x.clone());
            for (name, at) in KINDS.into_iter().zip(&forces) {
                let values: Vec<f64> = x.iter().map(|&x| at(middle + x)).collect();
                let most = values.iter().map(|v| v.abs()).fold(0.0, f64::max);
                let share = values.iter().map(|v| v / most).collect();
                table = table.with(name, "of the largest", Tolerance::ROUNDING, share);
            }
            record.keep(table);
        }
    }
    let widths: Vec<f64> = WIDTHS.into_iter().map(real).collect();
    // the passes, and the two derivatives that average over two pixels each
    let sigma_squared = f64::from(REPORT_PASSES) / 2.0 + 2.0 / 3.0;
    let ideal = widths
        .iter()
        .map(|width| theory(0.5 * width, sigma_squared) - 0.5 * width)
        .collect();
    let place = Tolerance::Absolute(1e-6);
    let mut table = Table::new("bars").with("width", "px", Tolerance::EXACT, widths);
    for (name, column) in KINDS.into_iter().zip(columns) {
        table = table.with(name, "px", place, column);
    }
    record.keep(table.with("theory", "px", place, ideal));
    Ok(record)
}

const COLORS: [Color; 5] = [
    Color::RED,
    Color::BLUE,
    Color::SKY,
    Color::PURPLE,
    Color::GREEN,
];
const WORDS: [&str; 5] = [
    "the program, 20 passes",
    "corrected, 20 passes",
    "corrected, 2 passes",
    "signed edge, 20 passes",
    "two regions",
];

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut off = Panel::new(
        "where the force of the right edge comes to rest",
        Axis::new("width of the bar / px", 0.0, 17.0).with_ticks(9),
        Axis::new("outside the true edge / px", -0.25, 2.75).with_ticks(7),
    )
    .with(
        Line::new(record.points("bars", "width", "theory")?, Color::GREY)
            .dashed()
            .named("theory: x tanh(w x/σ²) = w"),
    );
    for (i, name) in KINDS.into_iter().enumerate() {
        let points = record.points("bars", "width", name)?;
        let radius = if name == "program" { 3.2 } else { 1.8 };
        off = off.with(Layer::Dots {
            points: points.clone(),
            radius,
            color: COLORS[i],
            label: WORDS[i].to_owned(),
        });
        if i >= 2 {
            off = off.with(Line::new(points, COLORS[i]).weighing(0.7));
        }
    }
    let mut panels = Vec::new();
    for width in SHOWN {
        let table = match width {
            4 => "bar-4",
            8 => "bar-8",
            _ => "bar-16",
        };
        let half = 0.5 * real(width);
        let mut panel = Panel::new(
            format!("force along a bar of {width} px"),
            Axis::new("from the bar's middle / px", -14.0, 14.0).with_ticks(8),
            Axis::new(
                if width == 4 {
                    "share of its largest"
                } else {
                    ""
                },
                -1.1,
                1.1,
            )
            .with_ticks(5),
        )
        .with(Layer::Area {
            points: vec![(-half, -1.1), (half, -1.1), (half, 1.1), (-half, 1.1)],
            color: Color::YELLOW,
            opacity: 0.35,
        })
        .with(Line::new(vec![(-14.0, 0.0), (14.0, 0.0)], Color::GREY).weighing(0.6));
        for (i, name) in KINDS.into_iter().enumerate().skip(1) {
            if name == "fewer passes" {
                continue;
            }
            panel = panel.with(Line::new(record.points(table, "x", name)?, COLORS[i]));
        }
        panels.push(panel);
    }
    let figure = Figure::new("§4.2.1  Two edges repel each other (D47)", 860.0)
        .with(330.0, vec![off])
        .with(250.0, panels);
    Ok(vec![Artefact::figure(
        "Above: how far outside the right edge of a bar each force vanishes. Below: the forces along three bars \
         (yellow), colors as above; the signed edge and the regions are those a node on the right side feels.",
        figure,
    )])
}

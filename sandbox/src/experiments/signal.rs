//! Figures 4.2 to 4.4: from a smoothed signal to a force, in one dimension (report §4.2.1).

use crate::demand::{below, judged, near};
use crate::draw::{Axis, Color, Figure, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use field::REPORT_PASSES;
use field::signal;

/// The report counts samples from 1.
pub(super) fn places(count: usize) -> Vec<f64> {
    (1..=count).map(real).collect()
}

pub(super) fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

/// Where a line through the samples crosses a level, from left to right.
fn crossings(x: &[f64], values: &[f64], level: f64) -> Vec<f64> {
    let mut out = Vec::new();
    for i in 1..values.len() {
        let (a, b) = (values[i - 1] - level, values[i] - level);
        if (a < 0.0) != (b < 0.0) {
            out.push(x[i - 1] + (x[i] - x[i - 1]) * a / (a - b));
        }
    }
    out
}

/// The crossing nearest to a place.
pub(super) fn crossing_near(x: &[f64], values: &[f64], level: f64, place: f64) -> f64 {
    crossings(x, values, level)
        .into_iter()
        .min_by(|a, b| (a - place).abs().total_cmp(&(b - place).abs()))
        .unwrap_or(f64::NAN)
}

/// One of the stacked panels the report draws.
fn strip(
    record: &Record,
    title: &str,
    column: &str,
    color: Color,
    last: bool,
) -> Result<Panel, SandboxError> {
    let points = record.points("signal", "x", column)?;
    let largest = points.iter().map(|p| p.1).fold(0.0, f64::max);
    let least = points.iter().map(|p| p.1).fold(0.0, f64::min);
    let spare = 0.12 * (largest - least);
    let label = if last { "x / samples" } else { "" };
    let panel = Panel::new(
        title,
        Axis::new(label, 1.0, 100.0).with_ticks(11),
        Axis::new("", least - spare, largest + spare).with_ticks(4),
    );
    Ok(panel.with(Line::new(points, color)))
}

/// A vertical line at an edge.
fn edge(panel: Panel, at: f64) -> Panel {
    let (low, high) = (panel.y.from, panel.y.to);
    panel.with(
        Line::new(vec![(at, low), (at, high)], Color::GREY)
            .dashed()
            .weighing(0.6),
    )
}

fn marked(panel: Panel, edges: &[f64]) -> Panel {
    edges.iter().fold(panel, |panel, &at| edge(panel, at))
}

// ---- Figure 4.2

/// Figure 4.2: the second derivative of the smoothed step.
pub(crate) const STEP: Experiment = Experiment {
    id: "fig-4-2",
    title: "The second derivative of the smoothed step",
    place: "Figure 4.2",
    question: "Is the second derivative of a smoothed rising step a force that pulls to the edge from both sides \
               and leaves everything else alone?",
    claims: &[
        Claim {
            says: "positive below the edge, negative above it",
            source: "report §4.2.1",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("samples with the wrong sign", 0.5),
                        near("zero of the second derivative", 50.5, 1e-9),
                    ],
                )
            },
        },
        Claim {
            says: "the step lies between samples 50 and 51, not at 50",
            source: "D46",
            judge: |r| judged(r, &[near("zero of the second derivative", 50.5, 1e-9)]),
        },
        Claim {
            says: "zero elsewhere, though the program has no δ",
            source: "report §4.2.1, D45",
            judge: |r| {
                let far = r.number("largest beyond 21.5 samples")?;
                let reach = r.number("reach to a hundredth of the peak")?;
                Ok(Finding::new(
                    far.abs() < f64::MIN_POSITIVE && reach < 13.0,
                    format!("exactly 0 beyond 21.5 samples, a hundredth of the peak at {reach:.1}"),
                ))
            },
        },
        Claim {
            says: "a step leaves no difference between the second derivative and F",
            source: "report §4.2.1",
            judge: |r| {
                judged(
                    r,
                    &[below(
                        "F against the second derivative; share of the peak",
                        0.08,
                    )],
                )
            },
        },
    ],
    run: run_step,
    draw: draw_step,
};

fn run_step() -> Result<Record, SandboxError> {
    let step = signal::step();
    let x = places(step.len());
    let smoothed = signal::smooth_binomial(&step, REPORT_PASSES);
    let second = signal::second_derivative(&smoothed);
    let force = signal::force(&smoothed);
    let peak = second.iter().copied().fold(0.0, f64::max);
    let mut record = Record::default();
    record.note(
        "zero of the second derivative",
        crossing_near(&x, &second, 0.0, 50.5),
        "samples",
        Tolerance::ROUNDING,
    );
    let wrong = x
        .iter()
        .zip(&second)
        .filter(|(x, f)| (*x - 50.5).abs() < 10.0 && (50.5 - *x) * *f <= 0.0);
    record.note(
        "samples with the wrong sign",
        real(wrong.count()),
        "",
        Tolerance::EXACT,
    );
    let beyond = |reach: f64| {
        x.iter()
            .zip(&second)
            .filter(|(x, _)| (*x - 50.5).abs() > reach)
            .map(|(_, f)| f.abs())
            .fold(0.0, f64::max)
    };
    record.note(
        "largest beyond 21.5 samples",
        beyond(21.5),
        "",
        Tolerance::EXACT,
    );
    let reach = x
        .iter()
        .zip(&second)
        .filter(|(_, f)| f.abs() > 0.01 * peak)
        .map(|(x, _)| (x - 50.5).abs())
        .fold(0.0, f64::max);
    record.note(
        "reach to a hundredth of the peak",
        reach,
        "samples",
        Tolerance::EXACT,
    );
    record.note("peak", peak, "", Tolerance::ROUNDING);
    record.note(
        "F against the second derivative; share of the peak",
        largest_difference(&second, &force) / peak,
        "",
        Tolerance::ROUNDING,
    );
    record.keep(
        Table::new("signal")
            .with("x", "samples", Tolerance::EXACT, x)
            .with("S", "", Tolerance::EXACT, step)
            .with("smoothed", "", Tolerance::ROUNDING, smoothed)
            .with("second derivative", "", Tolerance::ROUNDING, second)
            .with("F", "", Tolerance::ROUNDING, force),
    );
    Ok(record)
}

fn draw_step(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let edges = [50.5];
    let panel = strip(
        record,
        "the second derivative of the smoothed signal",
        "second derivative",
        Color::BLUE,
        true,
    )?;
    let figure = Figure::new(
        "Figure 4.2  The second derivative of the smoothed signal",
        760.0,
    )
    .with(230.0, vec![marked(panel, &edges)]);
    Ok(vec![Artefact::figure(
        "Dashed: where the step is. Positive pulls to the right, negative to the left.",
        figure,
    )])
}

// ---- Figures 4.3 and 4.4

fn run_box() -> Result<Record, SandboxError> {
    let input = signal::box_();
    let x = places(input.len());
    let smoothed = signal::smooth_binomial(&input, REPORT_PASSES);
    let first = signal::first_derivative(&smoothed);
    let absolute: Vec<f64> = first.iter().map(|value| value.abs()).collect();
    let force = signal::force(&smoothed);
    let second = signal::second_derivative(&smoothed);
    let mut record = Record::default();
    for (name, values) in [("second derivative", &second), ("F", &force)] {
        for (which, at) in [("rising", 35.5), ("falling", 64.5)] {
            let right = x
                .iter()
                .zip(values.iter())
                .filter(|(x, f)| (*x - at).abs() < 10.0 && (at - *x) * *f > 0.0)
                .count();
            record.note(
                format!("{name}: samples of 20 that pull to the {which} edge"),
                real(right),
                "",
                Tolerance::EXACT,
            );
            record.note(
                format!("{name}: zero at the {which} edge"),
                crossing_near(&x, values, 0.0, at),
                "samples",
                Tolerance::ROUNDING,
            );
        }
    }
    record.keep(
        Table::new("signal")
            .with("x", "samples", Tolerance::EXACT, x)
            .with("S", "", Tolerance::EXACT, input)
            .with("smoothed", "", Tolerance::ROUNDING, smoothed)
            .with("first derivative", "", Tolerance::ROUNDING, first)
            .with("absolute value", "", Tolerance::ROUNDING, absolute)
            .with("second derivative", "", Tolerance::ROUNDING, second)
            .with("F", "", Tolerance::ROUNDING, force),
    );
    Ok(record)
}

fn pulls(record: &Record, what: &str, which: &str) -> Result<f64, SandboxError> {
    record.number(&format!(
        "{what}: samples of 20 that pull to the {which} edge"
    ))
}

/// Figure 4.3: the second derivative fails at a falling edge.
pub(crate) const BOX: Experiment = Experiment {
    id: "fig-4-3",
    title: "A box, and why the second derivative will not do",
    place: "Figure 4.3",
    question: "A box rises at one edge and falls at the other. Does the second derivative pull to both?",
    claims: &[
        Claim {
            says: "right at the rising edge",
            source: "report §4.2.1",
            judge: |r| {
                let count = pulls(r, "second derivative", "rising")?;
                Ok(Finding::new(
                    count > 19.5,
                    format!("{count} of 20 samples pull to it"),
                ))
            },
        },
        Claim {
            says: "turned round at the falling edge: it pushes away",
            source: "report §4.2.1",
            judge: |r| {
                let count = pulls(r, "second derivative", "falling")?;
                Ok(Finding::new(
                    count < 0.5,
                    format!("{count} of 20 samples pull to it"),
                ))
            },
        },
    ],
    run: run_box,
    draw: |record| {
        let edges = [35.5, 64.5];
        let mut figure = Figure::new("Figure 4.3  A box input and its second derivative", 760.0);
        for (title, column, color, height) in [
            ("the input signal", "S", Color::INK, 120.0),
            ("the smoothed signal", "smoothed", Color::BLUE, 120.0),
            (
                "the second derivative: wrong at the second edge",
                "second derivative",
                Color::RED,
                170.0,
            ),
        ] {
            let last = column == "second derivative";
            figure = figure.with(
                height,
                vec![marked(strip(record, title, column, color, last)?, &edges)],
            );
        }
        Ok(vec![Artefact::figure(
            "Top: the input signal. Middle: smoothed. Bottom: the second derivative. Dashed: the edges.",
            figure,
        )])
    },
};

/// Figure 4.4: the force of the report, right at both edges.
pub(crate) const FORCE: Experiment = Experiment {
    id: "fig-4-4",
    title: "A box, and the force that pulls to both edges",
    place: "Figure 4.4",
    question: "Does F = ∇|∇(G ∗ S)| pull to a rising and to a falling edge alike?",
    claims: &[
        Claim {
            says: "right at the rising edge",
            source: "report §4.2.1",
            judge: |r| {
                let (count, at) = (
                    pulls(r, "F", "rising")?,
                    r.number("F: zero at the rising edge")?,
                );
                Ok(Finding::new(
                    count > 19.5 && (at - 35.5).abs() < 0.01,
                    format!(
                        "{count} of 20 samples pull to it; zero at x = {at:.3}, the edge is at 35.5"
                    ),
                ))
            },
        },
        Claim {
            says: "right at the falling edge",
            source: "report §4.2.1",
            judge: |r| {
                let (count, at) = (
                    pulls(r, "F", "falling")?,
                    r.number("F: zero at the falling edge")?,
                );
                Ok(Finding::new(
                    count > 19.5 && (at - 64.5).abs() < 0.01,
                    format!(
                        "{count} of 20 samples pull to it; zero at x = {at:.3}, the edge is at 64.5"
                    ),
                ))
            },
        },
        Claim {
            says: "the sampled box has its edges at 35.5 and 64.5",
            source: "D46",
            judge: |r| {
                let (a, b) = (
                    r.number("F: zero at the rising edge")?,
                    r.number("F: zero at the falling edge")?,
                );
                Ok(Finding::new(
                    ((a + b) / 2.0 - 50.0).abs() < 1e-9,
                    format!("zeros at {a:.3} and {b:.3}, centered on 50"),
                ))
            },
        },
    ],
    run: run_box,
    draw: |record| {
        let edges = [35.5, 64.5];
        let mut figure = Figure::new("Figure 4.4  A box input and the resultant force", 760.0);
        for (title, column, color) in [
            ("the input signal", "S", Color::INK),
            ("the smoothed signal", "smoothed", Color::BLUE),
            ("the first derivative", "first derivative", Color::BLUE),
            ("its absolute value", "absolute value", Color::BLUE),
            (
                "the resultant force: right at both edges",
                "F",
                Color::GREEN,
            ),
        ] {
            let last = column == "F";
            let height = if last { 150.0 } else { 112.0 };
            figure = figure.with(
                height,
                vec![marked(strip(record, title, column, color, last)?, &edges)],
            );
        }
        Ok(vec![Artefact::figure(
            "From top to bottom: the input signal, the smoothed signal, the first derivative, the absolute value, \
             the resultant force. Dashed: the edges.",
            figure,
        )])
    },
};

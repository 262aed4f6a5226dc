//! Figures 4.2 to 4.4: from a smoothed signal to a force, in one dimension (report §4.2.1).

use crate::prelude::*;
use field::REPORT_PASSES;
use field::signal;

/// The report counts samples from 1.
pub(super) fn places(count: usize) -> Vec<f64> {
    (1..=count).map(real).collect()
}

pub(super) fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    most(a.iter().zip(b).map(|(a, b)| (a - b).abs()))
}

/// Where a line through the samples crosses a level nearest to a place.
pub(super) fn crossing_near(x: &[f64], values: &[f64], level: f64, place: f64) -> f64 {
    let crosses = |i: &usize| (values[i - 1] < level) != (values[*i] < level);
    let at = |i: usize| {
        let (a, b) = (values[i - 1] - level, values[i] - level);
        x[i - 1] + (x[i] - x[i - 1]) * a / (a - b)
    };
    let all = (1..values.len()).filter(crosses).map(at);
    let nearest = all.min_by(|a, b| (a - place).abs().total_cmp(&(b - place).abs()));
    nearest.unwrap_or(f64::NAN)
}

/// Stacked panels as the report draws them, with dashed lines at the edges: title, column, color,
/// height.
fn strips(
    record: &Record,
    title: &str,
    edges: &[f64],
    panels: &[(&str, &str, Color, f64)],
) -> Result<Figure> {
    let mut figure = Figure::new(title, 760.0);
    for (k, &(title, column, color, height)) in panels.iter().enumerate() {
        let points = record.points("signal", "x", column)?;
        let (low, high) = range(points.iter().map(|p| p.1).chain([0.0]), 0.12);
        let label = if k + 1 == panels.len() {
            "x / samples"
        } else {
            ""
        };
        let x = Axis::new(label, 1.0, 100.0).with_ticks(11);
        let mut panel = plot(title, x, Axis::new("", low, high).with_ticks(4));
        panel = panel.with(line(points, color));
        for &at in edges {
            panel = panel.with(
                line([(at, low), (at, high)], Color::GREY)
                    .dashed()
                    .weighing(0.6),
            );
        }
        figure = figure.with(height, vec![panel]);
    }
    Ok(figure)
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
        claim("positive below the edge, negative above it [report §4.2.1]").when(&[
            below("samples with the wrong sign", 0.5),
            near("zero of the second derivative", 50.5, 1e-9),
        ]),
        claim("the step lies between samples 50 and 51, not at 50 [D46]").when(&[near(
            "zero of the second derivative",
            50.5,
            1e-9,
        )]),
        claim("zero elsewhere, though the program has no δ [report §4.2.1, D45]").when(&[
            near("largest beyond 21.5 samples", 0.0, f64::MIN_POSITIVE),
            below("reach to a hundredth of the peak", 13.0),
        ]),
        claim("a step leaves no difference between the second derivative and F [report §4.2.1]")
            .when(&[below(
                "F against the second derivative; share of the peak",
                0.08,
            )]),
    ],
    run: run_step,
    draw: draw_step,
};

fn run_step() -> Result {
    let step = signal::step();
    let x = places(step.len());
    let smoothed = signal::smooth_binomial(&step, REPORT_PASSES);
    let second = signal::second_derivative(&smoothed);
    let force = signal::force(&smoothed);
    let peak = most(second.iter().copied());
    let both = || x.iter().map(|x| x - 50.5).zip(second.iter().copied());
    let wrong = both()
        .filter(|(x, f)| x.abs() < 10.0 && -x * f <= 0.0)
        .count();
    let far = both().filter(|(x, _)| x.abs() > 21.5);
    let strong = both().filter(|(_, f)| f.abs() > 0.01 * peak);
    let zero = crossing_near(&x, &second, 0.0, 50.5);
    let off = largest_difference(&second, &force) / peak;
    let mut record = Record::default();
    record.note("zero of the second derivative [samples]", zero, ROUNDING);
    record.note("samples with the wrong sign", real(wrong), EXACT);
    record.note(
        "largest beyond 21.5 samples",
        most(far.map(|(_, f)| f.abs())),
        EXACT,
    );
    let reach = most(strong.map(|(x, _)| x.abs()));
    record.note("reach to a hundredth of the peak [samples]", reach, EXACT);
    record.note("peak", peak, ROUNDING);
    record.note(
        "F against the second derivative; share of the peak",
        off,
        ROUNDING,
    );
    record.keep(
        Table::new("signal")
            .exact("x [samples]", x)
            .exact("S", step)
            .with("smoothed", ROUNDING, smoothed)
            .with("second derivative", ROUNDING, second)
            .with("F", ROUNDING, force),
    );
    Ok(record)
}

fn draw_step(record: &Record) -> Drawn {
    let title = "the second derivative of the smoothed signal";
    let panels = [(title, "second derivative", Color::BLUE, 230.0)];
    let title = "Figure 4.2  The second derivative of the smoothed signal";
    Artefact::only(
        "Dashed: where the step is. Positive pulls to the right, negative to the left.",
        strips(record, title, &[50.5], &panels)?,
    )
}

// ---- Figures 4.3 and 4.4

/// Where the box has its edges.
const EDGES: [f64; 2] = [35.5, 64.5];

fn run_box() -> Result {
    let input = signal::box_();
    let x = places(input.len());
    let smoothed = signal::smooth_binomial(&input, REPORT_PASSES);
    let first = signal::first_derivative(&smoothed);
    let absolute: Vec<f64> = first.iter().map(|value| value.abs()).collect();
    let force = signal::force(&smoothed);
    let second = signal::second_derivative(&smoothed);
    let mut record = Record::default();
    for (name, values) in [("second derivative", &second), ("F", &force)] {
        for (which, at) in [("rising", EDGES[0]), ("falling", EDGES[1])] {
            let both = x.iter().zip(values);
            let right = both.filter(|(x, f)| (*x - at).abs() < 10.0 && (at - *x) * *f > 0.0);
            let pulls = format!("{name}: samples of 20 that pull to the {which} edge");
            record.note(pulls, real(right.count()), EXACT);
            let zero = crossing_near(&x, values, 0.0, at);
            record.note(
                format!("{name}: zero at the {which} edge [samples]"),
                zero,
                ROUNDING,
            );
        }
    }
    record.keep(
        Table::new("signal")
            .exact("x [samples]", x)
            .exact("S", input)
            .with("smoothed", ROUNDING, smoothed)
            .with("first derivative", ROUNDING, first)
            .with("absolute value", ROUNDING, absolute)
            .with("second derivative", ROUNDING, second)
            .with("F", ROUNDING, force),
    );
    Ok(record)
}

const RISING: &str = "F: zero at the rising edge";
const FALLING: &str = "F: zero at the falling edge";

/// Figure 4.3: the second derivative fails at a falling edge.
pub(crate) const BOX: Experiment = Experiment {
    id: "fig-4-3",
    title: "A box, and why the second derivative will not do",
    place: "Figure 4.3",
    question: "A box rises at one edge and falls at the other. Does the second derivative pull to both?",
    claims: &[
        claim("right at the rising edge [report §4.2.1]").when(&[above(
            "second derivative: samples of 20 that pull to the rising edge",
            19.5,
        )]),
        claim("turned round at the falling edge: it pushes away [report §4.2.1]").when(&[below(
            "second derivative: samples of 20 that pull to the falling edge",
            0.5,
        )]),
    ],
    run: run_box,
    draw: |record| {
        let title = "the second derivative: wrong at the second edge";
        let panels = [
            ("the input signal", "S", Color::INK, 120.0),
            ("the smoothed signal", "smoothed", Color::BLUE, 120.0),
            (title, "second derivative", Color::RED, 170.0),
        ];
        let title = "Figure 4.3  A box input and its second derivative";
        Artefact::only(
            "Top: the input signal. Middle: smoothed. Bottom: the second derivative. Dashed: the edges.",
            strips(record, title, &EDGES, &panels)?,
        )
    },
};

/// Figure 4.4: the force of the report, right at both edges.
pub(crate) const FORCE: Experiment = Experiment {
    id: "fig-4-4",
    title: "A box, and the force that pulls to both edges",
    place: "Figure 4.4",
    question: "Does F = ∇|∇(G ∗ S)| pull to a rising and to a falling edge alike?",
    claims: &[
        claim("right at the rising edge [report §4.2.1]").when(&[
            above("F: samples of 20 that pull to the rising edge", 19.5),
            near(RISING, 35.5, 0.01),
        ]),
        claim("right at the falling edge [report §4.2.1]").when(&[
            above("F: samples of 20 that pull to the falling edge", 19.5),
            near(FALLING, 64.5, 0.01),
        ]),
        claim("the sampled box has its edges at 35.5 and 64.5, centered on 50 [D46]").judged(|r| {
            let (a, b) = (r.number(RISING)?, r.number(FALLING)?);
            let words = format!("zeros at {a:.3} and {b:.3}");
            Ok(Finding::new(
                (f64::midpoint(a, b) - 50.0).abs() < 1e-9,
                words,
            ))
        }),
    ],
    run: run_box,
    draw: |record| {
        let panels = [
            ("the input signal", "S", Color::INK, 112.0),
            ("the smoothed signal", "smoothed", Color::BLUE, 112.0),
            (
                "the first derivative",
                "first derivative",
                Color::BLUE,
                112.0,
            ),
            ("its absolute value", "absolute value", Color::BLUE, 112.0),
            (
                "the resultant force: right at both edges",
                "F",
                Color::GREEN,
                150.0,
            ),
        ];
        let title = "Figure 4.4  A box input and the resultant force";
        Artefact::only(
            "From top to bottom: the input signal, the smoothed signal, the first derivative, the absolute value, \
             the resultant force. Dashed: the edges.",
            strips(record, title, &EDGES, &panels)?,
        )
    },
};

//! Figure 4.1: three ways to smooth a signal (report §4.2.1).

use super::signal::{crossing_near, largest_difference, places};
use crate::demand::{below, judged, near};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};
use field::REPORT_PASSES;
use field::signal;

/// The standard deviation of the report's twenty passes: √(20/2) (D36).
fn sigma(passes: u32) -> f64 {
    (f64::from(passes) / 2.0).sqrt()
}

/// Figure 4.1: twenty binomial passes, beside the two other ways.
pub(crate) const SMOOTHING: Experiment = Experiment {
    id: "fig-4-1",
    title: "Binomial convolutions produce a Gaussian",
    place: "Figure 4.1",
    question: "Does the mask [¼ ½ ¼], applied twenty times, smooth a step as a Gaussian does? The report names \
               three ways to smooth and shows one; here they stand side by side, and the number of passes is \
               varied.",
    claims: &[
        Claim {
            says: "the edge stays where it is, between samples 50 and 51",
            source: "report §4.2.1, D46",
            judge: |r| judged(r, &[near("edge of the smoothed step", 50.5, 1e-12)]),
        },
        Claim {
            says: "it works rather well when the number of iterations is sufficient",
            source: "report §4.2.1",
            judge: |r| {
                let errors = r.column("passes", "largest difference")?;
                let falling = errors.windows(2).all(|pair| pair[1] < pair[0]);
                let twenty = r.number("binomial against Gaussian; 20 passes")?;
                Ok(Finding::new(
                    falling && twenty < 2e-3,
                    format!(
                        "off by {:.4} after 1 pass, {twenty:.5} after 20, falling all the way",
                        errors[0]
                    ),
                ))
            },
        },
        Claim {
            says: "the Fourier way and the direct way are the same Gaussian",
            source: "report §4.2.1",
            judge: |r| judged(r, &[below("Fourier against direct", 1e-10)]),
        },
        Claim {
            says: "mirror boundaries keep the sum and make no new extremes",
            source: "report §4.2.1",
            judge: |r| {
                let (sum, least, most) = (
                    r.number("sum kept")?,
                    r.number("least value")?,
                    r.number("largest value")?,
                );
                Ok(Finding::new(
                    (sum - 50.0).abs() < 1e-9 && least >= 0.0 && most <= 1.0,
                    format!("sum {sum} of 50, values {least:.3} to {most:.3}"),
                ))
            },
        },
    ],
    run: run_smoothing,
    draw: draw_smoothing,
};

fn run_smoothing() -> Result<Record, SandboxError> {
    let step = signal::step();
    let sigma20 = sigma(REPORT_PASSES);
    let binomial = signal::smooth_binomial(&step, REPORT_PASSES);
    let fourier = signal::smooth_fourier(&step, sigma20);
    let direct = signal::smooth_direct(&step, sigma20);
    let x = places(step.len());
    let mut record = Record::default();
    record.note(
        "edge of the smoothed step",
        crossing_near(&x, &binomial, 0.5, 50.5),
        "samples",
        Tolerance::ROUNDING,
    );
    record.note(
        "sigma of 20 passes",
        sigma20,
        "samples",
        Tolerance::ROUNDING,
    );
    record.note(
        "binomial against Gaussian; 20 passes",
        largest_difference(&binomial, &direct),
        "",
        Tolerance::ROUNDING,
    );
    record.note(
        "Fourier against direct",
        largest_difference(&fourier, &direct),
        "",
        Tolerance::ROUNDING,
    );
    record.note("sum kept", binomial.iter().sum(), "", Tolerance::ROUNDING);
    record.note(
        "least value",
        binomial.iter().copied().fold(1.0, f64::min),
        "",
        Tolerance::ROUNDING,
    );
    record.note(
        "largest value",
        binomial.iter().copied().fold(0.0, f64::max),
        "",
        Tolerance::ROUNDING,
    );

    let numbers: Vec<u32> = vec![1, 2, 5, 10, 20, 40, 80];
    let errors = numbers
        .iter()
        .map(|&passes| {
            let many = signal::smooth_binomial(&step, passes);
            largest_difference(&many, &signal::smooth_fourier(&step, sigma(passes)))
        })
        .collect();
    record.keep(
        Table::new("passes")
            .with(
                "passes",
                "",
                Tolerance::EXACT,
                numbers.iter().map(|&n| f64::from(n)).collect(),
            )
            .with(
                "sigma",
                "samples",
                Tolerance::ROUNDING,
                numbers.iter().map(|&n| sigma(n)).collect(),
            )
            .with("largest difference", "", Tolerance::ROUNDING, errors),
    );
    let few = |passes| signal::smooth_binomial(&step, passes);
    record.keep(
        Table::new("signal")
            .with("x", "samples", Tolerance::EXACT, x)
            .with("S", "", Tolerance::EXACT, step.clone())
            .with("binomial", "", Tolerance::ROUNDING, binomial.clone())
            .with("Fourier", "", Tolerance::ROUNDING, fourier.clone())
            .with("direct", "", Tolerance::ROUNDING, direct.clone())
            .with(
                "binomial − direct",
                "",
                Tolerance::ROUNDING,
                difference(&binomial, &direct),
            )
            .with("1 pass", "", Tolerance::ROUNDING, few(1))
            .with("5 passes", "", Tolerance::ROUNDING, few(5)),
    );
    Ok(record)
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn draw_smoothing(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let line = |column: &str, color| -> Result<Line, SandboxError> {
        Ok(Line::new(record.points("signal", "x", column)?, color).named(column))
    };
    let whole = |label: &str| Axis::new(label, 1.0, 100.0).with_ticks(11);
    let up = || Axis::new("", -0.1, 1.1).with_ticks(4);
    let top =
        Panel::new("the input signal S", whole(""), up()).with(line("S", Color::INK)?.named(""));
    let bottom = Panel::new("smoothed, twenty times [¼ ½ ¼]", whole("x / samples"), up())
        .with(line("binomial", Color::BLUE)?.named(""));
    let near = |label: &str| Axis::new(label, 38.0, 63.0).with_ticks(6);
    let ways = Panel::new("three ways, the same Gaussian", near("x / samples"), up())
        .legend_at(Corner::TopLeft)
        .with(line("Fourier", Color::ORANGE)?.weighing(3.2))
        .with(line("direct", Color::RED)?)
        .with(line("binomial", Color::BLUE)?.dashed());
    let passes = Panel::new("more passes, wider and smoother", near("x / samples"), up())
        .legend_at(Corner::TopLeft)
        .with(line("S", Color::GREY)?)
        .with(line("1 pass", Color::ORANGE)?)
        .with(line("5 passes", Color::GREEN)?)
        .with(line("binomial", Color::BLUE)?.named("20 passes"));
    let errors = record.points("passes", "passes", "largest difference")?;
    let convergence = Panel::new(
        "binomial against Gaussian",
        Axis::log("passes", 1.0, 100.0),
        Axis::log("largest difference", 1e-4, 1e-1),
    )
    .with(Line::new(errors.clone(), Color::BLUE))
    .with(Layer::Dots {
        points: errors,
        radius: 1.6,
        color: Color::BLUE,
        label: String::new(),
    });
    let figure = Figure::new(
        "Figure 4.1  Binomial convolutions to produce a Gaussian",
        760.0,
    )
    .with(120.0, vec![top])
    .with(140.0, vec![bottom])
    .with(220.0, vec![ways, passes, convergence]);
    Ok(vec![Artefact::figure(
        "Top: the input signal. Middle: smoothed. Below: the three ways of §4.2.1, the number of passes, and how \
         far twenty of them are from a Gaussian.",
        figure,
    )])
}

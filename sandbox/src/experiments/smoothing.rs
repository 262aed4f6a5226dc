//! Figure 4.1: three ways to smooth a signal (report §4.2.1).

use super::signal::{crossing_near, largest_difference, places};
use crate::prelude::*;
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
        claim("the edge stays where it is, between samples 50 and 51 [report §4.2.1, D46]")
            .when(&[near("edge of the smoothed step", 50.5, 1e-12)]),
        claim("it works rather well when the number of iterations is sufficient [report §4.2.1]")
            .when(&[
                falling("largest difference @ passes"),
                below("binomial against Gaussian; 20 passes", 2e-3),
            ]),
        claim("the Fourier way and the direct way are the same Gaussian [report §4.2.1]")
            .when(&[below("Fourier against direct", 1e-10)]),
        claim("mirror boundaries keep the sum and make no new extremes [report §4.2.1]").when(&[
            near("sum kept", 50.0, 1e-9),
            at_least("least value", 0.0),
            at_most("largest value", 1.0),
        ]),
    ],
    run: run_smoothing,
    draw: draw_smoothing,
};

fn run_smoothing() -> Result {
    let step = signal::step();
    let wide = sigma(REPORT_PASSES);
    let smooth = |passes| signal::smooth_binomial(&step, passes);
    let binomial = smooth(REPORT_PASSES);
    let fourier = signal::smooth_fourier(&step, wide);
    let direct = signal::smooth_direct(&step, wide);
    let x = places(step.len());
    let edge = crossing_near(&x, &binomial, 0.5, 50.5);
    let mut record = Record::default();
    for (name, value) in [
        ("edge of the smoothed step [samples]", edge),
        ("sigma of 20 passes [samples]", wide),
        (
            "binomial against Gaussian; 20 passes",
            largest_difference(&binomial, &direct),
        ),
        (
            "Fourier against direct",
            largest_difference(&fourier, &direct),
        ),
        ("sum kept", binomial.iter().sum()),
        ("least value", least(binomial.iter().copied())),
        ("largest value", most(binomial.iter().copied())),
    ] {
        record.note(name, value, ROUNDING);
    }
    let numbers = [1, 2, 5, 10, 20, 40, 80];
    let gaussian = |passes| signal::smooth_fourier(&step, sigma(passes));
    let error = |passes| largest_difference(&smooth(passes), &gaussian(passes));
    record.keep(
        Table::new("passes")
            .exact("passes", numbers.map(f64::from))
            .with("sigma [samples]", ROUNDING, numbers.map(sigma))
            .with("largest difference", ROUNDING, numbers.map(error)),
    );
    let difference = binomial.iter().zip(&direct).map(|(a, b)| a - b);
    record.keep(
        Table::new("signal")
            .exact("x [samples]", x)
            .exact("S", step.clone())
            .with("binomial", ROUNDING, binomial.clone())
            .with("Fourier", ROUNDING, fourier)
            .with("direct", ROUNDING, direct.clone())
            .with("binomial − direct", ROUNDING, difference)
            .with("1 pass", ROUNDING, smooth(1))
            .with("5 passes", ROUNDING, smooth(5)),
    );
    Ok(record)
}

fn draw_smoothing(record: &Record) -> Drawn {
    let own = |column: &str, color| -> Result<Line> {
        Ok(line(record.points("signal", "x", column)?, color).named(column))
    };
    let whole = |label: &str| Axis::new(label, 1.0, 100.0).with_ticks(11);
    let up = || Axis::new("", -0.1, 1.1).with_ticks(4);
    let near = || Axis::new("x / samples", 38.0, 63.0).with_ticks(6);
    let top = plot("the input signal S", whole(""), up()).with(own("S", Color::INK)?.named(""));
    let bottom = plot("smoothed, twenty times [¼ ½ ¼]", whole("x / samples"), up())
        .with(own("binomial", Color::BLUE)?.named(""));
    let ways = plot("three ways, the same Gaussian", near(), up())
        .legend_at(Corner::TopLeft)
        .with(own("Fourier", Color::ORANGE)?.weighing(3.2))
        .with(own("direct", Color::RED)?)
        .with(own("binomial", Color::BLUE)?.dashed());
    let passes = plot("more passes, wider and smoother", near(), up())
        .legend_at(Corner::TopLeft)
        .with(own("S", Color::GREY)?)
        .with(own("1 pass", Color::ORANGE)?)
        .with(own("5 passes", Color::GREEN)?)
        .with(own("binomial", Color::BLUE)?.named("20 passes"));
    let errors = record.points("passes", "passes", "largest difference")?;
    let x = Axis::log("passes", 1.0, 100.0);
    let y = Axis::log("largest difference", 1e-4, 1e-1);
    let convergence = plot("binomial against Gaussian", x, y)
        .with(line(errors.clone(), Color::BLUE))
        .with(dots(errors, 1.6, Color::BLUE));
    Artefact::only(
        "Top: the input signal. Middle: smoothed. Below: the three ways of §4.2.1, the number of passes, and how \
         far twenty of them are from a Gaussian.",
        Figure::new(
            "Figure 4.1  Binomial convolutions to produce a Gaussian",
            760.0,
        )
        .with(120.0, vec![top])
        .with(140.0, vec![bottom])
        .with(220.0, vec![ways, passes, convergence]),
    )
}

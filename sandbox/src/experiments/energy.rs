//! The energies of report §2.3 and §2.4 at every moment: what damping takes is what the sum loses.

use crate::demand::{at_most, below, judged};
use crate::draw::{Axis, Color, Figure, Line, Panel};
use crate::experiments::motion::{Frames, changed_scene, keep_energies, keep_frames, thin};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};
use std::ops::ControlFlow;

const ID: &str = "sec-2-3-energy";

/// An oval that would be a circle, and its energies.
pub(crate) const ENERGY: Experiment = Experiment {
    id: ID,
    title: "Where the energy goes",
    place: "§2.3",
    question: "An oval whose shape at rest is a circle is let go. Energy runs between motion and deformation; is what \
               the sum loses exactly what the damping takes?",
    claims: &[
        Claim {
            says: "the damping force dissipates the energy: the sum loses ∫∫ γ v² ds dt",
            source: "report §2.3",
            judge: |r| {
                judged(
                    r,
                    &[below("largest difference of loss and dissipation", 1e-3)],
                )
            },
        },
        Claim {
            says: "the energy of deformation is never negative, and zero without deformation",
            source: "report §2.3, §2.4",
            judge: |r| {
                let (least, rest) = (
                    r.number("least elastic energy")?,
                    r.number("elastic energy of the rest shape")?,
                );
                Ok(Finding::new(
                    least >= 0.0 && rest.abs() < 1e-25,
                    format!("least {least:.1e}, of the circle itself {rest:.1e}"),
                ))
            },
        },
        Claim {
            says: "the sum falls at every step",
            source: "report §2.3",
            judge: |r| judged(r, &[at_most("largest rise of the sum in a step", 1e-4)]),
        },
        Claim {
            says: "all of it is gone at the rate γ/μ of an underdamped body",
            source: "D27",
            judge: |r| {
                let (found, right) = (r.number("rate of loss")?, r.number("γ/μ")?);
                Ok(Finding::new(
                    (found / right - 1.0).abs() < 0.05,
                    format!("{found:.3} /s, γ/μ = {right}"),
                ))
            },
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let mut scene = changed_scene(ID, "ringing-oval", &[])?;
    scene.plan.recording.every = Some(5);
    let mut snake = scene.snake.clone();
    let spacing = snake.body().spacing;
    let n = snake.body().len();
    let (gamma, mass) = (snake.body().damping.to_vec(n), snake.body().mass.at(0));
    let power = |v: &[glam::DVec2]| -> f64 {
        let each = v.iter().zip(&gamma).map(|(v, g)| g * v.length_squared());
        spacing * each.sum::<f64>()
    };
    let start = scene.start.clone();
    let dt = scene.plan.dt;
    let mut times = vec![0.0];
    let mut sums = vec![snake.energies(&start).total()];
    let mut taken = vec![0.0];
    let mut least = f64::INFINITY;
    let mut before = power(&start.v);
    let run = scene
        .run(&mut |state| {
            let energies = snake.energies(state);
            let now = power(&state.v);
            // the trapezium rule, of the scheme's own order
            taken.push(taken[taken.len() - 1] + 0.5 * dt * (before + now));
            before = now;
            times.push(state.t);
            sums.push(energies.total());
            least = least.min(energies.elastic());
            ControlFlow::Continue(())
        })
        .map_err(SandboxError::refused(ID))?;
    let begun = sums[0];
    let difference = |i: usize| ((begun - sums[i]) - taken[i]).abs() / begun;
    let off = (0..sums.len()).map(difference).fold(0.0_f64, f64::max);
    let rise = sums
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) / begun)
        .fold(0.0_f64, f64::max);
    let end = sums.len() - 1;
    let mut record = Record::default();
    let close = Tolerance::Relative(1e-6);
    record.note("energy at the start", begun, "", close);
    record.note("energy at the end", sums[end], "", close);
    record.note("taken by damping", taken[end], "", close);
    record.note(
        "largest difference of loss and dissipation",
        off,
        "of the start",
        Tolerance::Absolute(1e-6),
    );
    record.note(
        "largest rise of the sum in a step",
        rise,
        "of the start",
        Tolerance::Absolute(1e-6),
    );
    record.note("least elastic energy", least, "", Tolerance::Absolute(1e-6));
    let mut round = start;
    round.x.clone_from(&snake.body().rest);
    round.v.fill(glam::DVec2::ZERO);
    let zero = snake.energies(&round).elastic();
    record.note(
        "elastic energy of the rest shape",
        zero,
        "",
        Tolerance::ROUNDING,
    );
    record.note(
        "rate of loss",
        (begun / sums[end]).ln() / times[end],
        "/s",
        close,
    );
    record.note("γ/μ", gamma[0] / mass, "/s", Tolerance::ROUNDING);
    record.keep(
        Table::new("loss")
            .with("t", "s", Tolerance::ROUNDING, thin(&times, 10))
            .with(
                "sum",
                "",
                Tolerance::Absolute(1e-6 * begun),
                thin(&sums, 10),
            )
            .with(
                "taken",
                "",
                Tolerance::Absolute(1e-6 * begun),
                thin(&taken, 10),
            ),
    );
    keep_energies(&mut record, "energy", &run);
    keep_frames(&mut record, "curves", &run);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let begun = record.number("energy at the start")?;
    let time = |to: f64| Axis::new("t / s", 0.0, to);
    let mut terms = Panel::new(
        "every term, and the sum",
        time(10.0),
        Axis::new("energy", 0.0, 1.04 * begun),
    );
    for (name, color) in [
        ("kinetic", Color::BLUE),
        ("tension", Color::ORANGE),
        ("rigidity", Color::GREEN),
        ("total", Color::INK),
    ] {
        let label = if name == "total" { "sum" } else { name };
        terms = terms.with(
            Line::new(record.points("energy", "t", name)?, color)
                .weighing(0.9)
                .named(label),
        );
    }
    let sum = record.points("loss", "t", "sum")?;
    let taken = record.points("loss", "t", "taken")?;
    let both = sum
        .iter()
        .zip(&taken)
        .map(|(s, t)| (s.0, s.1 + t.1))
        .collect();
    let loss = Panel::new(
        "the sum, and what damping has taken",
        time(20.0),
        Axis::new("energy", 0.0, 1.35 * begun),
    )
    .with(Line::new(sum, Color::INK).named("sum of the energies"))
    .with(Line::new(taken, Color::RED).named("∫∫ γ v² ds dt"))
    .with(Line::new(both, Color::GREY).dashed().named("together"));
    let frames = Frames::of(record, "curves")?;
    let mut shapes = Panel::new(
        "the first 4 s, every 0.5 s",
        Axis::new("x", -14.0, 14.0),
        Axis::new("y", -14.0, 14.0),
    )
    .equal();
    for t in 0..=8 {
        let share = f64::from(t) / 8.0;
        let frame = frames.nearest(4.0 * share);
        shapes = shapes.with(
            frames
                .ring(frame, Color::BLUE.mix(Color::RED, share))
                .weighing(0.7),
        );
    }
    shapes.share = 0.75;
    let figure = Figure::new(
        "§2.3  The energies of an oval that would be a circle",
        1000.0,
    )
    .with(330.0, vec![shapes, terms, loss]);
    Ok(vec![Artefact::figure(
        "Left: the oval swings about the circle, from blue to orange. Middle: kinetic and elastic energy take turns. \
         Right: what the sum loses, damping takes.",
        figure,
    )])
}

//! The energies of report §2.3 and §2.4 at every moment: what damping takes is what the sum loses.

use crate::prelude::*;

/// An oval that would be a circle, and its energies.
pub(crate) const ENERGY: Experiment = Experiment {
    id: "sec-2-3-energy",
    title: "Where the energy goes",
    place: "§2.3",
    question: "An oval whose shape at rest is a circle is let go. Energy runs between motion and deformation; is what \
               the sum loses exactly what the damping takes?",
    claims: &[
        claim("the damping force dissipates the energy: the sum loses ∫∫ γ v² ds dt [report §2.3]")
            .when(&[below("largest difference of loss and dissipation", 1e-3)]),
        claim("energy of deformation is never negative, and zero without [report §2.3, §2.4]")
            .when(&[
                at_least("least elastic energy", 0.0),
                near("elastic energy of the rest shape", 0.0, 1e-25),
            ]),
        claim("the sum falls at every step [report §2.3]")
            .when(&[at_most("largest rise of the sum in a step", 1e-4)]),
        claim("all of it is gone at the rate γ/μ of an underdamped body [D27]").when(&[like(
            "rate of loss",
            "γ/μ",
            0.05,
        )]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let mut scene = scene_with("ringing-oval", &[])?;
    scene.plan.recording.every = Some(5);
    let mut snake = scene.snake.clone();
    let (spacing, n) = (snake.body().spacing, snake.body().len());
    let (gamma, mass) = (snake.body().damping.to_vec(n), snake.body().mass.at(0));
    let power = |v: &[DVec2]| -> f64 {
        let each = v.iter().zip(&gamma).map(|(v, g)| g * v.length_squared());
        spacing * each.sum::<f64>()
    };
    let (mut start, dt) = (scene.start.clone(), scene.plan.dt);
    let begun = snake.energies(&start).total();
    let (mut times, mut sums, mut taken) = (vec![0.0], vec![begun], vec![0.0]);
    let (mut lowest, mut before) = (f64::INFINITY, power(&start.v));
    let run = watched(&scene, &mut |state| {
        let energies = snake.energies(state);
        let now = power(&state.v);
        // the trapezium rule, of the scheme's own order
        taken.push(taken[taken.len() - 1] + 0.5 * dt * (before + now));
        before = now;
        times.push(state.t);
        sums.push(energies.total());
        lowest = lowest.min(energies.elastic());
    })?;
    let off = sums
        .iter()
        .zip(&taken)
        .map(|(sum, taken)| ((begun - sum) - taken).abs() / begun);
    let rise = sums.windows(2).map(|pair| (pair[1] - pair[0]) / begun);
    let end = sums.len() - 1;
    let close = share(1e-6);
    let mut record = Record::default();
    record.note("energy at the start", begun, close);
    record.note("energy at the end", sums[end], close);
    record.note("taken by damping", taken[end], close);
    let name = "largest difference of loss and dissipation [of the start]";
    record.note(name, most(off), 1e-6);
    let rise = rise.fold(0.0, f64::max);
    record.note(
        "largest rise of the sum in a step [of the start]",
        rise,
        1e-6,
    );
    record.note("least elastic energy", lowest, 1e-6);
    start.x.clone_from(&snake.body().rest);
    start.v.fill(DVec2::ZERO);
    let zero = snake.energies(&start).elastic();
    record.note("elastic energy of the rest shape", zero, ROUNDING);
    record.note(
        "rate of loss [/s]",
        (begun / sums[end]).ln() / times[end],
        close,
    );
    record.note("γ/μ [/s]", gamma[0] / mass, ROUNDING);
    let tenth = |values: Vec<f64>| values.into_iter().step_by(10);
    record.keep(
        Table::new("loss")
            .with("t [s]", ROUNDING, tenth(times))
            .with("sum", 1e-6 * begun, tenth(sums))
            .with("taken", 1e-6 * begun, tenth(taken)),
    );
    record.keep_run("curves", &run);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let begun = record.told("energy at the start")?;
    let frames = record.run("curves")?;
    let (time, energy) = (("t / s", 0.0, 10.0), ("energy", 0.0, 1.04 * begun));
    let mut terms = plot("every term, and the sum", time, energy);
    for (name, label, color) in [
        ("kinetic", "kinetic", Color::BLUE),
        ("tension", "tension", Color::ORANGE),
        ("rigidity", "rigidity", Color::GREEN),
        ("total", "sum", Color::INK),
    ] {
        terms = terms.with(line(frames.energy(name)?, color).weighing(0.9).named(label));
    }
    let sum = record.points("loss", "t", "sum")?;
    let taken = record.points("loss", "t", "taken")?;
    let both = sum.iter().zip(&taken).map(|(s, t)| (s.0, s.1 + t.1));
    let both = line(both, Color::GREY).dashed().named("together");
    let (time, energy) = (("t / s", 0.0, 20.0), ("energy", 0.0, 1.35 * begun));
    let loss = plot("the sum, and what damping has taken", time, energy)
        .with(line(sum, Color::INK).named("sum of the energies"))
        .with(line(taken, Color::RED).named("∫∫ γ v² ds dt"))
        .with(both);
    let mut shapes = plot(
        "the first 4 s, every 0.5 s",
        ("x", -14.0, 14.0),
        ("y", -14.0, 14.0),
    )
    .equal();
    for t in 0..=8 {
        let share = f64::from(t) / 8.0;
        let color = Color::BLUE.mix(Color::RED, share);
        shapes = shapes.with(
            frames
                .ring(frames.nearest(4.0 * share), color)
                .weighing(0.7),
        );
    }
    shapes.share = 0.75;
    Artefact::only(
        "Left: the oval swings about the circle, from blue to orange. Middle: kinetic and elastic energy take turns. \
         Right: what the sum loses, damping takes.",
        Figure::new(
            "§2.3  The energies of an oval that would be a circle",
            1000.0,
        )
        .with(330.0, vec![shapes, terms, loss]),
    )
}

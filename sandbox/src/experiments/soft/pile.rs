//! Twenty balls of different hardness fall into a box.

use crate::prelude::*;
use snake::{Snake, World};

/// What is seen of the box.
const WINDOW: [f64; 4] = [-0.6, -0.6, 20.6, 24.5];

/// The pile, the same without contact, and the same without walls.
pub(crate) const PILE: Experiment = Experiment {
    id: "soft-pile",
    title: "Twenty balls in a box",
    place: "beyond",
    question: "Twenty balls of three hardnesses fall into a box, touch, rub and come to lie on each other. Does the \
               account of energies close, do they stay out of each other, and is momentum kept where there is no box?",
    claims: &[
        claim("it runs to its end with the step of the scene and comes to lie [the scene pile]")
            .when(&[below("kinetic energy at the end", 1e-2)]),
        claim("no ball is deeper in another than the stop and the way of a step [the contact law]")
            .judged(|r| {
                let (deep, most) = (r.number("pile: deepest overlap")?, r.number("stop and way")?);
                let words = format!("deepest {deep:.3} px, stop and way of a step {most:.3} px");
                Ok(Finding::new(deep <= most, words))
            }),
        claim("flung at each other without box and gravity they keep their momentum [the contact law]")
            .when(&[
                below("momentum lost without walls", 1e-9),
                above("most energy between them without walls", 1.0),
            ]),
        claim("without contact all of them lie on the floor, in each other [the same run without]")
            .when(&[more("top of the pile", 1.8, "top without contact")]),
    ],
    run,
    draw,
};

fn top(run: &Run) -> f64 {
    let last = run
        .frames
        .iter()
        .filter(|frame| frame.t >= run.t(run.len() - 1));
    let curves = last.flat_map(|frame| &frame.curves);
    most(curves.flat_map(|curve| &curve.nodes).map(|p| p.y))
}

/// Takes a snake out of the box, and the medium away, which takes momentum.
fn free(snake: &mut Snake) -> Result<()> {
    let body = snake.body().clone().with_damping(0.0);
    snake.set_body(body)?;
    Ok(snake.set_world(World::default())?)
}

fn run() -> Result {
    let scene = scene_with("pile", &[])?;
    let (steps, dt) = (scene.plan.until.steps, scene.plan.dt);
    let mut record = Record::default();
    let pictures = [0, steps / 6, steps / 3, steps];
    let seen = watch(&mut group(&scene)?, steps, 50, &pictures)?;
    seen.note(&mut record, "pile", 0.1);
    let kinetic = seen.run.energy("kinetic")?;
    let left = kinetic[kinetic.len() - 1].1 / most(kinetic.iter().map(|p| p.1));
    record.note(
        "kinetic energy at the end [of the greatest]",
        left,
        share(0.3),
    );
    let contact = scene.company.as_ref().and_then(|company| company.contact);
    let stop = contact.map_or(0.0, |contact| contact.stop);
    record.note("stop and way [px]", stop + 2.0 * dt * seen.fastest, 0.01);
    record.note("top of the pile [px]", top(&seen.run), 1.0);
    record.keep_run("pile", seen.run);

    // the same balls without contact
    let mut alone = scene.clone();
    if let Some(company) = &mut alone.company {
        company.contact = None;
    }
    let without = watch(&mut group(&alone)?, steps / 2, steps, &[steps / 2])?;
    record.note("top without contact [px]", top(&without.run), 0.1);
    record.keep_run("without", without.run);

    // and flung at the middle of nothing
    let mut flung = scene.clone();
    let mut balls = vec![(&mut flung.snake, &mut flung.start)];
    let others = flung
        .company
        .iter_mut()
        .flat_map(|company| &mut company.others);
    balls.extend(others.map(|(snake, state)| (snake, state)));
    let mut all = 0.0;
    for (snake, state) in balls {
        free(snake)?;
        let way = DVec2::new(10.0, 12.0) - elastic::center(&state.x, None);
        state.v.fill(0.6 * way + DVec2::new(0.5, 0.2));
        all += snake.body().spacing * state.v.iter().map(|v| v.length()).sum::<f64>();
    }
    let thrown = watch(
        &mut group(&flung)?,
        steps / 5,
        40,
        &[0, steps / 10, steps / 5],
    )?;
    let off = thrown.momentum.1 / all;
    record.note("momentum lost without walls [of Σ|p|]", off, 1e-9);
    let met = most(thrown.run.energy("between")?.iter().map(|p| p.1));
    record.note("most energy between them without walls", met, share(0.05));
    thrown.note(&mut record, "flung", 0.1);
    record.keep_run("flung", thrown.run);
    Ok(record)
}

/// Soft, firm, hard: the first six, the next six, the rest.
fn hardness(snake: usize) -> Color {
    match snake {
        0..=5 => Color::SKY,
        6..=11 => Color::ORANGE,
        _ => Color::RED,
    }
}

fn draw(record: &Record) -> Drawn {
    let in_the_box = |title: String, frame: &Frame| {
        picture(title, &frame.curves, WINDOW, &hardness)
            .with(wall((0.0, 0.0), (20.0, 0.0)))
            .with(wall((0.0, 0.0), (0.0, 24.0)))
            .with(wall((20.0, 0.0), (20.0, 24.0)))
    };
    let mut row = Vec::new();
    for frame in &record.run("pile")?.frames {
        row.push(in_the_box(format!("t = {:.0} s", frame.t), frame));
    }
    for frame in &record.run("without")?.frames {
        row.push(in_the_box(
            format!("without contact, t = {:.0} s", frame.t),
            frame,
        ));
    }
    let mut second = Vec::new();
    for frame in &record.run("flung")?.frames {
        let title = format!("flung, t = {:.0} s", frame.t);
        second.push(picture(
            title,
            &frame.curves,
            [-3.0, -1.0, 26.0, 28.0],
            &hardness,
        ));
    }
    let terms = [
        ("kinetic", "kinetic", Color::BLUE),
        ("elastic", "elastic", Color::GREEN),
        ("outside", "gravity", Color::GREY),
        ("between", "between", Color::YELLOW),
        ("damping", "lost to damping", Color::ORANGE),
        ("contact", "lost in contact", Color::RED),
    ];
    let mut kept = account(record, "pile", "the account of the pile", &terms)?;
    kept.share = 1.7;
    second.push(kept);
    Artefact::only(
        "Above: the pile, and the same run without contact at its right. Below: the same balls flung at each other without \
         a box, and where the energy of the pile goes: the terms stand on each other, and their top stays level.",
        Figure::new("Twenty balls of three hardnesses", 1100.0)
            .with(270.0, row)
            .with(300.0, second),
    )
}

//! Twenty balls of different hardness fall into a box.

use super::course::{Course, account, crowd_of, picture, shots, times, wall, watch};
use crate::demand::{above, below, judged};
use crate::draw::{Color, Figure};
use crate::experiments::motion::changed_scene;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Tolerance};
use glam::DVec2;
use snake::World;

const ID: &str = "soft-pile";

/// What is seen of the box.
const WINDOW: [f64; 4] = [-0.6, -0.6, 20.6, 24.5];

/// The pile, the same without contact, and the same without walls.
pub(crate) const PILE: Experiment = Experiment {
    id: ID,
    title: "Twenty balls in a box",
    place: "beyond",
    question: "Twenty balls of three hardnesses fall into a box, touch, rub and come to lie on each other. Does the \
               account of energies close, do they stay out of each other, and is momentum kept where there is no box?",
    claims: &[
        Claim {
            says: "it runs to its end with the step of the scene and comes to lie",
            source: "the scene pile",
            judge: |r| judged(r, &[below("kinetic energy at the end", 1e-2)]),
        },
        Claim {
            says: "the account closes to rounding",
            source: "the ledger of a crowd",
            judge: |r| judged(r, &[below("pile: gap of the account", 1e-9)]),
        },
        Claim {
            says: "no ball is deeper in another than the stop and the way of a step",
            source: "the contact law",
            judge: |r| {
                let (deep, most) = (
                    r.number("pile: deepest overlap")?,
                    r.number("stop and way")?,
                );
                Ok(Finding::new(
                    deep <= most,
                    format!("deepest {deep:.3} px, stop and way of a step {most:.3} px"),
                ))
            },
        },
        Claim {
            says: "flung at each other without box and gravity they keep their momentum",
            source: "the contact law",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("momentum lost without walls", 1e-9),
                        above("most energy between them without walls", 1.0),
                    ],
                )
            },
        },
        Claim {
            says: "without contact all of them lie on the floor, in each other",
            source: "the same run without",
            judge: |r| {
                let (with, without) = (
                    r.number("top of the pile")?,
                    r.number("top without contact")?,
                );
                Ok(Finding::new(
                    with > 1.8 * without,
                    format!("highest node at {with:.1} px with contact, {without:.1} px without"),
                ))
            },
        },
    ],
    run,
    draw,
};

fn top(course: &Course) -> f64 {
    let end = course.t.last().copied().unwrap_or(0.0);
    let last = course.shots.iter().filter(|shot| shot.0 >= end);
    last.flat_map(|shot| &shot.3)
        .fold(0.0, |most, p| most.max(p.y))
}

fn run() -> Result<Record, SandboxError> {
    let scene = changed_scene(ID, "pile", &[])?;
    let (steps, dt) = (scene.plan.until.steps, scene.plan.dt);
    let mut record = Record::default();
    let pictures = [0, steps / 6, steps / 3, steps];
    let mut crowd = crowd_of(ID, &scene)?;
    let course = watch(ID, &mut crowd, steps, 50, &pictures)?;
    course.note(&mut record, "pile", 0.1);
    let kinetic = |course: &Course| -> Vec<f64> { course.terms.iter().map(|row| row[0]).collect() };
    let most = kinetic(&course).into_iter().fold(0.0, f64::max);
    let left = kinetic(&course).last().copied().unwrap_or(0.0) / most;
    let stop = scene
        .company
        .as_ref()
        .and_then(|company| company.contact)
        .map_or(0.0, |c| c.stop);
    let loose = Tolerance::Relative(0.3);
    record.note("kinetic energy at the end", left, "of the greatest", loose);
    record.note(
        "stop and way",
        stop + 2.0 * dt * course.fastest,
        "px",
        Tolerance::Absolute(0.01),
    );
    record.note(
        "top of the pile",
        top(&course),
        "px",
        Tolerance::Absolute(1.0),
    );
    course.keep(&mut record, "account", "balls");

    // the same balls without contact: a tenth of the pictures and no account
    let mut alone = scene.clone();
    if let Some(company) = &mut alone.company {
        company.contact = None;
    }
    let mut crowd = crowd_of(ID, &alone)?;
    let without = watch(ID, &mut crowd, steps / 2, steps, &[steps / 2])?;
    let end = Tolerance::Absolute(0.1);
    record.note("top without contact", top(&without), "px", end);
    super::course::keep_shots(&mut record, "without", &without.shots);

    // and flung at the middle of nothing
    let mut flung = scene.clone();
    // damping by a medium takes momentum
    let free = |snake: &mut snake::Snake| {
        let body = snake.body().clone().with_damping(0.0);
        snake.set_body(body)?;
        snake.set_world(World::default())
    };
    free(&mut flung.snake).map_err(SandboxError::refused(ID))?;
    let middle = DVec2::new(10.0, 12.0);
    let aim = |x: &[DVec2]| {
        let way = middle - elastic::center(x, None);
        0.6 * way + DVec2::new(0.5, 0.2)
    };
    flung.start.v.fill(aim(&flung.start.x));
    for (snake, state) in flung
        .company
        .iter_mut()
        .flat_map(|company| &mut company.others)
    {
        free(snake).map_err(SandboxError::refused(ID))?;
        state.v.fill(aim(&state.x));
    }
    let everyone = flung.company.iter().flat_map(|company| &company.others);
    let damped = std::iter::once((&flung.snake, &flung.start)).chain(everyone.map(|(a, b)| (a, b)));
    let all: f64 = damped
        .map(|(snake, state)| {
            let speeds: f64 = state.v.iter().map(|v| v.length()).sum();
            snake.body().spacing * speeds
        })
        .sum();
    let mut crowd = crowd_of(ID, &flung)?;
    let thrown = watch(ID, &mut crowd, steps / 5, 40, &[0, steps / 10, steps / 5])?;
    let met = thrown.terms.iter().map(|row| row[3]).fold(0.0, f64::max);
    let off = thrown.momentum.1 / all;
    record.note(
        "momentum lost without walls",
        off,
        "of Σ|p|",
        Tolerance::Absolute(1e-9),
    );
    let like = Tolerance::Relative(0.05);
    record.note("most energy between them without walls", met, "", like);
    thrown.note(&mut record, "flung", 0.1);
    super::course::keep_shots(&mut record, "flung", &thrown.shots);
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

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let balls = shots(record, "balls")?;
    let floor = |panel: crate::draw::Panel| {
        panel
            .with(wall(DVec2::ZERO, DVec2::new(20.0, 0.0)))
            .with(wall(DVec2::ZERO, DVec2::new(0.0, 24.0)))
            .with(wall(DVec2::new(20.0, 0.0), DVec2::new(20.0, 24.0)))
    };
    let mut row = Vec::new();
    for t in times(&balls) {
        row.push(floor(picture(
            format!("t = {t:.0} s"),
            &balls,
            t,
            WINDOW,
            &hardness,
        )));
    }
    let without = shots(record, "without")?;
    for t in times(&without) {
        let title = format!("without contact, t = {t:.0} s");
        row.push(floor(picture(title, &without, t, WINDOW, &hardness)));
    }
    let flung = shots(record, "flung")?;
    let mut second = Vec::new();
    for t in times(&flung) {
        let window = [-3.0, -1.0, 26.0, 28.0];
        second.push(picture(
            format!("flung, t = {t:.0} s"),
            &flung,
            t,
            window,
            &hardness,
        ));
    }
    let mut kept = account(
        record,
        "account",
        "the account of the pile",
        &[
            ("kinetic", "kinetic", Color::BLUE),
            ("elastic", "elastic", Color::GREEN),
            ("outside", "gravity", Color::GREY),
            ("between", "between", Color::YELLOW),
            ("damping", "lost to damping", Color::ORANGE),
            ("contact", "lost in contact", Color::RED),
        ],
    )?;
    kept.share = 1.7;
    second.push(kept);
    let figure = Figure::new("Twenty balls of three hardnesses", 1100.0)
        .with(270.0, row)
        .with(300.0, second);
    Ok(vec![Artefact::figure(
        "Above: the pile, and the same run without contact at its right. Below: the same balls flung at each other without \
         a box, and where the energy of the pile goes: the terms stand on each other, and their top stays level.",
        figure,
    )])
}

//! A bag with gas, and the same bag empty.

use super::course::{account, crowd_of, picture, shots, times, wall, watch};
use crate::demand::{below, judged};
use crate::draw::{Axis, Color, Figure, Line, Panel};
use crate::experiments::motion::changed_scene;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};
use glam::DVec2;
use snake::{Pressure, World};

const ID: &str = "soft-gas";

/// The scene gas-bag, with and without gas, and in empty space.
pub(crate) const GAS: Experiment = Experiment {
    id: ID,
    title: "A bag with gas",
    place: "beyond",
    question: "A skin under tension holds a gas, falls on the floor and bounces. Does it come to rest where its forces balance, \
               and what does the skin do without the gas?",
    claims: &[
        Claim {
            says: "at rest the gas on an upright cut is held by the skin above and below it",
            source: "p H = T₁ + T₂",
            judge: |r| {
                let (gas, skin) = (r.number("p H at rest")?, r.number("T₁ + T₂ at rest")?);
                Ok(Finding::new(
                    (gas / skin - 1.0).abs() < 0.01,
                    format!("{gas:.2} and {skin:.2}"),
                ))
            },
        },
        Claim {
            says: "the account closes to a billionth",
            source: "the ledger of a crowd",
            judge: |r| judged(r, &[below("gas: gap of the account", 1e-9)]),
        },
        Claim {
            says: "thrown into empty space it keeps its momentum",
            source: "the push of a gas has no sum",
            judge: |r| judged(r, &[below("momentum lost without walls", 1e-12)]),
        },
        Claim {
            says: "without gas the skin shrinks to nothing",
            source: "the same run without",
            judge: |r| judged(r, &[below("area without gas after 40 s", 0.2)]),
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let scene = changed_scene(ID, "gas-bag", &[])?;
    let (steps, dt) = (scene.plan.until.steps, scene.plan.dt);
    let refused = SandboxError::refused;
    let mut record = Record::default();
    let mut crowd = crowd_of(ID, &scene)?;
    let full = elastic::signed_area(&scene.start.x);
    let at = |t: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some thousand"
        )]
        let step = (t / dt).round() as u64;
        step
    };
    let every: Vec<u64> = (0..=steps / 10).map(|k| 10 * k).collect();
    let course = watch(ID, &mut crowd, steps, 5, &every)?;
    course.note(&mut record, "gas", 1e-3);
    let areas: Vec<f64> = course
        .shots
        .iter()
        .map(|shot| elastic::signed_area(&shot.3) / full)
        .collect();
    let when: Vec<f64> = course.shots.iter().map(|shot| shot.0).collect();
    record.keep(
        Table::raw("area")
            .with("t", "s", Tolerance::EXACT, when)
            .with("share", "", Tolerance::EXACT, areas),
    );
    let member = &crowd.members()[0];
    let (x, body) = (&member.state().x, member.snake().body());
    let n = x.len();
    let tension =
        |i: usize| body.material.tension.at(i) * x[i].distance(x[(i + 1) % n]) / body.spacing;
    let middle = |i: usize| 0.5 * (x[i] + x[(i + 1) % n]);
    let axis = elastic::center(x, None).x;
    // where the skin meets the upright through the center
    let mut cut = Vec::new();
    for i in 0..n {
        let (a, b) = (x[i].x - axis, x[(i + 1) % n].x - axis);
        if (a < 0.0) != (b < 0.0) {
            cut.push((middle(i).y, tension(i)));
        }
    }
    let (low, high) = (cut[0].0.min(cut[1].0), cut[0].0.max(cut[1].0));
    let pressure = scene
        .snake
        .world()
        .forces
        .iter()
        .find_map(|acting| acting.downcast::<Pressure>());
    let area = elastic::signed_area(x);
    // what it was given with: its pressure at the area of the start
    let p = pressure.map_or(0.0, |p| p.at(area));
    let like = Tolerance::Relative(1e-3);
    record.note("area at rest", area / full, "of the start", like);
    record.note("p H at rest", p * (high - low), "", like);
    record.note("T₁ + T₂ at rest", cut[0].1 + cut[1].1, "", like);
    let mut seen = course;
    let shown = [0.0, 2.2, 2.8, 3.6, 60.0].map(at);
    let shown_at: Vec<f64> = shown
        .iter()
        .map(|&s| crate::real(usize::try_from(s).unwrap_or(0)) * dt)
        .collect();
    seen.shots
        .retain(|shot| shown_at.iter().any(|t| (shot.0 - t).abs() < 0.5 * dt));
    seen.keep(&mut record, "account", "bag");

    // the same without gas
    let mut empty = scene.clone();
    let mut world = empty.snake.world().clone();
    world
        .forces
        .retain(|acting| acting.downcast::<Pressure>().is_none());
    empty.snake.set_world(world).map_err(refused(ID))?;
    let mut crowd = crowd_of(ID, &empty)?;
    let pictures: Vec<u64> = [0.0, 2.2, 2.8, 3.6, 40.0].map(at).to_vec();
    let without = watch(ID, &mut crowd, at(40.0), steps, &pictures)?;
    let left = elastic::signed_area(&crowd.members()[0].state().x).abs() / full;
    record.note(
        "area without gas after 40 s",
        left,
        "of the start",
        Tolerance::Relative(0.3),
    );
    super::course::keep_shots(&mut record, "empty", &without.shots);

    // and thrown into empty space, wobbling
    let mut thrown = scene.clone();
    let mut world = World::default();
    world.forces.extend(
        scene
            .snake
            .world()
            .forces
            .iter()
            .filter(|a| a.downcast::<Pressure>().is_some())
            .cloned(),
    );
    thrown.snake.set_world(world).map_err(refused(ID))?;
    let body = thrown.snake.body().clone().with_damping(0.0);
    thrown.snake.set_body(body).map_err(refused(ID))?;
    let center = elastic::center(&thrown.start.x, None);
    for (v, x) in thrown.start.v.iter_mut().zip(&thrown.start.x) {
        *v = DVec2::new(0.7, 0.3) + 0.3 * (*x - center) * DVec2::new(1.0, -1.0);
    }
    let mut crowd = crowd_of(ID, &thrown)?;
    let flight = watch(ID, &mut crowd, steps, 100, &[])?;
    let off = flight.momentum.1 / flight.momentum.0.length();
    record.note(
        "momentum lost without walls",
        off,
        "of itself",
        Tolerance::Absolute(1e-12),
    );
    flight.note(&mut record, "thrown", 1e-2);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut figure = Figure::new("A bag with gas", 1000.0);
    for (table, words, color) in [("bag", "gas", Color::BLUE), ("empty", "no gas", Color::RED)] {
        let all = shots(record, table)?;
        let panels = times(&all)
            .into_iter()
            .map(|t| {
                let title = format!("{words}, t = {t:.1} s");
                picture(title, &all, t, [-5.2, -0.5, 5.2, 11.5], &|_| color)
                    .with(wall(DVec2::new(-5.2, 0.0), DVec2::new(5.2, 0.0)))
            })
            .collect();
        figure = figure.with(230.0, panels);
    }
    let area = Panel::new(
        "its area",
        Axis::new("t / s", 0.0, 30.0),
        Axis::new("share of the start", 0.3, 1.3),
    )
    .with(Line::new(record.points("area", "t", "share")?, Color::BLUE));
    let kept = account(
        record,
        "account",
        "the account",
        &[
            ("kinetic", "kinetic", Color::BLUE),
            ("elastic", "skin", Color::GREEN),
            ("outside", "gravity and gas", Color::GREY),
            ("damping", "lost to damping", Color::ORANGE),
            ("wall", "floor", Color::YELLOW),
            ("contact", "lost on the floor", Color::RED),
        ],
    )?;
    Ok(vec![Artefact::figure(
        "Above: the bag bounces on its gas, and below it the same skin without. Last: its area, and where the energy goes.",
        figure.with(270.0, vec![area, kept]),
    )])
}

//! A ball through a funnel of two taut strings.

use crate::prelude::*;
use scene::Scene;

/// Whom and how hard.
const BALLS: [(&str, f64); 2] = [("soft", 1.0), ("hard", 8.0)];

/// A soft ball, and a hard one.
pub(crate) const FUNNEL: Experiment = Experiment {
    id: "soft-funnel",
    title: "A ball through a funnel",
    place: "beyond",
    question: "Two taut strings, pinned at both ends, leave an opening narrower than the ball. Does a soft ball pass and \
               a hard one stay, without being pressed through the strings?",
    claims: &[
        claim("the soft ball passes an opening narrower than itself [the scene funnel]")
            .when(&[below("soft: center at the end", 4.0), below("opening", 1.0)]),
        claim("the same ball, eight times as hard, stays in it [the same run with another]")
            .when(&[above("hard: center at the end", 7.0)]),
        claim("overlap stays below the stop and the way of a step [the contact law]").judged(|r| {
            let (a, b) = (
                r.number("soft: deepest overlap")?,
                r.number("hard: deepest overlap")?,
            );
            let most = r.number("stop and way")?;
            let words = format!("{a:.3} px and {b:.3} px, at most {most:.3} px");
            Ok(Finding::new(a.max(b) <= most, words))
        }),
    ],
    run,
    draw,
};

fn hardened(factor: f64) -> Result<Scene> {
    let mut scene = scene_with("funnel", &[])?;
    let mut body = scene.snake.body().clone();
    let of = |value: &elastic::Profile| factor * value.at(0);
    let m = &body.material;
    body.material = elastic::Material::uniform(of(&m.tether), of(&m.tension), of(&m.rigidity));
    scene.snake.set_body(body)?;
    scene.plan.dt /= if factor > 1.0 { 2.0 } else { 1.0 };
    Ok(scene)
}

fn run() -> Result {
    let mut record = Record::default();
    let mut way = f64::INFINITY;
    for (name, factor) in BALLS {
        let scene = hardened(factor)?;
        let dt = scene.plan.dt;
        let chosen = [0.0, 2.0, 3.0, 4.5, 20.0].map(|t| steps_in(t, dt));
        let mut group = group(&scene)?;
        let seen = watch(&mut group, chosen[4], 20, &chosen)?;
        seen.note(&mut record, name, 0.1);
        let center = elastic::center(&group.members()[0].state().x, None);
        record.note(format!("{name}: center at the end [px]"), center.y, 0.3);
        let contact = scene.company.as_ref().and_then(|company| company.contact);
        way = way.min(contact.map_or(0.0, |contact| contact.stop) + 2.0 * dt * seen.fastest);
        record.keep_run(name, seen.run);
    }
    record.note("stop and way [px]", way, 0.05);
    record.note("opening [of the width]", (11.7 - 8.3) / 4.8, ROUNDING);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let terms = [
        ("kinetic", "kinetic", Color::BLUE),
        ("elastic", "elastic", Color::GREEN),
        ("outside", "gravity", Color::GREY),
        ("between", "between", Color::YELLOW),
        ("damping", "lost to damping", Color::ORANGE),
        ("contact", "lost in contact", Color::RED),
    ];
    let mut figure = Figure::new("A ball through a funnel", 1000.0);
    let mut accounts = Vec::new();
    for (name, title, ball) in [
        ("soft", "the soft ball's account", Color::BLUE),
        ("hard", "the hard ball's", Color::RED),
    ] {
        let color = |snake: usize| if snake == 0 { ball } else { Color::INK };
        let row = record.run(name)?.frames.iter().map(|frame| {
            let title = format!("{name}, t = {:.1} s", frame.t);
            picture(title, &frame.curves, [1.0, -0.6, 19.0, 18.0], &color)
                .with(wall((1.0, 0.0), (19.0, 0.0)))
        });
        figure = figure.with(230.0, row.collect());
        accounts.push(account(record, name, title, &terms)?);
    }
    Artefact::only(
        "The funnel is two snakes pinned at both ends. The soft ball passes; eight times as hard it stays. Below: the \
         terms of the account stand on each other, and their top stays level.",
        figure.with(260.0, accounts),
    )
}

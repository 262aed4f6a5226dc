//! A ball through a funnel of two taut strings.

use super::course::{Course, account, crowd_of, picture, shots, times, wall, watch};
use crate::demand::{above, below, judged};
use crate::draw::{Color, Figure, Panel};
use crate::experiments::motion::changed_scene;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Tolerance};
use glam::DVec2;
use scene::Scene;

const ID: &str = "soft-funnel";

/// Whom and how hard.
const BALLS: [(&str, &str, f64); 2] = [("soft", "through", 1.0), ("hard", "stuck", 8.0)];

/// A soft ball, and a hard one.
pub(crate) const FUNNEL: Experiment = Experiment {
    id: ID,
    title: "A ball through a funnel",
    place: "beyond",
    question: "Two taut strings, pinned at both ends, leave an opening narrower than the ball. Does a soft ball pass and \
               a hard one stay, without being pressed through the strings?",
    claims: &[
        Claim {
            says: "the soft ball passes an opening narrower than itself",
            source: "the scene funnel",
            judge: |r| {
                judged(
                    r,
                    &[below("soft: center at the end", 4.0), below("opening", 1.0)],
                )
            },
        },
        Claim {
            says: "the same ball, eight times as hard, stays in it",
            source: "the same run with another",
            judge: |r| judged(r, &[above("hard: center at the end", 7.0)]),
        },
        Claim {
            says: "overlap stays below the stop and the way of a step",
            source: "the contact law",
            judge: |r| {
                let (a, b) = (
                    r.number("soft: deepest overlap")?,
                    r.number("hard: deepest overlap")?,
                );
                let most = r.number("stop and way")?;
                Ok(Finding::new(
                    a.max(b) <= most,
                    format!("{a:.3} px and {b:.3} px, at most {most:.3} px"),
                ))
            },
        },
        Claim {
            says: "the account closes to rounding",
            source: "the ledger of a crowd",
            judge: |r| {
                let (a, b) = (
                    r.number("soft: gap of the account")?,
                    r.number("hard: gap of the account")?,
                );
                Ok(Finding::new(
                    a.max(b) < 1e-9,
                    format!("gaps {a:.0e} and {b:.0e}"),
                ))
            },
        },
    ],
    run,
    draw,
};

fn hardened(factor: f64) -> Result<Scene, SandboxError> {
    let mut scene = changed_scene(ID, "funnel", &[])?;
    let mut body = scene.snake.body().clone();
    let of = |value: &elastic::Profile| factor * value.at(0);
    let m = &body.material;
    body.material = elastic::Material::uniform(of(&m.tether), of(&m.tension), of(&m.rigidity));
    scene
        .snake
        .set_body(body)
        .map_err(SandboxError::refused(ID))?;
    scene.plan.dt /= if factor > 1.0 { 2.0 } else { 1.0 };
    Ok(scene)
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let mut most = f64::INFINITY;
    for (name, table, factor) in BALLS {
        let scene = hardened(factor)?;
        let dt = scene.plan.dt;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some thousand"
        )]
        let at = |t: f64| (t / dt).round() as u64;
        let steps = at(20.0);
        let chosen = [at(0.0), at(2.0), at(3.0), at(4.5), steps];
        let mut crowd = crowd_of(ID, &scene)?;
        let course: Course = watch(ID, &mut crowd, steps, 20, &chosen)?;
        course.note(&mut record, name, 0.1);
        let ball = &crowd.members()[0].state().x;
        let center = elastic::center(ball, None);
        let end = Tolerance::Absolute(0.3);
        record.note(format!("{name}: center at the end"), center.y, "px", end);
        let stop = scene
            .company
            .as_ref()
            .and_then(|c| c.contact)
            .map_or(0.0, |c| c.stop);
        most = most.min(stop + 2.0 * dt * course.fastest);
        course.keep(
            &mut record,
            if factor > 1.0 {
                "account-hard"
            } else {
                "account"
            },
            table,
        );
    }
    record.note("stop and way", most, "px", Tolerance::Absolute(0.05));
    record.note(
        "opening",
        (11.7 - 8.3) / 4.8,
        "of the width",
        Tolerance::ROUNDING,
    );
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut rows = Vec::new();
    for (name, table, _) in BALLS {
        let all = shots(record, table)?;
        let color = move |snake: usize| match (snake, name) {
            (0, "soft") => Color::BLUE,
            (0, _) => Color::RED,
            _ => Color::INK,
        };
        let panels: Vec<Panel> = times(&all)
            .into_iter()
            .map(|t| {
                let title = format!("{name}, t = {t:.1} s");
                picture(title, &all, t, [1.0, -0.6, 19.0, 18.0], &color)
                    .with(wall(DVec2::new(1.0, 0.0), DVec2::new(19.0, 0.0)))
            })
            .collect();
        rows.push(panels);
    }
    let terms = [
        ("kinetic", "kinetic", Color::BLUE),
        ("elastic", "elastic", Color::GREEN),
        ("outside", "gravity", Color::GREY),
        ("between", "between", Color::YELLOW),
        ("damping", "lost to damping", Color::ORANGE),
        ("contact", "lost in contact", Color::RED),
    ];
    let accounts = vec![
        account(record, "account", "the soft ball's account", &terms)?,
        account(record, "account-hard", "the hard ball's", &terms)?,
    ];
    let figure = rows
        .into_iter()
        .fold(Figure::new("A ball through a funnel", 1000.0), |f, row| {
            f.with(230.0, row)
        })
        .with(260.0, accounts);
    Ok(vec![Artefact::figure(
        "The funnel is two snakes pinned at both ends. The soft ball passes; eight times as hard it stays. Below: the \
         terms of the account stand on each other, and their top stays level.",
        figure,
    )])
}

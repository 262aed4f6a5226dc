//! A bouncing ring that dents for good.

use super::course::{account, crowd_of, picture, shots, times, wall, watch};
use crate::demand::{above, judged, less, near};
use crate::draw::{Axis, Color, Figure, Line, Panel};
use crate::experiments::motion::changed_scene;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};
use glam::DVec2;

const ID: &str = "soft-dent";

/// A ring that yields, and one that does not.
pub(crate) const DENT: Experiment = Experiment {
    id: ID,
    title: "A ring that dents for good",
    place: "beyond",
    question: "A ring falls on the floor and bounces. Where an edge is strained beyond the yield strain its rest shape \
               gives way: does it keep the dent, where the elastic ring does not?",
    claims: &[
        Claim {
            says: "the shape at rest is no circle any more",
            source: "plastic flow",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("plastic: width over height of the rest shape", 1.1),
                        near("elastic: width over height of the rest shape", 1.0, 1e-12),
                    ],
                )
            },
        },
        Claim {
            says: "denting takes energy from the bounce",
            source: "plastic flow",
            judge: |r| {
                judged(
                    r,
                    &[less(
                        "plastic: height of the first bounce",
                        0.9,
                        "elastic: height of the first bounce",
                    )],
                )
            },
        },
        Claim {
            says: "the account closes to rounding, what yielding took counted in",
            source: "the ledger of a crowd",
            judge: |r| {
                let (a, b) = (
                    r.number("plastic: gap of the account")?,
                    r.number("elastic: gap of the account")?,
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

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    for name in ["plastic", "elastic"] {
        let mut scene = changed_scene(ID, "dented-ring", &[])?;
        if name == "elastic"
            && let Some(company) = &mut scene.company
        {
            company.upkeep.plastic = None;
        }
        let (steps, dt) = (scene.plan.until.steps, scene.plan.dt);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some thousand"
        )]
        let at = |t: f64| (t / dt).round() as u64;
        let chosen: Vec<u64> = [0.0, 1.7, 2.2, 3.0, 4.0]
            .map(at)
            .into_iter()
            .chain([steps])
            .collect();
        let mut crowd = crowd_of(ID, &scene)?;
        let every: Vec<u64> = (0..=steps / 50).map(|k| 50 * k).collect();
        let course = watch(ID, &mut crowd, steps, 10, &every)?;
        course.note(&mut record, name, 1e-3);
        let rest = &crowd.members()[0].snake().body().rest;
        let wide = |k: usize| {
            let (low, high) = rest
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| {
                    (a.min(p[k]), b.max(p[k]))
                });
            high - low
        };
        let like = Tolerance::Relative(0.01);
        record.note(
            format!("{name}: width over height of the rest shape"),
            wide(0) / wide(1),
            "",
            like,
        );
        // how high its center is, over time; the first bounce is the highest after the lowest of the fall
        let way: Vec<(f64, f64)> = course
            .shots
            .iter()
            .map(|shot| (shot.0, elastic::center(&shot.3, None).y))
            .collect();
        let turn = way
            .windows(2)
            .position(|pair| pair[1].1 > pair[0].1)
            .unwrap_or(0);
        let rise = way[turn..].iter().map(|p| p.1).fold(0.0, f64::max);
        record.note(
            format!("{name}: height of the first bounce"),
            rise,
            "px",
            like,
        );
        let (table, account, center) = match name {
            "plastic" => ("plastic", "account", "center-plastic"),
            _ => ("elastic", "account-elastic", "center-elastic"),
        };
        let mut seen = course;
        let near = |t: f64| {
            chosen.iter().any(|&step| {
                (crate::real(usize::try_from(step).unwrap_or(0)) * dt - t).abs() < 25.0 * dt
            })
        };
        seen.shots.retain(|shot| near(shot.0));
        seen.keep(&mut record, account, table);
        record.keep(
            Table::raw(center)
                .with(
                    "t",
                    "s",
                    Tolerance::EXACT,
                    way.iter().map(|p| p.0).collect(),
                )
                .with(
                    "y",
                    "px",
                    Tolerance::EXACT,
                    way.iter().map(|p| p.1).collect(),
                ),
        );
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut figure = Figure::new("A bouncing ring that dents for good", 1000.0);
    for (name, color) in [("plastic", Color::RED), ("elastic", Color::BLUE)] {
        let all = shots(record, name)?;
        let panels = times(&all)
            .into_iter()
            .map(|t| {
                let title = format!("{name}, t = {t:.1} s");
                picture(title, &all, t, [-4.6, -0.5, 4.6, 12.5], &|_| color)
                    .with(wall(DVec2::new(-4.6, 0.0), DVec2::new(4.6, 0.0)))
            })
            .collect();
        figure = figure.with(230.0, panels);
    }
    let mut height = Panel::new(
        "height of the center",
        Axis::new("t / s", 0.0, 16.0),
        Axis::new("y / px", 0.0, 12.0),
    );
    for (table, name, color) in [
        ("center-plastic", "plastic", Color::RED),
        ("center-elastic", "elastic", Color::BLUE),
    ] {
        height = height.with(Line::new(record.points(table, "t", "y")?, color).named(name));
    }
    let kept = account(
        record,
        "account",
        "the account of the ring that yields",
        &[
            ("kinetic", "kinetic", Color::BLUE),
            ("elastic", "elastic", Color::GREEN),
            ("outside", "gravity", Color::GREY),
            ("between", "between", Color::YELLOW),
            ("damping", "lost to damping", Color::ORANGE),
            ("contact", "lost on the floor", Color::RED),
            ("upkeep", "lost by yielding", Color::PURPLE),
        ],
    )?;
    Ok(vec![Artefact::figure(
        "Above: the ring that yields, and below it the elastic one. Last: how high they bounce, and where the energy goes.",
        figure.with(270.0, vec![height, kept]),
    )])
}

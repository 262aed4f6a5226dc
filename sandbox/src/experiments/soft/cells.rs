//! Two cells that share a border, against Young's equation.

use super::course::{advance, crowd_of, keep_shots, picture, shots, times};
use crate::demand::{above, judged};
use crate::draw::{Axis, Color, Figure, Layer, Line, Panel};
use crate::experiments::motion::changed_scene;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
use snake::Simulation;

const ID: &str = "soft-cells";
const ADHESION: [f64; 6] = [0.0, 0.4, 0.8, 1.2, 1.6, 2.0];

/// The scene two-cells at several adhesions.
pub(crate) const CELLS: Experiment = Experiment {
    id: ID,
    title: "Two cells share a border",
    place: "beyond",
    question: "Two filled skins of tension T gain W per length of border that they share. Do they part at the angle of Young's \
               equation, cos θ = 1 − W/2T, with no overlap?",
    claims: &[
        Claim {
            says: "they part at the angle of Young's equation, up to W = T",
            source: "Young's equation",
            judge: |r| {
                let (found, exact) = (r.column("angles", "cosine")?, r.column("angles", "exact")?);
                let off: Vec<f64> = found
                    .iter()
                    .zip(exact)
                    .map(|(a, b)| (a - b).abs())
                    .collect();
                let most = off[1..].iter().copied().fold(0.0, f64::max);
                Ok(Finding::new(
                    most < 0.02,
                    format!(
                        "cos θ off by {:.3}, {:.3}, {:.3}, {:.3} and {:.3}",
                        off[1], off[2], off[3], off[4], off[5]
                    ),
                ))
            },
        },
        Claim {
            says: "if their skins bend over some nodes: a corner sharper than a right angle holds on to its node",
            source: "the same run without rigidity",
            judge: |r| {
                let sharp = r.number("cosine without rigidity, less the exact one")?;
                let round = r.number("cosine, less the exact one")?;
                Ok(Finding::new(
                    sharp > 5.0 * round.abs(),
                    format!(
                        "at W = T off by {sharp:.3} without rigidity, {round:.3} with the width of three edges"
                    ),
                ))
            },
        },
        Claim {
            says: "they lie a gap apart and nowhere in each other",
            source: "the contact law",
            judge: |r| {
                let (deep, gap) = (
                    r.number("deepest overlap")?,
                    r.number("width of the layer between")?,
                );
                Ok(Finding::new(
                    deep <= 0.0 && (gap / 0.1 - 1.0).abs() < 0.1,
                    format!("overlap {deep}, layer {gap:.4} px of 0.1 px"),
                ))
            },
        },
        Claim {
            says: "without adhesion they touch and no more",
            source: "the same run without",
            judge: |r| judged(r, &[above("centers without adhesion", 6.0)]),
        },
    ],
    run,
    draw,
};

/// The circle through points: least squares of `|p|² − 2 c·p − d`.
fn circle_through(points: &[DVec2]) -> (DVec2, f64) {
    let n = real(points.len());
    let mean = points.iter().sum::<DVec2>() / n;
    let spread = points.iter().map(|p| p.distance_squared(mean)).sum::<f64>() / n;
    let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
    for p in points.iter().map(|p| *p - mean) {
        xx += p.x * p.x;
        xy += p.x * p.y;
        yy += p.y * p.y;
        right += 0.5 * (p.length_squared() - spread) * p;
    }
    let det = xx * yy - xy * xy;
    let at = DVec2::new(yy * right.x - xy * right.y, xx * right.y - xy * right.x) / det;
    (mean + at, (spread + at.length_squared()).sqrt())
}

/// cos θ as the free arcs say it, and the tension of the skin.
fn measure(crowd: &Simulation, gap: f64, range: f64) -> (f64, f64, f64) {
    let (mut centers, mut radius, mut tension) = (Vec::new(), 0.0, 0.0);
    for member in crowd.members() {
        let (x, body) = (&member.state().x, member.snake().body());
        let n = x.len();
        let length: f64 = (0..n).map(|i| x[i].distance(x[(i + 1) % n])).sum();
        tension = body.material.tension.at(0) * length / (body.spacing * real(n));
        let free = x.iter().copied().filter(|p| p.x.abs() > gap + 2.0 * range);
        let (center, r) = circle_through(&free.collect::<Vec<_>>());
        centers.push(center);
        radius = r;
    }
    let apart = centers[0].distance(centers[1]);
    (0.5 * (apart - gap) / radius, tension, apart)
}

/// The two cells at rest.
fn adhering(adhesion: f64, rigidity: &str) -> Result<Simulation, SandboxError> {
    let adhesion = format!("adhesion = {adhesion:.1}");
    let rigidity = format!("rigidity = {rigidity}");
    let changes = [
        ("adhesion = 1.2", adhesion.as_str()),
        ("rigidity = 1e-7", rigidity.as_str()),
    ];
    let scene = changed_scene(ID, "two-cells", &changes)?;
    let mut crowd = crowd_of(ID, &scene)?;
    while crowd.steps() < scene.plan.until.steps {
        advance(ID, &mut crowd)?;
    }
    Ok(crowd)
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let (mut found, mut exact, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    let mut kept = Vec::new();
    let like = Tolerance::Absolute(5e-3);
    let sharp = adhering(2.0, "0.0")?;
    let (cosine, tension, _) = measure(&sharp, 0.1, 0.4);
    let off = cosine - 1.0 + 1.0 / tension;
    record.note("cosine without rigidity, less the exact one", off, "", like);
    record.note("W/T without rigidity", 2.0 / tension, "", like);
    record.note("cosine without rigidity", cosine, "", like);
    for adhesion in ADHESION {
        let crowd = adhering(adhesion, "1e-7")?;
        let (cosine, tension, apart) = measure(&crowd, 0.1, 0.4);
        found.push(cosine);
        exact.push(1.0 - 0.5 * adhesion / tension);
        ratios.push(adhesion / tension);
        for member in crowd.members() {
            kept.push((adhesion, member.id(), true, member.state().x.clone()));
        }
        let like = Tolerance::Absolute(1e-3);
        if adhesion <= 0.0 {
            record.note("centers without adhesion", apart, "px", like);
        } else if adhesion >= 2.0 {
            let off = cosine - 1.0 + 0.5 * adhesion / tension;
            record.note("cosine, less the exact one", off, "", like);
            record.note("deepest overlap", crowd.deepest(), "px", like);
            let inner = |k: usize| {
                let x = &crowd.members()[k].state().x;
                let side = x.iter().filter(|p| p.y.abs() < 0.5 && p.x.abs() < 1.0);
                let (sum, count) = side.fold((0.0, 0.0), |(s, n), p| (s + p.x, n + 1.0));
                sum / count
            };
            let least = inner(1) - inner(0);
            record.note("width of the layer between", least, "px", like);
        }
    }
    keep_shots(&mut record, "cells", &kept);
    record.keep(
        Table::new("angles")
            .with("adhesion", "", Tolerance::EXACT, ADHESION.to_vec())
            .with("W/T", "", Tolerance::Absolute(1e-3), ratios)
            .with("cosine", "", Tolerance::Absolute(5e-3), found)
            .with("exact", "", Tolerance::Absolute(1e-3), exact),
    );
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let all = shots(record, "cells")?;
    let color = |snake: usize| [Color::BLUE, Color::ORANGE][snake % 2];
    let row = times(&all)
        .into_iter()
        .step_by(1)
        .map(|w| {
            picture(
                format!("W = {w:.1}"),
                &all,
                w,
                [-6.4, -4.0, 6.4, 4.0],
                &color,
            )
        })
        .collect();
    let line = (0..=20)
        .map(|k| 0.055 * f64::from(k))
        .map(|w| (w, 1.0 - 0.5 * w));
    let mut points = record.points("angles", "W/T", "cosine")?;
    points.retain(|p| p.0 > 0.0);
    let angle = Panel::new(
        "where they part",
        Axis::new("W / T", 0.0, 1.1),
        Axis::new("cos θ", 0.4, 1.1),
    )
    .with(Line::new(line.collect(), Color::GREEN).named("Young: 1 − W / 2T"))
    .with(Layer::Dots {
        points,
        radius: 3.0,
        color: Color::INK,
        label: "of the arcs".to_owned(),
    })
    .with(Layer::Dots {
        points: vec![(
            record.number("W/T without rigidity")?,
            record.number("cosine without rigidity")?,
        )],
        radius: 3.0,
        color: Color::ORANGE,
        label: "without rigidity".to_owned(),
    });
    let mut close = picture(
        "the end of the border at W = 1.2",
        &all,
        1.2,
        [-1.6, 0.6, 1.6, 2.6],
        &color,
    );
    close.share = 1.0;
    Ok(vec![Artefact::figure(
        "Above: two cells without adhesion, and with more and more. Below: the angle against Young's equation, and a closer look.",
        Figure::new("Two cells share a border", 1100.0)
            .with(170.0, row)
            .with(290.0, vec![angle, close]),
    )])
}

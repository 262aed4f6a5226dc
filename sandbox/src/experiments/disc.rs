//! Report §4.2.2: the force around a disc, axis by axis and of the norm.

use super::pixels::{arrows, grey};
use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Line, Panel, Picture};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use field::{
    EdgeForce, ForceField, Grid, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, edge_force, report_force,
};
use glam::DVec2;

const ID: &str = "sec-4-2-2";
const SIZE: usize = 128;
const RADIUS: f64 = 40.0;
/// Half way between the pixels in the middle.
const MIDDLE: f64 = 63.5;
const BRIGHT: f64 = 100.0;

/// The report's two-dimensional force is not the same in every direction; the corrected one is.
pub(crate) const DISC: Experiment = Experiment {
    id: ID,
    title: "The force around a disc",
    place: "§4.2.2",
    question: "\"We use the same algorithm for the one-dimensional problem\", once along x and once along y. Around \
               a disc every direction should be alike: is it?",
    claims: &[
        Claim {
            says: "the report's pull to the edge depends on the direction",
            source: "D38, D39",
            judge: |r| judged(r, &[above("report: pull; largest over least", 1.2)]),
        },
        Claim {
            says: "and it pulls along the edge as well",
            source: "D39",
            judge: |r| {
                judged(
                    r,
                    &[above(
                        "report: pull along the edge; share of that to it",
                        0.2,
                    )],
                )
            },
        },
        Claim {
            says: "F = ∇|∇(G ∗ S)| of the norm is the same in every direction",
            source: "D39",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("corrected: pull; largest over least", 1.06),
                        below("corrected: pull along the edge; share of that to it", 0.05),
                    ],
                )
            },
        },
        Claim {
            says: "both agree where the edge is upright",
            source: "theory",
            judge: |r| {
                let (a, b) = (
                    r.number("report: pull at 0°")?,
                    r.number("corrected: pull at 0°")?,
                );
                Ok(Finding::new(
                    (a / b - 1.0).abs() < 0.1,
                    format!("{a:.2} and {b:.2} at 0°"),
                ))
            },
        },
    ],
    run,
    draw,
};

/// A disc with a border as smooth as one pixel: sixteen points a pixel.
fn disc() -> Grid {
    Grid::from_shape_fn((SIZE, SIZE), |(row, column)| {
        let covered = (0..16_usize).filter(|point| {
            let x = real(column) + (real(point % 4) - 1.5) / 4.0 - MIDDLE;
            let y = real(row) + (real(point / 4) - 1.5) / 4.0 - MIDDLE;
            x * x + y * y < RADIUS * RADIUS
        });
        50.0 + BRIGHT * real(covered.count()) / 16.0
    })
}

fn run() -> Result<Record, SandboxError> {
    let image = disc();
    let fields = [
        (
            "report",
            report_force(&image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN)
                .map_err(SandboxError::refused(ID))?,
        ),
        (
            "corrected",
            edge_force(&image, &EdgeForce::as_strong_as_the_report())
                .map_err(SandboxError::refused(ID))?,
        ),
    ];
    let mut record = Record::default();
    let degrees: Vec<f64> = (0..=360).step_by(3).map(real).collect();
    let mut table = Table::new("around").with("direction", "°", Tolerance::EXACT, degrees.clone());
    for (name, field) in &fields {
        let found: Vec<(f64, f64)> = degrees.iter().map(|&degree| pulls(field, degree)).collect();
        let (to, along): (Vec<f64>, Vec<f64>) = found.into_iter().unzip();
        let most = to.iter().copied().fold(0.0, f64::max);
        let least = to.iter().copied().fold(f64::INFINITY, f64::min);
        let sideways = along.iter().copied().fold(0.0, f64::max);
        let unit = "M px/T²";
        record.note(
            format!("{name}: pull at 0°"),
            to[0],
            unit,
            Tolerance::Relative(1e-9),
        );
        record.note(
            format!("{name}: pull; largest over least"),
            most / least,
            "",
            Tolerance::ROUNDING,
        );
        record.note(
            format!("{name}: pull along the edge; share of that to it"),
            sideways / most,
            "",
            Tolerance::ROUNDING,
        );
        table = table
            .with(
                format!("{name}: to the edge"),
                unit,
                Tolerance::Relative(1e-9),
                to,
            )
            .with(
                format!("{name}: along the edge"),
                unit,
                Tolerance::ROUNDING,
                along,
            );
        let (fx, fy) = field.components();
        record.keep_grid(format!("{name} x"), fx);
        record.keep_grid(format!("{name} y"), fy);
    }
    record.keep(table);
    record.keep_grid("image", image);
    Ok(record)
}

/// The strongest pull to the edge and along it, in one direction from the middle, 12 px about the edge.
fn pulls(field: &ForceField, degree: f64) -> (f64, f64) {
    let outward = DVec2::from_angle(degree.to_radians());
    let along = outward.perp();
    let mut best = (0.0_f64, 0.0_f64);
    for step in 0..=240 {
        let distance = -12.0 + 0.1 * real(step);
        let force = field.at(DVec2::splat(MIDDLE) + outward * (RADIUS + distance));
        best.0 = best.0.max(force.dot(outward) * -distance.signum());
        best.1 = best.1.max(force.dot(along).abs());
    }
    best
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let image = record.grid("image")?;
    let window = [64, 64, 62, 62];
    let extent = [63.5, 63.5, 125.5, 125.5];
    let cut = grey(&image.slice(ndarray::s![64..126, 64..126]).to_owned());
    let edge: Vec<(f64, f64)> = (0..=90)
        .map(|degree| DVec2::splat(MIDDLE) + DVec2::from_angle(real(degree).to_radians()) * RADIUS)
        .map(|p| (p.x, p.y))
        .collect();
    let quarter = |title: &str, name: &str| -> Result<Panel, SandboxError> {
        let mut panel = Panel::new(
            title,
            Axis::new("x / px", extent[0], extent[2]),
            Axis::new("y / px", extent[3], extent[1]),
        )
        .equal();
        panel.grid = false;
        let (fx, fy) = (
            record.grid(&format!("{name} x"))?,
            record.grid(&format!("{name} y"))?,
        );
        Ok(panel
            .with(Picture::new(cut.clone()).over(extent).faded(0.4))
            .with(Line::new(edge.clone(), Color::GREEN).weighing(0.8))
            .with(arrows(fx, fy, 3, 0.02, window)))
    };
    let mut around = Panel::new(
        "about the whole disc",
        Axis::new("direction from the middle / °", 0.0, 360.0).with_ticks(9),
        Axis::new("strongest pull / (M px/T²)", 0.0, 26.0),
    )
    .legend_at(Corner::TopRight);
    for (name, color, words) in [
        ("report", Color::RED, "report"),
        ("corrected", Color::BLUE, "corrected"),
    ] {
        let to = record.points("around", "direction", &format!("{name}: to the edge"))?;
        let along = record.points("around", "direction", &format!("{name}: along the edge"))?;
        around = around
            .with(Line::new(to, color).named(format!("{words}: to the edge")))
            .with(
                Line::new(along, color)
                    .dashed()
                    .named(format!("{words}: along the edge")),
            );
    }
    let figure = Figure::new(
        "§4.2.2  The force around a disc, 20 passes, contrast 100",
        860.0,
    )
    .with(
        420.0,
        vec![
            quarter("the report's: axis by axis", "report")?,
            quarter("corrected: of the norm", "corrected")?,
        ],
    )
    .with(270.0, vec![around]);
    Ok(vec![Artefact::figure(
        "Above: a quarter of the disc with both fields. Below: how strong each pulls to the edge, and along it.",
        figure,
    )])
}

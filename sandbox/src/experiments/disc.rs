//! Report §4.2.2: the force around a disc, axis by axis and of the norm.

use crate::prelude::*;
use field::{
    EdgeForce, ForceField, Grid, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, edge_force, report_force,
};

const SIZE: usize = 128;
const RADIUS: f64 = 40.0;
/// Half way between the pixels in the middle.
const MIDDLE: f64 = 63.5;
const BRIGHT: f64 = 100.0;

/// The report's two-dimensional force is not the same in every direction; the corrected one is.
pub(crate) const DISC: Experiment = Experiment {
    id: "sec-4-2-2",
    title: "The force around a disc",
    place: "§4.2.2",
    question: "\"We use the same algorithm for the one-dimensional problem\", once along x and once along y. Around \
               a disc every direction should be alike: is it?",
    claims: &[
        claim("the report's pull to the edge depends on the direction [D38, D39]")
            .when(&[above("report: pull; largest over least", 1.2)]),
        claim("and it pulls along the edge as well [D39]").when(&[above(
            "report: pull along the edge; share of that to it",
            0.2,
        )]),
        claim("F = ∇|∇(G ∗ S)| of the norm is the same in every direction [D39]").when(&[
            below("corrected: pull; largest over least", 1.06),
            below("corrected: pull along the edge; share of that to it", 0.05),
        ]),
        claim("both agree where the edge is upright [theory]").when(&[like(
            "report: pull at 0°",
            "corrected: pull at 0°",
            0.1,
        )]),
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

fn run() -> Result {
    let image = disc();
    let report = report_force(&image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN)?;
    let corrected = edge_force(&image, &EdgeForce::as_strong_as_the_report())?;
    let mut record = Record::default();
    let degrees: Vec<f64> = (0..=360).step_by(3).map(real).collect();
    let mut table = Table::new("around").exact("direction [°]", degrees.clone());
    for (name, field) in [("report", report), ("corrected", corrected)] {
        let found = degrees.iter().map(|&degree| pulls(&field, degree));
        let (to, along): (Vec<f64>, Vec<f64>) = found.unzip();
        let (largest, lowest) = (most(to.iter().copied()), least(to.iter().copied()));
        let sideways = most(along.iter().copied()) / largest;
        let mut own = record.under(name);
        own.note("pull at 0° [M px/T²]", to[0], share(1e-9));
        let uneven = largest / lowest;
        own.note("pull; largest over least", uneven, ROUNDING);
        let askew = format!("{name}: pull along the edge; share of that to it");
        record.note(askew, sideways, ROUNDING);
        table = table
            .with(format!("{name}: to the edge [M px/T²]"), share(1e-9), to)
            .with(format!("{name}: along the edge [M px/T²]"), ROUNDING, along);
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

fn draw(record: &Record) -> Drawn {
    let image = record.grid("image")?;
    let extent = [63.5, 63.5, 125.5, 125.5];
    let cut = grey(&image.slice(ndarray::s![64..126, 64..126]).to_owned());
    let edge = (0..=90).map(|degree| DVec2::from_angle(real(degree).to_radians()) * RADIUS);
    let edge: Vec<DVec2> = edge.map(|p| DVec2::splat(MIDDLE) + p).collect();
    let quarter = |title: &str, name: &str| -> Result<Panel> {
        let (x, y) = (
            ("x / px", extent[0], extent[2]),
            ("y / px", extent[3], extent[1]),
        );
        let mut panel = plot(title, x, y).equal();
        panel.grid = false;
        let fx = record.grid(&format!("{name} x"))?;
        let fy = record.grid(&format!("{name} y"))?;
        Ok(panel
            .with(Picture::new(cut.clone()).over(extent).faded(0.4))
            .with(line(pairs(&edge), Color::GREEN).weighing(0.8))
            .with(arrows(fx, fy, 3, 0.02, [64, 64, 62, 62])))
    };
    let direction = Axis::new("direction from the middle / °", 0.0, 360.0).with_ticks(9);
    let pull = ("strongest pull / (M px/T²)", 0.0, 26.0);
    let mut around = plot("about the whole disc", direction, pull);
    for (name, color) in [("report", Color::RED), ("corrected", Color::BLUE)] {
        for words in ["to the edge", "along the edge"] {
            let name = format!("{name}: {words}");
            let pull = line(record.points("around", "direction", &name)?, color);
            let sideways = words == "along the edge";
            around = around.with(if sideways { pull.dashed() } else { pull }.named(name));
        }
    }
    let above = vec![
        quarter("the report's: axis by axis", "report")?,
        quarter("corrected: of the norm", "corrected")?,
    ];
    Artefact::only(
        "Above: a quarter of the disc with both fields. Below: how strong each pulls to the edge, and along it.",
        Figure::new(
            "§4.2.2  The force around a disc, 20 passes, contrast 100",
            860.0,
        )
        .with(420.0, above)
        .with(270.0, vec![around]),
    )
}

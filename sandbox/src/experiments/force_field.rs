//! Figure 4.5: the force field of a photograph, as arrows and as colors (report §4.2.2).

use super::pixels::{arrows, grey, shrunk, signed, strongest_arrows};
use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Figure, Line, Panel, Picture};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use elastic::normals;
use field::{
    EdgeForce, ForceField, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, edge_force, report_force,
};
use glam::DVec2;

const ID: &str = "fig-4-5";
/// The part of the picture that is looked at closely: left, top, columns, rows.
const CLOSE: [usize; 4] = [330, 35, 110, 110];

/// Figure 4.5: the input image and its force field.
pub(crate) const FIELD: Experiment = Experiment {
    id: ID,
    title: "The force field of the apple",
    place: "Figure 4.5",
    question: "Does the force made from a photograph point to the contour of the apple from both sides, and leave \
               alone what is far from any edge? (The report's own picture is not to be had; another apple stands \
               in. Its contour was drawn by hand.)",
    claims: &[
        Claim {
            says: "the forces point to the contour from inside and from outside",
            source: "report §4.2.2",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("report: pulled outward 4 px inside", 0.7),
                        above("report: pulled inward 4 px outside", 0.7),
                    ],
                )
            },
        },
        Claim {
            says: "the force vanishes on the contour, within the care it was drawn with",
            source: "report §4.2.2",
            judge: |r| {
                judged(
                    r,
                    &[below(
                        "corrected: median distance of the zero from the contour",
                        2.0,
                    )],
                )
            },
        },
        Claim {
            says: "far from the contour the force is weak; not nothing, as cloth and skin have edges of their own",
            source: "report §4.2.1",
            judge: |r| {
                let share =
                    r.number("report: median far from the contour; share of that at 4 px")?;
                Ok(Finding::new(
                    share < 1.0 / 3.0,
                    format!(
                        "beyond 25 px the median force is {:.1} % of that at 4 px",
                        100.0 * share
                    ),
                ))
            },
        },
        Claim {
            says: "the corrected field does the same",
            source: "D38, D39",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("corrected: pulled outward 4 px inside", 0.7),
                        above("corrected: pulled inward 4 px outside", 0.7),
                    ],
                )
            },
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let picture = scene::picture("apple").map_err(SandboxError::refused(ID))?;
    let contour = scene::contour("apple-truth")
        .map_err(SandboxError::refused(ID))?
        .first()
        .to_vec();
    let image = picture.levels();
    let report = report_force(image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN)
        .map_err(SandboxError::refused(ID))?;
    let corrected = edge_force(image, &EdgeForce::as_strong_as_the_report())
        .map_err(SandboxError::refused(ID))?;
    let outward = {
        let normals = normals(&contour, true);
        // the hand contour may run either way; outward is what makes the area positive
        let sign = if elastic::signed_area(&contour) < 0.0 {
            -1.0
        } else {
            1.0
        };
        normals
            .into_iter()
            .map(|n| n * sign)
            .collect::<Vec<DVec2>>()
    };
    let mut record = Record::default();
    for (name, field) in [("report", &report), ("corrected", &corrected)] {
        measure(&mut record, name, field, &contour, &outward);
    }
    let (fx, fy) = report.components();
    record.keep_grid("report x", fx);
    record.keep_grid("report y", fy);
    let (fx, fy) = corrected.components();
    record.keep_grid("corrected x", fx);
    record.keep_grid("corrected y", fy);
    record.keep_grid("image", image.clone());
    record.keep(
        Table::raw("contour")
            .with(
                "x",
                "px",
                Tolerance::EXACT,
                contour.iter().map(|p| p.x).collect(),
            )
            .with(
                "y",
                "px",
                Tolerance::EXACT,
                contour.iter().map(|p| p.y).collect(),
            ),
    );
    Ok(record)
}

fn measure(
    record: &mut Record,
    name: &str,
    field: &ForceField,
    contour: &[DVec2],
    outward: &[DVec2],
) {
    let along = |i: usize, distance: f64| {
        let at = contour[i] + outward[i] * distance;
        field.at(at).dot(outward[i])
    };
    let count = real(contour.len());
    let share = |test: &dyn Fn(usize) -> bool| {
        real((0..contour.len()).filter(|&i| test(i)).count()) / count
    };
    let tolerance = Tolerance::Absolute(0.003); // one point of 400 may go over to the other side
    record.note(
        format!("{name}: pulled outward 4 px inside"),
        share(&|i| along(i, -4.0) > 0.0),
        "",
        tolerance,
    );
    record.note(
        format!("{name}: pulled inward 4 px outside"),
        share(&|i| along(i, 4.0) < 0.0),
        "",
        tolerance,
    );
    // the nearest place where the pull turns from outward to inward
    let mut zeros: Vec<f64> = (0..contour.len())
        .map(|i| {
            (0..160)
                .map(|step| -8.0 + 0.1 * real(step))
                .filter(|&d| along(i, d) > 0.0 && along(i, d + 0.1) <= 0.0)
                .map(|d| (d + 0.05).abs())
                .fold(8.0, f64::min)
        })
        .collect();
    record.note(
        format!("{name}: median distance of the zero from the contour"),
        median(&mut zeros),
        "px",
        Tolerance::Absolute(0.11),
    );
    let mut near: Vec<f64> = (0..contour.len()).map(|i| along(i, -4.0).abs()).collect();
    let mut far = Vec::new();
    for row in (0..field.height()).step_by(4) {
        for column in (0..field.width()).step_by(4) {
            let at = DVec2::new(real(column), real(row));
            if contour.iter().all(|p| p.distance(at) > 25.0) {
                far.push(field.at(at).length());
            }
        }
    }
    record.note(
        format!("{name}: median far from the contour; share of that at 4 px"),
        median(&mut far) / median(&mut near),
        "",
        Tolerance::Absolute(1e-6),
    );
    record.note(
        format!("{name}: largest force"),
        field.largest(),
        "M px/T²",
        Tolerance::Relative(1e-9),
    );
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let image = record.grid("image")?;
    let (rows, columns) = image.dim();
    let whole = [-0.5, -0.5, real(columns) - 0.5, real(rows) - 0.5];
    let thirds = [
        -0.5,
        -0.5,
        real(columns / 3 * 3) - 0.5,
        real(rows / 3 * 3) - 0.5,
    ];
    let small = grey(&shrunk(image, 2));
    let contour = record.points("contour", "x", "y")?;
    let panel = |title: &str| Panel::pixels(title, columns, rows);
    let (fx, fy) = (record.grid("report x")?, record.grid("report y")?);
    let strongest = strongest_arrows(fx, fy, 16, 0.18);

    let close = |title: &str, x: &str, y: &str| -> Result<Panel, SandboxError> {
        let [left, top, width, height] = CLOSE;
        let cut = image
            .slice(ndarray::s![top..top + height, left..left + width])
            .to_owned();
        let extent = [
            real(left) - 0.5,
            real(top) - 0.5,
            real(left + width) - 0.5,
            real(top + height) - 0.5,
        ];
        let mut panel = Panel::new(
            title,
            Axis::new("x / px", extent[0], extent[2]),
            Axis::new("y / px", extent[3], extent[1]),
        )
        .equal();
        panel.grid = false;
        Ok(panel
            .with(Picture::new(grey(&cut)).over(extent).faded(0.45))
            .with(
                Line::new(contour.clone(), Color::GREEN)
                    .closed()
                    .weighing(0.8),
            )
            .with(arrows(record.grid(x)?, record.grid(y)?, 5, 0.02, CLOSE)))
    };
    let figure = Figure::new("Figure 4.5  a) The input image; b) the force field", 860.0)
        .with(
            410.0,
            vec![
                panel("a) the input image").with(Picture::new(small.clone()).over(whole)),
                panel("b) the force field as arrows")
                    .with(Picture::new(small).over(whole).faded(0.35))
                    .with(strongest),
            ],
        )
        .with(
            410.0,
            vec![
                panel("x-force: blue to the left, orange to the right")
                    .with(Picture::new(signed(&shrunk(fx, 3), 0.995)).over(thirds)),
                panel("y-force: blue up, orange down")
                    .with(Picture::new(signed(&shrunk(fy, 3), 0.995)).over(thirds)),
            ],
        );
    let nearer = Figure::new("Figure 4.5  A closer look at the upper right flank", 860.0).with(
        430.0,
        vec![
            close("the report's field, axis by axis", "report x", "report y")?,
            close(
                "corrected: the gradient of one scalar",
                "corrected x",
                "corrected y",
            )?,
        ],
    );
    Ok(vec![
        Artefact::figure(
            "a) The input image. b) The force field as arrows, as long as the root of the force, one where it is strongest in each 16 px. Below: its two \
             components as colors.",
            figure,
        ),
        Artefact::further(
            "close",
            "Arrows every 5 px with the contour drawn by hand: the report's field, and the corrected one.",
            crate::Body::Figure(nearer),
        ),
    ])
}

//! Every kind of field on one page: the U and the apple, as arrows, as colors, by strength.

use super::super::pixels::{arrows, grey, shrunk, signed};
use super::synthetic::{AROUND, OBJECT, SIZE, u_corners, u_shape};
use crate::demand::{above, judged};
use crate::draw::{Color, Figure, Panel, Picture, sequential};
use crate::{
    Artefact, Body, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real,
};
use field::{
    Across, EdgeForce, Falloff, FieldError, FlowRule, ForceField, Grid, Line, REPORT_GAIN,
    REPORT_PASSES, REPORT_SCALE, Smoothing, TwoRegions, VectorFlow, distance_force, edge_force,
    edge_pixels, edge_stages, gradient_force, line_strength, mask_x, mask_y,
    multiscale_edge_strength, report_force, termination_strength, vector_convolution, vector_flow,
};
use glam::DVec2;
use ndarray::{Array2, s};

const ID: &str = "sec-4-2-kinds";
/// How a kind is made: its name, and the function of the picture.
type Kind = (&'static str, fn(&Grid) -> Result<ForceField, FieldError>);

const KINDS: [Kind; 9] = [
    ("report", |image| {
        report_force(image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN)
    }),
    ("corrected", |image| {
        edge_force(image, &EdgeForce::as_strong_as_the_report())
    }),
    ("several scales", |image| {
        gradient_force(
            &multiscale_edge_strength(image, &[1.0, 2.0, 4.0, 8.0, 16.0])?,
            1.0,
        )
    }),
    ("bright line", |image| {
        gradient_force(&line_strength(image, WIDE, Line::Bright)?, 1.0)
    }),
    ("corners", |image| {
        gradient_force(&termination_strength(image, WIDE, 1.0)?, 1.0)
    }),
    ("distance", |image| {
        distance_force(&edge_pixels(image, FINE, LEAST)?, 1.0, f64::INFINITY)
    }),
    ("GVF", |image| {
        flow(image, FlowRule::Plain { smoothness: 0.2 })
    }),
    ("generalised GVF", |image| {
        flow(image, FlowRule::Generalised { spread: 0.05 })
    }),
    ("VFC", |image| {
        vector_convolution(&strength(image)?, Falloff::Power { exponent: 1.7 }, 64.0)
    }),
];
const WIDE: Smoothing = Smoothing::Gaussian(3.0);
const FINE: Smoothing = Smoothing::Gaussian(1.5);
/// The apple is shown this many times smaller.
const SMALL: usize = 5;
/// Grey levels per pixel from which an edge counts.
const LEAST: f64 = 8.0;

fn strength(image: &Grid) -> Result<Grid, FieldError> {
    let rule = EdgeForce {
        smoothing: FINE,
        gain: 1.0,
    };
    Ok(edge_stages(image, &rule)?.strength)
}

fn flow(image: &Grid, rule: FlowRule) -> Result<ForceField, FieldError> {
    Ok(vector_flow(
        &strength(image)?,
        &VectorFlow {
            rule,
            residual: 1e-5,
        },
    )?
    .field)
}

/// Those that pull to the outline from both sides, and those that have an energy.
const TO_EDGES: [&str; 7] = [
    "report",
    "corrected",
    "several scales",
    "distance",
    "GVF",
    "generalised GVF",
    "VFC",
];
const GRADIENTS: [&str; 5] = [
    "corrected",
    "several scales",
    "bright line",
    "corners",
    "distance",
];

/// A gallery of fields.
pub(crate) const FIELDS: Experiment = Experiment {
    id: ID,
    title: "Kinds of field",
    place: "§4.2",
    question: "What does each kind of field look like, on a U whose outline is known and on a photograph? Where does \
               it point, how far does it reach, and is it the gradient of anything?",
    claims: &[
        Claim {
            says: "those made for outlines pull to it from 3 px inside and 3 px outside, away from the corners",
            source: "theory",
            judge: |r| {
                let shares = numbers(r, &TO_EDGES, "pulled to the outline at 3 px")?;
                let least = shares.iter().copied().fold(1.0, f64::min);
                Ok(Finding::new(
                    least > 0.99,
                    format!("at {:.1} % of the places at least", 100.0 * least),
                ))
            },
        },
        Claim {
            says: "the bright-line force does not: it pulls into the object from both sides",
            source: "theory",
            judge: |r| {
                let share = r.number("bright line: pulled to the outline at 3 px")?;
                Ok(Finding::new(
                    (0.4..0.6).contains(&share),
                    format!(
                        "to the outline at {:.0} % of the places: those outside",
                        100.0 * share
                    ),
                ))
            },
        },
        Claim {
            says: "the corner force is strong at the eight corners only",
            source: "theory",
            judge: |r| {
                judged(
                    r,
                    &[above(
                        "corners: part of the force within 15 px of a corner",
                        0.95,
                    )],
                )
            },
        },
        Claim {
            says: "the edge force is felt in a strip along the outline; distance, GVF and VFC nearly everywhere",
            source: "theory §10.2",
            judge: |r| {
                let near = numbers(
                    r,
                    &["report", "corrected"],
                    "felt in this part of the picture",
                )?;
                let far = numbers(
                    r,
                    &["distance", "GVF", "generalised GVF", "VFC"],
                    "felt in this part of the picture",
                )?;
                let most = near.iter().copied().fold(0.0, f64::max);
                let least = far.iter().copied().fold(1.0, f64::min);
                Ok(Finding::new(
                    most < 0.35 && least > 0.85,
                    format!(
                        "more than 1 % of the largest force on {:.0} % of the picture at most, against {:.0} % at least",
                        100.0 * most,
                        100.0 * least
                    ),
                ))
            },
        },
        Claim {
            says: "forces made from a strength have no curl; the report's and the flows are no gradients",
            source: "D39",
            judge: |r| {
                let none = numbers(r, &GRADIENTS, "curl")?;
                let some = numbers(r, &["report", "GVF", "generalised GVF"], "curl")?;
                let most = none.iter().copied().fold(0.0, f64::max);
                let least = some.iter().copied().fold(1.0, f64::min);
                Ok(Finding::new(
                    most < 1e-12 && least > 0.01,
                    format!("curl over slope {most:.0e} at most, against {least:.3} at least"),
                ))
            },
        },
    ],
    run,
    draw,
};

fn numbers(record: &Record, kinds: &[&str], what: &str) -> Result<Vec<f64>, SandboxError> {
    let one = |kind: &&str| record.number(&format!("{kind}: {what}"));
    kinds.iter().map(one).collect()
}

/// Points of the outline farther than 16 px from a corner, with the outward normal.
fn straight() -> Vec<(DVec2, DVec2)> {
    let corners = u_corners();
    let mut out = Vec::new();
    for (i, &from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % corners.len()];
        let along = (to - from).normalize();
        let mut way = 16.0;
        while way < from.distance(to) - 16.0 {
            out.push((from + along * way, DVec2::new(along.y, -along.x)));
            way += 1.0;
        }
    }
    out
}

/// Root mean square of the curl over that of all slopes, off the border: by the stencil that made the force.
fn curl(field: &ForceField) -> f64 {
    let (fx, fy) = field.components();
    let (rows, columns) = fx.dim();
    let part = |grid: &Grid| grid.slice(s![4..rows - 4, 4..columns - 4]).to_owned();
    let slopes = [
        mask_x(&fx, Across::Mirror),
        mask_y(&fx, Across::Mirror),
        mask_x(&fy, Across::Mirror),
        mask_y(&fy, Across::Mirror),
    ]
    .map(|slope| part(&slope));
    let square = |grid: &Array2<f64>| grid.iter().map(|v| v * v).sum::<f64>();
    let turning = square(&(&slopes[2] - &slopes[1]));
    (turning / slopes.iter().map(square).sum::<f64>()).sqrt()
}

fn measure(record: &mut Record, name: &str, field: &ForceField) {
    let straight = straight();
    let pulled = straight
        .iter()
        .flat_map(|&(at, outward)| [(at, outward, -3.0), (at, outward, 3.0)])
        .filter(|&(at, outward, way)| field.at(at + outward * way).dot(outward) * way < 0.0)
        .count();
    let share = Tolerance::Absolute(1e-3);
    record.note(
        format!("{name}: pulled to the outline at 3 px"),
        real(pulled) / real(2 * straight.len()),
        "of the places",
        share,
    );
    let (fx, fy) = field.components();
    let size = Grid::from_shape_fn(fx.dim(), |at| fx[at].hypot(fy[at]));
    let least = 0.01 * field.largest();
    let felt = size.iter().filter(|&&size| size > least).count();
    record.note(
        format!("{name}: felt in this part of the picture"),
        real(felt) / real(size.len()),
        "",
        share,
    );
    record.note(
        format!("{name}: curl"),
        curl(field),
        "of the slope",
        Tolerance::Absolute(1e-5),
    );
    if name == "corners" {
        let corners = u_corners();
        let near = size.indexed_iter().filter(|((row, column), _)| {
            let p = DVec2::new(real(*column), real(*row));
            corners.iter().any(|corner| corner.distance(p) < 15.0)
        });
        record.note(
            "corners: part of the force within 15 px of a corner",
            near.map(|(_, size)| size).sum::<f64>() / size.sum(),
            "",
            share,
        );
    }
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let no = || SandboxError::refused::<FieldError>(ID);
    let u = u_shape(ID)?;
    let apple = scene::picture("apple").map_err(SandboxError::refused(ID))?;
    let apple = shrunk(apple.levels(), SMALL);
    for (name, make) in KINDS {
        for (picture, image) in [("U", &u), ("apple", &apple)] {
            let field = make(image).map_err(no())?;
            if picture == "U" {
                measure(&mut record, name, &field);
            }
            let (fx, fy) = field.components();
            record.keep_grid(format!("{picture}: {name} x"), fx);
            record.keep_grid(format!("{picture}: {name} y"), fy);
        }
    }
    // two regions need a curve; about a circle in the middle of the picture their push is a grid too
    for (picture, image) in [("U", &u), ("apple", &apple)] {
        let (rows, columns) = image.dim();
        let middle = 0.5 * DVec2::new(real(columns), real(rows)) - 0.5;
        let circle = elastic::circle(middle, 0.3 * real(rows.min(columns)), 120);
        let gain = 1.0 / (OBJECT - AROUND).powi(2);
        let regions = TwoRegions::new(image, gain).map_err(no())?;
        let means = regions.means(&circle);
        let push = Grid::from_shape_fn(image.dim(), |(row, column)| {
            regions.normal_force(DVec2::new(real(column), real(row)), &means)
        });
        record.keep_grid(format!("{picture}: push"), push);
        record.keep(
            Table::raw(if picture == "U" {
                "U-circle"
            } else {
                "apple-circle"
            })
            .with(
                "x",
                "px",
                Tolerance::EXACT,
                circle.iter().map(|p| p.x).collect(),
            )
            .with(
                "y",
                "px",
                Tolerance::EXACT,
                circle.iter().map(|p| p.y).collect(),
            ),
        );
    }
    record.keep_grid("U: image", u);
    record.keep_grid("apple: image", apple);
    Ok(record)
}

/// Direction as hue and the root of the strength as saturation; few enough colors for a small file.
fn wheel(fx: &Grid, fy: &Grid) -> Array2<Color> {
    let image = io::paint::wheel(fx, fy);
    let few = |level: u8| if level > 240 { 255 } else { level / 28 * 28 };
    Array2::from_shape_fn(fx.dim(), |(row, column)| {
        let [x, y] = [column, row].map(|place| u32::try_from(place).unwrap_or(0));
        let [red, green, blue] = image.get_pixel(x, y).0.map(few);
        Color(red, green, blue)
    })
}

/// The root of the strength, dark where it is strong.
fn size(fx: &Grid, fy: &Grid) -> Array2<Color> {
    let size = Grid::from_shape_fn(fx.dim(), |at| fx[at].hypot(fy[at]));
    let most = size.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    size.mapv(|size| sequential(((size / most).sqrt() * 20.0).round() / 20.0))
}

/// Three rows for five kinds: arrows, direction as color, strength.
fn page(
    record: &Record,
    picture: &str,
    title: &str,
    (every, factor): (usize, usize),
) -> Result<Figure, SandboxError> {
    let image = record.grid(&format!("{picture}: image"))?;
    let (rows, columns) = image.dim();
    let height = 188.0 * real(rows) / real(columns) + 22.0;
    let extent = [
        -0.5,
        -0.5,
        real(columns / factor * factor) - 0.5,
        real(rows / factor * factor) - 0.5,
    ];
    let ground = grey(&shrunk(image, factor));
    let panel = |title: &str| Panel::pixels(title, columns, rows).bare();
    let mut figure = Figure::new(title, 960.0);
    for block in [&KINDS[..5], &KINDS[5..]] {
        let mut rows = [Vec::new(), Vec::new(), Vec::new()];
        for (name, _) in block {
            let fx = record.grid(&format!("{picture}: {name} x"))?;
            let fy = record.grid(&format!("{picture}: {name} y"))?;
            let (small_x, small_y) = (shrunk(fx, factor), shrunk(fy, factor));
            let (rows_all, columns_all) = image.dim();
            rows[0].push(
                panel(name)
                    .with(Picture::new(ground.clone()).over(extent).faded(0.4))
                    .with(arrows(fx, fy, every, 0.02, [0, 0, columns_all, rows_all])),
            );
            rows[1].push(
                panel("direction").with(Picture::new(wheel(&small_x, &small_y)).over(extent)),
            );
            rows[2]
                .push(panel("strength").with(Picture::new(size(&small_x, &small_y)).over(extent)));
        }
        if block.len() < 5 {
            let push = signed(
                &shrunk(record.grid(&format!("{picture}: push"))?, factor),
                0.995,
            );
            let circle = record.points(&format!("{picture}-circle"), "x", "y")?;
            let circle = crate::draw::Line::new(circle, Color::INK).closed();
            rows[0].push(
                panel("two regions, for this circle")
                    .with(Picture::new(push).over(extent))
                    .with(circle),
            );
            rows[1].push(panel("color of each direction").with(Picture::new(disc()).over(extent)));
            rows[2].push(panel("the picture").with(Picture::new(ground.clone()).over(extent)));
        }
        let [arrows, colors, sizes] = rows;
        figure = figure
            .with(height, arrows)
            .with(height, colors)
            .with(height, sizes);
    }
    Ok(figure)
}

/// Every direction from a middle, as [`wheel`] colors it.
fn disc() -> Array2<Color> {
    let middle = 0.5 * real(SIZE) - 0.5;
    let place = |i: usize| (real(i) - middle) / middle;
    let part = |f: fn(DVec2) -> f64| {
        Grid::from_shape_fn((SIZE, SIZE), |(row, column)| {
            let at = DVec2::new(place(column), place(row));
            // the wheel takes a root of the length
            if at.length() > 0.9 {
                0.0
            } else {
                f(at * at.length())
            }
        })
    };
    wheel(&shrunk(&part(|p| p.x), 2), &shrunk(&part(|p| p.y), 2))
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    Ok(vec![
        Artefact::figure(
            "The U. For each kind from above: arrows, as long as the root of the force; direction as color, pale where \
             the force is weak; strength, dark where it is large (the pull of distance is 1 everywhere, but where two edges are equally near). Two regions: orange, the circle would grow; blue, it \
             would shrink.",
            page(record, "U", "§4.2  Kinds of field on a U", (16, 2))?,
        ),
        Artefact::further(
            "apple",
            "The same on the apple, at a fifth of its size.",
            Body::Figure(page(
                record,
                "apple",
                "§4.2  Kinds of field on the apple",
                (10, 1),
            )?),
        ),
    ])
}

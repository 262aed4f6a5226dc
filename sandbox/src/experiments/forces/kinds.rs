//! Every kind of field on one page: the U and the apple, as arrows, as colors, by strength.

use super::synthetic::{AROUND, OBJECT, SIZE, along, fit, u_corners, u_shape};
use crate::prelude::*;
use field::{
    Across, ForceField, Grid, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, TwoRegions, mask_x, mask_y,
    report_force,
};
use ndarray::{Array2, s};
use snake::ImageForce;

/// The kinds as they are called here, and as typed behind `--force`.
const KINDS: [(&str, &str); 9] = [
    ("report", "report"),
    ("corrected", "edge"),
    ("several scales", "scales"),
    ("bright line", "line"),
    ("corners", "termination"),
    ("distance", "distance"),
    ("GVF", "gvf"),
    ("generalised GVF", "{ kind = \"gvf\", spread = 0.05 }"),
    ("VFC", "vfc"),
];
/// The apple is shown this many times smaller.
const SMALL: usize = 5;

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
const GRADIENTS: [&str; 4] = ["corrected", "several scales", "bright line", "corners"];

/// A gallery of fields.
pub(crate) const FIELDS: Experiment = Experiment {
    id: "sec-4-2-kinds",
    title: "Kinds of field",
    place: "§4.2",
    question: "What does each kind of field look like, on a U whose outline is known and on a photograph? Where does \
               it point, how far does it reach, and is it the gradient of anything?",
    claims: &[
        claim("those made for outlines pull to it from 3 px inside and 3 px outside, away from the \
               corners [theory]")
            .judged(|r| {
                let worst = least(numbers(r, &TO_EDGES, "pulled to the outline at 3 px")?);
                let words = format!("at {:.1} % of the places at least", 100.0 * worst);
                Ok(Finding::new(worst > 0.99, words))
            }),
        claim("the bright-line force does not: it pulls into the object from both sides [theory]")
            .when(&[near("bright line: pulled to the outline at 3 px", 0.5, 0.1)]),
        claim("the corner force is strong at the eight corners only [theory]").when(&[above(
            "corners: part of the force within 15 px of a corner",
            0.95,
        )]),
        claim("the edge force is felt in a strip along the outline [theory §10.2]").when(&[
            below("report: felt in this part of the picture", 0.35),
            below("corrected: felt in this part of the picture", 0.35),
        ]),
        claim("distance, GVF and VFC nearly everywhere [theory §10.2]").when(&[
            above("distance: felt in this part of the picture", 0.85),
            above("GVF: felt in this part of the picture", 0.85),
            above("generalised GVF: felt in this part of the picture", 0.85),
            above("VFC: felt in this part of the picture", 0.85),
        ]),
        claim("forces made from a strength have no curl; the report's and the flows are no gradients [D39]")
            .judged(|r| {
                let none = most(numbers(r, &GRADIENTS, "curl")?);
                let some = least(numbers(r, &["report", "GVF", "generalised GVF"], "curl")?);
                let words = format!("curl over slope {none:.0e} at most, against {some:.3} at least");
                // the shipped fields are kept in single precision
                Ok(Finding::new(none < 1e-6 && some > 0.01, words))
            }),
    ],
    run,
    draw,
};

fn numbers(record: &Record, kinds: &[&str], what: &str) -> Result<Vec<f64>> {
    let one = |kind: &&str| record.number(&format!("{kind}: {what}"));
    kinds.iter().map(one).collect()
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
    // farther than 16 px from a corner
    let places = along(&u_corners(), 1.0, 16.0);
    let sides = places
        .iter()
        .flat_map(|&(at, outward)| [(at, outward, -3.0), (at, outward, 3.0)]);
    let pulled = |(at, outward, way): (DVec2, DVec2, f64)| {
        flag(field.at(at + outward * way).dot(outward) * way < 0.0)
    };
    let few = 1e-3;
    let pulled = mean(sides.map(pulled));
    record.note(
        format!("{name}: pulled to the outline at 3 px [of the places]"),
        pulled,
        few,
    );
    let (fx, fy) = field.components();
    let size = Grid::from_shape_fn(fx.dim(), |at| fx[at].hypot(fy[at]));
    let lowest = 0.01 * field.largest();
    let felt = mean(size.iter().map(|&size| flag(size > lowest)));
    let mut own = record.under(name);
    own.note("felt in this part of the picture", felt, few);
    own.note("curl [of the slope]", curl(field), 1e-5);
    if name == "corners" {
        let corners = u_corners();
        let near = size.indexed_iter().filter(|((row, column), _)| {
            let p = DVec2::new(real(*column), real(*row));
            corners.iter().any(|corner| corner.distance(p) < 15.0)
        });
        let part = near.map(|(_, size)| size).sum::<f64>() / size.sum();
        record.note(
            "corners: part of the force within 15 px of a corner",
            part,
            few,
        );
    }
}

/// The field of a kind, as shipped.
fn field_of(typed: &str, image: &Grid) -> Result<ForceField> {
    if typed == "report" {
        return Ok(report_force(
            image,
            REPORT_PASSES,
            REPORT_SCALE,
            REPORT_GAIN,
        )?);
    }
    let session = fit(image, &circle_in(image), typed)?;
    let world = session.simulation().members()[0].snake().world();
    let force = world.forces[0].downcast::<ImageForce>();
    let force = force.ok_or_else(|| refused(format!("{typed} is no field")))?;
    Ok(force.field().as_ref().clone())
}

/// A circle in the middle of a picture.
fn circle_in(image: &Grid) -> Vec<DVec2> {
    let (rows, columns) = image.dim();
    let middle = 0.5 * DVec2::new(real(columns), real(rows)) - 0.5;
    elastic::circle(middle, 0.3 * real(rows.min(columns)), 120)
}

fn run() -> Result {
    let mut record = Record::default();
    let apple = shrunk(scene::picture("apple")?.levels(), SMALL);
    for (picture, image) in [("U", u_shape()?), ("apple", apple)] {
        for (name, typed) in KINDS {
            let field = field_of(typed, &image)?;
            if picture == "U" {
                measure(&mut record, name, &field);
            }
            let (fx, fy) = field.components();
            record.keep_grid(format!("{picture}: {name} x"), fx);
            record.keep_grid(format!("{picture}: {name} y"), fy);
        }
        // two regions need a curve; about a circle in the middle of the picture their push is a grid
        let circle = circle_in(&image);
        let regions = TwoRegions::new(&image, 1.0 / (OBJECT - AROUND).powi(2))?;
        let means = regions.means(&circle);
        let push =
            |(row, column)| regions.normal_force(DVec2::new(real(column), real(row)), &means);
        record.keep_grid(
            format!("{picture}: push"),
            Grid::from_shape_fn(image.dim(), push),
        );
        record.keep_run(picture, vec![Frame::closed(0.0, circle)]);
        record.keep_grid(format!("{picture}: image"), image);
    }
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
) -> Result<Figure> {
    let image = record.grid(&format!("{picture}: image"))?;
    let (rows, columns) = image.dim();
    let height = 188.0 * real(rows) / real(columns) + 22.0;
    let side = |pixels: usize| real(pixels / factor * factor) - 0.5;
    let extent = [-0.5, -0.5, side(columns), side(rows)];
    let panel = |title: &str| Panel::pixels(title, columns, rows).bare();
    let shown = |title: &str, pixels| panel(title).with(Picture::new(pixels).over(extent));
    let ground = grey(&shrunk(image, factor));
    let mut figure = Figure::new(title, 960.0);
    for block in [&KINDS[..5], &KINDS[5..]] {
        let (mut above, mut middle, mut below) = (Vec::new(), Vec::new(), Vec::new());
        for (name, _) in block {
            let fx = record.grid(&format!("{picture}: {name} x"))?;
            let fy = record.grid(&format!("{picture}: {name} y"))?;
            let (small_x, small_y) = (shrunk(fx, factor), shrunk(fy, factor));
            let pale = Picture::new(ground.clone()).over(extent).faded(0.4);
            let field = arrows(fx, fy, every, 0.02, [0, 0, columns, rows]);
            above.push(panel(name).with(pale).with(field));
            middle.push(shown("direction", wheel(&small_x, &small_y)));
            below.push(shown("strength", size(&small_x, &small_y)));
        }
        if block.len() < 5 {
            let push = shrunk(record.grid(&format!("{picture}: push"))?, factor);
            let circle = record.run(picture)?.ring(0, Color::INK);
            above.push(shown("two regions, for this circle", signed(&push, 0.995)).with(circle));
            middle.push(shown("color of each direction", disc()));
            below.push(shown("the picture", ground.clone()));
        }
        for row in [above, middle, below] {
            figure = figure.with(height, row);
        }
    }
    Ok(figure)
}

/// Every direction from a middle, as [`wheel`] colors it.
fn disc() -> Array2<Color> {
    let middle = 0.5 * real(SIZE) - 0.5;
    let place = |i: usize| (real(i) - middle) / middle;
    let part = |f: fn(DVec2) -> f64| {
        let grid = Grid::from_shape_fn((SIZE, SIZE), |(row, column)| {
            let at = DVec2::new(place(column), place(row));
            // the wheel takes a root of the length
            if at.length() > 0.9 {
                0.0
            } else {
                f(at * at.length())
            }
        });
        shrunk(&grid, 2)
    };
    wheel(&part(|p| p.x), &part(|p| p.y))
}

fn draw(record: &Record) -> Drawn {
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
            page(
                record,
                "apple",
                "§4.2  Kinds of field on the apple",
                (10, 1),
            )?,
        ),
    ])
}

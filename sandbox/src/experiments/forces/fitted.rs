//! What `snake fit` makes of the U with each shipped force: as users have them, nothing set.

use super::super::pixels::grey;
use super::reach::mean_distance;
use super::synthetic::{SIZE, u_corners, u_shape};
use crate::demand::{below, judged};
use crate::draw::{Color, Figure, Line, Panel, Picture};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
use scene::ForceChoice;
use scene::fit::{Contour, Image, Options, fit};
use snake::Outcome;

const ID: &str = "sec-4-2-fit";
/// The forces as typed behind `--force`, several joined by a plus; the first is the default.
const KINDS: [&str; 13] = [
    "edge",
    "{ kind = \"edge\", polarity = \"bright-to-dark\" }",
    "scales",
    "coarse-to-fine",
    "distance",
    "gvf",
    "gvf:0.5+edge",
    "vfc",
    "line",
    "termination",
    "regions",
    "local-regions",
    "likelihood",
];
/// The circle around the object, and how far outside its outline a contour is drawn that is near.
const AROUND_IT: f64 = 115.0;
const OUTSIDE: f64 = 8.0;
/// Panels in a row.
const ROW: usize = 5;

/// The two starts.
const STARTS: [&str; 2] = ["drawn near", "from around"];

/// Each shipped force in `snake fit`, from two starts.
pub(crate) const FITTED: Experiment = Experiment {
    id: ID,
    title: "What fit makes of it",
    place: "§4.2",
    question: "The same picture of a U, given to the command `snake fit` with each force it has and nothing else set: from a contour drawn 8 px outside the \
               outline, and from a circle of radius 115 px around it. How far is the true outline from the contour that comes out?",
    claims: &[
        Claim {
            says: "drawn near, the default force finds the outline to about a pixel, corners included",
            source: "docs/fields.md",
            judge: |r| {
                judged(
                    r,
                    &[below("edge, drawn near: mean distance of the outline", 1.5)],
                )
            },
        },
        Claim {
            says: "from the circle around, no force as shipped brings the curve to rest on the outline within 40,000 steps",
            source: "docs/fields.md",
            judge: |r| {
                let mut least = ("none", f64::INFINITY);
                for kind in KINDS {
                    let name = format!("{}, from around", label(kind));
                    let off = r.number(&format!("{name}: mean distance of the outline"))?;
                    let rests = r.number(&format!("{name}: comes to rest"))? > 0.5;
                    if rests && off < least.1 {
                        least = (kind, off);
                    }
                }
                Ok(Finding::new(
                    least.1 > 2.0,
                    format!(
                        "nearest of those at rest is {}, {:.1} px on average",
                        label(least.0),
                        least.1
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// A force in few words.
fn label(kind: &str) -> &str {
    if kind.starts_with('{') {
        "edge of one polarity"
    } else {
        kind
    }
}

/// The outline moved outwards by so much: a square ring of the same corners.
fn near() -> Vec<DVec2> {
    let corners = u_corners();
    let n = corners.len();
    let unit = |i: usize| (corners[(i + 1) % n] - corners[i]).normalize();
    // both edges that meet at a corner move outwards
    let moved = |i: usize| {
        let (before, after) = (unit((i + n - 1) % n), unit(i));
        let outwards = |edge: DVec2| DVec2::new(edge.y, -edge.x);
        corners[i] + OUTSIDE * (outwards(before) + outwards(after))
    };
    let moved: Vec<DVec2> = (0..n).map(moved).collect();
    let mut out = Vec::new();
    for (i, &from) in moved.iter().enumerate() {
        let to = moved[(i + 1) % n];
        let mut way = 0.0;
        while way < from.distance(to) {
            out.push(from + (to - from).normalize() * way);
            way += 5.0;
        }
    }
    out
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let image = u_shape(ID)?;
    let picture = Image::grey(image.clone());
    let truth = u_corners();
    let starts = [
        near(),
        elastic::circle(DVec2::splat(real(SIZE) / 2.0), AROUND_IT, 180),
    ];
    for (start, table) in starts.iter().zip(["near", "around"]) {
        let mut ends = Table::raw(table).with(
            "start x",
            "px",
            Tolerance::EXACT,
            start.iter().map(|p| p.x).collect(),
        );
        let y = start.iter().map(|p| p.y).collect();
        ends = ends.with("start y", "px", Tolerance::EXACT, y);
        let words = if table == "near" {
            STARTS[0]
        } else {
            STARTS[1]
        };
        for kind in KINDS {
            let forces = kind
                .split('+')
                .map(|text| ForceChoice::parse(text).map(ForceChoice::for_fit))
                .collect::<Result<Vec<_>, String>>()
                .map_err(SandboxError::refused(ID))?;
            // the default is no force chosen
            let options = Options {
                forces: if kind == KINDS[0] { Vec::new() } else { forces },
                ..Options::default()
            };
            let contour = Contour::closed(start.clone());
            let found = fit(&picture, &contour, &options).map_err(SandboxError::refused(ID))?;
            let x = &found.contour.points;
            record.note(
                format!("{}, {words}: mean distance of the outline", label(kind)),
                mean_distance(&truth, x),
                "px",
                Tolerance::Relative(0.02),
            );
            let rests = matches!(found.outcome, Outcome::Settled { .. });
            record.note(
                format!("{}, {words}: comes to rest", label(kind)),
                f64::from(u8::from(rests)),
                "",
                Tolerance::EXACT,
            );
            let column = |part: fn(&DVec2) -> f64| x.iter().map(part).collect();
            ends = ends
                .with(
                    format!("{} x", label(kind)),
                    "px",
                    Tolerance::EXACT,
                    column(|p| p.x),
                )
                .with(
                    format!("{} y", label(kind)),
                    "px",
                    Tolerance::EXACT,
                    column(|p| p.y),
                );
        }
        record.keep(ends);
    }
    record.keep_grid("image", image);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let ground = grey(record.grid("image")?);
    let mut out = Vec::new();
    for (table, words, suffix, caption) in [
        (
            "around",
            STARTS[1],
            "",
            "Dashed: the start, a circle around the object. Red: where `snake fit` leaves it, nothing set but the force. The number is the mean distance of \
             the true outline from it; a star says that it was not at rest after 40,000 steps.",
        ),
        (
            "near",
            STARTS[0],
            "near",
            "The same from a contour drawn 8 px outside the outline.",
        ),
    ] {
        let title = format!("§4.2  snake fit with each force, {words}");
        let mut figure = Figure::new(title, 940.0);
        let mut panels = Vec::new();
        for kind in KINDS {
            let off = record.number(&format!(
                "{}, {words}: mean distance of the outline",
                label(kind)
            ))?;
            let rests = record.number(&format!("{}, {words}: comes to rest", label(kind)))?;
            let star = if rests > 0.5 { "" } else { " *" };
            let end = record.points(
                table,
                &format!("{} x", label(kind)),
                &format!("{} y", label(kind)),
            )?;
            let start = record.points(table, "start x", "start y")?;
            panels.push(
                Panel::pixels(format!("{}: {off:.1} px{star}", label(kind)), SIZE, SIZE)
                    .bare()
                    .with(Picture::new(ground.clone()).faded(0.35))
                    .with(Line::new(start, Color::INK).closed().dashed().weighing(0.8))
                    .with(Line::new(end, Color::RED).closed().weighing(1.3)),
            );
        }
        for row in panels.chunks(ROW) {
            let mut row = row.to_vec();
            row.resize_with(ROW, || Panel::pixels(String::new(), SIZE, SIZE).bare());
            figure = figure.with(212.0, row);
        }
        out.push(if suffix.is_empty() {
            Artefact::figure(caption, figure)
        } else {
            Artefact::further(suffix, caption, crate::Body::Figure(figure))
        });
    }
    Ok(out)
}

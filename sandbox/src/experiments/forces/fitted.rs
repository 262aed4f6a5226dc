//! What `snake fit` makes of the U with each shipped force: as users have them, nothing set.

use super::synthetic::{SIZE, along, fit, in_rows, mean_distance, over_u, u_corners, u_shape};
use crate::prelude::*;
use snake::Outcome;

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

/// The two starts.
const STARTS: [&str; 2] = ["drawn near", "from around"];

/// Each shipped force in `snake fit`, from two starts.
pub(crate) const FITTED: Experiment = Experiment {
    id: "sec-4-2-fit",
    title: "What fit makes of it",
    place: "§4.2",
    question: "The same picture of a U, given to the command `snake fit` with each force it has and nothing else set: from a contour drawn 8 px outside the \
               outline, and from a circle of radius 115 px around it. How far is the true outline from the contour that comes out?",
    claims: &[
        claim("drawn near, the default force finds the outline to about a pixel [docs/fields.md]")
            .when(&[below("edge, drawn near: mean distance of the outline", 1.5)]),
        claim(
            "from the circle around, no force as shipped brings the curve to rest on the outline \
               within 40,000 steps [docs/fields.md]",
        )
        .judged(|r| {
            let mut nearest = ("none", f64::INFINITY);
            for kind in KINDS {
                let name = format!("{}, from around", label(kind));
                let off = r.number(&format!("{name}: mean distance of the outline"))?;
                let rests = r.number(&format!("{name}: comes to rest"))? > 0.5;
                if rests && off < nearest.1 {
                    nearest = (label(kind), off);
                }
            }
            let (kind, off) = nearest;
            let words = format!("nearest of those at rest is {kind}, {off:.1} px on average");
            Ok(Finding::new(off > 2.0, words))
        }),
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
        corners[i] - OUTSIDE * (before.perp() + after.perp())
    };
    let moved: Vec<DVec2> = (0..n).map(moved).collect();
    along(&moved, 5.0, 0.0)
        .into_iter()
        .map(|place| place.0)
        .collect()
}

fn run() -> Result {
    let mut record = Record::default();
    let (image, truth) = (u_shape()?, u_corners());
    let around = elastic::circle(DVec2::splat(real(SIZE) / 2.0), AROUND_IT, 180);
    for (start, words) in [near(), around].iter().zip(STARTS) {
        let mut ends = vec![Frame::closed(0.0, start.clone())];
        for kind in KINDS {
            // the default is no force chosen
            let found = fit(&image, start, if kind == KINDS[0] { "" } else { kind })?.finish();
            let (name, x) = (label(kind), &found.contour.points);
            let off = mean_distance(&truth, x);
            let words_of = format!("{name}, {words}: mean distance of the outline [px]");
            record.note(words_of, off, share(0.02));
            let rests = flag(matches!(found.outcome, Outcome::Settled { .. }));
            record.note(format!("{name}, {words}: comes to rest"), rests, EXACT);
            ends.push(Frame::closed(0.0, x.to_vec()));
        }
        record.keep_run(words, ends);
    }
    record.keep_grid("image", image);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let page = |words: &str| -> Result<Figure> {
        let ends = record.run(words)?;
        let mut panels = Vec::new();
        for (i, kind) in KINDS.into_iter().enumerate() {
            let name = label(kind);
            let off = record.number(&format!("{name}, {words}: mean distance of the outline"))?;
            let rests = record.number(&format!("{name}, {words}: comes to rest"))? > 0.5;
            let star = if rests { "" } else { " *" };
            panels.push(
                over_u(format!("{name}: {off:.1} px{star}"), record.grid("image")?)
                    .with(ends.ring(0, Color::INK).dashed().weighing(0.8))
                    .with(ends.ring(i + 1, Color::RED).weighing(1.3)),
            );
        }
        let title = format!("§4.2  snake fit with each force, {words}");
        Ok(in_rows(&title, &panels))
    };
    Ok(vec![
        Artefact::figure(
            "Dashed: the start, a circle around the object. Red: where `snake fit` leaves it, nothing set but the force. The number is the mean distance of \
             the true outline from it; a star says that it was not at rest after 40,000 steps.",
            page(STARTS[1])?,
        ),
        Artefact::further(
            "near",
            "The same from a contour drawn 8 px outside the outline.",
            page(STARTS[0])?,
        ),
    ])
}

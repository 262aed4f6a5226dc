//! The story of §4.3 on a drawn picture, by the report's own rules from end to end.

use super::draw::{animation, frame_panel, height_and_stuck, marked};
use super::story::{Story, Truth, share_of, top};
use crate::prelude::*;

/// Six moments.
const MOMENTS: [f64; 6] = [0.0, 10.0, 30.0, 34.0, 37.0, 60.0];
/// Center and half axes of the bright ellipse, and the row of the false edge.
const ELLIPSE: (DVec2, DVec2) = (DVec2::new(55.4, 61.25), DVec2::new(34.0, 26.0));
const FALSE_EDGE: f64 = 15.5;
/// Positions under the report's sampling, which jumps (D51).
const PLACE: f64 = 0.01;

/// A false edge above an ellipse.
pub(crate) const DRAWN: Experiment = Experiment {
    id: "sec-4-3-drawn",
    title: "A drawn false edge, the report's rules",
    place: "§4.3",
    question: "With the report's field, sampling, ends, frame and scheme, and nothing of ours: does a snake on a drawn \
               picture do what §4.3 tells?",
    claims: &[
        claim("the top of the snake is attracted by a disturbing edge at the top of the image: it rises \
               to it [report §4.3, D50]")
            .judged(|r| {
                let (start, held) = (r.number("top at the start")?, r.number("top at t = 10")?);
                Ok(Finding::new(
                    held < start - 3.0 && (held - FALSE_EDGE).abs() < 1.0,
                    format!("from y = {start:.2} to {held:.2} px; the false edge is at 15.5"),
                ))
            }),
        claim("the ends stick first, and the stuck part grows [report §4.3]").when(&[
            rising("stuck at t = *"),
            below("middle node stuck at t = 30", 0.5),
        ]),
        claim("the middle is suddenly extracted from the neighborhood of the disturbing edge \
               [report §4.3, errata §5]")
            .when(&[below("top at t = 30", 18.5), above("top at t = 40", 34.0)]),
        claim("and the snake reaches the contour, which is its equilibrium [report §4.3]").when(&[
            below("mean distance to the ellipse at the end", 1.5),
            above("stuck at t = 60", 0.9),
            below("nodes moved in the last 5 units of time", 0.1),
        ]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let truth = Truth::ellipse(ELLIPSE.0, ELLIPSE.1);
    let story = Story::of("disturbing-edge", &[("every = 100", "every = 50")], truth)?;
    let mut record = Record::default();
    record.note("top at the start [px]", top(story.at(0.0)).y, PLACE);
    for t in [10.0, 30.0, 40.0] {
        record.note(format!("top at t = {t} [px]"), top(story.at(t)).y, PLACE);
    }
    for t in [0.0, 10.0, 20.0, 30.0, 60.0] {
        let stuck = share_of(&story.truth.stuck(story.at(t)));
        record.note(format!("stuck at t = {t} [of the nodes]"), stuck, 0.019);
    }
    let middle = story.truth.stuck(story.at(30.0))[25];
    record.note("middle node stuck at t = 30", flag(middle), EXACT);
    let nodes = story.last();
    let mean = story.truth.mean_distance(nodes).0;
    record.note("mean distance to the ellipse at the end [px]", mean, PLACE);
    let moved = nodes
        .iter()
        .zip(story.at(55.0))
        .map(|(p, q)| p.distance(*q));
    record.note(
        "nodes moved in the last 5 units of time [px]",
        most(moved),
        PLACE,
    );
    record.note("nodes", real(nodes.len()), EXACT);
    story.keep(&mut record, Some(10), PLACE);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let letters = ["a", "b", "c", "d", "e", "f"].into_iter().zip(MOMENTS);
    let panels = letters.map(|(letter, t)| frame_panel(record, letter, t, false));
    let mut panels = panels.collect::<Result<Vec<_>>>()?;
    let below = panels.split_off(3);
    let (height, stuck) = height_and_stuck(record)?;
    let terms = [
        ("elastic", "elastic", Color::RED),
        ("kinetic", "kinetic", Color::BLUE),
    ];
    let energy = energies(record, "curves", &terms, "energy of deformation and motion")?;
    let mark = |panel| marked(panel, &MOMENTS[1..5], "bcde");
    Ok(vec![
        Artefact::figure(
            "An ellipse, and a bar above it. Yellow: the snake; blue: its part within 2 px of the ellipse. The top is \
             caught by the bar, the ends stick, the middle snaps down.",
            Figure::new("§4.3  A drawn false edge, by the report's rules", 900.0)
                .with(270.0, panels)
                .with(270.0, below)
                .with(220.0, vec![mark(height), mark(stuck), energy]),
        ),
        Artefact::further(
            "moving",
            "The same in motion.",
            animation(record, false, 0..120, 336)?,
        ),
    ])
}

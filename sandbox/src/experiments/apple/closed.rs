//! A closed snake around the same apple.

use super::draw::{animation, frame_panel, over_picture, snake_on};
use super::story::{Story, Truth, share_of, top, truth_of};
use crate::prelude::*;

/// Positions: a longer run with weak edges.
const PLACE: f64 = 0.02;

/// The whole outline.
pub(crate) const CLOSED: Experiment = Experiment {
    id: "sec-4-3-closed",
    title: "A closed snake around the apple",
    place: "§4.3",
    question: "The whole outline from a start drawn by hand around it, stem included: how near does a closed snake come?",
    claims: &[
        claim("it comes within 2 px of the contour in the mean, outside the boxes of what disturbs [our aim]")
            .when(&[below("mean distance at the end", 2.0)]),
        claim("it lets go of the stem too [report §4.3]")
            .when(&[below("top at the start", 8.0), above("top at the end", 50.0)]),
        claim("what is left is inside the boxes: the lobe at the foot and the weak right side [errata §5]")
            .when(&[
                more(
                    "largest distance at the end inside the boxes",
                    2.0,
                    "largest distance at the end outside the boxes",
                ),
                below("largest distance at the end outside the boxes", 6.0),
            ]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let story = Story::of("apple-closed", &[], Truth::apple()?)?;
    let (mut record, truth) = (Record::default(), &story.truth);
    let (start, nodes) = (story.at(0.0), story.last());
    let (mean, count) = truth.mean_distance(nodes);
    record.note(
        "mean distance at the start [px]",
        truth.mean_distance(start).0,
        PLACE,
    );
    record.note("mean distance at the end [px]", mean, PLACE);
    record.note("nodes outside the boxes at the end", real(count), 1.0);
    record.note(
        "stuck at the end [of the nodes]",
        share_of(&truth.stuck(nodes)),
        0.03,
    );
    record.note("top at the start [px]", top(start).y, PLACE);
    record.note("top at the end [px]", top(nodes).y, PLACE);
    for (name, wanted) in [("outside", true), ("inside", false)] {
        let kept = nodes.iter().filter(|&&p| truth.counts(p) == wanted);
        let far = most(kept.map(|&p| truth.distance(p)));
        record.note(
            format!("largest distance at the end {name} the boxes [px]"),
            far,
            0.2,
        );
    }
    record.keep(
        Table::raw("distance")
            .exact("node", (0..nodes.len()).map(real))
            .exact("distance [px]", nodes.iter().map(|&p| truth.distance(p)))
            .exact("counts", nodes.iter().map(|&p| flag(truth.counts(p)))),
    );
    story.keep(&mut record, Some(10), PLACE);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let frames = record.run("curves")?;
    let truth = truth_of(record)?;
    let contour = line(record.xy("truth")?, Color::GREEN)
        .closed()
        .weighing(0.6);
    let last = over_picture(record, "the end; green: the contour by hand", true)?.with(contour);
    let mut pictures = Vec::new();
    for (letter, t) in [("a", 0.0), ("b", 40.0), ("c", 140.0)] {
        pictures.push(frame_panel(record, letter, t, true)?);
    }
    pictures.push(snake_on(
        last,
        frames.nodes(frames.len() - 1),
        &truth,
        true,
        1.0,
    ));
    let distance = record.points("distance", "node", "distance")?;
    let counts = record.column("distance", "counts")?;
    let only = |wanted: bool, color| {
        let kept = distance
            .iter()
            .zip(counts)
            .filter(|(_, c)| (**c > 0.5) == wanted);
        dots(kept.map(|(p, _)| *p), 1.2, color)
    };
    let title = "distance to the contour at the end";
    let along = plot(title, ("node", 0.0, 160.0), ("px", 0.0, 18.0))
        .with(only(true, Color::BLUE).named("outside the boxes"))
        .with(only(false, Color::ORANGE).named("inside"));
    let (red, green) = (
        [("distance", "", Color::RED)],
        [("stuck", "", Color::GREEN)],
    );
    let mean = over_time(
        record,
        "fine",
        &red,
        "mean distance outside the boxes",
        "px",
    )?;
    let title = "part within 4 px of the contour";
    let stuck = over_time(record, "fine", &green, title, "of the nodes")?;
    let below = pictures.split_off(2);
    let shown = (0..60).chain((60..150).step_by(5));
    Ok(vec![
        Artefact::figure(
            "Yellow: the snake; blue: its part within 4 px of the contour. The right side has almost no contrast, and the \
             lobe at the foot is filled by the table's shadow.",
            Figure::new("§4.3  A closed snake around the apple", 900.0)
                .with(440.0, pictures)
                .with(440.0, below)
                .with(230.0, vec![along, mean, stuck]),
        ),
        Artefact::further(
            "moving",
            "The same in motion.",
            animation(record, true, shown, 300)?,
        ),
    ])
}

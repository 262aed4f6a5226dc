//! The apple under the report's rules, and what keeps it from letting go (D11).

use super::PLACE;
use super::draw::{over_picture, snake_on};
use super::story::{Story, Truth, share_of, top, truth_of};
use crate::prelude::*;

const WITHOUT_STEM: &str = "rest = { shipped = \"apple-without-the-stem\" }\n";
const START: &str = "start = { shipped = \"apple-over-the-stem\" }\n";
const START_AND_REST: &str = "start = { shipped = \"apple-over-the-stem\" }\nrest = { shipped = \"apple-without-the-stem\" }\n";

/// Rules and natural shape, each of two kinds.
const CASES: [(&str, &str, Changes); 4] = [
    ("report's rules; drawn shape", "apple-report", &[]),
    (
        "report's rules; shape without the bump",
        "apple-report",
        &[(START, START_AND_REST)],
    ),
    (
        "corrected rules; drawn shape",
        "apple",
        &[(WITHOUT_STEM, "")],
    ),
    ("corrected rules; shape without the bump", "apple", &[]),
];

/// Why the apple does not work by the report's rules.
pub(crate) const RULES: Experiment = Experiment {
    id: "sec-4-3-report",
    title: "The apple by the report's rules",
    place: "§4.3",
    question: "The report's program takes the drawn curve for the natural shape (D11). Drawn over the stem, it has a \
               bump. Can the snake let go of the stem then, and what else does it take?",
    claims: &[
        claim("by the report's rules the stem holds the top for good [D11]").when(&[
            below("report's rules; drawn shape: top at the end", 8.0),
            below("report's rules; drawn shape: top moved since t = 200", 0.2),
        ]),
        claim("because of the natural shape: with corrected rules and the same shape it is held too [D11]")
            .when(&[
                below("corrected rules; drawn shape: top at the end", 10.0),
                above("corrected rules; shape without the bump: top at the end", 50.0),
            ]),
        claim("the shape alone is not enough: the report's field holds the snake elsewhere [D38, D39, D51]")
            .when(&[
                below("report's rules; shape without the bump: top at the end", 20.0),
                above("report's rules; shape without the bump: mean distance at the end", 5.0),
            ]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let mut record = Record::default();
    // the report's sampling jumps (D51), and a node at a jump may chatter (D52)
    let loose = 0.5;
    let mut tops = Table::raw("tops");
    for (name, scene, changes) in CASES {
        let story = Story::of(scene, changes, Truth::apple()?)?;
        let nodes = story.last();
        let place = if scene == "apple" { PLACE } else { loose };
        let mut own = record.under(name);
        own.note("top at the end [px]", top(nodes).y, place);
        let moved = (top(nodes).y - top(story.at(200.0)).y).abs();
        own.note("top moved since t = 200 [px]", moved, share(0.3));
        let stuck = share_of(&story.truth.stuck(nodes));
        own.note("stuck at the end [of the nodes]", stuck, 0.05);
        let off = story.truth.mean_distance(nodes).0;
        own.note("mean distance at the end [px]", off, place);
        if tops.columns.is_empty() {
            tops = tops.exact("t", story.run.frames.iter().map(|frame| frame.t));
            story.keep(&mut record, None, loose);
        }
        tops = tops.exact(
            format!("{name} [px]"),
            story.run.frames.iter().map(|frame| top(frame.nodes()).y),
        );
        record.keep_run(name, &story.run);
    }
    record.keep(tops);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let truth = truth_of(record)?;
    let mut panels = Vec::new();
    for (name, ..) in CASES {
        let frames = record.run(name)?;
        let panel = over_picture(record, &name.replace(';', ","), true)?;
        let end = frames.nodes(frames.nearest(420.0));
        panels.push(snake_on(panel, end, &truth, false, 1.3));
    }
    let below = panels.split_off(2);
    let columns = CASES
        .iter()
        .zip(Color::SERIES)
        .map(|((name, ..), color)| (*name, *name, color));
    let columns: Vec<(&str, &str, Color)> = columns.collect();
    let mut height = over_time(record, "tops", &columns, "height of the top", "y / px")?;
    (height.y.from, height.y.to) = (64.0, 0.0);
    let contour = line([(0.0, 54.6), (420.0, 54.6)], Color::GREY)
        .dashed()
        .weighing(0.6);
    let height = height.legend_at(Corner::BottomLeft);
    Artefact::only(
        "At t = 420. Upper row: the report's rules; lower: corrected. Left: the natural shape is the drawn one with its \
         bump; right: the same without. Only with both corrected does the snake let go.",
        Figure::new(
            "§4.3  The apple by the report's rules, and what holds it",
            760.0,
        )
        .with(370.0, panels)
        .with(370.0, below)
        .with(
            250.0,
            vec![height.with(contour.named("the contour at the stem"))],
        ),
    )
}

//! The apple under the report's rules, and what keeps it from letting go (D11).

use super::PLACE;
use super::draw::frame_panel;
use super::story::{Story, Truth, share, top};
use crate::demand::{above, below, judged};
use crate::draw::{Color, Corner, Figure, Line};
use crate::experiments::over_time::over_time;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};

const ID: &str = "sec-4-3-report";
const WITHOUT_STEM: &str = "rest = { shipped = \"apple-without-the-stem\" }\n";
const START: &str = "start = { shipped = \"apple-over-the-stem\" }\n";
const START_AND_REST: &str = "start = { shipped = \"apple-over-the-stem\" }\nrest = { shipped = \"apple-without-the-stem\" }\n";

/// Name, scene, changes.
type Case = (
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str)],
);
/// Rules and natural shape, each of two kinds.
const CASES: [Case; 4] = [
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
    id: ID,
    title: "The apple by the report's rules",
    place: "§4.3",
    question: "The report's program takes the drawn curve for the natural shape (D11). Drawn over the stem, it has a \
               bump. Can the snake let go of the stem then, and what else does it take?",
    claims: &[
        Claim {
            says: "by the report's rules the stem holds the top for good",
            source: "D11",
            judge: |r| {
                let (top, moved) = (
                    r.number("report's rules; drawn shape: top at the end")?,
                    r.number("report's rules; drawn shape: top moved since t = 200")?,
                );
                let stuck = r.told("report's rules; drawn shape: stuck at the end")?;
                Ok(Finding::new(
                    top < 8.0 && moved < 0.2,
                    format!(
                        "top at y = {top:.1} to the end, moved by {moved:.2} px since t = 200; {:.0} % stuck on the contour",
                        100.0 * stuck
                    ),
                ))
            },
        },
        Claim {
            says: "because of the natural shape: with corrected rules and the same shape it is held too",
            source: "D11",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("corrected rules; drawn shape: top at the end", 10.0),
                        above(
                            "corrected rules; shape without the bump: top at the end",
                            50.0,
                        ),
                    ],
                )
            },
        },
        Claim {
            says: "the shape alone is not enough: the report's field holds the snake elsewhere",
            source: "D38, D39, D51",
            judge: |r| {
                judged(
                    r,
                    &[
                        below(
                            "report's rules; shape without the bump: top at the end",
                            20.0,
                        ),
                        above(
                            "report's rules; shape without the bump: mean distance at the end",
                            5.0,
                        ),
                    ],
                )
            },
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    // the report's sampling jumps (D51), and a node at a jump may chatter (D52)
    let place = Tolerance::Absolute(0.5);
    let mut tops = Table::raw("tops");
    for (index, (name, scene, changes)) in CASES.into_iter().enumerate() {
        let mut changes = changes.to_vec();
        if scene == "apple" {
            changes.push(("every = 10", "every = 10"));
        }
        let story = Story::of(ID, scene, &changes, Truth::apple(ID)?)?;
        let nodes = story.last();
        let tolerance = if scene == "apple" { PLACE } else { place };
        record.note(
            format!("{name}: top at the end"),
            top(nodes).y,
            "px",
            tolerance,
        );
        let moved = (top(nodes).y - top(story.at(200.0)).y).abs();
        record.note(
            format!("{name}: top moved since t = 200"),
            moved,
            "px",
            Tolerance::Relative(0.3),
        );
        record.note(
            format!("{name}: stuck at the end"),
            share(&story.truth.stuck(nodes)),
            "of the nodes",
            Tolerance::Absolute(0.05),
        );
        record.note(
            format!("{name}: mean distance at the end"),
            story.truth.mean_distance(nodes).0,
            "px",
            tolerance,
        );
        let heights = story
            .run
            .frames
            .iter()
            .map(|frame| top(frame.nodes()).y)
            .collect();
        let times = story.run.frames.iter().map(|frame| frame.t).collect();
        if index == 0 {
            tops = tops.with("t", "", Tolerance::EXACT, times);
        }
        tops = tops.with(name, "px", Tolerance::EXACT, heights);
        let mut kept = Record::default();
        story.keep(&mut kept, None, place);
        if index == 0 {
            record
                .tables
                .extend(kept.tables.iter().filter(|t| t.name == "truth").cloned());
            record.grids = kept.grids;
        }
        let curves = kept.tables.into_iter().find(|table| table.name == "curves");
        if let Some(mut curves) = curves {
            curves.name = CURVES[index];
            record.keep(curves);
        }
    }
    record.keep(tops);
    Ok(record)
}

const CURVES: [&str; 4] = ["curves-1", "curves-2", "curves-3", "curves-4"];

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut panels = Vec::new();
    for ((name, _, _), curves) in CASES.into_iter().zip(CURVES) {
        let mut one = Record::default();
        one.grids.clone_from(&record.grids);
        one.tables
            .extend(record.tables.iter().filter(|t| t.name == "truth").cloned());
        for table in record.tables.iter().filter(|t| t.name == curves) {
            let mut table = table.clone();
            table.name = "curves";
            one.keep(table);
        }
        let mut panel = frame_panel(&one, "", 420.0, false)?;
        panel.title = name.replace(';', ",");
        panels.push(panel);
    }
    let columns: Vec<(&str, &str, Color)> = CASES
        .iter()
        .zip(Color::SERIES)
        .map(|((name, _, _), color)| (*name, *name, color))
        .collect();
    let mut height = over_time(record, "tops", &columns, "height of the top", "y / px")?;
    (height.y.from, height.y.to) = (64.0, 0.0);
    let contour = Line::new(vec![(0.0, 54.6), (420.0, 54.6)], Color::GREY)
        .dashed()
        .weighing(0.6);
    let figure = Figure::new(
        "§4.3  The apple by the report's rules, and what holds it",
        760.0,
    )
    .with(370.0, panels[..2].to_vec())
    .with(370.0, panels[2..].to_vec())
    .with(
        250.0,
        vec![
            height
                .legend_at(Corner::BottomLeft)
                .with(contour.named("the contour at the stem")),
        ],
    );
    Ok(vec![Artefact::figure(
        "At t = 420. Upper row: the report's rules; lower: corrected. Left: the natural shape is the drawn one with its \
         bump; right: the same without. Only with both corrected does the snake let go.",
        figure,
    )])
}

//! The whole story of Figures 4.6 to 4.8 on one page, and in motion.

use super::draw::{all_over, animation, height_and_stuck, marked, window};
use super::story::top;
use super::{LETTERS, MOMENTS, PLACE, tell};
use crate::demand::{above, below, judged, less};
use crate::draw::{Color, Corner, Figure};
use crate::experiments::over_time::over_time;
use crate::{Artefact, Body, Claim, Experiment, Record, SandboxError, Tolerance, real};

const ID: &str = "sec-4-3-apple";

/// All curves over the picture, with graphs.
pub(crate) const OVERVIEW: Experiment = Experiment {
    id: ID,
    title: "The apple, whole",
    place: "§4.3",
    question: "Figures 4.6 to 4.8 in one: when does each part of the snake reach the contour, and what holds the rest?",
    claims: &[
        Claim {
            says: "the ends stick first: head and tail are on the contour when the top is still held",
            source: "report §4.3",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("ends on the contour for good from", 20.0),
                        above("top on the contour for good from", 250.0),
                    ],
                )
            },
        },
        Claim {
            says: "the energy of deformation falls when the middle lets go",
            source: "report §4.3",
            judge: |r| {
                judged(
                    r,
                    &[less(
                        "elastic energy at the end",
                        0.6,
                        "elastic energy while held (t = 100)",
                    )],
                )
            },
        },
        Claim {
            says: "it ends within 2 px of the contour drawn by hand, in the mean",
            source: "our aim",
            judge: |r| judged(r, &[below("mean distance at the end", 2.0)]),
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let story = tell(ID)?;
    let mut record = Record::default();
    let n = story.last().len();
    // when each node arrives to stay
    let stays: Vec<Vec<bool>> = story
        .run
        .frames
        .iter()
        .map(|frame| story.truth.stuck(frame.nodes()))
        .collect();
    let arrival = |node: usize| {
        let away = stays.iter().rposition(|stuck| !stuck[node]);
        away.map_or(0.0, |i| {
            story
                .run
                .frames
                .get(i + 1)
                .map_or(f64::INFINITY, |frame| frame.t)
        })
    };
    let arrivals: Vec<f64> = (0..n).map(arrival).collect();
    let ends = (0..10)
        .chain(n - 10..n)
        .map(|i| arrivals[i])
        .fold(0.0_f64, f64::max);
    let at = story.at(100.0);
    let highest = (0..n)
        .min_by(|&a, &b| at[a].y.total_cmp(&at[b].y))
        .unwrap_or(0);
    let moment = Tolerance::Absolute(4.1);
    record.note("ends on the contour for good from", ends, "", moment);
    record.note(
        "top on the contour for good from",
        arrivals[highest],
        "",
        moment,
    );
    record.note(
        "node that is the top at t = 100",
        real(highest),
        "",
        Tolerance::EXACT,
    );
    let elastic = |t: f64| {
        let frame = story.run.frames.iter().find(|frame| frame.t >= t - 1e-9);
        frame
            .and_then(|frame| frame.energies.as_ref())
            .map_or(f64::NAN, snake::Energies::elastic)
    };
    let few = Tolerance::Absolute(1.0);
    record.note(
        "elastic energy while held (t = 100)",
        elastic(100.0),
        "",
        few,
    );
    record.note("elastic energy at the end", elastic(420.0), "", few);
    record.note("top at the end", top(story.last()).y, "px", PLACE);
    record.note(
        "mean distance at the end",
        story.truth.mean_distance(story.last()).0,
        "px",
        PLACE,
    );
    let nodes = (0..n).map(real).collect();
    record.keep(
        crate::Table::new("arrival")
            .with("node", "", Tolerance::EXACT, nodes)
            .with("on the contour for good from", "", moment, arrivals),
    );
    story.keep(&mut record, Some(10), PLACE);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut picture = all_over(record, &MOMENTS, false)?;
    picture.share = 1.15;
    let (height, stuck) = height_and_stuck(record)?;
    let distance = over_time(
        record,
        "fine",
        &[("distance", "", Color::RED)],
        "mean distance to the contour outside the boxes",
        "px",
    )?;
    let elastic = over_time(
        record,
        "energy",
        &[
            ("elastic", "elastic", Color::RED),
            ("tether", "of it, tether", Color::ORANGE),
            ("kinetic", "kinetic", Color::BLUE),
        ],
        "energy of deformation and motion",
        "energy",
    )?;
    let image = over_time(
        record,
        "energy",
        &[
            ("image", "picture", Color::GREEN),
            ("total", "sum", Color::INK),
        ],
        "energy in the picture, and the sum",
        "energy",
    )?;
    let mark = |panel| marked(panel, &MOMENTS[3..], &LETTERS[3..]);
    let arrival = crate::draw::Panel::new(
        "when each node is on the contour to stay",
        crate::draw::Axis::new("node", 0.0, 79.0),
        crate::draw::Axis::new("t", 0.0, 420.0),
    )
    .with(crate::draw::Layer::Dots {
        points: record.points("arrival", "node", "on the contour for good from")?,
        radius: 1.4,
        color: Color::BLUE,
        label: String::new(),
    });
    let figure = Figure::new(
        "Figures 4.6 to 4.8  The apple, and the stem that is in the way",
        1000.0,
    )
    .with(430.0, vec![picture, arrival])
    .with(340.0, vec![window(record, &MOMENTS, [130, 0, 320, 70])?])
    .with(220.0, vec![mark(height), mark(stuck), mark(distance)])
    .with(220.0, vec![elastic, image.legend_at(Corner::TopRight)]);
    let frames: Vec<usize> = (0..=30).chain((32..210).step_by(2)).collect();
    Ok(vec![
        Artefact::figure(
            "All fourteen moments over the picture, and enlarged where the stem holds the snake; when each node arrives; height of the top, stuck part, distance; energies.",
            figure,
        ),
        Artefact::further(
            "moving",
            "The same in motion: yellow the snake, blue where it is on the contour.",
            Body::Animation(animation(record, false, &frames, 300)?),
        ),
    ])
}

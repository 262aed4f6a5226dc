//! The whole story of Figures 4.6 to 4.8 on one page, and in motion.

use super::draw::{all_over, animation, height_and_stuck, marked, window};
use super::story::top;
use super::{LETTERS, MOMENTS, PLACE, tell};
use crate::prelude::*;

/// All curves over the picture, with graphs.
pub(crate) const OVERVIEW: Experiment = Experiment {
    id: "sec-4-3-apple",
    title: "The apple, whole",
    place: "§4.3",
    question: "Figures 4.6 to 4.8 in one: when does each part of the snake reach the contour, and what holds the rest?",
    claims: &[
        claim("the ends stick first: they are on the contour when the top is still held [report §4.3]")
            .when(&[
                below("ends on the contour for good from", 20.0),
                above("top on the contour for good from", 250.0),
            ]),
        claim("the energy of deformation falls when the middle lets go [report §4.3]").when(&[less(
            "elastic energy at the end",
            0.6,
            "elastic energy while held (t = 100)",
        )]),
        claim("it ends within 2 px of the contour drawn by hand, in the mean [our aim]")
            .when(&[below("mean distance at the end", 2.0)]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let story = tell()?;
    let mut record = Record::default();
    let (frames, n) = (&story.run.frames, story.last().len());
    // when each node arrives to stay
    let stays = frames.iter().map(|frame| story.truth.stuck(frame.nodes()));
    let stays: Vec<Vec<bool>> = stays.collect();
    let arrival = |node: usize| match stays.iter().rposition(|stuck| !stuck[node]) {
        Some(away) => frames.get(away + 1).map_or(f64::INFINITY, |frame| frame.t),
        None => 0.0,
    };
    let arrivals: Vec<f64> = (0..n).map(arrival).collect();
    let ends = most((0..10).chain(n - 10..n).map(|i| arrivals[i]));
    let at = story.at(100.0);
    let highest = (0..n)
        .min_by(|&a, &b| at[a].y.total_cmp(&at[b].y))
        .unwrap_or(0);
    let moment = 4.1;
    record.note("ends on the contour for good from", ends, moment);
    record.note(
        "top on the contour for good from",
        arrivals[highest],
        moment,
    );
    record.note("node that is the top at t = 100", real(highest), EXACT);
    let elastic = |t: f64| {
        let frame = frames.iter().find(|frame| frame.t >= t - 1e-9);
        let energies = frame.and_then(|frame| frame.energies.as_ref());
        energies.map_or(f64::NAN, snake::Energies::elastic)
    };
    record.note("elastic energy while held (t = 100)", elastic(100.0), 1.0);
    record.note("elastic energy at the end", elastic(420.0), 1.0);
    record.note("top at the end [px]", top(story.last()).y, PLACE);
    let mean = story.truth.mean_distance(story.last()).0;
    record.note("mean distance at the end [px]", mean, PLACE);
    let table = Table::new("arrival").exact("node", (0..n).map(real));
    record.keep(table.with("on the contour for good from", moment, arrivals));
    story.keep(&mut record, Some(10), PLACE);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut picture = all_over(record, &MOMENTS)?;
    picture.share = 1.15;
    let (height, stuck) = height_and_stuck(record)?;
    let title = "mean distance to the contour outside the boxes";
    let distance = over_time(record, "fine", &[("distance", "", Color::RED)], title, "px")?;
    let terms = [
        ("elastic", "elastic", Color::RED),
        ("tether", "of it, tether", Color::ORANGE),
        ("kinetic", "kinetic", Color::BLUE),
    ];
    let elastic = energies(record, "curves", &terms, "energy of deformation and motion")?;
    let terms = [
        ("image", "picture", Color::GREEN),
        ("total", "sum", Color::INK),
    ];
    let image = energies(
        record,
        "curves",
        &terms,
        "energy in the picture, and the sum",
    )?;
    let mark = |panel| marked(panel, &MOMENTS[3..], &LETTERS[3..]);
    let arrivals = record.points("arrival", "node", "on the contour for good from")?;
    let title = "when each node is on the contour to stay";
    let arrival = plot(title, ("node", 0.0, 79.0), ("t", 0.0, 420.0));
    let arrival = arrival.with(dots(arrivals, 1.4, Color::BLUE));
    let title = "Figures 4.6 to 4.8  The apple, and the stem that is in the way";
    let figure = Figure::new(title, 1000.0)
        .with(430.0, vec![picture, arrival])
        .with(340.0, vec![window(record, &MOMENTS, [130, 0, 320, 70])?])
        .with(220.0, vec![mark(height), mark(stuck), mark(distance)])
        .with(220.0, vec![elastic, image]);
    let frames = (0..=30).chain((32..210).step_by(2));
    Ok(vec![
        Artefact::figure(
            "All fourteen moments over the picture, and enlarged where the stem holds the snake; when each node arrives; height of the top, stuck part, distance; energies.",
            figure,
        ),
        Artefact::further(
            "moving",
            "The same in motion: yellow the snake, blue where it is on the contour.",
            animation(record, false, frames, 300)?,
        ),
    ])
}

//! Report §4.3: a snake finds an apple although a false edge is in its way (Figures 4.6 to 4.8).

mod closed;
mod draw;
mod drawn;
mod frames;
mod hand;
mod overview;
mod rules;
mod story;

pub(crate) use closed::CLOSED;
pub(crate) use drawn::DRAWN;
pub(crate) use frames::{FIRST, SECOND, THIRD};
pub(crate) use hand::HAND;
pub(crate) use overview::OVERVIEW;
pub(crate) use rules::RULES;

use crate::draw::Figure;
use crate::{Artefact, Record, SandboxError, Tolerance};
use story::{Story, Truth, share, top};

/// The fourteen moments, a to n.
const MOMENTS: [f64; 14] = [
    0.0, 4.0, 10.0, 20.0, 100.0, 148.0, 170.0, 194.0, 220.0, 244.0, 268.0, 288.0, 304.0, 420.0,
];
const LETTERS: &str = "abcdefghijklmn";
/// What a position may differ by on another machine, in pixels.
const PLACE: Tolerance = Tolerance::Absolute(1e-3);

fn tell(id: &'static str) -> Result<Story, SandboxError> {
    Story::of(id, "apple", &[], Truth::apple(id)?)
}

/// Notes the top and the stuck share at each moment, and keeps what is drawn.
fn noted(story: &Story) -> Record {
    let mut record = Record::default();
    for (t, letter) in MOMENTS.into_iter().zip(LETTERS.chars()) {
        let nodes = story.at(t);
        record.note(format!("{letter}: top"), top(nodes).y, "px", PLACE);
        let stuck = story.truth.stuck(nodes);
        record.note(
            format!("{letter}: stuck"),
            share(&stuck),
            "of the nodes",
            Tolerance::Absolute(0.03),
        );
    }
    record
}

/// Frames from one letter to another in rows of three.
fn strip(
    record: &Record,
    title: &str,
    from: usize,
    to: usize,
    caption: &'static str,
) -> Result<Vec<Artefact>, SandboxError> {
    let mut figure = Figure::new(title, if to - from > 2 { 870.0 } else { 580.0 });
    let panels = (from..to)
        .zip(LETTERS.chars().skip(from))
        .map(|(i, letter)| draw::frame_panel(record, &letter.to_string(), MOMENTS[i], false))
        .collect::<Result<Vec<_>, SandboxError>>()?;
    for row in panels.chunks(3) {
        figure = figure.with(310.0, row.to_vec());
    }
    Ok(vec![Artefact::figure(caption, figure)])
}

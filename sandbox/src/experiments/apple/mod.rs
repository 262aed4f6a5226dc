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

use crate::prelude::*;
use story::{Story, Truth, share_of, top};

/// The fourteen moments, a to n.
const MOMENTS: [f64; 14] = [
    0.0, 4.0, 10.0, 20.0, 100.0, 148.0, 170.0, 194.0, 220.0, 244.0, 268.0, 288.0, 304.0, 420.0,
];
const LETTERS: &str = "abcdefghijklmn";
/// What a position may differ by on another machine, in pixels.
const PLACE: f64 = 1e-3;

fn tell() -> Result<Story> {
    Story::of("apple", &[], Truth::apple()?)
}

/// Notes the top and the stuck share at each moment, and keeps what is drawn.
fn noted(story: &Story) -> Record {
    let mut record = Record::default();
    for (t, letter) in MOMENTS.into_iter().zip(LETTERS.chars()) {
        let nodes = story.at(t);
        record.note(format!("{letter}: top [px]"), top(nodes).y, PLACE);
        let stuck = share_of(&story.truth.stuck(nodes));
        record.note(format!("{letter}: stuck [of the nodes]"), stuck, 0.03);
    }
    record
}

/// Frames from one letter to another in rows of three.
fn strip(
    record: &Record,
    title: &str,
    letters: std::ops::Range<usize>,
    caption: &'static str,
) -> Drawn {
    let figure = Figure::new(title, if letters.len() > 2 { 870.0 } else { 580.0 });
    let panels = letters.map(|i| draw::frame_panel(record, &LETTERS[i..=i], MOMENTS[i], false));
    let panels = panels.collect::<Result<Vec<_>>>()?;
    let rows = panels.chunks(3);
    Artefact::only(
        caption,
        rows.fold(figure, |figure, row| figure.with(310.0, row.to_vec())),
    )
}

//! What is said of a track: to people on the way and in the end, and as JSON.

use indicatif::{ProgressBar, ProgressStyle};
use scene::SceneError;
use serde_json::json;

use super::course::Course;
use crate::args::Words;
use crate::fit::counted;

/// A bar on standard error; without an end where nobody knows it.
pub(super) fn bar(total: Option<usize>, from: usize, words: Words) -> ProgressBar {
    if words.quiet {
        return ProgressBar::hidden();
    }
    let (bar, template) = match total {
        Some(total) => (
            ProgressBar::new(total as u64),
            "{bar:40} {pos}/{len} frames, {eta} left",
        ),
        None => (
            ProgressBar::no_length(),
            "{spinner} {pos} frames, {per_sec}",
        ),
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.set_position(from as u64 + 1);
    bar
}

/// Say how it ended; whether all is good.
pub(super) fn summary(
    course: &Course,
    left: Option<usize>,
    stopped: bool,
    words: Words,
) -> Result<bool, SceneError> {
    let tally = &course.tally;
    let mut text = format!(
        "{} followed through {}",
        counted(tally.objects.len(), "object"),
        counted(tally.frames, "frame")
    );
    let mut add = |count: usize, what: &str| {
        if count > 0 {
            text.push_str(&format!(", {count} {what}"));
        }
    };
    add(tally.divided, "divided");
    add(tally.born, "born");
    add(tally.lost.len(), "lost");
    add(tally.hidden.len(), "not seen in the last");
    add(tally.unsure.len(), "unsure from the start");
    add(
        tally.uncertain.len(),
        "whose numbers may have been exchanged",
    );
    words.say(&text);
    if tally.coasting > 0 {
        words.say(&format!(
            "{} of {} not seen in their frames",
            counted(tally.coasting, "outline"),
            tally.outlines
        ));
    }
    if !tally.broken.is_empty() {
        words.say(&format!(
            "{} could not be used",
            counted(tally.broken.len(), "frame")
        ));
    }
    let good = !stopped
        && tally.broken.is_empty()
        && tally.lost.is_empty()
        && tally.hidden.is_empty()
        && tally.unsure.is_empty();
    words.end(&json!({
        "frames": tally.frames,
        "last_frame": tally.last,
        "objects": tally.objects.len(),
        "outlines": tally.outlines,
        "coasting": tally.coasting,
        "divided": tally.divided,
        "born": tally.born,
        "lost": tally.lost,
        "hidden_at_end": tally.hidden,
        "unsure": tally.unsure,
        "uncertain": tally.uncertain,
        "broken_frames": tally.broken,
        "left": left,
        "stopped": stopped,
        "good": good,
    }))?;
    Ok(good)
}

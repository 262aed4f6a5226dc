//! A sequence: frames that are shown one by one, and outlines that are followed through them.

use std::sync::Arc;

use scene::fit::{Contour, Image};
use track::{Event, Happening, Options, Start, State, Tracked, Tracker};

use super::{One, Pictures, decoded, prepared};
use crate::LiveError;

/// Outlines on their way through frames.
#[derive(Debug, Clone)]
pub(crate) struct Following {
    tracker: Arc<Tracker>,
    /// The frame that the tracker has come to.
    frame: usize,
    /// Numbers of the outlines, by those of the tracker.
    ids: Vec<u32>,
}

impl Pictures {
    /// Show a frame.
    pub(super) fn go(&mut self, frame: usize) -> Result<(), LiveError> {
        let count = self.frames.len();
        let Some(kept) = self.frames.get(frame) else {
            return Err(LiveError::new(format!(
                "the sequence has {count} frames from 0, got frame {frame}"
            )));
        };
        if frame == self.now {
            return Ok(());
        }
        let picture = decoded(&kept.name, &kept.bytes)?;
        let prepared = prepared(&picture, self.valid.as_deref())?;
        self.store();
        (self.picture, self.prepared, self.now) = (picture, prepared, frame);
        self.outlines = self
            .others
            .remove(&frame)
            .map_or_else(Default::default, |outlines| (*outlines).clone());
        self.version += 1;
        Ok(())
    }

    /// Keep the outlines of the frame that is shown.
    fn store(&mut self) {
        let outlines = std::mem::take(&mut self.outlines);
        if outlines.is_empty() {
            self.others.remove(&self.now);
        } else {
            self.others.insert(self.now, Arc::new(outlines));
        }
    }

    /// Follow the outlines of this frame into those behind it.
    pub(super) fn track(&mut self) -> Result<(), LiveError> {
        if self.now + 1 >= self.frames.len() {
            return Err(LiveError::new(
                "this is the last frame; there is none to follow outlines into",
            ));
        }
        let closed: Vec<(u32, &One)> = self
            .outlines
            .iter()
            .filter(|(_, one)| one.closed)
            .map(|(id, one)| (*id, &**one))
            .collect();
        if closed.is_empty() {
            return Err(LiveError::new(
                "this frame has no closed outline to be followed",
            ));
        }
        let starts: Vec<Contour> = closed
            .iter()
            .map(|(_, one)| Contour::closed(one.points.clone()))
            .collect();
        let options = Options {
            // what is shown was found or mended here
            start: Start::Exact,
            ..Options::default()
        };
        let image = Image::of(Arc::<io::Picture>::clone(&self.picture));
        let tracker = Tracker::new(&image, &starts, &options).map_err(LiveError::of)?;
        let ids = closed.iter().map(|(id, _)| *id).collect();
        self.facts.insert(self.now);
        self.following = Some(Following {
            tracker: Arc::new(tracker),
            frame: self.now,
            ids,
        });
        Ok(())
    }

    /// One frame on, where outlines are being followed. A frame that was mended by hand is a fact: there it ends.
    pub(super) fn follow(&mut self) {
        let Some(mut following) = self.following.take() else {
            return;
        };
        let next = following.frame + 1;
        if next >= self.frames.len() || self.facts.contains(&next) {
            return;
        }
        let tracker = Arc::make_mut(&mut following.tracker);
        let kept = self.frames[next].clone();
        let tracked = match decoded(&kept.name, &kept.bytes) {
            Ok(picture) => match tracker.next(&Image::of(picture)) {
                Ok(tracked) => tracked,
                Err(_) => tracker.skip(),
            },
            // a frame that cannot be read is flown over
            Err(_) => tracker.skip(),
        };
        let outlines = tracked.outlines.iter().map(|outline| {
            (
                following.id(outline.id),
                Arc::new(self.one_of(outline, following.id(outline.id))),
            )
        });
        let outlines = outlines.collect();
        let words = said(&tracked, &following);
        if self.go(next).is_ok() {
            self.outlines = outlines;
            self.events.insert(next, words);
            following.frame = next;
            if !tracked.outlines.is_empty() {
                self.following = Some(following);
            }
        }
    }

    /// An outline of a frame as it is shown.
    fn one_of(&self, outline: &track::Outline, id: u32) -> One {
        let before = self.outlines.get(&id);
        let sure = outline.confidence.clamp(0.0, 1.0);
        One {
            label: before.map_or_else(|| format!("outline {id}"), |one| one.label.clone()),
            class: before.map_or_else(String::new, |one| one.class.clone()),
            closed: true,
            strength: vec![sure; outline.points.len()],
            error: outline.errors.iter().map(|error| Some(*error)).collect(),
            sure: outline.state == State::Seen,
            words: format!("{:?}, confidence {sure:.2}", outline.state).to_lowercase(),
            start: before.map_or_else(Vec::new, |one| one.points.clone()),
            points: outline.points.clone(),
            ..One::default()
        }
    }
}

impl Following {
    /// The number of an outline by that of the tracker.
    fn id(&self, of: u32) -> u32 {
        let index = usize::try_from(of).ok().and_then(|of| of.checked_sub(1));
        index
            .and_then(|index| self.ids.get(index).copied())
            .unwrap_or(1_000_000 + of)
    }
}

/// What happened in a frame, in words.
fn said(tracked: &Tracked, following: &Following) -> Vec<String> {
    let words = |event: &Event| {
        let id = following.id(event.id);
        let what = match &event.what {
            Happening::Hidden => "is hidden",
            Happening::Found => "is seen again",
            Happening::Left => "has left the frame",
            Happening::Lost => "is lost",
            Happening::Merged(_) => "cannot be told from another one any more",
            Happening::Uncertain(_) => "may have been taken for another one from here on",
            Happening::Skipped => "was carried over a frame that could not be read",
            _ => return None,
        };
        Some(format!("outline {id} {what} ({:.2})", event.confidence))
    };
    tracked.events.iter().filter_map(words).collect()
}

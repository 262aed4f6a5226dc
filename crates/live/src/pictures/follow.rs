//! A sequence: frames that are shown one by one, and outlines that are followed through them.

use std::collections::BTreeMap;
use std::sync::Arc;

use scene::fit::{Contour, Image};
use track::{Event, Happening, Options, Start, State, Tracked, Tracker};

use super::{One, Pictures, prepared};
use crate::LiveError;

/// Outlines on their way through frames.
#[derive(Debug, Clone)]
pub(crate) struct Following {
    tracker: Arc<Tracker>,
    /// The frame that the tracker has come to.
    frame: usize,
    /// Numbers of the outlines, by those of the tracker.
    ids: BTreeMap<u32, u32>,
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
        let picture = self.fitting(kept)?;
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
    pub(super) fn track(&mut self, births: bool) -> Result<(), LiveError> {
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
            births,
            ..Options::default()
        };
        let image = Image::of(Arc::<io::Picture>::clone(&self.picture));
        let tracker = Tracker::new(&image, &starts, &options).map_err(LiveError::of)?;
        let ids = (1..).zip(closed.iter().map(|(id, _)| *id)).collect();
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
        let tracked = match self.fitting(&kept) {
            Ok(picture) => match tracker.next(&Image::of(picture)) {
                Ok(tracked) => tracked,
                Err(_) => tracker.skip(),
            },
            // a frame that cannot be read is flown over
            Err(_) => tracker.skip(),
        };
        for outline in &tracked.outlines {
            let new = self.next_id;
            let id = *following.ids.entry(outline.id).or_insert(new);
            self.next_id = self.next_id.max(id + 1);
        }
        let outlines = tracked.outlines.iter().map(|outline| {
            let id = following.id(outline.id);
            (id, Arc::new(self.one_of(outline, id)))
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
        self.ids.get(&of).copied().unwrap_or(of)
    }
}

/// What happened in a frame, in words.
fn said(tracked: &Tracked, following: &Following) -> Vec<String> {
    let words = |event: &Event| {
        let id = following.id(event.id);
        let what = match &event.what {
            Happening::Hidden => "is hidden".to_owned(),
            Happening::Found => "is seen again".to_owned(),
            Happening::Left => "has left the frame".to_owned(),
            Happening::Lost => "is lost".to_owned(),
            Happening::Divided([a, b]) => format!(
                "has become outlines {} and {}",
                following.id(*a),
                following.id(*b)
            ),
            Happening::Born => "is new".to_owned(),
            Happening::Merged(other) => format!(
                "cannot be told from outline {} any more",
                following.id(*other)
            ),
            Happening::Uncertain(other) => format!(
                "may have been exchanged with outline {} from here on",
                following.id(*other)
            ),
            Happening::Skipped => "was carried over a frame that could not be read".to_owned(),
            _ => return None,
        };
        Some(format!("outline {id} {what} ({:.2})", event.confidence))
    };
    tracked.events.iter().filter_map(words).collect()
}

//! Outlines given by hand on the way.

use fit::Image;
use glam::DVec2;

use crate::body::Body;
use crate::holes;
use crate::step::{Frame, Step};
use crate::tracker::Object;
use crate::{Event, Happening, TrackError, Tracker};

impl Tracker {
    /// Set the outline of an object in the last frame, by hand: tracking goes on from there.
    ///
    /// # Errors
    ///
    /// No such object; an outline without area in the frame; a frame of another size.
    pub fn mend(&mut self, frame: &Image, id: u32, outline: &[DVec2]) -> Result<Event, TrackError> {
        let (needed, got) = (self.size, frame.size());
        if needed != got {
            return Err(TrackError::Size {
                frame: self.frame,
                needed,
                got,
            });
        }
        let known = self.objects.iter().map(|object| object.id).collect();
        let (width, height) = self.size;
        let Some(object) = self.objects.iter_mut().find(|object| object.id == id) else {
            return Err(TrackError::NoObject { id, known });
        };
        let frame = &holes::filled(frame);
        let now = Frame {
            pixels: frame.pixels(),
            pyramid: &self.before,
            before: None,
        };
        object.body = Body::new(now, outline).ok_or(TrackError::Start {
            index: 0,
            width,
            height,
        })?;
        (object.unseen, object.gone) = (0, 0);
        object.step = Step::begun();
        Ok(Event {
            frame: self.frame,
            id,
            what: Happening::Mended,
            confidence: 1.0,
        })
    }

    /// Take up one more object in the last frame: its number.
    ///
    /// # Errors
    ///
    /// An outline without area in the frame; a frame of another size.
    pub fn take_up(&mut self, frame: &Image, outline: &[DVec2]) -> Result<u32, TrackError> {
        let (needed, got) = (self.size, frame.size());
        if needed != got {
            return Err(TrackError::Size {
                frame: self.frame,
                needed,
                got,
            });
        }
        let frame = &holes::filled(frame);
        let now = Frame {
            pixels: frame.pixels(),
            pyramid: &self.before,
            before: None,
        };
        let (width, height) = self.size;
        let body = Body::new(now, outline).ok_or(TrackError::Start {
            index: 0,
            width,
            height,
        })?;
        let id = self.next_id;
        self.next_id += 1;
        self.objects.push(Object::new(id, None, body, self.frame));
        Ok(id)
    }
}

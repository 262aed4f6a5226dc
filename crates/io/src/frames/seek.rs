//! Frames in any order, where what they come from has one.

use super::{Frames, Source};

impl Frames {
    /// Whether frames can be read in any order: files and pages can, videos and streams cannot.
    #[must_use]
    pub fn is_seekable(&self) -> bool {
        let fixed = |source: &Source| matches!(source, Source::File(_) | Source::Pages(..));
        self.sources.iter().all(fixed)
    }

    /// Go to the frame of that place, which is read next; behind the last, there is none then. Whether that could be
    /// done: nothing changes where [`Frames::is_seekable`] says no.
    pub fn seek(&mut self, index: usize) -> bool {
        if !self.is_seekable() {
            return false;
        }
        for source in &mut self.sources {
            if let Source::Pages(_, page) = source {
                *page = 0;
            }
        }
        (self.current, self.next) = (0, 0);
        self.pass(index);
        true
    }

    /// The place of a frame by its number or by the name of its file.
    #[must_use]
    pub fn place_of(&self, text: &str) -> Option<usize> {
        if let Ok(index) = text.parse::<usize>() {
            return self
                .total
                .is_none_or(|total| index < total)
                .then_some(index);
        }
        let single = self.total == Some(self.files.len());
        let named = |file: &std::path::PathBuf| {
            file.file_name().is_some_and(|name| name == text) || file.as_os_str() == text
        };
        self.files.iter().position(named).filter(|_| single)
    }
}

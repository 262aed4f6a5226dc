//! How objects are followed.

/// How a start is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Start {
    /// Exactly as it is.
    Exact,
    /// As drawn roughly: the outline that is found about it, always.
    Rough,
    /// The outline that is found about it, unless it is nearly the start itself.
    #[default]
    Chosen,
}

/// How objects are followed. The default is for all kinds of pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// How starts are taken.
    pub start: Start,
    /// How an outline is found about a rough start.
    pub fit: fit::Options,
    /// An object that was not seen for so many frames is given up.
    pub patience: u32,
    /// Threads for many objects; results do not depend on it.
    pub threads: usize,
    /// Whether objects may divide, and new ones be born: for cells and the like.
    pub births: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            start: Start::Chosen,
            fit: fit::Options::default(),
            patience: 30,
            threads: 1,
            births: false,
        }
    }
}

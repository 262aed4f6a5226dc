//! How objects are looked for: every number that was chosen, with its meaning.

/// How objects are looked for. Prices are in edges as strong as there can be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// What it is worth to take in a tenth of an inner radius of pixels that are e times likelier inside than outside.
    pub region: f64,
    /// Price of a step by one place from one ray to the next.
    pub bend: f64,
    /// An outline is none if the mean strength of its edge is below this.
    pub unsure: f64,
    /// How far the last stage may move an outline, in pixels; 0 for no last stage.
    pub reach: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            region: 0.05,
            bend: 0.03,
            unsure: 0.3,
            reach: 1.5,
        }
    }
}

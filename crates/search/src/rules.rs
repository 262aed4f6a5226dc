//! How a search goes: every number that was chosen, with its meaning.

/// Which way the color across an outline is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sign {
    /// As between the middle of the start and its surroundings.
    #[default]
    Learnt,
    /// Brighter inside.
    Brighter,
    /// Darker inside.
    Darker,
    /// Any edge.
    Either,
}

/// How a search goes. Lengths are in radii of a disk of the start's area, prices in edges as strong as there can be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// Price of an outline one radius from the start. It is looked for with ten times and a third of that too.
    pub tether: f64,
    /// What it is worth to take in a tenth of a radius of pixels that are e times likelier inside than outside.
    pub region: f64,
    /// How far inside and outside the start the tethered search looks.
    pub inward: f64,
    /// See `inward`.
    pub outward: f64,
    /// What the outermost place is worth to the search within, against the middle.
    pub outer: f64,
    /// Which way the color across the outline is looked for.
    pub sign: Sign,
    /// An outline is accepted at once if four fifths of it have an edge this strong, or one of a single polarity and
    /// at least `unsure`.
    pub sure: f64,
    /// Below this an outline is none.
    pub unsure: f64,
    /// Share of pixels that must be told apart by what they look like for a region of any shape to be taken; 1 for
    /// never.
    pub pure: f64,
    /// How far around a start that lies inside an outline is looked for; 1 for not at all.
    pub around: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            tether: 10.0,
            region: 0.05,
            inward: 0.35,
            outward: 0.08,
            outer: 0.2,
            sign: Sign::Learnt,
            sure: 0.46,
            unsure: 0.3,
            pure: 0.97,
            around: 3.2,
        }
    }
}

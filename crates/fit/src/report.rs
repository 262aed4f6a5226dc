//! What a search measured, what it chose and how it ended, in plain words.

use std::fmt;

use glam::DVec2;
use search::{Search, Seen, Support};
use subpixel::Blurred;

/// What was measured and chosen by a search.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Searched {
    /// What was measured about the start.
    pub seen: Seen,
    /// What speaks for each curve that was found, the one about the start first.
    pub found: Vec<(Search, Support)>,
    /// These curves, closed or open as the outline.
    pub curves: Vec<Vec<DVec2>>,
    /// Which of them was taken; None for none: the start was given back.
    pub taken: Option<usize>,
    /// Whether it was taken though another was closed better, since that one folds or has collapsed.
    pub instead: bool,
    /// Whether the start lay inside, and the outline was looked for around it.
    pub around: bool,
    /// Whether the start crossed itself, and its largest part was taken.
    pub repaired: bool,
    /// Size of a pixel of the window that was searched. Pixels.
    pub pixel: f64,
    /// What speaks for the outline after the last stage.
    pub support: Support,
    /// What the last stage measured of the edge; None where it left the outline as it was found.
    pub edge: Option<Blurred>,
    /// Number of nodes.
    pub nodes: usize,
}

fn name(search: Search) -> &'static str {
    match search {
        Search::Near => "near the start",
        Search::Close => "close to the start",
        Search::Loose => "loose from the start",
        Search::Wider => "a little beyond the start",
        Search::Within => "within the start",
        Search::Region => "by likeness to the inside",
        Search::Again => "once more about it",
    }
}

impl fmt::Display for Searched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seen = &self.seen;
        if self.repaired {
            writeln!(f, "start: crosses itself; its largest part was taken")?;
        }
        if self.around {
            writeln!(
                f,
                "start: no edge there or within; it lies inside, and was looked around"
            )?;
        }
        let than = match seen.brighter {
            Some(true) => "brighter than",
            Some(false) => "darker than",
            None => "of another color than",
        };
        writeln!(
            f,
            "contrast: the middle of the start is {than} what is around it, by {:.1} of 100; noise {:.1}",
            seen.contrast, seen.noise
        )?;
        writeln!(
            f,
            "edge: a slope of {:.1} a pixel counts as half an edge (a pixel of the search is {:.2} pixels)",
            seen.half, self.pixel
        )?;
        for (index, (search, support)) in self.found.iter().enumerate() {
            let mark = if self.taken == Some(index) {
                "taken"
            } else {
                "not taken"
            };
            writeln!(
                f,
                "{}: edge {:.2} on four fifths of the curve, {:.2} in the mean, {:.2} of one polarity; {mark}",
                name(*search),
                support.closed,
                support.edge,
                support.polar
            )?;
        }
        if self.instead {
            writeln!(
                f,
                "instead: a curve that was closed better folds, crosses itself or has collapsed"
            )?;
        }
        match &self.edge {
            Some(edge) => write!(
                f,
                "last stage: {} nodes on the edge, blurred by {:.2} pixels; noise {:.2} levels; waves below {:.0} pixels smoothed",
                self.nodes,
                edge.blur,
                edge.noise,
                std::f64::consts::TAU * edge.length
            ),
            None => write!(
                f,
                "last stage: {} nodes, left where they were found: no blurred step explains the picture across them",
                self.nodes
            ),
        }
    }
}

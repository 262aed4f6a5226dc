//! Drawing: what a figure consists of, and how it becomes bytes.
//!
//! A [`Figure`] is data: rows of [`Panel`]s, each with two axes and a list of [`Layer`]s. One
//! function turns it into SVG; an [`Animation`] is turned into a GIF the same way. There is one
//! palette, one line weight, no font file and no clock, so the same record always gives the same
//! bytes. Nothing here knows what a snake is.
//!
//! What it cannot do: three dimensions, axes on the right, pictures that are not grids.

mod animation;
mod chart;
mod embed;
mod figure;
mod frame;
mod legend;
mod palette;
mod panel;
mod pixels;
mod raster;
mod short;

pub use animation::{Animation, Shot, Stroke};
pub use figure::{DrawError, Figure, Row};
pub use palette::{Color, diverging, sequential};
pub use panel::{Axis, Corner, Dash, Layer, Line, Panel, Picture, Scale};
pub use pixels::{arrows, grey, shrunk, signed, strongest_arrows};
pub use short::{Dots, area, arrow, circle, dots, line, plot, text};

//! The flags of `snake eval` as typed.

use std::num::NonZero;
use std::path::PathBuf;

use clap::{Args as ClapArgs, ValueEnum};

use crate::args::{Change, Polarity};

/// What the codes mean, in the help.
pub(crate) const CODES: &str = "\
DIR holds manifest.csv (columns file and mask: pictures, and masks of their objects in white on black) and inits.csv \
(columns stem, quality and points: the picture's name without its ending, a name for the kind of start, and a closed \
polygon as `x y;x y;...` in pixels, the first pixel's center at 0 0).\n\n\
The table has a row a quality: number of fits; mean IoU of the starts; mean and median IoU of the outlines found; mean \
of the mean distance and of the Hausdorff distance to the truth, pixels; mean boundary F at 2 pixels; how many lost \
more than 0.02 of their start's IoU; how many `snake fit` would be unsure of (exit code 1), and would refuse; the share \
of the nodes whose 95 % band holds the truth, if the fit states any; CPU seconds a fit, with making the picture ready \
and without reading it (with --jobs above 1 those of its thread alone). What blew up or was refused counts as IoU 0 and \
F 0, and has no distance.\n\n\
A manifest with the columns sequence and frame is of sequences: one object is followed through each, from the starts \
`near` and `true` (the true outline of the first frame) if no quality is given. A row a sequence and start: number of \
frames after the first; mean IoU, that of the last frame and the least; mean boundary F at 2 pixels; J&F as the DAVIS \
challenge takes it; mean distance, pixels; the share of frames with an IoU below 0.3, and of those that are and were \
said to be sure; CPU milliseconds a frame; of drawn ones, events told within a frame (returns: two) of all there are, \
and those told where there is none. Folders as 01 and 01_GT/TRA are sequences of many objects as the Cell \
Tracking Challenge has them: SEG, DET, TRA, IDF1, switches of identity, F1 of divisions within a frame.\n\n\
Exit code 0: all was scored. 1: what was broken is reported and left out, or Ctrl-C stopped it. 2: refused, and why.";

/// Where many objects in a picture are looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum SeedKind {
    /// About the circles of the file of starts, which is the default.
    #[default]
    Circles,
    /// About the middles of these circles, as if their size was not known.
    Points,
    /// Everywhere; the file of starts only says which pictures.
    Auto,
}

#[derive(Debug, ClapArgs)]
pub(crate) struct Eval {
    /// The folder of the data set; or `synthetic` or `sequences`, drawn pictures and sequences whose truth is a
    /// formula.
    #[arg(value_name = "DIR")]
    pub set: PathBuf,
    /// A file of starts, in DIR or by its path; may be given again. inits.csv if not given.
    #[arg(long, value_name = "FILE")]
    pub inits: Vec<PathBuf>,
    /// Only starts of this quality; may be given again.
    #[arg(long, value_name = "NAME")]
    pub quality: Vec<String>,
    /// Give a rule of the search another value, as `snake fit --set` does; may be given again.
    #[arg(long = "set", value_name = "RULE=VALUE")]
    pub rules: Vec<Change>,
    /// Which edges attract, going outwards, as of `snake fit`; learnt if not given.
    #[arg(long, value_enum)]
    pub polarity: Option<Polarity>,
    /// Where many objects in a picture are looked for.
    #[arg(long, value_name = "WHERE", value_enum)]
    pub seeds: Option<SeedKind>,
    /// Write a row a fit: stem, quality, scores, outcome and CPU seconds.
    #[arg(long, value_name = "CSV")]
    pub each: Option<PathBuf>,
    /// Invert the pictures: 255 less each level.
    #[arg(long)]
    pub invert: bool,
    /// Multiply all levels by K, above 0 and at most 1, and round them.
    #[arg(long, value_name = "K", allow_negative_numbers = true)]
    pub darken: Option<f64>,
    /// Turn pictures and starts clockwise: 90, 180 or 270 degrees.
    #[arg(long, value_name = "DEGREES")]
    pub turn: Option<u32>,
    /// Enlarge pictures and starts twofold, by bilinear interpolation.
    #[arg(long)]
    pub double: bool,
    /// How many of the worst results to draw; 12 if not given.
    #[arg(long, value_name = "N")]
    pub worst: Option<usize>,
    /// Draw the worst results: the start blue, the truth green, the outline found orange. A name that ends in .png is
    /// one sheet of all, another is a folder with a file for each.
    #[arg(long, value_name = "PNG|DIR")]
    pub sheet: Option<PathBuf>,
    /// Of sequences, score what this holds instead of following the objects: a CSV of frame,id,x,y, or a folder as the
    /// Cell Tracking Challenge has results; of several sequences a folder that holds `NAME.csv` or `NAME_RES` for each.
    #[arg(long, value_name = "CSV|DIR")]
    pub found: Option<PathBuf>,
    /// Of sequences, take the starts exactly as they are.
    #[arg(long)]
    pub exact_start: bool,
    /// Of sequences, score the fit on their first frames alone.
    #[arg(long)]
    pub first_frames: bool,
    /// Work on so many pictures, or sequences, at a time.
    #[arg(long, short, value_name = "N", default_value = "1")]
    pub jobs: NonZero<usize>,
}

//! Flags of `snake track` as typed.

use std::path::PathBuf;

use clap::{Args as ClapArgs, ValueEnum};

use crate::fit::{Origin, Start, Where};

/// What the long help ends with.
pub(crate) const EXAMPLES: &str = "\
Examples:
  snake track frames/ --from circle:102,146,60 -o tracks.csv --overlay seen.gif
  snake track 'cell_*.tif' --from first.geojson -o tracks.geojson --measure table.csv --kymograph speed.png
  snake track stack.tif --from labels.tif --births -o 01_RES --as ctc --events events.csv
  snake track clip.mp4 --from box:40,60,220,180 -o boxes.txt --as mot --overlay seen.mp4
  snake track frames/ --from start.csv -o tracks.csv --resume
  snake track cells/ --seeds auto --at 40 --mend by_hand.csv -o tracks.csv

Exit code 0: all objects were followed to the end. 1: one was lost, is not seen at the end or was unsure from the \
start, a frame could not be read, or it was stopped. 2: refused, and why.";

#[derive(Debug, Clone, ClapArgs)]
pub(crate) struct Flags {
    /// The frames: picture files, a folder of them, a name with `*` and `?`, a TIFF of several pages, a video (by the
    /// program ffmpeg, where it is installed); `-` is standard input, of PGM or PPM pictures one behind the other.
    #[arg(required = true, value_name = "FRAME")]
    pub frames: Vec<PathBuf>,
    /// Where the objects are in the first frame, or in that of --at; may be given several times:
    /// `circle:X,Y,RADIUS`, `box:LEFT,TOP,WIDTH,HEIGHT`, `ellipse:X,Y,RX,RY[,DEGREES]`, `polygon:X,Y,X,Y,…` or
    /// `click:X,Y` in pixels, the first pixel's center at 0,0; or a file of one or several outlines or points: CSV,
    /// GeoJSON, COCO, `ImageJ`, SVG, labelme, CVAT, a mask or labels. `{stem}` in its name stands for the name of the
    /// file of that frame without its ending.
    #[arg(long, short, value_name = "START", required_unless_present = "seeds")]
    pub from: Vec<Start>,
    /// Look for many objects: `auto` finds them, a file has points or outlines of half their size.
    #[arg(long, value_name = "SEEDS", conflicts_with = "from")]
    pub seeds: Option<Where>,
    /// The frame that the start is in, by its number from 0 or the name of its file. Frames before it are followed
    /// back from it; those of a video or of standard input cannot be, and are left out, as with --births.
    #[arg(long, value_name = "FRAME")]
    pub at: Option<String>,
    /// How a start is taken: exactly as it is, roughly (the outline that is found about it), or whichever suits it.
    #[arg(long, value_enum, default_value_t = Taken::Auto)]
    pub start: Taken,
    /// Write the outlines of all frames, in the format that the name's ending says: csv, geojson, json (COCO for
    /// videos), zip (`ImageJ`), txt (MOT), a folder (Cell Tracking Challenge); standard output, as CSV, if not given
    /// or `-`.
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// The format to write: csv, geojson, coco, ctc, imagej or mot.
    #[arg(long = "as", value_name = "FORMAT")]
    pub format: Option<String>,
    /// Write the frames with the outlines over them, in a color for each object, dashed where it is not seen: gif, png
    /// (animated), or a video (mp4, mov, mkv, webm; by ffmpeg).
    #[arg(long, value_name = "FILE")]
    pub overlay: Option<PathBuf>,
    /// Frames a second of the overlay.
    #[arg(long, value_name = "N", default_value_t = 12.5)]
    pub rate: f64,
    /// Write a table with a row for each object in each frame: state, confidence, area, perimeter, place, velocity.
    #[arg(long, value_name = "CSV")]
    pub measure: Option<PathBuf>,
    /// Write a table of what happened: begun, hidden, found, left, lost, divided, born, merged, uncertain, mended.
    #[arg(long, value_name = "CSV")]
    pub events: Option<PathBuf>,
    /// Write what goes on along the outline of an object over the frames: a picture (png) or a table (csv).
    #[arg(long, value_name = "FILE")]
    pub kymograph: Option<PathBuf>,
    /// What the kymograph shows.
    #[arg(long, value_enum, default_value_t = Shown::Speed)]
    pub of: Shown,
    /// The number of the object that the kymograph is of; the first if not given.
    #[arg(long, value_name = "N")]
    pub object: Option<u32>,
    /// Write where the middles of the objects went: a picture (png), over the last frame, or a table (csv).
    #[arg(long, value_name = "FILE")]
    pub trajectories: Option<PathBuf>,
    /// Outlines mended by hand, a table frame,id,x,y: objects go on from there, and between two outlines that are given
    /// (the start is one) they are followed both ways and blended. Frames are read several times then; those of a video
    /// or of standard input cannot be, and objects only go on.
    #[arg(long, value_name = "CSV")]
    pub mend: Option<PathBuf>,
    /// Give up an object that was not seen for so many frames.
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub patience: u32,
    /// Objects may divide, and new ones be born, as cells do: onwards in time only, so that frames before --at are left
    /// out.
    #[arg(long)]
    pub births: bool,
    /// Say of each frame how each object was found, and what happened.
    #[arg(long)]
    pub explain: bool,
    /// Go on with --out (csv, geojson, txt or a folder of labels) as if the run had not been ended: frames are followed
    /// again from the first, which takes its time; what is there is compared, not written, and where it differs, the
    /// run is refused.
    #[arg(long, requires = "out")]
    pub resume: bool,
    /// Refuse to write over a file that is there.
    #[arg(long)]
    pub no_clobber: bool,
    /// Objects at a time; all cores if not given. Results do not depend on it.
    #[arg(long, short, value_name = "N")]
    pub jobs: Option<usize>,

    /// Columns of x and y in a table of the start, by name or number from 1, as `X,Y`.
    #[arg(
        long,
        value_name = "X,Y",
        value_delimiter = ',',
        num_args = 1,
        help_heading = "Input"
    )]
    pub columns: Vec<String>,
    /// Where 0,0 is in the file of the start, if not where its format has it: the first pixel's center, or its
    /// outer corner.
    #[arg(long, value_enum, help_heading = "Input")]
    pub origin: Option<Origin>,
    /// Channel of the frames, by name or number from 1.
    #[arg(long, value_name = "NAME", help_heading = "Input")]
    pub channel: Option<String>,
    /// Take the pixels as they are stored, whatever the tag of orientation says.
    #[arg(long, help_heading = "Input")]
    pub as_stored: bool,
}

/// How a start is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Taken {
    /// Whichever suits it.
    Auto,
    /// As it is.
    Exact,
    /// As drawn roughly.
    Rough,
}

/// What a kymograph shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Shown {
    /// Motion along the normal, outwards above 0. Pixels a frame.
    Speed,
    /// Curvature, above 0 where it bulges. Per pixel.
    Curvature,
    /// Grey level of the picture under the outline, 0 to 255.
    Grey,
    /// Distance from the middle, less that in the first frame. Pixels.
    Protrusion,
}

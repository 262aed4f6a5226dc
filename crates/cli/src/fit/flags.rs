//! Flags of `snake fit` as typed.

use std::path::{Path, PathBuf};

use clap::{Args as ClapArgs, ValueEnum};
use io::Picture;

use super::measures::called;
use super::results::ANIMATION;
use super::seeds::Where;
use super::start::Start;
use crate::args::{Change, Computed, Polarity};

/// What the long help ends with.
pub(crate) const EXAMPLES: &str = "\
Examples:
  snake fit photo.jpg --from box:40,60,220,180 --overlay seen.png -o outline.csv
  snake fit photo.jpg --from click:120,90 --explain -o outline.geojson
  snake fit photo.jpg --from mask.png -o refined.png --measure table.csv
  snake fit nuclei.png --seeds auto -o labels.tif --measure table.csv --overlay seen.png
  snake fit 'cells/*.tif' --from starts/{stem}.csv --out-dir found --sheet found.html
  snake fit frames/ --from starts/{stem}.csv --out-dir found --as geojson,mask
  snake fit plates/ --seeds auto --out-dir found --as parquet --resume

Exit code 0: found. 1: unsure, not at rest, stopped, or a picture of many failed. 2: refused, and why.";

#[derive(Debug, Clone, ClapArgs)]
pub(crate) struct Flags {
    /// The picture whose starts are read, once it is known; no flag.
    #[arg(skip)]
    pub about: Option<About>,
    /// The pictures: PNG, JPEG, TIFF, PGM, PPM, PFM or WebP files, folders of them, or names with `*` and `?`; `-` is
    /// standard input.
    #[arg(required = true, value_name = "IMAGE")]
    pub images: Vec<PathBuf>,
    /// Where to start: `circle:X,Y,RADIUS`, `box:LEFT,TOP,WIDTH,HEIGHT`, `ellipse:X,Y,RX,RY[,DEGREES]`,
    /// `polygon:X,Y,X,Y,…` or `click:X,Y` in pixels, the first pixel's center at 0,0; or a file of one or several
    /// outlines or points: CSV, GeoJSON, COCO, `ImageJ`, SVG, labelme, CVAT, a mask or labels. `{stem}` in its name
    /// stands for the name of the picture without its ending; `-` is standard input.
    #[arg(long, short, value_name = "START", required_unless_present = "seeds")]
    pub from: Option<Start>,
    /// Find many objects, as cells, each but once, with borders in common where they touch: `auto`, or a file of a
    /// point or an outline in each (in a table of x and y each row is a point); `{stem}` as above.
    #[arg(long, value_name = "auto|FILE", conflicts_with_all = ["from", "set", "nodes", "polarity"])]
    pub seeds: Option<Where>,
    /// Write the outlines, in the format that the name's ending says: csv, geojson, svg, roi, zip, png (a mask), tif
    /// (labels); standard output, as CSV, if not given or `-`.
    #[arg(long, short, value_name = "FILE", conflicts_with = "out_dir")]
    pub out: Option<PathBuf>,
    /// Write the outlines of each picture to this folder, as STEM.csv and so on.
    #[arg(long, value_name = "DIR")]
    pub out_dir: Option<PathBuf>,
    /// Formats to write: csv, geojson, coco, imagej, svg, labelme, mask, labels, deep-labels, and of --out-dir overlay,
    /// animation, and parquet (a file for each picture, together one table for pandas, `DuckDB`, QGIS and `pysnakes`);
    /// of --out one, of --out-dir several with commas between them.
    #[arg(long = "as", value_name = "FORMATS", value_delimiter = ',')]
    pub formats: Vec<String>,
    /// Write a table with a row for each outline: area, perimeter, axes, grey inside and outside, how sure it is.
    #[arg(long, value_name = "CSV")]
    pub measure: Option<PathBuf>,
    /// Write the picture with the starts (blue) and the outlines found (orange; purple where unsure) over it.
    #[arg(long, value_name = "PNG", conflicts_with = "out_dir")]
    pub overlay: Option<PathBuf>,
    /// Write a page with a small picture of every result, the least sure first, and what was refused: one HTML file.
    #[arg(long, value_name = "HTML")]
    pub sheet: Option<PathBuf>,
    /// Write how the outlines were found: each curve of the searches, or the curve as it moved.
    #[arg(long, value_name = "GIF", conflicts_with_all = ["out_dir", "seeds"])]
    pub animation: Option<PathBuf>,
    /// Write the moments of a motion, as `snake run` does (at most 1000): CSV if the name ends in .csv, else JSON
    /// Lines;
    /// `-` is standard output.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["out_dir", "seeds"])]
    pub record: Option<PathBuf>,
    /// Write what is known of each node too: its standard error in pixels and the strength of its edge from 0 to 1, as
    /// columns `error` and `edge` of a CSV, lists `node_error` and `node_edge` of GeoJSON, COCO and labelme, in --json.
    /// The overlay has the strength as color, from yellow (none) to blue, and in orange the sides of the band that
    /// holds the edge 95 times of 100.
    #[arg(long, conflicts_with = "seeds")]
    pub evidence: bool,
    /// Pluck each outline: move stretch by stretch so many pixels outwards and inwards, 2 if not given, let go, and say
    /// how much comes back: 1 where the picture holds it firmly, 0 where it stays where it was put. The overlay has
    /// that as color, from yellow (loose) to blue, red where it ran away.
    #[arg(
        long,
        value_name = "PX",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "2",
        allow_negative_numbers = true
    )]
    pub pluck: Option<f64>,
    /// Say what was measured, what was chosen and why, and how it ended.
    #[arg(long)]
    pub explain: bool,
    /// Leave out pictures whose results are in the folder of --out-dir already, and their rows in the table of
    /// --measure, which are kept.
    #[arg(long, requires = "out_dir")]
    pub resume: bool,
    /// Refuse to write over a file that is there.
    #[arg(long)]
    pub no_clobber: bool,
    /// Pictures at a time; all cores if not given.
    #[arg(long, short, value_name = "N")]
    pub jobs: Option<usize>,

    /// The outlines are open.
    #[arg(long, conflicts_with = "closed", help_heading = "Input")]
    pub open: bool,
    /// The outlines are closed, whatever their file says.
    #[arg(long, help_heading = "Input")]
    pub closed: bool,
    /// Columns of x and y in a table, by name or number from 1, as `X,Y`.
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
    /// Page of a TIFF, from 1; or `all`, each a picture of its own: those of stack.tif are called `stack_page1` and so
    /// on, by results and by `{stem}`.
    #[arg(long, value_name = "N|all", help_heading = "Input")]
    pub page: Option<Pages>,
    /// Channel of a picture, by name or number from 1.
    #[arg(long, value_name = "NAME", help_heading = "Input")]
    pub channel: Option<String>,
    /// Take the pixels as they are stored, whatever the tag of orientation says.
    #[arg(long, help_heading = "Input")]
    pub as_stored: bool,

    /// How the outline is found: by searches about the start, or by a curve that moves from it. Motion if a flag is
    /// given that only it has.
    #[arg(long, value_enum, help_heading = "Search")]
    pub method: Option<Method>,
    /// Give a rule of the search another value: tether, region, inward, outward, outer, sure, unsure, pure
    /// or around; may be
    /// given again.
    #[arg(long, value_name = "RULE=VALUE", help_heading = "Search")]
    pub set: Vec<Change>,
    /// Which edges attract, going outwards across the contour; if not given, a search learns it and a motion takes
    /// either.
    #[arg(long, value_enum, help_heading = "Search")]
    pub polarity: Option<Polarity>,
    /// Number of nodes; if not given, one a pixel of an outline found by a search, one every four pixels of a motion.
    #[arg(long, short, value_name = "N", help_heading = "Search")]
    pub nodes: Option<usize>,

    /// How hard each node is held to its place in the start's shape; 0 if not given.
    #[arg(
        long,
        value_name = "W0",
        allow_negative_numbers = true,
        help_heading = "Motion"
    )]
    pub tether: Option<f64>,
    /// How hard the curve resists stretching out of the start's shape; 20 if not given.
    #[arg(
        long,
        value_name = "W1",
        allow_negative_numbers = true,
        help_heading = "Motion"
    )]
    pub tension: Option<f64>,
    /// How hard the curve resists bending out of the start's shape; 100 if not given.
    #[arg(
        long,
        value_name = "W2",
        allow_negative_numbers = true,
        help_heading = "Motion"
    )]
    pub rigidity: Option<f64>,
    /// How strongly the motion is damped; 2 if not given.
    #[arg(
        long,
        value_name = "G",
        allow_negative_numbers = true,
        help_heading = "Motion"
    )]
    pub damping: Option<f64>,
    /// A force to pull with (see `list forces`) instead of the edge force; may be given again. With a
    /// weight as `gvf:0.5`, with keys of its own as `{ kind = "edge", sigma = 2.0 }`.
    #[arg(long, value_name = "KIND", help_heading = "Motion")]
    pub force: Vec<String>,
    /// Whether the edge force is computed only where the contour goes, or for the whole picture in double precision;
    /// `auto`, as if not given, is lazy wherever that is exact enough.
    #[arg(long, value_enum, help_heading = "Motion")]
    pub computed: Option<Computed>,
    /// Pressure inside the contour, in pulls of an edge: it grows, or shrinks below 0; 0.1 is much.
    #[arg(
        long,
        value_name = "S",
        allow_negative_numbers = true,
        help_heading = "Motion"
    )]
    pub balloon: Option<f64>,
    /// Width of the Gaussian that smooths the picture for the edge force, pixels; the reach is about three times that.
    /// If not given, the square root of 10, about 3.16.
    #[arg(
        long,
        value_name = "PX",
        allow_negative_numbers = true,
        help_heading = "Motion"
    )]
    pub sigma: Option<f64>,
    /// How hard the edge force pulls; 1, as if not given, suits most.
    #[arg(
        long,
        value_name = "S",
        allow_negative_numbers = true,
        help_heading = "Motion"
    )]
    pub strength: Option<f64>,
    /// Equal steps of this length; if not given, steps that grow on the way to rest (with --force: half of
    /// the largest that is stable anywhere in the picture, and at most 0.2).
    #[arg(
        long,
        value_name = "T",
        allow_negative_numbers = true,
        help_heading = "Motion"
    )]
    pub dt: Option<f64>,
    /// Steps at most; 40000 if not given.
    #[arg(long, value_name = "N", help_heading = "Motion")]
    pub steps: Option<u64>,
}

/// What a file of starts is to be for: a picture by its file name, and of its width and height.
#[derive(Debug, Clone)]
pub(crate) struct About {
    pub name: String,
    pub size: (usize, usize),
}

/// How an outline is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// By searches about the start.
    Search,
    /// By a curve that moves from it.
    Motion,
}

/// Which pages of a file are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pages {
    /// One, from 1.
    One(usize),
    /// Each, as a picture of its own.
    All,
}

impl std::str::FromStr for Pages {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if text == "all" {
            return Ok(Self::All);
        }
        let number = text.parse().map(Self::One);
        number.map_err(|_| format!("must be a number from 1, or all, got {text}"))
    }
}

/// Where 0,0 is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Origin {
    /// The center of the first pixel.
    Center,
    /// The outer corner of the first pixel.
    Corner,
}

impl Flags {
    /// The same for the starts of that picture.
    pub(super) fn about(&self, picture: &Picture, image: &Path) -> Self {
        let (name, size) = (called(image), picture.size());
        Self {
            about: Some(About { name, size }),
            ..self.clone()
        }
    }

    /// Whether the way of a curve is kept.
    pub(super) fn is_watched(&self) -> bool {
        let named = self.formats.iter().any(|name| name == ANIMATION);
        named || self.animation.is_some() || self.record.is_some()
    }

    /// The first flag that only a motion has.
    fn of_motion(&self) -> Option<&'static str> {
        let given = [
            ("--tether", self.tether.is_some()),
            ("--tension", self.tension.is_some()),
            ("--rigidity", self.rigidity.is_some()),
            ("--damping", self.damping.is_some()),
            ("--force", !self.force.is_empty()),
            ("--computed", self.computed.is_some()),
            ("--balloon", self.balloon.is_some()),
            ("--sigma", self.sigma.is_some()),
            ("--strength", self.strength.is_some()),
            ("--dt", self.dt.is_some()),
            ("--steps", self.steps.is_some()),
        ];
        given
            .into_iter()
            .find(|(_, given)| *given)
            .map(|(flag, _)| flag)
    }

    /// How the outline is found.
    ///
    /// # Errors
    ///
    /// A flag of the other method than the one asked for, by its name.
    pub(super) fn method(&self) -> Result<Method, (&'static str, String)> {
        let (motion, search) = (self.of_motion(), !self.set.is_empty());
        match (self.method, motion) {
            (Some(Method::Search), Some(flag)) => Err((
                flag,
                "is for --method motion, got --method search".to_owned(),
            )),
            (Some(Method::Motion), _) if search => Err((
                "--set",
                "is for --method search, got --method motion".to_owned(),
            )),
            (None, Some(flag)) if search => Err((
                flag,
                "is of a motion and --set of a search; needed: one of them".to_owned(),
            )),
            (Some(method), _) => Ok(method),
            (None, Some(_)) => Ok(Method::Motion),
            (None, None) => Ok(Method::Search),
        }
    }
}

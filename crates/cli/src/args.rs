//! Flags as typed.

use std::path::PathBuf;

use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};

use crate::eval::flags as eval;

/// What the codes mean, in every help.
const CODES: &str = "Exit code 0: at rest, or ran as asked. 1: ran, but blew up, left the picture, found no outline, \
                     was stopped, or ran out of steps before rest. 2: refused, and why.";

/// Elastic curves with mass that find, measure and follow outlines in pictures.
#[derive(Debug, Parser)]
#[command(name = "snake", version, max_term_width = 100, after_help = CODES)]
pub(crate) struct Args {
    #[command(flatten)]
    pub words: Words,
    #[command(subcommand)]
    pub command: Command,
}

/// How much is said.
#[derive(Debug, Clone, Copy, ClapArgs)]
pub(crate) struct Words {
    /// Say nothing but errors.
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say what was chosen, and why.
    #[arg(long, short, global = true)]
    pub verbose: bool,
    /// Say how it ended as one line of JSON on standard output.
    #[arg(long, global = true)]
    pub json: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a scene: a shipped one by name (see `list`), a TOML file, or a session of `live`.
    #[command(after_help = CODES)]
    Run(Run),
    /// Write every stage from a picture to its force field, or every kind of field, as pictures and numbers.
    #[command(after_help = CODES)]
    Field(Field),
    /// Find outlines in pictures: of what is drawn roughly around, clicked on, or masked.
    #[command(after_help = CODES, after_long_help = crate::fit::EXAMPLES)]
    Fit(Box<crate::fit::Flags>),
    /// Follow outlines through the frames of a sequence: files, a folder, the pages of a TIFF, a video.
    #[command(after_help = CODES, after_long_help = crate::track::EXAMPLES)]
    Track(Box<crate::track::Flags>),
    /// A window in the browser: throw balls, find outlines, mend them, follow them.
    #[command(after_help = CODES, after_long_help = crate::live::EXAMPLES)]
    Live(crate::live::Flags),
    /// Score the fit of `fit` on a data set whose truth is known.
    #[command(after_help = eval::CODES)]
    Eval(eval::Eval),
    /// Print the text of a scene: a shipped one by name, or a TOML file.
    #[command(after_help = CODES)]
    Show(Show),
    /// List the shipped scenes, the schemes, or the kinds of force.
    #[command(after_help = CODES)]
    List(List),
    /// Print completions for a shell, to be put where it looks for them.
    #[command(after_help = CODES)]
    Completions(Completions),
    /// Print the manual page, of this command or of one of its subcommands.
    #[command(after_help = CODES)]
    Man(Man),
}

#[derive(Debug, ClapArgs)]
pub(crate) struct Completions {
    /// Which shell.
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

#[derive(Debug, ClapArgs)]
pub(crate) struct Man {
    /// The subcommand; the whole command if not given.
    pub command: Option<String>,
}

#[derive(Debug, ClapArgs)]
pub(crate) struct Run {
    /// A shipped scene's name, a scene file, or a session of `live`; `-` is standard input.
    pub scene: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    /// Another scheme than the scene's.
    #[arg(long, value_name = "NAME")]
    pub scheme: Option<String>,
    /// Another step than the scene's; `auto`: the program chooses each step, and a moment may be kept after any.
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub dt: Option<Step>,
    /// Make every step in as many sub-steps as it takes for each to err by at most so many pixels; of `auto`, what
    /// each may err.
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub tolerance: Option<f64>,
    /// Another number of steps than the scene's (or, with a rule for rest, at most so many).
    #[arg(long, value_name = "N")]
    pub steps: Option<u64>,
    /// Run although the step is beyond the limit of stability.
    #[arg(long)]
    pub force: bool,
    /// Say first what is known of the motion: frequencies, largest steps, time to rest.
    #[arg(long)]
    pub certificate: bool,
    /// Write the moments kept: CSV if the name ends in .csv, else JSON Lines; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// Keep a moment every N steps (and the first and the last).
    #[arg(long, value_name = "N")]
    pub every: Option<u64>,
    /// Keep velocities too.
    #[arg(long)]
    pub velocities: bool,
    /// Keep energies too.
    #[arg(long)]
    pub energies: bool,
    /// Write the final contour, of several snakes all of them; `-` is standard output.
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write the picture with every start (blue) and every final contour (orange) over it.
    #[arg(long, value_name = "PNG")]
    pub overlay: Option<PathBuf>,
}

#[derive(Debug, ClapArgs)]
pub(crate) struct Show {
    /// A shipped scene's name, or a scene file; `-` is standard input.
    pub scene: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
}

/// Changes of a scene's text.
#[derive(Debug, ClapArgs)]
pub(crate) struct Changes {
    /// Give a key of the scene another value, as `material.tension=30` or `force.edge.strength=2`;
    /// may be given again.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<Change>,
}

/// A change as typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Change {
    pub key: String,
    pub value: String,
}

impl std::str::FromStr for Change {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (key, value) = text
            .split_once('=')
            .ok_or_else(|| "a key and a value are needed, as run.dt=0.1".to_owned())?;
        Ok(Self {
            key: key.trim().to_owned(),
            value: value.trim().to_owned(),
        })
    }
}

/// A step as typed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Step {
    Fixed(f64),
    Auto,
}

impl std::str::FromStr for Step {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            number => number
                .parse()
                .map(Self::Fixed)
                .map_err(|_| "a number above 0, or auto, is needed".to_owned()),
        }
    }
}

#[derive(Debug, ClapArgs)]
pub(crate) struct Field {
    /// The picture: PNG, JPEG, TIFF, PGM or PPM; `-` is standard input.
    pub image: PathBuf,
    /// Folder to write to; made if it is not there.
    #[arg(long, short, value_name = "DIR")]
    pub out: PathBuf,
    /// Smooth by a Gaussian of this width, pixels.
    #[arg(
        long,
        value_name = "PX",
        conflicts_with = "passes",
        allow_negative_numbers = true
    )]
    pub sigma: Option<f64>,
    /// Smooth by so many passes of [1/4 1/2 1/4]; the report takes 20, a width of 3.16 pixels.
    #[arg(long, value_name = "N")]
    pub passes: Option<u32>,
    /// Only the field of this kind (see `list forces`); may be given again. With keys of its own as
    /// `{ kind = "edge", sigma = 2.0 }`.
    #[arg(long, value_name = "KIND")]
    pub kind: Vec<String>,
    /// The stages, and the field of every kind.
    #[arg(long, conflicts_with = "kind")]
    pub all: bool,
    /// The closed contour that regions compare the inside and the outside of; a circle in the middle if not given.
    #[arg(long, value_name = "CONTOUR")]
    pub from: Option<PathBuf>,
}

#[derive(Debug, ClapArgs)]
pub(crate) struct List {
    /// What to list.
    #[arg(value_enum, default_value_t = What::Scenes)]
    pub what: What,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum What {
    /// Shipped scenes.
    Scenes,
    /// Schemes that move a snake.
    Schemes,
    /// Kinds of force that act on it.
    Forces,
}

/// Which edges attract, going outwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Polarity {
    /// Both kinds.
    Either,
    /// Dark inside, bright outside.
    DarkToBright,
    /// Bright inside, dark outside.
    BrightToDark,
}

/// How the edge force is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Computed {
    /// Lazy wherever that will do.
    Auto,
    /// Where the contour goes.
    Lazy,
    /// For the whole picture.
    Whole,
}

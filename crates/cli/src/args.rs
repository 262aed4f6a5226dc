//! Flags as typed.

use std::path::PathBuf;

use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};

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
    /// Run a scene: a shipped one by name (see `list`), or a TOML file.
    #[command(after_help = CODES)]
    Run(Run),
    /// Write every stage from a picture to its force field, or every kind of field, as pictures and numbers.
    #[command(after_help = CODES)]
    Field(Field),
    /// Pull a drawn contour onto the edges of a picture.
    #[command(after_help = CODES)]
    Fit(Fit),
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
    /// A shipped scene's name, or a scene file; `-` is standard input.
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

/// Where a fit starts, as typed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Start {
    /// x and y of the center, and the radius.
    Circle([f64; 3]),
    /// Left, top, width and height.
    Box([f64; 4]),
    /// A file of points.
    File(PathBuf),
}

impl std::str::FromStr for Start {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(numbers) = text.strip_prefix("circle:") {
            let numbers: [f64; 3] = finite(numbers, "circle:X,Y,RADIUS")?;
            let [_, _, radius] = numbers;
            if radius <= 0.0 {
                return Err(format!("the radius must be above 0, got {radius}"));
            }
            return Ok(Self::Circle(numbers));
        }
        if let Some(numbers) = text.strip_prefix("box:") {
            let numbers: [f64; 4] = finite(numbers, "box:LEFT,TOP,WIDTH,HEIGHT")?;
            let [_, _, width, height] = numbers;
            if width <= 0.0 || height <= 0.0 {
                let message = format!("width and height must be above 0, got {width} and {height}");
                return Err(message);
            }
            return Ok(Self::Box(numbers));
        }
        Ok(Self::File(PathBuf::from(text)))
    }
}

/// So many finite numbers with commas between them.
fn finite<const N: usize>(text: &str, form: &str) -> Result<[f64; N], String> {
    let wrong = || format!("must be {form} with numbers, got {text}");
    let numbers = text.split(',').map(|number| number.trim().parse::<f64>());
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>().map_err(|_| wrong())?;
    if numbers.iter().any(|number| !number.is_finite()) {
        return Err(wrong());
    }
    numbers.try_into().map_err(|_| wrong())
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
pub(crate) struct Fit {
    /// The picture: PNG, JPEG, TIFF, PGM or PPM; `-` is standard input.
    pub image: PathBuf,
    /// The contour to start from: `circle:X,Y,RADIUS` or `box:LEFT,TOP,WIDTH,HEIGHT` in pixels, the first
    /// pixel's center at 0,0; or a file of x,y in pixels; `-` is standard input.
    #[arg(long, short, value_name = "START")]
    pub from: Start,
    /// Write the contour found; standard output if not given or `-`.
    #[arg(long, short, value_name = "CONTOUR")]
    pub out: Option<PathBuf>,
    /// Write the picture with the start (blue) and the contour found (orange) over it.
    #[arg(long, value_name = "PNG")]
    pub overlay: Option<PathBuf>,
    /// The contour is open.
    #[arg(long, conflicts_with = "closed")]
    pub open: bool,
    /// The contour is closed, whatever its file says.
    #[arg(long)]
    pub closed: bool,
    /// Number of nodes; one every four pixels if not given.
    #[arg(long, short, value_name = "N")]
    pub nodes: Option<usize>,
    /// How hard each node is held to its place in the start's shape.
    #[arg(long, value_name = "W0", allow_negative_numbers = true, default_value_t = scene::fit::Options::default().tether)]
    pub tether: f64,
    /// How hard the curve resists stretching out of the start's shape.
    #[arg(long, value_name = "W1", allow_negative_numbers = true, default_value_t = scene::fit::Options::default().tension)]
    pub tension: f64,
    /// How hard the curve resists bending out of the start's shape.
    #[arg(long, value_name = "W2", allow_negative_numbers = true, default_value_t = scene::fit::Options::default().rigidity)]
    pub rigidity: f64,
    /// How strongly the motion is damped.
    #[arg(long, value_name = "G", allow_negative_numbers = true, default_value_t = scene::fit::Options::default().damping)]
    pub damping: f64,
    /// A force to pull with (see `list forces`) instead of the edge force; may be given again. With a
    /// weight as `gvf:0.5`, with keys of its own as `{ kind = "edge", sigma = 2.0 }`.
    #[arg(long, value_name = "KIND")]
    pub force: Vec<String>,
    /// Which edges attract, going outwards across the contour.
    #[arg(long, value_enum, default_value_t = Polarity::Either)]
    pub polarity: Polarity,
    /// Whether the edge force is computed only where the contour goes, or for the whole picture in double precision;
    /// `auto` is lazy wherever that is exact enough.
    #[arg(long, value_enum, default_value_t = Computed::Auto)]
    pub computed: Computed,
    /// Pressure inside the contour, in pulls of an edge: it grows, or shrinks below 0; 0.1 is much.
    #[arg(
        long,
        value_name = "S",
        allow_negative_numbers = true,
        default_value_t = 0.0
    )]
    pub balloon: f64,
    /// Width of the Gaussian that smooths the picture for the edge force, pixels; the reach is about three times that.
    /// If not given, the square root of 10, about 3.16.
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub sigma: Option<f64>,
    /// How hard the edge force pulls; 1 suits most.
    #[arg(long, value_name = "S", allow_negative_numbers = true, default_value_t = scene::fit::Options::default().strength)]
    pub strength: f64,
    /// Equal steps of this length; if not given, steps that grow on the way to rest (with --force: half of
    /// the largest that is stable anywhere in the picture, and at most 0.2).
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub dt: Option<f64>,
    /// Steps at most.
    #[arg(long, value_name = "N", default_value_t = scene::fit::Options::default().steps)]
    pub steps: u64,
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

//! The text of a scene, exactly as written: the types that serde fills and writes. What is not
//! given, or given as what stands for it anyway, is not written.
//!
//! Every key that may be left out is an `Option` or has its default here; what the values mean is
//! decided in `meaning`. `docs/formats.md` explains the format by example.

mod company;
mod force;
mod forms;
mod hand;
mod map;

use serde::{Deserialize, Serialize};

pub(crate) use company::{AlsoText, ContactText, UpkeepText};
pub(crate) use force::*;
pub(crate) use forms::{
    DampingText, EndText, FrameText, FrameWord, InternalText, NodesText, OutputText, ProfileText,
    RulesText, StepText, TermText, TopologyText,
};
pub(crate) use hand::HandText;
pub(crate) use map::{AwayText, MapText, ParameterText, SourceText};

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct SceneText {
    /// Version of the format; 1 when not given.
    #[serde(default)]
    pub version: Option<u64>,
    pub title: String,
    #[serde(default)]
    pub report: Option<String>,
    #[serde(default)]
    pub note: Option<String>,
    #[serde(default, skip_serializing_if = "usual")]
    pub rules: RulesText,
    #[serde(default, skip_serializing_if = "usual")]
    pub view: ViewText,
    #[serde(default)]
    pub picture: Option<PictureText>,
    #[serde(default)]
    pub field: Option<FieldText>,
    #[serde(
        default,
        deserialize_with = "force::forces",
        skip_serializing_if = "Vec::is_empty"
    )]
    pub force: Vec<ForceText>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hand: Vec<HandText>,
    pub snake: SnakeText,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<AlsoText>,
    #[serde(default)]
    pub contact: Option<ContactText>,
    #[serde(default)]
    pub upkeep: Option<UpkeepText>,
    pub tips: Option<TipsText>,
    pub material: MaterialText,
    pub densities: DensitiesText,
    #[serde(default, skip_serializing_if = "usual")]
    pub schedule: ScheduleText,
    #[serde(default, skip_serializing_if = "usual")]
    pub maps: MapsText,
    #[serde(default, skip_serializing_if = "usual")]
    pub world: WorldText,
    pub run: RunText,
    #[serde(default, skip_serializing_if = "usual")]
    pub record: RecordText,
}

/// Whose rules: the report's program, or ours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Rule {
    Report,
    Corrected,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct EachRule {
    pub all: Option<Rule>,
    pub frame: Option<Rule>,
    pub ends: Option<Rule>,
    pub field: Option<Rule>,
    pub sampling: Option<Rule>,
    pub spline: Option<Rule>,
    pub spacing: Option<Rule>,
    pub start: Option<Rule>,
    pub border: Option<Rule>,
    pub clock: Option<Rule>,
}

/// How a drawing should look at the scene.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ViewText {
    /// "down" (pictures) or "up" (chapter 2).
    pub y: Option<UpDown>,
    /// `[x0, y0, x1, y1]`.
    pub window: Option<[f64; 4]>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum UpDown {
    Up,
    Down,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PictureText {
    /// A file beside the scene.
    pub file: Option<String>,
    /// A picture that comes with the program.
    pub shipped: Option<String>,
    /// Drawn from numbers.
    pub drawn: Option<DrawnText>,
    /// A picture file of the pixels that count.
    pub mask: Option<String>,
    /// What becomes of pixels that are no finite numbers.
    pub invalid: Option<InvalidText>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum InvalidText {
    /// The picture is refused.
    Refuse,
    /// They do not count.
    Mask,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct DrawnText {
    pub size: [usize; 2],
    #[serde(default = "sixty", skip_serializing_if = "is_sixty")]
    pub background: f64,
    #[serde(default = "two_hundred", skip_serializing_if = "is_two_hundred")]
    pub foreground: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub blur: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub noise: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub seed: u64,
    pub region: RegionText,
}

fn sixty() -> f64 {
    60.0
}

fn is_sixty(value: &f64) -> bool {
    is(*value, sixty())
}

fn two_hundred() -> f64 {
    200.0
}

fn is_two_hundred(value: &f64) -> bool {
    is(*value, two_hundred())
}

/// Whether a value is what stands for it when it is not given, and so need not be written.
fn usual<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// The same number, to the bit.
const fn is(value: f64, other: f64) -> bool {
    value.to_bits() == other.to_bits()
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) enum RegionText {
    /// Everything right of x.
    RightOf(f64),
    /// `[x0, y0, x1, y1]`.
    Box([f64; 4]),
    Ellipse(EllipseText),
    Circle(CircleText),
    Road(RoadText),
    /// What is in any of these.
    Any(Vec<Self>),
}

/// What is no farther than half a width from a polyline.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RoadText {
    pub points: Vec<[f64; 2]>,
    pub width: f64,
}

/// Whether a field is made where a curve goes, or as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ComputedText {
    Lazy,
    Whole,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct FieldText {
    pub computed: Option<ComputedText>,
    pub passes: Option<u32>,
    pub sigma: Option<f64>,
    pub scale: Option<f64>,
    pub gain: Option<f64>,
    #[serde(default)]
    pub weight: Option<ProfileText>,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct CircleText {
    pub center: [f64; 2],
    pub radius: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct EllipseText {
    pub center: [f64; 2],
    pub axes: [f64; 2],
    #[serde(default, skip_serializing_if = "usual")]
    pub angle: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct SegmentText {
    pub from: [f64; 2],
    pub to: [f64; 2],
}

/// A curve, before it has nodes.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) enum ShapeText {
    Circle(CircleText),
    Ellipse(EllipseText),
    Segment(SegmentText),
    /// Clicked points, joined by a spline.
    Points(Vec<[f64; 2]>),
    /// The nodes themselves.
    Nodes(Vec<[f64; 2]>),
    /// A contour file beside the scene, joined by a spline.
    File(String),
    /// A contour that comes with the program.
    Shipped(String),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum EndWord {
    Free,
    Anchored,
    Pinned,
    Clamped,
    /// Free along the border of the picture.
    Border,
}

/// A free end that slides along a line.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RailText {
    pub rail: Vec<[f64; 2]>,
}

/// Ends that grow.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct TipsText {
    pub ends: Option<TipsWord>,
    pub shade: Option<ShadeText>,
    pub sigma: Option<f64>,
    pub least: Option<f64>,
    pub every: Option<u64>,
    pub most: Option<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TipsWord {
    Both,
    Head,
    Tail,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum OpenClosed {
    Open,
    Closed,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct EndsText {
    pub head: EndText,
    pub tail: EndText,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct SnakeText {
    pub nodes: Option<NodesText>,
    pub topology: TopologyText,
    pub start: ShapeText,
    #[serde(default)]
    pub rest: Option<ShapeText>,
    #[serde(default, skip_serializing_if = "usual")]
    pub velocity: [f64; 2],
    /// Angular velocity about the center, radians per unit of time, from +x towards +y.
    #[serde(default, skip_serializing_if = "usual")]
    pub spin: f64,
    /// What the deformation is measured in.
    pub frame: Option<FrameText>,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct MaterialText {
    pub tether: ParameterText,
    pub tension: ParameterText,
    pub rigidity: ParameterText,
    /// Nodes at which the rigidity is 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners: Vec<usize>,
    /// Nodes after which the curve may part.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub breaks: Vec<usize>,
    /// Weights of the orders 3, 4 and on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub higher: Vec<ProfileText>,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct DensitiesText {
    pub mass: ParameterText,
    pub damping: DampingText,
    /// Damping inside the body.
    pub internal: Option<InternalText>,
}

/// `[[time, factor], …]` for each parameter.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ScheduleText {
    pub tether: Option<Vec<[f64; 2]>>,
    pub tension: Option<Vec<[f64; 2]>>,
    pub rigidity: Option<Vec<[f64; 2]>>,
    pub mass: Option<Vec<[f64; 2]>>,
    pub damping: Option<Vec<[f64; 2]>>,
    pub higher: Option<Vec<[f64; 2]>>,
}

/// How often maps are looked at.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct MapsText {
    /// Time between two looks; 0: at every step.
    #[serde(default, skip_serializing_if = "usual")]
    pub every: f64,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct WorldText {
    #[serde(default)]
    pub gravity: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wall: Vec<WallText>,
    /// What happens at the borders of the picture.
    #[serde(default)]
    pub border: Option<BorderText>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum BorderText {
    /// Nothing: nodes may leave.
    None,
    /// The report's: clamped at the top and the bottom only.
    Clamp,
    /// All four sides stop a node.
    Stop,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct WallText {
    pub point: [f64; 2],
    pub normal: [f64; 2],
    pub law: LawText,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) enum LawText {
    Clamp,
    Penalty(PenaltyText),
    Impact(ImpactText),
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PenaltyText {
    pub stiffness: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub damping: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ImpactText {
    #[serde(default, skip_serializing_if = "usual")]
    pub restitution: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub friction: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RestText {
    pub balance: Option<f64>,
    pub travel: Option<f64>,
    #[serde(default, skip_serializing_if = "usual")]
    pub shape: bool,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RunText {
    #[serde(default)]
    pub scheme: Option<String>,
    pub dt: StepText,
    /// Largest error of a sub-step, where they are chosen.
    #[serde(default)]
    pub tolerance: Option<f64>,
    /// Time between steps, where sub-steps are chosen.
    #[serde(default)]
    pub output: Option<OutputText>,
    #[serde(default)]
    pub steps: Option<u64>,
    #[serde(default)]
    pub time: Option<f64>,
    #[serde(default)]
    pub rest: Option<RestText>,
    /// Run although the step is beyond the limit.
    #[serde(default, skip_serializing_if = "usual")]
    pub force: bool,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RecordText {
    pub every: Option<u64>,
    pub steps: Option<Vec<u64>>,
    #[serde(default, skip_serializing_if = "usual")]
    pub velocities: bool,
    #[serde(default, skip_serializing_if = "usual")]
    pub energies: bool,
}

//! `[[force]]`: one force of the world, by its kind.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::ProfileText;

/// One `[[force]]`: its kind with the keys of that kind, and what every kind has.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ForceText {
    pub kind: KindText,
    pub common: CommonText,
}

/// The keys that every kind has.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct CommonText {
    pub name: Option<String>,
    pub weight: Option<ProfileText>,
    pub schedule: Option<Vec<[f64; 2]>>,
    /// Radians per unit of time.
    pub spin: Option<f64>,
    /// About what it spins.
    pub about: Option<[f64; 2]>,
}

/// The names of those keys, and the one that says which kind.
const COMMON: [&str; 6] = ["kind", "name", "weight", "schedule", "spin", "about"];

macro_rules! kinds {
    ($($word:literal $variant:ident($text:ty)),* $(,)?) => {
        /// Which force, with its own keys.
        #[derive(Debug, Clone, PartialEq, Serialize)]
        #[serde(untagged)]
        pub(crate) enum KindText {
            $($variant($text)),*
        }

        /// The word of every kind.
        pub(crate) const WORDS: &[&str] = &[$($word),*];

        impl KindText {
            /// The word for it.
            pub(crate) const fn word(&self) -> &'static str {
                match self {
                    $(Self::$variant(_) => $word),*
                }
            }

            fn read(word: &str, keys: toml::Table) -> Result<Self, toml::de::Error> {
                match word {
                    $($word => <$text>::deserialize(keys).map(Self::$variant),)*
                    _ => Err(unknown("variant", word, WORDS)),
                }
            }
        }
    };
}

kinds![
    "edge" Edge(EdgeText),
    "color-edge" ColorEdge(StrengthText),
    "scales" Scales(ScalesText),
    "coarse-to-fine" CoarseToFine(CoarseToFineText),
    "line" Line(LineText),
    "termination" Termination(TerminationText),
    "distance" Distance(DistanceText),
    "gvf" Gvf(GvfText),
    "vfc" Vfc(VfcText),
    "regions" Regions(RegionsText),
    "local-regions" LocalRegions(LocalRegionsText),
    "likelihood" Likelihood(LikelihoodText),
    "texture" Texture(TextureText),
    "pressure" Pressure(PressureText),
    "gas" Gas(AreaText),
    "area" Area(AreaText),
    "spring" Spring(SpringText),
    "repulsor" Repulsor(RepulsorText),
    "freeze" Freeze(FreezeText),
    "gravity" Gravity(GravityText),
];

/// As serde says it, so that all such messages are one.
fn unknown<E: Error>(what: &str, word: &str, known: &[&str]) -> E {
    E::custom(format!(
        "unknown {what} `{word}`, expected one of `{}`",
        known.join("`, `")
    ))
}

impl ForceText {
    /// Read one table.
    fn read(mut keys: toml::Table) -> Result<Self, toml::de::Error> {
        let mut common = toml::Table::new();
        let word = keys.remove(COMMON[0]);
        for key in &COMMON[1..] {
            if let Some(value) = keys.remove(*key) {
                common.insert((*key).to_owned(), value);
            }
        }
        let word = match word {
            Some(toml::Value::String(word)) => word,
            Some(other) => {
                let message = format!("kind: expected a word, got {}", super::forms::shown(&other));
                return Err(Error::custom(message));
            }
            None => return Err(Error::missing_field(COMMON[0])),
        };
        let kind = KindText::read(&word, keys).map_err(|error| {
            let message = error.message();
            // the keys of every kind are known too
            if message.starts_with("unknown field") {
                let given = message.split('`').nth(1).unwrap_or("");
                let own = message.split('`').skip(3).step_by(2);
                let known: Vec<&str> = COMMON.into_iter().chain(own).collect();
                unknown("field", given, &known)
            } else {
                error
            }
        })?;
        let common = CommonText::deserialize(common)?;
        Ok(Self { kind, common })
    }
}

impl<'de> Deserialize<'de> for ForceText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let keys = toml::Table::deserialize(deserializer)?;
        Self::read(keys).map_err(|error| D::Error::custom(error.message()))
    }
}

/// The keys of a force as they are written: all in one table.
#[derive(Serialize)]
struct ForceLines<'a> {
    kind: &'static str,
    #[serde(flatten)]
    own: &'a KindText,
    #[serde(flatten)]
    common: &'a CommonText,
}

impl Serialize for ForceText {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        ForceLines {
            kind: self.kind.word(),
            own: &self.kind,
            common: &self.common,
        }
        .serialize(serializer)
    }
}

/// All of a scene's forces; a message says which one it is about.
pub(super) fn forces<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<ForceText>, D::Error> {
    let tables = Vec::<toml::Table>::deserialize(deserializer)?;
    let read = |(i, keys)| {
        ForceText::read(keys)
            .map_err(|error| D::Error::custom(format!("force {i}: {}", error.message())))
    };
    tables.into_iter().enumerate().map(read).collect()
}

/// The forces of a further snake, where it has its own.
pub(super) fn own_forces<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Vec<ForceText>>, D::Error> {
    forces(deserializer).map(Some)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum PolarityText {
    Either,
    DarkToBright,
    BrightToDark,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct EdgeText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
    pub polarity: Option<PolarityText>,
}

/// A kind that needs no more than a smoothing and a strength.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct StrengthText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ScalesText {
    pub sigmas: Option<Vec<f64>>,
    pub strength: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct CoarseToFineText {
    pub sigmas: Option<Vec<f64>>,
    pub strength: Option<f64>,
    pub blur: Option<f64>,
    pub hold: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ShadeText {
    Bright,
    Dark,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct LineText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
    pub shade: Option<ShadeText>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct TerminationText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
    pub floor: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct DistanceText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
    pub threshold: Option<f64>,
    pub reach: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct GvfText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
    pub threshold: Option<f64>,
    pub smoothness: Option<f64>,
    pub spread: Option<f64>,
    pub knee: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct VfcText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
    pub threshold: Option<f64>,
    pub exponent: Option<f64>,
    pub width: Option<f64>,
    pub reach: Option<f64>,
    pub knee: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RegionsText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
    pub grey: Option<bool>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct LocalRegionsText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
    pub grey: Option<bool>,
    pub radius: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum DensityText {
    Histogram,
    Gaussian,
    Mixture,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct LikelihoodText {
    pub sigma: Option<f64>,
    pub strength: Option<f64>,
    pub grey: Option<bool>,
    pub classes: Option<usize>,
    pub density: Option<DensityText>,
    pub bandwidth: Option<f64>,
    pub components: Option<usize>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct TextureText {
    pub sigmas: Option<Vec<f64>>,
    pub strength: Option<f64>,
    pub classes: Option<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum DirectionText {
    Given,
    Picture,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PressureText {
    pub pressure: f64,
    pub direction: Option<DirectionText>,
}

/// Of a gas, and of a spring towards an area.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct AreaText {
    pub pressure: f64,
    pub area: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct SpringText {
    pub node: Option<usize>,
    pub from: Option<[f64; 2]>,
    pub to: Option<[f64; 2]>,
    pub path: Option<Vec<[f64; 3]>>,
    pub stiffness: f64,
    pub damping: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RepulsorText {
    pub at: Option<[f64; 2]>,
    pub path: Option<Vec<[f64; 3]>>,
    pub reach: f64,
    pub push: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct FreezeText {
    pub stretch: [usize; 2],
    pub stiffness: f64,
    pub damping: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct GravityText {
    pub acceleration: [f64; 2],
}

//! Values that may be written in more than one form.
//!
//! Each looks at what is there before it decides, so that a message is about the form that was meant.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{EachRule, EndWord, EndsText, OpenClosed, ParameterText, RailText, Rule};

/// A number, one number a node, or points along the curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum ProfileText {
    Uniform(f64),
    PerNode(Vec<f64>),
    Along(Along),
}

impl<'de> Deserialize<'de> for ProfileText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match toml::Value::deserialize(deserializer)? {
            toml::Value::Float(value) => Ok(Self::Uniform(value)),
            toml::Value::Array(values) => inner(toml::Value::Array(values)).map(Self::PerNode),
            toml::Value::Table(table) => inner(toml::Value::Table(table)).map(Self::Along),
            // as serde reads any other number
            toml::Value::Integer(value) => inner(toml::Value::Integer(value)).map(Self::Uniform),
            other => Err(wrong(
                "a number, one number a node, or { along = [[s, value], …] }",
                &other,
            )),
        }
    }
}

/// What is inside a value that may have several forms.
pub(super) fn inner<T: for<'a> Deserialize<'a>, E: serde::de::Error>(
    value: toml::Value,
) -> Result<T, E> {
    T::deserialize(value).map_err(|error| E::custom(error.message()))
}

fn wrong<E: serde::de::Error>(wanted: &str, given: &toml::Value) -> E {
    E::custom(format!("expected {wanted}, got {}", shown(given)))
}

/// A value for a message: what it is where it has parts, which may be many.
pub(super) fn shown(given: &toml::Value) -> String {
    match given {
        toml::Value::Array(_) => "a list".to_owned(),
        toml::Value::Table(_) => "a table".to_owned(),
        other => crate::error::clip(&other.to_string()),
    }
}

/// `{ along = [[s, value], …] }`: straight between points, `s` from 0 (first node) to 1 (last).
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Along {
    pub along: Vec<[f64; 2]>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum RulesText {
    All(Rule),
    Each(Box<EachRule>),
}

impl<'de> Deserialize<'de> for RulesText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(deserializer)?;
        match value {
            toml::Value::String(_) => inner(value).map(Self::All),
            toml::Value::Table(_) => inner(value).map(|each| Self::Each(Box::new(each))),
            other => Err(wrong(
                "\"report\", \"corrected\" or a table of rules",
                &other,
            )),
        }
    }
}

impl Default for RulesText {
    fn default() -> Self {
        Self::All(Rule::Corrected)
    }
}

#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum TopologyText {
    Word(OpenClosed),
    Ends(EndsText),
}

impl<'de> Deserialize<'de> for TopologyText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(deserializer)?;
        match value {
            toml::Value::String(_) => inner(value).map(Self::Word),
            toml::Value::Table(_) => inner(value).map(Self::Ends),
            other => Err(wrong(
                "\"open\", \"closed\" or { head = …, tail = … }",
                &other,
            )),
        }
    }
}

/// An end: a word, or the line that it slides along.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum EndText {
    Word(EndWord),
    Rail(RailText),
}

impl<'de> Deserialize<'de> for EndText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(deserializer)?;
        match value {
            toml::Value::String(_) => inner(value).map(Self::Word),
            toml::Value::Table(_) => inner(value).map(Self::Rail),
            other => Err(wrong(
                "\"free\", another word or { rail = [[x, y], …] }",
                &other,
            )),
        }
    }
}

/// Damping: a profile, or the word for a rule that chooses it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum DampingText {
    Given(ParameterText),
    Rule(String),
}

impl<'de> Deserialize<'de> for DampingText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match toml::Value::deserialize(deserializer)? {
            toml::Value::String(word) => Ok(Self::Rule(word)),
            other => inner(other).map(Self::Given),
        }
    }
}

/// Internal damping: a time, or the word for a rule that chooses it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum InternalText {
    Given(f64),
    Rule(String),
}

impl<'de> Deserialize<'de> for InternalText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match toml::Value::deserialize(deserializer)? {
            toml::Value::String(word) => Ok(Self::Rule(word)),
            toml::Value::Float(value) => Ok(Self::Given(value)),
            toml::Value::Integer(value) => inner(toml::Value::Integer(value)).map(Self::Given),
            other => Err(wrong("a time, \"critical\" or \"mode(k)\"", &other)),
        }
    }
}

/// The body frame: a word, or the inertial forces that its equations have.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum FrameText {
    Word(FrameWord),
    Terms(TermsText),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum FrameWord {
    /// It moves with the body and keeps its direction.
    Translating,
    /// It turns too, to where the rest shape fits best.
    Turning,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TermsText {
    pub terms: Vec<TermText>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TermText {
    Centrifugal,
    Coriolis,
    Transverse,
}

impl<'de> Deserialize<'de> for FrameText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(deserializer)?;
        match value {
            toml::Value::String(_) => inner(value).map(Self::Word),
            toml::Value::Table(_) => inner(value).map(Self::Terms),
            other => Err(wrong(
                "\"translating\", \"turning\" or { terms = [\"centrifugal\", \"coriolis\", \"transverse\"] }",
                &other,
            )),
        }
    }
}

/// A step: a number, or the word for one chosen while it runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum StepText {
    Fixed(f64),
    Auto,
}

impl<'de> Deserialize<'de> for StepText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match toml::Value::deserialize(deserializer)? {
            toml::Value::Float(value) => Ok(Self::Fixed(value)),
            toml::Value::String(word) if word == "auto" => Ok(Self::Auto),
            toml::Value::Integer(value) => inner(toml::Value::Integer(value)).map(Self::Fixed),
            other => Err(wrong("a number above 0 or \"auto\"", &other)),
        }
    }
}

/// The time between two steps: a number, or the word for each sub-step being one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum OutputText {
    Time(f64),
    Every,
}

impl<'de> Deserialize<'de> for OutputText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match toml::Value::deserialize(deserializer)? {
            toml::Value::Float(value) => Ok(Self::Time(value)),
            toml::Value::String(word) if word == "every" => Ok(Self::Every),
            toml::Value::Integer(value) => inner(toml::Value::Integer(value)).map(Self::Time),
            other => Err(wrong("a number above 0 or \"every\"", &other)),
        }
    }
}

impl Serialize for StepText {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Fixed(dt) => serializer.serialize_f64(*dt),
            Self::Auto => serializer.serialize_str("auto"),
        }
    }
}

impl Serialize for OutputText {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Time(time) => serializer.serialize_f64(*time),
            Self::Every => serializer.serialize_str("every"),
        }
    }
}

/// How many nodes: their number, or their distance along the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum NodesText {
    Count(usize),
    /// Pixels.
    Apart(f64),
}

impl<'de> Deserialize<'de> for NodesText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(deserializer)?;
        let toml::Value::String(text) = &value else {
            return inner(value).map(Self::Count);
        };
        let number = ["pixels", "pixel", "px"].iter().find_map(|unit| {
            let number = text.trim().strip_suffix(unit)?.trim_end();
            number.parse::<f64>().ok()
        });
        number.map(Self::Apart).ok_or_else(|| {
            let wanted = "a number of nodes, or the distance between two in pixels, as \"4 px\"";
            wrong(wanted, &value)
        })
    }
}

impl Serialize for NodesText {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Count(count) => count.serialize(serializer),
            Self::Apart(distance) => serializer.serialize_str(&format!("{distance} px")),
        }
    }
}

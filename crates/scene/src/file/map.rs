//! The text of a parameter that the picture has a say in.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::forms::{inner, shown};
use super::{ProfileText, usual};

/// A profile, and the map it is multiplied with, if there is one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ParameterText {
    pub profile: ProfileText,
    pub map: Option<MapText>,
}

/// What a share of 0 and of 1 mean, and where shares come from.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct MapText {
    pub map: SourceText,
    pub low: Option<f64>,
    pub high: Option<f64>,
    pub range: Option<[f64; 2]>,
}

/// Where the shares of a map come from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SourceText {
    Grey,
    Edge(SigmaText),
    Contrast(SigmaText),
    Distance(AwayText),
    File(String),
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct SigmaText {
    pub sigma: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct AwayText {
    pub sigma: Option<f64>,
    pub least: Option<f64>,
    pub reach: Option<f64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum WordText {
    Grey,
    Edge,
    Contrast,
    Distance,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum TableText {
    Edge(SigmaText),
    Contrast(SigmaText),
    Distance(AwayText),
    File(String),
}

impl<'de> Deserialize<'de> for SourceText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(deserializer)?;
        Ok(match value {
            toml::Value::String(_) => match inner(value)? {
                WordText::Grey => Self::Grey,
                WordText::Edge => Self::Edge(SigmaText::default()),
                WordText::Contrast => Self::Contrast(SigmaText::default()),
                WordText::Distance => Self::Distance(AwayText::default()),
            },
            toml::Value::Table(_) => match inner(value)? {
                TableText::Edge(text) => Self::Edge(text),
                TableText::Contrast(text) => Self::Contrast(text),
                TableText::Distance(text) => Self::Distance(text),
                TableText::File(file) => Self::File(file),
            },
            other => {
                let message = format!(
                    "expected \"grey\", \"edge\", \"contrast\", \"distance\" or {{ file = … }}, got {}",
                    shown(&other)
                );
                return Err(serde::de::Error::custom(message));
            }
        })
    }
}

impl<'de> Deserialize<'de> for ParameterText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(deserializer)?;
        let toml::Value::Table(mut table) = value else {
            let profile = inner(value)?;
            return Ok(Self { profile, map: None });
        };
        const KEYS: [&str; 6] = ["value", "along", "map", "low", "high", "range"];
        let mapped = KEYS[2..].iter().any(|key| table.contains_key(*key));
        if let Some(other) = table.keys().find(|key| !KEYS.contains(&key.as_str()))
            && mapped
        {
            return Err(serde::de::Error::unknown_field(other, &KEYS));
        }
        let mut own = toml::Table::new();
        for key in ["map", "low", "high", "range"] {
            if let Some(value) = table.remove(key) {
                own.insert(key.to_owned(), value);
            }
        }
        let map = if own.is_empty() {
            None
        } else {
            Some(inner(toml::Value::Table(own))?)
        };
        let given = match table.remove("value") {
            Some(value) if table.is_empty() => value,
            Some(_) => {
                let message = "value is the whole profile; needed: no other key beside it";
                return Err(serde::de::Error::custom(message));
            }
            None => toml::Value::Table(table),
        };
        let profile = inner(given)?;
        Ok(Self { profile, map })
    }
}

/// A source whose keys are given.
#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
enum Given<'a> {
    Edge(&'a SigmaText),
    Contrast(&'a SigmaText),
    Distance(&'a AwayText),
    File(&'a str),
}

impl Serialize for SourceText {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Grey => serializer.serialize_str("grey"),
            Self::Edge(text) if usual(text) => serializer.serialize_str("edge"),
            Self::Contrast(text) if usual(text) => serializer.serialize_str("contrast"),
            Self::Distance(text) if usual(text) => serializer.serialize_str("distance"),
            Self::Edge(text) => Given::Edge(text).serialize(serializer),
            Self::Contrast(text) => Given::Contrast(text).serialize(serializer),
            Self::Distance(text) => Given::Distance(text).serialize(serializer),
            Self::File(file) => Given::File(file).serialize(serializer),
        }
    }
}

/// A parameter with a map as it is written: all in one table.
#[derive(Serialize)]
struct ParameterLines<'a> {
    value: Option<&'a ProfileText>,
    along: Option<&'a [[f64; 2]]>,
    #[serde(flatten)]
    map: &'a MapText,
}

impl Serialize for ParameterText {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Some(map) = &self.map else {
            return self.profile.serialize(serializer);
        };
        let (value, along) = match &self.profile {
            ProfileText::Along(along) => (None, Some(&along.along[..])),
            profile => (Some(profile), None),
        };
        ParameterLines { value, along, map }.serialize(serializer)
    }
}

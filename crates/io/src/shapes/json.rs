//! JSON as a tree that takes little more memory than its text, with the place of everything in it.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt;

use serde::de::{DeserializeSeed, Error as _, MapAccess, SeqAccess, Visitor};

use super::Value;
use crate::IoError;
use crate::limits::MOST_VALUES;

/// A value of JSON. A list of numbers alone is kept as such.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Json {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    Numbers(Vec<f64>),
    List(Vec<Self>),
    Table(Vec<(String, Self)>),
}

/// Where a value stands, for messages.
#[derive(Clone, Copy)]
pub(super) struct At<'a> {
    up: Option<&'a Self>,
    step: Step<'a>,
}

#[derive(Clone, Copy)]
enum Step<'a> {
    Root,
    Key(&'a str),
    Index(usize),
}

impl At<'static> {
    pub(super) const ROOT: Self = At {
        up: None,
        step: Step::Root,
    };
}

impl At<'_> {
    pub(super) const fn key<'a>(&'a self, key: &'a str) -> At<'a> {
        At {
            up: Some(self),
            step: Step::Key(key),
        }
    }

    pub(super) const fn index(&self, index: usize) -> At<'_> {
        At {
            up: Some(self),
            step: Step::Index(index),
        }
    }

    /// A refusal of what stands here.
    pub(super) fn refuse(&self, what: impl fmt::Display) -> IoError {
        let place = self.to_string();
        IoError::text(
            None,
            if place.is_empty() {
                what.to_string()
            } else {
                format!("{place}: {what}")
            },
        )
    }
}

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(up) = self.up {
            up.fmt(f)?;
        }
        match self.step {
            Step::Root => Ok(()),
            Step::Index(index) => write!(f, "[{index}]"),
            Step::Key(key) if self.up.is_some_and(|up| up.up.is_some()) => write!(f, ".{key}"),
            Step::Key(key) => f.write_str(key),
        }
    }
}

impl Json {
    /// The value of a text.
    pub(super) fn parse(text: &str) -> Result<Self, IoError> {
        let count = Cell::new(0);
        let mut reader = serde_json::Deserializer::from_str(text);
        let read = Seed(&count).deserialize(&mut reader);
        read.and_then(|value| reader.end().map(|()| value))
            .map_err(|error| {
                let said = error.to_string();
                let said = said.split(" at line ").next().unwrap_or_default();
                IoError::text(
                    Some(error.line()),
                    format!("{}; a whole JSON is needed", crate::text::clip(said)),
                )
            })
    }

    /// What stands under a name.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        match self {
            Self::Table(list) => {
                let found = list.iter().find(|(name, _)| name == key);
                found.map(|(_, value)| value).filter(|v| **v != Self::Null)
            }
            _ => None,
        }
    }

    pub(super) fn text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// A name, which may be a number.
    pub(super) fn name(&self) -> Option<String> {
        match self {
            Self::Text(text) => Some(text.clone()),
            Self::Number(number) => Some(number.to_string()),
            _ => None,
        }
    }

    /// The numbers of a list of numbers alone.
    pub(super) fn numbers(&self) -> Option<&[f64]> {
        match self {
            Self::Numbers(list) => Some(list),
            Self::List(list) if list.is_empty() => Some(&[]),
            _ => None,
        }
    }

    /// The entries of a list that has others than numbers.
    pub(super) fn list(&self) -> Option<&[Self]> {
        match self {
            Self::List(list) => Some(list),
            Self::Numbers(list) if list.is_empty() => Some(&[]),
            _ => None,
        }
    }

    /// As a property of an outline.
    pub(super) fn value(&self) -> Value {
        match self {
            Self::Null => Value::Nothing,
            Self::Bool(yes) => Value::Bool(*yes),
            Self::Number(number) => Value::Number(*number),
            Self::Text(text) => Value::Text(text.clone()),
            Self::Numbers(list) => Value::List(list.iter().map(|&v| Value::Number(v)).collect()),
            Self::List(list) => Value::List(list.iter().map(Self::value).collect()),
            Self::Table(_) => Value::Table(self.values(&[])),
        }
    }

    /// The entries of a table as properties, without those of some names.
    pub(super) fn values(&self, without: &[&str]) -> BTreeMap<String, Value> {
        let Self::Table(list) = self else {
            return BTreeMap::new();
        };
        let kept = list
            .iter()
            .filter(|(name, _)| !without.contains(&name.as_str()));
        kept.map(|(name, value)| (name.clone(), value.value()))
            .collect()
    }
}

/// A property as JSON.
pub(super) fn json_of(value: &Value) -> serde_json::Value {
    match value {
        Value::Nothing => serde_json::Value::Null,
        Value::Bool(yes) => (*yes).into(),
        Value::Number(number) => number_of(*number),
        Value::Text(text) => text.clone().into(),
        Value::List(list) => list.iter().map(json_of).collect(),
        Value::Table(table) => table_of(table).into(),
    }
}

pub(super) fn table_of(
    table: &BTreeMap<String, Value>,
) -> serde_json::Map<String, serde_json::Value> {
    let entries = table.iter();
    entries
        .map(|(name, value)| (name.clone(), json_of(value)))
        .collect()
}

/// A number, whole ones without a point.
#[expect(
    clippy::cast_possible_truncation,
    reason = "whole numbers below 2^53 are kept exactly"
)]
pub(super) fn number_of(number: f64) -> serde_json::Value {
    let whole = number.fract() == 0.0
        && number.abs() < 9e15
        && !(number == 0.0 && number.is_sign_negative());
    if whole {
        return (number as i64).into();
    }
    serde_json::Number::from_f64(number).map_or(serde_json::Value::Null, Into::into)
}

/// Reads one value, and counts all but numbers in lists of numbers.
#[derive(Clone, Copy)]
struct Seed<'a>(&'a Cell<usize>);

impl Seed<'_> {
    fn count<E: serde::de::Error>(self, more: usize) -> Result<(), E> {
        self.0.set(self.0.get().saturating_add(more));
        if self.0.get() > MOST_VALUES {
            return Err(E::custom(format!("more than {MOST_VALUES} values")));
        }
        Ok(())
    }
}

impl<'de> DeserializeSeed<'de> for Seed<'_> {
    type Value = Json;

    fn deserialize<D: serde::Deserializer<'de>>(self, reader: D) -> Result<Json, D::Error> {
        reader.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_> {
    type Value = Json;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_unit<E>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E>(self, yes: bool) -> Result<Json, E> {
        Ok(Json::Bool(yes))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Json, E> {
        Ok(Json::Number(number))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Json, E> {
        Ok(Json::Number(number as f64))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Json, E> {
        Ok(Json::Number(number as f64))
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Json, E> {
        self.count(1)?;
        Ok(Json::Text(text.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<Json, A::Error> {
        self.count(1)?;
        let mut numbers: Vec<f64> = Vec::new();
        let mut list: Option<Vec<Json>> = None;
        while let Some(entry) = entries.next_element_seed(self)? {
            match (entry, &mut list) {
                (Json::Number(number), None) => numbers.push(number),
                (entry, Some(list)) => {
                    self.count(1)?;
                    list.push(entry);
                }
                (entry, None) => {
                    self.count(numbers.len() + 1)?;
                    let mut all: Vec<Json> = numbers.drain(..).map(Json::Number).collect();
                    all.push(entry);
                    list = Some(all);
                }
            }
        }
        Ok(list.map_or_else(
            || {
                numbers.shrink_to_fit();
                Json::Numbers(numbers)
            },
            Json::List,
        ))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Json, A::Error> {
        self.count(1)?;
        let mut list = Vec::new();
        while let Some(key) = entries.next_key::<String>()? {
            self.count(1)?;
            if key.len() > MOST_KEY {
                return Err(A::Error::custom("a name that is too long"));
            }
            list.push((key, entries.next_value_seed(self)?));
        }
        Ok(Json::Table(list))
    }
}

/// Bytes of a name in a table.
const MOST_KEY: usize = 1000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_kept_and_lists_of_numbers_are_flat() {
        let json = Json::parse(r#"{"a":[1,2.5,-3],"b":[[1],"x",null],"c":true,"d":[]}"#).unwrap();
        assert_eq!(
            json.get("a").unwrap().numbers(),
            Some(&[1.0, 2.5, -3.0][..])
        );
        assert_eq!(json.get("b").unwrap().list().unwrap().len(), 3);
        assert_eq!(json.get("c"), Some(&Json::Bool(true)));
        assert_eq!(json.get("d").unwrap().list(), Some(&[][..]));
        let value = json.value();
        let written = json_of(&value).to_string();
        assert_eq!(Json::parse(&written).unwrap().value(), value);
    }

    #[test]
    fn what_is_no_json_is_refused_by_its_line() {
        for (text, line) in [
            ("{\n\"a\": nil}", "line 2: "),
            ("[1,2", "line 1: "),
            ("[NaN]", "line 1: "),
            ("[1e999]", "line 1: "),
            ("{} x", "line 1: "),
            (&"[".repeat(100_000), "line 1: recursion limit"),
        ] {
            let error = Json::parse(text).unwrap_err().to_string();
            assert!(error.starts_with(line), "{error}");
        }
    }

    #[test]
    fn a_place_reads_as_a_path() {
        let (a, b) = (At::ROOT.key("features"), 3);
        let at = a.index(b);
        assert_eq!(at.key("geometry").to_string(), "features[3].geometry");
    }
}

//! TOML's own messages, turned into one line that names the place and what is needed.

use serde::Deserialize as _;

use crate::SceneError;
use crate::error::{clip, meant};
use crate::file::SceneText;
use crate::limits::MOST_VALUES;

/// Read the text of a scene.
pub(crate) fn parse(text: &str) -> Result<SceneText, SceneError> {
    read(text)
}

/// The text of a scene from the table that it is in TOML.
pub(crate) fn from_table(table: toml::Table) -> Result<SceneText, String> {
    SceneText::deserialize(toml::Value::Table(table)).map_err(|error| helpful(error.message()))
}

/// Read a text of any shape.
pub(crate) fn read<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, SceneError> {
    few_enough(text)?;
    toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start.min(text.len()));
        let before = text.get(..start).unwrap_or("");
        let line = before.matches('\n').count();
        let given = clip(text.lines().nth(line).unwrap_or(""));
        let mut message = helpful(error.message());
        if !given.is_empty() {
            message.push_str(&format!(", at: {given}"));
        }
        SceneError::Text {
            line: line + 1,
            message,
        }
    })
}

/// Refuse a text of more values than a scene can need, before each takes its hundred bytes and more.
fn few_enough(text: &str) -> Result<(), SceneError> {
    let mut values = 0;
    for (number, line) in (1..).zip(text.lines()) {
        // whatever ends or begins one, in words and comments too: a scene has few of those
        values += line.bytes().filter(|byte| b",=[{".contains(byte)).count();
        if values > MOST_VALUES {
            let message =
                format!("the text holds more than {MOST_VALUES} values, which are the most");
            return Err(SceneError::Text {
                line: number,
                message,
            });
        }
    }
    Ok(())
}

/// A message of serde's, with the nearest known key where it names an unknown one.
fn helpful(message: &str) -> String {
    let message = message.trim();
    // a list says which of its entries it is about
    if let Some((entry, rest)) = message.split_once(": ")
        && entry.starts_with("force ")
    {
        return format!("{entry}: {}", helpful(rest));
    }
    if message.starts_with("wanted exactly 1 element") {
        return "must have exactly one key, the word for what it is".to_owned();
    }
    if message == "invalid type: unit variant, expected newtype variant" {
        return "is a word that needs a value, as { word = value }".to_owned();
    }
    // serde names the type of this program
    if let Some((given, _)) = message.split_once(", expected struct ") {
        return format!("{}, expected a table", clip(given));
    }
    let mut quoted = message.split('`').skip(1).step_by(2);
    let unknown = message.starts_with("unknown field") || message.starts_with("unknown variant");
    match (unknown, quoted.next()) {
        (true, Some(word)) => {
            let known: Vec<&str> = quoted.collect();
            if known.is_empty() {
                return clip(message);
            }
            let meant = meant(word, known.iter().copied());
            let what = if message.starts_with("unknown field") {
                "key"
            } else {
                "word"
            };
            let (word, known) = (clip(word), known.join(", "));
            format!("unknown {what} \"{word}\"{meant} (known: {known})")
        }
        _ => message.lines().collect::<Vec<_>>().join(", "),
    }
}

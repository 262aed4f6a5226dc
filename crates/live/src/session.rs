//! A session as a list of messages, each with the steps made before it: what replays to the same bytes.

use std::sync::Arc;

use base64::prelude::BASE64_STANDARD;
use serde::{Deserialize, Serialize};

use crate::LiveError;
use crate::request::Action;

/// Messages that are kept at most, and bytes of a session that is read.
const MOST_MESSAGES: usize = 1_000_000;
const MOST_BYTES: usize = 1 << 30;

/// Steps that a session may have at most.
const MOST_STEPS: u64 = 1 << 40;

/// The number of this form of sessions.
const FORM: u32 = 1;

/// A message that was carried out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Said {
    /// Steps made by the clock before it.
    pub at: u64,
    /// What.
    #[serde(rename = "do")]
    pub action: Action,
    /// The bytes of the file that came with it.
    #[serde(default = "none", skip_serializing_if = "is_none", with = "bytes")]
    pub file: Arc<[u8]>,
}

/// A session: everything that was done, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Session {
    /// The number of the form.
    #[serde(rename = "snakes-session")]
    form: u32,
    /// Steps made by the clock in all.
    pub(crate) steps: u64,
    pub(crate) messages: Vec<Said>,
}

impl Default for Session {
    fn default() -> Self {
        Self {
            form: FORM,
            steps: 0,
            messages: Vec::new(),
        }
    }
}

impl Session {
    /// The session of a text.
    ///
    /// # Errors
    ///
    /// Text that is no session, or one of a later form.
    pub fn parse(text: &str) -> Result<Self, LiveError> {
        if text.len() > MOST_BYTES {
            let got = text.len();
            return Err(LiveError::new(format!(
                "a session must have at most {MOST_BYTES} bytes, got {got}"
            )));
        }
        let session: Self = serde_json::from_str(text)
            .map_err(|error| LiveError::new(format!("this is no session of Snakes: {error}")))?;
        if session.form != FORM {
            return Err(LiveError::new(format!(
                "the form of this session must be {FORM}, got {}; another version of the program wrote it",
                session.form
            )));
        }
        if session.steps > MOST_STEPS {
            return Err(LiveError::new(format!(
                "a session must have at most {MOST_STEPS} steps, got {}",
                session.steps
            )));
        }
        let mut before = 0;
        for (index, said) in session.messages.iter().enumerate() {
            if said.at < before || said.at > session.steps {
                return Err(LiveError::new(format!(
                    "message {index} of the session comes after {} steps; it must be from {before} to {}",
                    said.at, session.steps
                )));
            }
            before = said.at;
        }
        Ok(session)
    }

    /// Whether a text looks like a session.
    #[must_use]
    pub fn is_one(text: &str) -> bool {
        text.trim_start().starts_with('{') && text.contains("\"snakes-session\"")
    }

    /// The text of it.
    #[must_use]
    pub fn text(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// A message was carried out. One that takes the place of the one before it, at the same step, replaces it.
    pub(crate) fn say(&mut self, said: Said, replaces: bool) {
        self.steps = said.at;
        let room = self.messages.len() < MOST_MESSAGES;
        match self.messages.last_mut() {
            Some(last) if replaces && last.at == said.at => *last = said,
            _ if room => self.messages.push(said),
            // too long to be kept whole: what is kept stays a session, of what was done so far
            _ => {}
        }
    }
}

fn none() -> Arc<[u8]> {
    Arc::new([])
}

fn is_none(file: &Arc<[u8]>) -> bool {
    file.is_empty()
}

/// Bytes of files as text.
mod bytes {
    use super::{Arc, BASE64_STANDARD, Deserialize};
    use base64::Engine as _;
    use serde::{Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(bytes: &Arc<[u8]>, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&BASE64_STANDARD.encode(bytes))
    }

    pub(super) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Arc<[u8]>, D::Error> {
        let text = String::deserialize(from)?;
        BASE64_STANDARD
            .decode(text)
            .map(Into::into)
            .map_err(|error| D::Error::custom(format!("a file must be in base 64: {error}")))
    }
}

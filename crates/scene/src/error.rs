//! What can be wrong with a scene. Every message names the key or the file, what was given, and
//! what is needed.

use io::IoError;
pub(crate) use io::text::clip;

/// Why a scene was refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A value under a key that will not do.
    #[error("{key}: {message}")]
    Key {
        /// The key as written, with its table: `material.tension`.
        key: String,
        /// What was given and what is needed.
        message: String,
    },
    /// Text that is no scene: syntax, unknown key, wrong type.
    #[error("line {line}: {message}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// What is wrong and what is needed.
        message: String,
    },
    /// No shipped scene has this name.
    #[error("no shipped scene is called \"{}\"{nearest}", clip(name))]
    UnknownScene {
        /// The name given.
        name: String,
        /// A question that names the nearest shipped one, or nothing.
        nearest: String,
    },
    /// A file that cannot be read or written.
    #[error(transparent)]
    File(#[from] IoError),
    /// A step larger than the scheme can bear.
    #[error("run.dt: {0}")]
    Step(String),
}

impl SceneError {
    pub(crate) fn key(key: &str, message: impl ToString) -> Self {
        Self::Key {
            key: key.to_owned(),
            message: message.to_string(),
        }
    }
}

/// What to say behind an unknown word: the known one that it is most like, if it is like any.
pub(crate) fn meant<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    match nearest(word, known) {
        Some(near) => format!("; did you mean \"{near}\"?"),
        None => String::new(),
    }
}

/// The entry of `known` that a slip of the keys could turn into `word`, whatever the case of letters.
fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word: String = word.trim().chars().take(100).collect();
    let word = word.to_lowercase();
    let like = |known: &str| strsim::jaro_winkler(&word, &known.to_lowercase());
    let near = |known: &&str| {
        let slips = strsim::osa_distance(&word, &known.to_lowercase());
        slips <= (known.chars().count() / 3).max(1) || like(known) >= 0.9
    };
    let known = known.into_iter().filter(near);
    known.max_by(|a, b| like(a).total_cmp(&like(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_word_that_a_slip_makes_is_taken_for_a_known_one() {
        let known = ["gvf", "edge", "gravity", "soft-ball", "two-cells"];
        for (word, near) in [
            ("GVF", Some("gvf")),
            ("gvff", Some("gvf")),
            ("egde", Some("edge")),
            ("soft-bal", Some("soft-ball")),
            ("Soft-Ball", Some("soft-ball")),
            ("nosuch", None),
            ("zzz", None),
            ("", None),
        ] {
            assert_eq!(nearest(word, known), near, "{word}");
        }
    }
}

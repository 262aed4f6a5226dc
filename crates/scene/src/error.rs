//! What can be wrong with a scene, a picture or a contour. Every message names the key or the
//! file, what was given, and what would do.

use std::path::PathBuf;

/// Why a scene, a picture, a contour or a record was refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A value under a key that will not do.
    #[error("{key}: {message}")]
    Key {
        /// The key as written, with its table: `material.tension`.
        key: String,
        /// What was given and what would do.
        message: String,
    },
    /// Text that is no scene: syntax, unknown key, wrong type.
    #[error("line {line}: {message}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// What is wrong and what would do.
        message: String,
    },
    /// No shipped scene has this name.
    #[error(
        "no shipped scene is called \"{}\"{nearest} (`snake list` shows all; a file needs its ending or a folder)",
        clip(name)
    )]
    UnknownScene {
        /// The name given.
        name: String,
        /// A question that names the nearest shipped one, or nothing.
        nearest: String,
    },
    /// A file that cannot be read or written.
    #[error("{}: {message}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
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

    pub(crate) fn file(path: &std::path::Path, message: impl ToString) -> Self {
        Self::File {
            path: path.to_owned(),
            message: message.to_string(),
        }
    }
}

/// At most sixty characters of what was given, on one line, for a message.
pub(crate) fn clip(given: &str) -> String {
    clip_to(given, 60)
}

/// [`clip`] to so many characters.
pub(crate) fn clip_to(given: &str, most: usize) -> String {
    let mut short = plain(&given.trim().chars().take(most).collect::<String>());
    if given.trim().chars().nth(most).is_some() {
        short.push('…');
    }
    short
}

/// Text on one line, without letters that would move the cursor or turn the order of others about.
#[must_use]
pub fn plain(text: &str) -> String {
    let shown = |c: char| !(c.is_control() || is_directing(c));
    text.chars()
        .map(|c| if shown(c) { c } else { '\u{fffd}' })
        .collect()
}

/// Letters without a shape that change how those around them are shown: directions, separators of lines, marks of a
/// beginning.
const fn is_directing(c: char) -> bool {
    matches!(
        c,
        '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
    )
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

    #[test]
    fn letters_that_turn_others_about_are_not_shown() {
        assert_eq!(
            plain("a\u{202e}b\u{1b}[1mc\u{2066}ä"),
            "a\u{fffd}b\u{fffd}[1mc\u{fffd}ä"
        );
        assert_eq!(clip(&"é".repeat(61)), format!("{}…", "é".repeat(60)));
    }
}

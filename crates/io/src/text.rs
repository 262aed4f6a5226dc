//! Words from files, made fit for a message of one line.

/// At most sixty characters of what was given, on one line, for a message.
#[must_use]
pub fn clip(given: &str) -> String {
    clip_to(given, 60)
}

/// [`clip`] to so many characters.
#[must_use]
pub fn clip_to(given: &str, most: usize) -> String {
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

/// Letters without a shape that change how those around them are shown: directions, separators of
/// lines, marks of a beginning.
const fn is_directing(c: char) -> bool {
    matches!(
        c,
        '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_that_turn_others_about_are_not_shown() {
        assert_eq!(
            plain("a\u{202e}b\u{1b}[1mc\u{2066}ä"),
            "a\u{fffd}b\u{fffd}[1mc\u{fffd}ä"
        );
        assert_eq!(clip(&"é".repeat(61)), format!("{}…", "é".repeat(60)));
    }
}

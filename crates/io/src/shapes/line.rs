//! Lines of a table as entries.

/// What stands between the entries of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Separator {
    Letter(char),
    Space,
}

impl Separator {
    /// Of a line: a tab, a semicolon or a comma that is not in quotes, or else space.
    pub(crate) fn of(line: &str) -> Self {
        let line = line.trim();
        let mut found = [false; 3];
        let mut quoted = false;
        for c in line.chars() {
            quoted ^= c == '"';
            if !quoted && let Some(at) = LETTERS.iter().position(|&known| known == c) {
                found[at] = true;
            }
        }
        let first = (0..3).find(|&at| found[at]);
        first.map_or(Self::Space, |at| Self::Letter(LETTERS[at]))
    }

    /// The number that an entry is; with a decimal comma, perhaps, where commas do not separate.
    pub(crate) fn number(self, entry: &str) -> Option<f64> {
        if let Ok(number) = entry.parse() {
            return Some(number);
        }
        let comma = matches!(self, Self::Letter('\t' | ';')) && !entry.contains('.');
        let (whole, rest) = entry.split_once(',').filter(|_| comma)?;
        let digits =
            |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
        let begin = whole.trim_start_matches(['-', '+']);
        let rest_digits = rest.split(['e', 'E']).next().unwrap_or_default();
        if !(digits(begin) && digits(rest_digits)) {
            return None;
        }
        format!("{whole}.{rest}").parse().ok()
    }

    /// The entries of a line, without the space and the quotes around them; nothing is kept.
    pub(crate) fn split(self, line: &str) -> impl Iterator<Item = &str> {
        let mut rest = Some(match self {
            Self::Letter('\t') => line.trim_end_matches(['\r', '\n']),
            _ => line.trim(),
        });
        std::iter::from_fn(move || {
            let line = rest?;
            let mut quoted = false;
            let ends = |c: char| {
                quoted ^= c == '"';
                !quoted
                    && match self {
                        Self::Letter(letter) => c == letter,
                        Self::Space => c.is_whitespace(),
                    }
            };
            let (word, after) = match line.find(ends) {
                Some(at) => {
                    let (word, after) = line.split_at(at);
                    let mut letters = after.chars();
                    letters.next();
                    (word, Some(letters.as_str()))
                }
                None => (line, None),
            };
            rest = match self {
                Self::Letter(_) => after,
                Self::Space => after.map(str::trim_start),
            };
            Some(unquoted(word.trim()))
        })
    }
}

/// In the order in which they are tried.
const LETTERS: [char; 3] = ['\t', ';', ','];

fn unquoted(word: &str) -> &str {
    let inside = word.strip_prefix('"').and_then(|w| w.strip_suffix('"'));
    inside.map_or(word, str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decimal_comma_is_one_where_commas_do_not_separate() {
        for (line, numbers) in [
            ("12,5;-40,25", &[Some(12.5), Some(-40.25)][..]),
            ("12,5\t1e3", &[Some(12.5), Some(1000.0)]),
            (
                "1,5e2;,5;1,234,567;1.234,5",
                &[Some(150.0), None, None, None],
            ),
        ] {
            let separator = Separator::of(line);
            let found: Vec<_> = separator
                .split(line)
                .map(|one| separator.number(one))
                .collect();
            assert_eq!(found, numbers, "{line}");
        }
    }

    #[test]
    fn entries_stand_between_separators_that_are_not_in_quotes() {
        for (line, entries) in [
            ("1,2", &["1", "2"][..]),
            (" 1 ;  2 ", &["1", "2"]),
            (" \tX\tY", &["", "X", "Y"]),
            ("1\t2\t\r", &["1", "2", ""]),
            ("\t1   2", &["1", "2"]),
            ("\"1,5\",\"2\"", &["1,5", "2"]),
            ("\"x\" \"y\"", &["x", "y"]),
            ("1,,2,", &["1", "", "2", ""]),
            ("", &[""]),
        ] {
            let separator = Separator::of(line);
            let found: Vec<&str> = separator.split(line).collect();
            assert_eq!(found, entries, "{line:?} by {separator:?}");
        }
    }
}

//! Tables as text: values between commas, quoted where they hold any.

use io::IoError;
use std::path::Path;

/// A table with named columns.
#[derive(Debug)]
pub(super) struct Table {
    names: Vec<String>,
    /// The line of each row, from 1, and its values.
    pub(super) rows: Vec<(usize, Vec<String>)>,
}

impl Table {
    /// Read a table from a file.
    pub(super) fn load(path: &Path) -> Result<Self, IoError> {
        let text = io::read_text(path, "a table of values between commas", 256 << 20)?;
        let mut rows = rows(&text).into_iter();
        let Some((_, names)) = rows.next() else {
            return Err(IoError::file(
                path,
                "is empty; a line with the names of its columns is needed",
            ));
        };
        let names = names.iter().map(|name| name.trim().to_owned()).collect();
        let rows = rows.collect();
        Ok(Self { names, rows })
    }

    /// Where a column is.
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// Where a column is that must be there.
    pub(super) fn needed(&self, path: &Path, name: &str) -> Result<usize, IoError> {
        self.column(name).ok_or_else(|| {
            let there = io::text::clip(&self.names.join(","));
            IoError::file(
                path,
                format!("has no column \"{name}\", which is needed; got {there}"),
            )
        })
    }
}

/// The rows of a text with their lines, from 1; a quote in quotes is doubled. Empty lines are none.
fn rows(text: &str) -> Vec<(usize, Vec<String>)> {
    let mut rows = Vec::new();
    let (mut row, mut value, mut quoted) = (Vec::new(), String::new(), false);
    let (mut line, mut begin) = (1, 1);
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        line += usize::from(c == '\n');
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => value.extend(chars.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => row.push(std::mem::take(&mut value)),
            '\r' if !quoted && chars.peek() == Some(&'\n') => {}
            '\n' if !quoted => {
                row.push(std::mem::take(&mut value));
                rows.push((begin, std::mem::take(&mut row)));
                begin = line;
            }
            c => value.push(c),
        }
    }
    row.push(value);
    rows.push((begin, row));
    rows.retain(|(_, row)| row.iter().any(|value| !value.is_empty()));
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use score::table::quoted;

    #[test]
    fn quotes_hold_commas_quotes_and_lines() {
        let text = "a,b\r\n1,\"x, \"\"y\"\"\nz\"\n\n2,\n";
        let got = rows(text);
        let row = |one: &str, other: &str| vec![one.to_owned(), other.to_owned()];
        let want = [
            (1, row("a", "b")),
            (2, row("1", "x, \"y\"\nz")),
            (5, row("2", "")),
        ];
        assert_eq!(got, want);
        let again = format!("{},{}", quoted("1"), quoted("x, \"y\"\nz"));
        assert_eq!(rows(&again)[0].1, want[1].1);
    }
}

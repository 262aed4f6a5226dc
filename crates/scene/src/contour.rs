//! Contours as CSV: one `x,y` a line, with the topology in a comment line.
//!
//! ```text
//! # contour 1, closed
//! x,y
//! 12.5,40
//! ```
//!
//! The comment and the heading may be left out; a heading may name the columns x and y in any place;
//! separators may be commas, semicolons, tabs or spaces; further columns are ignored.

use std::path::Path;

use glam::DVec2;

use crate::error::clip;
use crate::limits::{FARTHEST, MOST_CONTOUR_BYTES, MOST_NODES};
use crate::write::write_whole;
use crate::{SceneError, read};

/// A curve as read from, or written to, a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Contour {
    /// Whether the last point joins the first, if the file says so.
    pub closed: Option<bool>,
    /// The points, in order. Pixels.
    pub points: Vec<DVec2>,
}

/// The version of the format.
const VERSION: &str = "1";

impl Contour {
    /// Read a contour file, or standard input for `-`.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, or a line that is not two finite numbers (by its number).
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let text = read::text(path, "a CSV of x,y", MOST_CONTOUR_BYTES)?;
        Self::parse(&text).map_err(|message| SceneError::file(&read::called(path), message))
    }

    /// Read a contour from text.
    ///
    /// # Errors
    ///
    /// A message that names the line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut contour = Self {
            closed: None,
            points: Vec::new(),
        };
        // which columns hold x and y, once a heading has said so
        let mut columns = None;
        for (number, line) in (1..).zip(text.lines().map(str::trim)) {
            let refuse = |what: &str| format!("line {number}: {what}, got \"{}\"", clip(line));
            if let Some(comment) = line.strip_prefix('#') {
                contour.note(comment).map_err(refuse)?;
                continue;
            }
            if line.is_empty() {
                continue;
            }
            let words = words(line);
            let numbers = words.iter().any(|word| word.parse::<f64>().is_ok());
            if !numbers && contour.points.is_empty() && columns.is_none() {
                columns = Some(heading(&words).map_err(refuse)?);
                continue;
            }
            let (first, second) = columns.unwrap_or((0, 1));
            let value = |at: usize| words.get(at).and_then(|word| word.parse::<f64>().ok());
            match (value(first), value(second)) {
                (Some(x), Some(y)) if x.abs() <= FARTHEST && y.abs() <= FARTHEST => {
                    contour.points.push(DVec2::new(x, y));
                }
                (Some(_), Some(_)) => {
                    return Err(refuse(&format!(
                        "numbers from -{FARTHEST:e} to {FARTHEST:e} would do"
                    )));
                }
                _ => return Err(refuse("two numbers x,y would do")),
            }
            if contour.points.len() > MOST_NODES {
                return Err(format!("more than {MOST_NODES} points; so many would do"));
            }
        }
        if contour.points.is_empty() {
            return Err("no points; lines of x,y would do".to_owned());
        }
        Ok(contour)
    }

    /// Take in a comment line: `contour 1, closed` says something, any other is for people.
    fn note(&mut self, comment: &str) -> Result<(), &'static str> {
        let mut words = comment
            .split(|c: char| !c.is_alphanumeric())
            .filter(|word| !word.is_empty());
        match words.next() {
            Some("record") => Err("this is the record of a run; a contour would do"),
            Some("contour") => {
                if words.next().is_some_and(|version| version != VERSION) {
                    return Err("this program reads contours of version 1");
                }
                self.closed = words
                    .find(|word| matches!(*word, "closed" | "open"))
                    .map(|word| word == "closed");
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// The contour as text: what [`Contour::parse`] reads back exactly.
    #[must_use]
    pub fn to_text(&self) -> String {
        use std::fmt::Write as _;
        let mut text = format!("# contour {VERSION}");
        if let Some(closed) = self.closed {
            text.push_str(if closed { ", closed" } else { ", open" });
        }
        text.push_str("\nx,y\n");
        for p in &self.points {
            // writing to a String cannot fail
            let _ = writeln!(text, "{},{}", p.x, p.y);
        }
        text
    }

    /// Write a contour file, whole or not at all.
    ///
    /// # Errors
    ///
    /// A folder that is not there or cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), SceneError> {
        write_whole(path, self.to_text().as_bytes())
    }
}

/// The entries of a line: between tabs, semicolons or commas, or else between spaces.
fn words(line: &str) -> Vec<&str> {
    match ['\t', ';', ','].into_iter().find(|&c| line.contains(c)) {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// The columns of x and y by a heading: by these names, or else the first two.
fn heading(words: &[&str]) -> Result<(usize, usize), &'static str> {
    let column = |name: &str| {
        words.iter().position(|word| {
            // the unit may follow: "x (px)"
            let word = word.trim_matches('"').split_whitespace().next();
            word.is_some_and(|word| word.eq_ignore_ascii_case(name))
        })
    };
    match (column("x"), column("y")) {
        (Some(x), Some(y)) => Ok((x, y)),
        (None, None) if words.len() >= 2 && words.iter().all(|word| is_name(word)) => Ok((0, 1)),
        _ => Err("two numbers x,y or a heading of these names would do"),
    }
}

/// Whether a word can be the name of a column, and is not a number gone wrong.
fn is_name(word: &str) -> bool {
    word.trim_matches('"').starts_with(char::is_alphabetic)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_contour_may_have_a_comment_a_heading_and_any_usual_separator() {
        let expected = vec![DVec2::new(1.0, 2.5), DVec2::new(-3.0, 4.0)];
        for text in [
            "x,y\n1,2.5\n-3,4\n",
            "1 2.5\n-3\t4",
            "# a drawing, not closed\n1;2.5;9\n\n-3;4;9\n",
            "\"node\",\"Y\",\"X\"\n0,2.5,1\n1,4,-3\n",
            "breadth height\r\n1 2.5\r\n-3 4\r\n",
            "x (px), y (px)\n1, 2.5\n-3, 4\n",
        ] {
            let contour = Contour::parse(text).unwrap();
            assert_eq!(
                (contour.points, contour.closed),
                (expected.clone(), None),
                "{text:?}"
            );
        }
        assert_eq!(
            Contour::parse("# contour 1, open\n1,2").unwrap().closed,
            Some(false)
        );
    }

    #[test]
    fn a_bad_line_is_named() {
        for (text, message) in [
            (
                "x,y\n1,2\n3,apple\n",
                "line 3: two numbers x,y would do, got \"3,apple\"",
            ),
            (
                "x,y\n1,2\n3\n",
                "line 3: two numbers x,y would do, got \"3\"",
            ),
            ("1,apple\n1,2", "line 1: two numbers x,y would do"),
            ("1,NaN", "line 1: numbers from -1e9 to 1e9 would do"),
            ("inf,0", "line 1: numbers from -1e9 to 1e9 would do"),
            ("0,1e10", "line 1: numbers from -1e9 to 1e9 would do"),
            ("x,y\n", "no points"),
            ("", "no points"),
            ("x,y\nx,y\n1,2", "line 2: two numbers"),
            ("12,5;40,5\n", "line 1: two numbers x,y or a heading"),
            ("1,,2\n", "line 1: two numbers x,y would do"),
            ("x,z\n1,2", "line 1: two numbers x,y or a heading"),
            ("apple\n1,2", "line 1: two numbers x,y or a heading"),
            (
                "# contour 2, closed\n1,2",
                "line 1: this program reads contours of version 1",
            ),
            (
                "# record 1, closed\nstep,t,node,x,y\n",
                "line 1: this is the record of a run",
            ),
        ] {
            let error = Contour::parse(text).unwrap_err();
            assert!(error.starts_with(message), "{text:?}: {error}");
        }
    }

    #[test]
    fn a_message_shows_little_of_a_long_line_and_no_control_letters() {
        let line = format!("1,\u{1b}[31m{}", "x".repeat(100_000));
        let error = Contour::parse(&line).unwrap_err();
        assert!(error.len() < 200 && !error.contains('\u{1b}'), "{error}");
    }

    proptest! {
        #[test]
        fn text_gives_back_the_same_bits(
            points in prop::collection::vec((-1e9..1e9_f64, -1e-3..1e-3_f64), 1..20),
            closed in prop::option::of(any::<bool>()),
        ) {
            let points = points.into_iter().map(|(x, y)| DVec2::new(x, y)).collect();
            let contour = Contour { closed, points };
            prop_assert_eq!(Contour::parse(&contour.to_text()).unwrap(), contour);
        }
    }
}

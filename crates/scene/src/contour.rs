//! Contours as CSV: one `x,y` a line, with the topology in a comment line.
//!
//! ```text
//! # contour 1, closed
//! x,y
//! 12.5,40
//! ```
//!
//! The comment and the heading may be left out; separators may be commas, semicolons, tabs or
//! spaces; further columns are ignored.

use std::path::Path;

use glam::DVec2;

use crate::SceneError;
use crate::write::write_whole;

/// A curve as read from, or written to, a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Contour {
    /// Whether the last point joins the first, if the file says so.
    pub closed: Option<bool>,
    /// The points, in order. Pixels.
    pub points: Vec<DVec2>,
}

/// Points a contour file may have.
const MOST_POINTS: usize = 10_000_000;

impl Contour {
    /// Read a contour file.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, or a line that is not two finite numbers (by its number).
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let bytes = std::fs::read(path).map_err(|error| SceneError::file(path, error))?;
        let text = String::from_utf8(bytes)
            .map_err(|_| SceneError::file(path, "not text; a CSV of x,y would do"))?;
        Self::parse(&text).map_err(|message| SceneError::file(path, message))
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
        let mut heading = false;
        for (number, line) in text
            .lines()
            .enumerate()
            .map(|(i, line)| (i + 1, line.trim()))
        {
            if let Some(comment) = line.strip_prefix('#') {
                match comment
                    .split(|c: char| !c.is_alphanumeric())
                    .find(|w| matches!(*w, "closed" | "open"))
                {
                    Some(word) => contour.closed = Some(word == "closed"),
                    None => continue,
                }
                continue;
            }
            if line.is_empty() {
                continue;
            }
            let mut numbers = line
                .split(|c: char| c == ',' || c == ';' || c.is_whitespace())
                .filter(|word| !word.is_empty());
            let (x, y) = (numbers.next().unwrap_or(""), numbers.next().unwrap_or(""));
            match (x.parse::<f64>(), y.parse::<f64>()) {
                (Ok(x), Ok(y)) if x.is_finite() && y.is_finite() => {
                    contour.points.push(DVec2::new(x, y));
                }
                (Ok(_), Ok(_)) => {
                    return Err(format!(
                        "line {number}: \"{line}\" is no place; finite numbers would do"
                    ));
                }
                // one heading is fine, before any point
                _ if contour.points.is_empty() && !heading => heading = true,
                _ => {
                    return Err(format!(
                        "line {number}: expected two numbers x,y, got \"{line}\""
                    ));
                }
            }
            if contour.points.len() > MOST_POINTS {
                return Err(format!("more than {MOST_POINTS} points"));
            }
        }
        if contour.points.is_empty() {
            return Err("no points; lines of x,y would do".to_owned());
        }
        Ok(contour)
    }

    /// The contour as text: what [`Contour::parse`] reads back exactly.
    #[must_use]
    pub fn to_text(&self) -> String {
        use std::fmt::Write as _;
        let mut text = String::from("# contour 1");
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
            "# a drawing\n1;2.5;9\n\n-3;4;9\n",
        ] {
            assert_eq!(Contour::parse(text).unwrap().points, expected, "{text:?}");
        }
        assert_eq!(
            Contour::parse("# contour 1, open\n1,2").unwrap().closed,
            Some(false)
        );
    }

    #[test]
    fn a_bad_line_is_named() {
        let error = Contour::parse("x,y\n1,2\n3,apple\n").unwrap_err();
        assert_eq!(error, "line 3: expected two numbers x,y, got \"3,apple\"");
        assert!(Contour::parse("1,NaN").unwrap_err().starts_with("line 1:"));
        assert!(
            Contour::parse("x,y\n")
                .unwrap_err()
                .starts_with("no points")
        );
        assert!(
            Contour::parse("x,y\nx,y\n1,2")
                .unwrap_err()
                .starts_with("line 2:")
        );
    }

    proptest! {
        #[test]
        fn text_gives_back_the_same_bits(
            points in prop::collection::vec((-1e9..1e9, -1e-3..1e-3), 1..20),
            closed in prop::option::of(any::<bool>()),
        ) {
            let points = points.into_iter().map(|(x, y)| DVec2::new(x, y)).collect();
            let contour = Contour { closed, points };
            prop_assert_eq!(Contour::parse(&contour.to_text()).unwrap(), contour);
        }
    }
}

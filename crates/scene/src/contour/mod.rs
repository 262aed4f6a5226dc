//! Contours as CSV: one `x,y` a line, with the topology in a comment line.
//!
//! ```text
//! # contour 1, closed
//! x,y
//! 12.5,40
//! ```
//!
//! The comment and the heading may be left out; a heading names the columns, x and y among them in any place;
//! separators may be commas, semicolons, tabs or spaces. Several curves have a column `curve`, or
//! blank lines between them.

mod heading;
mod table;

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec2;
use heading::{Columns, is_heading};
use table::Separator;

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

/// Entries of a heading that are looked at.
const MOST_COLUMNS: usize = 1000;

impl Contour {
    /// Read a contour file, or standard input for `-`.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, or whatever [`Contour::parse`] refuses.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let text = read::text(path, "a CSV of x,y", MOST_CONTOUR_BYTES)?;
        Self::parse(&text).map_err(|message| SceneError::file(&read::called(path), message))
    }

    /// Read a contour from text.
    ///
    /// # Errors
    ///
    /// A message that names the line, and shows nothing of it: no two finite numbers, more entries than the heading has
    /// names, a heading without x or y. A text of more than one curve.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut curves = Self::parse_all(text)?;
        match curves.pop() {
            Some(curve) if curves.is_empty() => Ok(curve),
            _ => Err(format!(
                "holds {} curves; a file of one is needed",
                curves.len() + 1
            )),
        }
    }

    /// Read every curve of a text: told apart by a column `curve` (or `id`, `label`, …) whose values repeat, by blank
    /// lines or by headings between them.
    ///
    /// # Errors
    ///
    /// As [`Contour::parse`], for more than one curve too.
    pub fn parse_all(text: &str) -> Result<Vec<Self>, String> {
        Reader::default().read(text)
    }

    /// The contour as text: what [`Contour::parse`] reads back exactly.
    #[must_use]
    pub fn to_text(&self) -> String {
        Self::all_to_text(std::slice::from_ref(self))
    }

    /// Curves as one text, which [`Contour::parse_all`] reads back exactly. Of more than one, a column `curve` has the
    /// number of each from 1 on, and where not all of them are closed or open, a column `closed` has 1 or 0.
    #[must_use]
    pub fn all_to_text(curves: &[Self]) -> String {
        use std::fmt::Write as _;
        let mut text = format!("# contour {VERSION}");
        let closed = curves.first().and_then(|curve| curve.closed);
        let alike = curves.iter().all(|curve| curve.closed == closed);
        if let (true, Some(closed)) = (alike, closed) {
            text.push_str(if closed { ", closed" } else { ", open" });
        }
        text.push_str("\nx,y");
        if curves.len() > 1 {
            text.push_str(",curve");
        }
        if !alike {
            text.push_str(",closed");
        }
        text.push('\n');
        for (number, curve) in (1..).zip(curves) {
            for p in &curve.points {
                // writing to a String cannot fail
                let _ = write!(text, "{},{}", p.x, p.y);
                if curves.len() > 1 {
                    let _ = write!(text, ",{number}");
                }
                if !alike {
                    let _ = write!(
                        text,
                        ",{}",
                        curve.closed.map_or("", |c| if c { "1" } else { "0" })
                    );
                }
                text.push('\n');
            }
        }
        text
    }

    /// Write a contour file, whole or not at all.
    ///
    /// # Errors
    ///
    /// A folder that is not there or cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), SceneError> {
        Self::save_all(std::slice::from_ref(self), path)
    }

    /// Write curves into one file, whole or not at all.
    ///
    /// # Errors
    ///
    /// As [`Contour::save`].
    pub fn save_all(curves: &[Self], path: &Path) -> Result<(), SceneError> {
        write_whole(path, Self::all_to_text(curves).as_bytes())
    }
}

/// What has been read of a text so far.
#[derive(Default)]
struct Reader {
    closed: Option<bool>,
    columns: Option<Columns>,
    /// Whether a heading has named them.
    headed: bool,
    separator: Option<Separator>,
    points: Vec<DVec2>,
    /// The curve of each point, and whether it is closed, by columns.
    names: Vec<(u64, Option<bool>)>,
    /// Known values of the column of curves.
    known: BTreeMap<String, u64>,
    /// Where blocks begin that stand behind blank lines or headings.
    blocks: Vec<usize>,
    /// Whether the next point begins one.
    fresh: bool,
}

impl Reader {
    fn read(mut self, text: &str) -> Result<Vec<Contour>, String> {
        for (number, line) in (1..).zip(text.lines()) {
            self.line(line)
                .map_err(|what| format!("line {number}: {what}"))?;
            if self.points.len() > MOST_NODES {
                return Err(format!(
                    "holds more than {MOST_NODES} points, which are the most"
                ));
            }
        }
        if self.points.is_empty() {
            return Err("no points; lines of x,y are needed".to_owned());
        }
        Ok(self.curves())
    }

    fn line(&mut self, line: &str) -> Result<(), String> {
        if let Some(comment) = line.trim_start().strip_prefix('#') {
            return self.note(comment);
        }
        if line.trim().is_empty() {
            self.fresh = true;
            return Ok(());
        }
        let separator = self.separator.unwrap_or_else(|| Separator::of(line));
        if self.columns.is_none() || self.fresh {
            let begin = separator.split(line).take(MOST_COLUMNS);
            let words: Vec<String> = begin.map(str::to_owned).collect();
            let numbers = words.iter().any(|word| word.parse::<f64>().is_ok());
            if !numbers && is_heading(&words) && (self.points.is_empty() == self.columns.is_none())
            {
                self.columns = Some(Columns::of(&words)?);
                self.headed = true;
                self.fresh = true;
                return Ok(());
            }
        }
        self.row(separator, line)
    }

    /// A line of numbers.
    fn row(&mut self, separator: Separator, line: &str) -> Result<(), String> {
        let given = self.headed;
        let columns = *self.columns.get_or_insert(Columns::TWO);
        // a heading may be set otherwise than its columns
        let separator = if given && self.separator.is_none() {
            Separator::of(line)
        } else {
            separator
        };
        self.separator = Some(separator);
        let (mut x, mut y, mut curve, mut closed) = (None, None, None, None);
        let mut count = 0;
        for entry in separator.split(line) {
            let number = || entry.parse::<f64>().ok();
            if count == columns.x {
                x = number();
            } else if count == columns.y {
                y = number();
            } else if Some(count) == columns.curve {
                curve = Some(entry);
            } else if Some(count) == columns.closed {
                closed = number().map(|value| value > 0.0);
            }
            count += 1;
            // one separator may end a line
            if count > columns.count && !(entry.is_empty() && count == columns.count + 1) {
                return Err(if given {
                    format!("more entries than the {} of the heading", columns.count)
                } else {
                    "more than two entries; a heading that names x and y is needed".to_owned()
                });
            }
        }
        let (Some(x), Some(y)) = (x, y) else {
            return Err("two numbers x,y are needed".to_owned());
        };
        if !(x.abs() <= FARTHEST && y.abs() <= FARTHEST) {
            return Err(format!(
                "numbers must be from -{FARTHEST:e} to {FARTHEST:e}"
            ));
        }
        if self.fresh && !self.points.is_empty() {
            self.blocks.push(self.points.len());
        }
        self.fresh = false;
        self.points.push(DVec2::new(x, y));
        let name = curve.map_or(0, |name| match self.known.get(name) {
            Some(&number) => number,
            None => {
                let number = self.known.len() as u64;
                self.known.insert(name.to_owned(), number);
                number
            }
        });
        self.names.push((name, closed));
        Ok(())
    }

    /// Take in a comment line: `contour 1, closed` says something, any other is for people.
    fn note(&mut self, comment: &str) -> Result<(), String> {
        let mut words = comment.split_whitespace();
        let kind = words.next().unwrap_or("");
        let Some(version) = words.next() else {
            return Ok(());
        };
        let number = version.strip_suffix(',').unwrap_or(version);
        let rest: Vec<&str> = words.collect();
        let known = ["closed", "open"];
        let ours = !number.is_empty()
            && number.bytes().all(|byte| byte.is_ascii_digit())
            && (version.ends_with(',') || rest.first().is_none_or(|word| known.contains(word)));
        match kind {
            "record" if ours => Err("this is the record of a run; a contour is needed".to_owned()),
            "contour" if ours => {
                if number != VERSION {
                    return Err("this program reads contours of version 1".to_owned());
                }
                let word = rest.iter().map(|word| word.trim_end_matches(','));
                let word = word.into_iter().find(|word| known.contains(word));
                self.closed = word.map(|word| word == "closed");
                // it may stand before every curve
                self.fresh = true;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// The curves that the points make.
    fn curves(self) -> Vec<Contour> {
        let n = self.points.len();
        let curve = |points, closed: Option<bool>| Contour {
            closed: closed.or(self.closed),
            points,
        };
        // a column that never says the same twice counts points
        if (2..n).contains(&self.known.len()) {
            let mut curves: Vec<Contour> = Vec::new();
            let mut at = BTreeMap::new();
            for (&p, &(name, closed)) in self.points.iter().zip(&self.names) {
                let i = *at.entry(name).or_insert_with(|| {
                    curves.push(curve(Vec::new(), closed));
                    curves.len() - 1
                });
                curves[i].points.push(p);
            }
            return curves;
        }
        let closed = self.names.first().and_then(|(_, closed)| *closed);
        // a text of which every second line is blank is one curve all the same
        if self.blocks.is_empty() || self.blocks.len() + 1 == n {
            return vec![curve(self.points, closed)];
        }
        let mut rest = &self.points[..];
        let mut curves = Vec::new();
        let ends = self.blocks.iter().chain(std::iter::once(&n));
        let mut begin = 0;
        for &end in ends {
            let (block, after) = rest.split_at(end - begin);
            curves.push(curve(block.to_vec(), closed));
            (rest, begin) = (after, end);
        }
        curves
    }
}

#[cfg(test)]
mod tests;

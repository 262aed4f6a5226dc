//! Outlines as a table: one `x,y` a line, with the topology in a comment line.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::DVec2;

use super::budget::point;
use super::format::{Column, Origin, Reading};
use super::geojson::shift;
use super::heading::{Columns, is_heading};
use super::line::Separator;
use super::{FRAME, NodeColumn, Shape, Shapes, Value};
use crate::IoError;
use crate::limits::MOST_NODES;

/// The version of the format.
const VERSION: &str = "1";

/// Entries of a heading that are looked at.
const MOST_COLUMNS: usize = 1000;

/// What is asked of the reader of a table.
#[derive(Debug, Clone, Default)]
pub(super) struct TableRule {
    /// The columns of x and y, if the heading is not to say so.
    columns: Option<(Column, Column)>,
    /// What to add to each point.
    shift: DVec2,
    /// Whether each point is an outline.
    points: bool,
}

impl TableRule {
    pub(super) fn of(reading: &Reading) -> Result<Self, IoError> {
        let columns = reading.columns.clone();
        let wrong = |column: &Column| matches!(column, Column::Number(number) if !(1..=MOST_COLUMNS).contains(number));
        if let Some((x, y)) = &columns
            && (wrong(x) || wrong(y))
        {
            let message = format!("columns are numbered from 1, up to {MOST_COLUMNS}");
            return Err(IoError::text(None, message));
        }
        Ok(Self {
            columns,
            shift: shift(reading.origin.unwrap_or(Origin::Center)),
            points: reading.points,
        })
    }
}

pub(super) fn parse(text: &str) -> Result<Shapes, IoError> {
    Reader::default().read(text)
}

pub(super) fn parse_with(text: &str, rule: &TableRule) -> Result<Shapes, IoError> {
    let reader = Reader {
        rule: rule.clone(),
        ..Reader::default()
    };
    reader.read(text)
}

pub(super) fn to_text(shapes: &[Shape], more: &[NodeColumn<'_>]) -> String {
    let mut text = format!("# contour {VERSION}");
    let closed = shapes.first().and_then(|shape| shape.closed);
    let alike = shapes.iter().all(|shape| shape.closed == closed);
    if let (true, Some(closed)) = (alike, closed) {
        text.push_str(if closed { ", closed" } else { ", open" });
    }
    text.push_str("\nx,y");
    let several = shapes.len() > 1;
    let rings = shapes.iter().any(|shape| shape.rings.len() > 1);
    for (column, given) in [(",curve", several), (",closed", !alike), (",ring", rings)] {
        if given {
            text.push_str(column);
        }
    }
    for column in more {
        text.push(',');
        text.push_str(column.name);
    }
    text.push('\n');
    let names = names(shapes);
    for (number, (shape, name)) in shapes.iter().zip(&names).enumerate() {
        let closed = shape.closed.map_or("", |c| if c { "1" } else { "0" });
        for (ring, points) in shape.rings.iter().enumerate() {
            for (node, p) in points.iter().enumerate() {
                // writing to a String cannot fail
                let _ = write!(text, "{},{}", p.x, p.y);
                if several {
                    let _ = write!(text, ",{name}");
                }
                if !alike {
                    let _ = write!(text, ",{closed}");
                }
                if rings {
                    let _ = write!(text, ",{ring}");
                }
                for column in more {
                    let values = column.values.get(number).filter(|_| ring == 0);
                    text.push(',');
                    if let Some(value) = values.and_then(|values| *values.get(node)?) {
                        let _ = write!(text, "{value}");
                    }
                }
                text.push('\n');
            }
        }
    }
    text
}

/// What tells the shapes apart: their names, if each has one of its own that a table can hold, else
/// their numbers.
fn names(shapes: &[Shape]) -> Vec<String> {
    let plain = |name: &&str| {
        let letter = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
        !name.is_empty() && name.chars().all(letter)
    };
    let given = shapes.iter().map(|shape| shape.id.as_deref().filter(plain));
    let given: Option<Vec<&str>> = given.collect();
    if let Some(given) = given {
        let mut different = given.clone();
        different.sort_unstable();
        different.dedup();
        if different.len() == given.len() {
            return given.into_iter().map(str::to_owned).collect();
        }
    }
    (1..=shapes.len())
        .map(|number| number.to_string())
        .collect()
}

/// What has been read of a text so far.
#[derive(Default)]
struct Reader {
    rule: TableRule,
    closed: Option<bool>,
    columns: Option<Columns>,
    /// Whether a heading has named them.
    headed: bool,
    separator: Option<Separator>,
    points: Vec<DVec2>,
    /// What the columns say of each point.
    marks: Vec<Mark>,
    /// Known values of the column of curves, and those of the column of rings.
    curves: Names,
    rings: Names,
    /// Where blocks begin that stand behind blank lines or headings.
    blocks: Vec<usize>,
    /// Whether the next point begins one.
    fresh: bool,
}

/// What the columns of a table say of a point.
#[derive(Clone, Copy)]
struct Mark {
    /// The number of its curve.
    curve: usize,
    /// Whether that curve is closed.
    closed: Option<bool>,
    /// The number of its ring.
    ring: usize,
}

/// The values of columns, numbered as they come.
#[derive(Default)]
struct Names(BTreeMap<Name, usize>);

/// What tells a curve, or a ring, from others: the entry of its column, and that of the column of frames.
type Name = (Option<String>, Option<String>);

impl Names {
    /// The number of values; None stands for a column that is not there.
    fn number(&mut self, (name, frame): (Option<&str>, Option<&str>)) -> usize {
        let name = (name.map(str::to_owned), frame.map(str::to_owned));
        let number = self.0.len();
        *self.0.entry(name).or_insert(number)
    }
}

impl Reader {
    fn read(mut self, text: &str) -> Result<Shapes, IoError> {
        for (number, line) in (1..).zip(text.lines()) {
            let read = self.line(line);
            read.map_err(|what| IoError::text(Some(number), what))?;
            if self.points.len() > MOST_NODES {
                let message = format!("holds more than {MOST_NODES} points, which are the most");
                return Err(IoError::text(None, message));
            }
        }
        if self.points.is_empty() {
            return Err(IoError::text(None, "no points; lines of x,y are needed"));
        }
        Ok(self.shapes())
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
            let numbers = words.iter().any(|word| separator.number(word).is_some());
            if !numbers && is_heading(&words) && (self.points.is_empty() == self.columns.is_none())
            {
                self.columns = Some(match &self.rule.columns {
                    Some(given) => Columns::given(&words, given)?,
                    None => Columns::of(&words)?,
                });
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
        if self.columns.is_none()
            && let Some(given) = &self.rule.columns
        {
            let count = separator.split(line).take(MOST_COLUMNS).count();
            self.columns = Some(Columns::numbered(given, count)?);
        }
        let columns = *self.columns.get_or_insert(Columns::TWO);
        // a heading may be set otherwise than its columns
        let separator = if given && self.separator.is_none() {
            Separator::of(line)
        } else {
            separator
        };
        self.separator = Some(separator);
        let (mut x, mut y, mut curve, mut closed, mut ring) = (None, None, None, None, None);
        let mut frame = None;
        let mut count = 0;
        for entry in separator.split(line) {
            let number = || separator.number(entry);
            if count == columns.x {
                x = number();
            } else if count == columns.y {
                y = number();
            } else if Some(count) == columns.frame {
                frame = Some(entry);
            } else if Some(count) == columns.curve {
                curve = Some(entry);
            } else if Some(count) == columns.closed {
                closed = number().map(|value| value > 0.0);
            } else if Some(count) == columns.ring {
                ring = Some(entry);
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
        let p = point(x, y)? + self.rule.shift;
        if self.fresh && !self.points.is_empty() {
            self.blocks.push(self.points.len());
        }
        self.fresh = false;
        self.points.push(p);
        self.marks.push(Mark {
            curve: self.curves.number((curve, frame)),
            closed,
            ring: self.rings.number((ring, None)),
        });
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

    /// The shapes that the points make.
    fn shapes(self) -> Shapes {
        if self.rule.points {
            let shape = |p| Shape::curve(vec![p], None);
            return self.points.into_iter().map(shape).collect();
        }
        let n = self.points.len();
        // a column that never says the same twice counts points
        let by_column = (2..n).contains(&self.curves.0.len());
        // a text of which every second line is blank is one curve all the same
        let by_blocks = !self.blocks.is_empty() && self.blocks.len() + 1 != n;
        let first = self.marks.first().and_then(|mark| mark.closed);
        let mut shapes: Shapes = Vec::new();
        let mut places: BTreeMap<usize, usize> = BTreeMap::new();
        let mut rings: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for (i, (&p, mark)) in self.points.iter().zip(&self.marks).enumerate() {
            let group = match (by_column, by_blocks) {
                (true, _) => mark.curve,
                (false, true) => self.blocks.partition_point(|&begin| begin <= i),
                (false, false) => 0,
            };
            let at = *places.entry(group).or_insert_with(|| {
                let closed = if by_column { mark.closed } else { first };
                shapes.push(Shape {
                    closed: closed.or(self.closed),
                    ..Shape::default()
                });
                shapes.len() - 1
            });
            let own = &mut shapes[at].rings;
            let ring = *rings.entry((at, mark.ring)).or_insert_with(|| {
                own.push(Vec::new());
                own.len() - 1
            });
            own[ring].push(p);
        }
        if by_column {
            for ((name, frame), number) in self.curves.0 {
                if let Some(shape) = places.get(&number).and_then(|&at| shapes.get_mut(at)) {
                    let count = frame.as_ref().and_then(|frame| frame.parse::<u32>().ok());
                    if let Some(count) = count {
                        let value = Value::Number(f64::from(count));
                        shape.properties.insert(FRAME.to_owned(), value);
                    }
                    shape.id = name.or(frame);
                }
            }
        }
        shapes
    }
}

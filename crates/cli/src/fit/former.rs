//! What a former run has left: the rows of its table, and how many of its results are marked unsure.

use std::collections::BTreeMap;
use std::path::Path;

use io::shapes::{self, Format, Reading, Value};
use scene::SceneError;

use super::flags::Flags;
use super::measures::{OUTCOME, UNSURE, headings};
use super::results::Wanted;
use crate::commands::key;

/// Bytes of a table: more than a row for each pixel of a large picture.
const MOST_TABLE: u64 = 1 << 32;

/// The table of a former run, by picture.
#[derive(Debug, Default)]
pub(super) struct Former(BTreeMap<String, Rows>);

/// The rows of a picture.
#[derive(Debug, Default)]
struct Rows {
    /// Which picture of the table it is.
    place: usize,
    text: String,
    unsure: usize,
}

impl Former {
    /// What is to be gone on with; nothing if that is not asked for, or no table is there.
    pub(super) fn of(flags: &Flags) -> Result<Self, SceneError> {
        let Some(path) = flags.measure.as_ref().filter(|_| flags.resume) else {
            return Ok(Self::default());
        };
        if io::is_standard(path) {
            let message = "is standard output, and --resume goes on with a table; needed: a file";
            return Err(key("--measure", message));
        }
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = io::read_text(path, "a table of measures", MOST_TABLE)?;
        Self::read(&text).map_err(|problem| {
            let message = format!(
                "--resume goes on with the table in {}, which {problem}; needed: another name, or a run without --resume",
                path.display()
            );
            key("--measure", message)
        })
    }

    fn read(text: &str) -> Result<Self, String> {
        let mut records = records(text);
        let headings = headings();
        let first = records.next().map(|(_, fields)| fields.join(","));
        if first.as_deref() != Some(&*headings) {
            return Err("has other columns than this version writes".to_owned());
        }
        let mut pictures: BTreeMap<String, Rows> = BTreeMap::new();
        for (text, mut fields) in records {
            if fields.len() != headings.split(',').count() {
                return Err(format!("has a row of {} fields", fields.len()));
            }
            let unsure = usize::from(fields[OUTCOME] == UNSURE);
            let place = pictures.len();
            let rows = pictures.entry(fields.swap_remove(0)).or_insert(Rows {
                place,
                ..Rows::default()
            });
            rows.text.push_str(text.trim_end_matches(['\r', '\n']));
            rows.text.push('\n');
            rows.unsure += unsure;
        }
        Ok(Self(pictures))
    }

    /// The rows of a picture, and how many of them are unsure.
    pub(super) fn rows(&self, picture: &str) -> Option<(&str, usize)> {
        let rows = self.0.get(picture)?;
        Some((&rows.text, rows.unsure))
    }

    /// The rows of all pictures but those of this run.
    pub(super) fn others<'a>(&self, own: impl Iterator<Item = &'a str>) -> String {
        let own: std::collections::BTreeSet<&str> = own.collect();
        let others = self
            .0
            .iter()
            .filter(|(name, _)| !own.contains(name.as_str()));
        let mut others: Vec<&Rows> = others.map(|(_, rows)| rows).collect();
        others.sort_by_key(|rows| rows.place);
        others.iter().map(|rows| rows.text.as_str()).collect()
    }
}

/// The records of a table, each as it stands there and as its fields; a quoted field may go over several lines.
fn records(text: &str) -> impl Iterator<Item = (&str, Vec<String>)> {
    let mut quoted = false;
    let ends = text.split_inclusive(move |c| {
        quoted ^= c == '"';
        c == '\n' && !quoted
    });
    ends.map(|record| (record, fields(record.trim_end_matches(['\r', '\n']))))
        .filter(|(_, fields)| fields.iter().any(|field| !field.is_empty()))
}

fn fields(record: &str) -> Vec<String> {
    let mut quoted = false;
    let entries = record.split(move |c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    });
    let plain = |entry: &str| {
        let inner = entry
            .strip_prefix('"')
            .and_then(|entry| entry.strip_suffix('"'));
        inner.map_or_else(|| entry.to_owned(), |inner| inner.replace("\"\"", "\""))
    };
    entries.map(plain).collect()
}

/// How many outlines of a result are marked unsure; 0 where its format has no mark.
pub(super) fn unsure(wanted: &Wanted) -> usize {
    let Wanted::Outlines(format, path) = wanted else {
        return 0;
    };
    match format {
        Format::Csv => marked(path),
        Format::GeoJson | Format::Coco | Format::Labelme | Format::ImageJ | Format::Roi => {
            let reading = Reading {
                format: Some(*format),
                ..Reading::default()
            };
            let shapes = shapes::load_with(path, &reading).unwrap_or_default();
            let is = |shape: &&shapes::Shape| {
                let word = Value::Text(UNSURE.to_owned());
                shape.properties.get("outcome") == Some(&word)
            };
            shapes.iter().filter(is).count()
        }
        _ => 0,
    }
}

/// The comments of a table of outlines that say why one is unsure.
fn marked(path: &Path) -> usize {
    let text = io::read_text(path, "a CSV of x,y", MOST_TABLE).unwrap_or_default();
    let comments = text.lines().take_while(|line| line.starts_with('#'));
    let is = |line: &&str| {
        let rest = line.strip_prefix("# outline ");
        rest.is_some_and(|rest| {
            rest.split_once(": ")
                .is_some_and(|(number, _)| number.parse::<u64>().is_ok())
        })
    };
    comments.filter(is).count()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
mod tests {
    use super::*;

    #[test]
    fn rows_are_kept_as_they_stand_with_whatever_names_pictures_have() {
        let headings = headings();
        let row = |start: &str, outcome: &str| {
            let rest = ",1".repeat(headings.split(',').count() - 4);
            format!("{start},1,,{outcome}{rest}\n")
        };
        let odd = row("\"a,\n\"\"b\"\".png\"", "unsure");
        let text = [
            format!("{headings}\n"),
            row("z.png", "found"),
            odd.clone(),
            row("z.png", "unsure"),
        ];
        let former = Former::read(&text.concat()).unwrap();
        assert_eq!(former.rows("a,\n\"b\".png"), Some((odd.as_str(), 1)));
        let both = [&text[1][..], &text[3]].concat();
        assert_eq!(former.rows("z.png"), Some((both.as_str(), 1)));
        assert_eq!(former.others(std::iter::empty()), both.clone() + &odd);
        assert_eq!(former.others(["a,\n\"b\".png"].into_iter()), both);
        assert!(former.rows("b.png").is_none());
        assert!(Former::read("picture,area\n").is_err() && Former::read("").is_err());
        assert!(Former::read(&format!("{headings}\na.png,1\n")).is_err());
    }
}

//! The numbers under each figure, kept in `sandbox/expected/`, and whether they moved.

use crate::record::shortest;
use crate::{Experiment, Folder, Record, SandboxError, Tolerance};
use std::path::PathBuf;

/// A number that is not what it was.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Moved {
    /// The file in `expected/`.
    pub file: String,
    /// Where in it, what was expected and what came.
    pub what: String,
}

impl std::fmt::Display for Moved {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "expected/{}: {}", self.file, self.what)
    }
}

/// The folder of expected numbers in the source tree this program was built from.
#[must_use]
pub fn expected_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("expected")
}

/// The files a record should leave in `expected/`, by name.
fn files(experiment: &Experiment, record: &Record) -> Vec<(String, String)> {
    let mut out = vec![(format!("{}.csv", experiment.id), record.numbers_csv())];
    for table in record.tables.iter().filter(|table| table.compared) {
        out.push((format!("{}.{}.csv", experiment.id, table.name), table.csv()));
    }
    out
}

/// The files that belong to an experiment now.
fn present(experiment: &Experiment) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(expected_folder())
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| name.split('.').next() == Some(experiment.id))
        .collect();
    names.sort();
    names
}

/// Rewrites what is expected of an experiment with what was found.
///
/// # Errors
///
/// When the folder or a file in it cannot be written.
pub fn accept(experiment: &Experiment, record: &Record) -> Result<(), SandboxError> {
    let folder = Folder::open(&expected_folder())?;
    let files = files(experiment, record);
    for stale in present(experiment) {
        if !files.iter().any(|(name, _)| *name == stale) {
            folder.remove(&stale)?;
        }
    }
    for (name, text) in files {
        folder.write(&name, text.as_bytes())?;
    }
    Ok(())
}

/// Every number of a record that is not what it was, each measured by its own tolerance.
#[must_use]
pub fn compare(experiment: &Experiment, record: &Record) -> Vec<Moved> {
    let mut moved = Vec::new();
    let files = files(experiment, record);
    for (name, _) in &files {
        let path = expected_folder().join(name);
        match std::fs::read_to_string(&path) {
            Err(reason) => moved.push(Moved {
                file: name.clone(),
                what: reason.to_string(),
            }),
            Ok(text) => {
                let table = record
                    .tables
                    .iter()
                    .find(|table| format!("{}.{}.csv", experiment.id, table.name) == *name);
                let differences = match table {
                    Some(table) => {
                        let columns: Vec<(&[f64], Tolerance)> = table
                            .columns
                            .iter()
                            .map(|column| (column.values.as_slice(), column.tolerance))
                            .collect();
                        compare_table(&table.csv(), &text, &columns)
                    }
                    None => compare_numbers(record, &text),
                };
                let file = name.clone();
                moved.extend(differences.into_iter().map(|what| Moved {
                    file: file.clone(),
                    what,
                }));
            }
        }
    }
    for stale in present(experiment) {
        if !files.iter().any(|(name, _)| *name == stale) {
            moved.push(Moved {
                file: stale,
                what: "is not computed any more".to_owned(),
            });
        }
    }
    moved
}

fn compare_numbers(record: &Record, text: &str) -> Vec<String> {
    // name, value, unit, tolerance: from the right, since only a name may have commas in it
    let rows: Vec<Vec<&str>> = text
        .lines()
        .skip(1)
        .map(|line| line.rsplitn(4, ',').collect::<Vec<_>>())
        .map(|mut row| {
            row.reverse();
            if let Some(name) = row.first_mut() {
                *name = name.trim_matches('"');
            }
            row
        })
        .collect();
    let mut out = Vec::new();
    for number in &record.numbers {
        let row = rows
            .iter()
            .find(|row| row.first() == Some(&number.name.as_str()));
        match row
            .and_then(|row| row.get(1))
            .and_then(|cell| cell.parse::<f64>().ok())
        {
            None => out.push(format!("{}: new", number.name)),
            Some(expected) if !number.tolerance.allows(number.value, expected) => {
                out.push(differs(
                    &number.name,
                    number.value,
                    expected,
                    number.tolerance,
                ));
            }
            Some(_) => {}
        }
    }
    for name in rows.iter().filter_map(|row| row.first()) {
        if !record.numbers.iter().any(|number| number.name == *name) {
            out.push(format!("{name}: gone"));
        }
    }
    out
}

fn compare_table(now: &str, text: &str, columns: &[(&[f64], Tolerance)]) -> Vec<String> {
    let heads = now.lines().next().unwrap_or_default();
    if text.lines().next() != Some(heads) {
        return vec!["has other columns".to_owned()];
    }
    if now.lines().count() != text.lines().count() {
        let (now, was) = (
            now.lines().count() - 1,
            text.lines().count().saturating_sub(1),
        );
        return vec![format!("has {now} rows, expected {was}")];
    }
    let mut out = Vec::new();
    for (index, ((values, tolerance), head)) in columns.iter().zip(heads.split(',')).enumerate() {
        for (row, (&value, line)) in values.iter().zip(text.lines().skip(1)).enumerate() {
            let cell = line.split(',').nth(index).unwrap_or_default();
            match cell.parse::<f64>() {
                Ok(expected) if tolerance.allows(value, expected) => {}
                Ok(expected) => {
                    let place = format!("row {} of {head}", row + 1);
                    out.push(differs(&place, value, expected, *tolerance));
                    break; // one of a column tells enough
                }
                Err(_) => {
                    out.push(format!("row {} of {head}: {cell:?} is no number", row + 1));
                    break;
                }
            }
        }
    }
    out
}

fn differs(place: &str, value: f64, expected: f64, tolerance: Tolerance) -> String {
    let (value, expected) = (shortest(value), shortest(expected));
    format!("{place}: {value}, expected {expected} (tolerance {tolerance})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Table;

    fn check(values: &[f64], text: &str) -> Vec<String> {
        let table = Table::new("t").with("x", "px", Tolerance::Absolute(0.5), values.to_vec());
        compare_table(&table.csv(), text, &[(values, Tolerance::Absolute(0.5))])
    }

    #[test]
    fn a_table_within_its_tolerance_has_not_moved() {
        assert!(check(&[1.0, 2.0], "x [px]\n1.4\n1.6\n").is_empty());
    }

    #[test]
    fn a_value_beyond_its_tolerance_is_named_with_its_row() {
        let moved = check(&[1.0, 2.0], "x [px]\n1\n2.75\n");
        assert_eq!(moved, ["row 2 of x [px]: 2, expected 2.75 (tolerance 0.5)"]);
    }

    #[test]
    fn other_columns_and_other_lengths_are_moves() {
        assert_eq!(check(&[1.0], "y [px]\n1\n"), ["has other columns"]);
        assert_eq!(check(&[1.0], "x [px]\n1\n2\n"), ["has 1 rows, expected 2"]);
        assert_eq!(
            check(&[1.0], "x [px]\none\n"),
            ["row 1 of x [px]: \"one\" is no number"]
        );
    }

    #[test]
    fn names_with_commas_are_quoted_and_found_again() {
        let mut record = Record::default();
        record.note("rope, snake: period", 8.0, "s", Tolerance::Absolute(0.1));
        let text = record.numbers_csv();
        assert!(text.contains("\"rope, snake: period\",8,s,"), "{text}");
        assert!(compare_numbers(&record, &text).is_empty());
    }

    #[test]
    fn numbers_that_come_and_go_are_moves() {
        let mut record = Record::default();
        record.note("a", 1.0, "", Tolerance::EXACT);
        record.note("b", 2.0, "px", Tolerance::Absolute(0.1));
        let text = "quantity,value,unit,tolerance\nb,3,px,0.1\nc,1,,0\n";
        let moved = compare_numbers(&record, text);
        assert_eq!(
            moved,
            ["a: new", "b: 2, expected 3 (tolerance 0.1)", "c: gone"]
        );
    }
}

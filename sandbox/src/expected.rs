//! The numbers under each figure, kept in `sandbox/expected/`, and whether they moved.
//!
//! `ID.csv` has the single numbers with their tolerances, `ID.TABLE.csv` each table that is
//! compared, `ID.tolerances.csv` the tolerances of the columns of these tables. A tolerance of the
//! program that is not the one in the file is a move: nobody widens it unseen.

use crate::record::quoted;
use crate::table::shortest;
use crate::{Column, Experiment, Folder, Record, SandboxError, Table, Tolerance};
use std::path::{Path, PathBuf};

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

/// The tables of a record that are compared.
fn compared(record: &Record) -> impl Iterator<Item = &Table> {
    record.tables.iter().filter(|table| table.compared)
}

/// The files a record should leave in `expected/`, by name.
fn files(id: &str, record: &Record) -> Vec<(String, String)> {
    let mut out = vec![(format!("{id}.csv"), record.numbers_csv())];
    for table in compared(record) {
        out.push((format!("{id}.{}.csv", table.name), table.csv()));
    }
    if out.len() > 1 {
        out.push((format!("{id}.tolerances.csv"), tolerances_csv(record)));
    }
    out
}

/// The tolerance of each column of the compared tables.
fn tolerances_csv(record: &Record) -> String {
    let mut out = String::from("table,column,tolerance\n");
    for table in compared(record) {
        for column in &table.columns {
            let name = quoted(&column.name);
            out.push_str(&format!("{},{name},{}\n", table.name, column.tolerance));
        }
    }
    out
}

/// The files of a folder that belong to an experiment.
fn present(folder: &Path, id: &str) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| name.split('.').next() == Some(id))
        .collect();
    names.sort();
    names
}

/// Rewrites what is expected of an experiment with what was found.
///
/// # Errors
///
/// When the folder or a file in it cannot be written.
pub fn accept(folder: &Path, experiment: &Experiment, record: &Record) -> Result<(), SandboxError> {
    let files = files(experiment.id, record);
    let open = Folder::open(folder)?;
    for stale in present(folder, experiment.id) {
        if !files.iter().any(|(name, _)| *name == stale) {
            open.remove(&stale)?;
        }
    }
    for (name, text) in files {
        open.write(&name, text.as_bytes())?;
    }
    Ok(())
}

/// Everything in a record that is not as the files of `folder` say: numbers measured by their own
/// tolerances, units and tolerances themselves, files that are missing or belong to nothing.
#[must_use]
pub fn compare(folder: &Path, experiment: &Experiment, record: &Record) -> Vec<Moved> {
    let mut moved = Vec::new();
    let files = files(experiment.id, record);
    for (name, now) in &files {
        let differences = match std::fs::read_to_string(folder.join(name)) {
            Err(reason) => vec![reason.to_string()],
            Ok(text) => {
                let middle = name.split('.').nth(1).unwrap_or_default();
                match compared(record).find(|table| table.name == middle) {
                    Some(table) => compare_table(table, &text),
                    None if middle == "tolerances" => compare_lines(now, &text),
                    None => compare_numbers(record, &text),
                }
            }
        };
        moved.extend(differences.into_iter().map(|what| Moved {
            file: name.clone(),
            what,
        }));
    }
    for stale in present(folder, experiment.id) {
        if !files.iter().any(|(name, _)| *name == stale) {
            moved.push(Moved {
                file: stale,
                what: "is not computed any more".to_owned(),
            });
        }
    }
    moved
}

/// One row of the file of single numbers: name, value, unit, tolerance.
fn cells(line: &str) -> Vec<&str> {
    // from the right, since only a name may have commas in it
    let mut row: Vec<&str> = line.rsplitn(4, ',').collect();
    row.reverse();
    if let Some(name) = row.first_mut() {
        *name = name.trim_matches('"');
    }
    row
}

fn compare_numbers(record: &Record, text: &str) -> Vec<String> {
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(cells).collect();
    let mut out = Vec::new();
    for number in &record.numbers {
        let name = &number.name;
        let Some(row) = rows.iter().find(|row| row.first() == Some(&name.as_str())) else {
            out.push(format!("{name}: new"));
            continue;
        };
        let cell = |index: usize| row.get(index).copied().unwrap_or_default();
        match cell(1).parse::<f64>() {
            Err(_) => out.push(format!("{name}: {:?} is no number", cell(1))),
            Ok(expected) if !number.tolerance.allows(number.value, expected) => {
                out.push(differs(name, number.value, expected, number.tolerance));
            }
            Ok(_) => {}
        }
        let tolerance = number.tolerance.to_string();
        for (what, own, file) in [
            ("unit", number.unit.as_str(), cell(2)),
            ("tolerance", tolerance.as_str(), cell(3)),
        ] {
            if own != file {
                out.push(format!("{name}: its {what} is {own:?}, expected {file:?}"));
            }
        }
    }
    for name in rows.iter().filter_map(|row| row.first()) {
        if !record.numbers.iter().any(|number| number.name == *name) {
            out.push(format!("{name}: gone"));
        }
    }
    out
}

fn compare_table(table: &Table, text: &str) -> Vec<String> {
    let now = table.csv();
    let heads = now.lines().next().unwrap_or_default();
    if text.lines().next() != Some(heads) {
        return vec!["has other columns".to_owned()];
    }
    let rows = |text: &str| text.lines().count().saturating_sub(1);
    if rows(&now) != rows(text) {
        return vec![format!("has {} rows, expected {}", rows(&now), rows(text))];
    }
    let columns = table.columns.iter().zip(heads.split(',')).enumerate();
    columns
        .filter_map(|(index, (column, head))| {
            let cells = text
                .lines()
                .skip(1)
                .map(|line| line.split(',').nth(index).unwrap_or_default());
            compare_column(column, cells, head) // one of a column tells enough
        })
        .collect()
}

/// The first cell of a column that is not what it was. A column may be shorter than its table; its
/// further cells are empty.
fn compare_column<'a>(
    column: &Column,
    cells: impl Iterator<Item = &'a str>,
    head: &str,
) -> Option<String> {
    for (row, cell) in cells.enumerate() {
        let place = format!("row {} of {head}", row + 1);
        match (column.values.get(row), cell.parse::<f64>()) {
            (Some(&value), Ok(expected)) if column.tolerance.allows(value, expected) => {}
            (Some(&value), Ok(expected)) => {
                return Some(differs(&place, value, expected, column.tolerance));
            }
            (Some(_), Err(_)) => return Some(format!("{place}: {cell:?} is no number")),
            (None, _) if cell.is_empty() => {}
            (None, _) => return Some(format!("{place}: nothing, expected {cell}")),
        }
    }
    None
}

/// The first line in which two texts differ.
fn compare_lines(now: &str, text: &str) -> Vec<String> {
    if now == text {
        return Vec::new();
    }
    let mut pairs = now.lines().zip(text.lines());
    let first = pairs.find(|(own, file)| own != file);
    vec![first.map_or_else(
        || "has another number of rows".to_owned(),
        |(own, file)| format!("{own:?}, expected {file:?}"),
    )]
}

fn differs(place: &str, value: f64, expected: f64, tolerance: Tolerance) -> String {
    let (value, expected) = (shortest(value), shortest(expected));
    format!("{place}: {value}, expected {expected} (tolerance {tolerance})")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(values: &[f64], text: &str) -> Vec<String> {
        let table = Table::new("t").with("x [px]", 0.5, values.to_vec());
        compare_table(&table, text)
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
        record.note("rope, snake: period [s]", 8.0, 0.1);
        let text = record.numbers_csv();
        assert!(text.contains("\"rope, snake: period\",8,s,"), "{text}");
        assert!(compare_numbers(&record, &text).is_empty());
    }

    #[test]
    fn numbers_that_come_and_go_are_moves() {
        let mut record = Record::default();
        record.note("a", 1.0, 0.0);
        record.note("b [px]", 2.0, 0.1);
        let text = "quantity,value,unit,tolerance\nb,3,px,0.1\nc,1,,0\n";
        let moved = compare_numbers(&record, text);
        assert_eq!(
            moved,
            ["a: new", "b: 2, expected 3 (tolerance 0.1)", "c: gone"]
        );
    }

    #[test]
    fn a_unit_or_a_tolerance_that_is_not_the_files_is_a_move() {
        let mut record = Record::default();
        record.note("a [px]", 1.0, 5.0);
        let of = |text: &str| {
            compare_numbers(&record, &format!("quantity,value,unit,tolerance\n{text}\n"))
        };
        assert!(of("a,1,px,5").is_empty());
        assert_eq!(
            of("a,1,px,1e-14"),
            ["a: its tolerance is \"5\", expected \"1e-14\""]
        );
        assert_eq!(of("a,1,px,5 of it").len(), 1);
        assert_eq!(of("a,1,s,5"), ["a: its unit is \"px\", expected \"s\""]);
    }

    #[test]
    fn what_is_not_finite_and_what_is_blank_is_told() {
        assert_eq!(check(&[f64::NAN], "x [px]\nNaN\n").len(), 1);
        assert_eq!(check(&[f64::INFINITY], "x [px]\ninf\n").len(), 1);
        let table = |short: Vec<f64>| Table::new("t").exact("x", vec![1.0, 2.0]).exact("y", short);
        assert!(compare_table(&table(vec![3.0]), "x,y\n1,3\n2,\n").is_empty());
        assert_eq!(
            compare_table(&table(vec![3.0]), "x,y\n1,3\n2,4\n"),
            ["row 2 of y: nothing, expected 4"]
        );
        assert_eq!(
            compare_table(&table(vec![3.0, 4.0]), "x,y\n1,3\n2,\n"),
            ["row 2 of y: \"\" is no number"]
        );
    }

    #[test]
    fn the_tolerances_of_a_table_have_a_file_of_their_own() {
        let record = |tolerance| {
            let mut record = Record::default();
            record.keep(Table::new("t").with("x [px]", tolerance, vec![1.0]));
            record
        };
        let written = files("id", &record(Tolerance::Absolute(0.5)));
        let names: Vec<&str> = written.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["id.csv", "id.t.csv", "id.tolerances.csv"]);
        assert_eq!(written[2].1, "table,column,tolerance\nt,x,0.5\n");
        let wider = tolerances_csv(&record(Tolerance::Absolute(5.0)));
        assert_eq!(
            compare_lines(&wider, &written[2].1),
            ["\"t,x,5\", expected \"t,x,0.5\""]
        );
    }
}

//! What a run leaves behind: single numbers, tables, grids, runs. All that a claim or a drawing
//! needs.

use crate::run::Run;
use crate::table::{name_and_unit, shortest};
use crate::tolerance::EXACT;
use crate::{SandboxError, Table, Tolerance};
use glam::DVec2;
use ndarray::Array2;
use std::cell::RefCell;
use std::fmt::Write;

/// One result with its name and unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// What it is, in a few words.
    pub name: String,
    /// How much.
    pub value: f64,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// How far it may move.
    pub tolerance: Tolerance,
}

/// What a judge asked a record for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Read {
    /// A single number, by its name.
    Number(String),
    /// A column, by the names of its table and its own.
    Column(String, String),
}

impl std::fmt::Display for Read {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(name) => write!(f, "{name}"),
            Self::Column(table, column) => write!(f, "column {column} of {table}"),
        }
    }
}

/// What a run leaves behind.
#[derive(Debug, Clone, Default)]
pub struct Record {
    /// Single results, in the order they were found.
    pub numbers: Vec<Number>,
    /// Tables, in the order they were made.
    pub tables: Vec<Table>,
    /// Grids for drawing: pictures and fields.
    pub grids: Vec<(String, Array2<f64>)>,
    /// Runs for drawing: curves and energies.
    pub runs: Vec<(String, Run)>,
    /// What was asked of it since [`Record::read_by`] began to listen.
    reads: RefCell<Vec<Read>>,
}

/// Notes of one of several cases.
#[derive(Debug)]
pub struct Notes<'a> {
    record: &'a mut Record,
    case: String,
}

impl Notes<'_> {
    /// As [`Record::note`], of this case.
    pub fn note(&mut self, name: &str, value: f64, tolerance: impl Into<Tolerance>) {
        let name = format!("{}: {name}", self.case);
        self.record.note(name, value, tolerance);
    }
}

impl Record {
    /// What `reader` asks this record for, each once, besides its answer. What is only shown
    /// ([`Record::told`]) does not count.
    pub fn read_by<T>(&self, reader: impl FnOnce(&Self) -> T) -> (T, Vec<Read>) {
        self.reads.borrow_mut().clear();
        let answer = reader(self);
        let mut reads = Vec::new();
        for read in self.reads.take() {
            if !reads.contains(&read) {
                reads.push(read);
            }
        }
        (answer, reads)
    }

    /// Notes a number. Its unit stands in brackets behind its name: `"way [px]"`.
    pub fn note(&mut self, name: impl Into<String>, value: f64, tolerance: impl Into<Tolerance>) {
        let (name, unit) = name_and_unit(name.into());
        self.numbers.push(Number {
            name,
            value,
            unit,
            tolerance: tolerance.into(),
        });
    }

    /// Notes of one of several cases: each name behind that of the case and a colon.
    pub fn under(&mut self, case: impl std::fmt::Display) -> Notes<'_> {
        let case = case.to_string();
        Notes { record: self, case }
    }

    /// Keeps a table.
    pub fn keep(&mut self, table: Table) {
        self.tables.push(table);
    }

    /// Keeps a grid.
    pub fn keep_grid(&mut self, name: impl Into<String>, grid: Array2<f64>) {
        self.grids.push((name.into(), grid));
    }

    /// Keeps points as a table that is not compared.
    pub fn keep_points(&mut self, name: &'static str, points: &[DVec2]) {
        self.keep(Table::raw(name).xy("px", EXACT, points));
    }

    /// Keeps a run.
    pub fn keep_run(&mut self, name: impl Into<String>, run: impl Into<Run>) {
        self.runs.push((name.into(), run.into()));
    }

    /// A number to judge by.
    ///
    /// # Errors
    ///
    /// When it was not noted, or is not a number (NaN): no verdict follows from that.
    pub fn number(&self, name: &str) -> Result<f64, SandboxError> {
        self.reads.borrow_mut().push(Read::Number(name.to_owned()));
        let value = self.told(name)?;
        if value.is_nan() {
            return Err(missing("value (it is NaN) of the number", name));
        }
        Ok(value)
    }

    /// A number that is only shown: no verdict depends on it.
    ///
    /// # Errors
    ///
    /// When it was not noted.
    pub fn told(&self, name: &str) -> Result<f64, SandboxError> {
        let found = self.numbers.iter().find(|number| number.name == name);
        found
            .map(|number| number.value)
            .ok_or_else(|| missing("number", name))
    }

    /// A column to judge by, by the names of its table and its own.
    ///
    /// # Errors
    ///
    /// When there is no such table, or no such column in it.
    pub fn column(&self, table: &str, column: &str) -> Result<&[f64], SandboxError> {
        let read = Read::Column(table.to_owned(), column.to_owned());
        self.reads.borrow_mut().push(read);
        self.told_column(table, column)
    }

    /// A column that is only shown or looked up in: no verdict depends on it.
    ///
    /// # Errors
    ///
    /// As [`Record::column`].
    pub fn told_column(&self, table: &str, column: &str) -> Result<&[f64], SandboxError> {
        let table = self
            .tables
            .iter()
            .find(|kept| kept.name == table)
            .ok_or_else(|| missing("table", table))?;
        let found = table.columns.iter().find(|kept| kept.name == column);
        found
            .map(|kept| kept.values.as_slice())
            .ok_or_else(|| missing("column", column))
    }

    /// Two columns of a table as points.
    ///
    /// # Errors
    ///
    /// As [`Record::column`].
    pub fn points(&self, table: &str, x: &str, y: &str) -> Result<Vec<(f64, f64)>, SandboxError> {
        let (x, y) = (self.column(table, x)?, self.column(table, y)?);
        Ok(x.iter().copied().zip(y.iter().copied()).collect())
    }

    /// The columns x and y of a table as points.
    ///
    /// # Errors
    ///
    /// As [`Record::column`].
    pub fn xy(&self, table: &str) -> Result<Vec<(f64, f64)>, SandboxError> {
        self.points(table, "x", "y")
    }

    /// A run by its name.
    ///
    /// # Errors
    ///
    /// When it was not kept.
    pub fn run(&self, name: &str) -> Result<&Run, SandboxError> {
        let found = self.runs.iter().find(|(kept, _)| kept == name);
        found
            .map(|(_, run)| run)
            .ok_or_else(|| missing("run", name))
    }

    /// A grid by its name.
    ///
    /// # Errors
    ///
    /// When it was not kept.
    pub fn grid(&self, name: &str) -> Result<&Array2<f64>, SandboxError> {
        let found = self.grids.iter().find(|(kept, _)| kept == name);
        found
            .map(|(_, grid)| grid)
            .ok_or_else(|| missing("grid", name))
    }

    /// All of it but the grids as files of an experiment: name and text.
    #[must_use]
    pub fn files(&self, id: &str) -> Vec<(String, String)> {
        let numbers = (format!("{id}.csv"), self.numbers_csv());
        let slug = |name: &str| name.replace(|c: char| !c.is_ascii_alphanumeric() && c != '-', "-");
        let tables = self.tables.iter();
        let tables = tables.map(|table| (format!("{id}.{}.csv", slug(table.name)), table.csv()));
        let runs = self.runs.iter();
        let runs = runs.map(|(name, run)| (format!("{id}.{}.run.csv", slug(name)), run.csv()));
        std::iter::once(numbers).chain(tables).chain(runs).collect()
    }

    /// The single numbers as CSV with their tolerances.
    #[must_use]
    pub fn numbers_csv(&self) -> String {
        let mut out = String::from("quantity,value,unit,tolerance\n");
        for number in &self.numbers {
            let value = shortest(number.value);
            let name = quoted(&number.name);
            let _ = writeln!(out, "{name},{value},{},{}", number.unit, number.tolerance);
        }
        out
    }
}

/// A name as a cell: in quotes if it has a comma in it, as programs that read such files expect.
pub(crate) fn quoted(name: &str) -> String {
    if name.contains(',') {
        format!("\"{name}\"")
    } else {
        name.to_owned()
    }
}

fn missing(kind: &'static str, name: &str) -> SandboxError {
    SandboxError::NotRecorded {
        kind,
        name: name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_judge_reads_is_known_and_nan_is_no_answer() {
        let mut record = Record::default();
        record.note("a", 1.0, EXACT);
        record.note("b", 2.0, EXACT);
        record.note("lost", f64::NAN, EXACT);
        record.keep(Table::new("t").exact("x", vec![3.0]));
        let (sum, reads) = record.read_by(|r| -> Result<f64, SandboxError> {
            Ok(r.number("a")? + r.number("a")? + r.column("t", "x")?[0] + r.told("b")?)
        });
        assert_eq!(sum.unwrap().to_bits(), 7.0_f64.to_bits());
        let names: Vec<String> = reads.iter().map(ToString::to_string).collect();
        assert_eq!(names, ["a", "column x of t"]);
        assert!(
            record
                .number("lost")
                .unwrap_err()
                .to_string()
                .contains("NaN")
        );
        assert!(record.number("none").is_err());
    }
}

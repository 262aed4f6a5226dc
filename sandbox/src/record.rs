//! What a run leaves behind: single numbers, tables, grids. Everything a claim or a drawing needs.

use crate::SandboxError;
use ndarray::Array2;
use std::fmt::Write;

/// How far a number may stray from the expected one before `figures --check` says it moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// At most so much, in the number's own unit. Zero: to the last digit.
    Absolute(f64),
    /// At most this share of the expected number.
    Relative(f64),
}

impl Tolerance {
    /// For counts, yes and no.
    pub const EXACT: Self = Self::Absolute(0.0);
    /// For results of a few thousand operations: rounding, and the last bits of a foreign `sin`.
    pub const ROUNDING: Self = Self::Absolute(1e-9);

    /// Whether `value` is close enough to `expected`. Values that are not finite must be the same.
    #[must_use]
    pub fn allows(self, value: f64, expected: f64) -> bool {
        if !(value.is_finite() && expected.is_finite()) {
            return value.to_bits() == expected.to_bits() || value.is_nan() && expected.is_nan();
        }
        let distance = (value - expected).abs();
        match self {
            Self::Absolute(most) => distance <= most,
            Self::Relative(share) => distance <= share * expected.abs(),
        }
    }
}

impl std::fmt::Display for Tolerance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Absolute(most) => write!(f, "{}", shortest(*most)),
            Self::Relative(share) => write!(f, "{} of it", shortest(*share)),
        }
    }
}

/// One result with its name and unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// What it is, in a few words.
    pub name: String,
    /// How much.
    pub value: f64,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// How far it may move.
    pub tolerance: Tolerance,
}

/// One column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// What it is.
    pub name: String,
    /// Its unit; empty for pure numbers.
    pub unit: &'static str,
    /// How far each value may move.
    pub tolerance: Tolerance,
    /// From top to bottom.
    pub values: Vec<f64>,
}

/// Columns of equal length under one name.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Its name, a part of the file's.
    pub name: &'static str,
    /// From left to right.
    pub columns: Vec<Column>,
    /// Whether it is compared with `expected/`; long ones are only written out.
    pub compared: bool,
}

impl Table {
    /// A table without columns, to be compared with `expected/`.
    #[must_use]
    pub fn new(name: &'static str) -> Self {
        Self {
            name,
            columns: Vec::new(),
            compared: true,
        }
    }

    /// A table that is written out but not compared: too long to be read by anyone.
    #[must_use]
    pub fn raw(name: &'static str) -> Self {
        Self {
            compared: false,
            ..Self::new(name)
        }
    }

    /// The same table with one more column at the right.
    #[must_use]
    pub fn with(
        mut self,
        name: impl Into<String>,
        unit: &'static str,
        tolerance: Tolerance,
        values: Vec<f64>,
    ) -> Self {
        self.columns.push(Column {
            name: name.into(),
            unit,
            tolerance,
            values,
        });
        self
    }

    /// The table as CSV: a header with units in brackets, shortest digits that read back the same.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut out = String::new();
        let heads: Vec<String> = self
            .columns
            .iter()
            .map(|column| match column.unit {
                "" => column.name.clone(),
                unit => format!("{} [{unit}]", column.name),
            })
            .collect();
        let _ = writeln!(out, "{}", heads.join(","));
        let rows = self
            .columns
            .iter()
            .map(|column| column.values.len())
            .max()
            .unwrap_or(0);
        for row in 0..rows {
            let cells: Vec<String> = self
                .columns
                .iter()
                .map(|column| {
                    column
                        .values
                        .get(row)
                        .copied()
                        .map_or(String::new(), shortest)
                })
                .collect();
            let _ = writeln!(out, "{}", cells.join(","));
        }
        out
    }
}

/// The shortest digits that read back as the same number.
pub(crate) fn shortest(value: f64) -> String {
    let size = value.abs();
    if value != 0.0 && value.is_finite() && !(1e-4..1e15).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
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
}

impl Record {
    /// Notes a number.
    pub fn note(
        &mut self,
        name: impl Into<String>,
        value: f64,
        unit: &'static str,
        tolerance: Tolerance,
    ) {
        self.numbers.push(Number {
            name: name.into(),
            value,
            unit,
            tolerance,
        });
    }

    /// Keeps a table.
    pub fn keep(&mut self, table: Table) {
        self.tables.push(table);
    }

    /// Keeps a grid.
    pub fn keep_grid(&mut self, name: impl Into<String>, grid: Array2<f64>) {
        self.grids.push((name.into(), grid));
    }

    /// A number by its name.
    ///
    /// # Errors
    ///
    /// When it was not noted.
    pub fn number(&self, name: &str) -> Result<f64, SandboxError> {
        let found = self.numbers.iter().find(|number| number.name == name);
        found
            .map(|number| number.value)
            .ok_or_else(|| missing("number", name))
    }

    /// A column by the names of its table and its own.
    ///
    /// # Errors
    ///
    /// When there is no such table, or no such column in it.
    pub fn column(&self, table: &str, column: &str) -> Result<&[f64], SandboxError> {
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
    fn a_table_is_written_with_units_and_digits_that_read_back() {
        let table = Table::new("t")
            .with("x", "px", Tolerance::EXACT, vec![1.0, 2.0])
            .with("f", "", Tolerance::ROUNDING, vec![0.1 + 0.2, 1e-300]);
        assert_eq!(table.csv(), "x [px],f\n1,0.30000000000000004\n2,1e-300\n");
    }

    #[test]
    fn tolerances_measure_as_they_say() {
        assert!(Tolerance::Absolute(0.1).allows(1.05, 1.0));
        assert!(!Tolerance::Absolute(0.1).allows(1.2, 1.0));
        assert!(Tolerance::Relative(0.1).allows(109.0, 100.0));
        assert!(!Tolerance::EXACT.allows(1.0 + f64::EPSILON, 1.0));
        assert!(Tolerance::EXACT.allows(f64::NAN, f64::NAN));
        assert!(!Tolerance::Absolute(1.0).allows(f64::INFINITY, 1.0));
    }
}

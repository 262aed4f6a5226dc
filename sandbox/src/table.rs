//! Columns of numbers under one name, and how they are written.

use crate::Tolerance;
use crate::tolerance::EXACT;
use glam::DVec2;
use std::fmt::Write;

/// One column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// What it is.
    pub name: String,
    /// Its unit; empty for pure numbers.
    pub unit: String,
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

    /// The same table with one more column at the right. Its unit stands in brackets behind its
    /// name: `"way [px]"`.
    #[must_use]
    pub fn with(
        mut self,
        name: impl Into<String>,
        tolerance: impl Into<Tolerance>,
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
        let (name, unit) = name_and_unit(name.into());
        self.columns.push(Column {
            name,
            unit,
            tolerance: tolerance.into(),
            values: values.into_iter().collect(),
        });
        self
    }

    /// As [`Table::with`], without tolerance: for counts, and in tables that are not compared.
    #[must_use]
    pub fn exact(self, name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        self.with(name, EXACT, values)
    }

    /// The same table with the columns x and y of points.
    #[must_use]
    pub fn xy(self, unit: &str, tolerance: impl Into<Tolerance> + Copy, points: &[DVec2]) -> Self {
        self.with(format!("x [{unit}]"), tolerance, points.iter().map(|p| p.x))
            .with(format!("y [{unit}]"), tolerance, points.iter().map(|p| p.y))
    }

    /// The same table with two columns of pairs.
    #[must_use]
    pub fn pairs(self, first: &str, second: &str, pairs: &[(f64, f64)]) -> Self {
        self.exact(first, pairs.iter().map(|pair| pair.0))
            .exact(second, pairs.iter().map(|pair| pair.1))
    }

    /// The table as CSV: a header with units in brackets, shortest digits that read back the same.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut out = String::new();
        let heads: Vec<String> = self
            .columns
            .iter()
            .map(|column| match column.unit.as_str() {
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

/// A name, and the unit that stands in brackets behind it.
pub(crate) fn name_and_unit(text: String) -> (String, String) {
    let parts = text
        .strip_suffix(']')
        .and_then(|rest| rest.rsplit_once(" ["));
    match parts {
        Some((name, unit)) => (name.to_owned(), unit.to_owned()),
        None => (text, String::new()),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_written_with_units_and_digits_that_read_back() {
        let table = Table::new("t").exact("x [px]", vec![1.0, 2.0]).with(
            "f",
            1e-9,
            vec![0.1 + 0.2, 1e-300],
        );
        assert_eq!(table.csv(), "x [px],f\n1,0.30000000000000004\n2,1e-300\n");
    }
}

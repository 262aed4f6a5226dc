//! Whether a verdict depends on the numbers it is judged by.
//!
//! A claim that reads a number and holds whatever that number is says nothing about it. So every
//! number that a judge reads is moved, down and up, until the verdict changes; one that may be
//! moved by a thousand times its size, and across every decade, is a fault of the claim. Where no
//! single one decides, as with the least of many, those that do not are moved together.

use crate::{Claim, Read, Record, SandboxError, Tolerance};

/// What is wrong with one claim: it does not depend on something it reads, or reads nothing.
///
/// # Errors
///
/// When the judge asks for what was not recorded.
pub(crate) fn idle(claim: &Claim, record: &Record) -> Result<Vec<String>, SandboxError> {
    let (finding, reads) = record.read_by(|record| claim.judge(record));
    let holds = finding?.holds;
    if reads.is_empty() {
        return Ok(vec![format!("{:?} reads no number", claim.says())]);
    }
    // grids are for drawing; without them a copy is cheap
    let mut moved = record.clone();
    let idle: Vec<&Read> = reads
        .iter()
        .filter(|read| !flips(claim, holds, &[read], record, &mut moved))
        .collect();
    // the least or the largest of many, or one of them chosen: no single one decides, all do
    if idle.len() > 1 && flips(claim, holds, &idle, record, &mut moved) {
        return Ok(Vec::new());
    }
    Ok(idle
        .iter()
        .map(|read| format!("{:?} does not depend on {read}", claim.says()))
        .collect())
}

/// Whether the verdict changes as what is read moves, all of it together.
fn flips(claim: &Claim, holds: bool, reads: &[&Read], record: &Record, moved: &mut Record) -> bool {
    let differs = |moved: &Record| {
        // a judge that refuses what it finds has noticed it
        claim
            .judge(moved)
            .map_or(true, |finding| finding.holds != holds)
    };
    let infinite = reads.iter().any(|read| may_be_infinite(record, read));
    let last = infinite.then_some(Move::To(f64::INFINITY));
    let mut found = moves().chain(last).any(|by| {
        reads
            .iter()
            .for_each(|read| apply(by, read, record, moved, None));
        differs(moved)
    });
    // a single row of a column decides where all together do not
    if let ([Read::Column(table, column)], false) = (reads, found) {
        let count = record.column(table, column).map_or(0, <[f64]>::len);
        let picked = [0, count / 2, count.saturating_sub(1)];
        found = picked.into_iter().filter(|row| *row < count).any(|row| {
            moves().any(|by| {
                apply(by, reads[0], record, moved, Some(row));
                differs(moved)
            })
        });
    }
    reads
        .iter()
        .for_each(|read| apply(Move::By(0.0, 0.0), read, record, moved, None));
    found
}

/// How a value is moved.
#[derive(Debug, Clone, Copy)]
enum Move {
    /// By a share of itself, and by an amount.
    By(f64, f64),
    /// To a value.
    To(f64),
}

impl Move {
    fn of(self, own: f64) -> f64 {
        match self {
            Self::By(share, amount) if own.is_finite() => own + share * own.abs() + amount,
            Self::By(_, amount) => amount,
            Self::To(value) => value,
        }
    }
}

/// Moves to try, from the nearest on: both ways by shares of the value, then by amounts, then to zero
/// and to values that are equal for all.
fn moves() -> impl Iterator<Item = Move> {
    let shares = (-9..=12).map(|k| 2.0_f64.powi(k));
    let amounts = (-14..=4).map(|k| 10.0_f64.powi(k));
    let shares = shares.flat_map(|by| [Move::By(by, 0.0), Move::By(-by, 0.0)]);
    let amounts = amounts.flat_map(|by| [Move::By(0.0, by), Move::By(0.0, -by)]);
    let same = [0.0, 1.0, -1.0, 1e-3, 1e3].map(Move::To);
    shares.chain(amounts).chain(same)
}

/// Whether a number's tolerance says that it may be infinite: "never" is then one of its answers.
fn may_be_infinite(record: &Record, read: &Read) -> bool {
    match read {
        Read::Number(name) => record.numbers.iter().any(|number| {
            number.name == *name && matches!(number.tolerance, Tolerance::RelativeOrInfinite(_))
        }),
        Read::Column(..) => false,
    }
}

/// Sets in `moved` what `read` names, moved from what it is in `record`: a number, a row of a column,
/// or all of its rows.
fn apply(by: Move, read: &Read, record: &Record, moved: &mut Record, row: Option<usize>) {
    match read {
        Read::Number(name) => {
            for (own, to) in record.numbers.iter().zip(&mut moved.numbers) {
                if own.name == *name {
                    to.value = if matches!(by, Move::By(0.0, 0.0)) {
                        own.value
                    } else {
                        by.of(own.value)
                    };
                }
            }
        }
        Read::Column(table, column) => {
            for (own, to) in record.tables.iter().zip(&mut moved.tables) {
                if own.name != table.as_str() {
                    continue;
                }
                for (own, to) in own.columns.iter().zip(&mut to.columns) {
                    if own.name != *column {
                        continue;
                    }
                    to.values.clone_from(&own.values);
                    if matches!(by, Move::By(0.0, 0.0)) {
                        continue;
                    }
                    for (index, value) in to.values.iter_mut().enumerate() {
                        if row.is_none_or(|row| row == index) {
                            *value = by.of(*value);
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demand::{above, below, falling, less};
    use crate::{Finding, Table, claim};

    fn record() -> Record {
        let mut record = Record::default();
        record.note("a [px]", 1.0, 0.0);
        record.note("b [px]", 2.0, 0.0);
        record.keep(Table::new("t").exact("x", [1.0, 5.0, 2.0]));
        record
    }

    fn found(judge: fn(&Record) -> Result<Finding, SandboxError>) -> Vec<String> {
        idle(&claim("it is so [a test]").judged(judge), &record()).unwrap()
    }

    #[test]
    fn demands_are_found_out_as_code_is() {
        const SOUND: Claim = claim("it is so").when(&[
            below("a", 3.0),
            less("a", 1.0, "b"),
            above("x @ t", 0.5),
            falling("x @ t"),
        ]);
        const FREE: Claim = claim("it is so").when(&[below("a", 1e9)]);
        const HALF: Claim = claim("it is so").when(&[below("a", 3.0), below("b", 1e9)]);
        const EMPTY: Claim = claim("it is so").when(&[]);
        let record = record();
        assert!(!SOUND.judge(&record).unwrap().holds); // the rows do not fall
        for (claim, faults) in [(FREE, 1), (HALF, 1), (EMPTY, 1)] {
            assert_eq!(idle(&claim, &record).unwrap().len(), faults);
        }
        const HOLDS: Claim = claim("it is so").when(&[below("a", 3.0), above("x @ t", 0.5)]);
        assert!(idle(&HOLDS, &record).unwrap().is_empty());
    }

    #[test]
    fn a_claim_that_depends_on_all_it_reads_is_sound() {
        assert!(found(|r| Ok(Finding::new(r.number("a")? < 3.0, ""))).is_empty());
        assert!(found(|r| Ok(Finding::new(r.number("a")? < r.number("b")?, ""))).is_empty());
        assert!(
            found(|r| Ok(Finding::new(
                r.column("t", "x")?.iter().all(|x| *x < 9.0),
                ""
            )))
            .is_empty()
        );
    }

    #[test]
    fn a_claim_that_cannot_fail_is_found_out() {
        assert_eq!(
            found(|r| {
                r.number("a")?;
                Ok(Finding::new(true, ""))
            }),
            ["\"it is so\" does not depend on a"]
        );
        assert_eq!(
            found(|r| Ok(Finding::new(
                r.number("a")? < 3.0 || r.number("b")? < 9.0,
                ""
            )))
            .len(),
            1
        );
        assert_eq!(
            found(|r| Ok(Finding::new(r.number("a")? < 1e9, ""))).len(),
            1
        );
        assert_eq!(
            found(|r| {
                r.column("t", "x")?;
                Ok(Finding::new(r.number("a")? < 3.0, ""))
            }),
            ["\"it is so\" does not depend on column x of t"]
        );
    }

    #[test]
    fn a_claim_judged_by_nothing_recorded_is_found_out() {
        assert_eq!(
            found(|_| Ok(Finding::new(true, ""))),
            ["\"it is so\" reads no number"]
        );
    }
}
